//! Findings about a mechanism that its motion shows: singular configurations, loops that cannot be closed, terms that
//! are no finite numbers, undetermined reactions.

mod cannot_close;
mod not_finite;
mod outside;
mod over_constrained;
mod overlap;
mod overlapping;
mod parted;
mod singular;
pub(crate) mod tuning;
mod undetermined;

pub use cannot_close::OpenConstraint;
pub use not_finite::{not_finite, place_of, written};
pub use outside::outside;
pub use over_constrained::over_constrained;
pub use overlap::{OverlapWatch, TooDeep};
pub use overlapping::overlapping;
pub use parted::PartingWatch;
pub use singular::{SingularPass, SingularWatch};
pub use undetermined::undetermined_outputs;
