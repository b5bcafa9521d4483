//! Values between output rows: a polynomial in time through the nearest rows.

use super::tuning::TUNING;

/// A value at a time, as a sum over rows.
#[derive(Clone, Debug)]
pub struct Interpolation {
    /// Rows with their weights.
    pub fine: Vec<(usize, f64)>,
    /// The same by fewer rows; the difference estimates the error. Empty if the time is that of a row.
    pub coarse: Vec<(usize, f64)>,
}

impl Interpolation {
    /// Interpolation at a time among those of rows, which ascend; `None` if there are no rows, or if the time is after
    /// the last.
    pub fn new(times: &[f64], time: f64) -> Option<Self> {
        let next = times.partition_point(|own| *own < time);
        let is_near = |row: usize| {
            let step = if times.len() > 1 { times[1] - times[0] } else { 1.0 };
            (times[row] - time).abs() <= TUNING.in_row * step
        };
        let exact = [next, next.saturating_sub(1)].into_iter().find(|&row| row < times.len() && is_near(row));
        if let Some(row) = exact {
            return Some(Self { fine: vec![(row, 1.0)], coarse: Vec::new() });
        }
        (next < times.len()).then(|| Self {
            fine: row_weights(times, time, next, TUNING.rows_of_interpolation).collect(),
            coarse: row_weights(times, time, next, TUNING.rows_of_coarser).collect(),
        })
    }

    /// Parabolas at a time through three rows before it and three behind it: rows with their weights. Next to an impact
    /// they differ from [`fine`](Self::fine); none if the time is that of a row.
    pub fn sides(&self, times: &[f64], time: f64) -> Vec<Vec<(usize, f64)>> {
        let next = times.partition_point(|own| *own < time);
        let sides = [next.saturating_sub(2), next + 1];
        let sides = sides.into_iter().filter(|_| !self.coarse.is_empty());
        sides.map(|next| row_weights(times, time, next, TUNING.rows_of_side).collect()).collect()
    }
}

/// Lagrange's polynomials at a time through `count` rows, half of them before row `next`: rows with their weights.
pub fn row_weights(times: &[f64], time: f64, next: usize, count: usize) -> impl Iterator<Item = (usize, f64)> {
    let count = count.min(times.len());
    let first = next.saturating_sub(count / 2).min(times.len() - count);
    let rows = first..first + count;
    rows.clone().map(move |row| {
        let others = rows.clone().filter(|other| *other != row);
        (row, others.map(|other| (time - times[other]) / (times[row] - times[other])).product())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomial_of_fifth_degree_is_interpolated_exactly() {
        let times: Vec<f64> = (0..20).map(|row| 0.1 * f64::from(row)).collect();
        let course = |t: f64| 1.0 - t + 0.3 * t.powi(5);
        for time in [0.0, 0.013, 0.3, 0.77, 1.899, 1.9] {
            let found = Interpolation::new(&times, time).unwrap();
            let value: f64 = found.fine.iter().map(|&(row, weight)| weight * course(times[row])).sum();
            assert!((value - course(time)).abs() < 1e-13, "{time}");
        }
        assert!(Interpolation::new(&times, 0.3).unwrap().coarse.is_empty());
        assert!(Interpolation::new(&times, 1.95).is_none());
    }

    /// |t − 1.03|: the polynomial through rows on both sides is off, and so is one of the parabolas.
    #[test]
    fn kink_is_interpolated_from_both_sides() {
        let times: Vec<f64> = (0..20).map(|row| 0.1 * f64::from(row)).collect();
        let course = |t: f64| (t - 1.03).abs();
        let sum = |weights: &[(usize, f64)]| weights.iter().map(|&(row, weight)| weight * course(times[row])).sum();
        for time in [0.85, 0.99, 1.01, 1.05, 1.15, 1.25] {
            let found = Interpolation::new(&times, time).unwrap();
            let value: f64 = sum(&found.fine);
            let sides: Vec<f64> = found.sides(&times, time).iter().map(|side| sum(side)).collect();
            let told = sides.iter().map(|side| (side - value).abs()).fold(0.0, f64::max);
            assert!(sides.len() == 2 && (value - course(time)).abs() <= told + 1e-12, "{time}: {sides:?} {value}");
        }
        assert!(Interpolation::new(&times, 0.3).unwrap().sides(&times, 0.3).is_empty());
    }
}
