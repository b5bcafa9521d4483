//! Models whose steps are not fixed ones of HHT-I3: the C repeats samples of `mbint sample`, which another program of
//! another language computes.

use std::fs;
use std::process::Command;

use super::{OTHER_START, columns};
use crate::place::Place;

/// Asserts that the C of a model has the motion of `mbint sample` at three points of its parameters, to 1e-9 of each
/// output's largest value.
fn repeats_samples(place: &Place, model: &str) {
    fs::write(place.path().join("own.yaml"), model).unwrap();
    place.run("export own.yaml --c -o own", 0);
    place.run("sample own.yaml --design sobol:3 -o samples.csv", 0);
    let samples = columns(&fs::read_to_string(place.path().join("samples.csv")).unwrap());
    let folder = place.path().join("own");
    fs::write(folder.join("host.c"), OTHER_START.replace("NAME", "own").replace("PREFIX", "own")).unwrap();
    let compiled = Command::new("gcc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O0", "-o", "motion", "host.c", "own.c", "-lm"])
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(compiled.status.success(), "{model}: {}", String::from_utf8_lossy(&compiled.stderr));
    let time = samples.iter().position(|(name, _)| name == "t").unwrap();
    let rows = samples[0].1.iter().filter(|number| **number == 0.0).count();
    for sample in 0..3 {
        let point: Vec<String> = (1..time).map(|own| format!("{:?}", samples[own].1[sample * rows])).collect();
        let found = Command::new(folder.join("motion")).args(&point).output().unwrap();
        assert!(found.status.success(), "{model}: {:?}", found.status);
        let found = columns(&String::from_utf8(found.stdout).unwrap());
        assert!(found.len() > 1, "{model}");
        for (output, values) in &found[1..] {
            let (_, expected) = samples.iter().find(|(own, _)| own == output).unwrap();
            let expected = &expected[sample * rows..][..rows];
            assert_eq!(values.len(), rows, "{model}");
            let size = expected.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
            let off = values.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off <= 1e-9 * size, "{model}, sample {sample}: {output} is off by {off} of {size}");
        }
    }
}

/// An arm under a digital controller with an integral, whose period is no multiple of the steps.
const CONTROLLER: &str = "model: own
parameters: { T: { value: 10 ms }, l: 0.5 m ± 1%, kp: 40 N*m ± 5% }
bodies: { arm: { mass: 2, inertia: 0.05, points: { top: [0, l/2] } } }
joints: { elbow: { revolute: [ground, arm.top] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  integral: { sampled: { input: integral + T*(0.5 - elbow.angle), period: T } }
  command: { sampled: { input: kp*(0.5 - elbow.angle) + 60 N*m/s*integral - 4 N*m*s*elbow.angular_velocity, period: T } }
  drive: { torque: { on: elbow, value: command } }
initial: { elbow.angle: 0.1, elbow.angular_velocity: 0 }
outputs: { angle: elbow.angle, command: command, force: elbow.force.x }
simulation: { duration: 0.3, STEPS, output_step: 0.03 }
";

#[test]
fn digital_controllers_match_samples() {
    let place = Place::new();
    for steps in [
        "step: 3e-3",
        "step: 3e-3, extrapolation: 2",
        "tolerance: 1e-5, scheme: hht",
        "tolerance: 1e-7, scheme: explicit",
    ] {
        repeats_samples(&place, &CONTROLLER.replace("STEPS", steps));
    }
}

/// A ball that bounces on a floor and is damped there, with a jump of the force at a time.
const BALL: &str = "model: own
parameters: { k: 2e4 N/m ± 5%, h: 0.3 m ± 2% }
bodies: { ball: { mass: 1, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  floor: { force: { on: ball, value: [0, \"k*max(0, 0.1 m - ball.y)*(1 - 0.3 s/m*ball.vy)\"] } }
  wind: { force: { on: ball, value: [0, \"if(t < 0.5 s, 1 N, 0 N)\"] } }
initial: { ball.y: h, ball.vy: 0 }
outputs: { y: ball.y, v: ball.vy, a: ball.ay }
simulation: { duration: 1, STEPS, output_step: 0.02 }
";

#[test]
fn steps_at_events_match_samples() {
    let place = Place::new();
    for steps in ["tolerance: 1e-4, scheme: hht", "tolerance: 1e-4, extrapolation: 2"] {
        repeats_samples(&place, &BALL.replace("STEPS", steps));
    }
}

/// Constraints, with reactions and accelerations of rows.
#[test]
fn steps_of_linkages_match_samples() {
    let place = Place::new();
    let own = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/models/slider_crank.yaml")).unwrap();
    let own = own.split("outputs:").next().unwrap().replace("slider_crank", "own");
    for steps in ["tolerance: 1e-4, scheme: hht", "tolerance: 1e-6, scheme: explicit", "step: 5e-3, extrapolation: 3"] {
        let more = format!(
            "outputs: {{ x: slider.x, v: slider.vx, a: slider.ax, force: pin.force.y }}
simulation: {{ duration: 1, {steps}, output_step: 0.04 }}
"
        );
        repeats_samples(&place, &format!("{own}{more}"));
    }
}

/// A linkage that hangs on springs, and an arm whose controller holds it by an integral.
const AT_REST: [&str; 2] = [
    "model: own
parameters: { k: 200 N/m ± 10%, load: 2 kg ± 10%, l: 0.3 m ± 3% }
bodies:
  bar: { mass: load, inertia: load*l^2/12, points: { A: [-l/2, 0], B: [l/2, 0] } }
  slider: { mass: 0.5, coordinates: [x, y] }
joints: { pivot: { revolute: [ground, bar.A] }, pin: { revolute: [bar.B, slider] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  spring: { spring_damper: { between: [ground, slider], stiffness: k, damping: 3 N*s/m, free_length: 0.1 } }
  turn: { torsional_spring_damper: { on: pivot, stiffness: 6, damping: 0.1 } }
  push: { force: { on: slider, value: [2 N*sin(5*t), 0] } }
initial: equilibrium
outputs: { angle: bar.angle, x: slider.x, force: pin.force.y, a: slider.ay }
simulation: { duration: 0.5, STEPS, output_step: 0.05 }
",
    "model: own
parameters: { load: 2 kg ± 20%, kp: 40 N*m ± 10% }
bodies: { arm: { mass: load, inertia: 0.05, points: { top: [-0.3, 0] } } }
joints: { elbow: { revolute: [ground, arm.top] } }
states:
  integral: { rate: 0.3 - elbow.angle, initial: 0 }
  lagged: { rate: (kp*(0.3 - elbow.angle) + 30 N*m/s*integral - lagged)/(20 ms), initial: 0 N*m }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  drive: { torque: { on: elbow, value: lagged - 3 N*m*s*elbow.angular_velocity + 2 N*m*sin(4*t) } }
initial: equilibrium
outputs: { angle: elbow.angle, torque: lagged, integral: integral }
simulation: { duration: 0.5, STEPS, output_step: 0.05 }
",
];

#[test]
fn equilibria_at_other_parameters_match_samples() {
    let place = Place::new();
    for (model, steps) in [(0, "step: 2e-3"), (0, "tolerance: 1e-6, scheme: explicit"), (1, "step: 2e-3")] {
        repeats_samples(&place, &AT_REST[model].replace("STEPS", steps));
    }
}

/// A parallelogram becomes flat with the nominal crank: the first sample passes a singular configuration.
#[test]
fn motions_through_singular_configurations_match_samples() {
    let model = "model: own
parameters: { l: 1 m ± 1% }
bodies:
  ground: { points: { b: [2, 0] } }
  one: { mass: 1, inertia: 0.1, points: { A: [0, 0], B: [l, 0] } }
  two: { mass: 1, inertia: 0.1, points: { A: [0, 0], B: [1, 0] } }
  rod: { mass: 1, inertia: 0.3, points: { A: [0, 0], B: [2, 0] } }
joints:
  p: { revolute: [ground, one.A] }
  q: { revolute: [ground.b, two.A] }
  r: { revolute: [one.B, rod.A] }
  s: { revolute: [two.B, rod.B] }
initial: { one.angle: 1.2, one.angular_velocity: -3 }
outputs: { a: one.angle, b: two.angle }
simulation: { duration: 1, STEPS, output_step: 0.02 }
";
    let place = Place::new();
    for steps in ["step: 1e-3", "tolerance: 1e-5, scheme: hht"] {
        repeats_samples(&place, &model.replace("STEPS", steps));
    }
}

/// A mass under a force held between samples moves by its difference equation: from instant to instant by parabolas.
#[test]
fn a_held_force_moves_a_mass_by_its_difference_equation() {
    let model = "model: own
parameters: { T: { value: 25 ms }, load: 2 kg ± 1% }
bodies: { mass: { mass: load, coordinates: [x] } }
effects:
  command: { sampled: { input: \"-30 N/m*mass.x - 6 N*s/m*mass.vx\", period: T } }
  push: { force: { on: mass, value: [command, 0] } }
initial: { mass.x: 0.5, mass.vx: 0 }
outputs: { x: mass.x, v: mass.vx }
simulation: { duration: 2, STEPS, output_step: 0.1 }
";
    let place = Place::new();
    for steps in ["step: 0.02", "tolerance: 1e-3, scheme: hht"] {
        fs::write(place.path().join("own.yaml"), model.replace("STEPS", steps)).unwrap();
        place.run("export own.yaml --c -o own", 0);
        let folder = place.path().join("own");
        let compiled = Command::new("gcc")
            .args(["-std=c99", "-O0", "-o", "motion", "own.c", "own_main.c", "-lm"])
            .current_dir(&folder)
            .output()
            .unwrap();
        assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
        let found = Command::new(folder.join("motion")).output().unwrap();
        let found = columns(&String::from_utf8(found.stdout).unwrap());
        let (mut x, mut v) = (0.5, 0.0);
        assert_eq!(found[1].1.len(), 21, "{steps}");
        for row in 0..21 {
            assert!((found[1].1[row] - x).abs() < 1e-12, "{steps}, row {row}: {} {x}", found[1].1[row]);
            assert!((found[2].1[row] - v).abs() < 1e-11, "{steps}, row {row}: {} {v}", found[2].1[row]);
            for _ in 0..4 {
                let (a, h) = ((-30.0 * x - 6.0 * v) / 2.0, 0.025);
                (x, v) = (x + h * v + h * h / 2.0 * a, v + h * a);
            }
        }
    }
}
