//! Distance joint: two points keep a distance d, as if by a massless rod.
//!
//! ```text
//! Φ = (|r|² − d²) / (2 d) = 0,   r = r_B − r_A          1 row, m
//! ```
//!
//! ∂Φ/∂r_B = r/d is the unit vector of the rod, so λ is the rod's tension, N: −Φ_qᵀ λ is −λ r/d at B and +λ r/d at A,
//! and λ > 0 pulls the points together. Φ is |r| − d to first order and has no root. It fails at d = 0: two coincident
//! points are a revolute or spherical joint.

use mbint_derive::Element;
use symdiff::Formula;

use crate::elements::Glyph;
use crate::grammar::PointRef;

use crate::multibody::Vector;

use super::{Joint, JointElement, Kinematics, Orientation, Placement, Row, RowDocs, Rows, Separation};

/// Two points keep their distance, as if by a massless rod.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "distance",
    what = "a distance joint",
    equation = "(|r_B − r_A|² − d²)/(2 d) = 0",
    source = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 4 and 7",
    example = "{ between: [ground, bob], length: 0.5 m }"
)]
pub struct Distance {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// d; may depend on t.
    #[quantity(unit = "m", positive, time)]
    pub length: Formula,
}

impl JointElement for Distance {
    const ROWS: &'static [RowDocs] = &[RowDocs { name: "", unit: "m", multiplier: "N: the rod's tension" }];
}

impl Joint for Distance {
    fn between(&self) -> Option<[PointRef; 2]> {
        Some(self.between)
    }

    fn placement(&self) -> Option<Placement<'_>> {
        Some(Placement { separation: Separation::Distance(&self.length), orientation: Orientation::Free })
    }

    /// Tension.
    fn axial_by_multiplier(&self) -> Option<f64> {
        Some(1.0)
    }

    fn glyph(&self) -> Glyph {
        Glyph::Rod
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let length = k.number(&self.length)?;
        let [a, b] = k.points(self.between);
        let line = b - a;
        let difference = line.dot(line) - length * length;
        let doubled = 2.0 * length;
        let pull = line / length;
        let value = difference / doubled;
        Ok(vec![Row { name: "", value, force: -pull, torque: Vector::zero(k.graph()) }])
    }
}
