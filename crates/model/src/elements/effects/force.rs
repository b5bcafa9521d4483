//! Force at a point of a body.
//!
//! ```text
//! F = value, or R value where given in the body's axes          N
//! ```
//!
//! It acts from outside the mechanism: nothing feels the reaction, and it has no potential.

use mbint_derive::{Choice, Element};
use symdiff::Formula;

use super::{ForceElement, Forces, TypedSensor};
use crate::elements::Glyph;
use crate::grammar::{Components, PointRef};
use crate::multibody::BuildError;

/// A force at a point.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "force",
    what = "a force",
    equation = "F = value",
    source = "Newton",
    example = "{ on: ball, value: [20*sin(3*t), 0] }"
)]
pub struct Force {
    /// Where it acts: `body.point` or `body`.
    pub on: PointRef,
    /// The force; may depend on t, positions and velocities.
    #[quantity(unit = "N")]
    #[key(in_ground)]
    pub value: Components,
    /// Whose axes the components are along.
    #[key(default = ForceFrame::Ground)]
    pub frame: ForceFrame,
}

/// Whose axes components are along.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Choice)]
pub enum ForceFrame {
    /// Components along the ground's axes.
    Ground,
    /// Components along the body's axes.
    Body,
}

impl ForceElement for Force {
    const GLYPH: Glyph = Glyph::Force;
    const SENSORS: &'static [TypedSensor] = &[];

    fn direction(&self) -> Option<&[Formula; 3]> {
        (self.frame == ForceFrame::Ground).then_some(&*self.value)
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let mut force = forces.vector(&self.value)?;
        if self.frame == ForceFrame::Body {
            force = forces.rotated(self.on.body, force);
        }
        let point = forces.point(self.on);
        forces.at(&point, force);
        Ok(())
    }
}
