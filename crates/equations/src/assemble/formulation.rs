//! Whether a mechanism can be described in joint coordinates.

use symdiff::Formula;

use super::coordinates::formulas_of_motion;
use super::mechanism::Mechanism;
use super::start::Named;
use crate::model::{Description, JointKind, Reference, StartValue, Symbol};
use crate::multibody::Context;

impl Mechanism<'_, '_> {
    /// The reason that prevents joint coordinates; `None` if nothing does.
    ///
    /// Where joint coordinates are one choice of two (`is_chosen`), a start that names coordinates of bodies is in
    /// favour of absolute ones, and so is a guess if no joints close loops: those are closed from the assembled start
    /// in absolute coordinates.
    pub fn obstacle(&self, description: &Description, is_chosen: bool) -> Option<String> {
        if self.tree.is_absolute() {
            return Some("no joint can give a body its position".to_owned());
        }
        if let Some(body) = self.flexible() {
            return Some(format!("{body}: its nodes have coordinates of their own"));
        }
        let start = if is_chosen { self.lost_start(description) } else { None };
        start.or_else(|| self.loaded_friction(description)).or_else(|| self.lost_reaction(description))
    }

    /// Friction by the load of an inboard joint.
    fn loaded_friction(&self, d: &Description) -> Option<String> {
        let joint = d.effects.iter().find_map(|effect| {
            let (joint, factor) = effect.kind.loading_joint().filter(|(joint, _)| self.tree.contains(*joint))?;
            let factor = self.formula(factor, Context::Motion);
            (!factor.is_ok_and(|factor| factor.is_zero())).then_some(joint)
        })?;
        Some(format!(
            "friction grows with the reaction of joint `{}`, which has no multiplier in joint coordinates",
            d.joints[joint].name
        ))
    }

    /// A value at the start, or a guess, of a body that has no coordinates of its own.
    fn lost_start(&self, d: &Description) -> Option<String> {
        let guess: &[StartValue] = if self.tree.closes_loops(d) { &[] } else { &d.guess };
        let kept = d.initial.iter().map(|value| (Named::Kept, value));
        let guessed = guess.iter().map(|value| (Named::Guessed, value));
        kept.chain(guessed).find_map(|(named, value)| {
            let body = match value {
                StartValue::Coordinate { body, coordinate, order, .. } => {
                    let known = self.angle_of_inboard_joint(d, named, *body, *coordinate, *order).is_some();
                    Some(body).filter(|_| !known)
                }
                StartValue::Orientation { body, .. } | StartValue::AngularVelocity { body, .. } => Some(body),
                StartValue::Joint { .. }
                | StartValue::AngularRate { .. }
                | StartValue::RollPitchYaw { .. }
                | StartValue::Point { .. } => None,
            };
            // If a joint's coordinates have no names, those of the body give its position in the tree.
            let inboard = self.tree.inboard[*body?].filter(|inboard| !self.has_no_names(inboard.joint));
            let body = body.filter(|_| inboard.is_some())?;
            let name = &d.bodies[*body].name;
            Some(format!("the start names a coordinate of body `{name}`, whose place follows from its joint's"))
        })
    }

    /// Obstacle: a reaction of an inboard joint is needed that has no multiplier.
    fn lost_reaction(&self, d: &Description) -> Option<String> {
        let reaction = |formulas: Vec<&Formula>| {
            formulas.iter().flat_map(|formula| formula.names()).find_map(|(name, _)| match d.symbol(name) {
                Some(Symbol::Reaction { joint, .. }) if self.tree.contains(joint) => Some(&d.joints[joint].name),
                _ => None,
            })
        };
        if let Some(joint) = reaction(formulas_of_motion(d)) {
            return Some(format!(
                "a force depends on the reaction of joint `{joint}`, which has no multiplier in joint coordinates"
            ));
        }
        // Forces on coordinates of joints alone are no part of a joint's reaction.
        let of_joints = |formula: &Formula| {
            formula.names().all(|(name, _)| {
                let known = d.symbol(name);
                let of_time = matches!(known, Some(Symbol::Time | Symbol::Trajectory { .. }));
                of_time || matches!(known, Some(Symbol::JointCoordinate { .. } | Symbol::Parameter(_)))
            })
        };
        let acts_on_bodies = |kind: &JointKind| {
            let of_body = |index: Reference| matches!(index, Reference::Body(_));
            kind.between().is_none()
                && (kind.clone().references().into_iter().any(of_body)
                    || !kind.equation().into_iter().flatten().all(of_joints))
        };
        let coupling = d.joints.iter().find(|joint| acts_on_bodies(&joint.kind))?;
        let joint = reaction(self.questions.outputs.iter().map(|output| &output.formula).collect())?;
        Some(format!(
            "an output is the reaction of joint `{joint}`, which has no multiplier in joint coordinates, and the contribution of `{}` to it is unknown",
            coupling.name
        ))
    }
}
