//! Revolute joints: reactions of a rod at rest and of a spinning one, and MSC Adams.

use mbint::Formulation;
use mbint::results::Bounds;

use crate::common::adams::{Case, compared_with_adams};
use crate::common::closed_forms::{assert_converges, assert_exact_force};
use crate::common::power::{assert_balance, pair, spatial_pair};
use crate::common::{curve, distance_from, nominal, order, read, row};

#[test]
fn a_rod_at_rest_hangs_by_its_weight() {
    // The reaction is on the second body.
    let hanging = |between: &str| {
        nominal(&read(&format!(
            "
bodies:
  ground: {{ points: {{ O: [0, 0] }} }}
  rod: {{ mass: 2, inertia: 0.1, points: {{ top: [0, 0.4] }} }}
joints: {{ hinge: {{ revolute: {between} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ rod.angle: 0, rod.angular_velocity: 0 }}
outputs: {{ up: hinge.force.y, side: hinge.force.x, size: hinge.force }}
simulation: {{ duration: 0.1, step: 1e-3, output_step: 0.01 }}
"
        )))
    };
    let bounds = hanging("[ground.O, rod.top]");
    assert_exact_force(&bounds, "up", |_| 2.0 * 9.81);
    assert_exact_force(&bounds, "side", |_| 0.0);
    assert_exact_force(&bounds, "size", |_| 2.0 * 9.81);
    assert_exact_force(&hanging("[rod.top, ground.O]"), "up", |_| -2.0 * 9.81);
}

#[test]
fn a_spinning_rod_pulls_at_its_hinge() {
    // Uniform rotation: the hinge pulls the centre inwards with m ω² l/2; free of other forces, the speed stays.
    let description = read(
        "
bodies: { rod: { mass: 2, inertia: 0.1, points: { hinge: [-0.4, 0] } } }
joints: { hinge: { revolute: [ground, rod.hinge] } }
initial: { rod.angle: 0, rod.angular_velocity: 6 }
outputs: { angle: rod.angle, x: hinge.force.x, y: hinge.force.y }
simulation: { duration: 2, step: 1e-3, output_step: 0.01, formulation: absolute }
",
    );
    let pull = 2.0 * 36.0 * 0.4;
    assert_converges(&description, 1e-3, "angle", 1e-7, |t| 6.0 * t);
    // The reactions' errors of the first steps (see `convergence`) have faded after 0.1 s.
    let after = |bounds: &Bounds, name: &str, exact: &dyn Fn(f64) -> f64| {
        let first = row(bounds, 0.1);
        distance_from(&bounds.times[first..], &curve(bounds, name)[first..], exact)
    };
    let runs = [1e-3, 5e-4].map(|h| nominal(&description.clone().step(h)));
    let x = |t: f64| -pull * (6.0 * t).cos();
    let y = |t: f64| -pull * (6.0 * t).sin();
    for (name, exact) in [("x", &x as &dyn Fn(f64) -> f64), ("y", &y)] {
        let errors = runs.each_ref().map(|run| after(run, name, exact));
        println!("{name}: {errors:?}");
        assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1, "{name}: {errors:?}");
        assert!(errors[0] < 1e-4 * pull, "{name}: {errors:?}");
    }
    // The hinge's own angle grows evenly: nothing is left to be approximated.
    let own = description.formulation(Formulation::Joint);
    let run = nominal(&own);
    for (name, exact) in [("x", &x as &dyn Fn(f64) -> f64), ("y", &y)] {
        assert!(distance_from(&run.times, curve(&run, name), exact) < 1e-9 * pull, "{name} in joint coordinates");
    }
}

const ADAMS: Case = Case {
    name: "revolute_joint/Revolute",
    velocities: "revolute_joint/Revolute",
    text: "bodies:
  ground: { points: { O: { rotation: { axis: x, angle: -90 deg } } } }
  a: { mass: 1, inertia: [0.04, 0.1, 0.1], points: { P: [-2, 0, 0] } }
joints: { j: { revolute: [ground.O, a.P] } }
initial: { a.orientation: { axis: x, angle: -90 deg } }",
    at_one: [
        -0.892381, 0.0, -1.78988, 0.372092, -0.372092, 0.601288, 0.601288, 11.4612, 0.0, 23.2273, 0.0, 2.92614, 0.0,
    ],
};

compared_with_adams!(ADAMS);

#[test]
fn reactions_do_no_work() {
    assert_balance(
        &pair(
            "  j: { revolute: [a.P, b.P] }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  j.angle: 0.3\n  j.angular_velocity: -0.8",
        ),
        "0",
    );
    assert_balance(
        &spatial_pair(
            "  j: { revolute: { between: [a.P, b.P], axis: [1, 2, -0.5] } }",
            "  spring: { spring_damper: { between: [ground.O, b], stiffness: 30, free_length: 0.2 } }",
            "  j.angle: 0.3\n  j.angular_velocity: -0.8",
        ),
        "0",
    );
}
