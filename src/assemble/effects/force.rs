//! Force at a point of a body.
//!
//! ```text
//! F = value, or R value where given in the body's axes          N
//! ```
//!
//! It acts from outside the mechanism: nothing feels the reaction, and it has no potential.

use symdiff::{Builder, Formula};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::model::PointRef;

use super::Loads;

pub fn apply(
    g: &Builder,
    m: &Mechanism,
    loads: &mut Loads,
    on: PointRef,
    value: &[Formula; 3],
    in_body: bool,
) -> Result<(), BuildError> {
    let mut force = m.vector(g, value, Context::Motion)?;
    if in_body {
        force = m.bodies[on.body].rotate(g, force);
    }
    let point = m.point(g, on);
    loads.add_force(g, &point, force);
    Ok(())
}
