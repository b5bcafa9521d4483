//! Laws of random parameters, points that are spread evenly by them, and what samples of a quantity say of it.

mod beta;
mod copula;
mod distribution;
mod estimates;
mod points;
mod special;

pub use copula::Copula;
pub use distribution::Distribution;
pub use estimates::share_interval;
pub use estimates::{Estimate, Replicates};
pub use points::{REPLICATES, replicate};
