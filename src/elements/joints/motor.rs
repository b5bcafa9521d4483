//! Motor: a joint's coordinate moves as is prescribed.

use symdiff::Formula;

use crate::grammar::{JointCoordinate, OnJoint};

use super::Joint;

/// A joint's coordinate moves as is prescribed.
#[derive(Clone, Debug)]
pub struct Motor {
    /// Joint index.
    pub joint: usize,
    /// Which of its coordinates.
    pub coordinate: JointCoordinate,
    /// How that moves.
    pub motion: Prescribed,
}

impl Joint for Motor {
    fn coordinates(&self, _: usize) -> Vec<OnJoint> {
        vec![OnJoint { joint: self.joint, coordinate: self.coordinate }]
    }
}

/// How a motor moves a joint's coordinate.
#[derive(Clone, Debug)]
pub enum Prescribed {
    /// A formula of parameters and t.
    Position(Formula),
    /// At a speed, from a coordinate at t = 0.
    Speed {
        /// rad or m
        from: Formula,
        /// Of parameters and t; it has an integral ([`symdiff::Graph::integral`]).
        speed: Formula,
    },
    /// From rest to rest.
    Move {
        /// Over the duration.
        profile: Profile,
        /// rad or m
        from: Formula,
        /// rad or m
        to: Formula,
        /// s
        start: Formula,
        /// s
        duration: Formula,
    },
    /// From rest to a speed, which it then keeps.
    RunUp {
        /// Over the duration.
        profile: Profile,
        /// rad or m
        from: Formula,
        /// rad/s or m/s
        speed: Formula,
        /// s
        start: Formula,
        /// s
        duration: Formula,
    },
}

impl Prescribed {
    /// Every formula in it.
    pub fn formulas(&self) -> Vec<&Formula> {
        match self {
            Self::Position(position) => vec![position],
            Self::Speed { from, speed } => vec![from, speed],
            Self::Move { profile, from, to: end, start, duration }
            | Self::RunUp { profile, from, speed: end, start, duration } => {
                let ramp = match profile {
                    Profile::Trapezoidal { ramp } => Some(ramp),
                    Profile::Cycloidal | Profile::Quintic => None,
                };
                [from, end, start, duration].into_iter().chain(ramp).collect()
            }
        }
    }
}

/// How a value changes from one to another.
#[derive(Clone, Debug)]
pub enum Profile {
    /// An acceleration that is a sine.
    Cycloidal,
    /// A polynomial with rates and accelerations zero at the ends.
    Quintic,
    /// A constant rate between constant accelerations.
    Trapezoidal {
        /// Part of the duration that each acceleration takes, at most ½.
        ramp: Formula,
    },
}
