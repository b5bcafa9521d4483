//! The frame of a solid relative to its body's, and to the ground's.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use symdiff::math;

use crate::results::{DrawnBody, DrawnSolid};

/// A frame relative to another.
#[derive(Clone, Copy, Debug)]
pub(in crate::export) struct SolidFrame {
    position: Vector3<f64>,
    rotation: UnitQuaternion<f64>,
}

fn unit([w, x, y, z]: [f64; 4]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
}

impl SolidFrame {
    /// The identity.
    pub fn still() -> Self {
        Self { position: Vector3::zeros(), rotation: UnitQuaternion::identity() }
    }

    /// The frame of a solid relative to its body's.
    pub fn in_body(solid: &DrawnSolid) -> Self {
        Self { position: solid.position.into(), rotation: unit(solid.orientation) }
    }

    /// The frame of a solid relative to the ground's.
    pub fn in_ground(solid: &DrawnSolid, body: &DrawnBody) -> Self {
        let rotation = match (body.orientation, body.angle) {
            (Some(parameters), _) => unit(parameters),
            (None, Some(angle)) => unit([math::cos(0.5 * angle), 0.0, 0.0, math::sin(0.5 * angle)]),
            (None, None) => UnitQuaternion::identity(),
        };
        let own = Self::in_body(solid);
        let position = Vector3::from(body.position) + rotation * own.position;
        Self { position, rotation: rotation * own.rotation }
    }

    /// The frame whose origin is at a point, and whose z is along an axis.
    pub fn along(&self, at: [f64; 3], axis: [f64; 3]) -> Self {
        let axis = Vector3::from(axis).try_normalize(0.0).unwrap_or_else(Vector3::z);
        let across = Vector3::z().cross(&axis);
        // Half the angle between both; the rotation between opposite directions is not unique.
        let turn = if axis.z > -1.0 + 1e-12 {
            unit([1.0 + axis.z, across.x, across.y, across.z])
        } else {
            unit([0.0, 1.0, 0.0, 0.0])
        };
        Self { position: self.place(at).into(), rotation: self.rotation * turn }
    }

    /// A point of the frame, in the other.
    pub fn place(&self, point: [f64; 3]) -> [f64; 3] {
        (self.position + self.rotation * Vector3::from(point)).into()
    }

    /// A direction of the frame, in the other.
    pub fn direction(&self, direction: [f64; 3]) -> [f64; 3] {
        (self.rotation * Vector3::from(direction)).into()
    }

    /// The origin, in the other.
    pub fn position(&self) -> [f64; 3] {
        self.position.into()
    }

    /// Euler parameters.
    pub fn orientation(&self) -> [f64; 4] {
        let turned = self.rotation.quaternion();
        [turned.w, turned.i, turned.j, turned.k]
    }
}
