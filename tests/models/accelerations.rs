//! Accelerations and reactions at rows of output: of order two down to rounding with fixed steps, and they converge
//! with the tolerance where steps are controlled. Constraints leave ε/h² in those of the steps, and each change of h
//! disturbs them.

use mbint::results::Method;

use crate::common::{Subject, band, curve, distance, distance_from, largest, nominal, order, read, run};

/// A rod on a hinge off its centre, in absolute coordinates: m = 1.5 kg, d = 0.6 m, radius of gyration 0.25 m.
const ROD: &str = "
parameters: { m: { value: 1.5, unit: kg, tolerance: 2% }, r: 0.25 m }
bodies: { rod: { mass: m, inertia: m*r^2, points: { hinge: [-0.6, 0] } } }
joints: { hinge: { revolute: [ground, rod.hinge] } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { rod.angle: -20 deg, rod.angular_velocity: 2 }
outputs:
  angle: rod.angle
  speed: rod.angular_velocity
  alpha: rod.angular_acceleration
  fx: hinge.force.x
  fy: hinge.force.y
simulation: { duration: 0.4, step: 1e-3, output_step: 0.02, formulation: absolute }
bounds: { scan: { points: 3 } }
";

/// A body on a ball joint, tilted against the axes of its frame.
const BALL: &str = "
space: spatial
parameters: { m: { value: 2, unit: kg, tolerance: 2% } }
bodies: { bob: { mass: m, inertia: [0.03, 0.07, 0.08], points: { pivot: [-0.7, 0.1, 0] } } }
joints: { ball: { spherical: [ground, bob.pivot] } }
effects: { weight: { gravity: { acceleration: [0, 0, -9.81] } } }
initial: { bob.orientation: { axis: [1, 2, 0], angle: 30 deg }, bob.omega: [0.4, -0.3, 1.1] }
outputs: { ax: bob.ax, az: bob.az, bx: bob.alpha.x, fx: ball.force.x, fz: ball.force.z }
simulation: { duration: 1, tolerance: 1e-4, output_step: 0.05, formulation: absolute }
bounds: { scan: { points: 3 } }
";

#[test]
fn accelerations_and_reactions_have_no_floor_at_short_steps() {
    let description = read(ROD);
    let runs: Vec<_> =
        (0..7).map(|halvings| nominal(&description.clone().step(5e-4 / f64::from(1 << halvings)))).collect();
    for name in ["alpha", "fx", "fy"] {
        let changes: Vec<f64> =
            runs.windows(2).map(|runs| distance(curve(&runs[0], name), curve(&runs[1], name))).collect();
        println!("{name}: {changes:?}");
        // The last difference is 1e-8 of the largest value.
        for changes in changes.windows(2) {
            let order = order(changes[0], changes[1]);
            assert!((order - 2.0).abs() < 0.1, "{name}: order {order:.2}, {changes:?}");
        }
    }
}

/// d'Alembert with the angle and the speed of the same row.
#[test]
fn reactions_balance_the_motion_of_their_row() {
    let bounds = nominal(&read(ROD).step(1e-5));
    let (m, d, g) = (1.5, 0.6, 9.81);
    let moment = m * (0.25 * 0.25 + d * d);
    for row in 0..bounds.times.len() {
        let at = |name: &str| curve(&bounds, name)[row];
        let (sin, cos) = at("angle").sin_cos();
        let alpha = -m * g * d * cos / moment;
        let [ax, ay] = [-d * (sin * alpha + cos * at("speed").powi(2)), d * (cos * alpha - sin * at("speed").powi(2))];
        // The velocities of the hinge are off by C h².
        for (name, wanted) in [("alpha", alpha), ("fx", m * ax), ("fy", m * (ay + g))] {
            assert!(
                (at(name) - wanted).abs() < 1e-8 * 20.0,
                "{name} at {} s: {} and {wanted}",
                bounds.times[row],
                at(name)
            );
        }
    }
}

fn converge_with_the_tolerance(description: &Subject, size: f64) {
    let exact = nominal(&description.clone().step(2e-5));
    let tolerances = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7];
    for output in exact.outputs.iter().filter(|output| output.name != "angle" && output.name != "speed") {
        let errors = tolerances.map(|tolerance| {
            let bounds = nominal(&description.clone().tolerance(tolerance));
            distance(curve(&bounds, &output.name), &output.nominal) / size
        });
        println!("{}: {errors:?}", output.name);
        for (error, tolerance) in errors.into_iter().zip(tolerances) {
            assert!(error < 30.0 * tolerance, "{} at {tolerance}: {error:e} of its size", output.name);
        }
    }
}

#[test]
#[ignore = "20 s: tolerances over decades"]
fn accelerations_and_reactions_converge_with_the_tolerance() {
    converge_with_the_tolerance(&read(ROD), 20.0);
    converge_with_the_tolerance(&read(BALL), 20.0);
}

#[test]
#[ignore = "10 s: against steps of 20 µs"]
fn the_stated_error_covers_reactions_under_a_tolerance() {
    for text in [ROD, BALL] {
        let description = read(text);
        let exact = run(&description.clone().step(2e-5));
        let bounds = run(&description.tolerance(1e-4));
        for (output, exact) in bounds.outputs.iter().zip(&exact.outputs) {
            let (band, exact) = (band(output, Method::Scan), band(exact, Method::Scan));
            let missed = (0..bounds.times.len()).filter(|&row| {
                let error = (band.lower[row] - exact.lower[row]).abs().max((band.upper[row] - exact.upper[row]).abs());
                error > band.error.total[row] + 1e-9 * largest(output.nominal.iter().copied())
            });
            assert_eq!(missed.count(), 0, "{}", output.name);
        }
    }
}

/// Samples, jets in the parameters and composition from coordinates take accelerations from the same equations.
#[test]
fn all_methods_agree_on_reactions() {
    let text = ROD.replace(
        "bounds: { scan: { points: 3 } }",
        "bounds: { scan: { points: 41 }, chebyshev: { order: 6 }, taylor: { order: 6 } }",
    );
    let bounds = run(&read(&text));
    for output in &bounds.outputs {
        let scan = band(output, Method::Scan);
        for method in [Method::Chebyshev, Method::Taylor] {
            let band = band(output, method);
            let off = distance(&band.lower, &scan.lower).max(distance(&band.upper, &scan.upper));
            assert!(
                off < 1e-6 * largest(output.nominal.iter().copied()),
                "{} by {}: {off:e}",
                output.name,
                method.name()
            );
        }
    }
}

/// Nothing moves on its own here, so that positions have no local errors and steps are as long as rows allow.
#[test]
fn velocities_of_a_driven_mechanism_follow_the_tolerance() {
    let text = "
parameters: { l: { value: 0.2, unit: m, tolerance: 1% } }
bodies:
  crank: { mass: 0.4, inertia: 0.002, points: { end: [l, 0] } }
  rod: { mass: 0.7, inertia: 0.01, points: { a: [-0.35, 0], b: [0.35, 0] } }
  slider: { mass: 0.5, coordinates: [x] }
joints:
  o: { revolute: [ground, crank] }
  a: { revolute: [crank.end, rod.a] }
  b: { revolute: [rod.b, slider] }
  drive: { equation: 'crank.angle = 9*t' }
guess: { slider.x: 0.9, rod.x: 0.55 }
outputs: { x: slider.x, v: slider.vx, a: slider.ax }
simulation: { duration: 1, tolerance: 1e-5, output_step: 0.02, formulation: absolute }
bounds: { scan: { points: 3 } }
";
    let bounds = nominal(&read(text));
    let (omega, l, rod) = (9.0, 0.2, 0.7);
    let x = |t: f64| {
        let (sin, cos) = (omega * t).sin_cos();
        l * cos + (rod * rod - l * l * sin * sin).sqrt()
    };
    let exact = |t: f64| {
        let (sin, cos) = (omega * t).sin_cos();
        -l * omega * sin - l * l * omega * sin * cos / (rod * rod - l * l * sin * sin).sqrt()
    };
    let off = [
        distance_from(&bounds.times, curve(&bounds, "x"), x),
        distance_from(&bounds.times, curve(&bounds, "v"), exact),
    ];
    println!("{off:?}");
    assert!(off[0] < 1e-9 && off[1] < 1e-9, "{off:?}");
}

/// A pendulum on a ball joint swings in a plane: the reaction across it is rounding, which is no output that is lost.
#[test]
fn reaction_of_rounding_errors_is_reliable() {
    let text = "
bodies:
  ground: { points: { J: { position: [1, 2, 3], rotation: { axis: x, angle: -50 deg } } } }
  bob: { mass: 1.3, inertia: [0.05, 0.12, 0.12], points: { J: [-1.7, 0, 0] } }
joints: { ball: { spherical: [ground.J, bob.J] } }
effects: { weight: { gravity: { acceleration: [0, 0, -9.81] } } }
initial: { bob.orientation: { axis: x, angle: -50 deg }, bob.omega: [0, 0, 0] }
outputs: { x: ball.force.x, y: ball.force.y, z: ball.force.z }
simulation: { duration: 5, tolerance: 1e-6, output_step: 0.1 }
bounds: { scan: { points: 2 } }
";
    let bounds = run(&read(text));
    assert!(largest(curve(&bounds, "y").iter().copied()) < 1e-10);
    for output in &bounds.outputs {
        let unresolved = &band(output, Method::Scan).error.unresolved;
        assert!(!unresolved.contains(&true), "{}: {:?}", output.name, unresolved.iter().position(|&lost| lost));
    }
}
