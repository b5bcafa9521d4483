//! A plate: a closed line of straight edges and arcs in the x and y of its frame, with a thickness along z.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ShapeElement, ShapeFrame};
use crate::elements::effects::ContactLine;
use crate::elements::form::Form;
use crate::grammar::{Checked, Fields, Reader, SymbolTable};

/// A plate by its outline.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "outline",
    what = "an outline",
    equation = "(x, y) within the line, |z| ≤ c/2",
    source = "Meisters, Amer. Math. Monthly 82 (1975) 648: its triangles",
    example = "{ points: [[0, 0], [0.2, 0], [0.2, 0.05], { to: [0, 0.05], radius: 0.15 }] }",
    short = "points",
    checked
)]
pub struct Outline {
    /// Corners in the x and y of its frame, in their order. `{ to: [x, y], radius: R }` is an arc to a point.
    #[quantity(unit = "m", constant)]
    points: ContactLine,
    /// Thickness along z, half of it on each side.
    #[quantity(unit = "m", constant, nonnegative, default = 0)]
    thickness: Formula,
    #[group]
    pub(super) place: ShapeFrame,
}

impl ShapeElement for Outline {
    fn form(&self) -> Form<Formula> {
        Form::Outline {
            points: self.points.bends(),
            is_closed: true,
            thickness: self.thickness.clone(),
            radius: Formula::number(0.0),
        }
    }
}

impl Checked for Outline {
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        self.points.check_edges(reader, fields.key_span("points"), "outline", 3);
    }
}
