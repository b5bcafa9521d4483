//! Outlines with arcs, against circles, bores and capsules, and their images.

use mbint::results::Bounds;

use crate::common::{curve, distance, largest, nominal, read};

const LAWS: &str = "radius: 0.05, impact: { stiffness: 1e5, dissipation: 0.3 }, friction: { coefficient: 0.2, transition_velocity: 0.02 }";

/// A ball of 1 kg under its weight, at a surface about the origin.
fn ball(surface: &str, [x, y]: [f64; 2], [vx, vy]: [f64; 2]) -> Bounds {
    nominal(&read(&format!(
        "
bodies: {{ ball: {{ mass: 1, inertia: 1e-3 }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  it: {{ contact: {{ between: [ground, ball], {surface}, {LAWS} }} }}
initial: {{ ball.x: {x}, ball.y: {y}, ball.vx: {vx}, ball.vy: {vy} }}
outputs: {{ x: ball.x, y: ball.y, angle: ball.angle, gap: it.gap, rate: it.rate, force: it.force, friction: it.friction }}
simulation: {{ duration: 0.8, step: 1e-4, output_step: 5e-3 }}
"
    )))
}

#[track_caller]
fn assert_same(a: &Bounds, b: &Bounds, names: &[&str]) {
    for name in names {
        let [one, other] = [a, b].map(|bounds| curve(bounds, name));
        let size = largest(other.iter().copied()).max(1.0);
        // Newton's iteration stops at 1e-10 m, which are 1e-6 of a force; a bore's wall is 5e-9 of its clearance off.
        let allowed = if matches!(*name, "force" | "friction") { 5e-5 } else { 2e-6 };
        assert!(distance(one, other) < allowed * size, "{name}: {:e} of {size}", distance(one, other));
    }
    assert!(curve(b, "force").iter().filter(|force| **force > 1.0).count() > 2, "no contact");
}

const ALL: [&str; 7] = ["x", "y", "angle", "gap", "rate", "force", "friction"];

/// Inside of an arc, which turns left or right as its ends are named, and outside of one.
#[test]
fn an_arc_is_a_part_of_a_circle() {
    let (start, speed) = ([0.1, -0.3], [0.3, 0.0]);
    let bore = ball("hollow: 0.48", start, speed);
    for arc in [
        "[[-0.5, 0], { to: [0, -0.5], radius: 0.5 }, { to: [0.5, 0], radius: 0.5 }]",
        "[[0.5, 0], { to: [0, -0.5], radius: -0.5 }, { to: [-0.5, 0], radius: -0.5 }]",
    ] {
        let by_arc = ball(&format!("path: {arc}, rounding: 0.02"), start, speed);
        assert_same(&by_arc, &bore, &["x", "y", "angle", "force", "friction"]);
    }
    let (start, speed) = ([0.05, 0.5], [0.2, 0.0]);
    let hill = ball(
        "path: [[0.3, 0], { to: [0, 0.3], radius: 0.3 }, { to: [-0.3, 0], radius: 0.3 }], rounding: 0.02",
        start,
        speed,
    );
    assert_same(&hill, &ball("circle: 0.32", start, speed), &["x", "y", "angle"]);
}

/// A polygon with round ends is a capsule: there is no corner where arcs continue the edges.
#[test]
fn arcs_join_edges_smoothly() {
    let stadium = "polygon: [[-0.2, 0.1], { to: [-0.3, 0], radius: 0.1 }, { to: [-0.2, -0.1], radius: 0.1 }, [0.2, -0.1], { to: [0.3, 0], radius: 0.1 }, { to: [0.2, 0.1], radius: 0.1 }], rounding: 0.02";
    let capsule = "capsule: [[-0.2, 0], [0.2, 0]], rounding: 0.12";
    for (start, speed) in [([0.1, 0.25], [0.5, 0.0]), ([-0.15, 0.2], [-0.4, 0.0]), ([0.6, 0.1], [-1.5, 1.0])] {
        assert_same(&ball(stadium, start, speed), &ball(capsule, start, speed), &ALL);
    }
}

/// An image has its arcs on the other side.
#[test]
fn mirrored_instance_has_mirrored_arcs() {
    for axis in ["x", "y"] {
        let bounds = nominal(&read(&format!(
            "
assemblies:
  bowl:
    bodies: {{ ground: {{ points: {{ rim: [-0.4, 0.1] }} }}, ball: {{ mass: 1, inertia: 1e-3 }} }}
    effects:
      push: {{ force: {{ on: ball, value: [-2, -9] }} }}
      it: {{ contact: {{ between: [ground.rim, ball], path: [[0, 0], {{ to: [0.3, -0.4], radius: 0.45 }}, {{ to: [0.9, -0.6], radius: -0.8 }}], rounding: 0.02, {LAWS} }} }}
    initial: {{ ball.x: 0.1, ball.y: 0, ball.angle: 0, ball.vx: 0, ball.vy: 0, ball.angular_velocity: 0 }}
instances: {{ one: {{ of: bowl }}, two: {{ of: bowl, mirror: {axis} }} }}
outputs: {{ x: one.ball.x, y: one.ball.y, a: two.ball.x, b: two.ball.y, force: one.it.force }}
simulation: {{ duration: 0.5, step: 1e-4, output_step: 0.01 }}
"
        )));
        for (name, image) in [("x", "a"), ("y", "b")] {
            let sign = if name == axis { -1.0 } else { 1.0 };
            let off = largest(curve(&bounds, name).iter().zip(curve(&bounds, image)).map(|(a, b)| a - sign * b));
            assert!(off < 1e-8, "{axis} {name}: {off:e}");
        }
        assert!(curve(&bounds, "force").iter().any(|force| *force > 1.0), "no contact");
    }
}
