//! Analyses without time steps as an ensemble: each sample goes to every configuration by itself.

use std::ops::Range as Rows;
use std::sync::atomic::Ordering;

use rayon::prelude::*;
use symdiff::jet::JetSpace;

use super::answered::answered;
use super::reducing::keep_reduced;
use super::tuning::TUNING;
use super::{Motions, stopped_at};
use crate::methods::{Effort, JET_WORK, Sampling, Simulated, Until};
use crate::numerics::Sample;
use crate::simulate::{SimulationError, SingularPass, Steps, Stop, Visit};

fn times(motions: &Motions) -> Vec<f64> {
    (0..motions.schedule.rows).map(|row| motions.schedule.time(row)).collect()
}

/// Visits samples; `reduce` gets all rows at once. Rows that a sample does not reach are NaN.
pub fn visit(
    motions: &Motions,
    samples: &[Sample],
    sampling: Sampling,
    reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
) -> Result<Simulated, SimulationError> {
    Ok(visit_watching(motions, samples, sampling, reduce)?.0)
}

/// Also returns the singular configurations that the samples passed.
pub fn visit_watching(
    motions: &Motions,
    samples: &[Sample],
    sampling: Sampling,
    reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
) -> Result<(Simulated, Vec<SingularPass>), SimulationError> {
    if let Some(source) = motions.source {
        return Ok((answered(motions, source, samples, sampling, reduce)?, Vec::new()));
    }
    let (times, outputs, count) = (times(motions), motions.simulator.system.outputs.len(), samples.len());
    let rows = times.len();
    let mut values = vec![f64::NAN; rows * outputs * count];
    let mut reduced = vec![f64::NAN; motions.channels.len() * count];
    let mut stops: Vec<Stop> = Vec::new();
    let mut singular = Vec::new();
    let mut visited = 0;
    for (block, samples) in samples.chunks(TUNING.visited_at_once).enumerate() {
        if !stops.is_empty() && sampling.until == Until::FirstStop {
            break;
        }
        let found: Vec<Result<Visit, SimulationError>> = samples
            .par_iter()
            .map(|sample| {
                motions.simulator.visit(
                    sample,
                    Steps { schedule: motions.schedule, controller: motions.tolerance },
                    motions.channels,
                    motions.interruption,
                )
            })
            .collect();
        if found.iter().any(|visit| matches!(visit, Err(SimulationError::Interrupted))) {
            break;
        }
        for (index, visit) in found.into_iter().enumerate() {
            let (visit, sample) = (visit?, block * TUNING.visited_at_once + index);
            for (line, value) in visit.values.into_iter().enumerate() {
                values[line * count + sample] = value;
            }
            for (channel, value) in visit.reduced.into_iter().enumerate() {
                reduced[channel * count + sample] = value;
            }
            singular.extend(visit.singular);
            stops.extend(visit.stop.map(|stop| Stop { sample, ..stop }));
        }
        visited += samples.len();
        motions.progress.advance(samples.len() * rows);
    }
    motions.over.fetch_add(visited, Ordering::Relaxed);
    let stop = stops.iter().copied().min_by_key(|stop| (stop.row, stop.sample));
    let missing = match stop {
        _ if visited < count && stop.is_none() => rows,
        Some(stop) if sampling.until == Until::FirstStop => rows - stop.row,
        _ => 0,
    };
    reduce(0..rows, &values);
    if visited < count {
        reduced.clear();
    }
    keep_reduced(motions, samples, &reduced);
    let simulated = Simulated {
        effort: Effort::default(),
        reduced,
        stop: stop.map(|stop| (stopped_at(&stop), samples[stop.sample].clone())),
        stopped: stops.iter().map(|stop| stop.sample).collect(),
        missing,
        ..Simulated::default()
    };
    Ok((simulated, singular))
}

/// The same of the one jet about `center`.
pub fn visit_jets(
    motions: &Motions,
    space: &JetSpace,
    center: &Sample,
    half_widths: &[f64],
    reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
) -> Result<Simulated, SimulationError> {
    let times = times(motions);
    let mut next = 0;
    let stop =
        motions.simulator.visit_jets(space, center, half_widths, &times, motions.interruption, &mut |values| {
            reduce(next..next + 1, values);
            motions.progress.advance(JET_WORK * (space.monomials().order() + 1));
            next += 1;
        })?;
    motions.over.fetch_add(1, Ordering::Relaxed);
    let stop = stop.map(|stop| (stopped_at(&stop), center.clone()));
    Ok(Simulated { stop, missing: times.len() - next, ..Simulated::default() })
}
