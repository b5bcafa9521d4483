//! Laws of random parameters, points that are spread evenly by them, and estimates from samples of a quantity.

mod beta;
mod copula;
mod distribution;
mod estimates;
mod joint_law;
mod mixture;
mod normals;
mod order;
mod points;
mod quantiles;
mod rare;
mod rays;
mod special;
mod subset;
pub(crate) mod tuning;

pub use beta::beta_quantile;
pub use copula::Copula;
pub use distribution::Distribution;
pub use estimates::share_interval;
pub use estimates::{Estimate, Replicates};
pub use joint_law::JointLaw;
pub use mixture::{Mixture, least_at_distance, shares_below, weighted_quantile};
pub use normals::Normals;
pub use order::{SampleQuantile, has_interval, sample_deviation, sample_mean, sample_quantile};
pub use points::{REPLICATES, replicate};
pub use rare::{RareShare, least_slacks, rare_share};
pub use special::normal_quantile;
