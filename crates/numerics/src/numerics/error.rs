//! Errors of a bound: the surrogate's error, and the time steps'.
//!
//! *Surrogate.* At validation samples the surrogate is compared with the simulation itself; its error is the largest
//! difference. A scan's error is estimated from its own points.
//!
//! *Time.* Some of them are simulated with halved steps too. The scheme is of second order, so that a value at step h
//! is off by 4/3 of the change by halving (Richardson). For an end of a band those validation samples count that carry
//! it: those whose values lie near it.
//!
//! Both differences change sign now and then, where they say nothing of the error nearby; each error is therefore
//! raised by its neighbours and by a share of the largest so far, and that of the steps by the peaks before and after
//! it.

use super::envelope::envelope;
use super::range::Range;
use super::tuning::TUNING;

/// Ratio of the error at step h to the change by halving h: 1/(1 − 2⁻²) for a second-order scheme.
pub const RICHARDSON: f64 = 4.0 / 3.0;

/// Factor by which the estimates of the steps' error may be wrong.
pub const SAFETY_OF_STEPS: f64 = TUNING.safety_of_steps;

/// Factor by which the estimates of the surrogate's error may be wrong.
pub const SAFETY_OF_SURROGATE: f64 = TUNING.safety_of_surrogate;

/// A band's errors over the output times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BandError {
    /// Surrogate and time together, in the output's unit.
    pub total: Vec<f64>,
    /// Largest of the surrogate's.
    pub surrogate: f64,
    /// Largest of the time steps'.
    pub time: f64,
    /// Rows whose bounds cannot be relied on.
    pub unresolved: Vec<bool>,
    /// Rows that are so only for the size of their error, which is known: large relative to the band or to the
    /// tolerance asked for.
    pub coarse: Vec<bool>,
}

/// Largest difference between a surrogate and the validation samples; unknown if either value is.
pub fn surrogate_error(surrogate: &[f64], direct: &[f64]) -> f64 {
    largest(surrogate.iter().zip(direct).map(|(surrogate, direct)| surrogate - direct))
}

/// Largest error of values at step h, given those of the first of the samples with halved steps.
pub fn step_error(direct: &[f64], halved: &[f64]) -> f64 {
    largest(direct.iter().zip(halved).map(|(direct, halved)| RICHARDSON * (halved - direct)))
}

/// Error of a band's ends from its validation samples' values, with the steps as they are and halved: the worse end's.
/// Samples without halved steps, after the others, do not count.
pub fn time_error(range: Range, direct: &[f64], halved: &[f64]) -> f64 {
    let direct = &direct[..halved.len()];
    let reach = TUNING.carries * range.width();
    let of_end = |end: f64| {
        let distance = |index: &usize| (direct[*index] - end).abs();
        let nearest = (0..direct.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let carriers = (0..direct.len()).filter(|index| distance(index) <= reach).chain(nearest);
        largest(carriers.map(|index| RICHARDSON * (halved[index] - direct[index])))
    };
    if range.lower.is_nan() { f64::NAN } else { of_end(range.lower).max(of_end(range.upper)) }
}

/// Whether each end of a band has a validation sample with halved steps near it, so that these give its error.
pub fn carries(range: Range, direct: &[f64]) -> bool {
    let reach = TUNING.carries * range.width();
    [range.lower, range.upper].iter().all(|end| direct.iter().any(|value| (value - end).abs() <= reach))
}

/// Error of a band's ends from the bounds with halved steps, all samples run again.
pub fn time_error_certified(range: Range, halved: Range) -> f64 {
    largest([range.lower - halved.lower, range.upper - halved.upper].map(|change| RICHARDSON * change))
}

impl BandError {
    /// Band error from the errors of every row, and the rows' ranges. `tolerance` is that of the error relative to
    /// `span`, the output's whole range, zero if it is at rest; a larger error is unresolved. Without one, a band is
    /// lost from where its surrogate no longer follows the response.
    pub fn new(ranges: &[Range], surrogate: &[f64], time: &[f64], span: f64, tolerance: Option<f64>) -> Self {
        let surrogate = held_up(surrogate, SAFETY_OF_SURROGATE, TUNING.of_largest);
        Self::of(surrogate, ranges, time, span, tolerance, tolerance.is_none())
    }

    /// The same with errors of the surrogate that are known row by row: none is raised by other rows, since a large
    /// error within a contact says nothing of the rows before and behind it.
    pub fn told(ranges: &[Range], surrogate: &[f64], time: &[f64], span: f64, tolerance: Option<f64>) -> Self {
        let surrogate = surrogate.iter().map(|error| SAFETY_OF_SURROGATE * error).collect();
        Self::of(surrogate, ranges, time, span, tolerance, false)
    }

    /// `lasts`: whether a row that is lost loses all behind it.
    fn of(surrogate: Vec<f64>, ranges: &[Range], time: &[f64], span: f64, tolerance: Option<f64>, lasts: bool) -> Self {
        let time = held_up(&envelope(time), SAFETY_OF_STEPS, TUNING.of_largest);
        let total: Vec<f64> = surrogate.iter().zip(&time).map(|(surrogate, time)| surrogate + time).collect();
        let is_unresolved = |(row, range): (usize, &Range)| {
            // Written so that NaN is not resolved.
            let at_rest = span == 0.0 && !total[row].is_nan();
            let small = |share: f64| total[row] <= share * span || at_rest;
            // However narrow the band is. An output at rest has rounding errors only.
            let follows = surrogate[row] <= (TUNING.lost * range.width()).max(TUNING.small_error * span) || at_rest;
            !tolerance.map_or(follows && small(TUNING.far_off), small)
        };
        let mut lost = false;
        let of_row = |row: (usize, &Range)| {
            let is_unresolved = is_unresolved(row) || lost;
            lost = lasts && is_unresolved;
            is_unresolved
        };
        let unresolved: Vec<bool> = ranges.iter().enumerate().map(of_row).collect();
        // An error that is not finite has no known size.
        let coarse =
            unresolved.iter().zip(&total).map(|(&unresolved, total)| unresolved && total.is_finite()).collect();
        Self { total, surrogate: largest(surrogate), time: largest(time), unresolved, coarse }
    }

    /// Rows whose range and error leave out a value that was simulated, given from the least to the largest of these:
    /// one of the two is wrong. An excess by rounding only is added to the error.
    pub fn contradicted(&mut self, ranges: &[Range], simulated: &[Range]) -> Vec<bool> {
        let mut contradicted = vec![false; ranges.len()];
        for (row, (range, simulated)) in ranges.iter().zip(simulated).enumerate() {
            let beyond = range.misses(*simulated);
            // An unknown range contradicts nothing.
            if beyond > self.total[row] {
                let is_rounding =
                    beyond <= TUNING.rounding_of_values * simulated.lower.abs().max(simulated.upper.abs());
                contradicted[row] = !is_rounding;
                self.total[row] = beyond;
            }
        }
        contradicted
    }

    /// Flags rows whose error is not to be believed, however small or large it is.
    pub fn distrust(&mut self, rows: std::ops::Range<usize>) {
        let last = rows.end.min(self.unresolved.len());
        let rows = rows.start.min(last)..last;
        self.unresolved[rows.clone()].fill(true);
        self.coarse[rows].fill(false);
    }

    /// Error of a row as it counts in decisions: `None` if it is not believed, doubled if it is only large.
    pub fn decisive(&self, row: usize) -> Option<f64> {
        match (self.unresolved[row], self.coarse[row]) {
            (false, _) => Some(self.total[row]),
            (true, true) => Some(TUNING.doubt * self.total[row]),
            (true, false) => None,
        }
    }

    /// Largest of all rows; NaN if one is.
    pub fn largest(&self) -> f64 {
        largest(self.total.iter().copied())
    }

    /// The first row that is not resolved.
    pub fn unresolved_from(&self) -> Option<usize> {
        self.unresolved.iter().position(|&unresolved| unresolved)
    }
}

/// Estimates times their safety, none far below its neighbours or below a share of the largest before it.
fn held_up(estimates: &[f64], safety: f64, of_largest: f64) -> Vec<f64> {
    let mut lasting = 0.0_f64;
    let held = |(own, beside): (&f64, f64)| {
        lasting = lasting.max(*own);
        let least = of_largest * lasting;
        safety * if beside < least { least } else { beside }
    };
    estimates.iter().zip(held_beside(estimates)).map(held).collect()
}

/// Estimates of rows, none far below its neighbours.
pub fn held_beside(estimates: &[f64]) -> Vec<f64> {
    let held = |row: usize| {
        let beside = [row.wrapping_sub(1), row + 1].map(|row| estimates.get(row).copied().unwrap_or(0.0));
        // `max` passes over NaN.
        let least = (TUNING.of_neighbour * beside[0]).max(TUNING.of_neighbour * beside[1]);
        if estimates[row] < least { least } else { estimates[row] }
    };
    (0..estimates.len()).map(held).collect()
}

/// Largest absolute value; NaN if one is.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |largest: f64, value: f64| if value <= largest || largest.is_nan() { largest } else { value };
    values.into_iter().map(f64::abs).fold(0.0, larger)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error_of_an_end_is_that_of_its_samples() {
        let range = Range { lower: 0.0, upper: 1.0 };
        let direct = [0.0, 0.2, 0.5, 1.0];
        let halved = [0.03, 0.2, 7.0, 1.06];
        assert!((time_error(range, &direct, &halved) - 0.08).abs() < 1e-15);
        // Where none is near, the nearest.
        let error = time_error(Range { lower: -9.0, upper: 1.0 }, &[0.0, 1.0], &[0.3, 1.0]);
        assert!((error - 0.4).abs() < 1e-15);
        assert!(time_error(Range::UNKNOWN, &direct, &halved).is_nan());
        assert!(time_error(range, &direct, &[f64::NAN; 4]).is_nan());
    }

    #[test]
    fn lost_rows_stay_lost_and_unknown_rows_are_lost() {
        let ranges = vec![Range { lower: 0.0, upper: 1.0 }; 6];
        let follows = BandError::new(&ranges, &[0.01; 6], &[0.0; 6], 1.0, None);
        assert_eq!(follows.unresolved_from(), None);
        let peak = [1e-9, 1e-2, 1e-9, 1e-9];
        let rows = [ranges[0]; 4];
        let [kept, told] = [BandError::new, BandError::told].map(|of| of(&rows, &peak, &[0.0; 4], 1.0, None).total[3]);
        assert!(told == 2e-9 && kept == 2.0 * TUNING.of_largest * 1e-2);
        let lost = BandError::new(&ranges, &[0.0, 0.0, 0.0, 0.6, 0.0, 0.0], &[0.0; 6], 1.0, None);
        assert_eq!(lost.unresolved, [false, false, true, true, true, true]);
        let unknown = BandError::new(&ranges, &[0.0, 0.0, 0.0, f64::NAN, 0.0, 0.0], &[0.0; 6], 1.0, None);
        assert_eq!(unknown.unresolved_from(), Some(3));
        assert!(unknown.surrogate.is_nan());
    }

    #[test]
    fn rounding_and_steps_lose_no_band_without_width() {
        let ranges = vec![Range { lower: 0.3, upper: 0.3 }; 2];
        assert_eq!(BandError::new(&ranges, &[1e-16; 2], &[2e-3; 2], 1.0, None).unresolved, [false; 2]);
        assert_eq!(BandError::new(&ranges, &[1e-2; 2], &[2e-3; 2], 1.0, None).unresolved, [true; 2]);
        // An output that was never seen has no span, and no error either.
        assert_eq!(BandError::new(&ranges, &[0.0; 2], &[f64::NAN; 2], 0.0, None).unresolved, [true; 2]);
        // At rest, to rounding.
        assert_eq!(BandError::new(&ranges, &[1e-16; 2], &[1e-16; 2], 0.0, None).unresolved, [false; 2]);
    }

    #[test]
    fn a_simulated_value_outside_of_range_and_error_contradicts() {
        let ranges = [Range { lower: 0.0, upper: 1.0 }; 5];
        let at = |value: f64| Range { lower: value, upper: value };
        let simulated = [at(1.01), at(1.1), crate::numerics::EMPTY, at(-0.5), Range { lower: 0.5, upper: 3.0 }];
        let mut error = BandError::new(&ranges, &[0.0; 5], &[0.01; 5], 1.0, None);
        assert_eq!(error.contradicted(&ranges, &simulated), [false, true, false, true, true]);
        let mut exact = BandError::new(&ranges[..2], &[0.0; 2], &[0.0; 2], 1.0, None);
        let rounded = 1.0_f64.next_up();
        assert_eq!(exact.contradicted(&ranges[..2], &[at(rounded), at(0.5)]), [false; 2]);
        assert!(ranges[0].upper + exact.total[0] >= rounded);
    }

    #[test]
    fn a_tolerance_is_missed_row_by_row() {
        let ranges = vec![Range { lower: 0.0, upper: 1.0 }; 5];
        let error = BandError::new(&ranges, &[0.0; 5], &[0.0, 0.0, 0.01, 0.0, 0.0], 2.0, Some(4e-3));
        assert_eq!(error.unresolved, [false, false, true, false, false]);
        assert!((error.time - 0.0125).abs() < 1e-15 && error.surrogate == 0.0);
    }
}
