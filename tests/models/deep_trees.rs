//! Deep trees in joint coordinates: their equations are eliminated link by link, in instructions in proportion to the
//! links, and move as the same equations eliminated as a whole, as absolute coordinates, and as an independent program
//! say.

use std::fmt::Write;

use mbint::inner::assemble;
use mbint::inner::compile::Scheme;
use mbint::inner::numerics::Sample;
use mbint::inner::simulate::{Simulator, Stepper};
use mbint::inner::study;
use mbint::{Formulation, SchemeChoice};

use crate::common::{Subject, curve, largest, nominal, read, richardson};

fn within(description: Subject, formulation: Formulation) -> Subject {
    description.formulation(formulation)
}

/// Axes of the joints, in turn.
const AXES: [[f64; 3]; 5] = [[1.0, 2.0, -0.5], [0.0, 1.0, 0.25], [-0.5, 0.25, 1.0], [0.2, -1.0, 0.5], [1.0, 0.0, 1.0]];

/// Bars of 0.3 m, each hanging from the one before by a sprung and damped pin: about [`AXES`], or all about z in the
/// plane.
fn chain(links: usize, spatial: bool) -> String {
    let [mut bodies, mut joints, mut effects, mut initial] = [const { String::new() }; 4];
    for i in 0..links {
        let (inertia, third) = if spatial { ("[0.001, 0.008, 0.006]", ", 0") } else { ("0.006", "") };
        let points = format!("points: {{ a: [-0.15, 0{third}], e: [0.15, 0{third}] }}");
        writeln!(bodies, "  b{i}: {{ mass: 1, inertia: {inertia}, {points} }}").unwrap();
        let before = if i == 0 { "ground".to_owned() } else { format!("b{}.e", i - 1) };
        let axis = if spatial { format!("{:?}", AXES[i % 5]) } else { "z".to_owned() };
        writeln!(joints, "  j{i}: {{ revolute: {{ between: [{before}, b{i}.a], axis: {axis} }} }}").unwrap();
        let spring = "stiffness: 5, damping: 0.05, free_angle: 0";
        writeln!(effects, "  s{i}: {{ torsional_spring_damper: {{ on: j{i}, {spring} }} }}").unwrap();
        writeln!(initial, "  j{i}.angle: {:?}", 0.1 + 0.02 * (i % 3) as f64).unwrap();
        writeln!(initial, "  j{i}.angular_velocity: {:?}", 0.2 - 0.05 * (i % 4) as f64).unwrap();
    }
    let down = if spatial { "[0, 0, -9.81]" } else { "[0, -9.81]" };
    let last = links - 1;
    format!(
        "bodies:\n{bodies}joints:\n{joints}effects:\n  weight: {{ gravity: {{ acceleration: {down} }} }}\n{effects}
initial:\n{initial}outputs: {{ tip: b{last}.e.y }}
simulation: {{ duration: 0.01, step: 1e-3, output_step: 1e-3, formulation: joint }}\n"
    )
}

/// A trunk of ten links with a branch of eight from its fifth, a motor in the branch, joints with friction, sliders,
/// and a spring with a damper between the ends.
fn branched() -> Subject {
    let [mut bodies, mut joints, mut effects] = [const { String::new() }; 3];
    for i in 0..18 {
        writeln!(bodies, "  b{i}: {{ mass: {:?}, inertia: {{ xx: 0.004, yy: 0.008, zz: 0.006, xy: 0.001, yz: -0.0005 }}, center_of_mass: [0.02, 0.01, 0], points: {{ a: [-0.15, 0, 0.02], e: [0.15, 0, 0] }} }}", 1.0 - 0.03 * i as f64).unwrap();
        let before = match i {
            0 => "ground".to_owned(),
            10 => "b4.e".to_owned(),
            _ => format!("b{}.e", i - 1),
        };
        let kind = if i == 7 || i == 13 { "prismatic" } else { "revolute" };
        writeln!(joints, "  j{i}: {{ {kind}: {{ between: [{before}, b{i}.a], axis: {:?} }} }}", AXES[i % 5]).unwrap();
        if i % 4 == 1 && kind == "revolute" {
            writeln!(
                effects,
                "  f{i}: {{ joint_friction: {{ on: j{i}, coulomb: 0.2, viscous: 0.05, transition_velocity: 0.3 }} }}"
            )
            .unwrap();
        }
    }
    read(&format!(
        "parameters:\n  k: {{ value: 40, unit: N/m, tolerance: 10% }}\nbodies:\n{bodies}joints:\n{joints}
  drive: {{ motor: {{ on: j15, position: 0.3*sin(2*t) }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }}
  spring: {{ spring_damper: {{ between: [b9.e, b17.e], stiffness: k, damping: 0.5, free_length: 0.2 }} }}
{effects}outputs: {{ x: b9.e.x, z: b17.e.z, vy: b17.e.vy, angle: j3.angle, slide: j7.displacement }}
simulation: {{ duration: 0.1, step: 1e-3, output_step: 0.02, formulation: joint }}\n"
    ))
}

/// The same equations, eliminated link by link and as a whole.
fn both(description: &Subject) -> [Simulator; 2] {
    let of_links =
        assemble::in_joint_coordinates(&assemble::Questions::of(description.study().description()), None, None)
            .unwrap()
            .unwrap();
    assert!(!of_links.links.is_empty());
    let mut whole = of_links.clone();
    whole.links.clear();
    [of_links, whole].map(|system| Simulator::new(system, Scheme::Hht { alpha: -0.1 }, 1e-3).unwrap())
}

fn instructions(simulator: &Simulator) -> usize {
    simulator.program.instructions()
}

#[test]
fn instructions_grow_in_proportion_to_the_links() {
    for (spatial, a_link) in [(false, 250), (true, 1400)] {
        let [short, long] = [20, 80].map(|links| {
            let description = read(&chain(links, spatial));
            let simulator = study::prepare(description.study().description()).unwrap();
            (instructions(&simulator), simulator.start.acceleration().len())
        });
        println!("spatial {spatial}: step and accelerations {short:?} of 20 links, {long:?} of 80");
        // A chain four times as long takes four times the instructions, and the last links fewer.
        assert!(10 * long.0 < 44 * short.0 && 10 * long.1 < 44 * short.1);
        assert!(long.0 < 80 * a_link);
    }
}

#[test]
#[ignore = "minutes: chains of 160 links"]
fn chains_of_160_links_cost_four_times_as_much_as_of_40() {
    for spatial in [false, true] {
        let [short, long] = [40, 160]
            .map(|links| instructions(&study::prepare(read(&chain(links, spatial)).study().description()).unwrap()));
        let exponent = (long as f64 / short as f64).ln() / 4_f64.ln();
        println!("spatial {spatial}: {short} and {long} instructions, exponent {exponent:.3}");
        assert!(exponent < 1.06, "{exponent}");
    }
}

/// A chain in space whose links bend and twist in turn: the torque about an axis of twist is the same sum for two
/// links.
fn twisting_chain(links: usize) -> String {
    AXES.iter().enumerate().fold(chain(links, true), |text, (index, axis)| {
        let other = ["[0, 1, 0]", "[1, 0, 0]"][index % 2];
        text.replace(&format!("axis: {axis:?}"), &format!("axis: {other}"))
    })
}

#[test]
fn elimination_by_links_and_as_a_whole_give_equal_steps() {
    for description in [read(&chain(12, true)), read(&chain(16, false)), read(&twisting_chain(24)), branched()] {
        let simulators = both(&description);
        let [by_links, whole] = [&simulators[0], &simulators[1]].map(instructions);
        assert!(by_links < whole, "{by_links} instructions instead of {whole}");
        let states = simulators.each_ref().map(|simulator| {
            let sample: Sample = simulator.system.parameters.iter().map(|parameter| parameter.nominal).collect();
            let start = simulator.assemble(1, 1e-3, |_| sample.clone()).unwrap();
            let mut stepper = Stepper::new(&simulator.program, &start);
            let mut states = Vec::new();
            for step in 1..=50 {
                assert!(stepper.step(1e-3, step as f64 * 1e-3).is_empty());
                let tile = stepper.tile();
                states.extend(simulator.program.layout.state().map(|register| tile.lane(register)[0]));
            }
            states
        });
        let apart = largest(states[0].iter().zip(&states[1]).map(|(a, b)| (a - b) / a.abs().max(b.abs()).max(1.0)));
        println!("{by_links} instructions instead of {whole}: states differ by {apart:e}");
        // Newton's tolerance, in accelerations over h².
        assert!(apart < 1e-6, "{apart}");
    }
}

#[test]
fn a_branched_tree_moves_as_in_absolute_coordinates() {
    let [absolute, joint] = [Formulation::Absolute, Formulation::Joint].map(|formulation| {
        let description = within(branched(), formulation);
        let courses = [1e-3, 5e-4].map(|h| nominal(&description.clone().step(h)));
        let names = ["x", "z", "vy", "angle", "slide"];
        names.map(|name| richardson(curve(&courses[0], name), curve(&courses[1], name)))
    });
    for (a, b) in absolute.iter().zip(&joint) {
        let apart = largest(a.iter().zip(b).map(|(a, b)| a - b)) / largest(a.iter().copied()).max(1e-3);
        println!("{apart:e}");
        // The remaining error of the extrapolation of a scheme of order 2.
        assert!(apart < 1e-4, "{apart}");
    }
}

/// Against Pinocchio 4.1: its articulated-body algorithm at the start, and under DOP853 of SciPy (tolerances 1e-12)
/// until 0.2 s.
#[test]
fn chain_of_twenty_links_matches_pinocchio() {
    let places = [0, 7, 13, 19];
    let outputs: Vec<String> = places
        .iter()
        .flat_map(|i| [format!("j{i}.angular_acceleration"), format!("j{i}.angle")])
        .chain(["b19.e.x".to_owned(), "b19.e.y".to_owned(), "b19.e.z".to_owned()])
        .collect();
    let names: Vec<&str> = outputs.iter().map(String::as_str).collect();
    let description = read(&chain(20, true)).observing(&names).duration(0.2).rows_every(0.2);
    let explicit = description.clone().tolerance(1e-8).scheme(SchemeChoice::Explicit);
    let by_hht = [5e-4, 2.5e-4].map(|h| nominal(&description.clone().by_hht().step(h)));
    let explicit = nominal(&explicit);
    let angles = [0.3697232906, 0.163273643, -0.039319955, 0.04612344483];
    let accelerations = [28.16537129, -6.418745082, -23.76886849, -92.29458895];
    let tip = [4.10494816, 3.21922696, -1.9233029];
    for (index, i) in places.iter().enumerate() {
        let found = curve(&explicit, &format!("j{i}.angular_acceleration"))[0];
        assert!((found - accelerations[index]).abs() < 1e-7, "j{i}: {found}");
    }
    let ends = names.iter().filter(|name| !name.ends_with("acceleration")).zip(angles.iter().chain(&tip));
    for (name, wanted) in ends {
        let found = curve(&explicit, name)[1];
        let extrapolated = richardson(curve(&by_hht[0], name), curve(&by_hht[1], name))[1];
        println!("{name}: {found} {extrapolated} {wanted}");
        assert!((found - wanted).abs() < 1e-6, "{name}: {found}, not {wanted}");
        assert!((extrapolated - wanted).abs() < 2e-5, "{name}: {extrapolated}, not {wanted}");
    }
}

/// Steps under a tolerance, whose errors are estimated from inertial forces, against explicit ones.
#[test]
fn tolerance_steps_of_a_chain_match_explicit_ones() {
    let description = read(&chain(14, true)).duration(0.2).rows_every(0.05);
    let by_hht = nominal(&description.clone().tolerance(1e-3).by_hht());
    let explicit = description.tolerance(1e-8).scheme(SchemeChoice::Explicit);
    let (found, wanted) = (curve(&by_hht, "tip").to_vec(), nominal(&explicit));
    let wanted = curve(&wanted, "tip");
    let apart = largest(found.iter().zip(wanted).map(|(a, b)| a - b)) / largest(wanted.iter().copied());
    println!("{apart:e}");
    assert!(apart < 1e-3, "{apart}");
}
