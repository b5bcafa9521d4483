//! Merges results of parts into those of a whole, field by field: of a model's subsystems, and of pieces of its box.

use super::summary::MethodSummary;
use super::{Band, Bounds, EffectCost, Explanation, InstructionCounts, LeftOut, OutputBounds, Summary};
use crate::methods::TooDeep;
use crate::numerics::{BandError, EMPTY, Range, largest, union};

/// The formulation of subsystems that differ in it.
const BOTH: &str = "absolute and joint";

/// Adds the cost of the same method elsewhere.
fn add_method(method: &mut MethodSummary, other: &MethodSummary) {
    method.simulations += other.simulations;
    method.steps = method.steps.max(other.steps);
    method.newton_iterations += other.newton_iterations;
    method.rank_revealing_solves += other.rank_revealing_solves;
    method.boxes = method.boxes.zip(other.boxes).map(|(a, b)| a + b);
    method.seconds = method.seconds.zip(other.seconds).map(|(a, b)| a + b);
    if let (Some(known), Some(other)) = (&mut method.order, &other.order) {
        known.iter_mut().zip(other).for_each(|(known, other)| *known = (*known).max(*other));
    }
}

/// Adds the costs of the methods in another part of the run.
pub fn add_methods(summary: &mut Summary, others: &[MethodSummary]) {
    for other in others {
        match summary.methods.iter_mut().find(|known| known.method == other.method) {
            Some(known) => add_method(known, other),
            None => summary.methods.push(other.clone()),
        }
    }
}

/// Summary of a model that consists of these subsystems. Results that depend on the whole model's bounds (errors,
/// contributions) and names (parameters) are taken from the first.
///
/// # Panics
/// Without any.
#[must_use]
pub fn summary_of_subsystems(subsystems: Vec<Summary>) -> Summary {
    let mut failures: Vec<String> = Vec::new();
    for failure in subsystems.iter().filter_map(|subsystem| subsystem.failure.as_ref()) {
        if !failures.contains(failure) {
            failures.push(failure.clone());
        }
    }
    let add = |mut whole: Summary, other: Summary| {
        if whole.formulation != other.formulation {
            whole.formulation = BOTH.to_owned();
        }
        whole.coordinates += other.coordinates;
        whole.constraints += other.constraints;
        whole.degrees_of_freedom += other.degrees_of_freedom;
        whole.redundant_constraints.extend(other.redundant_constraints);
        whole.undetermined_outputs.extend(other.undetermined_outputs);
        whole.singular_at_start.extend(other.singular_at_start);
        whole.shared_start.extend(other.shared_start);
        whole.singular_configurations.extend(other.singular_configurations);
        whole.failure_code = whole.failure_code.or(other.failure_code);
        whole.damped_mode = whole.damped_mode.or(other.damped_mode);
        whole.events.extend(other.events);
        whole.excitations.extend(other.excitations);
        let followed = whole.events_followed.into_iter().chain(other.events_followed);
        whole.events_followed = followed.min_by(|a, b| a.until.total_cmp(&b.until));
        whole.unmet_switch = whole.unmet_switch.into_iter().chain(other.unmet_switch).reduce(f64::min);
        whole.passed_force = whole.passed_force.into_iter().chain(other.passed_force).reduce(f64::min);
        whole.overlaps_at_start.extend(other.overlaps_at_start);
        whole.too_deep = TooDeep::first(whole.too_deep.iter().chain(&other.too_deep));
        whole.beyond_tolerance = whole.beyond_tolerance.into_iter().chain(other.beyond_tolerance).reduce(f64::max);
        add_methods(&mut whole, &other.methods);
        whole
    };
    // A model has at least one: `reduce` sees to it.
    let mut whole = subsystems.into_iter().reduce(add).expect("a model has a subsystem");
    whole.singular_configurations.sort_by(|a, b| a.time.total_cmp(&b.time));
    whole.failure = (!failures.is_empty()).then(|| failures.join("; "));
    whole
}

/// Bounds of a piece of the box.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'b> {
    /// Its own bounds.
    pub bounds: &'b Bounds,
    /// Rows up to which they hold for all of the piece.
    pub rows: usize,
    /// Its share of the whole box.
    pub share: f64,
}

/// Bounds over all pieces that reached a row; which share of the box these are is in `covered`.
///
/// # Panics
/// Without any piece.
#[must_use]
pub fn bounds_of_pieces(pieces: &[Piece]) -> Bounds {
    // Callers merge at least one piece.
    let longest = pieces.iter().max_by_key(|piece| piece.rows).expect("some piece has been bounded");
    let rows = longest.rows;
    let reach = |row: usize| pieces.iter().filter(move |piece| row < piece.rows);
    let output = |(output, first): (usize, &OutputBounds)| {
        let band = |index: usize| of_band(pieces, output, index, rows);
        let bands = (0..first.bands.len()).map(band).collect();
        OutputBounds { nominal: first.nominal[..rows].to_vec(), bands, ..first.clone() }
    };
    Bounds {
        times: longest.bounds.times[..rows].to_vec(),
        outputs: longest.bounds.outputs.iter().enumerate().map(output).collect(),
        contributions: if pieces.len() == 1 { longest.bounds.contributions.clone() } else { Vec::new() },
        covered: (0..rows).map(|row| reach(row).map(|piece| piece.share).sum()).collect(),
        analysis: longest.bounds.analysis,
        responses: Vec::new(),
        // Those of a piece are ends of the piece.
        witnesses: Vec::new(),
        derivatives: longest.bounds.derivatives.clone(),
        functions: Vec::new(),
        // Proofs of a piece are of the piece.
        certified: Vec::new(),
    }
}

/// One band of an output over all pieces that have it.
fn of_band(pieces: &[Piece], output: usize, index: usize, rows: usize) -> Band {
    let of = |piece: &Piece| piece.bounds.outputs[output].bands.get(index).cloned();
    let bands: Vec<Option<Band>> = pieces.iter().map(of).collect();
    let known = || bands.iter().flatten();
    // The longest piece has the band: the caller counts its bands.
    let method = known().next().expect("a piece has the band").method;
    let mut all = Band { method, lower: vec![], upper: vec![], error: BandError::default() };
    for row in 0..rows {
        let reach = || pieces.iter().zip(&bands).filter(|(piece, _)| row < piece.rows).map(|(_, band)| band);
        let found = reach().map(|band| match band {
            Some(band) => (Range { lower: band.lower[row], upper: band.upper[row] }, band.error.total[row]),
            None => (Range::UNKNOWN, f64::NAN),
        });
        let (range, error) = found.fold((EMPTY, 0.0), union);
        all.lower.push(range.lower);
        all.upper.push(range.upper);
        all.error.total.push(error);
        let unresolved = |band: &Option<Band>| band.as_ref().is_none_or(|band| band.error.unresolved[row]);
        all.error.unresolved.push(reach().any(unresolved));
        // Where no piece is worse than coarse.
        let coarse = |band: &Option<Band>| band.as_ref().is_some_and(|band| band.error.coarse[row]);
        all.error.coarse.push(reach().any(coarse) && reach().all(|band| coarse(band) || !unresolved(band)));
    }
    all.error.surrogate = largest(known().map(|band| band.error.surrogate));
    all.error.time = largest(known().map(|band| band.error.time));
    all
}

/// Adds those of another program.
fn add_instructions(counts: &mut InstructionCounts, other: &InstructionCounts) {
    counts.sample += other.sample;
    counts.step_size += other.step_size;
    counts.step += other.step;
    counts.factor += other.factor;
    counts.first_correction += other.first_correction;
    counts.correct += other.correct;
    counts.advance += other.advance;
    counts.observe += other.observe;
}

/// In two programs.
fn cost_of_both(one: EffectCost, other: EffectCost) -> EffectCost {
    let inactive = |cost: &EffectCost| cost.inactive.unwrap_or(cost.active);
    let conditional = one.inactive.is_some() || other.inactive.is_some();
    EffectCost { active: one.active + other.active, inactive: conditional.then(|| inactive(&one) + inactive(&other)) }
}

/// Explanation of a model that consists of these subsystems.
///
/// # Panics
/// Without any.
pub fn explanation_of_subsystems(subsystems: Vec<Explanation>) -> Explanation {
    // A model has at least one: `reduce` sees to it.
    subsystems.into_iter().reduce(explanation_of_both).expect("a model has a subsystem")
}

fn explanation_of_both(mut whole: Explanation, other: Explanation) -> Explanation {
    for (line, more) in [(&mut whole.space, other.space), (&mut whole.formulation, other.formulation)] {
        if line.split("; ").all(|known| known != more) {
            *line += &format!("; {more}");
        }
    }
    whole.coordinates.extend(other.coordinates);
    whole.constraints.extend(other.constraints);
    whole.degrees_of_freedom += other.degrees_of_freedom;
    whole.redundant_constraints.extend(other.redundant_constraints);
    whole.singular_at_start.extend(other.singular_at_start);
    whole.shared_start.extend(other.shared_start);
    whole.undetermined_outputs.extend(other.undetermined_outputs);
    for parameter in other.parameters {
        if !whole.parameters.contains(&parameter) {
            whole.parameters.push(parameter);
        }
    }
    for effect in other.effects {
        match whole.effects.iter_mut().find(|known| known.name == effect.name) {
            // Gravity acts in every subsystem.
            Some(known) => {
                known.forces += effect.forces;
                known.expressions += effect.expressions;
                known.adds = known.adds.take().zip(effect.adds).map(|(ours, theirs)| cost_of_both(ours, theirs));
            }
            None => whole.effects.push(effect),
        }
    }
    whole.outputs.extend(other.outputs);
    if whole.inactive.is_some() || other.inactive.is_some() {
        let inactive = whole.inactive.get_or_insert_with(|| whole.instructions.clone());
        add_instructions(inactive, other.inactive.as_ref().unwrap_or(&other.instructions));
    }
    add_instructions(&mut whole.instructions, &other.instructions);
    // The subsystems' matrices are blocks on one diagonal.
    let (ours, theirs) = (&mut whole.newton, other.newton);
    let first = ours.size;
    ours.pivots.extend(theirs.pivots.into_iter().map(|(row, column)| (first + row, first + column)));
    ours.size += theirs.size;
    ours.nonzeros += theirs.nonzeros;
    ours.factor_nonzeros += theirs.factor_nonzeros;
    ours.fill += theirs.fill;
    let new = |item: &LeftOut| !whole.left_out.contains(item);
    let more: Vec<LeftOut> = other.left_out.into_iter().filter(new).collect();
    whole.left_out.extend(more);
    whole
}
