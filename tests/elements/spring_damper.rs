//! Springs and dampers: oscillators with closed forms, characteristics by formula and table, MSC Adams.

use std::fmt::Write as _;

use crate::common::adams::{Case, compared_with_adams};
use crate::common::closed_forms::assert_converges;
use crate::common::power::{APART, APART_IN_SPACE, assert_balance, pair, spatial_pair};
use crate::common::{curve, distance_from, nominal, read};

#[test]
fn a_mass_on_a_spring_and_damper_oscillates() {
    let (m, c, k, x0) = (0.5, 0.8, 50.0, 0.2);
    let description = read(
        "
bodies: { mass: { mass: 0.5, coordinates: [x] } }
effects:
  mount: { spring_damper: { between: [ground, mass], along: x, stiffness: 50, damping: 0.8, free_length: 1 } }
initial: { mass.x: 1.2, mass.vx: 0 }
outputs: { stretch: mass.x - 1, speed: mass.vx }
simulation: { duration: 2, step: 1e-3, output_step: 0.01 }
",
    );
    let decay: f64 = c / (2.0 * m);
    let omega = (k / m - decay * decay).sqrt();
    let stretch = |t: f64| x0 * (-decay * t).exp() * ((omega * t).cos() + decay / omega * (omega * t).sin());
    let speed = |t: f64| -x0 * (-decay * t).exp() * (omega + decay * decay / omega) * (omega * t).sin();
    // The remaining error is of fourth order (third in velocities, whose start is of third): (ω h)⁴ of the amplitude,
    // times ω t.
    assert_converges(&description, 1e-3, "stretch", 1e-8, stretch);
    assert_converges(&description, 1e-3, "speed", 1e-7, speed);
}

/// A spring by a table of a parabola's slope stores the energy of the parabola's integral.
#[test]
fn a_spring_may_have_a_measured_characteristic() {
    let mut points = String::new();
    for i in -20..=20 {
        let x = 0.02 * f64::from(i);
        write!(points, "[{x}, {}], ", 50.0 * x + 400.0 * x.powi(3)).unwrap();
    }
    let bounds = nominal(&read(&format!(
        "
tables: {{ measured: {{ points: [{points}], units: [m, N] }} }}
bodies: {{ mass: {{ mass: 0.5, coordinates: [x] }} }}
effects: {{ hard: {{ spring_damper: {{ between: [ground, mass], along: x, force: measured(hard.length) }} }} }}
initial: {{ mass.x: 0.3, mass.vx: 0 }}
outputs: {{ energy: 0.25*mass.vx^2 + 25*mass.x^2 + 100*mass.x^4 }}
simulation: {{ duration: 2, step: 5e-4, output_step: 0.01 }}
"
    )));
    let start = 25.0 * 0.09 + 100.0 * 0.0081;
    let error = distance_from(&bounds.times, curve(&bounds, "energy"), |_| start);
    // HHT's dissipation at this step and the spline's natural ends.
    assert!(error < 2e-3 * start, "{error:e}");
}

/// A hardening spring by a formula of its own length: ½ m v² + ¼ k₃ x⁴ stays, and so the period is
/// 4 √(2 m/k₃)/A ∫₀¹ du/√(1 − u⁴).
#[test]
fn a_spring_may_be_a_formula_of_its_length() {
    let description = read(
        "
parameters: { k3: 400 N/m^3 }
bodies: { mass: { mass: 0.5, coordinates: [x] } }
effects:
  hard: { spring_damper: { between: [ground, mass], along: x, force: k3*hard.length^3 } }
initial: { mass.x: 0.3, mass.vx: 0 }
outputs: { x: mass.x, v: mass.vx, rate: hard.rate }
simulation: { duration: 2, step: 1e-3, output_step: 1e-3 }
",
    );
    // ∫₀¹ du/√(1 − u⁴) = Γ(¼)²/(4 √(2π))
    let period = 4.0 * (2.0 * 0.5 / 400.0_f64).sqrt() / 0.3 * 1.311_028_777_146_06;
    let bounds = nominal(&description);
    let x = curve(&bounds, "x");
    let crossings: Vec<f64> = (1..x.len())
        .filter(|&i| x[i - 1] > 0.0 && x[i] <= 0.0)
        .map(|i| bounds.times[i - 1] + 1e-3 * x[i - 1] / (x[i - 1] - x[i]))
        .collect();
    let found = (crossings.last().unwrap() - crossings[0]) / (crossings.len() - 1) as f64;
    assert!((found - period).abs() < 1e-4 * period, "{found} {period}");
    assert!(distance_from(&bounds.times, curve(&bounds, "rate"), |_| 0.0) > 1.0);
}

const ADAMS: Case = Case {
    name: "transpring_force/TranSpring",
    velocities: "transpring_force/TranSpring",
    text: "bodies:
  a: { mass: 1, inertia: [0.04, 0.1, 0.1] }
effects: { s: { spring_damper: { between: [ground, a], along: z, stiffness: 10, damping: 0.5 } } }
initial: { a.orientation: { axis: x, angle: 0 }, a.x: 0, a.y: 0, a.z: 0 }",
    at_one: [0.0, 0.0, -1.74502, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
};

compared_with_adams!(ADAMS);

#[test]
fn springs_store_and_dampers_dissipate_energy() {
    assert_balance(
        &pair("", "  e: { spring_damper: { between: [a.P, b.P], stiffness: 50, free_length: 0.4 } }", APART),
        "0",
    );
    assert_balance(
        &pair(
            "",
            "  e: { spring_damper: { between: [a.P, b.P], along: [3, 4], stiffness: 50, damping: 7, free_length: 0.4 } }",
            APART,
        ),
        "-7*(0.6*(b.P.vx - a.P.vx) + 0.8*(b.P.vy - a.P.vy))^2",
    );
    assert_balance(
        &spatial_pair(
            "",
            "  e: { spring_damper: { between: [a.P, b.P], stiffness: 50, damping: 7, free_length: 0.4 } }",
            APART_IN_SPACE,
        ),
        "-7*((b.P.x - a.P.x)*(b.P.vx - a.P.vx) + (b.P.y - a.P.y)*(b.P.vy - a.P.vy) + (b.P.z - a.P.z)*(b.P.vz - a.P.vz))^2/((b.P.x - a.P.x)^2 + (b.P.y - a.P.y)^2 + (b.P.z - a.P.z)^2)",
    );
}

/// A spring and damper without free length begins where its points meet: x = v/ω e^(−δt) sin ωt.
#[test]
fn a_spring_without_free_length_may_begin_at_length_zero() {
    let description = read(
        "
bodies: { bob: { mass: 0.5, coordinates: [x, y] } }
effects: { mount: { spring_damper: { between: [ground, bob], stiffness: 50, damping: 0.8 } } }
initial: { bob.x: 0, bob.y: 0, bob.vx: 0.6, bob.vy: -0.8 }
outputs: { along: 0.6*bob.x - 0.8*bob.y, across: 0.8*bob.x + 0.6*bob.y }
simulation: { duration: 1, step: 1e-3, output_step: 0.01 }
",
    );
    let (decay, omega) = (0.8_f64, (100.0 - 0.64_f64).sqrt());
    assert_converges(&description, 1e-3, "along", 1e-6, |t| (-decay * t).exp() * (omega * t).sin() / omega);
    let bounds = nominal(&description);
    assert!(distance_from(&bounds.times, curve(&bounds, "across"), |_| 0.0) < 1e-12);
}
