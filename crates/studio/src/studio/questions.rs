//! Questions of the page to the workers.

use crate::numerics::Sample;
use crate::study::Grip;

/// A sample that the page wants.
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
    /// A point of it at a place.
    Drag(Drag),
}

/// A point that is taken to a place.
pub struct Drag {
    /// The model.
    pub number: u64,
    /// Values of the uncertain parameters.
    pub sample: Sample,
    /// The point.
    pub grip: Grip,
    /// The place, m.
    pub place: [f64; 3],
    /// Poses from which the hand begins; where it is, where there are none.
    pub from: Option<Vec<f64>>,
}

/// Why a question of another model has no answer.
pub fn replaced() -> String {
    "the model has changed meanwhile".to_owned()
}
