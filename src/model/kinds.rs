//! The kinds of joints of a [`Description`](super::Description), with their details.

use symdiff::Formula;

use crate::grammar::{JointCoordinate, PointRef, Turning};

/// What a joint constrains; equations stand in `mechanics::joints`.
///
/// A joint is between two points A and B with frames. Axes are directions in both frames alike (any length but zero):
/// where the joint's angle is zero, the frames' axes are parallel.
#[derive(Clone, Debug)]
pub enum JointKind {
    /// Two points coincide and the frames turn about an axis against one another.
    Revolute {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// In the plane: z.
        axis: [Formula; 3],
    },
    /// The second point moves along a line through the first, fixed in the first body; no relative rotation, the second
    /// frame being turned by `angle` about the first's z.
    Prismatic {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        #[allow(missing_docs)]
        axis: [Formula; 3],
        /// rad
        angle: Formula,
    },
    /// Welded: points coincide, and the second frame is turned by `angle` about the first's z.
    Fixed {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// rad
        angle: Formula,
        /// Whether both bodies move as one, so that there is no reaction between them; a file cannot say so.
        merged: bool,
    },
    /// The second point moves along a line through the first, fixed in the first body; it may turn about the frames' z.
    PinInSlot {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        #[allow(missing_docs)]
        axis: [Formula; 3],
    },
    /// The second point moves along the axis through the first, and the frames turn about it.
    Cylindrical {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        #[allow(missing_docs)]
        axis: [Formula; 3],
    },
    /// A cylindrical joint that advances by `pitch` a turn.
    Screw {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        #[allow(missing_docs)]
        axis: [Formula; 3],
        /// m a turn; right-handed where positive.
        pitch: Formula,
    },
    /// Two points coincide.
    Spherical {
        #[allow(missing_docs)]
        between: [PointRef; 2],
    },
    /// Two points coincide, and an axis of the first frame stays perpendicular to one of the second.
    Universal {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// Of the first frame, and of the second.
        axes: [[Formula; 3]; 2],
    },
    /// The second point moves in a plane through the first, and the frames turn about its normal.
    Planar {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        #[allow(missing_docs)]
        normal: [Formula; 3],
    },
    /// The second point moves along a line through the first, fixed in the first body.
    PointOnLine {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        #[allow(missing_docs)]
        axis: [Formula; 3],
    },
    /// The second point moves in a plane through the first, fixed in the first body.
    PointOnPlane {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        #[allow(missing_docs)]
        normal: [Formula; 3],
    },
    /// The points keep a distance, m.
    Distance {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// m, > 0
        length: Formula,
    },
    /// angle₂ = ratio · angle₁ + offset. An external gear pair has a negative ratio.
    Gear {
        #[allow(missing_docs)]
        between: [Turning; 2],
        #[allow(missing_docs)]
        ratio: Formula,
        /// rad
        offset: Formula,
    },
    /// displacement of the rack's joint = radius · angle of the pinion's joint + offset.
    Rack {
        /// Joint index.
        pinion: usize,
        /// Joint index.
        rack: usize,
        /// m a radian
        radius: Formula,
        /// m
        offset: Formula,
    },
    /// A joint's coordinate moves as is prescribed.
    Motor {
        /// Joint index.
        joint: usize,
        #[allow(missing_docs)]
        coordinate: JointCoordinate,
        #[allow(missing_docs)]
        motion: Prescribed,
    },
    /// left = right, a formula of coordinates, points, parameters and t.
    Equation {
        #[allow(missing_docs)]
        left: Formula,
        #[allow(missing_docs)]
        right: Formula,
    },
}

impl JointKind {
    /// The points that it is between; `None` for couplings and equations.
    pub fn between(&self) -> Option<[PointRef; 2]> {
        match self {
            Self::Revolute { between, .. }
            | Self::Prismatic { between, .. }
            | Self::Fixed { between, .. }
            | Self::PinInSlot { between, .. }
            | Self::Cylindrical { between, .. }
            | Self::Screw { between, .. }
            | Self::Spherical { between }
            | Self::Universal { between, .. }
            | Self::Planar { between, .. }
            | Self::PointOnLine { between, .. }
            | Self::PointOnPlane { between, .. }
            | Self::Distance { between, .. } => Some(*between),
            Self::Gear { .. } | Self::Rack { .. } | Self::Motor { .. } | Self::Equation { .. } => None,
        }
    }

    /// The axis about which, or along which, the joint has the coordinate; `None` where it has it not.
    pub fn axis_of(&self, coordinate: JointCoordinate) -> Option<&[Formula; 3]> {
        match (self, coordinate) {
            (Self::Revolute { axis, .. }, JointCoordinate::Angle)
            | (Self::Prismatic { axis, .. }, JointCoordinate::Displacement)
            | (Self::Cylindrical { axis, .. } | Self::Screw { axis, .. }, _) => Some(axis),
            _ => None,
        }
    }
}

/// How a motor moves a joint's coordinate.
#[derive(Clone, Debug)]
pub enum Prescribed {
    /// A formula of parameters and t.
    Position(Formula),
    /// At a speed, from a coordinate at t = 0.
    Speed {
        #[allow(missing_docs)]
        from: Formula,
        /// Of parameters and t; it has an integral ([`symdiff::Graph::integral`]).
        speed: Formula,
    },
    /// From rest to rest.
    Move {
        #[allow(missing_docs)]
        profile: Profile,
        #[allow(missing_docs)]
        from: Formula,
        #[allow(missing_docs)]
        to: Formula,
        /// s
        start: Formula,
        /// s
        duration: Formula,
    },
    /// From rest to a speed, which it then keeps.
    RunUp {
        #[allow(missing_docs)]
        profile: Profile,
        #[allow(missing_docs)]
        from: Formula,
        #[allow(missing_docs)]
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

/// The way from one value to another; formulas stand in `mechanics::joints::motor`.
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
