//! Beams and superelements that are carried along steadily: their inner forces do not change (Galileo), along the
//! beam and aslant.

use std::fmt::Write;

use crate::common::finite_elements::Beam;
use crate::common::measured::Case;
use crate::common::{curve, largest, nominal, read};

/// Speed of the carriage, m/s; it goes by 4 m in the run, the beam bends by 1 cm.
const SPEED: f64 = 20.0;

/// Largest change, as a share of the largest value, by rounding of metres in forces of millimetres times 1 MN/m.
const MOST: f64 = 1e-8;

const STEEL: Beam = Beam { length: 0.8, axial: 4e6, bending: [60.0, 90.0], torsional: 45.0, mass: 1.2, turning: 1e-4 };

/// A mechanism with an elastic part that is clamped to a carriage, and its inner forces.
struct Elastic {
    element: &'static str,
    spatial: bool,
    bodies: String,
    effects: String,
    tip: &'static str,
    joints: &'static str,
    outputs: &'static [&'static str],
}

fn elastic() -> Vec<Elastic> {
    let section = "length: 0.8, axial_stiffness: 4e6, bending_stiffness: 90, damping: 1e-4";
    let in_space = "bending_stiffness_y: 60, torsional_stiffness: 45";
    let matrices = STEEL.of_elements(10).reduced(&[0, 10], 2).yaml(&[[0.0; 3], [STEEL.length, 0.0, 0.0]], 2);
    let ends = "  root: { mass: 0, inertia: 0 }\n  tip: { mass: 0, inertia: 0 }\n".to_owned();
    let of_beam: &[&str] = &["rod.axial", "rod.torque", "rod.start_torque"];
    let of_body: &[&str] = &["rod.element1.axial", "rod.element1.start_torque", "rod.element3.torque"];
    let mut all = Vec::new();
    for spatial in [false, true] {
        let (inertia, more) =
            if spatial { ("[0.02, 0.03, 0.04]", format!(", {in_space}")) } else { ("0.03", String::new()) };
        all.push(Elastic {
            element: "`beam`, massless",
            spatial,
            bodies: format!("  tip: {{ mass: 2, inertia: {inertia} }}\n"),
            effects: format!("  rod: {{ beam: {{ between: [carriage, tip], {section}{more} }} }}\n"),
            tip: "tip",
            joints: "",
            outputs: of_beam,
        });
        all.push(Elastic {
            element: "`beam`, a flexible body",
            spatial,
            bodies: format!("  rod: {{ beam: {{ {section}{more}, mass_per_length: 1.2, elements: 3 }} }}\n"),
            effects: String::new(),
            tip: "rod.end",
            joints: ", clamp: { fixed: [carriage, rod.start] }",
            outputs: of_body,
        });
        all.push(Elastic {
            element: "`superelement`",
            spatial,
            bodies: ends.clone(),
            effects: format!(
                "  rod: {{ superelement: {{ nodes: [root, tip], matrices: {matrices}, damping: 1e-4 }} }}\n"
            ),
            tip: "tip",
            joints: ", clamp: { fixed: [carriage, root] }",
            outputs: &["rod.axial", "clamp.torque"],
        });
    }
    all
}

impl Elastic {
    /// Inner forces and the energy of deformation, row by row, on a carriage with this speed along an axis.
    fn felt(&self, speed: f64, axis: usize) -> Vec<Vec<f64>> {
        let (space, force) = match self.spatial {
            false => ("planar", "[\"50*sin(40*t)\", \"120*sin(60*t)\"]"),
            true => ("spatial", "[\"50*sin(40*t)\", \"120*sin(60*t)\", 90]"),
        };
        let [x, y, z] = match (axis, self.spatial) {
            (0, _) => [1.0, 0.0, 0.0],
            (_, false) => [0.6, 0.8, 0.0],
            (_, true) => [0.48, 0.6, 0.64],
        };
        let axis = if self.spatial { format!("[{x}, {y}, {z}]") } else { format!("[{x}, {y}]") };
        let [x, y, z] = [x, y, z].map(|component| speed * component);
        let third = if self.spatial { format!(", tip.vz: {z}") } else { String::new() };
        let inertia = if self.spatial { "[1, 1, 1]" } else { "1" };
        let outputs: String = self.outputs.iter().map(|name| format!("{}: {name}, ", name.replace('.', "_"))).collect();
        let at = match self.element.contains("massless") {
            true => format!("initial: {{ tip.x: 0.8, tip.vx: {x}, tip.vy: {y}{third} }}\n"),
            false => String::new(),
        };
        let mut text =
            format!("space: {space}\nbodies:\n  carriage: {{ mass: 1, inertia: {inertia} }}\n{}", self.bodies);
        write!(
            text,
            "joints: {{ rail: {{ prismatic: {{ between: [ground, carriage], axis: {} }} }}, drive: {{ motor: {{ on: rail, position: \"{speed}*t\" }} }}{} }}\n\
             effects:\n{}  push: {{ force: {{ on: {}, value: {force} }} }}\n\
             {at}outputs: {{ {outputs}energy: potential_energy }}\n\
             simulation: {{ duration: 0.2, step: 5e-4, output_step: 0.01 }}\n",
            axis, self.joints, self.effects, self.tip
        )
        .unwrap();
        let bounds = nominal(&read(&text));
        self.outputs.iter().chain(&["energy"]).map(|name| curve(&bounds, &name.replace('.', "_")).to_vec()).collect()
    }
}

/// The table of largest changes; fails where inner forces change by more than rounding.
pub fn table() -> String {
    let mut page = "| element | space | along the beam | aslant |\n|---|---|--:|--:|\n".to_owned();
    for own in elastic() {
        let space = if own.spatial { "space" } else { "plane" };
        let changes = [0, 1].map(|axis| {
            let [at_rest, carried] = [0.0, SPEED].map(|speed| own.felt(speed, axis));
            let change = |(rest, carried): (&Vec<f64>, &Vec<f64>)| {
                let size = largest(rest.iter().copied());
                assert!(size > 1e-3, "{}: nothing is felt", own.element);
                largest(rest.iter().zip(carried).map(|(rest, carried)| rest - carried)) / size
            };
            at_rest.iter().zip(&carried).map(change).fold(0.0, f64::max)
        });
        Case::new("elements", &format!("{}, {space}, carried at {SPEED} m/s", own.element))
            .at_most("inner forces and energy, along the beam", changes[0], MOST)
            .at_most("inner forces and energy, aslant", changes[1], MOST)
            .note();
        writeln!(page, "| {} | {space} | {:.0e} | {:.0e} |", own.element, changes[0], changes[1]).unwrap();
    }
    page
}

#[test]
fn steady_motion_leaves_inner_forces_unchanged() {
    println!("{}", table());
}
