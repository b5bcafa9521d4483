//! Values at the start.

use symdiff::Formula;

use crate::grammar::{Coordinate, JointCoordinate, PointRef, Rotation, TimeOrder};

/// A value at the start; formulas are of parameters.
#[derive(Clone, Debug)]
pub enum StartValue {
    /// Value of a coordinate.
    Coordinate {
        /// Body index, not the ground.
        body: usize,
        /// One that the body has.
        coordinate: Coordinate,
        /// Position or velocity.
        order: TimeOrder,
        /// SI.
        value: Formula,
    },
    /// Values of a body's Euler parameters.
    Orientation {
        /// Body index.
        body: usize,
        /// Rotation from the body's frame to the ground's.
        rotation: Rotation,
    },
    /// Angular velocity of a body that has an orientation, rad/s.
    AngularVelocity {
        /// Body index.
        body: usize,
        /// Components, rad/s.
        value: [Formula; 3],
        /// Components in the body's frame instead of the ground's.
        in_body: bool,
    },
    /// One angle of a body's orientation.
    RollPitchYaw {
        /// Body index.
        body: usize,
        /// Index of the angle: 0 to 2 for roll, pitch, yaw.
        angle: usize,
        /// rad
        value: Formula,
    },
    /// A part of a body's angular velocity.
    AngularRate {
        /// Body index.
        body: usize,
        /// Index of the component: 0 to 2 for x, y, z.
        axis: usize,
        /// Whether the axis is the body frame's instead of the ground's.
        in_body: bool,
        /// rad/s
        value: Formula,
    },
    /// Value of a point's position or velocity, along an axis of the ground.
    Point {
        /// The point, of a body that is not the ground.
        place: PointRef,
        /// x, y or z.
        coordinate: Coordinate,
        /// Position or velocity.
        order: TimeOrder,
        /// SI.
        value: Formula,
    },
    /// Value of a joint's coordinate.
    Joint {
        /// Joint index.
        joint: usize,
        /// One of its coordinates.
        coordinate: JointCoordinate,
        /// Position or velocity.
        order: TimeOrder,
        /// SI.
        value: Formula,
    },
}
