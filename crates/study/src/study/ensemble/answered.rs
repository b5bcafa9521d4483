//! Answers of a program as an ensemble.

use std::ops::Range as Rows;
use std::sync::atomic::Ordering;

use super::Motions;
use super::reducing::keep_reduced;
use crate::methods::{Effort, Sampling, Simulated, Stop, StopCause, Until};
use crate::numerics::Sample;
use crate::simulate::{SimulationError, reduced_rows};
use crate::study::black_box::source::ProgramSource;

/// As [`Ensemble::simulate`](crate::methods::Ensemble::simulate), by the answers of a program; `reduce` gets all
/// rows at once. A sample without an answer stops in its first row.
///
/// # Errors
/// If the program cannot be started.
pub fn answered(
    motions: &Motions,
    source: &ProgramSource,
    samples: &[Sample],
    sampling: Sampling,
    reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
) -> Result<Simulated, SimulationError> {
    let (times, outputs, count) = (source.times(), source.outputs(), samples.len());
    let rows = times.len();
    let answers = source.answers(samples, source.refinement(motions.schedule), motions.interruption, &|points| {
        motions.progress.advance(points * rows);
    });
    let answers = match answers {
        Err(SimulationError::Interrupted) => {
            return Ok(Simulated { missing: rows, ..Simulated::default() });
        }
        answers => answers?,
    };
    let mut values = vec![f64::NAN; rows * outputs * count];
    let mut reduced = vec![f64::NAN; motions.channels.len() * count];
    let mut stops: Vec<Stop> = Vec::new();
    for (sample, answer) in answers.into_iter().enumerate() {
        let found = match answer {
            Ok(found) => found,
            Err(why) => {
                let cause = StopCause::NoAnswer { why: why.to_string() };
                stops.push(Stop { sample, row: 0, time: times[0], cause });
                continue;
            }
        };
        for (line, &value) in found.iter().enumerate() {
            values[line * count + sample] = value;
        }
        for (channel, value) in reduced_rows(motions.channels, times, &found).into_iter().enumerate() {
            reduced[channel * count + sample] = value;
        }
    }
    motions.over.fetch_add(count, Ordering::Relaxed);
    reduce(0..rows, &values);
    keep_reduced(motions, samples, &reduced);
    let stopped: Vec<usize> = stops.iter().map(|stop| stop.sample).collect();
    let missing = if stops.is_empty() || sampling.until == Until::End { 0 } else { rows };
    let stop = stops.into_iter().next().map(|stop| {
        let sample = samples[stop.sample].clone();
        (stop, sample)
    });
    Ok(Simulated { effort: Effort::default(), reduced, stop, stopped, missing, ..Simulated::default() })
}
