//! Findings about a mechanism that its motion shows: singular configurations, loops that cannot be closed, undetermined reactions.

mod cannot_close;
mod singular;
mod undetermined;

pub use cannot_close::OpenConstraint;
pub use singular::{SingularPass, SingularWatch};
pub use undetermined::undetermined_outputs;
