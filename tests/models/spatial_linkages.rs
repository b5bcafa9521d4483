//! Linkages and couplings in space against their closed forms, and mechanisms of the plane against themselves in space.

use crate::common::measured::Case;
use crate::common::{
    Findings, Subject, curve, distance_from, largest, model, nominal, order, read, reference, richardson, row,
    run_methods,
};
use std::f64::consts::TAU;

/// Positions are those of closed loops: Newton ends at 1e-11 of the model's size.
const CLOSED: f64 = 1e-9;

#[test]
fn the_spatial_four_bar_closes_its_loop() {
    // |D + r (sin b, 0, cos b) − B| = c is  x sin b + z cos b = (c² − r² − |D − B|²) / 2r  with (x, ·, z) = D − B.
    let (crank, coupler, rocker): (f64, f64, f64) = (0.1, 0.26, 0.2);
    let rocker_angle = |t: f64| {
        let (sin, cos) = (TAU * t).sin_cos();
        let (x, y) = (0.25 - crank * cos, 0.05 - crank * sin);
        let right = (coupler * coupler - rocker * rocker - x * x - y * y) / (2.0 * rocker);
        // x sin b = right: the solution near b = 0 of the two.
        (right / x).asin()
    };
    let bounds = nominal(&model("spatial_four_bar").observing(&["D.angle", "A.angle", "crank.B.z"]));
    assert!(distance_from(&bounds.times, curve(&bounds, "A.angle"), |t| TAU * t) < CLOSED);
    let off = distance_from(&bounds.times, curve(&bounds, "D.angle"), rocker_angle);
    let case = Case::new("textbook", "spatial four-bar, rocker's angle").source("closure of the loop");
    case.at_most("largest error", off, CLOSED).note();
    assert!(largest(curve(&bounds, "crank.B.z").iter().copied()) < CLOSED);
}

#[test]
fn energy_of_the_spatial_four_bar_equals_motor_work() {
    let description = model("spatial_four_bar").observing(&["energy", "-motor.force*A.angular_velocity"]);
    let runs = [1e-3, 5e-4].map(|h| nominal(&description.clone().step(h).rows_every(1e-3)));
    // Simpson's rule over rows 1 ms apart is exact enough; from 0.1 s on, when the reactions' start has faded.
    let errors = runs.map(|run| {
        let (energy, power) = (curve(&run, "energy"), curve(&run, "-motor.force*A.angular_velocity"));
        let first = row(&run, 0.1);
        let work: f64 = (first..energy.len() - 2)
            .step_by(2)
            .map(|k| 1e-3 / 3.0 * (power[k] + 4.0 * power[k + 1] + power[k + 2]))
            .sum();
        let last = first + (energy.len() - 1 - first) / 2 * 2;
        energy[last] - energy[first] - work
    });
    println!("{errors:?}");
    assert!(errors[1].abs() < 1e-5 && errors[1].abs() < 0.3 * errors[0].abs(), "{errors:?}");
}

/// Lengths a, b and twists α, β with a / sin α = b / sin β: the only loop of four revolute joints in space that moves.
#[test]
fn bennetts_linkage_matches_its_closed_form() {
    let (alpha, beta) = (40_f64.to_radians(), 75_f64.to_radians());
    let a: f64 = 0.3;
    let b = a * beta.sin() / alpha.sin();
    let ratio = (0.5 * (beta + alpha)).sin() / (0.5 * (beta - alpha)).sin();
    // Denavit-Hartenberg angles, with (a, α) behind the first joint: tan(θ₁/2) tan(θ₂/2) = ratio, θ₃ = −θ₁, θ₄ = −θ₂.
    let second = |first: f64| 2.0 * (ratio / (0.5 * first).tan()).atan();
    let start = 1.0_f64;
    let link = |name: &str, length: f64, twist: f64| {
        format!(
            "  {name}: {{ mass: 1, inertia: [0.01, 0.02, 0.02], points: {{ A: [0, 0, 0], \
             B: {{ position: [{length}, 0, 0], rotation: {{ axis: x, angle: {twist} }} }} }} }}\n"
        )
    };
    let text = format!(
        "
parameters: {{ start: {start} rad, rate: 1 rad/s }}
bodies:
  ground: {{ points: {{ A: [0, 0, 0], B: {{ position: [{b}, 0, 0], rotation: {{ axis: x, angle: {beta} }} }} }} }}
{}{}{}joints:
  J1: {{ revolute: [ground.B, one.A] }}
  J2: {{ revolute: [one.B, two.A] }}
  J3: {{ revolute: [two.B, three.A] }}
  J4: {{ revolute: [three.B, ground.A] }}
  motor: {{ equation: J1.angle = start + rate*t }}
guess: {{ J1.angle: {start}, J2.angle: {}, J3.angle: {}, J4.angle: {} }}
outputs: {{ x: one.x }}
simulation: {{ duration: 1.5, step: 1e-2, output_step: 0.05 }}
",
        link("one", a, alpha),
        link("two", b, beta),
        link("three", a, alpha),
        second(start),
        -start,
        -second(start),
    );
    let (bounds, summary) =
        run_methods(&read(&text).observing(&["J1.angle", "J2.angle", "J3.angle", "J4.angle"]), Some(Vec::new()));
    assert_eq!(summary.redundant_constraints.len(), 3, "{:?}", summary.redundant_constraints);
    let mut findings = Findings::default();
    for (k, &t) in bounds.times.iter().enumerate() {
        let first = start + t;
        let wanted = [first, second(first), -first, -second(first)];
        for (output, wanted) in bounds.outputs.iter().zip(wanted) {
            let off = output.nominal[k] - wanted;
            findings
                .check(off.abs() < 1e-8, format_args!("{} at {t}: {} not {wanted}", output.name, output.nominal[k]));
        }
    }
    findings.none();
}

#[test]
fn bricards_mechanism_falls_and_comes_back() {
    // t, the corners P3 and P2.
    let rows = reference("iftomm/bricard.csv");
    let formulas = ["rod3.P3.x", "rod3.P3.y", "rod3.P3.z", "rod3.P2.x", "rod3.P2.y", "rod3.P2.z"];
    let all = [&formulas[..], &["energy"]].concat();
    let description = model("bricard").observing(&all).duration(10.0).rows_every(1e-2);
    let runs = [1e-3, 5e-4].map(|h| nominal(&description.clone().step(h)));
    for (column, name) in formulas.iter().enumerate() {
        let error = |curve: &[f64]| largest(rows.iter().map(|line| curve[row(&runs[0], line[0])] - line[column + 1]));
        let curves = runs.each_ref().map(|run| curve(run, name));
        let (errors, left) = (curves.map(error), error(&richardson(curves[0], curves[1])));
        println!("{name}: {errors:?}, extrapolated {left:.2e}");
        assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1, "{name}: {errors:?}");
        assert!(left < 2e-2 * errors[1], "{name}: {left:e}");
    }
    let energies = runs.each_ref().map(|run| {
        let energy = curve(run, "energy");
        largest(energy.iter().map(|value| value - energy[0]))
    });
    println!("energy {energies:?}");
    assert!(order(energies[0], energies[1]) > 1.9, "{energies:?}");
}

/// The same text, read as a mechanism of the plane and as one of space.
fn both(text: &str) -> [Subject; 2] {
    ["planar", "spatial"].map(|space| read(&format!("space: {space}\n{text}")))
}

#[test]
fn planar_mechanism_moves_equally_in_space() {
    let pair = both(
        "
bodies:
  ground: { points: { guide: [0, 0.05] } }
  crank: { mass: 0.4, inertia: 0.01, points: { A: [-0.1, 0], B: [0.1, 0] } }
  rod: { mass: 0.7, inertia: 0.03, center_of_mass: [0.02, 0.01], points: { B: [-0.25, 0], C: [0.25, 0], D: [0, 0.1] } }
  slider: { mass: 0.5, inertia: 0.001 }
  bob: { mass: 0.2, inertia: 0.002, points: { top: [0, 0.1] } }
  wheel: { mass: 0.3, inertia: 0.004 }
joints:
  pivot: { revolute: [ground, crank.A] }
  pin: { revolute: [crank.B, rod.B] }
  wrist: { revolute: [rod.C, slider] }
  guide: { prismatic: { between: [ground.guide, slider], axis: x, angle: 0.1 } }
  hook: { revolute: [rod.D, bob.top] }
  axle: { revolute: [slider, wheel] }
  mesh: { gear: { between: [pivot, axle], ratio: -1.5 } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  drive: { torque: { on: pivot, value: 0.4*cos(3*t) } }
  coil: { torsional_spring_damper: { on: hook, stiffness: 0.5, damping: 0.01, free_angle: 0.2 } }
  spring: { spring_damper: { between: [ground, bob], stiffness: 20, damping: 0.2, free_length: 0.3 } }
  push: { force: { on: rod.D, value: [1, 0.5], frame: body } }
  mount: { bushing: { between: [ground.guide, slider], stiffness: [5, 0, 0], damping: 0.1, torsional_stiffness: 2 } }
initial: { pivot.angle: 0.6, pivot.angular_velocity: 2, hook.angle: -1.2, hook.angular_velocity: 0 }
guess: { pin.angle: -1 }
outputs: { x: slider.x }
simulation: { duration: 1, step: 1e-3, output_step: 0.01 }
",
    );
    assert_eq!(pair.each_ref().map(|own| own.study().description().space.spatial), [false, true]);
    let formulas = [
        "slider.x",
        "bob.x",
        "rod.D.vy",
        "pivot.angle",
        "axle.angle",
        "guide.displacement",
        "pin.force.x",
        "wrist.force.y",
        "energy",
    ];
    let run = |h: f64| pair.each_ref().map(|model| nominal(&model.clone().observing(&formulas).step(h)));
    let (coarse, fine) = (run(1e-3), run(5e-4));
    let mut findings = Findings::default();
    for name in formulas {
        let size = largest(curve(&fine[0], name).iter().copied());
        // The reactions' errors of the first steps (see `convergence`) have faded after 0.1 s.
        let apart = |runs: &[mbint::results::Bounds; 2]| {
            let [planar, spatial] = runs.each_ref().map(|run| &curve(run, name)[row(run, 0.1)..]);
            largest(planar.iter().zip(spatial).map(|(a, b)| a - b))
        };
        let (coarse, fine) = (apart(&coarse), apart(&fine));
        println!("{name} of {size:.2}: apart {coarse:.1e}, {fine:.1e}");
        findings.check(fine < 1e-4 * size && fine < 0.3 * coarse + 1e-12, format_args!("{name}: {coarse:e}, {fine:e}"));
    }
    findings.none();
}
