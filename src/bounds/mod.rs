//! Trajectories → [`Bounds`]: which parameters to run, and what their responses say of the whole box.

mod result;

pub use result::{Band, Bounds, Method, OutputBounds};
