//! What values of keys are to an instance that is mirrored or turned.
//!
//! The type of a key says it ([`super::Value::IMAGE`]), or the key itself: `#[key(image = Turning)]`. So a new element
//! has its images by its struct.

/// What a value is to a mirror.
#[derive(Clone, Copy, Debug)]
pub enum Image {
    /// The same: a length, a stiffness, a name.
    Same,
    /// A vector, or an axis by its letter.
    Polar,
    /// A vector of a torque; one number is about z, or about the axis of the joint of `on`.
    Axial,
    /// A list of polar vectors, some of them ends of arcs.
    Polars,
    /// A rotation: its axis is axial, its angle stays.
    Rotation,
    /// Factors along three axes, or one for all: that across a mirror changes its sign.
    Factors,
    /// A number that counts the other way where the joint of `on` turns, or there is none.
    Turning,
    /// A number that counts the other way where the joint of `on` turns.
    Effort,
    /// The end of a range: it changes its key with the other end, and counts the other way as [`Image::Turning`].
    End(&'static str),
    /// A number along an axis, 0 to 2.
    Along(usize),
    /// A number about an axis, 0 to 2.
    About(usize),
    /// A product of two components.
    Product([usize; 2]),
    /// A polar vector, or a mapping with keys of its own.
    PolarOr(fn() -> Vec<KeyImage>),
    /// A mapping by names, of which each has this image.
    Named(&'static Image),
    /// A shape, or a list of them.
    Shapes,
    /// Six rows by displacements along axes and rotations about them.
    SixRows,
    /// A mapping with keys of its own.
    Keys(fn() -> Vec<KeyImage>),
    /// Not declared.
    Unknown,
}

/// A key with its image.
#[derive(Clone, Debug)]
pub struct KeyImage {
    /// As it is written.
    pub name: &'static str,
    /// What its value is to a mirror.
    pub image: Image,
    /// Whether its components are along the axes of the ground, so that they turn with an instance.
    pub in_ground: bool,
    /// What holds where the key is not there.
    pub default: Option<serde_json::Value>,
}
