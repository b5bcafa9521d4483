//! A cylinder about an axis through its frame's origin, which is its middle.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ShapeElement, ShapeFrame};
use crate::elements::form::Form;
use crate::grammar::SpaceAxis;

/// A cylinder about its frame's origin.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "cylinder",
    what = "a cylinder",
    equation = "|u · r| ≤ L/2, |r − (u · r) u| ≤ R",
    source = "Ericson, Real-Time Collision Detection (2005), ch. 4",
    example = "{ radius: 0.05, length: 0.02, axis: z }"
)]
pub struct Cylinder {
    /// Radius R.
    #[quantity(unit = "m", constant, positive)]
    radius: Formula,
    /// Length L, along the axis.
    #[quantity(unit = "m", constant, positive)]
    length: Formula,
    /// Axis u, any one also in the plane: about z it is a disc there.
    #[key(default = SpaceAxis::z())]
    axis: SpaceAxis,
    #[group]
    pub(super) place: ShapeFrame,
}

impl ShapeElement for Cylinder {
    fn form(&self) -> Form<Formula> {
        Form::Cylinder { axis: self.axis.0.clone(), length: self.length.clone(), radius: self.radius.clone() }
    }
}
