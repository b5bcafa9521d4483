//! Points that do not define a spline.

/// Points that do not define a spline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SplineError {
    /// Fewer than two points.
    #[error("a table has at least two points")]
    TooFew,
    /// The point with this index is not a finite number.
    #[error("point {} is not finite", .0 + 1)]
    NotFinite(usize),
    /// The point with this index does not come after the one before.
    #[error("point {} does not come after the one before", .0 + 1)]
    NotAscending(usize),
    /// A periodic one has different values at its beginning and its end.
    #[error("the last value is not the first")]
    NotPeriodic,
}
