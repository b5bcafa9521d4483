//! Bands of an output, with their errors, and evidence that they are wrong: values that the run has simulated, and
//! other bands.

use super::tuning::TUNING;
use super::{Bounded, Outcome};
use crate::methods::Method;
use crate::numerics::{BandError, EMPTY, Range, carries, largest, step_error, time_error, time_error_certified};
use crate::results::Band;
use crate::simulate::Integration;
use crate::study::problem::Study;

/// An output's band by every method, with its error. All that was simulated lies within.
pub fn bands(study: &Study, bounded: &Bounded, output: usize, rows: usize) -> Vec<Band> {
    let Some((validation, _)) = &bounded.validation else { return Vec::new() };
    let corrections = validation.corrections(output, rows, bounded.switched_from());
    let is_explicit = bounded.plan.schedule.integration == Integration::Explicit;
    let simulated: Vec<Range> = (0..rows).map(|row| bounded.seen.range(row, output)).collect();
    let band = |(index, (method, outcome)): (usize, &(Method, Outcome))| {
        // As constants, then as functions of the time.
        let constant = &outcome.result.bands[output][..rows];
        let functions = bounded.functions.as_ref();
        let of_functions = |row: usize| functions.map_or(EMPTY, |functions| functions.range(row, output));
        let found: Vec<Range> = (0..rows).map(|row| constant[row].with(of_functions(row))).collect();
        let found = &found[..];
        let is_sampled = method.about().is_sampled;
        // A proven band needs no samples. (It may miss them by the rounding of the steps' equations.)
        let widened = |(range, simulated): (&Range, &Range)| if is_sampled { range.with(*simulated) } else { *range };
        let ranges: Vec<Range> = found.iter().zip(&simulated).map(widened).collect();
        let halved = bounded.halved.get(index).map(|(_, halved)| &halved.result.bands[output]);
        let by_halving = |row: usize| {
            if let Some(halved) = halved {
                return time_error_certified(constant[row], halved[row]);
            }
            let (direct, halved) = (validation.direct.at(row, output), validation.halved.at(row, output));
            let by_coordinates = outcome.result.steps[output][row];
            let by_samples = time_error(constant[row], &direct, &halved);
            // Either estimate is enough: from the validation samples near the ends, if there are any, or from the
            // effect of the coordinates' errors on the ends, which is nothing where a range is saturated. (`min` passes
            // over NaN.) Long explicit steps of a high order err otherwise where values are nearly the same.
            if by_coordinates.is_nan() || !is_explicit && carries(constant[row], &direct[..halved.len()]) {
                by_samples.min(by_coordinates)
            } else {
                by_coordinates
            }
        };
        // Motion that halved steps have damped away too is added.
        let damped = |row: usize| -> f64 {
            bounded.doubts.damped.iter().map(|mode| mode.lost(output, bounded.plan.schedule.time(row))).sum()
        };
        let mut time: Vec<f64> = (0..rows).map(|row| corrections[row].of(by_halving(row)) + damped(row)).collect();
        let mut surrogate = outcome.result.surrogate[output][..rows].to_vec();
        let mut span = validation.spans[output];
        if let Some(functions) = functions {
            for row in 0..rows {
                surrogate[row] += functions.open(row, output);
                time[row] = largest([time[row], functions.steps(row, output)]);
                span = span.max(found[row].width());
            }
        }
        let of_rows = if outcome.result.is_told_at_rows { BandError::told } else { BandError::new };
        let with = |surrogate: &[f64]| of_rows(&ranges, surrogate, &time, span, study.request.tolerance);
        let surrogate = &surrogate[..];
        let mut error = with(surrogate);
        // The nominal simulation has steps, which the motion that is proven does not have.
        let explained = |row: usize, nominal: Range| {
            let (direct, halved) = (validation.direct.at(row, output), validation.halved.at(row, output));
            outcome.result.steps[output][row] == 0.0
                && constant[row].misses(nominal) <= TUNING.outside_of_proof * step_error(&direct, &halved)
        };
        let held: Vec<Range> = match is_sampled {
            true => simulated.clone(),
            false => {
                let nominal = bounded.nominal_within(&study.domain, output);
                (0..rows).map(|row| if explained(row, nominal[row]) { EMPTY } else { nominal[row] }).collect()
            }
        };
        let contradicted = error.contradicted(found, &held);
        if contradicted.contains(&true) {
            let beyond = |row: usize| if contradicted[row] { found[row].misses(held[row]) } else { 0.0 };
            let raised: Vec<f64> = (0..rows).map(|row| surrogate[row].max(beyond(row))).collect();
            error = with(&raised);
            (0..rows).filter(|&row| contradicted[row]).for_each(|row| error.distrust(row..row + 1));
        }
        if let Some(row) = bounded.unreliable_from() {
            error.distrust(row..rows);
        }
        Band {
            method: *method,
            lower: ranges.iter().map(|range| range.lower).collect(),
            upper: ranges.iter().map(|range| range.upper).collect(),
            error,
        }
    };
    let mut bands: Vec<Band> = bounded.methods.iter().enumerate().map(band).collect();
    flag_exclusions(&mut bands);
    bands
}

/// The largest width of an output's bounds by the first method, with excitations that are constants.
pub fn as_constants(bounded: &Bounded, output: usize, rows: usize) -> f64 {
    let Some((_, outcome)) = bounded.methods.first() else { return f64::NAN };
    let of_row = |row: usize| outcome.result.bands[output][row].with(bounded.seen.range(row, output)).width();
    (0..rows).map(of_row).fold(0.0, f64::max)
}

/// Flags rows in which two methods exclude each other: one of them is wrong, and it is unknown which. Proven bands are
/// not flagged.
fn flag_exclusions(bands: &mut [Band]) {
    let rows = bands.first().map_or(0, |band| band.lower.len());
    let mut excluded: Vec<(usize, usize)> = Vec::new();
    for (a, b) in (0..bands.len()).flat_map(|b| (0..b).map(move |a| (a, b))) {
        let (a_is_sampled, b_is_sampled) = (bands[a].method.about().is_sampled, bands[b].method.about().is_sampled);
        for row in (0..rows).filter(|&row| exclude(&bands[a], &bands[b], row)) {
            excluded.extend(a_is_sampled.then_some((a, row)));
            excluded.extend(b_is_sampled.then_some((b, row)));
        }
    }
    excluded.into_iter().for_each(|(band, row)| bands[band].error.distrust(row..row + 1));
}

/// Whether an end of two bands that are relied on in a row cannot be the same. A proven band holds the range, and may
/// be wider.
fn exclude(a: &Band, b: &Band, row: usize) -> bool {
    let proven = [a, b].map(|band| !band.method.about().is_sampled);
    let below = a.lower[row] - b.lower[row];
    let above = b.upper[row] - a.upper[row];
    // Distances by which b reaches beyond a, and a beyond b.
    let [b_beyond, a_beyond] = [below.max(above), (-below).max(-above)];
    let apart = match proven {
        [false, false] => a_beyond.max(b_beyond),
        [true, false] => b_beyond,
        [false, true] => a_beyond,
        [true, true] => 0.0,
    };
    let are_relied_on = !a.error.unresolved[row] && !b.error.unresolved[row];
    are_relied_on && apart > a.error.total[row] + b.error.total[row]
}
