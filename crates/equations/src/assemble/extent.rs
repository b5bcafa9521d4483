//! The model's size.

use std::collections::BTreeSet;

use symdiff::{Formula, Scalar};

use super::mechanism::Mechanism;
use super::questions::Questions;
use crate::elements::joints::{Placement, Separation};
use crate::grammar::{JointCoordinate, ReactionComponent, Reference, Symbol, TimeOrder};
use crate::model::{Description, StartValue};
use crate::multibody::{BuildError, Context};

impl Mechanism<'_, '_> {
    /// The largest length that the model names and uses, m, at its nominal parameters: coordinates of points,
    /// distances, prescribed and initial positions; 1 where it names none.
    pub fn characteristic_length(&self, description: &Description) -> Result<f64, BuildError> {
        let mut lengths: Vec<Scalar> = Vec::new();
        // Euler parameters of zero rotate nothing, so that children give no lengths then.
        let is_placed = self.unnamed_coordinates().next().is_none();
        for body in &self.bodies {
            lengths.extend(body.center.components());
            // A coordinate's symbol counts as zero here.
            if is_placed || !body.is_child() {
                lengths.extend(&body.position[..3]);
            }
        }
        for (body, point) in used_points(self.questions) {
            lengths.extend(self.bodies[body].points[point].components());
        }
        for joint in self.joints {
            if let Some(Placement { separation: Separation::Distance(length), .. }) = joint.kind.placement() {
                lengths.push(self.formula(length, Context::Time)?);
            }
        }
        lengths.push(self.length_of_beams()?);
        let nodes = self
            .superelements
            .iter()
            .flat_map(|of| (1..of.inertia.nodes.len()).map(|node| of.inertia.matrices.offset(node)));
        lengths.extend(nodes.flatten().map(|length| self.g.number(length)));
        for formula in description.initial.iter().chain(&description.guess).filter_map(length_at_start) {
            lengths.push(self.formula(formula, Context::Parameters)?);
        }
        let values = self.sample(&lengths, 0.0, |parameter| parameter.nominal);
        let largest = values.into_iter().map(f64::abs).filter(|length| length.is_finite());
        let largest = largest.fold(0.0, f64::max);
        Ok(if largest > 0.0 { largest } else { 1.0 })
    }

    /// Mass of all bodies, kg, at their nominal parameters.
    pub fn total_mass(&self) -> f64 {
        let masses: Vec<Scalar> = self.bodies.iter().map(|body| body.mass).collect();
        self.sample(&masses, 0.0, |parameter| parameter.nominal).into_iter().filter(|mass| mass.is_finite()).sum()
    }
}

/// The formula of a start value that is a position.
fn length_at_start(value: &StartValue) -> Option<&Formula> {
    match value {
        StartValue::Coordinate { coordinate, order: TimeOrder::Position, value, .. } => {
            coordinate.is_length().then_some(value)
        }
        StartValue::Joint { coordinate: JointCoordinate::Displacement, order: TimeOrder::Position, value, .. } => {
            Some(value)
        }
        StartValue::Point { order: TimeOrder::Position, value, .. } => Some(value),
        _ => None,
    }
}

/// Points that a joint, an effect or a formula refers to: body and point. Other points do not count for the model's
/// size.
fn used_points(questions: &Questions) -> BTreeSet<(usize, usize)> {
    let description = questions.description;
    let mut used = BTreeSet::new();
    let joints = description.joints.iter().map(|joint| (joint.kind.clone(), joint.kind.formulas()));
    for (mut kind, formulas) in joints {
        add_references(&mut used, kind.references());
        add_names(&mut used, description, formulas);
    }
    let effects = description.effects.iter().map(|effect| (effect.kind.clone(), effect.kind.formulas()));
    for (mut kind, formulas) in effects {
        add_references(&mut used, kind.references());
        add_names(&mut used, description, formulas);
    }
    add_names(&mut used, description, questions.outputs.iter().map(|output| &output.formula));
    used
}

fn add_references(used: &mut BTreeSet<(usize, usize)>, references: Vec<Reference>) {
    used.extend(references.into_iter().filter_map(|reference| match reference {
        Reference::Point(place) => Some((place.body, place.point?)),
        Reference::Body(_) | Reference::Joint(_) => None,
    }));
}

fn add_names<'f>(
    used: &mut BTreeSet<(usize, usize)>,
    description: &Description,
    formulas: impl IntoIterator<Item = &'f Formula>,
) {
    for (name, _) in formulas.into_iter().flat_map(Formula::names) {
        match description.symbol(name) {
            Some(Symbol::Point { body, point, .. }) => {
                used.insert((body, point));
            }
            Some(Symbol::Reaction { component: ReactionComponent::TorqueAt(place, _), .. }) => {
                used.extend(place.point.map(|point| (place.body, point)));
            }
            _ => {}
        }
    }
}
