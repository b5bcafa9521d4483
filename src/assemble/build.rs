//! The equations of motion of a description.

use std::sync::Arc;

use symdiff::taylor_model::encloses;
use symdiff::{Binary, Builder, Expr};

use crate::model::{Description, Formulation};

use super::acting::Acting;
use super::applied_forces::AppliedForces;
use super::body::{Body, EULER, RotationCoordinates};
use super::error::BuildError;
use super::joints;
use super::mechanism::Mechanism;
use super::recursion;
use super::system::{ConstraintInfo, CoordinateInfo, EffectInfo, FormulationInfo, LeftOut, Nearest, ResidualUnit, System};
use crate::elements::joints::Row;

/// How far from zero, in rad or relative to the model's size, a constraint that nothing can change may be: rounding
/// only.
const CLOSED: f64 = 1e-9;

/// Writes down M w = Q − Φ_qᵀ λ and Φ = 0 for a description, in the formulation that it asks for; `auto` is in absolute
/// coordinates here.
///
/// Parameters that are certain are folded in; only intervals become symbols. Constraints that hold whatever moves (both
/// sides held) are left out. The work is linear in the number of bodies, joints and effects.
///
/// # Errors
/// A constraint that nothing can fulfil, joint coordinates that are asked for where they do not do, and (for descriptions
/// that were not checked) a name out of place.
pub fn build(description: &Description) -> Result<System, BuildError> {
    match description.simulation.formulation {
        Formulation::Joint => in_joint_coordinates(description, None)?.map_err(|why| BuildError::NotCarried { why }),
        Formulation::Absolute | Formulation::Auto => in_absolute_coordinates(description),
    }
}

/// Every body has coordinates of its own.
///
/// # Errors
/// As for [`build`].
pub fn in_absolute_coordinates(description: &Description) -> Result<System, BuildError> {
    let builder = Builder::new();
    let mechanism = Mechanism::new(&builder, description, false)?;
    equations(builder, mechanism)
}

/// Joints carry bodies as far as they can; or why they cannot do here. With `deepest`, not where joints close loops, nor where
/// a body is more joints than that from its root on average.
///
/// # Errors
/// As for [`build`].
pub fn in_joint_coordinates(
    description: &Description,
    deepest: Option<usize>,
) -> Result<Result<System, String>, BuildError> {
    let builder = Builder::new();
    let mechanism = Mechanism::new(&builder, description, true)?;
    if let Some(why) = deepest.and_then(|deepest| mechanism.tree.too_involved(description, deepest)) {
        return Ok(Err(why));
    }
    match mechanism.obstacle(&builder) {
        Some(why) => Ok(Err(why)),
        None => equations(builder, mechanism).map(Ok),
    }
}

fn equations(builder: Builder, mut mechanism: Mechanism) -> Result<System, BuildError> {
    let (g, description) = (&builder, mechanism.description);
    let length = mechanism.characteristic_length(g)?;

    let mut left_out = Vec::new();
    let mut closures = Vec::new();
    let mut constraints = Constraints::default();
    for (body, built) in description.bodies.iter().zip(&mechanism.bodies) {
        if let Some(value) = normalisation(g, built) {
            let (name, joint) = (format!("{}.norm", body.name), body.name.clone());
            constraints.add(g, ConstraintInfo { name, joint, unit: ResidualUnit::Number }, value);
        }
    }
    for (index, joint) in description.joints.iter().enumerate() {
        if mechanism.tree.uses(index) {
            // Its reaction follows from the motion, once the forces are known.
            let none = joints::reaction(g, &*joint.kind, &[]);
            mechanism.reactions.push(none);
            continue;
        }
        let rows = joints::rows(g, &mechanism, index)?;
        let mut kept = Vec::with_capacity(rows.len());
        for row in rows {
            let name = if row.name.is_empty() { joint.name.clone() } else { format!("{}.{}", joint.name, row.name) };
            let info = ConstraintInfo { name, joint: joint.name.clone(), unit: residual_unit(&row) };
            if is_effective(g, &mechanism, length, &info, row)? {
                kept.push((row, constraints.add(g, info, row.value.expr())));
            } else {
                let why = "nothing that it constrains can move".to_owned();
                left_out.push(LeftOut { what: format!("constraint {}", info.name), why });
            }
        }
        let reaction = joints::reaction(g, &*joint.kind, &kept);
        mechanism.reactions.push(reaction);
        closures.push(index);
        for (coordinate, value) in mechanism.definitions(g, index)? {
            let name = format!("{}.{coordinate}", joint.name);
            let unit = if coordinate == "angle" { ResidualUnit::Angle } else { ResidualUnit::Length };
            constraints.add(g, ConstraintInfo { name, joint: joint.name.clone(), unit }, value);
        }
    }

    let mut applied = AppliedForces::new(g, mechanism.bodies.len());
    let mut effects = Vec::new();
    for (index, effect) in description.effects.iter().enumerate() {
        let nodes = g.len();
        applied.begin();
        effect.kind.apply(&mut Acting { g, m: &mechanism, applied: &mut applied })?;
        let measured = applied.measured().iter().map(|&(measure, value)| ((index, measure), value));
        mechanism.measures.extend(measured);
        let forces = applied.coordinates_touched(&mechanism);
        if forces == 0 {
            let why = "it moves nothing: it is zero, or acts on what is held".to_owned();
            left_out.push(LeftOut { what: format!("effect {}", effect.name), why });
        }
        let (name, kind) = (effect.name.clone(), effect.kind.keyword());
        let enclosed = g.graph().exprs_after(nodes).all(|expr| encloses(g.node(expr)));
        effects.push(EffectInfo { name, kind, forces, expressions: g.len() - nodes, enclosed });
    }
    let mut mass = Vec::new();
    let mut force = applied.generalised(g, &mechanism);
    // What acts only sometimes is summed apart, so that nothing of it is computed where nothing acts.
    let touching = applied.conditions().into_iter().reduce(|a, b| g.binary(Binary::Max, a, b));
    let mut sometimes = vec![g.constant(0.0); force.len()];
    if let Some(touching) = touching {
        let guarded = applied.guarded(g).generalised(g, &mechanism);
        sometimes = g.assume(&guarded, touching, true);
        for (total, &part) in force.iter_mut().zip(&sometimes) {
            let part = g.only_where(touching, part);
            *total = g.add(*total, part);
        }
    }
    for body in &mechanism.bodies {
        body.add_inertia(g, &mut mass, &mut force);
    }
    let mut inertia = vec![g.constant(0.0); mechanism.q.len()];
    for &(row, column, value) in &mass {
        let part = g.mul(value, mechanism.w[column]);
        inertia[row] = g.add(inertia[row], part);
    }
    if !mechanism.tree.is_absolute() {
        let carried = recursion::inertial_forces(g, &mechanism, applied.field);
        let all = applied.with_guarded(g);
        mechanism.react(g, &all, &carried, &closures);
        for (total, part) in inertia.iter_mut().zip(carried.generalised) {
            *total = g.add(*total, part);
        }
        mass = mass_matrix(g, &inertia, &mechanism.w);
    }
    if mechanism.flexible().is_some() {
        for (total, part) in inertia.iter_mut().zip(mechanism.inertia_of_beams(g)?) {
            *total = g.add(*total, part);
        }
        mass = mass_matrix(g, &inertia, &mechanism.w);
        mechanism.bending = mechanism.kinetic_energy_of_beams(g)?;
    }
    mechanism.potentials = applied.potentials;
    mass.sort_unstable_by_key(|&(row, column, _)| (row, column));

    let outputs = mechanism.outputs(g)?;
    let mut start = mechanism.start(g)?;
    // The equations' graph stays what it is without them.
    let graph = g.graph().clone();
    let distances = mechanism.distances(g, length, &start)?;
    let coordinates = mechanism.coordinates.iter().map(|&owner| CoordinateInfo {
        name: mechanism.coordinate_name(owner),
        scale: if owner.is_length() { length } else { 1.0 },
        is_angle: !owner.is_length(),
    });
    start.nearest = (!distances.is_empty()).then(|| Arc::new(Nearest { graph: builder.finish(), distances }));
    let mut system = System {
        coordinates: coordinates.collect(),
        parameters: mechanism.uncertain,
        time: mechanism.time,
        q: mechanism.q,
        v: mechanism.v,
        w: mechanism.w,
        lambda: constraints.lambda,
        constraints: constraints.infos,
        mass,
        inertia,
        force,
        touching,
        sometimes,
        constraint: constraints.values,
        outputs,
        length,
        start,
        effects,
        left_out,
        space: description.space.clone(),
        formulation: FormulationInfo {
            joint: !mechanism.tree.is_absolute(),
            why: "the model asks for them".to_owned(),
        },
        graph,
    };
    system.note_unused_parameters();
    Ok(system)
}

/// ∂ inertia / ∂w, both triangles: it is symmetric, so one is enough to be computed.
fn mass_matrix(g: &Builder, inertia: &[Expr], w: &[Expr]) -> Vec<(usize, usize, Expr)> {
    let slopes = g.jacobian(inertia, w);
    let lower = slopes.entries().filter(|&(row, column, _)| column <= row);
    lower
        .flat_map(|(row, column, value)| {
            let mirrored = (row != column).then_some((column, row, value));
            std::iter::once((row, column, value)).chain(mirrored)
        })
        .collect()
}

/// (pᵀp − 1) / 2 of a body that turns by Euler parameters.
fn normalisation(g: &Builder, body: &Body) -> Option<Expr> {
    body.index[EULER + 1].filter(|_| body.turn == RotationCoordinates::Euler)?;
    let p = body.euler();
    let (square, one) = (g.dot(&p, &p), g.constant(1.0));
    let excess = g.sub(square, one);
    Some(g.scale(0.5, excess))
}

/// The rows that are kept, with their multipliers.
#[derive(Default)]
struct Constraints {
    infos: Vec<ConstraintInfo>,
    values: Vec<Expr>,
    lambda: Vec<Expr>,
}

impl Constraints {
    fn add(&mut self, g: &Builder, info: ConstraintInfo, value: Expr) -> Expr {
        let lambda = g.symbol(&format!("lambda:{}", info.name));
        self.infos.push(info);
        self.values.push(value);
        self.lambda.push(lambda);
        lambda
    }
}

/// Unit of a row's Φ: m where its multiplier is a force, rad where it is a torque alone.
fn residual_unit(row: &Row) -> ResidualUnit {
    match (row.force.is_zero(), row.torque.is_zero()) {
        (false, _) => ResidualUnit::Length,
        (true, false) => ResidualUnit::Angle,
        (true, true) => ResidualUnit::Number,
    }
}

/// Whether a row constrains anything. One without a coordinate holds always, and is not needed, or never.
fn is_effective(g: &Builder, m: &Mechanism, length: f64, info: &ConstraintInfo, row: Row) -> Result<bool, BuildError> {
    if !m.is_given(g, &[row.value.expr()]) {
        return Ok(true);
    }
    let samples = [
        (None, m.sample(g, &[row.value.expr()], 0.0, |parameter| parameter.nominal)),
        (Some("at the parameters' lower bounds"), m.sample(g, &[row.value.expr()], 0.0, |parameter| parameter.lower)),
        (Some("at the parameters' upper bounds"), m.sample(g, &[row.value.expr()], 0.0, |parameter| parameter.upper)),
        (Some("at t = 1 s"), m.sample(g, &[row.value.expr()], 1.0, |parameter| parameter.nominal)),
    ];
    for (at, values) in samples {
        let residual = values[0];
        // What is NaN is not closed.
        let closed = residual.abs() <= CLOSED * length.min(1.0);
        if !closed {
            let (joint, constraint) = (info.joint.clone(), info.name.clone());
            return Err(BuildError::Contradiction { joint, constraint, residual, at });
        }
    }
    Ok(false)
}
