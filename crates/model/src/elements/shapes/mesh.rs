//! Triangles of an STL or OBJ file.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ShapeElement, ShapeFrame};
use crate::elements::form::Form;
use crate::grammar::{Factors, FromNumber, Mesh};

/// Triangles of an STL or OBJ file.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "mesh",
    what = "a mesh",
    equation = "r = s · corner of the file",
    source = "Burns, Automated Fabrication (1993), sec. 6.5: the STL format",
    example = "{ file: housing.stl, scale: 0.001 }"
)]
pub struct MeshShape {
    /// STL (text or binary) or OBJ, in the model's folder or below.
    file: Mesh,
    /// Scale of the file's numbers, for all axes or each: 0.001 if the file is in mm.
    #[quantity(unit = "1", constant, nonzero)]
    #[key(default = Factors::from_number(1.0))]
    scale: Factors,
    #[group]
    pub(super) place: ShapeFrame,
}

impl ShapeElement for MeshShape {
    fn form(&self) -> Form<Formula> {
        Form::Mesh { mesh: self.file.clone(), scale: self.scale.0.clone() }
    }
}
