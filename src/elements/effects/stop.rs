//! Stops at the ends of a joint's way.
//!
//! ```text
//! f = f(lower − s) − f(s − upper)          N or N m, on the joint's coordinate s; f is that of `impact`
//! ```
//!
//! Between the stops nothing acts, and nothing is computed but where s is.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ForceElement, Impact, Sensor, effort};
use crate::grammar::quantity::Dimension;
use crate::grammar::{Checked, Fields, Measure, OnJoint, Reader, SymbolTable};

/// Stops at the ends of a joint's range.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "stop",
    what = "a stop",
    equation = "f = K ⟨δ⟩ⁿ ⟨1 + χ δ̇⟩, δ = lower − s or s − upper",
    source = "Hunt & Crossley, J. Appl. Mech. 42 (1975) 440; Lankarani & Nikravesh, J. Mech. Des. 112 (1990) 369",
    example = "{ on: hinge, lower: -1.5, upper: 0.8, impact: { stiffness: 1e4, restitution: 0.5, impact_velocity: 2 } }",
    checked
)]
pub struct Stop {
    /// The joint's coordinate.
    #[group]
    pub on: OnJoint,
    /// Smallest value of the coordinate.
    #[quantity(unit = "m or rad", constant)]
    pub lower: Option<Formula>,
    /// Largest value of the coordinate.
    #[quantity(unit = "m or rad", constant, above = lower)]
    pub upper: Option<Formula>,
    /// How it pushes back.
    pub impact: Impact,
}

impl ForceElement for Stop {
    const SENSORS: &'static [Sensor] = &[(Measure::FORCE, Dimension::FORCE), (Measure::TORQUE, Dimension::TORQUE)];

    fn sensors(&self) -> Vec<Sensor> {
        vec![effort(self.on)]
    }

    fn coordinates(&self) -> Vec<OnJoint> {
        vec![self.on]
    }
}

impl Checked for Stop {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        if fields.get("lower").is_none() && fields.get("upper").is_none() {
            reader.error(fields.at.clone(), "a stop needs `lower` or `upper`", None);
        }
    }
}
