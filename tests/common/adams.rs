//! One body on one joint or spring, against MSC Adams (results published with Project Chrono, 7 digits).
//!
//! m = 1 kg, inertia (0.04, 0.1, 0.1) about the world's axes, g = 9.80665 in −z, from rest, rows 0.01 s apart over 5 s.
//! Adams gives the reaction on the ground; mbint's is on the second body, here the moving one.

use mbint::results::Bounds;

use super::{Findings, curve, largest, measured, nominal, read, row, rows, third_party};

/// A joint `j` or an effect `s` that carries a body `a`.
pub struct Case {
    /// Folder and beginning of the files.
    pub name: &'static str,
    /// The files with its velocities. Adams' velocities on the spherical joint differ by 2.6e-3 m/s at the end from
    /// those on the revolute one, where the body moves alike and with which mbint agrees to 1.5e-4: those stand for
    /// both.
    pub velocities: &'static str,
    pub text: &'static str,
    /// The row at 1 s: position, Euler parameters, force on the body, angular velocity.
    pub at_one: [f64; 13],
}

/// Outputs, the file that has them, its sign, and how far they may be off: absolutely, and relative to the curve's
/// size.
const OBSERVED: [(&str, [&str; 3], f64, f64, f64); 6] = [
    ("Pos", ["a.x", "a.y", "a.z"], 1.0, 1e-3, 0.0),
    ("Vel", ["a.vx", "a.vy", "a.vz"], 1.0, 1e-3, 0.0),
    ("Acc", ["a.ax", "a.ay", "a.az"], 1.0, 2e-2, 0.0),
    ("Avel", ["a.omega.x", "a.omega.y", "a.omega.z"], 1.0, 1e-3, 0.0),
    ("Aacc", ["a.alpha.x", "a.alpha.y", "a.alpha.z"], 1.0, 2e-2, 0.0),
    ("Rforce", ["j.force.x", "j.force.y", "j.force.z"], -1.0, 1e-3, 1e-2),
];

/// Quantity of a file, with its unit.
fn quantity(file: &str) -> &'static str {
    match file {
        "Quat" => "Euler parameters",
        "Pos" => "position, m",
        "Vel" => "velocity, m/s",
        "Acc" => "acceleration, m/s²",
        "Avel" => "angular velocity, rad/s",
        "Aacc" => "angular acceleration, rad/s²",
        _ => "force, N",
    }
}

const EULER: [&str; 4] = ["a.p0", "a.p1", "a.p2", "a.p3"];

impl Case {
    fn has_joint(&self) -> bool {
        self.text.contains("joints:")
    }

    fn observed(&self) -> Bounds {
        let gravity = "gravity: { gravity: { acceleration: [0, 0, -9.80665] } }";
        let text = match self.text.split_once("effects: {") {
            Some((before, after)) => format!("{before}effects: {{ {gravity}, {after}"),
            None => format!("{}\neffects: {{ {gravity} }}", self.text),
        };
        let text =
            format!("{text}\noutputs: {{ x: a.x }}\nsimulation: {{ duration: 5, step: 1e-3, output_step: 0.01 }}\n");
        let formulas = EULER.into_iter().chain(OBSERVED.iter().flat_map(|(_, formulas, ..)| *formulas));
        let formulas: Vec<&str> = formulas.filter(|f| self.has_joint() || !f.starts_with("j.")).collect();
        nominal(&read(&text).observing(&formulas))
    }

    #[track_caller]
    pub fn at_one_second(&self) {
        let mut findings = Findings::default();
        let bounds = self.observed();
        let one = row(&bounds, 1.0);
        let names = [&["a.x", "a.y", "a.z"][..], &EULER, &OBSERVED[5].1, &OBSERVED[3].1].concat();
        for (formula, wanted) in names.iter().zip(self.at_one) {
            if formula.starts_with("j.") && !self.has_joint() {
                continue;
            }
            let found = curve(&bounds, formula)[one];
            let allowed = if formula.starts_with("j.") { 1e-3 + 1e-2 * wanted.abs() } else { 1e-3 };
            findings.check((found - wanted).abs() < allowed, format_args!("{formula} = {found}, not {wanted}"));
        }
        findings.none();
    }

    #[track_caller]
    pub fn over_five_seconds(&self) {
        let bounds = self.observed();
        let mut case = measured::Case::new("adams", self.name.rsplit('/').next().unwrap_or(self.name));
        let compare = |case: measured::Case, file: &str, formulas: &[&str], sign: f64, absolute: f64, relative: f64| {
            let name = if ["Vel", "Avel"].contains(&file) { self.velocities } else { self.name };
            let rows = rows(&third_party().join(format!("adams_joints/{name}_Case01_ADAMS_{file}.txt")));
            let columns = || rows.iter().flat_map(|row| &row[1..]);
            let allowed = absolute + relative * largest(columns().copied());
            let worst = largest(formulas.iter().enumerate().map(|(column, formula)| {
                let found = curve(&bounds, formula);
                assert_eq!(rows.len(), found.len(), "{file}");
                let worst = largest(rows.iter().zip(found).map(|(row, found)| row[column + 1] - sign * found));
                println!("{formula}: {worst:.1e}");
                worst
            }));
            case.at_most(quantity(file), worst, allowed)
        };
        case = compare(case, "Quat", &EULER, 1.0, 1e-3, 0.0);
        for (file, formulas, sign, absolute, relative) in OBSERVED {
            if self.has_joint() || file != "Rforce" {
                case = compare(case, file, &formulas, sign, absolute, relative);
            }
        }
        case.note();
    }
}

/// The two tests of a [`Case`]: against numbers that stand in it, and against the third party's files.
#[allow(unused_macros, reason = "the tests of elements alone use it")]
macro_rules! compared_with_adams {
    ($case:expr) => {
        #[test]
        fn motion_after_one_second_matches_adams() {
            $case.at_one_second();
        }

        #[test]
        #[ignore = "third-party results: MBINT_REFERENCE=folder"]
        fn it_moves_as_in_adams() {
            $case.over_five_seconds();
        }
    };
}
#[allow(unused_imports, reason = "the tests of elements alone use it")]
pub(crate) use compared_with_adams;
