//! Torque on a body.
//!
//! ```text
//! Q_θ(on) = +value,   Q_θ(from) = −value          N m, counter-clockwise
//! ```
//!
//! A motor between two bodies; from the ground, the reaction is the ground's. It has no potential.

use symdiff::{Formula, Graph};

use crate::mechanics::error::BuildError;
use crate::mechanics::mechanism::{Context, Mechanism};

use super::Loads;

pub fn apply(
    g: &mut Graph,
    m: &Mechanism,
    loads: &mut Loads,
    on: usize,
    from: usize,
    value: &Formula,
) -> Result<(), BuildError> {
    let torque = m.formula(g, value, Context::Motion)?;
    loads.add_torque_pair(g, from, on, torque);
    Ok(())
}
