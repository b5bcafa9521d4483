//! Drag: fall through a fluid.

use crate::common::power::{APART, assert_balance, pair};
use crate::common::{curve, distance_from, nominal, order, read};

/// A body that falls through a fluid: v = v_T tanh(g t/v_T), v_T² = 2 m g/(ρ c_d A).
#[test]
fn a_falling_body_reaches_its_terminal_speed() {
    let description = read(
        "
bodies: { sphere: { mass: 0.5, coordinates: [x, y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  air: { drag: { on: sphere, density: 1.2 kg/m^3, drag_coefficient: 0.47, area: 0.3 m^2, wind: [2, 0] } }
initial: { sphere.x: 0, sphere.y: 0, sphere.vx: 2, sphere.vy: 0 }
outputs: { v: sphere.vy, vx: sphere.vx, force: air.force }
simulation: { duration: 3, step: 1e-3, output_step: 0.01 }
",
    );
    let terminal = (2.0 * 0.5 * 9.81 / (1.2 * 0.47 * 0.3_f64)).sqrt();
    let runs = [2e-3, 1e-3].map(|h| nominal(&description.clone().step(h)));
    let exact = |t: f64| -terminal * (9.81 * t / terminal).tanh();
    let errors = runs.each_ref().map(|run| distance_from(&run.times, curve(run, "v"), exact));
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1, "{errors:?}");
    assert!(errors[1] < 1e-5, "{errors:?}");
    assert!(distance_from(&runs[1].times, curve(&runs[1], "vx"), |_| 2.0) < 1e-12);
    assert!((curve(&runs[1], "force").last().unwrap() - 4.905).abs() < 0.05);
}

#[test]
fn dissipated_power_is_force_times_speed() {
    assert_balance(
        &pair("", "  e: { drag: { on: a.P, linear: 2, quadratic: 0.5 } }", APART),
        "-(2 + 0.5*sqrt(a.P.vx^2 + a.P.vy^2))*(a.P.vx^2 + a.P.vy^2)",
    );
}
