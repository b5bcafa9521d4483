//! A part of the box with its polynomials.

use super::surrogate::{SegmentErrors, SegmentSurrogate};

/// A part of the box.
pub(super) struct Piece<'a> {
    pub surrogate: SegmentSurrogate<'a>,
    pub errors: SegmentErrors,
    /// ξ of its samples.
    pub samples: Vec<Vec<f64>>,
}
