//! Questions of the page to the workers.

use crate::numerics::Sample;
use crate::study::Grip;

/// A requested sample.
pub struct Values {
    /// The model.
    pub number: u64,
    /// Values of the uncertain parameters.
    pub sample: Sample,
}

/// A question about the mechanism.
pub enum Move {
    /// Its motion at a sample: the model's number, and values of the uncertain parameters.
    Motion(u64, Sample),
    /// A point of it dragged to a position.
    Drag(Drag),
}

/// A point that is dragged to a position.
pub struct Drag {
    /// The model.
    pub number: u64,
    /// Values of the uncertain parameters.
    pub sample: Sample,
    /// The point.
    pub grip: Grip,
    /// The position, m.
    pub place: [f64; 3],
    /// Poses from which the hand begins; without them, the present ones.
    pub from: Option<Vec<f64>>,
}

/// Error for a question of another model.
pub fn replaced() -> String {
    "the model has changed meanwhile".to_owned()
}
