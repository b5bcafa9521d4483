//! Friction in joints, against closed forms and against the same mechanics written down another way.
//!
//! The smooth law is short of Coulomb's by the share ½ (u₀/u)²: the bounds of errors below follow from that.

use mbint::results::Method;

use crate::common::power::{assert_balance, pair};
use crate::common::{
    Findings, band, curve, distance, distance_from, largest, nominal, output, read, richardson, row, run,
};

/// On a slope: s̈ = g (sin β − μ cos β), down and up.
#[test]
fn friction_on_an_incline_follows_the_normal_force() {
    let (beta, mu): (f64, f64) = (30.0_f64.to_radians(), 0.3);
    for speed in [1.0_f64, -3.0] {
        let bounds = nominal(&read(&format!(
            "
parameters: {{ slope: 30 deg, g: 9.81, mu: {mu} }}
bodies: {{ box: {{ mass: 4, inertia: 0.2 }} }}
joints: {{ slide: {{ prismatic: {{ between: [ground, box], axis: [cos(slope), -sin(slope)] }} }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -g] }} }}
  rubbing: {{ joint_friction: {{ on: slide, coefficient: mu, transition_velocity: 1e-5 }} }}
initial: {{ box.x: 0, box.vx: {speed}*cos(slope) }}
outputs:
  along: box.x*cos(slope) - box.y*sin(slope)
  load: rubbing.load
  friction: rubbing.force
simulation: {{ duration: 0.3, step: 1e-3, output_step: 0.01 }}
"
        )));
        let acceleration = 9.81 * (beta.sin() - speed.signum() * mu * beta.cos());
        let error = distance_from(&bounds.times, curve(&bounds, "along"), |t| speed * t + 0.5 * acceleration * t * t);
        // ½ (1e-5/1)² of 10 m/s² for 0.3 s is 5e-11 m.
        assert!(error < 1e-9, "{speed}: {error:e}");
        let normal = 4.0 * 9.81 * beta.cos();
        assert!(distance_from(&bounds.times, curve(&bounds, "load"), |_| normal) < 1e-7);
        assert!(distance_from(&bounds.times, curve(&bounds, "friction"), |_| -speed.signum() * mu * normal) < 1e-7);
    }
}

/// A pendulum whose pin rubs: the load hangs on the acceleration, which hangs on the friction. The same two equations,
/// solved by iteration and integrated by Runge and Kutta's scheme.
#[test]
fn pendulum_with_pin_friction_matches_runge_kutta() {
    let (m, l, inertia, g, mu, r, u0) = (2.0_f64, 0.4_f64, 0.05_f64, 9.81_f64, 0.4_f64, 0.05_f64, 0.05_f64);
    let description = read(&format!(
        "
bodies: {{ rod: {{ mass: {m}, inertia: {inertia}, points: {{ pin: [-{l}, 0] }} }} }}
joints: {{ pin: {{ revolute: [ground, rod.pin] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -{g}] }} }}
  rubbing: {{ joint_friction: {{ on: pin, coefficient: {mu}, radius: {r}, transition_velocity: {u0} }} }}
initial: {{ rod.angle: 0, rod.angular_velocity: 0 }}
outputs: {{ angle: rod.angle, load: rubbing.load }}
simulation: {{ duration: 2, step: 1e-3, output_step: 0.01 }}
"
    ));
    // θ from the horizontal; centre at l (cos θ, sin θ). N accelerates the rod and carries its weight.
    let load = |theta: f64, omega: f64, alpha: f64| {
        let (s, c) = theta.sin_cos();
        let x = m * l * (-alpha * s - omega * omega * c);
        let y = m * l * (alpha * c - omega * omega * s) + m * g;
        x.hypot(y)
    };
    let acceleration = |theta: f64, omega: f64| {
        let mut alpha = 0.0;
        for _ in 0..60 {
            let torque = -mu * r * load(theta, omega, alpha) * omega / (omega * omega + u0 * u0).sqrt();
            alpha = (torque - m * g * l * theta.cos()) / (inertia + m * l * l);
        }
        alpha
    };
    let rhs = |[theta, omega]: [f64; 2]| [omega, acceleration(theta, omega)];
    let mut state = [0.0, 0.0];
    let (h, mut exact) = (1e-4, vec![0.0]);
    for step in 1..=20_000 {
        let at = |k: [f64; 2], c: f64| [state[0] + c * h * k[0], state[1] + c * h * k[1]];
        let k1 = rhs(state);
        let k2 = rhs(at(k1, 0.5));
        let k3 = rhs(at(k2, 0.5));
        let k4 = rhs(at(k3, 1.0));
        for i in 0..2 {
            state[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
        if step % 100 == 0 {
            exact.push(state[0]);
        }
    }
    let runs = [1e-3, 5e-4].map(|h| nominal(&description.clone().step(h)));
    let errors = [&runs[0], &runs[1]].map(|run| distance(curve(run, "angle"), &exact));
    let order = crate::common::order(errors[0], errors[1]);
    println!("errors {errors:?}, order {order:.2}");
    assert!((order - 2.0).abs() < 0.1, "{order}: {errors:?}");
    let left = distance(&richardson(curve(&runs[0], "angle"), curve(&runs[1], "angle")), &exact);
    assert!(left < 1e-7, "{left:e}");
}

/// A drawer that is pulled off its middle: the couple F e presses on both ends of a guide of length L, and
/// m a = F (1 − 2 μ e/L).
#[test]
fn couple_on_its_guide_brakes_a_drawer() {
    let (force, arm, length, mu, m) = (10.0, 0.15, 0.3, 0.4, 2.0);
    let bounds = nominal(&read(&format!(
        "
bodies: {{ drawer: {{ mass: {m}, inertia: 0.1, points: {{ knob: [0, {arm}] }} }} }}
joints: {{ guide: {{ prismatic: {{ between: [ground, drawer], axis: x }} }} }}
effects:
  pull: {{ force: {{ on: drawer.knob, value: [{force}, 0] }} }}
  rubbing: {{ joint_friction: {{ on: guide, coefficient: {mu}, length: {length}, transition_velocity: 1e-6 }} }}
initial: {{ drawer.x: 0, drawer.vx: 0.1 }}
outputs: {{ x: drawer.x, load: rubbing.load }}
simulation: {{ duration: 0.5, step: 1e-3, output_step: 0.01 }}
"
    )));
    let acceleration = force * (1.0 - 2.0 * mu * arm / length) / m;
    let error = distance_from(&bounds.times, curve(&bounds, "x"), |t| 0.1 * t + 0.5 * acceleration * t * t);
    assert!(error < 1e-8, "{error:e}");
    assert!(distance_from(&bounds.times, curve(&bounds, "load"), |_| 2.0 * force * arm / length) < 1e-6);
}

/// A sleeve that slides and turns on a horizontal shaft: friction opposes the velocity of its surface, so with J = m r²
/// that velocity keeps its direction and falls by μ g.
#[test]
fn a_sleeve_slides_and_turns_against_one_friction() {
    let (r, mu, v, w) = (0.05, 0.15, 0.8, 12.0);
    let description = read(&format!(
        "
bodies: {{ sleeve: {{ mass: 2, inertia: [2*{r}^2, 0.01, 0.01] }} }}
joints: {{ shaft: {{ cylindrical: {{ between: [ground, sleeve], axis: x }} }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }}
  rubbing: {{ joint_friction: {{ on: shaft, coefficient: {mu}, radius: {r}, transition_velocity: 1e-5 }} }}
initial: {{ sleeve.x: 0, sleeve.vx: {v}, shaft.angle: 0, shaft.angular_velocity: {w} }}
outputs: {{ x: sleeve.x, angle: shaft.angle, load: rubbing.load }}
simulation: {{ duration: 0.5, step: 1e-3, output_step: 0.01 }}
"
    ));
    let runs = [1e-3, 5e-4].map(|h| nominal(&description.clone().step(h)));
    let speed = f64::hypot(v, r * w);
    let way = |t: f64| t - 0.5 * mu * 9.81 / speed * t * t;
    let mut findings = Findings::default();
    for (name, initial) in [("x", v), ("angle", w)] {
        // The scheme turns a body by Euler parameters with an error of second order.
        let curves = runs.each_ref().map(|run| curve(run, name));
        let error = distance_from(&runs[0].times, &richardson(curves[0], curves[1]), |t| initial * way(t));
        findings.check(error < 1e-7, format_args!("{name} is off by {error:e}"));
    }
    let error = distance_from(&runs[0].times, curve(&runs[0], "load"), |_| 2.0 * 9.81);
    findings.check(error < 1e-3, format_args!("load is off by {error:e}"));
    findings.none();
}

/// The friction itself uncertain: expanded coordinates, with the load from the closure, and Taylor's polynomials agree
/// with a scan.
#[test]
fn uncertain_friction_is_bounded_by_all_methods() {
    let bounds = run(&read(
        "
parameters: { mu: { value: 0.3, tolerance: 20% } }
bodies: { rod: { mass: 2, inertia: 0.05, points: { pin: [-0.4, 0] } } }
joints: { pin: { revolute: [ground, rod.pin] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  rubbing: { joint_friction: { on: pin, coefficient: mu, radius: 0.05, transition_velocity: 0.5 } }
initial: { rod.angle: 0, rod.angular_velocity: 0 }
outputs: { angle: rod.angle, load: rubbing.load, torque: rubbing.torque }
simulation: { duration: 1, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 5 }, taylor: { order: 4 }, scan: { points: 21 } }
",
    ));
    for name in ["angle", "load", "torque"] {
        let found = output(&bounds, name);
        let scan = band(found, Method::Scan);
        let widest = largest(scan.upper.iter().zip(&scan.lower).map(|(upper, lower)| upper - lower));
        for method in [Method::Chebyshev, Method::Taylor] {
            let band = band(found, method);
            let late = row(&bounds, 0.1)..bounds.times.len();
            let apart = late.map(|row| {
                f64::max((band.upper[row] - scan.upper[row]).abs(), (band.lower[row] - scan.lower[row]).abs())
            });
            let apart = largest(apart);
            println!("{name}: {method:?} is {apart:.2e} from a scan {widest:.2e} wide");
            assert!(apart < 0.02 * widest, "{name}: {method:?} is {apart:e} off, of {widest:e}");
        }
    }
}

#[test]
fn dissipated_power_is_torque_times_rate() {
    assert_balance(
        &pair(
            "  j: { revolute: [a.P, b.P] }",
            "  e: { joint_friction: { on: j, coefficient: 0.3, radius: 0.1, transition_velocity: 0.1 } }",
            "  j.angle: 0.3\n  j.angular_velocity: -0.8",
        ),
        "e.torque*j.angular_velocity",
    );
}
