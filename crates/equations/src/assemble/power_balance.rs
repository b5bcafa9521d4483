//! Balance of power: d'Alembert's principle in the form of virtual power along the motion itself.
//!
//! ```text
//! Σ vᵢ (M w + Φ_qᵀ λ − Q)ᵢ = dT/dt + Σ λₖ (Φ_q v)ₖ − Σ Pₑ,   Pₑ = Σ F · ṙ + τ · ω   W
//! ```
//!
//! The left side has the rows of the equations of motion; T is summed body by body, and Pₑ wrench by wrench, before
//! anything is projected on generalised coordinates. States are no coordinates of the motion.

use symdiff::Scalar;

use super::acting::Acting;
use super::applied_forces::AppliedForces;
use super::mechanism::Mechanism;
use super::powers::EffectPower;
use crate::model::Description;
use crate::multibody::{BuildError, Vector};

impl<'g> Mechanism<'g, '_> {
    /// The powers of all effects, each by itself.
    ///
    /// # Errors
    /// As [`crate::elements::effects::ForceElement::apply`].
    pub fn powers(&self, description: &Description) -> Result<Vec<EffectPower>, BuildError> {
        let nothing = || AppliedForces::new(self.g, self.bodies.len());
        let mut powers = Vec::new();
        for (index, effect) in description.effects.iter().enumerate() {
            let mut own = nothing();
            effect.kind.apply(&mut Acting { m: self, effect: index, applied: &mut own })?;
            let (name, kind) = (effect.name.clone(), effect.kind.keyword());
            let stored = self.g.sum(own.potentials.iter().copied()).expr();
            powers.push(EffectPower { name, kind, power: self.power(&own).expr(), stored });
        }
        if !self.teeth.is_empty() {
            let mut own = nothing();
            self.add_tooth_forces(&mut own, false)?;
            let (power, stored) = (self.power(&own).expr(), self.g.number(0.0).expr());
            powers.push(EffectPower { name: "teeth".to_owned(), kind: "teeth", power, stored });
        }
        Ok(powers)
    }

    /// Σ F · ṙ + τ · ω of all bodies, with the weights of children, and efforts on coordinates of their own.
    fn power(&self, applied: &AppliedForces<'g>) -> Scalar<'g> {
        let applied = applied.with_guarded();
        let nowhere = Vector::zero(self.g);
        let of_bodies = self.bodies.iter().zip(applied.wrenches()).map(|(body, wrench)| {
            wrench.force.dot(body.velocity_of(nowhere)) + wrench.torque.dot(body.angular_velocity())
        });
        let weights = self.bodies.iter().enumerate().filter(|(_, body)| body.is_child()).map(|(index, body)| {
            let center = self.point_at(index, body.center);
            body.mass * applied.field.dot(center.velocity)
        });
        let efforts = applied.efforts().filter(|(index, _)| !self.coordinates[*index].is_state());
        let efforts = efforts.map(|(index, effort)| effort * self.v[index]);
        self.g.sum(of_bodies.chain(weights).chain(efforts))
    }
}
