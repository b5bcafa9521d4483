//! Chebyshev bounds through events: the instants of the events and the motions between them are expanded, since at a
//! fixed time some samples have met an event and their neighbours have not.
//!
//! - `surrogate`: polynomials of the instants, and of the motion at the nodes of each segment;
//! - `row`: the outputs at a time, and how far the polynomials' errors move them;
//! - `seeds`: where a range is searched for, and `climb`: the search within the part of the box that is in a segment,
//!   and on its surfaces.

mod climb;
mod row;
mod seeds;
mod surrogate;

use rayon::prelude::*;

use super::adaptive::Goal;
use super::composition::can_compose;
use super::sensitivity::SensitivityAnalysis;
use crate::methods::ensemble::{Closure, Ensemble, EnsembleError, Simulated};
use crate::methods::result::{BandBuilder, Estimate, MethodResult};
use crate::methods::validation::Validation;
use crate::numerics::{SAFETY_OF_SURROGATE, Sample, SegmentMotions, Surrogate, largest};
use row::SegmentRow;
use seeds::Lattice;
use surrogate::{SegmentErrors, SegmentSurrogate};

/// Degrees that are tried to a tolerance.
const DEGREES: [usize; 6] = [2, 3, 4, 6, 8, 12];

/// By segments between events, where the ensemble's motions are cut there.
///
/// # Errors
/// Where a sample cannot be assembled, or a closure not be compiled.
pub(super) fn of_degree(
    ensemble: &dyn Ensemble,
    surrogate: &Surrogate,
    samples: &[Sample],
    validation: &Validation,
) -> Result<Option<(BandBuilder, Simulated)>, EnsembleError> {
    match ensemble.segments(samples)? {
        Some(motions) => composed(ensemble, surrogate, &motions, validation),
        None => Ok(None),
    }
}

/// To the degree that the goal asks for, by segments between events, where the ensemble's motions are cut there.
///
/// # Errors
/// Where a sample cannot be assembled, or a closure not be compiled.
pub(super) fn adapted(
    ensemble: &dyn Ensemble,
    goal: &Goal,
    validation: &Validation,
) -> Result<Option<MethodResult>, EnsembleError> {
    let k = ensemble.domain().dimension();
    let (mut spent, mut best) = (0, None);
    if !can_compose(k, ensemble.scales().len()) {
        return Ok(None);
    }
    for order in DEGREES {
        let count = (order + 1).checked_pow(k as u32);
        let Some(count) = count.filter(|count| goal.spent + spent + count <= goal.budget.simulations) else { break };
        let surrogate = Surrogate::tensor(&vec![order; k], &vec![order + 1; k]);
        let samples = ensemble.domain().samples(surrogate.samples());
        let Some((bands, simulated)) = of_degree(ensemble, &surrogate, &samples, validation)? else { break };
        spent += count;
        let result = bands.finish(spent, simulated);
        let rows = |(errors, allowed): (&Vec<f64>, &f64)| {
            errors.iter().take(goal.rows).all(|error| SAFETY_OF_SURROGATE * error <= *allowed)
        };
        let is_enough = result.surrogate.iter().zip(&goal.allowed).all(rows);
        best = Some(MethodResult { order: Some(vec![order; k]), ..result });
        if is_enough || ensemble.is_interrupted() {
            break;
        }
    }
    Ok(best)
}

/// Bounds from the motions of a surrogate's samples, cut at their events; `None` where validation samples meet others.
///
/// # Errors
/// Where a sample cannot be assembled, or a closure not be compiled, and at an interruption.
fn composed(
    ensemble: &dyn Ensemble,
    tensor: &Surrogate,
    motions: &SegmentMotions,
    validation: &Validation,
) -> Result<Option<(BandBuilder, Simulated)>, EnsembleError> {
    let domain = ensemble.domain();
    let Some(direct) = ensemble.segments(&domain.samples(&validation.points))? else { return Ok(None) };
    let surrogate = SegmentSurrogate::new(tensor, motions);
    let errors = SegmentErrors::new(&surrogate, &validation.points, &direct);
    let lattice = Lattice::new(&surrogate, domain.dimension());
    let analysis = SensitivityAnalysis::new(domain, tensor);
    let middle = vec![0.0; domain.dimension()];
    let parameters = domain.sample(&middle);
    let mut closures: Vec<Box<dyn Closure + '_>> = Vec::new();
    let mut chosen = Vec::with_capacity(ensemble.rows());
    for row in 0..ensemble.rows() {
        let motion = surrogate.motion_at(&middle, ensemble.time(row));
        let independent = ensemble.independent(&parameters, &motion, ensemble.time(row));
        let known = closures.iter().position(|closure| closure.independent() == independent);
        chosen.push(known.unwrap_or(closures.len()));
        if known.is_none() {
            closures.push(ensemble.closure(independent)?);
        }
    }
    let estimate = |row: usize| -> Vec<Estimate> {
        let time = ensemble.time(row);
        let row_of =
            SegmentRow { ensemble, tensor, surrogate: &surrogate, closure: closures[chosen[row]].as_ref(), time };
        let extents = climb::extents(&row_of, &lattice);
        let moved = row_of.moved(&extents, &errors);
        let sensitivities = analysis.of_row(&row_of, &extents);
        let all = extents.into_iter().zip(moved).zip(sensitivities).enumerate();
        all.map(|(output, ((extent, moved), sensitivity))| {
            let outside = validation.direct.at(row, output).into_iter().map(|value| extent.range.distance(value));
            Estimate {
                range: extent.range,
                error: largest(outside.chain([moved])),
                of_search: 0.0,
                step_error: f64::NAN,
                sensitivity: Some(sensitivity),
                is_expanded: false,
                is_own: false,
            }
        })
        .collect()
    };
    let known = |row: usize| ensemble.go_on().map(|()| estimate(row));
    let found: Vec<Vec<Estimate>> =
        (0..ensemble.rows()).into_par_iter().map(known).collect::<Result<_, EnsembleError>>()?;
    let mut bands = BandBuilder::new(ensemble.outputs(), ensemble.rows());
    for (row, estimates) in found.into_iter().enumerate() {
        estimates.into_iter().enumerate().for_each(|(output, estimate)| bands.set_estimate(row, output, estimate));
    }
    Ok(Some((bands, Simulated::default())))
}
