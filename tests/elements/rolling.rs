//! Wheels that roll: on a slope, on a plank that slides, on a lever that rocks.

use mbint::Formulation;
use mbint::results::Method;

use crate::common::power::{assert_balance, pair};
use crate::common::{band, curve, distance_from, largest, nominal, order, output, read, run};

/// s̈ = g sin α/(1 + J/(m r²)), with the reactions m g cos α and J s̈/r².
#[test]
fn a_disc_rolls_down_a_slope() {
    let description = read(
        "
parameters: { J: { value: 0.02, unit: kg*m^2, tolerance: 10% } }
bodies: { disc: { mass: 2, inertia: J } }
joints: { roll: { rolling: { between: [ground, disc], axis: [4, -3], radius: 0.1, offset: 0.05 } } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { disc.angle: 0.3, disc.angular_velocity: 0 }
outputs: { x: disc.x, y: disc.y, angle: disc.angle, fx: roll.force.x, fy: roll.force.y }
simulation: { duration: 1, step: 1e-3, output_step: 0.1 }
bounds: { chebyshev: { order: 5 } }
",
    );
    let acceleration = |inertia: f64| 9.81 * 0.6 / (1.0 + inertia / (2.0 * 0.01));
    // At an angle of 0.3 the wheel is r 0.3 before the position that the offset gives.
    let way = |inertia: f64, t: f64| 0.05 - 0.1 * 0.3 + 0.5 * acceleration(inertia) * t * t;
    for formulation in [Formulation::Absolute, Formulation::Auto] {
        let description = description.clone().formulation(formulation);
        let bounds = run(&description);
        let off = |name: &str, wanted: &dyn Fn(f64) -> f64| distance_from(&bounds.times, curve(&bounds, name), wanted);
        assert!(off("x", &|t| 0.8 * way(0.02, t) + 0.6 * 0.1) < 1e-10);
        assert!(off("y", &|t| -0.6 * way(0.02, t) + 0.8 * 0.1) < 1e-10);
        assert!(off("angle", &|t| 0.3 - 5.0 * acceleration(0.02) * t * t) < 1e-9);
        let (normal, along) = (2.0 * 9.81 * 0.8, -0.02 * acceleration(0.02) / 0.01);
        assert!(off("fx", &|_| 0.6 * normal + 0.8 * along) < 1e-7);
        assert!(off("fy", &|_| 0.8 * normal - 0.6 * along) < 1e-7);
        let band = band(output(&bounds, "x"), Method::Chebyshev);
        for (row, &t) in bounds.times.iter().enumerate() {
            let allowed = band.error.total[row] + 1e-10;
            let [low, high] = [0.022, 0.018].map(|inertia| 0.8 * way(inertia, t) + 0.06);
            assert!((band.lower[row] - low).abs() < allowed && (band.upper[row] - high).abs() < allowed, "{t}");
        }
    }
}

/// A plank of 3 kg is pulled by 5 N from under a solid cylinder of 2 kg: the plank has the acceleration F/(M + m/3),
/// the cylinder's centre a third of it.
#[test]
fn moving_plank_drags_a_rolling_cylinder() {
    let bounds = nominal(&read(
        "
bodies:
  plank: { mass: 3, inertia: 0.1, points: { top: [0, 0.02] } }
  cylinder: { mass: 2, inertia: 2*0.05^2/2 }
joints:
  ice: { prismatic: { between: [ground, plank], axis: x } }
  roll: { rolling: { between: [plank.top, cylinder], axis: x, radius: 50 mm } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  pull: { force: { on: plank, value: [5, 0] } }
initial: { plank.x: 0, plank.vx: 0, cylinder.x: 0, cylinder.vx: 0 }
outputs: { plank: plank.x, cylinder: cylinder.x, y: cylinder.y }
simulation: { duration: 1, step: 1e-3, output_step: 0.1 }
",
    ));
    let acceleration = 5.0 / (3.0 + 2.0 / 3.0);
    assert!(distance_from(&bounds.times, curve(&bounds, "plank"), |t| 0.5 * acceleration * t * t) < 1e-10);
    assert!(distance_from(&bounds.times, curve(&bounds, "cylinder"), |t| acceleration * t * t / 6.0) < 1e-10);
    assert!(largest(curve(&bounds, "y").iter().map(|y| y - 0.07)) < 1e-12);
}

#[test]
fn reactions_do_no_work() {
    for joint in [
        "  j: { rolling: { between: [a.P, b], axis: [1, 2], radius: 0.2, offset: 0.1 } }",
        "  j: { rolling: { between: [a.P, b], axis: [-1, 0.3], radius: 0.3 } }\n  hinge: { revolute: [ground.O, a] }",
    ] {
        let start = if joint.contains("hinge") {
            "  b.angle: 0.2\n  b.angular_velocity: 1.3"
        } else {
            "  b.x: 0.9\n  b.vx: 0.3"
        };
        let text = pair(
            joint,
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            start,
        );
        let text = if joint.contains("hinge") {
            text.replace("  a.x: 0.1\n  a.y: -0.2\n", "").replace("  a.vx: 0.7\n  a.vy: 1.1\n", "")
        } else {
            text
        };
        assert_balance(&text, "0");
    }
}

/// Its wheel does not slip, and stays on the rail, whatever moves; of second order.
#[test]
fn a_wheel_follows_a_lever_that_rocks() {
    let text = "
bodies:
  lever: { mass: 1, inertia: 0.05, points: { top: [0.02, 0.03] } }
  wheel: { mass: 0.5, inertia: 2e-4 }
joints:
  pin: { revolute: [ground, lever] }
  roll: { rolling: { between: [lever.top, wheel], axis: x, radius: 0.04 } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  coil: { torsional_spring_damper: { on: pin, stiffness: 3 } }
initial: { lever.angle: 0.2, lever.angular_velocity: 0, wheel.angle: 0.2, wheel.angular_velocity: 0 }
outputs:
  x: wheel.x
  along: (wheel.x - lever.top.x)*cos(lever.angle) + (wheel.y - lever.top.y)*sin(lever.angle) + 0.04*(wheel.angle - lever.angle)
  across: (wheel.y - lever.top.y)*cos(lever.angle) - (wheel.x - lever.top.x)*sin(lever.angle) - 0.04
simulation: { duration: 0.8, step: 1e-3, output_step: 0.02 }
";
    let description = read(text);
    let runs = [1e-3, 5e-4, 2.5e-4].map(|h| nominal(&description.clone().step(h)));
    assert!(largest(["along", "across"].into_iter().flat_map(|name| curve(&runs[0], name).iter().copied())) < 1e-11);
    let far = curve(&runs[0], "x");
    assert!(largest(far.iter().map(|x| x - far[0])) > 0.05, "{far:?}");
    let off = |index: usize| largest(curve(&runs[index], "x").iter().zip(curve(&runs[2], "x")).map(|(a, b)| a - b));
    // Differences from the finest run: of order 2 they have the ratio (1 − 1/16)/(1/4 − 1/16) = 5, log₂ 5 = 2.3.
    assert!(order(off(0), off(1)) > 1.9 && order(off(0), off(1)) < 2.7, "{} {}", off(0), off(1));
}
