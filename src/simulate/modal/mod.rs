//! Small vibrations about a configuration: modes, how they are followed over the box, and what harmonic loads do.
//!
//! - `eigen`: frequencies, damping ratios and shapes;
//! - `follow`: which mode of one configuration is which of another;
//! - `response`: the frequency response.

mod eigen;
mod follow;
mod gradients;
mod likeness;
mod response;
mod vibrations;

pub use vibrations::{ALIKE, Place, Vibrations, further_outputs};
