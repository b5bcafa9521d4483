//! PID controllers against scipy, the balance of power, and the same written out by `states`.

use mbint::results::Method;

use crate::common::{band, curve, distance, largest, nominal, output, read, row, run};

fn arm(pid: &str, simulation: &str, more: &str) -> String {
    format!(
        "
parameters: {{ ki: {{ value: 30, tolerance: 10% }} }}
bodies: {{ arm: {{ mass: 1, inertia: 0.5 }} }}
joints: {{ hinge: {{ revolute: [ground, arm] }} }}
effects: {{ drive: {{ pid: {{ on: hinge, target: 1 rad, proportional: 20, integral: ki, derivative: 4, {pid} }} }} }}
initial: {{ hinge.angle: 0, hinge.angular_velocity: 0 }}
outputs: {{ s: arm.angle, w: arm.angular_velocity, I: drive.integral{more} }}
simulation: {{ duration: 3, output_step: 0.5, {simulation} }}
"
    )
}

/// SciPy 1.17, `solve_ivp`, DOP853, rtol 1e-12: angle, rate, integral and filtered rate of the error; with T_t =
/// k_p/k_i the limit of 6 N m makes it overshoot by a fifth, with 0.1 s hardly.
#[test]
fn limited_controller_matches_scipy() {
    let own = [
        (1, [1.09795697, 1.95834415, 5.36586225, -2.16382639]),
        (2, [1.18738658, -0.55941133, 1.67023194, 0.56135745]),
        (4, [1.01017125, -0.01470028, 0.14568623, 0.01479709]),
    ];
    let fast = [
        (1, [0.86807828, 1.34260529, 0.0500457, -1.47119657]),
        (2, [1.02487448, -0.13124053, -0.04340999, 0.12762561]),
        (4, [0.99866681, 0.00719213, -0.01161205, -0.00786995]),
    ];
    for (tracking, wanted) in [("", own), (", tracking: 0.1 s", fast)] {
        for (simulation, allowed) in
            [("step: 1e-3", 1e-3), ("scheme: explicit, tolerance: 1e-8", 1e-6), ("tolerance: 1e-6, scheme: hht", 2e-5)]
        {
            let text = arm(&format!("filter: 20 ms, limit: 6 N*m{tracking}"), simulation, ", d: drive.filtered_rate");
            let bounds = nominal(&read(&text));
            for (row, values) in wanted {
                for (name, value) in ["s", "w", "I", "d"].into_iter().zip(values) {
                    let found = curve(&bounds, name)[row];
                    assert!(
                        (found - value).abs() < allowed,
                        "{tracking} {simulation}: {name} in {row}: {found}, not {value}"
                    );
                }
            }
        }
    }
}

/// Without filter and limit it equals three lines of `states` and `torque`; the gain is uncertain in both.
#[test]
fn controller_matches_equivalent_states() {
    let bounds = run(&read(&arm("initial: 2 N*m", "step: 1e-3", "")));
    let written = "
parameters: { ki: { value: 30, tolerance: 10% } }
bodies: { arm: { mass: 1, inertia: 0.5 } }
joints: { hinge: { revolute: [ground, arm] } }
states: { I: { rate: ki*(1 N*m/rad/s)*(1 rad - hinge.angle), initial: 2 N*m } }
effects: { drive: { torque: { on: hinge, value: 20 N*m/rad*(1 rad - hinge.angle) + I - 4 N*m*s/rad*hinge.angular_velocity } } }
initial: { hinge.angle: 0, hinge.angular_velocity: 0 }
outputs: { s: arm.angle, w: arm.angular_velocity, I: I }
simulation: { duration: 3, output_step: 0.5, step: 1e-3 }
";
    let other = run(&read(written));
    for name in ["s", "w", "I"] {
        let [one, two] = [&bounds, &other].map(|bounds| band(output(bounds, name), Method::Chebyshev));
        assert!(distance(&one.lower, &two.lower) < 1e-9 && distance(&one.upper, &two.upper) < 1e-9, "{name}");
    }
}

/// A weight that the controller does not know: the integral carries it in the end, whatever the gain is.
#[test]
fn the_integral_carries_the_load() {
    let text = "
parameters: { ki: { value: 60, tolerance: 20% } }
bodies: { lift: { mass: 3, inertia: 1 } }
joints: { rail: { prismatic: { between: [ground, lift], axis: y } } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  drive: { pid: { on: rail, target: 0.2, proportional: 120, integral: ki, derivative: 40, filter: 10 ms, limit: 80 N } }
initial: { lift.y: 0, lift.vy: 0 }
outputs: { y: lift.y, force: drive.force, integral: drive.integral }
simulation: { duration: 12, step: 2e-3, output_step: 1 }
";
    let bounds = run(&read(text));
    let last = row(&bounds, 12.0);
    for (name, value, allowed) in [("y", 0.2, 1e-2), ("force", 29.43, 1e-1), ("integral", 29.43, 1.0)] {
        let band = band(output(&bounds, name), Method::Chebyshev);
        let off = largest([band.lower[last] - value, band.upper[last] - value]);
        assert!(off < allowed, "{name}: {off:e}");
        assert_eq!(output(&bounds, name).unit, if name == "y" { "m" } else { "N" });
    }
}

/// A target that follows another joint, with the rate of that joint: the same as `states` and a torque that write it
/// out.
#[test]
fn a_target_may_follow_a_joint() {
    let text = |states: &str, drive: &str| {
        format!(
            "
bodies: {{ arm: {{ mass: 1, inertia: 0.5 }}, other: {{ mass: 1, inertia: 0.3 }} }}
joints: {{ hinge: {{ revolute: [ground, arm] }}, leader: {{ revolute: [ground, other] }} }}
{states}
effects:
  wire: {{ torsional_spring_damper: {{ on: leader, stiffness: 5 }} }}
  drive: {{ {drive} }}
initial: {{ hinge.angle: 0, hinge.angular_velocity: 0, leader.angle: 0.6, leader.angular_velocity: 0 }}
outputs: {{ s: arm.angle }}
simulation: {{ duration: 2, step: 1e-3, output_step: 0.05 }}
"
        )
    };
    let own = text(
        "",
        "pid: { on: hinge, target: 2*leader.angle, target_rate: 2*leader.angular_velocity, proportional: 20, integral: 30, derivative: 4 }",
    );
    let written = text(
        "states: { I: { rate: 30 N*m/s*(2*leader.angle - hinge.angle), initial: 0 N*m } }",
        "torque: { on: hinge, value: 20 N*m*(2*leader.angle - hinge.angle) + I + 4 N*m*s*(2*leader.angular_velocity - hinge.angular_velocity) }",
    );
    let [own, written] = [own, written].map(|text| nominal(&read(&text)));
    assert!(distance(curve(&own, "s"), curve(&written, "s")) < 1e-9);
    assert!(curve(&own, "s").iter().any(|s| s.abs() > 0.5), "it moves");
}
