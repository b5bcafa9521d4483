//! Force at a point of a body.
//!
//! ```text
//! F = value, or R value where given in the body's axes          N
//! ```
//!
//! It acts from outside the mechanism: nothing feels the reaction, and it has no potential.

use symdiff::Builder;

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::model::Force;
use crate::model::force::Frame;

use super::Loads;

pub fn apply(
    g: &Builder,
    m: &Mechanism,
    loads: &mut Loads,
    effect: &Force,
) -> Result<(), BuildError> {
    let mut force = m.vector(g, &effect.value, Context::Motion)?;
    if effect.frame == Frame::Body {
        force = m.bodies[effect.on.body].rotate(g, force);
    }
    let point = m.point(g, effect.on);
    loads.add_force(g, &point, force);
    Ok(())
}
