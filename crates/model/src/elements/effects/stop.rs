//! Stops at the ends of a joint's way.
//!
//! ```text
//! f = f(lower − s) − f(s − upper)          N or N m, on the joint's coordinate s; f is that of `impact`
//! ```
//!
//! Between the stops nothing acts, and nothing is computed but where s is.

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use super::laws::impact::Push;
use super::{ForceElement, Forces, Impact, TypedSensor, effort};
use crate::grammar::quantity::Dimension;
use crate::grammar::{Checked, Fields, OnJoint, Reader, Sensor, SymbolTable};
use crate::multibody::BuildError;
use crate::syntax::codes::Code;

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
    #[key(image = End("upper"))]
    pub lower: Option<Formula>,
    /// Largest value of the coordinate.
    #[quantity(unit = "m or rad", constant, above = lower)]
    #[key(image = End("lower"))]
    pub upper: Option<Formula>,
    /// How it pushes back.
    pub impact: Impact,
}

impl ForceElement for Stop {
    const RESISTS: bool = true;
    const SENSORS: &'static [TypedSensor] = &[(Sensor::FORCE, Dimension::FORCE), (Sensor::TORQUE, Dimension::TORQUE)];

    fn sensors(&self) -> Vec<TypedSensor> {
        vec![effort(self.on)]
    }

    fn coordinates(&self) -> Vec<OnJoint> {
        vec![self.on]
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let impact = Push::of(forces, &self.impact)?;
        let [place, rate] = forces.coordinate_and_rate(self.on);
        let back = -rate;
        let mut push = forces.graph().number(0.0);
        let mut ends: Vec<Scalar> = Vec::new();
        if let Some(lower) = &self.lower {
            let depth = forces.prescribed(lower)? - place;
            push += impact.force(depth, back).only_where(depth);
            ends.push(depth);
        }
        if let Some(upper) = &self.upper {
            let depth = place - forces.prescribed(upper)?;
            push -= impact.force(depth, rate).only_where(depth);
            ends.push(depth);
        }
        if let Some(overlap) = ends.iter().copied().reduce(Scalar::max) {
            forces.only_where(overlap);
        }
        forces.effort(self.on, push)?;
        for depth in ends {
            let potential = impact.potential(depth).only_where(depth);
            forces.potential(&[impact.stiffness], potential);
        }
        forces.sensor(Sensor::of_effort(self.on.coordinate), push);
        Ok(())
    }
}

impl Checked for Stop {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        if fields.lacks_all(&["lower", "upper"]) {
            reader.error(Code::IncompleteElement, fields.at.clone(), "a stop needs `lower` or `upper`", None);
        }
    }
}
