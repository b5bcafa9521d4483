//! The smallest and largest value of a band over the run, with an allowance for peaks between its rows.

use serde::Serialize;

use super::tuning::TUNING;
use super::{Band, Bounds, OutputBounds};

/// The least and the greatest value of a band over the run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PeakSummary {
    /// Name of the output.
    pub output: String,
    /// Its SI unit, in which the numbers are; empty if dimensionless or unknown.
    pub unit: String,
    /// Name of the method.
    pub method: String,
    /// The smallest lower bound.
    pub least: Peak,
    /// The largest upper bound.
    pub greatest: Peak,
}

/// An extreme over the run: the true one of all times lies within `error` of `value`, as far as the rows show the
/// motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Peak {
    /// The row's time, s.
    pub time: f64,
    /// Value in the row.
    pub value: f64,
    /// The row's own error with the allowance for a peak between rows; NaN if a row is unknown.
    pub error: f64,
}

impl PeakSummary {
    /// Peaks of every band.
    pub fn of(bounds: &Bounds) -> Vec<Self> {
        let of_band = |output: &OutputBounds, band: &Band| {
            let negative: Vec<f64> = band.lower.iter().map(|value| -value).collect();
            let least = Peak::of(&bounds.times, &negative, &band.error.total)?;
            Some(Self {
                output: output.name.clone(),
                unit: output.unit.clone(),
                method: band.method.name().to_owned(),
                least: Peak { value: -least.value, ..least },
                greatest: Peak::of(&bounds.times, &band.upper, &band.error.total)?,
            })
        };
        let of_output = |output: &'_ OutputBounds| -> Vec<Self> {
            output.bands.iter().filter_map(|band| of_band(output, band)).collect()
        };
        bounds.outputs.iter().flat_map(of_output).collect()
    }
}

impl Peak {
    /// The greatest value of a curve with errors; `None` without any known row.
    fn of(times: &[f64], values: &[f64], errors: &[f64]) -> Option<Self> {
        let known = (0..values.len()).filter(|&row| values[row].is_finite());
        let row = known.max_by(|&a, &b| values[a].total_cmp(&values[b]).then(b.cmp(&a)))?;
        let value = values[row];
        let highest = (0..values.len()).map(|row| values[row] + errors[row] + between(values, row));
        let surely = (0..values.len()).map(|row| values[row] - errors[row]);
        let [highest, surely] = [highest.fold(value, worse), surely.fold(f64::NEG_INFINITY, worse)];
        Some(Self { time: times[row], value, error: worse(highest - value, value - surely) })
    }
}

/// Possible excess of the curve over a row, on either side of it.
fn between(values: &[f64], row: usize) -> f64 {
    let last = values.len().saturating_sub(1);
    if last < 2 {
        // Two rows show no curvature: all that lies between them may be as much again.
        return values.first().zip(values.last()).map_or(0.0, |(first, last)| (first - last).abs());
    }
    let second = |at: usize| values[at - 1] - 2.0 * values[at] + values[at + 1];
    let places = row.saturating_sub(1).clamp(1, last - 1)..=(row + 1).clamp(1, last - 1);
    let bent = places.map(|at| second(at).abs()).fold(0.0, worse);
    // The first and the last row have none: theirs goes on from the next two as a line does.
    let at_end = match row {
        _ if last < 3 => 0.0,
        0 | 1 => 2.0 * second(1) - second(2),
        _ if row + 1 >= last => 2.0 * second(last - 1) - second(last - 2),
        _ => 0.0,
    };
    TUNING.between_rows * worse(bent, at_end.abs())
}

/// The larger one; NaN is passed on, not over.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn peak(step: f64, rows: usize, f: impl Fn(f64) -> f64) -> Peak {
        let times: Vec<f64> = (0..rows).map(|row| step * row as f64).collect();
        let values: Vec<f64> = times.iter().map(|&time| f(time)).collect();
        Peak::of(&times, &values, &vec![1e-6; rows]).unwrap()
    }

    #[test]
    fn error_covers_peaks_between_rows_closely() {
        // A parabola whose vertex is in the middle of two rows: 0.0025 higher than these.
        let found = peak(0.1, 11, |time| 1.0 - (time - 0.45) * (time - 0.45));
        assert_eq!((found.time, found.value), (0.4, 1.0 - (0.4_f64 - 0.45) * (0.4 - 0.45)));
        assert!(found.error > 0.0025 && found.error < 0.0051, "{found:?}");
        // A line has no extreme between its rows; unknown values stay unknown.
        let line = peak(0.1, 11, |time| 2.0 * time);
        assert!((line.error - 1e-6).abs() < 1e-12 && line.time == 1.0, "{line:?}");
        let unknown = peak(0.1, 11, |time| if time > 0.75 { f64::NAN } else { time });
        assert!(unknown.error.is_nan() && unknown.value > 0.69, "{unknown:?}");
        assert!(Peak::of(&[0.0], &[f64::NAN], &[0.0]).is_none());
        assert_eq!(Peak::of(&[0.0], &[2.0], &[0.5]).map(|peak| (peak.value, peak.error)), Some((2.0, 0.5)));
    }

    proptest! {
        /// A sum of oscillations, of which the faster one has four rows a period: its greatest value on a grid that is
        /// a thousand times as fine.
        #[test]
        fn the_true_peak_is_within_the_error(
            phases in prop::array::uniform2(0.0..6.2_f64), share in 0.0..1.0_f64, slow in 0.05..0.9_f64, fast in 0.9..1.55_f64,
        ) {
            let f = |time: f64| (slow * time + phases[0]).sin() + share * (fast * time + phases[1]).cos();
            let rows = 12;
            let found = peak(1.0, rows, f);
            let fine = (0..=1000 * (rows - 1)).map(|index| f(1e-3 * index as f64)).fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(fine >= found.value - 1e-12 && fine <= found.value + found.error, "{fine} and {found:?}");
        }
    }
}
