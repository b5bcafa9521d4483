//! Bodies, joints and effects in space.

use nalgebra::{DMatrix, Quaternion, Unit, UnitQuaternion, Vector3};
use symdiff::Expr;

use crate::assemble::System;
use crate::elements::joints::*;
use crate::grammar::{Axis, BodyRef, Components, Direction, PerAxis};
use crate::model::force::ForceFrame;
use crate::model::torque::{AboutAxes, TorqueOn};
use crate::model::{Bushing, EffectKind, Force, Gravity, JointKind, Rotation, SpringDamper, Torque};

use super::model::{Model, formula, vector};
use super::numbers::{
    State, assert_all_close, assert_close, constraint_forces, inertia_times, output, time_derivative,
};

/// Coordinates of a lump: x, y, z, p.
pub const SIZE: usize = 7;

fn names(point: &str, letters: &str) -> Vec<String> {
    letters.split(' ').map(|letter| format!("{point}.{letter}")).collect()
}

fn values(system: &System, state: &State, names: &[String]) -> Vector3<f64> {
    Vector3::from_iterator(names.iter().map(|name| state.value(&system.graph, output(system, name))))
}

/// Made-up values with p on its sphere and ṗ along it.
pub fn on_sphere(system: &System, seed: u64) -> State {
    let mut state = State::random(system, seed);
    for body in 0..system.q.len() / SIZE {
        let p = &system.q[SIZE * body + 3..SIZE * (body + 1)];
        let v = &system.v[SIZE * body + 3..SIZE * (body + 1)];
        let square: f64 = state.list(p).iter().map(|p| p * p).sum();
        p.iter().for_each(|p| *state.0.get_mut(p).unwrap() /= square.sqrt());
        let along: f64 = state.list(p).iter().zip(state.list(v)).map(|(p, v)| p * v).sum();
        for (p, v) in p.iter().zip(v) {
            *state.0.get_mut(v).unwrap() -= along * state.0[p];
        }
    }
    state
}

/// Torque about a body's origin that generalised forces on its p stand for: ½ E.
pub fn torque(p: &[f64], force: &[f64]) -> Vector3<f64> {
    let (e, f) = (Vector3::from_column_slice(&p[1..4]), Vector3::from_column_slice(&force[1..4]));
    0.5 * (p[0] * f - force[0] * e + e.cross(&f))
}

pub fn two_lumps() -> Model {
    let mut m = Model::spatial();
    m.interval("d", [0.7, 0.8, 0.9]);
    let turned = |angles: [&str; 3]| Some(Rotation::RollPitchYaw(vector(angles)));
    m.lump("a");
    m.frame("P", ["0.3", "-0.5", "0.2"], turned(["0.3", "0.5", "-0.4"]));
    m.lump("b");
    m.frame("P", ["-0.2", "0.6", "0.1"], turned(["-0.9", "0.2", "1.1"]));
    for point in ["a.P", "b.P"] {
        names(point, "x y z vx vy vz ax ay az").iter().for_each(|name| m.output(name));
    }
    for body in ["a", "b"] {
        names(body, "omega.x omega.y omega.z alpha.x alpha.y alpha.z").iter().for_each(|name| m.output(name));
    }
    m.output("kinetic_energy");
    m.output("potential_energy");
    m
}

#[test]
fn velocity_and_acceleration_are_the_derivatives_of_position() {
    let system = two_lumps().build();
    let state = on_sphere(&system, 3);
    let h = 1e-5;
    let (before, after) = (state.later(&system, -h), state.later(&system, h));
    let chains = ["x vx", "vx ax", "y vy", "vy ay", "z vz", "vz az"].map(|pair| names("a.P", pair));
    let turning = ["omega.x alpha.x", "omega.y alpha.y", "omega.z alpha.z"].map(|pair| names("a", pair));
    for link in chains.iter().chain(&turning) {
        let [low, high] = [0, 1].map(|index| output(&system, &link[index]));
        let slope = (after.value(&system.graph, low) - before.value(&system.graph, low)) / (2.0 * h);
        assert_close(slope, state.value(&system.graph, high), 1e-8);
    }
}

/// M w − Q is d/dt ∂T/∂v − ∂T/∂q except along p, where the multiplier of pᵀp = 1 acts; M is positive definite.
#[test]
fn inertia_agrees_with_lagrange() {
    let mut m = Model::spatial();
    m.lump("a");
    m.output("kinetic_energy");
    let mut system = m.build();
    let kinetic = output(&system, "kinetic_energy");
    for seed in 0..5 {
        let state = on_sphere(&system, seed);
        let force = state.values(&system.graph, &system.force);
        let moved = inertia_times(&system, &state);
        let mut off = Vec::new();
        for row in 0..SIZE {
            let momentum = system.graph.derivative(kinetic, system.v[row]);
            let rate = time_derivative(&mut system, momentum);
            let slope = system.graph.derivative(kinetic, system.q[row]);
            let lagrange = state.value(&system.graph, rate) - state.value(&system.graph, slope);
            off.push(moved[row] - force[row] - lagrange);
        }
        assert_all_close(&off[..3], &[0.0; 3], 1e-12);
        let turning = torque(&state.list(&system.q)[3..], &off[3..]);
        assert_all_close(turning.as_slice(), &[0.0; 3], 1e-12);
        let mut mass = DMatrix::zeros(SIZE, SIZE);
        for &(row, column, value) in &system.mass {
            mass[(row, column)] = state.value(&system.graph, value);
        }
        assert!(mass.cholesky().is_some(), "M is not positive definite");
    }
}

fn kinds(m: &Model) -> Vec<(JointKind, usize)> {
    let between = m.between("a.P", "b.P");
    let axis = || vector(["1", "-2", "0.5"]);
    let (pitch, length) = (formula("0.3"), formula("d"));
    vec![
        (JointKind::Revolute(Revolute { between, axis: Axis(axis()) }), 5),
        (JointKind::Prismatic(Prismatic { between, axis: Direction(axis()), angle: formula("0.3") }), 5),
        (JointKind::Fixed(Fixed { between, angle: formula("0.3") }), 6),
        (JointKind::PinInSlot(PinInSlot { between, axis: Direction(vector(["1", "-2", "0"])) }), 4),
        (JointKind::Cylindrical(Cylindrical { between, axis: Axis(axis()) }), 4),
        (JointKind::Screw(Screw { between, axis: Axis(axis()), pitch }), 5),
        (JointKind::Spherical(Spherical { between }), 3),
        (
            JointKind::Universal(Universal {
                between,
                axes: [Direction(vector(["1", "2", "0"])), Direction(vector(["2", "-1", "3"]))],
            }),
            4,
        ),
        (JointKind::Planar(Planar { between, normal: Direction(axis()) }), 3),
        (JointKind::PointOnLine(PointOnLine { between, axis: Direction(axis()) }), 2),
        (JointKind::PointOnPlane(PointOnPlane { between, normal: Direction(axis()) }), 1),
        (JointKind::Distance(Distance { between, length }), 1),
    ]
}

/// The second frame against the first where the joint is closed: offset, rotation, and the joint's angle.
fn closed(kind: &JointKind) -> (Vector3<f64>, UnitQuaternion<f64>, f64) {
    let axis = Vector3::new(1.0, -2.0, 0.5).normalize();
    let across = axis.cross(&Vector3::z());
    let about = |axis: Vector3<f64>, angle: f64| UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis), angle);
    let any = about(Vector3::new(0.3, 0.8, -0.5), 2.1);
    let (none, turn) = (UnitQuaternion::identity(), 2.5);
    match kind {
        JointKind::Revolute(_) => (Vector3::zeros(), about(axis, turn), turn),
        JointKind::Prismatic(_) => (0.7 * axis, about(Vector3::z(), 0.3), 0.0),
        JointKind::Fixed(_) => (Vector3::zeros(), about(Vector3::z(), 0.3), 0.0),
        JointKind::PinInSlot(_) => (-0.4 * Vector3::new(1.0, -2.0, 0.0), about(Vector3::z(), turn), 0.0),
        JointKind::Cylindrical(_) => (0.7 * axis, about(axis, turn), turn),
        JointKind::Screw(_) => (0.3 * turn / std::f64::consts::TAU * axis, about(axis, turn), turn),
        JointKind::Spherical(_) => (Vector3::zeros(), any, 0.0),
        // (1, 2, 0) and (2, −1, 3) are perpendicular, and stay so when turned about the one, then the other.
        JointKind::Universal(_) => {
            let cross = about(Vector3::new(1.0, 2.0, 0.0), 0.8) * about(Vector3::new(2.0, -1.0, 3.0), -0.6);
            (Vector3::zeros(), cross, 0.0)
        }
        JointKind::Planar(_) => (0.6 * across, about(axis, turn), turn),
        JointKind::PointOnLine(_) => (-0.3 * axis, any, 0.0),
        JointKind::PointOnPlane(_) => (across - 0.2 * axis.cross(&across), any, 0.0),
        _ => (0.8 * axis, none, 0.0),
    }
}

fn rotation(p: &[f64]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(p[0], p[1], p[2], p[3]))
}

/// A state in which the joint is closed, with b placed accordingly.
fn closed_state(system: &System, kind: &JointKind) -> State {
    let mut state = on_sphere(system, 7);
    let q = state.list(&system.q);
    let first = UnitQuaternion::from_euler_angles(0.3, 0.5, -0.4);
    let second = UnitQuaternion::from_euler_angles(-0.9, 0.2, 1.1);
    let (offset, across, angle) = closed(kind);
    let a = rotation(&q[3..7]);
    let frame = a * first;
    let orientation = frame * across * second.inverse();
    let at = Vector3::from_column_slice(&q[..3]) + a * Vector3::new(0.3, -0.5, 0.2) + frame * offset;
    let origin = at - orientation * Vector3::new(-0.2, 0.6, 0.1);
    let p = [orientation.w, orientation.i, orientation.j, orientation.k];
    for (symbol, value) in system.q[SIZE..].iter().zip(origin.iter().chain(&p)) {
        state.0.insert(*symbol, *value);
    }
    for symbol in &system.q[2 * SIZE..] {
        state.0.insert(*symbol, angle);
    }
    state
}

fn jacobian(system: &mut System, state: &State) -> DMatrix<f64> {
    let mut jacobian = DMatrix::zeros(system.lambda.len(), system.q.len());
    for (row, column, value) in system.graph.jacobian(&system.constraint, &system.q).entries() {
        jacobian[(row, column)] = state.value(&system.graph, value);
    }
    jacobian
}

#[test]
fn rows_vanish_at_closed_joints_and_have_full_rank() {
    for (kind, rows) in kinds(&two_lumps()) {
        let mut m = two_lumps();
        m.joint("j", kind.clone());
        let mut system = m.build();
        let state = closed_state(&system, &kind);
        let gaps = state.values(&system.graph, &system.constraint);
        assert_all_close(&gaps, &vec![0.0; gaps.len()], 1e-14);
        let own_coordinates = system.q.len() - 2 * SIZE;
        assert_eq!(system.lambda.len(), 2 + rows + own_coordinates, "{kind:?}");
        assert_eq!(jacobian(&mut system, &state).rank(1e-9), system.lambda.len(), "{kind:?}");
    }
}

/// −Φ_qᵀ λ on the second body is the reaction's force at the second point and its torque; the first body feels the
/// opposite, and the pair has no moment.
#[test]
fn reactions_equal_generalised_multiplier_forces() {
    for (kind, _) in kinds(&two_lumps()) {
        let mut m = two_lumps();
        m.joint("j", kind.clone());
        for name in ["j.force.x", "j.force.y", "j.force.z", "j.torque.x", "j.torque.y", "j.torque.z"] {
            m.output(name);
        }
        let mut system = m.build();
        let mut state = closed_state(&system, &kind);
        // The multipliers of p, and of an angle that is a coordinate of its own and carries no force, are none of the
        // joint's: the latter follows from the equation of the angle.
        for (info, lambda) in system.constraints.clone().iter().zip(system.lambda.clone()) {
            if info.name.ends_with(".norm") || info.name == "j.angle" {
                state.0.insert(lambda, 0.0);
            }
        }
        if system.q.len() > 2 * SIZE {
            let free = constraint_forces(&mut system, &state)[2 * SIZE];
            let last = *system.lambda.last().unwrap();
            let slope = jacobian(&mut system, &state)[(system.lambda.len() - 1, 2 * SIZE)];
            state.0.insert(last, -free / slope);
        }
        let pull: Vec<f64> = constraint_forces(&mut system, &state).iter().map(|force| -force).collect();
        let q = state.list(&system.q);
        let force = values(&system, &state, &names("j", "force.x force.y force.z"));
        let turn = values(&system, &state, &names("j", "torque.x torque.y torque.z"));
        let on = |body: usize| {
            let index = SIZE * body;
            let force = Vector3::from_column_slice(&pull[index..index + 3]);
            (force, torque(&q[index + 3..index + 7], &pull[index + 3..index + 7]))
        };
        let origin = |body: usize| Vector3::from_column_slice(&q[SIZE * body..SIZE * body + 3]);
        let ((first, first_turn), (second, second_turn)) = (on(0), on(1));
        assert_all_close(second.as_slice(), force.as_slice(), 1e-12);
        assert_all_close(first.as_slice(), (-force).as_slice(), 1e-12);
        let arm = values(&system, &state, &names("b.P", "x y z")) - origin(1);
        assert_all_close(second_turn.as_slice(), (turn + arm.cross(&force)).as_slice(), 1e-12);
        let moment = first_turn + origin(0).cross(&first) + second_turn + origin(1).cross(&second);
        assert_all_close(moment.as_slice(), &[0.0; 3], 1e-12);
    }
}

/// Σ Q v of the effects alone, without the inertial forces of the same bodies.
pub fn power(with: &System, state: &State) -> f64 {
    let inertial = two_lumps().build();
    let named: std::collections::HashMap<&str, f64> =
        state.0.iter().filter_map(|(&symbol, &value)| Some((with.graph.symbol_name(symbol)?, value))).collect();
    let felt =
        inertial.graph.evaluate(&inertial.force, |symbol: Expr| named[inertial.graph.symbol_name(symbol).unwrap()]);
    let force = state.values(&with.graph, &with.force);
    let applied = force.iter().zip(felt).map(|(all, felt)| all - felt);
    applied.zip(state.list(&with.v)).map(|(force, velocity)| force * velocity).sum()
}

/// dV/dt along a motion, by finite differences.
pub fn potential_rate(system: &System, state: &State) -> f64 {
    let h = 1e-5;
    let potential = output(system, "potential_energy");
    let ends = [h, -h].map(|h| state.later(system, h).value(&system.graph, potential));
    (ends[0] - ends[1]) / (2.0 * h)
}

#[test]
fn forces_and_torques_have_force_times_velocity_as_power() {
    let (push, twist) = (Vector3::new(3.0, -2.0, 1.5), Vector3::new(0.7, -1.1, 0.4));
    for in_body in [false, true] {
        let mut m = two_lumps();
        let frame = if in_body { ForceFrame::Body } else { ForceFrame::Ground };
        m.effect(Force { on: m.point("a.P"), value: Components(vector(["3", "-2", "1.5"])), frame });
        let value = AboutAxes(vector(["0.7", "-1.1", "0.4"]));
        m.effect(Torque { on: TorqueOn::Body(2), from: Some(BodyRef(1)), value, frame });
        let system = m.build();
        let state = on_sphere(&system, 5);
        let q = state.list(&system.q);
        let carried = |body: usize, value: Vector3<f64>| {
            if in_body { rotation(&q[SIZE * body + 3..SIZE * body + 7]) * value } else { value }
        };
        let speed = values(&system, &state, &names("a.P", "vx vy vz"));
        let [first, second] = ["a", "b"].map(|body| values(&system, &state, &names(body, "omega.x omega.y omega.z")));
        let expected = carried(0, push).dot(&speed) + carried(1, twist).dot(&(second - first));
        assert_close(power(&system, &state), expected, 1e-12);
    }
}

#[test]
fn springs_bushings_and_gravity_have_their_potential() {
    let zero = || PerAxis([0.0; 3].map(symdiff::Formula::number));
    let m = two_lumps();
    let spring = |along: Option<[symdiff::Formula; 3]>| SpringDamper {
        between: m.between("a.P", "b.P"),
        along: along.map(Direction),
        stiffness: formula("50"),
        damping: formula("0"),
        free_length: formula("0.4"),
        force: None,
    };
    let bushing = Bushing {
        between: m.between("a.P", "b.P"),
        stiffness: PerAxis(vector(["30", "50", "80"])),
        damping: zero(),
        torsional_stiffness: PerAxis(vector(["3", "5", "8"])),
        torsional_damping: zero(),
        stiffness_matrix: None,
        damping_matrix: None,
    };
    let gravity = Gravity { acceleration: Components(vector(["1", "-2", "-9.81"])) };
    let springs = [spring(None), spring(Some(vector(["1", "2", "-2"])))].map(EffectKind::SpringDamper);
    for kind in springs.into_iter().chain([bushing.into(), gravity.into()]) {
        let mut m = two_lumps();
        m.effect(kind);
        let system = m.build();
        for seed in 0..4 {
            let state = on_sphere(&system, seed);
            assert_close(power(&system, &state), -potential_rate(&system, &state), 1e-7);
        }
    }
}

/// Dampers take power, and none where the bodies move as one.
#[test]
fn a_bushing_damps_relative_motion_only() {
    let mut m = two_lumps();
    m.effect(Bushing {
        between: m.between("a.P", "b.P"),
        stiffness: PerAxis([0.0; 3].map(symdiff::Formula::number)),
        damping: PerAxis(vector(["3", "3", "3"])),
        torsional_stiffness: PerAxis([0.0; 3].map(symdiff::Formula::number)),
        torsional_damping: PerAxis(vector(["2", "2", "2"])),
        stiffness_matrix: None,
        damping_matrix: None,
    });
    let system = m.build();
    let mut state = on_sphere(&system, 9);
    assert!(power(&system, &state) < -1e-2);
    // Both turn by ω about the ground's origin: ṙ = ω × r, ṗ = ½ Eᵀ ω.
    let omega = Vector3::new(0.4, -0.9, 1.3);
    let q = state.list(&system.q);
    for body in 0..2 {
        let index = SIZE * body;
        let speed = omega.cross(&Vector3::from_column_slice(&q[index..index + 3]));
        let p = Quaternion::new(q[index + 3], q[index + 4], q[index + 5], q[index + 6]);
        let rate = Quaternion::from_imag(omega) * p * 0.5;
        let rates = speed.iter().copied().chain([rate.w, rate.i, rate.j, rate.k]);
        for (symbol, value) in system.v[index..index + SIZE].iter().zip(rates) {
            state.0.insert(*symbol, value);
        }
    }
    assert_close(power(&system, &state), 0.0, 1e-13);
}
