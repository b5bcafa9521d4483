//! A box about its frame's origin.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ShapeElement, ShapeFrame};
use crate::elements::effects::check_lengths;
use crate::elements::form::Form;
use crate::grammar::{Checked, Fields, Reader, SpacePoint, SymbolTable};

/// A box about its frame's origin.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "box",
    what = "a box",
    equation = "|x| ≤ a/2, |y| ≤ b/2, |z| ≤ c/2",
    source = "Ericson, Real-Time Collision Detection (2005), ch. 4",
    example = "{ size: [0.2, 0.02, 0.01], position: [0.1, 0] }",
    short = "size",
    checked
)]
pub struct Cuboid {
    /// Lengths along the axes of its frame; in the plane two are enough.
    #[quantity(unit = "m", constant)]
    #[key(image = Same)]
    size: SpacePoint,
    #[group]
    pub(super) place: ShapeFrame,
}

impl ShapeElement for Cuboid {
    fn form(&self) -> Form<Formula> {
        Form::Box { size: self.size.0.clone(), radius: Formula::number(0.0) }
    }
}

impl Checked for Cuboid {
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        check_lengths(reader, fields.key_span("size"), "box", &self.size);
    }
}
