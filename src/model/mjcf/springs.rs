//! `springdamper`: stiffness and damping of a joint by a time constant T and a damping ratio ζ,
//!
//! ```text
//! k = m/(T ζ)²,   d = 2 m/T
//! ```
//!
//! where m is what the joint moves in the file's configuration: moment of inertia about a hinge, mass on a slide, each with its
//! armature.

use super::flags::{Flags, on};
use super::robot::{Joint, Kind, Robot};
use crate::model::robots::algebra::{self, Pose, Value, Vector};

/// Sets stiffness and damping of all joints that have them so.
pub fn set(robot: &mut Robot, flags: Flags) {
    if robot.joints.iter().all(|joint| joint.spring_damper.is_none()) {
        return;
    }
    let poses = poses(robot);
    for index in 0..robot.joints.len() {
        let joint = &robot.joints[index];
        let Some([time, ratio]) = joint.spring_damper.filter(|_| joint.is_single()) else { continue };
        let moved = moved(robot, &poses, joint) + joint.armature.value;
        let joint = &mut robot.joints[index];
        joint.stiffness.value = on(flags.springs) * moved / (time * time * ratio * ratio);
        joint.damping.value = on(flags.dampers) * 2.0 * moved / time;
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

fn plain(vector: &Vector) -> [f64; 3] {
    algebra::numbers(vector).unwrap_or_default()
}

/// Moment of inertia about a joint's axis, or mass, of all that the joint moves.
fn moved(robot: &Robot, poses: &[Pose], joint: &Joint) -> f64 {
    let mut is_moved = vec![false; robot.bodies.len()];
    let here = &poses[joint.body];
    let at = plain(&here.then(&algebra::vector(joint.position), &algebra::identity()).position);
    let axis = plain(&algebra::rotate(&here.rotation, &algebra::vector(joint.axis)));
    let mut sum = 0.0;
    for (index, body) in robot.bodies.iter().enumerate() {
        is_moved[index] = index == joint.body || index > 0 && is_moved[body.parent];
        let Some(mass) = body.mass.as_ref().filter(|_| is_moved[index]) else { continue };
        if joint.kind == Kind::Slide {
            sum += mass.mass.value;
            continue;
        }
        let center = mass.center.each_ref().map(|number| Value::Number(number.value));
        let pose = poses[index].then(&center, &mass.rotation);
        let [xx, yy, zz, xy, xz, yz] = mass.inertia.each_ref().map(|number| number.value);
        // The axis in the inertia's frame.
        let [x, y, z] = plain(&algebra::rotate(&algebra::inverse(&pose.rotation), &algebra::vector(axis)));
        sum += xx * x * x + yy * y * y + zz * z * z + 2.0 * (xy * x * y + xz * x * z + yz * y * z);
        let center = plain(&pose.position);
        let [a, b, c] = [0, 1, 2].map(|i| center[i] - at[i]);
        let [p, q, r] = axis;
        let across = [q * c - r * b, r * a - p * c, p * b - q * a];
        sum += mass.mass.value * across.iter().map(|part| part * part).sum::<f64>();
    }
    sum
}
