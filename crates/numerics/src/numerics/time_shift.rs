//! Splits the steps' error of a coordinate into a shift in time and a remainder.
//!
//! Steps that are too long for an oscillation change its frequency before they change its amplitude: after many turns
//! the coordinate is too early or too late by a time s, and its error is s v + r with a small r, v its velocity. At an
//! extreme over the parameters that is one over time too, v is zero.

use super::error::{RICHARDSON, largest};
use super::tuning::TUNING;

/// The steps' error of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeShift {
    /// Largest shift, s.
    pub shift: f64,
    /// Largest error that is no shift in time, in the coordinate's unit.
    pub remainder: f64,
}

/// A coordinate of one sample in a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// With the schedule's steps,
    pub direct: f64,
    /// and with halved ones.
    pub halved: f64,
    /// Its velocity.
    pub velocity: f64,
}

impl TimeShift {
    /// Rows that determine the shift in one of them.
    pub fn window(row: usize, rows: usize) -> std::ops::Range<usize> {
        row.saturating_sub(TUNING.rows_of_shift)..(row + TUNING.rows_of_shift + 1).min(rows)
    }

    /// From every sample's coordinate in a window of rows; `None` if some sample does not turn in it, so that a shift
    /// and an offset look alike.
    ///
    /// The remainder is the largest in the whole window, the offset with it: the remainder of a single row may be zero
    /// by chance.
    pub fn of(samples: impl Iterator<Item = Vec<Turning>>) -> Option<Self> {
        let mut found = Self { shift: 0.0, remainder: 0.0 };
        for sample in samples {
            let errors: Vec<f64> = sample.iter().map(|at| RICHARDSON * (at.halved - at.direct)).collect();
            let shift = slope(&errors, &sample)?;
            let remainders = errors.iter().zip(&sample).map(|(error, at)| error - shift * at.velocity);
            found =
                Self { shift: largest([found.shift, shift]), remainder: largest(remainders.chain([found.remainder])) };
        }
        Some(found)
    }
}

/// The slope of a sample's errors over its velocities, if these vary.
fn slope(errors: &[f64], sample: &[Turning]) -> Option<f64> {
    let count = sample.len() as f64;
    let velocity = sample.iter().map(|at| at.velocity).sum::<f64>() / count;
    let error = errors.iter().sum::<f64>() / count;
    let apart = |at: &Turning| at.velocity - velocity;
    let variance = sample.iter().map(|at| apart(at) * apart(at)).sum::<f64>() / count;
    let covariance = errors.iter().zip(sample).map(|(of_row, at)| (of_row - error) * apart(at)).sum::<f64>() / count;
    let turns = variance >= TUNING.turns * (variance + velocity * velocity) && variance > 0.0;
    // NaN does not turn.
    (turns && covariance.is_finite()).then(|| covariance / variance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use symdiff::math;

    fn sample(error: impl Fn(f64, f64) -> f64, phase: f64) -> Vec<Turning> {
        let at = |row: i32| {
            let t = 0.7 * f64::from(row) + phase;
            let (direct, velocity) = (math::sin(t), math::cos(t));
            Turning { direct, halved: direct + error(t, velocity) / RICHARDSON, velocity }
        };
        (0..9).map(at).collect()
    }

    #[test]
    fn shift_is_separated_from_the_remainder() {
        let late = TimeShift::of([sample(|_, v| -0.02 * v, 0.0), sample(|_, v| 0.01 * v, 1.0)].into_iter()).unwrap();
        assert!((late.shift - 0.02).abs() < 1e-12 && late.remainder < 1e-12, "{late:?}");
        // An amplitude that shrinks is no shift.
        let damped = TimeShift::of([sample(|t, _| 0.02 * math::sin(t), 0.3)].into_iter()).unwrap();
        assert!(damped.remainder > 0.015 && damped.shift < 0.01, "{damped:?}");
    }

    #[test]
    fn non_oscillating_motion_has_no_shift() {
        let steady = |velocity: f64| vec![Turning { direct: 1.0, halved: 1.1, velocity }; 9];
        assert_eq!(TimeShift::of([steady(2.0)].into_iter()), None);
        assert_eq!(TimeShift::of([steady(0.0)].into_iter()), None);
        assert_eq!(TimeShift::of([sample(|_, _| f64::NAN, 0.0)].into_iter()), None);
    }
}
