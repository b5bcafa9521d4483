//! `springdamper`: stiffness and damping of a joint by a time constant T and a damping ratio ζ,
//!
//! ```text
//! k = m/(T ζ)²,   d = 2 m/T,   1/m = (M⁻¹)ⱼⱼ
//! ```
//!
//! where M is the mass matrix of the joints in the file's configuration, with armatures: m is the inertia that a force
//! in the joint feels while all others are free. And `dampratio`: the damping of an actuator that holds a position with
//! the gain kₚ,
//!
//! ```text
//! kᵥ = 2 ζ √(kₚ m),   1/m = g M⁻¹ gᵀ
//! ```
//!
//! where g is the gradient of its length: it feels the mass m while all else is free.

use nalgebra::{DMatrix, DVector, Vector3};

use super::flags::{Flags, on};
use super::robot::{ActuatorLaw, Joint, MjcfType, Robot};
use crate::robots::algebra::{self, Pose, Value, Vector};

/// A velocity of one joint, in the world.
struct Degree {
    joint: usize,
    /// Axis, along or about which it moves.
    axis: Vector3<f64>,
    /// Point on the axis, if it turns.
    about: Option<Vector3<f64>>,
}

/// Sets stiffness and damping of all joints that have them so.
pub fn set(robot: &mut Robot, flags: Flags) {
    if robot.joints.iter().all(|joint| joint.spring_damper.is_none()) {
        return;
    }
    let poses = poses(robot);
    let degrees = degrees(robot, &poses);
    // Where it is singular the start of the motion says so.
    let Some(inverse) = mass_matrix(robot, &poses, &degrees).try_inverse() else { return };
    for (index, degree) in degrees.iter().enumerate() {
        let joint = &mut robot.joints[degree.joint];
        let Some([time, ratio]) = joint.spring_damper.filter(|_| joint.is_single()) else { continue };
        let moved = 1.0 / inverse[(index, index)];
        joint.stiffness.value = on(flags.springs) * moved / (time * time * ratio * ratio);
        joint.damping.value = on(flags.dampers) * 2.0 * moved / time;
    }
}

/// Sets the damping of all actuators that have a damping ratio.
pub fn damp_actuators(robot: &mut Robot) {
    if robot.actuators.iter().all(|actuator| actuator.damping_ratio.is_none()) {
        return;
    }
    let poses = poses(robot);
    let degrees = degrees(robot, &poses);
    let Some(inverse) = mass_matrix(robot, &poses, &degrees).try_inverse() else { return };
    for actuator in &mut robot.actuators {
        let Some(ratio) = actuator.damping_ratio else { continue };
        let mut gradient = DVector::zeros(degrees.len());
        for &(joint, by) in &actuator.on.terms {
            if let Some(index) = degrees.iter().position(|degree| degree.joint == joint) {
                gradient[index] += actuator.gear.value * by;
            }
        }
        let mass = 1.0 / gradient.dot(&(&inverse * &gradient));
        match &mut actuator.law {
            ActuatorLaw::Position { kp, kv } => kv.value = 2.0 * ratio * (kp.value * mass).sqrt(),
            ActuatorLaw::Affine { gain, bias } => bias[2] = -2.0 * ratio * (*gain * mass).sqrt(),
            ActuatorLaw::Velocity { .. } | ActuatorLaw::Damper { .. } => {}
        }
    }
}

/// Where bodies are in the world, in the file's configuration.
fn poses(robot: &Robot) -> Vec<Pose> {
    let mut poses = vec![Pose::identity()];
    for body in robot.bodies.iter().skip(1) {
        let position = body.position.each_ref().map(|number| Value::Number(number.value));
        poses.push(poses[body.parent].then(&position, &body.rotation));
    }
    poses
}

fn plain(vector: &Vector) -> Vector3<f64> {
    Vector3::from(algebra::numbers(vector).unwrap_or_default())
}

fn degrees(robot: &Robot, poses: &[Pose]) -> Vec<Degree> {
    let mut degrees = Vec::new();
    for (index, joint) in robot.joints.iter().enumerate() {
        let Joint { kind, body, position, axis, .. } = joint;
        let here = &poses[*body];
        let at = plain(&here.then(&algebra::vector(*position), &algebra::identity()).position);
        let axis = plain(&algebra::rotate(&here.rotation, &algebra::vector(*axis)));
        let mut add = |axis, about| degrees.push(Degree { joint: index, axis, about });
        let all = [Vector3::x(), Vector3::y(), Vector3::z()];
        match kind {
            MjcfType::Hinge => add(axis, Some(at)),
            MjcfType::Slide => add(axis, None),
            MjcfType::Ball => all.into_iter().for_each(|axis| add(axis, Some(at))),
            MjcfType::Free => {
                all.into_iter().for_each(|axis| add(axis, None));
                all.into_iter().for_each(|axis| add(axis, Some(at)));
            }
        }
    }
    degrees
}

fn mass_matrix(robot: &Robot, poses: &[Pose], degrees: &[Degree]) -> DMatrix<f64> {
    let armatures = degrees.iter().map(|degree| robot.joints[degree.joint].armature.value);
    let mut matrix = DMatrix::from_diagonal(&DVector::from_iterator(degrees.len(), armatures));
    for (index, body) in robot.bodies.iter().enumerate() {
        let Some(mass) = &body.mass else { continue };
        let center = mass.center.each_ref().map(|number| Value::Number(number.value));
        let pose = poses[index].then(&center, &mass.rotation);
        let [xx, yy, zz, xy, xz, yz] = mass.inertia.each_ref().map(|number| Value::Number(number.value));
        let tensor = [[xx, xy.clone(), xz.clone()], [xy, yy, yz.clone()], [xz, yz, zz]];
        let [x, y, z] = algebra::rotate_tensor(&pose.rotation, &tensor).each_ref().map(plain);
        let tensor = nalgebra::Matrix3::from_columns(&[x, y, z]);
        let center = plain(&pose.position);
        // Degrees of freedom that move it: index, velocity of its centre, angular velocity.
        let mut moving = Vec::new();
        let mut above = index;
        while above != 0 {
            let own = degrees.iter().enumerate().filter(|(_, degree)| robot.joints[degree.joint].body == above);
            moving.extend(own.map(|(place, degree)| match degree.about {
                Some(at) => (place, degree.axis.cross(&(center - at)), degree.axis),
                None => (place, degree.axis, Vector3::zeros()),
            }));
            above = robot.bodies[above].parent;
        }
        for (row, velocity, spin) in &moving {
            for (column, other, turn) in &moving {
                matrix[(*row, *column)] += mass.mass.value * velocity.dot(other) + spin.dot(&(tensor * turn));
            }
        }
    }
    matrix
}
