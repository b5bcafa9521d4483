//! Reactions of bearings that teeth push on: refused, since a ratio determines neither where teeth touch nor at which
//! angle.

use std::collections::{BTreeMap, HashSet};

use symdiff::Formula;

use super::names::Reader;
use crate::grammar::Symbol;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::Entry;

/// Reports outputs and effects that take the reaction of a bearing on which the teeth of a gear or rack push. Couplings
/// that are not among `joints` have no teeth: a robot's mimicking joints.
pub fn check(reader: &mut Reader, joints: &[Entry], effects: &[Entry], outputs: &[Entry]) {
    let bearings = bearings(reader, joints);
    if bearings.is_empty() {
        return;
    }
    let mut refused: Vec<(Span, usize)> = Vec::new();
    let place = |entries: &[Entry], name: &str| {
        entries.iter().find(|entry| entry.key == name).map(|entry| entry.value.span.clone()).unwrap_or_default()
    };
    for output in &reader.model.outputs {
        let joint = reactions(reader, &output.formula).find(|joint| bearings.contains_key(joint));
        refused.extend(joint.map(|joint| (place(outputs, &output.name), joint)));
    }
    for effect in &reader.model.effects {
        let loaded = effect.kind.loading_joint().filter(|(_, factor)| factor.as_number() != Some(0.0));
        let named = effect.kind.formulas().into_iter().flat_map(|formula| reactions(reader, formula));
        let joint = loaded.map(|(joint, _)| joint).into_iter().chain(named).find(|joint| bearings.contains_key(joint));
        refused.extend(joint.map(|joint| (place(effects, &effect.name), joint)));
    }
    for (span, joint) in refused {
        let (joint, teeth) = (&reader.model.joints[joint].name, &reader.model.joints[bearings[&joint]].name);
        let message = format!(
            "the reaction of `{}` is not known: the teeth of `{}` push on it, and a ratio does not tell how",
            clip(joint),
            clip(teeth)
        );
        let help = format!(
            "give `{teeth}` a `pressure_angle`, e.g. `20 deg`, and between joints, the bearings: then the force of the teeth acts \
             at the pitch point"
        );
        reader.error(Code::IncompleteElement, span, message, help);
    }
}

/// Joints that hold toothed bodies, each with the gear or rack.
fn bearings(reader: &Reader, joints: &[Entry]) -> BTreeMap<usize, usize> {
    let mut bearings = BTreeMap::new();
    let written: HashSet<&str> = joints.iter().map(|entry| entry.key.as_str()).collect();
    // The first gear or rack of each body.
    let mut teeth = BTreeMap::new();
    for (index, joint) in reader.model.joints.iter().enumerate().filter(|(_, joint)| written.contains(&*joint.name)) {
        let toothed = joint.kind.toothed();
        for bearing in toothed.joints {
            bearings.entry(bearing).or_insert(index);
        }
        for body in toothed.bodies {
            teeth.entry(body).or_insert(index);
        }
    }
    for (bearing, joint) in reader.model.joints.iter().enumerate().filter(|_| !teeth.is_empty()) {
        let held = joint.kind.between().into_iter().flatten();
        if let Some(&first) = held.filter_map(|at| teeth.get(&at.body)).min() {
            let known = bearings.entry(bearing).or_insert(first);
            *known = first.min(*known);
        }
    }
    bearings
}

/// Joints whose reactions a formula refers to.
fn reactions<'r>(reader: &'r Reader, formula: &'r Formula) -> impl Iterator<Item = usize> + 'r {
    formula.names().filter_map(|(name, _)| match reader.model.symbol(name)? {
        Symbol::Reaction { joint, .. } => Some(joint),
        _ => None,
    })
}
