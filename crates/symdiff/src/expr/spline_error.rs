//! Points that make no spline.

/// Points that make no spline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SplineError {
    /// Fewer than two.
    #[error("a table has at least two points")]
    TooFew,
    /// The point at this place is not a finite number.
    #[error("point {} is not finite", .0 + 1)]
    NotFinite(usize),
    /// The point at this place does not come after the one before.
    #[error("point {} does not come after the one before", .0 + 1)]
    NotAscending(usize),
    /// A periodic one does not end with the value that it begins with.
    #[error("the last value is not the first")]
    NotPeriodic,
}
