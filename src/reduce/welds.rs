//! Which bodies that are welded together move as one.
//!
//! A fixed joint merges its bodies where nothing asks what it transmits, its angle does not change in time, and neither is a node of a beam, and the bodies do not both have
//! a place of their own: of bodies that are merged, one has coordinates, and the others follow it. What says where a body is,
//! and so cannot be given up, is a coordinate that it lacks, or a value at the start.

use symdiff::Formula;

use super::sets::Sets;
use crate::model::{Description, LineMass, Referent, StartValue};

/// A fixed joint, and why its bodies stay two; or that they became one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Weld {
    /// Joint index.
    pub joint: usize,
    /// Why its bodies are not merged, where they are not.
    pub obstacle: Option<String>,
}

/// Marks the fixed joints whose bodies are merged.
pub fn merge(description: &mut Description) -> Vec<Weld> {
    let observed = observed(description);
    let held = held(description);
    let nodes = nodes(description);
    let mut sets = Sets::new(description.bodies.len());
    let mut anchored: Vec<bool> =
        held.iter().zip(named(description, &description.initial)).map(|(held, named)| *held || named).collect();
    let mut welds = Vec::new();
    for (joint, (known, &observed)) in description.joints.iter().zip(&observed).enumerate() {
        let (Some(angle), Some(between)) = (known.kind.weld(), known.kind.between()) else { continue };
        let bends = between.iter().any(|point| nodes[point.body]);
        let [a, b] = between.map(|point| sets.of(point.body));
        let obstacle = if observed {
            Some("its reaction is asked for".to_owned())
        } else if !is_steady(description, angle) {
            Some("its angle changes in time".to_owned())
        } else if bends {
            Some("a beam that bends moves by its nodes' own coordinates".to_owned())
        } else if a == b {
            Some("other welds hold its bodies already".to_owned())
        } else if anchored[a] && anchored[b] {
            Some("the start, or coordinates that are missing, say of both bodies where they are".to_owned())
        } else {
            sets.join(a, b);
            anchored[a.min(b)] |= anchored[a.max(b)];
            None
        };
        welds.push(Weld { joint, obstacle });
    }
    keep_guesses(description, &mut sets, &mut welds);
    for weld in &welds {
        description.joints[weld.joint].merged = weld.obstacle.is_none();
    }
    welds
}

/// Where a body has coordinates missing, so that others follow it, and the start says nothing of it, what it says of the others must not be
/// lost.
fn keep_guesses(description: &Description, sets: &mut Sets, welds: &mut [Weld]) {
    let bodies = description.bodies.len();
    let (initial, guessed) = (named(description, &description.initial), named(description, &description.guess));
    let held = held(description);
    let (mut loses, mut guessed_in) = (vec![false; bodies], vec![false; bodies]);
    for body in 1..bodies {
        loses[sets.of(body)] |= held[body] && !initial[body] && !guessed[body];
        guessed_in[sets.of(body)] |= guessed[body];
    }
    loses[0] = false;
    for weld in welds.iter_mut().filter(|weld| weld.obstacle.is_none()) {
        let Some([first, _]) = description.joints[weld.joint].kind.between() else { continue };
        let set = sets.of(first.body);
        if loses[set] && guessed_in[set] {
            weld.obstacle = Some("the guess is of a body that would follow another".to_owned());
        }
    }
}

/// Bodies that do not have all coordinates, the ground among them: these follow no other.
fn held(description: &Description) -> Vec<bool> {
    let spatial = description.space.spatial;
    description.bodies.iter().map(|body| !body.is_free(spatial)).collect()
}

/// Bodies that are nodes of beams with mass.
fn nodes(description: &Description) -> Vec<bool> {
    let mut nodes = vec![false; description.bodies.len()];
    for effect in &description.effects {
        if let Some(LineMass { between, .. }) = effect.kind.inertia() {
            between.iter().for_each(|end| nodes[end.body] = true);
        }
    }
    nodes
}

/// Which bodies the start says something of, by their own coordinates.
fn named(description: &Description, values: &[StartValue]) -> Vec<bool> {
    let mut named = vec![false; description.bodies.len()];
    for value in values {
        match value {
            StartValue::Coordinate { body, .. }
            | StartValue::Orientation { body, .. }
            | StartValue::AngularVelocity { body, .. } => named[*body] = true,
            StartValue::Joint { .. } => {}
        }
    }
    named
}

fn is_steady(description: &Description, angle: &Formula) -> bool {
    angle.names().all(|(name, _)| matches!(description.referent(name), Some(Referent::Parameter(_))))
}

/// Joints whose reaction a formula names.
fn observed(description: &Description) -> Vec<bool> {
    let mut observed = vec![false; description.joints.len()];
    let of_effects = description.effects.iter().flat_map(|effect| effect.kind.formulas());
    let of_outputs = description.outputs.iter().map(|output| &output.formula);
    for (name, _) in of_effects.chain(of_outputs).flat_map(Formula::names) {
        if let Some(Referent::Reaction { joint, .. }) = description.referent(name) {
            observed[joint] = true;
        }
    }
    observed
}
