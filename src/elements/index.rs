//! Indices of the bodies, points and joints of a description, by which elements refer to them.

/// A point of a body, or its origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointRef {
    /// Index of a body.
    pub body: usize,
    /// Index into that body's points.
    pub point: Option<usize>,
}

/// A coordinate of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum JointCoordinate {
    /// Angle of the second frame against the first about the joint's axis, rad, never wrapped.
    Angle,
    /// Displacement of the second point from the first along the joint's axis, m.
    Displacement,
}

/// One coordinate of one joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct OnJoint {
    /// Index of a joint.
    pub joint: usize,
    /// Which of its coordinates.
    pub coordinate: JointCoordinate,
}

/// An angle: that of a body about z, or that of a joint about its axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleOf {
    /// Index of a body.
    Body(usize),
    /// Index of a joint.
    Joint(usize),
}
