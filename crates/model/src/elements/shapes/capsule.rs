//! All that is within a radius of a line: a rod with round ends.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ShapeElement, ShapeFrame};
use crate::elements::effects::{Points, check_ends};
use crate::elements::form::Form;
use crate::grammar::{Checked, Fields, Reader, SymbolTable};

/// A rod with round ends.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "capsule",
    what = "a capsule",
    equation = "|r − p| ≤ R for a p of the line",
    source = "Ericson, Real-Time Collision Detection (2005), ch. 4",
    example = "{ ends: [[0, 0], [0.2, 0]], radius: 0.01 }",
    checked
)]
pub struct Capsule {
    /// Ends of the line in its middle, in its frame.
    #[quantity(unit = "m", constant)]
    ends: Points,
    /// Radius R.
    #[quantity(unit = "m", constant, positive)]
    radius: Formula,
    #[group]
    pub(super) place: ShapeFrame,
}

impl ShapeElement for Capsule {
    fn form(&self) -> Form<Formula> {
        // The reader has let two points through, no more and no less.
        let end = |index: usize| self.ends.get(index).cloned().unwrap_or([0.0; 3].map(Formula::number));
        Form::Capsule { ends: [end(0), end(1)], radius: self.radius.clone() }
    }
}

impl Checked for Capsule {
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        check_ends(reader, fields.key_span("ends"), "capsule", &self.ends);
    }
}
