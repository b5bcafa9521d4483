//! Chebyshev bounds through events: the instants of the events and the motions between them are expanded, since at a
//! fixed time some samples have met an event and their neighbours have not.
//!
//! Where samples meet different events, the box is divided along the surfaces on which one is just grazed.
//!
//! - `basis`: the terms of polynomials, and the surfaces;
//! - `surrogate`: polynomials of the instants, and of the motion at the nodes of each segment, in one part of the box;
//! - `piece`: a part of the box with its polynomials, `pieces`: all of them, `parts`: the samples in each;
//! - `fitting`: polynomials by least squares, and `sampling`: the samples that these need;
//! - `growth`: the terms of polynomials of many parameters;
//! - `kept`: all of them, stored after the run;
//! - `of_part`: a number that motions have in a part of the box only;
//! - `at_row`: motions at a row's time, on branches of segments that go on a little beyond their events;
//! - `row`: the outputs at a time, and how far the polynomials' errors move them;
//! - `seeds`: where a range is searched for, and `climb`: the search within the part of the box that is in a segment,
//!   and on its surfaces; `ridges`: where it ends early; `extremes`: the `ends` that it finds;
//! - `held`: how far values elsewhere may be beyond a corner, however the polynomials err.

mod at_row;
mod basis;
mod climb;
mod ends;
mod extremes;
mod fitting;
mod growth;
mod held;
mod kept;
mod of_part;
mod parts;
mod piece;
mod pieces;
mod ridges;
mod row;
mod sampling;
mod seeds;
mod surrogate;
pub(crate) mod tuning;

use std::sync::Arc;

use rayon::prelude::*;
use symdiff::jet::JetSpace;

use super::adaptive::{Goal, OutputGoal};
use super::composition::can_compose;
use super::sensitivity::SensitivityAnalysis;
use crate::methods::closure::Closure;
use crate::methods::ensemble::{Ensemble, EnsembleError, Simulated};
use crate::methods::kept::{CutRow, KeptSurrogate};
use crate::methods::request::Keep;
use crate::methods::result::{BandBuilder, Estimate, MethodResult};
use crate::methods::validation::Validation;
use crate::numerics::{Extent, Range, SAFETY_OF_SURROGATE, Sample, Surrogate, held_beside, largest};
use at_row::{PolynomialSource, RowMotion};
use ends::Ends;
use growth::Growth;
use held::{AxisLines, Misses};
use kept::KeptPieces;
pub use of_part::{number_as_motion, range_in_part};
use piece::Piece;
use pieces::Pieces;
use row::{BoxRow, SegmentRow, SensedRow};
use seeds::Lattice;
use surrogate::Point;
use tuning::TUNING;

/// Bounds by segments between events, if the ensemble's motions are cut there.
///
/// # Errors
/// If a sample cannot be assembled, or a closure not be compiled.
pub(super) fn of_degree(
    ensemble: &dyn Ensemble,
    surrogate: &Surrogate,
    samples: &[Sample],
    validation: &Validation,
    keep: Keep,
) -> Result<Option<MethodResult>, EnsembleError> {
    let Some(motions) = ensemble.segments(samples)? else { return Ok(None) };
    match Pieces::new(ensemble, surrogate, motions, validation)? {
        Some(pieces) => {
            let composed = composed(ensemble, &pieces, PolynomialSource::Grid(surrogate), validation)?;
            Ok(Some(composed.finished(ensemble, samples.len(), pieces, keep)))
        }
        None => Ok(None),
    }
}

/// Bounds to the degree that the goal asks for, by segments between events, if the ensemble's motions are cut there.
///
/// # Errors
/// If a sample cannot be assembled, or a closure not be compiled.
pub(super) fn adapted(
    ensemble: &dyn Ensemble,
    goal: &Goal,
    validation: &Validation,
    keep: Keep,
) -> Result<Option<MethodResult>, EnsembleError> {
    let k = ensemble.domain().dimension();
    let (mut spent, mut best) = (0, None);
    if !can_compose(k, ensemble.scales().len()) {
        return Ok(None);
    }
    if k >= TUNING.many_parameters {
        return grown(ensemble, goal, validation, keep);
    }
    for order in TUNING.degrees {
        let count = (order + 1).checked_pow(k as u32);
        if count.is_none_or(|count| goal.spent + spent + count > goal.budget.simulations) {
            break;
        }
        let surrogate = Surrogate::tensor(&vec![order; k], &vec![order + 1; k]);
        let samples = ensemble.domain().samples(surrogate.samples());
        let Some(result) = of_degree(ensemble, &surrogate, &samples, validation, keep)? else { break };
        spent += result.simulations;
        let is_enough = excess(&result, goal) <= 1.0;
        best = Some(MethodResult { order: Some(vec![order; k]), simulations: spent, ..result });
        if is_enough || ensemble.is_interrupted() {
            break;
        }
    }
    Ok(best)
}

/// Does the same as `adapted` for many parameters: terms are added until the goal is met.
fn grown(
    ensemble: &dyn Ensemble,
    goal: &Goal,
    validation: &Validation,
    keep: Keep,
) -> Result<Option<MethodResult>, EnsembleError> {
    let Some(mut growth) = Growth::start(ensemble)? else { return Ok(None) };
    let mut best: Option<MethodResult> = None;
    // The excess when rows were last bounded, and the error of the polynomials then.
    let mut last: Option<(f64, f64)> = None;
    loop {
        let count = growth.grid.len();
        let surrogate = Surrogate::sparse(&growth.grid);
        let Some(pieces) = Pieces::new(ensemble, &surrogate, growth.motions.clone(), validation)? else { break };
        let error = largest(pieces.all.iter().map(|piece| growth.error(piece.errors())));
        let wanted = count + count / 2;
        let is_last = goal.spent + wanted > goal.budget.simulations || ensemble.is_interrupted();
        let is_likely = |(excess, before): (f64, f64)| excess * error <= TUNING.likely * before;
        if is_last || last.is_none_or(is_likely) {
            let composed = composed(ensemble, &pieces, PolynomialSource::Grid(&surrogate), validation)?;
            let result = composed.finished(ensemble, count, pieces, keep);
            let excess = excess(&result, goal);
            best = Some(MethodResult { order: Some(growth.orders()), ..result });
            if is_last || excess <= 1.0 || excess.is_nan() {
                break;
            }
            last = Some((excess, error));
        }
        if !growth.grow(ensemble, wanted)? {
            break;
        }
    }
    Ok(best)
}

/// Largest error of a surrogate over the one that is allowed; NaN if one is unknown.
fn excess(result: &MethodResult, goal: &Goal) -> f64 {
    let of_output = |(errors, goal): (&Vec<f64>, &OutputGoal)| {
        largest(errors.iter().take(goal.rows).map(|error| SAFETY_OF_SURROGATE * error)) / goal.allowed
    };
    largest(result.surrogate.iter().zip(&goal.outputs).map(of_output))
}

/// Bounds that estimate the error of a scan's, if the ensemble's motions are cut at events: across events differences
/// of a scan's samples say nothing of the motions between them. They take no more samples than the scan; of few
/// parameters at least those of the first degree.
///
/// # Errors
/// If a sample cannot be assembled, or a closure not be compiled, and at an interruption.
pub(in crate::methods) fn beside_scan(
    ensemble: &dyn Ensemble,
    samples: usize,
    validation: &Validation,
) -> Result<Option<MethodResult>, EnsembleError> {
    let k = ensemble.domain().dimension();
    if !can_compose(k, ensemble.scales().len()) {
        return Ok(None);
    }
    let fits = |order: &usize| (order + 1).checked_pow(k as u32).is_some_and(|count| count <= samples);
    let degrees = TUNING.degrees.into_iter().take_while(fits);
    let first = (k <= TUNING.degrees_of_part.len()).then_some(TUNING.first_degree);
    let Some(order) = degrees.last().or(first) else { return Ok(None) };
    let surrogate = Surrogate::tensor(&vec![order; k], &vec![order + 1; k]);
    let points = ensemble.domain().samples(surrogate.samples());
    of_degree(ensemble, &surrogate, &points, validation, Keep::Nothing)
}

/// Bounds by jets in segments between events, if the ensemble's motions are cut there.
///
/// # Errors
/// If a sample cannot be assembled, or a closure not be compiled, and at an interruption.
pub(in crate::methods) fn of_jets(
    ensemble: &dyn Ensemble,
    space: &JetSpace,
    validation: &Validation,
) -> Result<Option<MethodResult>, EnsembleError> {
    let Some(mut pieces) = Pieces::of_jets(ensemble, space, validation)? else { return Ok(None) };
    let mut found = composed(ensemble, &pieces, PolynomialSource::Jets(space), validation)?;
    for _ in 0..TUNING.halvings_of_jets {
        if found.worst <= TUNING.enough_of_jets {
            break;
        }
        let Some(halved) = pieces.halved(ensemble, space)? else { break };
        pieces = halved;
        found = composed(ensemble, &pieces, PolynomialSource::Jets(space), validation)?;
    }
    Ok(Some(found.finished(ensemble, 1, pieces, Keep::Nothing)))
}

/// Bounds from polynomials.
struct Composed {
    bands: BandBuilder,
    simulated: Simulated,
    /// Rows that are known.
    rows: Vec<CutRow>,
    /// Motions at their times, by row and part.
    motions: Vec<Vec<RowMotion>>,
    /// Largest error as a share of its row's width.
    worst: f64,
}

impl Composed {
    /// The result of `simulations` simulations and those of the pieces; the polynomials are stored for statistics.
    fn finished(self, ensemble: &dyn Ensemble, simulations: usize, pieces: Pieces, keep: Keep) -> MethodResult {
        let simulations = simulations + pieces.added;
        let keeps = keep == Keep::Statistics;
        let kept =
            keeps.then(|| KeptPieces::new(ensemble.domain(), pieces, ensemble.outputs(), self.rows, self.motions));
        let kept = kept.map(|kept| KeptSurrogate::of_pieces(Arc::new(kept)));
        let result = self.bands.finish_keeping(simulations, self.simulated, kept);
        MethodResult { is_told_at_rows: true, ..result }
    }
}

/// Bounds from the polynomials in all parts of the box; sensitivities where there is a grid.
///
/// # Errors
/// If a closure cannot be compiled, and at an interruption.
fn composed(
    ensemble: &dyn Ensemble,
    pieces: &Pieces,
    source: PolynomialSource,
    validation: &Validation,
) -> Result<Composed, EnsembleError> {
    let domain = ensemble.domain();
    let lattice = |piece: &Piece| Lattice::new(&piece.surrogate, &piece.samples, domain.dimension());
    let lattices: Vec<Lattice> = pieces.all.iter().map(lattice).collect();
    let analysis = match source {
        PolynomialSource::Grid(grid) => Some((grid, SensitivityAnalysis::new(domain, grid))),
        PolynomialSource::Jets(_) => None,
    };
    let lines = AxisLines::new(&validation.points);
    let held_out: Vec<Vec<Point>> =
        pieces.all.iter().map(|piece| piece.surrogate.points(validation.points.clone())).collect();
    let middle = vec![0.0; domain.dimension()];
    let parameters = domain.sample(&middle);
    let mut closures: Vec<Box<dyn Closure + '_>> = Vec::new();
    let mut chosen = Vec::with_capacity(ensemble.rows());
    for row in 0..ensemble.rows() {
        let motion = pieces.part_of(&middle).map(|piece| piece.surrogate.motion_at(&middle, ensemble.time(row)));
        let independent = ensemble.independent(&parameters, &motion.unwrap_or_default(), ensemble.time(row));
        let known = closures.iter().position(|closure| closure.independent() == independent);
        chosen.push(known.unwrap_or(closures.len()));
        if known.is_none() {
            closures.push(ensemble.closure(independent)?);
        }
    }
    let known_rows = (0..ensemble.rows()).take_while(|&row| ensemble.time(row) <= pieces.known_to).count();
    let times: Vec<f64> = (0..known_rows).map(|row| ensemble.time(row)).collect();
    let of_parts: Vec<Vec<RowMotion>> = pieces
        .all
        .par_iter()
        .zip(&lattices)
        .map(|(piece, lattice)| RowMotion::of_rows(piece, lattice, &times, source))
        .collect();
    let mut of_parts: Vec<_> = of_parts.into_iter().map(Vec::into_iter).collect();
    let motions: Vec<Vec<RowMotion>> =
        times.iter().map(|_| of_parts.iter_mut().filter_map(Iterator::next).collect()).collect();
    let estimate = |row: usize| -> Vec<Estimate> {
        if row >= known_rows {
            return (0..ensemble.outputs()).map(|output| unknown(ensemble.seen(row, output))).collect();
        }
        let (time, closure) = (ensemble.time(row), closures[chosen[row]].as_ref());
        let row_of = BoxRow { domain, outputs: ensemble.outputs(), pieces, motions: &motions[row], closure, time };
        let at_corner = |output: usize, xi: &[f64]| {
            let corner = validation.points.iter().position(|point| point == xi)?;
            Some(validation.direct.at(row, output)[corner]).filter(|value| value.is_finite())
        };
        let of_part = |(row_of, (lattice, at)): (SegmentRow, (&Lattice, &Vec<Point>))| {
            let misses = Misses::new(&lines, &row_of, at, |output| validation.direct.at(row, output));
            let mut ends = extremes::ends(&row_of, lattice, Some(&misses));
            ends.iter_mut().enumerate().for_each(|(output, own)| own.hold(|xi| at_corner(output, xi)));
            ends
        };
        let parts: Vec<Vec<Ends>> = row_of.in_parts().zip(lattices.iter().zip(&held_out)).map(of_part).collect();
        let joined: Vec<(Extent, f64)> = (0..ensemble.outputs()).map(|output| joined(&parts, output)).collect();
        let extents: Vec<Extent> = joined.iter().map(|(extent, _)| extent.clone()).collect();
        let of_grid = |(grid, analysis): &(&Surrogate, SensitivityAnalysis)| {
            analysis.of_row(&SensedRow { row: &row_of, grid }, &extents)
        };
        let mut sensitivities = analysis.as_ref().map(of_grid).into_iter().flatten();
        let all = joined.into_iter().enumerate();
        all.map(|(output, (extent, moved))| {
            let outside = validation.direct.at(row, output).into_iter().map(|value| extent.range.distance(value));
            Estimate {
                range: extent.range,
                error: largest(outside.chain([moved])),
                of_search: 0.0,
                step_error: f64::NAN,
                sensitivity: sensitivities.next(),
                is_expanded: false,
                is_own: false,
            }
        })
        .collect()
    };
    let known = |row: usize| ensemble.go_on().map(|()| estimate(row));
    let mut found: Vec<Vec<Estimate>> =
        (0..ensemble.rows()).into_par_iter().map(known).collect::<Result<_, EnsembleError>>()?;
    if pieces.all.len() > 1 {
        // Next to a surface samples may miss an error in one row, and show it in the next.
        for output in 0..ensemble.outputs() {
            let errors: Vec<f64> = found.iter().map(|row| row[output].error).collect();
            found.iter_mut().zip(held_beside(&errors)).for_each(|(row, error)| row[output].error = error);
        }
    }
    let mut bands = BandBuilder::new(ensemble.outputs(), ensemble.rows());
    let shares = found.iter().flat_map(|row| row.iter().zip(&validation.spans));
    let worst = largest(shares.map(|(estimate, &span)| share(estimate, span)));
    for (row, estimates) in found.into_iter().enumerate() {
        estimates.into_iter().enumerate().for_each(|(output, estimate)| bands.set_estimate(row, output, estimate));
    }
    let beyond_tolerance_from = (known_rows < ensemble.rows()).then_some(known_rows);
    let of_row = |row: usize| {
        let independent = closures[chosen[row]].independent().to_vec();
        CutRow { time: ensemble.time(row), independent }
    };
    let rows = (0..known_rows).map(of_row).collect();
    let simulated = Simulated { beyond_tolerance_from, ..Simulated::default() };
    Ok(Composed { bands, simulated, rows, motions, worst })
}

/// An error as a share of its row's width, or of a share of the output's span if that is larger; zero if the error is
/// unknown.
fn share(estimate: &Estimate, span: f64) -> f64 {
    let share = SAFETY_OF_SURROGATE * estimate.error / estimate.range.width().max(TUNING.narrow_row * span);
    if share.is_finite() { share } else { 0.0 }
}

/// A row of which only simulated values are known.
fn unknown(seen: Range) -> Estimate {
    let range = if seen.lower <= seen.upper { seen } else { Range::UNKNOWN };
    Estimate {
        range,
        error: f64::NAN,
        of_search: 0.0,
        step_error: f64::NAN,
        sensitivity: None,
        is_expanded: false,
        is_own: false,
    }
}

/// Whether some ξ is a corner of the box.
fn is_corner(xi: &[f64]) -> bool {
    xi.iter().all(|xi| xi.abs() == 1.0)
}

/// An output's range over all parts, and how far either end may be off: by an unknown amount where one is unknown.
fn joined(parts: &[Vec<Ends>], output: usize) -> (Extent, f64) {
    let (known, unknown): (Vec<_>, Vec<_>) =
        parts.iter().map(|ends| ends[output].clone()).partition(|ends| !ends.extent.range.lower.is_nan());
    let Some(all) = known.into_iter().reduce(Ends::or) else {
        let unknown = || Extent::unknown(parts.first().map_or(0, |ends| ends[output].extent.places[0].len()));
        return (unknown(), f64::NAN);
    };
    (all.extent, if unknown.is_empty() { largest(all.errors) } else { f64::NAN })
}
