//! A ball about its frame's origin.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ShapeElement, ShapeFrame};
use crate::elements::form::Form;

/// A ball about its frame's origin; in the plane a disc.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "sphere",
    what = "a sphere",
    equation = "|r| ≤ R",
    source = "Ericson, Real-Time Collision Detection (2005), ch. 4",
    example = "{ radius: 0.03, position: [0.2, 0] }"
)]
pub struct Sphere {
    /// Radius R.
    #[quantity(unit = "m", constant, positive)]
    radius: Formula,
    #[group]
    pub(super) place: ShapeFrame,
}

impl ShapeElement for Sphere {
    fn form(&self) -> Form<Formula> {
        Form::Sphere { radius: self.radius.clone() }
    }
}
