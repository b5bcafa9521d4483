//! Images of values of keys in a mirrored or turned instance.
//!
//! The type of a key determines its image ([`super::Value::IMAGE`]), or the key itself does: `#[key(image = Turning)]`.
//! So the struct of a new element gives its images.

/// Image of a value in a mirror.
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
    /// Factors along three axes, or one for all: the factor across a mirror changes its sign.
    Factors,
    /// A number that changes its sign if the joint of `on` turns, or if there is no `on`.
    Turning,
    /// A number that changes its sign if the joint of `on` turns.
    Effort,
    /// The end of a range: it exchanges its key with the other end, and changes its sign as [`Image::Turning`].
    End(&'static str),
    /// A number along an axis, 0 to 2.
    Along(usize),
    /// A number about an axis, 0 to 2.
    About(usize),
    /// A product of two components.
    Product([usize; 2]),
    /// A polar vector, or a mapping with keys of its own.
    PolarOr(fn() -> Vec<KeyImage>),
    /// A mapping by names, each of whose values has this image.
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
    /// Image of its value in a mirror.
    pub image: Image,
    /// Whether its components are along the axes of the ground, so that they turn with an instance.
    pub in_ground: bool,
    /// Default of the key.
    pub default: Option<serde_json::Value>,
}
