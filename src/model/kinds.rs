//! The kinds of joints and effects of a [`Description`](super::Description), with their details.

use symdiff::Formula;

use super::description::PointRef;

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
            Self::Gear { .. } | Self::Rack { .. } | Self::Equation { .. } => None,
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

/// A coordinate of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum JointCoordinate {
    /// Angle of the second frame against the first about the joint's axis, rad, never wrapped.
    Angle,
    /// Of the second point from the first along the joint's axis, m.
    Displacement,
}

/// Something with an angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turning {
    /// The angle of a body about z.
    Body(usize),
    /// The angle of a joint.
    Joint(usize),
}

/// What an effect does; formulas stand in `mechanics::effects`. Values may depend on parameters, t, positions and
/// velocities.
#[derive(Clone, Debug)]
pub enum EffectKind {
    /// The same acceleration on every body, m/s².
    Gravity {
        #[allow(missing_docs)]
        acceleration: [Formula; 3],
    },
    /// A force at a point, N.
    Force {
        #[allow(missing_docs)]
        on: PointRef,
        #[allow(missing_docs)]
        value: [Formula; 3],
        /// Components in the body's frame instead of the ground's.
        in_body: bool,
    },
    /// A torque on a body, N m; its reaction acts on `from` (0: the ground).
    Torque {
        /// Body index.
        on: usize,
        /// Body index.
        from: usize,
        #[allow(missing_docs)]
        value: [Formula; 3],
        /// Components in the frame of `on` instead of the ground's.
        in_body: bool,
    },
    /// A torque on a joint's second body about the joint's axis, N m; its reaction acts on the first body.
    JointTorque {
        /// Joint index.
        joint: usize,
        #[allow(missing_docs)]
        value: Formula,
    },
    /// Between two points: along their connecting line, or along an axis of the ground.
    SpringDamper {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// Direction in the ground's frame; absent: along the connecting line.
        along: Option<[Formula; 3]>,
        /// N/m
        stiffness: Formula,
        /// N s/m
        damping: Formula,
        /// m
        free_length: Formula,
    },
    /// Between two bodies' angles, or on the angle of a joint.
    TorsionalSpringDamper {
        #[allow(missing_docs)]
        on: Twisted,
        /// N m/rad
        stiffness: Formula,
        /// N m s/rad
        damping: Formula,
        /// rad
        free_angle: Formula,
    },
    /// Springs and dampers between two frames, along and about the axes of the first.
    Bushing {
        #[allow(missing_docs)]
        between: [PointRef; 2],
        /// N/m
        stiffness: [Formula; 3],
        /// N s/m
        damping: [Formula; 3],
        /// N m/rad
        torsional_stiffness: [Formula; 3],
        /// N m s/rad
        torsional_damping: [Formula; 3],
    },
}

/// Whose angle a torsional spring twists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Twisted {
    /// angle₂ − angle₁ of two bodies, by index.
    Bodies([usize; 2]),
    /// The angle of a joint, by index.
    Joint(usize),
}

impl EffectKind {
    /// The word for it in a model file.
    pub fn keyword(&self) -> &'static str {
        match self {
            Self::Gravity { .. } => "gravity",
            Self::Force { .. } => "force",
            Self::Torque { .. } | Self::JointTorque { .. } => "torque",
            Self::SpringDamper { .. } => "spring_damper",
            Self::TorsionalSpringDamper { .. } => "torsional_spring_damper",
            Self::Bushing { .. } => "bushing",
        }
    }
}
