//! The front door: a [`Model`], a [`Study`] of it, and the results of the study.

mod builder;
mod error;
mod model;
mod result;
mod samples;
mod study;
mod sweep;
mod value;

pub use builder::ModelBuilder;
pub use error::Error;
pub use model::Model;
pub use result::{Band, Output, StudyResult, write_cost};
pub use samples::Samples;
pub use study::Study;
pub use sweep::{Axis, Sweep};
pub use value::Value;
