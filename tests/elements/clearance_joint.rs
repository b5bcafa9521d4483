//! A slider crank whose wrist pin is loose by 0.1 mm: stable, convergent, and within its clearance of the ideal one.

use mbint::results::Method;

use crate::common::power::{APART, assert_balance, pair};
use crate::common::{Subject, band, curve, distance, largest, nominal, output, read, row, run, study_of};

/// `wrist` is the joint or the effect between rod and slider; it starts centred, with the ideal mechanism's velocities.
fn slider_crank(joint: &str, effect: &str, start: &str) -> Subject {
    read(&format!(
        "
parameters:
  c: {{ value: 0.1, unit: mm, tolerance: 50% }}
  l: 50 mm
  L: 120 mm
  theta: 60 deg
  omega: 60 rpm
  phi: asin(l*sin(theta)/L)
  phi_rate: omega*l*cos(theta)/(L*cos(phi))
bodies:
  crank: {{ mass: 0.3, inertia: 1e-4, points: {{ A: [-l/2, 0], B: [l/2, 0] }} }}
  rod: {{ mass: 0.21, inertia: 2.5e-4, points: {{ B: [-L/2, 0], C: [L/2, 0] }} }}
  slider: {{ mass: 0.14, coordinates: [x] }}
joints:
  pivot: {{ revolute: [ground, crank.A] }}
  pin: {{ revolute: [crank.B, rod.B] }}
  drive: {{ motor: {{ on: pivot, speed: omega, from: theta }} }}
{joint}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
{effect}
{start}
guess: {{ crank.angle: theta }}
outputs: {{ x: slider.x, torque: drive.torque }}
simulation: {{ duration: 0.5, step: 1e-4, output_step: 1e-3 }}
bounds: {{ scan: {{ points: 3 }} }}
"
    ))
}

fn ideal() -> Subject {
    slider_crank("  wrist: { revolute: [slider, rod.C] }", "", "initial: {}")
}

fn loose(friction: &str) -> Subject {
    let wrist = format!(
        "  wrist:
    clearance_joint:
      between: [slider, rod.C]
      clearance: c
      radius: 5 mm
      impact: {{ stiffness: 1e9, restitution: 0.5, impact_velocity: 0.05, law: hunt_crossley }}
{friction}"
    );
    let start = "initial:
  rod.angle: -phi
  rod.angular_velocity: -phi_rate
  slider.x: l*cos(theta) + L*cos(phi)
  slider.vx: -l*omega*sin(theta) - L*phi_rate*sin(phi)";
    slider_crank("", &wrist, start)
}

/// After the first blows, when the journal has come to lie in its bearing.
const SETTLED: f64 = 0.1;

#[test]
fn loose_pin_stays_within_its_clearance() {
    let tight = nominal(&ideal());
    for friction in ["", "      friction: { coefficient: 0.1 }\n"] {
        let description = loose(friction);
        let bounds = nominal(&description.clone().observing(&["slider.x", "wrist.gap", "wrist.force", "drive.torque"]));
        let (gap, force) = (curve(&bounds, "wrist.gap"), curve(&bounds, "wrist.force"));
        // Depth under its largest force, in a bearing of 0.1 mm.
        let deepest = (largest(force.iter().copied()) / 1e9).powf(2.0 / 3.0);
        let lowest = gap.iter().copied().fold(0.0, f64::min);
        println!("deepest {lowest:.3e}, largest force {:.3e}", largest(force.iter().copied()));
        assert!(-lowest < 1.5 * deepest + 1e-9 && deepest < 1e-4, "{lowest:e}, {deepest:e}");
        assert!(gap.iter().all(|gap| *gap <= 1e-4));
        // The pin's centre is within clearance and depth of the slider's, and the rod's slope takes that to the slider.
        let apart = distance(curve(&bounds, "slider.x"), curve(&tight, "x"));
        println!("slider off by {apart:.3e}");
        assert!(apart < 1.2e-4 * 1.1 + deepest && apart > 2e-5, "{apart:e}");
        // The mean drive is the ideal torque, without the blows.
        let from = row(&bounds, SETTLED);
        let mean = |torque: &[f64]| torque[from..].iter().sum::<f64>() / (torque.len() - from) as f64;
        let (loose, ideal) = (mean(curve(&bounds, "drive.torque")), mean(curve(&tight, "torque")));
        assert!((loose - ideal).abs() < 0.02, "{loose} {ideal}");
    }
}

/// The first blows converge as the step falls.
#[test]
fn a_loose_pin_converges_with_the_step() {
    let description = loose("      friction: { coefficient: 0.1 }\n").duration(0.05);
    let runs = [1e-4, 5e-5, 2.5e-5, 1.25e-5].map(|h| nominal(&description.clone().step(h)));
    let differences: Vec<f64> =
        runs.windows(2).map(|pair| distance(curve(&pair[0], "x"), curve(&pair[1], "x"))).collect();
    println!("{differences:?}");
    assert!(differences[2] < 0.5 * differences[0] && differences[2] < 2e-6, "{differences:?}");
}

/// The clearance is the uncertain parameter; the samples run in lockstep.
#[test]
#[ignore = "2 s"]
fn the_clearance_may_be_uncertain() {
    let bounds = run(&loose(""));
    let x = output(&bounds, "x");
    let scan = band(x, Method::Scan);
    let widest = scan.upper.iter().zip(&scan.lower).map(|(upper, lower)| upper - lower).fold(0.0, f64::max);
    // Three clearances from 0.05 to 0.15 mm: the slider deviates from its position by at most the largest.
    assert!(widest > 2e-5 && widest < 4e-4, "{widest:e}");
    assert!(scan.lower.iter().chain(&scan.upper).all(|value| value.is_finite()));
}

#[test]
fn stored_energy_of_an_elastic_bearing_equals_work_done() {
    assert_balance(
        &pair(
            "",
            "  e: { clearance_joint: { between: [a.P, b.P], clearance: 0.01, radius: 2, impact: { stiffness: 20 } } }",
            APART,
        ),
        "0",
    );
}

/// A journal whose centre is beyond the bearing's surface is no joint.
#[test]
fn a_journal_outside_of_its_bearing_is_refused() {
    let begins = |x: &str| {
        study_of(&format!(
            "
bodies: {{ rod: {{ mass: 1, inertia: 0.1, points: {{ A: [35 mm, 0] }} }} }}
effects:
  pin: {{ clearance_joint: {{ between: [ground, rod.A], clearance: 0.1 mm, radius: 5 mm, impact: {{ stiffness: 1e9 }} }} }}
initial: {{ rod.x: {x}, rod.y: 0, rod.angle: 0 }}
outputs: {{ x: rod.x }}
simulation: {{ duration: 1e-3, step: 1e-4 }}
"
        )).run()
    };
    assert!(begins("-35.05 mm").is_ok(), "the journal is in its bearing");
    let message = begins("0").expect_err("it is outside").to_string();
    assert!(message.contains("`pin`") && message.contains("2.990e-2 m outside"), "{message}");
}
