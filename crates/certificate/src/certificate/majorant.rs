//! Linear inequalities of non-negative numbers, solved with rounding upwards.

use symdiff::taylor_model::up;

use super::matrix::Bounds;
use super::tuning::TUNING;

/// An s with start + time (A s + rate) ≤ s, or `None` if none is found.
///
/// It bounds |e| where |e| ≤ start at first and |e|' ≤ A |e| + rate over that time: start + t (A s + rate) solves
/// x' ≥ A x + rate as long as it is below s, and A's entries are not negative.
pub fn bound(matrix: &Bounds, start: &[f64], time: f64, rate: &[f64]) -> Option<Vec<f64>> {
    let image = |s: &[f64]| -> Vec<f64> {
        let rows = matrix.times(s).into_iter().zip(start).zip(rate);
        rows.map(|((moved, start), rate)| up(start + up(time * up(moved + rate)))).collect()
    };
    let mut candidate = start.to_vec();
    for _ in 0..TUNING.attempts_of_majorant {
        let found = image(&candidate);
        // Written so that NaN is no proof.
        if found.iter().zip(&candidate).all(|(found, candidate)| found <= candidate) {
            return Some(found);
        }
        if found.iter().any(|value| !value.is_finite()) {
            return None;
        }
        candidate = found.iter().map(|value| TUNING.inflation_of_majorant * value + TUNING.least_candidate).collect();
    }
    None
}

/// X with X ≥ K (S + X), column by column: a bound of |(I − K')⁻¹ K' S'| for all |K'| ≤ K, |S'| ≤ S.
pub fn resolvent(contraction: &Bounds, of: &Bounds) -> Option<Bounds> {
    let (rows, columns) = of.shape();
    let mut values = vec![0.0; rows * columns];
    for column in 0..columns {
        let start = contraction.times(&of.column(column));
        let found = bound(contraction, &start, 1.0, &vec![0.0; rows])?;
        found.into_iter().enumerate().for_each(|(row, value)| values[row * columns + column] = value);
    }
    Some(Bounds::of(rows, columns, &values))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_exceed_the_solution_or_do_not_exist() {
        // x' = 3 x + 2 from 1 over 0.1: x = (1 + 2/3) e^0.3 − 2/3 = 1.5831.
        let s = bound(&Bounds::of(1, 1, &[3.0]), &[1.0], 0.1, &[2.0]).unwrap();
        assert!((1.5831..1.9).contains(&s[0]), "{s:?}");
        assert_eq!(bound(&Bounds::of(1, 1, &[3.0]), &[1.0], 0.4, &[2.0]), None);
        assert_eq!(bound(&Bounds::of(1, 1, &[f64::NAN]), &[1.0], 0.1, &[2.0]), None);
    }

    #[test]
    fn a_resolvent_bounds_a_neumann_series() {
        // K/(1 − K) = 1/3 of 2.
        let x = resolvent(&Bounds::of(1, 1, &[0.25]), &Bounds::of(1, 1, &[2.0])).unwrap();
        assert!((2.0 / 3.0..0.75).contains(&x.at(0, 0)), "{x:?}");
        assert!(resolvent(&Bounds::of(1, 1, &[1.0]), &Bounds::of(1, 1, &[2.0])).is_none());
    }
}
