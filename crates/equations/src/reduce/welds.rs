//! Welds: fixed joints whose bodies are merged.
//!
//! A fixed joint merges its bodies if no output or effect needs its reaction, its angle is time-independent, neither
//! body is a node of a beam, and not both bodies have positions of their own. Of merged bodies one has coordinates,
//! and the others follow it; a body has a position of its own if it lacks a coordinate or has a value at the start.

use symdiff::Formula;

use super::sets::Sets;
use crate::model::{Description, LineMass, StartValue, Symbol};

/// A fixed joint, and why its bodies are not merged, if they are not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Weld {
    /// Joint index.
    pub joint: usize,
    /// Why its bodies are not merged; `None` if they are.
    pub obstacle: Option<String>,
}

/// The fixed joints, of which those without an obstacle merge their bodies.
pub fn welds(description: &Description) -> Vec<Weld> {
    let observed = observed(description);
    let restricted = restricted(description);
    let nodes = nodes(description);
    let mut sets = Sets::new(description.bodies.len());
    let mut anchored: Vec<bool> = restricted
        .iter()
        .zip(named(description, &description.initial))
        .map(|(restricted, named)| *restricted || named)
        .collect();
    let mut welds = Vec::new();
    for (joint, (known, &observed)) in description.joints.iter().zip(&observed).enumerate() {
        let (Some(angle), Some(between)) = (known.kind.weld(), known.kind.between()) else { continue };
        let bends = between.iter().any(|point| nodes[point.body]);
        let [a, b] = between.map(|point| sets.of(point.body));
        let obstacle = if observed {
            Some("its reaction is needed".to_owned())
        } else if !is_time_independent(description, angle) {
            Some("its angle changes in time".to_owned())
        } else if bends {
            Some("a beam that bends moves by its nodes' own coordinates".to_owned())
        } else if a == b {
            Some("other welds join its bodies already".to_owned())
        } else if anchored[a] && anchored[b] {
            Some("both bodies have positions of their own, from the start or from missing coordinates".to_owned())
        } else {
            sets.join(a, b);
            anchored[a.min(b)] |= anchored[a.max(b)];
            None
        };
        welds.push(Weld { joint, obstacle });
    }
    keep_guesses(description, &mut sets, &mut welds);
    welds
}

/// Keeps welds apart where merging would lose a guess: a body that lacks coordinates is followed by the others, and if
/// the start has no value for it, the guesses of the others must be kept.
fn keep_guesses(description: &Description, sets: &mut Sets, welds: &mut [Weld]) {
    let bodies = description.bodies.len();
    let (initial, guessed) = (named(description, &description.initial), named(description, &description.guess));
    let restricted = restricted(description);
    let (mut loses, mut guessed_in) = (vec![false; bodies], vec![false; bodies]);
    for body in 1..bodies {
        loses[sets.of(body)] |= restricted[body] && !initial[body] && !guessed[body];
        guessed_in[sets.of(body)] |= guessed[body];
    }
    loses[0] = false;
    for weld in welds.iter_mut().filter(|weld| weld.obstacle.is_none()) {
        let Some([first, _]) = description.joints[weld.joint].kind.between() else { continue };
        let set = sets.of(first.body);
        if loses[set] && guessed_in[set] {
            weld.obstacle = Some("the guess belongs to a body that would follow another".to_owned());
        }
    }
}

/// Bodies that lack coordinates, the ground among them: they follow no other body.
fn restricted(description: &Description) -> Vec<bool> {
    let spatial = description.space.spatial;
    description.bodies.iter().map(|body| !body.is_free(spatial)).collect()
}

/// Bodies that are nodes of flexible ones.
fn nodes(description: &Description) -> Vec<bool> {
    let mut nodes = vec![false; description.bodies.len()];
    for effect in &description.effects {
        let beam = effect.kind.inertia().into_iter().flat_map(|beam: LineMass| beam.between);
        let reduced = effect.kind.reduced_inertia().into_iter().flat_map(|inertia| inertia.nodes.iter().copied());
        beam.chain(reduced).for_each(|end| nodes[end.body] = true);
    }
    nodes
}

/// Whether each body has values among these, by its own coordinates.
fn named(description: &Description, values: &[StartValue]) -> Vec<bool> {
    let mut named = vec![false; description.bodies.len()];
    for value in values {
        match value {
            StartValue::Coordinate { body, .. }
            | StartValue::Orientation { body, .. }
            | StartValue::AngularVelocity { body, .. } => named[*body] = true,
            // Conditions that hold for the pose of whatever body is followed.
            StartValue::Joint { .. }
            | StartValue::AngularRate { .. }
            | StartValue::RollPitchYaw { .. }
            | StartValue::Point { .. } => {}
        }
    }
    named
}

fn is_time_independent(description: &Description, angle: &Formula) -> bool {
    angle.names().all(|(name, _)| matches!(description.symbol(name), Some(Symbol::Parameter(_))))
}

/// Joints whose reaction a formula refers to.
fn observed(description: &Description) -> Vec<bool> {
    let mut observed = vec![false; description.joints.len()];
    let of_effects = description.effects.iter().flat_map(|effect| effect.kind.formulas());
    let of_outputs = description.outputs.iter().map(|output| &output.formula);
    for (name, _) in of_effects.chain(of_outputs).flat_map(Formula::names) {
        if let Some(Symbol::Reaction { joint, .. }) = description.symbol(name) {
            observed[joint] = true;
        }
    }
    observed
}
