//! A mechanism as an engineer counts it: mobility, size, mass, and loads.

use std::collections::BTreeSet;

use symdiff::Formula;

use super::RunError;
use super::formulation::assembled;
use super::prepared::questions;
use crate::assemble::{Inventory, Questions};
use crate::elements::effects::Scope;
use crate::grammar::{PointRef, Reference, TimeOrder};
use crate::model::{Description, Effect, Output, StartValue};
use crate::numerics::Sample;
use crate::reduce::Reduction;
use crate::results::{KindCount, MassRange, MobilityCount, Structure};
use crate::simulate::Assembled;

/// Assembles a whole model, with the parts that no output depends on, and nothing merged, and counts its parts. Where
/// parts that no output depends on have no start, without them.
///
/// # Errors
/// If the mechanism cannot be built or assembled.
pub fn structure(description: &Description) -> Result<(Assembled, Structure), RunError> {
    match of_model(&Questions::of(description)) {
        Err(RunError::Simulation(_)) => of_model(&questions(&Reduction::joined(description))),
        found => found,
    }
}

fn of_model(questions: &Questions) -> Result<(Assembled, Structure), RunError> {
    let description = questions.description;
    let inventory = Inventory::of(questions)?;
    let mut outputs = questions.outputs.to_vec();
    let own = outputs.len();
    let hidden =
        |formula| Output { name: String::new(), formula, unit: String::new(), dimension: None, of_results: false };
    outputs.extend(places(description).map(hidden));
    let places = outputs.len();
    outputs.extend(gravities(description).into_iter().flatten().cloned().map(hidden));
    let end = outputs.len();
    let mut assembled = assembled(&Questions { outputs: outputs.into(), ..questions.clone() })?;
    let nominal: Sample = assembled.system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let size = extent(description.space.spatial, &assembled.outputs_at_start(own..places, &nominal));
    let gravity = sum(&assembled.outputs_at_start(places..end, &nominal));
    assembled.system.outputs.truncate(own);

    let [nominal, lower, upper] = inventory.mass;
    let (resisting, acting) = description
        .effects
        .iter()
        .filter(|effect| effect.kind.scope() != Scope::EveryBody)
        .partition(|effect| effect.kind.resists());
    let structure = Structure {
        mobility: mobility(description, &inventory, &assembled),
        size,
        mass: MassRange { nominal, lower, upper },
        gravity,
        acting: by_kind(acting),
        resisting: by_kind(resisting),
        moves_at_start: description.initial.iter().any(is_speed),
    };
    Ok((assembled, structure))
}

fn mobility(description: &Description, inventory: &Inventory, assembled: &Assembled) -> MobilityCount {
    let spatial = description.space.spatial;
    let bodies = description.bodies.iter().filter(|body| !body.is_ground_of_instance()).count();
    let &Inventory { joints, constraints, held, drives, .. } = inventory;
    let freedoms = if spatial { 6 } else { 3 } * (bodies - 1);
    MobilityCount {
        spatial,
        bodies,
        joints,
        constraints,
        held,
        drives,
        // Numbers of a model's parts are far below 2⁶³.
        count: freedoms as i64 - (constraints + held) as i64,
        mobility: assembled.mobility.degrees_of_freedom + drives,
        over_constrained: assembled.mobility.redundant.len(),
    }
}

/// x, y and z of the bodies' origins and points; on the ground only of points that an element refers to.
fn places(description: &Description) -> impl Iterator<Item = Formula> {
    let axes: &[&str] = if description.space.spatial { &["x", "y", "z"] } else { &["x", "y"] };
    let mut names: Vec<String> = Vec::new();
    for body in &description.bodies[1..] {
        names.push(body.name.clone());
        names.extend(body.points.iter().map(|point| format!("{}.{}", body.name, point.name)));
    }
    let mut coordinates: Vec<Formula> =
        names.iter().flat_map(|name| axes.iter().map(move |axis| Formula::name(&format!("{name}.{axis}")))).collect();
    for position in used_points_of_ground(description) {
        coordinates.extend(position.into_iter().take(axes.len()));
    }
    coordinates.into_iter()
}

fn used_points_of_ground(description: &Description) -> Vec<[Formula; 3]> {
    let ground = &description.bodies[0];
    let mut used = BTreeSet::new();
    let mut mark = |references: Vec<Reference>| {
        for reference in references {
            if let Reference::Point(&mut PointRef { body: 0, point }) = reference {
                used.insert(point);
            }
        }
    };
    for joint in &description.joints {
        mark(joint.kind.clone().references());
    }
    for effect in &description.effects {
        mark(effect.kind.clone().references());
    }
    let origin = || std::array::from_fn(|_| Formula::number(0.0));
    used.into_iter().map(|point| point.map_or_else(origin, |point| ground.points[point].position.clone())).collect()
}

/// Extents along the axes of consecutive positions.
fn extent(spatial: bool, coordinates: &[f64]) -> [f64; 3] {
    let axes = if spatial { 3 } else { 2 };
    std::array::from_fn(|axis| {
        let along = coordinates.chunks_exact(axes).filter_map(|place| place.get(axis).copied());
        let (least, most) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        if least < most { most - least } else { 0.0 }
    })
}

/// Accelerations of all effects that act on every body.
fn gravities(description: &Description) -> Vec<&[Formula; 3]> {
    let everywhere = description.effects.iter().filter(|effect| effect.kind.scope() == Scope::EveryBody);
    everywhere.filter_map(|effect| effect.kind.direction()).collect()
}

fn sum(vectors: &[f64]) -> Option<[f64; 3]> {
    let sum = |sum: [f64; 3], vector: &[f64]| std::array::from_fn(|axis| sum[axis] + vector[axis]);
    (!vectors.is_empty()).then(|| vectors.chunks_exact(3).fold([0.0; 3], sum))
}

/// Number of effects of each kind, in the order in which they come.
fn by_kind(effects: Vec<&Effect>) -> Vec<KindCount> {
    let mut counts: Vec<KindCount> = Vec::new();
    for effect in effects {
        let kind = effect.kind.keyword();
        match counts.iter_mut().find(|known| known.kind == kind) {
            Some(known) => known.count += 1,
            None => counts.push(KindCount { kind, count: 1 }),
        }
    }
    counts
}

/// Whether a value at the start sets something in motion.
fn is_speed(value: &StartValue) -> bool {
    let moves = |formula: &Formula| formula.as_number() != Some(0.0);
    match value {
        StartValue::Coordinate { order, value, .. }
        | StartValue::Point { order, value, .. }
        | StartValue::Joint { order, value, .. } => *order != TimeOrder::Position && moves(value),
        StartValue::AngularVelocity { value, .. } => value.iter().any(moves),
        StartValue::AngularRate { value, .. } => moves(value),
        StartValue::Orientation { .. } | StartValue::RollPitchYaw { .. } => false,
    }
}
