//! Things with an angle, by index.

/// Something with an angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rotating {
    /// The angle of a body about z, against the ground that it is in: the model's, or that of an instance.
    Body {
        /// Index of the body.
        body: usize,
        /// Index of the ground.
        ground: usize,
    },
    /// The angle of a joint.
    Joint(usize),
}

impl Rotating {
    /// The angle of a body in the model.
    pub fn of_body(body: usize) -> Self {
        Self::Body { body, ground: 0 }
    }
}
