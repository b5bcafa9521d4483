//! Forces between teeth, instead of the torques of their constraints' multipliers.
//!
//! They do no work beyond those, so the motion does not depend on them: they change the loads of bearings, and friction
//! with that. They are written down only where a reaction is asked for.

use super::applied_forces::AppliedForces;
use super::mechanism::Mechanism;
use super::questions::Questions;
use crate::grammar::Symbol;
use crate::multibody::BuildError;

/// Whether an output or an effect depends on the reaction of a joint.
pub fn reactions_are_asked(questions: &Questions) -> bool {
    let description = questions.description;
    let outputs = questions.outputs.iter().map(|output| &output.formula);
    let effects = description.effects.iter();
    let of_effects = effects.clone().flat_map(|effect| effect.kind.formulas());
    let mut names = outputs.chain(of_effects).flat_map(|formula| formula.names());
    effects.clone().any(|effect| effect.kind.loading_joint().is_some())
        || names.any(|(name, _)| matches!(description.symbol(name), Some(Symbol::Reaction { .. })))
}

impl<'g> Mechanism<'g, '_> {
    /// Adds the forces of teeth between bearings of the trees (`of_trees`), or the others. Inboard joints feel those in
    /// addition to their coordinates' forces, along which no reaction is counted; where bearings are constraints, the
    /// force at the pitch point replaces the multiplier's torques.
    pub fn add_tooth_forces(&self, applied: &mut AppliedForces<'g>, of_trees: bool) -> Result<(), BuildError> {
        for tooth in &self.teeth {
            if tooth.instead.iter().all(|(on, _)| self.tree.contains(on.joint)) != of_trees {
                continue;
            }
            let [first, second] = tooth.bodies.map(|body| self.point_now_at(body, tooth.at));
            applied.add_force_pair(&first, &second, tooth.force);
            for (on, effort) in tooth.instead.into_iter().filter(|_| !of_trees) {
                applied.add_joint_effort(self, on, -effort)?;
            }
        }
        Ok(())
    }
}
