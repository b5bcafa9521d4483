//! Values at the start.

use symdiff::Formula;

use crate::grammar::{Coordinate, JointCoordinate, Rotation, TimeOrder};

/// A value at the start; formulas are of parameters.
#[derive(Clone, Debug)]
pub enum StartValue {
    /// Of a coordinate.
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
    /// Of a body's Euler parameters.
    Orientation {
        /// Body index.
        body: usize,
        /// From the body's frame to the ground's.
        rotation: Rotation,
    },
    /// Of a body that has an orientation, rad/s.
    AngularVelocity {
        /// Body index.
        body: usize,
        /// Components, rad/s.
        value: [Formula; 3],
        /// Components in the body's frame instead of the ground's.
        in_body: bool,
    },
    /// Of a joint's coordinate.
    Joint {
        /// Joint index.
        joint: usize,
        /// Which of its coordinates.
        coordinate: JointCoordinate,
        /// Position or velocity.
        order: TimeOrder,
        /// SI.
        value: Formula,
    },
}
