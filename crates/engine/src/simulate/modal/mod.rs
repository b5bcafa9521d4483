//! Small vibrations about a configuration: modes, how they are followed over the box, and responses to harmonic loads.
//!
//! - `eigen`: frequencies, damping ratios and shapes; `follow`: which mode of one configuration is which of another;
//! - `first_order`: eigenvalues where there are states; `roots`: the same of them;
//! - `response`: the frequency response; `random`: responses to random excitations;
//! - `outputs`: names and units of all that.

mod eigen;
mod first_order;
mod follow;
mod gradients;
mod likeness;
mod outputs;
mod random;
mod response;
mod roots;
pub(crate) mod tuning;
mod vibrations;

pub use first_order::{Eigenvalue, eigenvalues};
pub use outputs::{further_outputs, is_one_number};
pub use vibrations::{ModesThere, Vibrations};
