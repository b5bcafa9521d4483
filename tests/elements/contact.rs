//! Contacts, stops and loose joints, against the mechanics of impact.

use crate::common::power::{APART, assert_balance, pair};
use crate::common::restitution::restitution;
use crate::common::{Subject, curve, distance_from, largest, nominal, order, read, row};
use mbint::results::Bounds;

fn ball(impact: &str) -> Subject {
    read(&format!(
        "
bodies:
  ball: {{ mass: 1, inertia: 0.004, coordinates: [y] }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  floor: {{ contact: {{ between: [ground, ball], plane: y, radius: 0.1, impact: {impact} }} }}
initial: {{ ball.y: 1.1, ball.vy: 0 }}
outputs: {{ height: ball.y - 0.1, speed: ball.vy, gap: floor.gap, force: floor.force, energy: energy }}
simulation: {{ duration: 1.3, step: 1e-4, output_step: 1e-4 }}
"
    ))
}

/// The highest point between two times.
fn top(bounds: &Bounds, from: f64, to: f64) -> f64 {
    curve(bounds, "height")[row(bounds, from)..row(bounds, to)].iter().copied().fold(0.0, f64::max)
}

/// A ball on a Hertzian floor that takes nothing: the energy is m g h throughout, the depth δ with K δ^2.5/2.5 = m g
/// (h + δ), the force the weight where it stays.
#[test]
fn an_elastic_ball_keeps_its_energy() {
    let description = ball("{ stiffness: 1e6 }");
    let runs = [1e-4, 5e-5].map(|h| nominal(&description.clone().step(h)));
    let errors = runs.each_ref().map(|run| distance_from(&run.times, curve(run, "energy"), |_| 1.1 * 9.81));
    println!("energy off by {errors:?}");
    assert!(errors[1] < 0.01, "{errors:?}");
    assert!(order(errors[0], errors[1]) > 1.8, "{errors:?}");
    let mut depth: f64 = 0.01;
    for _ in 0..50 {
        depth = (2.5 * 9.81 * (1.0 + depth) / 1e6_f64).powf(0.4);
    }
    let deepest = -runs[1]
        .outputs
        .iter()
        .find(|output| output.name == "gap")
        .unwrap()
        .nominal
        .iter()
        .copied()
        .fold(0.0, f64::min);
    assert!((deepest - depth).abs() < 1e-3 * depth, "{deepest} {depth}");
    assert!((top(&runs[1], 0.6, 1.3) - 1.0).abs() < 1e-3);
}

/// An impact without weight, at 2 m/s: the restitution depends on d = χ v alone, and the speed after the impact
/// converges to it.
#[test]
fn restitution_follows_from_the_dissipation() {
    for (impact, d) in [
        ("{ stiffness: 1e6 }", 1e-9),
        ("{ stiffness: 1e6, dissipation: 0.5 }", 1.0),
        ("{ stiffness: 1e5, dissipation: 5 }", 10.0),
        ("{ stiffness: 1e6, restitution: 0.8, impact_velocity: 2, law: hunt_crossley }", 1.5 * 0.2),
        ("{ stiffness: 1e6, restitution: 0.8, impact_velocity: 2, law: lankarani_nikravesh }", 0.75 * 0.36),
        ("{ stiffness: 1e8, exponent: 2, restitution: 0.5, impact_velocity: 2, law: hunt_crossley }", 1.5 * 0.5),
        ("{ stiffness: 1e4, exponent: 1, restitution: 0.9, impact_velocity: 2, law: hunt_crossley }", 1.5 * 0.1),
    ] {
        let description = read(&format!(
            "
bodies: {{ ball: {{ mass: 1, coordinates: [y] }} }}
effects: {{ floor: {{ contact: {{ between: [ground, ball], plane: y, impact: {impact} }} }} }}
initial: {{ ball.y: 0.01, ball.vy: -2 }}
outputs: {{ speed: ball.vy }}
simulation: {{ duration: 0.2, step: 1e-4, output_step: 0.01 }}
"
        ));
        let expected = restitution(d);
        let errors = [1e-4, 5e-5, 2.5e-5].map(|h| {
            let bounds = nominal(&description.clone().step(h));
            (curve(&bounds, "speed").last().unwrap() / 2.0 - expected).abs()
        });
        println!("{impact}: {expected:.5}, off by {errors:?}");
        assert!(errors[2] < 1e-3 && errors[2] < 0.5 * errors[0], "{impact}: {errors:?}");
    }
}

/// If no law of the literature is named, an impact at that speed has the given restitution, whatever the exponent.
#[test]
fn impact_has_the_given_restitution() {
    for (restitution, keys) in [(1.0, ""), (0.9, ""), (0.8, ", exponent: 1"), (0.5, ", exponent: 2"), (0.15, "")] {
        let description = read(&format!(
            "
parameters: {{ e: {restitution} }}
bodies: {{ ball: {{ mass: 1, coordinates: [y] }} }}
effects:
  floor:
    contact: {{ between: [ground, ball], plane: y, impact: {{ stiffness: 1e6, restitution: e, impact_velocity: 2{keys} }} }}
initial: {{ ball.y: 0.01, ball.vy: -2 }}
outputs: {{ speed: ball.vy }}
simulation: {{ duration: 0.2, step: 2e-5, output_step: 0.01 }}
"
        ));
        let left = curve(&nominal(&description), "speed").last().unwrap() / 2.0;
        assert!((left - restitution).abs() < 1e-3, "{restitution}: {left}");
    }
}

/// The ball comes to rest at the depth at which the floor carries it, and the run stays stable.
#[test]
fn a_ball_comes_to_rest() {
    let description = ball("{ stiffness: 1e6, dissipation: 2 }").duration(3.0);
    let rest = (9.81_f64 / 1e6).powf(2.0 / 3.0);
    for h in [1e-3, 5e-4] {
        let bounds = nominal(&description.clone().step(h).rows_every(1e-3));
        let late = row(&bounds, 2.9);
        let heights = &curve(&bounds, "height")[late..];
        assert!(largest(heights.iter().map(|height| height + rest)) < 1e-6, "{h}: {:?}", heights.last());
        assert!((curve(&bounds, "force").last().unwrap() - 9.81).abs() < 1e-3);
    }
}

/// It slides on the plane, and friction brings it to roll: v = 5/7 v₀ of a ball, at t = 2 v₀/(7 μ g).
#[test]
fn a_sliding_ball_comes_to_roll() {
    let (v, mu, r, m) = (2.0, 0.2, 0.1, 1.0);
    let inertia = 0.4 * m * r * r;
    let rest = (9.81_f64 / 1e6).powf(2.0 / 3.0);
    let description = read(&format!(
        "
bodies: {{ ball: {{ mass: {m}, inertia: {inertia} }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  floor:
    contact:
      between: [ground, ball]
      plane: y
      radius: {r}
      impact: {{ stiffness: 1e6, dissipation: 1 }}
      friction: {{ coefficient: {mu}, transition_velocity: 1e-4 }}
initial: {{ ball.x: 0, ball.y: {}, ball.angle: 0, ball.vx: {v}, ball.vy: 0, ball.angular_velocity: 0 }}
outputs: {{ v: ball.vx, spin: ball.angular_velocity, friction: floor.friction }}
simulation: {{ duration: 0.5, step: 2e-4, output_step: 0.01 }}
",
        r - rest
    ));
    let bounds = nominal(&description);
    let rolls = 2.0 * v / (7.0 * mu * 9.81);
    let speed = |t: f64| v - mu * 9.81 * t.min(rolls);
    let error = distance_from(&bounds.times, curve(&bounds, "v"), speed);
    assert!(error < 1e-3, "{error:e}");
    let late = row(&bounds, 0.45);
    assert!((curve(&bounds, "v")[late] - 5.0 / 7.0 * v).abs() < 2e-4);
    assert!((curve(&bounds, "spin")[late] + 5.0 / 7.0 * v / r).abs() < 1e-2);
    assert!(
        (curve(&bounds, "friction")[row(&bounds, 0.1)] + mu * 9.81 * m).abs() < 1e-3,
        "{}",
        curve(&bounds, "friction")[row(&bounds, 0.1)]
    );
}

/// Two balls of one mass that meet head on exchange their velocities; in space, and along any line.
#[test]
fn equal_balls_exchange_their_velocities() {
    let bounds = nominal(&read(
        "
space: spatial
bodies:
  a: { mass: 0.2, inertia: 1e-4 }
  b: { mass: 0.2, inertia: 1e-4 }
effects:
  meeting: { contact: { between: [a, b], circle: 0.03, radius: 0.02, impact: { stiffness: 1e6 } } }
initial:
  a.x: 0
  a.y: 0
  a.z: 0
  a.vx: 1
  a.vy: 2
  a.vz: -2
  b.x: 0.1
  b.y: 0.2
  b.z: -0.2
  b.vx: 0
  b.vy: 0
  b.vz: 0
outputs: { a: sqrt(a.vx^2 + a.vy^2 + a.vz^2 + 1e-30), bx: b.vx, by: b.vy, bz: b.vz }
simulation: { duration: 0.15, step: 2e-5, output_step: 0.01 }
bounds: { chebyshev: { order: 1 } }
",
    ));
    assert!(curve(&bounds, "a").last().unwrap().abs() < 1e-4, "{:?}", curve(&bounds, "a").last());
    for (name, speed) in [("bx", 1.0), ("by", 2.0), ("bz", -2.0)] {
        assert!((curve(&bounds, name).last().unwrap() - speed).abs() < 1e-4);
    }
}

/// A small cylinder that swings in a hollow one without friction is a pendulum of length R − r + δ.
#[test]
fn a_cylinder_in_a_bowl_swings() {
    for (space, axis) in [("planar", ""), ("spatial", ", axis: z")] {
        let description = read(&format!(
            "
space: {space}
bodies: {{ roll: {{ mass: 1, inertia: 0.01 }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  bowl:
    contact: {{ between: [ground, roll], hollow: 0.6, radius: 0.1{axis}, impact: {{ stiffness: 1e8, dissipation: 3 }} }}
initial: {{ roll.x: 0.01, roll.y: -0.49990, roll.vx: 0, roll.vy: 0 }}
outputs: {{ x: roll.x, gap: bowl.gap }}
simulation: {{ duration: 1.4186, step: 2e-4, output_step: 0.0002 }}
"
        ));
        let bounds = nominal(&description);
        // T = 2π √(L/g) (1 + φ²/16), φ = 0.02.
        let period = std::f64::consts::TAU * (0.5_f64 / 9.81).sqrt() * (1.0 + 2.5e-5);
        let (x, quarter) = (curve(&bounds, "x"), 0.25 * period);
        let crossing = x.iter().position(|x| *x < 0.0).unwrap();
        let time = bounds.times[crossing - 1] + 2e-4 * x[crossing - 1] / (x[crossing - 1] - x[crossing]);
        assert!((time - quarter).abs() < 1e-3 * quarter, "{space}: {time} {quarter}");
        assert!((x.last().unwrap() - 0.01).abs() < 1e-4, "{space}: {:?}", x.last());
    }
}

/// Step control passes through impacts: it takes small steps in them, keeps the energy better than its tolerance asks
/// for at large ones, and converges as the tolerance falls.
#[test]
fn step_control_resolves_impacts() {
    let description = ball("{ stiffness: 1e6 }").rows_every(1e-2);
    let errors = [1e-5, 1e-6, 1e-7].map(|tolerance| {
        let bounds = nominal(&description.clone().tolerance(tolerance));
        distance_from(&bounds.times, curve(&bounds, "energy"), |_| 1.1 * 9.81) / (1.1 * 9.81)
    });
    println!("{errors:?}");
    assert!(errors[2] < 1e-3 && errors[2] < errors[0], "{errors:?}");
}

/// Surfaces that are deep in one another all the time.
#[test]
fn stored_energy_of_elastic_surfaces_equals_work_done() {
    assert_balance(
        &pair(
            "",
            "  e: { contact: { between: [a.P, b.P], plane: [1, 2], radius: 3, impact: { stiffness: 50 } } }",
            APART,
        ),
        "0",
    );
    assert_balance(
        &pair(
            "",
            "  e: { contact: { between: [a.P, b.P], circle: 3, radius: 0.9, impact: { stiffness: 20 } } }",
            APART,
        ),
        "0",
    );
    assert_balance(
        &pair(
            "",
            "  e: { contact: { between: [a.P, b.P], hollow: 0.91, radius: 0.9, impact: { stiffness: 20 } } }",
            APART,
        ),
        "0",
    );
}
