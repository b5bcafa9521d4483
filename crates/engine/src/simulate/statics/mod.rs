//! Configurations at rest, and the equations about a configuration.
//!
//! - `configuration`: the equations at one configuration, with their derivatives, as small dense matrices;
//! - `equilibrium`: where forces are in equilibrium; `jets`: how that changes with the parameters;
//! - `stability`: the smallest eigenvalue there.

mod adjoint;
mod configuration;
mod equilibrium;
mod jets;
mod scaled;
mod stability;
pub(crate) mod tuning;

pub use configuration::{Linearised, StaticConfiguration, reduced, times};
pub use equilibrium::{Equilibrium, NoEquilibrium};
