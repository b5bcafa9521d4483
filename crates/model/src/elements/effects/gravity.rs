//! Gravity: the same acceleration on every body.
//!
//! ```text
//! F = m g at the centre of mass,   V = −m g · r_c          N, J
//! ```
//!
//! and on the mass along beams (`flexible`).
//! g in m/s², in the ground's axes: (0, −9.81) pulls down. V is zero at the ground's origin.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ForceElement, Forces, Scope, TypedSensor};
use crate::grammar::Components;
use crate::multibody::BuildError;

/// The same acceleration on every body.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "gravity",
    what = "`gravity`",
    equation = "F = m g at each centre of mass",
    source = "Newton",
    example = "{ acceleration: [0, -9.81] }"
)]
pub struct Gravity {
    /// Acceleration in the ground's axes: [0, -9.81] pulls down.
    #[quantity(unit = "m/s^2")]
    pub acceleration: Components,
}

impl ForceElement for Gravity {
    const SENSORS: &'static [TypedSensor] = &[];

    const SCOPE: Scope = Scope::EveryBody;

    fn direction(&self) -> Option<&[Formula; 3]> {
        Some(&self.acceleration)
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let acceleration = forces.vector(&self.acceleration)?;
        forces.weight(acceleration)
    }
}
