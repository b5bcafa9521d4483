//! The equations of motion of a description.

use std::sync::Arc;

use rustc_hash::FxHashSet;
use symdiff::{Builder, Expr, Graph, Scalar};

use super::acting::Acting;
use super::applied_forces::AppliedForces;
use super::constraints::Constraints;
use super::cuts::{cuts_of_several_axes, other_cuts};
use super::formulation_info::FormulationInfo;
use super::inputs::MechanismInput;
use super::links::links_of;
use super::mechanism::Mechanism;
use super::powers::PowerBalance;
use super::questions::Questions;
use super::recursion;
use super::system::{ChildLink, CoordinateInfo, EffectInfo, Nearest, Omission, Overlap, System};
use super::tree::Tree;
use crate::assemble::tuning::TUNING;
use crate::grammar::Sensor;
use crate::model::{Analysis, Description, Formulation, Joint};
use crate::multibody::BuildError;

/// Writes down M w = Q − Φ_qᵀ λ and Φ = 0 for a description and its questions, in the formulation that these ask for;
/// `auto` is in absolute coordinates here.
///
/// Parameters that are certain are folded in; only intervals become symbols. Constraints that hold whatever moves (both
/// sides prescribed) are omitted. The work is linear in the number of bodies, joints and effects.
///
/// # Errors
/// A constraint that nothing can fulfil, joint coordinates that are asked for where they are not possible, and (for
/// descriptions that were not checked) a name that its context does not allow.
pub fn build(questions: &Questions) -> Result<System, BuildError> {
    match questions.formulation {
        Formulation::Joint => {
            in_joint_coordinates(questions, None, None)?.map_err(|why| BuildError::NoJointCoordinates { why })
        }
        Formulation::Absolute | Formulation::Auto => in_absolute_coordinates(questions),
    }
}

/// Every body has coordinates of its own.
///
/// # Errors
/// As for [`build`].
pub fn in_absolute_coordinates(questions: &Questions) -> Result<System, BuildError> {
    let builder = Builder::new();
    let system = equations(Mechanism::new(&builder, questions, false)?)?;
    Ok(system(builder.finish()))
}

/// As many bodies as possible are children, without coordinates of their own; or the reason why that is impossible.
/// With `deepest`, it is refused if bodies are more joints than that from their roots on average. Loops are closed from
/// the guess in absolute coordinates, or from an assembled start in absolute coordinates (their values) if it is known.
/// If the tree cannot be used and the questions leave its cut open, it is replaced by the first usable one that differs
/// in one joint, or in those of several axes: a reaction that a force depends on is known if its joint closes a loop.
///
/// # Errors
/// As for [`build`].
pub fn in_joint_coordinates(
    questions: &Questions,
    deepest: Option<usize>,
    assembled: Option<&[f64]>,
) -> Result<Result<System, String>, BuildError> {
    let refused = match in_this_tree(questions, deepest, assembled)? {
        Err(why) if questions.is_cut_open() => why,
        built => return Ok(built),
    };
    for cut in other_cuts(questions).into_iter().chain(cuts_of_several_axes(questions)) {
        if let Ok(system) = in_this_tree(&questions.cut_at(cut), deepest, assembled)? {
            return Ok(Ok(system));
        }
    }
    Ok(Err(refused))
}

fn in_this_tree(
    questions: &Questions,
    deepest: Option<usize>,
    assembled: Option<&[f64]>,
) -> Result<Result<System, String>, BuildError> {
    let builder = Builder::new();
    let mut mechanism = Mechanism::new(&builder, questions, true)?;
    let too_deep = deepest.and_then(|deepest| mechanism.tree.too_deep(deepest));
    if let Some(why) = too_deep.or_else(|| mechanism.obstacle(questions.description, deepest.is_some())) {
        return Ok(Err(why));
    }
    mechanism.guess_children(assembled)?;
    let mut system = equations(mechanism)?(builder.finish());
    system.formulation.closed_from = assembled.map(<[f64]>::to_vec);
    Ok(Ok(system))
}

/// Whether joints close loops, in joint coordinates.
pub fn closes_loops(questions: &Questions) -> bool {
    Tree::spanning(questions, |_| true).closes_loops(questions.description)
}

/// Whether joint coordinates have ones that formulas have no names for.
pub fn has_joints_of_several_axes(description: &Description) -> bool {
    let several = |joint: &Joint| joint.kind.mobilizer().is_some_and(|mobilizer| !mobilizer.has_one_axis());
    description.joints.iter().any(several)
}

/// Least number of multiplications that an elimination takes in joint coordinates, before anything is written down.
pub fn joint_elimination(questions: &Questions) -> usize {
    Tree::spanning(questions, |_| true).elimination()
}

/// M w = Q − Φ_qᵀ λ and Φ = 0 of a mechanism, once its graph is finished.
fn equations(mut m: Mechanism) -> Result<impl FnOnce(Graph) -> System + use<>, BuildError> {
    let questions = m.questions;
    let description = questions.description;
    let length = m.characteristic_length(description)?;
    let mut left_out = Vec::new();
    let mut constraints = Constraints::of(&mut m, description, length, &mut left_out)?;
    let (mut applied, effects) = apply_effects(&mut m, description, &mut left_out)?;
    let sampled = m.sampled_states(description, std::mem::take(&mut applied.sampled));
    let powers = if questions.powers { Some(m.powers(description)?) } else { None };
    let balance = Balance::of(&mut m, applied, &constraints.closures)?;
    let powers = powers.map(|effects| PowerBalance { kinetic: m.kinetic_energy().expr(), effects });
    let outputs = m.outputs()?;
    let random = m.random_inputs()?;
    let mut start = m.start(description)?;
    if description.analysis != Analysis::Kinematics {
        constraints.add_balances(&m, &balance.massive, &balance.force, &start)?;
    }
    // The equations' graph is the same without the distances; coordinates of joints are in it.
    let of_equations = (!m.has_distances()).then(|| m.g.graph().clone());
    let distances = m.distances(description, length, &start)?;
    let coordinates = m.coordinates.iter().zip(&m.coordinate_names).map(|(owner, name)| CoordinateInfo {
        name: name.clone(),
        scale: if owner.is_length() { length } else { 1.0 },
        is_angle: !owner.is_length(),
        is_state: owner.is_state(),
    });
    let mut coordinates: Vec<CoordinateInfo> = coordinates.collect();
    m.scale_states(&balance.force, &start, description.simulation.duration, &mut coordinates);
    let joint = !m.tree.is_absolute();
    let cut = if joint { m.tree.closing(description) } else { Vec::new() };
    let formulation = FormulationInfo { joint, why: "the model asks for them".to_owned(), cut, closed_from: None };
    let (analysis, modes) = (description.analysis, questions.modes.clone().into_owned());
    let is_derived = description.black_box.is_some() || questions.outputs.iter().any(|output| output.of_results);
    let declared_parameters = if is_derived { description.parameters.clone() } else { Vec::new() };
    let mass_of_bodies = m.total_mass();
    let inputs = m.inputs.iter().map(MechanismInput::info).collect();
    let is_excited = m.is_excited.get();
    let (time, space, parameters) = (m.time.expr(), description.space.clone(), m.uncertain);
    let [q, v, w] = [&m.q, &m.v, &m.w].map(|list| Scalar::exprs(list));
    let kinds = [constraints.positions, constraints.velocities];
    let [constraint, velocity_constraint] = kinds.each_ref().map(|kind| Scalar::exprs(&kind.values));
    let lambda = kinds.iter().flat_map(|kind| Scalar::exprs(&kind.lambda)).collect();
    let constraints = kinds.into_iter().flat_map(|kind| kind.infos).collect();
    let [inertia, force, conditional] =
        [&balance.inertia, &balance.force, &balance.conditional].map(|list| Scalar::exprs(list));
    let mass = balance.mass.into_iter().map(|(row, column, value)| (row, column, value.expr())).collect();
    let (links, massive) = (balance.links, balance.massive);
    let active_condition = balance.active_condition.map(Scalar::expr);
    Ok(move |graph| {
        let (graph, with_distances) = match of_equations {
            Some(of_equations) => (of_equations, Some(graph)),
            None => (graph, None),
        };
        start.nearest = (!distances.is_empty()).then(|| Arc::new(Nearest { graph: with_distances, distances }));
        let mut system = System {
            graph,
            parameters,
            inputs,
            is_excited,
            random,
            time,
            q,
            v,
            w,
            lambda,
            coordinates,
            constraints,
            mass,
            massive,
            inertia,
            force,
            active_condition,
            conditional,
            constraint,
            velocity_constraint,
            sampled,
            links,
            outputs,
            length,
            mass_of_bodies,
            start,
            analysis,
            modes,
            declared_parameters,
            effects,
            powers,
            left_out,
            space,
            formulation,
        };
        if system.analysis == Analysis::Kinematics {
            system.forget_forces();
        }
        system.note_unused_parameters();
        system
    })
}

/// The forces of all effects, and the description of each effect.
fn apply_effects<'g>(
    m: &mut Mechanism<'g, '_>,
    description: &Description,
    left_out: &mut Vec<Omission>,
) -> Result<(AppliedForces<'g>, Vec<EffectInfo>), BuildError> {
    let g = m.g;
    let mut applied = AppliedForces::new(g, m.bodies.len());
    m.add_tooth_forces(&mut applied, false)?;
    let mut effects = Vec::new();
    for (index, effect) in description.effects.iter().enumerate() {
        let nodes = g.len();
        applied.begin();
        effect.kind.apply(&mut Acting { m, effect: index, applied: &mut applied })?;
        m.sensors.extend(applied.measured().iter().map(|&(measure, value)| ((index, measure), value)));
        m.thrusts.push(applied.thrusts().to_vec());
        let forces = applied.coordinates_touched(m);
        if forces == 0 && effect.kind.states().is_empty() {
            let why = "it has no effect: its force is zero, or acts only on prescribed coordinates".to_owned();
            left_out.push(Omission { what: format!("effect {}", effect.name), why });
        }
        let (name, kind) = (effect.name.clone(), effect.kind.keyword());
        let measured = |wanted: Sensor| {
            applied.measured().iter().find(|(measure, _)| *measure == wanted).map(|&(_, value)| value.expr())
        };
        let length = measured(Sensor::LENGTH);
        let touch =
            measured(Sensor::GAP).and_then(|gap| Some([gap, measured(Sensor::RATE)?, measured(Sensor::FORCE)?]));
        let room = applied.room.map(Scalar::expr);
        let overlap = applied.overlap.map(|(gap, deepest)| Overlap { gap: gap.expr(), deepest: deepest.expr() });
        let expressions = g.len() - nodes;
        effects.push(EffectInfo { name, kind, forces, expressions, length, room, overlap, touch });
    }
    Ok((applied, effects))
}

/// Both sides of M w = Q but for reactions.
struct Balance<'g> {
    /// M's nonzero entries: row, column, value; none of long trees.
    mass: Vec<(usize, usize, Scalar<'g>)>,
    /// Whether each coordinate has inertia.
    massive: Vec<bool>,
    /// M w, with the terms listed at [`System::inertia`].
    inertia: Vec<Scalar<'g>>,
    /// Q
    force: Vec<Scalar<'g>>,
    /// If it is not positive, no force acts that acts under conditions.
    active_condition: Option<Scalar<'g>>,
    /// Generalised forces that act under conditions.
    conditional: Vec<Scalar<'g>>,
    /// The children, parents first.
    links: Vec<ChildLink>,
}

impl<'g> Balance<'g> {
    /// Sums the forces, and adds the reactions of inboard joints, which follow from them, to the mechanism; `closures`
    /// are the other joints.
    fn of(m: &mut Mechanism<'g, '_>, applied: AppliedForces<'g>, closures: &[usize]) -> Result<Self, BuildError> {
        let g = m.g;
        let mut mass = Vec::new();
        let mut force = applied.generalised(m);
        // Forces that act only under conditions are summed separately, so that they are not computed where none acts.
        let active_condition = applied.conditions().into_iter().reduce(Scalar::max);
        let mut conditional = vec![g.number(0.0); force.len()];
        if let Some(active_condition) = active_condition {
            let guarded = Scalar::exprs(&applied.guarded().generalised(m));
            let assumed = g.with(|graph| graph.assume(&guarded, active_condition.expr(), true));
            conditional = assumed.into_iter().map(|expr| g.scalar(expr)).collect();
            for (total, &part) in force.iter_mut().zip(&conditional) {
                *total += part.only_where(active_condition);
            }
        }
        for body in &m.bodies {
            body.add_inertia(&mut mass, &mut force);
        }
        mass.extend(m.states.values().map(|&index| (index, index, g.number(1.0))));
        let mut inertia = vec![g.number(0.0); m.q.len()];
        for &(row, column, value) in &mass {
            inertia[row] += value * m.w[column];
        }
        let mut links = Vec::new();
        if !m.tree.is_absolute() {
            let inertial = recursion::inertial_forces(m, applied.field);
            let mut on_bodies = applied.with_guarded();
            m.add_tooth_forces(&mut on_bodies, true)?;
            m.add_reactions_of_trees(on_bodies.clone(), &inertial, closures);
            links = links_of(m, &inertial, &[&applied, &applied.guarded(), &on_bodies]);
            add_all(&mut inertia, inertial.generalised);
            mass.clear();
        }
        if m.flexible().is_some() {
            add_all(&mut inertia, m.inertia_of_beams()?);
            add_all(&mut inertia, m.inertia_of_superelements()?);
            mass.clear();
            m.kinetic_energy_of_flexible = m.energy_of_beams()? + m.energy_of_superelements()?;
        }
        let mut massive = depend_on(&inertia, &m.w);
        let is_long = are_long(&links) && massive.iter().all(|&massive| massive);
        if mass.is_empty() && !is_long {
            mass = mass_matrix(&inertia, &m.w);
            massive.fill(false);
            mass.iter().filter(|(.., value)| !value.is_zero()).for_each(|&(row, ..)| massive[row] = true);
        }
        m.potentials = applied.potentials;
        mass.sort_unstable_by_key(|&(row, column, _)| (row, column));
        Ok(Self { mass, massive, inertia, force, active_condition, conditional, links })
    }
}

/// Whether M is omitted because the average link has many others in its tree.
fn are_long(links: &[ChildLink]) -> bool {
    let mut roots: Vec<usize> = Vec::with_capacity(links.len());
    let mut sizes = vec![0_usize; links.len()];
    for (index, link) in links.iter().enumerate() {
        roots.push(link.parent.map_or(index, |parent| roots[parent]));
        sizes[roots[index]] += 1;
    }
    let pairs: usize = sizes.iter().map(|size| size * size).sum();
    !links.is_empty() && pairs >= TUNING.links_without_mass_matrix * links.len()
}

fn add_all<'g>(totals: &mut [Scalar<'g>], parts: Vec<Scalar<'g>>) {
    for (total, part) in totals.iter_mut().zip(parts) {
        *total += part;
    }
}

/// Whether each value depends on any of some symbols.
fn depend_on<'g>(values: &[Scalar<'g>], symbols: &[Scalar<'g>]) -> Vec<bool> {
    let Some(g) = symbols.first().map(|symbol| symbol.builder()) else { return vec![false; values.len()] };
    let (values, graph) = (Scalar::exprs(values), g.graph());
    let mut depends: FxHashSet<Expr> = Scalar::exprs(symbols).into_iter().collect();
    for expr in graph.reachable(&values) {
        if graph.node(expr).children().any(|child| depends.contains(&child)) {
            depends.insert(expr);
        }
    }
    values.iter().map(|value| depends.contains(value)).collect()
}

/// ∂ inertia / ∂w, both triangles: it is symmetric, so one is enough to be computed.
fn mass_matrix<'g>(inertia: &[Scalar<'g>], w: &[Scalar<'g>]) -> Vec<(usize, usize, Scalar<'g>)> {
    let Some(g) = w.first().map(|w| w.builder()) else { return Vec::new() };
    let jacobian = g.with(|graph| graph.jacobian(&Scalar::exprs(inertia), &Scalar::exprs(w)));
    let lower = jacobian.entries().filter(|&(row, column, _)| column <= row);
    lower
        .flat_map(|(row, column, value)| {
            let value = g.scalar(value);
            let mirrored = (row != column).then_some((column, row, value));
            std::iter::once((row, column, value)).chain(mirrored)
        })
        .collect()
}
