use crate::assemble::{self, System};
use crate::elements::joints::*;
use crate::grammar::{Axis, Direction, Rotating};
use crate::model::JointKind;

use super::model::{Model, formula, pair, vector};
use super::numbers::{State, assert_all_close, assert_close, constraint_forces, output};

fn two_bodies() -> Model {
    let mut m = Model::new();
    m.interval("d", [0.7, 0.8, 0.9]);
    m.body("a", "2", "0.1", "xya", &[("P", "0.3", "-0.5")]);
    m.body("b", "1", "0.2", "xya", &[("P", "-0.2", "0.6")]);
    for name in ["j.force", "j.force.x", "j.force.y", "j.torque", "b.P.x - b.x", "b.P.y - b.y", "a.P.x", "b.P.x"] {
        m.output(name);
    }
    m
}

fn value(system: &System, state: &State, name: &str) -> f64 {
    state.value(&system.graph, output(system, name))
}

fn kinds(m: &Model) -> Vec<JointKind> {
    let between = m.between("a.P", "b.P");
    vec![
        JointKind::Revolute(Revolute { between, axis: Axis(vector(["0", "0", "1"])) }),
        JointKind::Prismatic(Prismatic { between, axis: Direction(pair("1", "2")), angle: formula("0.3") }),
        JointKind::Fixed(Fixed { between, angle: formula("0.3") }),
        JointKind::PinInSlot(PinInSlot { between, axis: Direction(pair("1", "2")) }),
        JointKind::Distance(Distance { between, length: formula("d") }),
        JointKind::Gear(Gear::of([Rotating::of_body(1), Rotating::of_body(2)], -2.0, 0.1)),
    ]
}

/// −Φ_qᵀ λ on the second body is the reaction's force at the second point and its torque; the first body feels the
/// opposite, and the pair has no moment (but for gears).
#[test]
fn reactions_equal_generalised_multiplier_forces() {
    for kind in kinds(&two_bodies()) {
        let mut m = two_bodies();
        m.joint("j", kind.clone());
        let mut system = m.build();
        let mut state = State::random(&system, 7);
        if let JointKind::Revolute(_) | JointKind::Fixed(_) = kind {
            // Points coincide, so that action and reaction do.
            let gap = state.values(&system.graph, &system.constraint[..2]);
            for (index, gap) in system.q[3..5].iter().zip(gap) {
                *state.0.get_mut(index).unwrap() += gap;
            }
        }
        let pull: Vec<f64> = constraint_forces(&mut system, &state).iter().map(|force| -force).collect();
        let force = ["j.force.x", "j.force.y"].map(|name| value(&system, &state, name));
        let torque = value(&system, &state, "j.torque");
        let arm = ["b.P.x - b.x", "b.P.y - b.y"].map(|name| value(&system, &state, name));
        assert_all_close(&pull[3..5], &force, 1e-13);
        assert_close(pull[5], torque + arm[0] * force[1] - arm[1] * force[0], 1e-13);
        if let JointKind::Gear(_) = kind {
            assert_all_close(&pull[..3], &[0.0, 0.0, 2.0 * torque], 1e-13);
            continue;
        }
        assert_all_close(&pull[..2], &[-force[0], -force[1]], 1e-13);
        let q = state.list(&system.q);
        let about_ground = |body: usize| pull[body + 2] + q[body] * pull[body + 1] - q[body + 1] * pull[body];
        assert_close(about_ground(0) + about_ground(3), 0.0, 1e-13);
        if !matches!(kind, JointKind::Distance(_)) {
            assert_close(value(&system, &state, "j.force"), force[0].hypot(force[1]), 1e-13);
        }
    }
}

/// Rows at a configuration computed by hand: a at the origin, b where the joint wants it.
#[test]
fn rows_vanish_where_the_joint_is_closed() {
    let turn =
        |s: [f64; 2], angle: f64| [angle.cos() * s[0] - angle.sin() * s[1], angle.sin() * s[0] + angle.cos() * s[1]];
    let (first, second) = (0.4, 0.7);
    let at_a = turn([0.3, -0.5], first);
    let slide = turn([1.0, 2.0], first);
    for kind in kinds(&two_bodies()) {
        let mut m = two_bodies();
        m.joint("j", kind.clone());
        let system = m.build();
        let (gap, angle) = match kind {
            JointKind::Revolute(_) => ([0.0, 0.0], 1.3),
            JointKind::Fixed(_) => ([0.0, 0.0], second),
            JointKind::Prismatic(_) => (slide.map(|s| -0.6 * s), second),
            JointKind::PinInSlot(_) => (slide.map(|s| 0.6 * s), -1.1),
            JointKind::Distance(_) => ([0.8 * 0.6, -0.8 * 0.8], 2.0),
            _ => ([5.0, 5.0], -2.0 * first + 0.1),
        };
        let arm = turn([-0.2, 0.6], angle);
        let b = [0, 1].map(|axis| at_a[axis] + gap[axis] - arm[axis]);
        let state = State::at(&system, &[0.0, 0.0, first, b[0], b[1], angle]);
        let rows = state.values(&system.graph, &system.constraint);
        assert_all_close(&rows, &vec![0.0; rows.len()], 1e-15);
        let moved = State::at(&system, &[0.0, 0.0, first, b[0] + 0.1, b[1] + 0.1, angle + 0.1]);
        for row in moved.values(&system.graph, &system.constraint) {
            assert!(row.abs() > 1e-3, "{kind:?} does not notice");
        }
    }
}

#[test]
fn constraint_rows_are_named_after_their_direction() {
    let mut m = two_bodies();
    for (index, kind) in kinds(&m).into_iter().enumerate() {
        m.joint(&format!("j{index}"), kind);
    }
    m.0.outputs.clear();
    let names: Vec<String> = m.build().constraints.into_iter().map(|info| info.name).collect();
    assert_eq!(names, ["j0.x", "j0.y", "j1.normal", "j1.angle", "j2.x", "j2.y", "j2.angle", "j3", "j4", "j5"]);
}

/// An equation's multiplier stands for its force; its drive is −λ.
#[test]
fn equations_may_drive_coordinates() {
    let mut m = Model::new();
    m.body("a", "2", "0.1", "a", &[]);
    m.joint("drive", JointKind::Equation(Equation { left: formula("a.angle"), right: formula("0.5*t^2") }));
    m.output("drive.force");
    m.output("drive.torque");
    let mut system = m.build();
    let mut state = State::at(&system, &[0.0]);
    super::numbers::solve_motion(&mut system, &mut state);
    assert_close(state.0[&system.w[0]], 1.0, 1e-15);
    assert_close(value(&system, &state, "drive.force"), -0.1, 1e-15);
    assert_close(value(&system, &state, "drive.torque"), 0.0, 0.0);
}

#[test]
fn a_rod_in_tension_has_a_positive_multiplier() {
    let mut m = Model::new();
    m.body("bob", "2", "0", "xy", &[]);
    m.joint("rod", JointKind::Distance(Distance { between: m.between("ground", "bob"), length: formula("0.5") }));
    m.gravity();
    m.output("rod.force.y");
    let mut system = m.build();
    let mut state = State::at(&system, &[0.0, -0.5]);
    super::numbers::solve_motion(&mut system, &mut state);
    assert_close(state.0[&system.lambda[0]], 2.0 * 9.81, 1e-14);
    assert_close(value(&system, &state, "rod.force.y"), 2.0 * 9.81, 1e-14);
}

/// A crosshead that has x alone, in a guide that holds its y and angle once more.
#[test]
fn identically_satisfied_rows_are_omitted() {
    let mut m = Model::new();
    m.interval("h", [0.1, 0.2, 0.3]);
    m.ground_point("G", "0", "2*h");
    m.body("cross", "1", "1", "x", &[("P", "0", "h")]);
    m.hold('y', "h");
    let guide = JointKind::Prismatic(Prismatic {
        between: m.between("ground.G", "cross.P"),
        axis: Direction(pair("1", "0")),
        angle: formula("0"),
    });
    m.joint("guide", guide);
    m.output("guide.force");
    m.output("guide.torque");
    let system = m.build();
    assert!(system.constraint.is_empty());
    assert!(system.outputs.iter().all(|output| system.graph.is_zero(output.expr)));
}

#[test]
fn a_row_that_nothing_can_close_is_an_error() {
    let build = |height: &str| {
        let mut m = Model::new();
        m.interval("h", [0.1, 0.2, 0.3]);
        m.body("cross", "1", "1", "x", &[]);
        m.hold('y', height);
        m.revolute("pin", "ground", "cross");
        assemble::build(&assemble::Questions::of(&m.0)).unwrap_err().to_string()
    };
    assert_eq!(build("0.25"), "joint `pin`: nothing in `pin.y` can move, yet it is -0.25 instead of 0");
    assert_eq!(
        build("h - 0.2"),
        "joint `pin`: nothing in `pin.y` can move, yet it is 0.1 instead of 0 (at the parameters' lower bounds)"
    );
    assert!(build("0.1*t").ends_with("it is -0.1 instead of 0 (at t = 1 s)"));
}

#[test]
fn constraints_on_velocities_are_refused() {
    let mut m = Model::new();
    m.body("a", "1", "1", "x", &[]);
    m.joint("rolling", JointKind::Equation(Equation { left: formula("a.vx"), right: formula("1") }));
    let error = assemble::build(&assemble::Questions::of(&m.0)).unwrap_err().to_string();
    assert_eq!(error, "`a.vx` cannot stand in a formula of parameters, t and positions");
}
