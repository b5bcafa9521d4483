//! Choice of rows of tables between which straight lines are best, as when a motion is shown.

use std::collections::BinaryHeap;

/// Rows × lines of one or more samples, by which rows are chosen.
pub struct Thinning<'v> {
    /// (row, line) of each sample.
    pub samples: Vec<&'v [f64]>,
    /// Weight of a line's deviation.
    pub weights: &'v [f64],
}

/// The rows between two selected ones, with the one that is furthest from the straight line.
#[derive(PartialEq)]
struct Gap {
    error: f64,
    worst: usize,
    from: usize,
    to: usize,
}

impl Eq for Gap {}

impl Ord for Gap {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.error.total_cmp(&other.error).then(other.from.cmp(&self.from))
    }
}

impl PartialOrd for Gap {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Thinning<'_> {
    /// At most `most` of the rows, and the error of straight lines between them: the first and the last, then always
    /// the row that is furthest from its line (Ramer, Comput. Graph. Image Process. 1 (1972) 244), until all are within
    /// `enough`.
    pub fn rows(&self, times: &[f64], most: usize, enough: f64) -> (Vec<usize>, f64) {
        let last = times.len().saturating_sub(1);
        let mut kept = if last == 0 { vec![0] } else { vec![0, last] };
        let mut gaps = BinaryHeap::from([self.gap(times, 0, last)]);
        while let Some(gap) = gaps.peek().filter(|gap| gap.error > enough && kept.len() < most) {
            let (from, worst, to) = (gap.from, gap.worst, gap.to);
            gaps.pop();
            kept.push(worst);
            gaps.push(self.gap(times, from, worst));
            gaps.push(self.gap(times, worst, to));
        }
        kept.sort_unstable();
        (kept, gaps.peek().map_or(0.0, |gap| gap.error))
    }

    fn gap(&self, times: &[f64], from: usize, to: usize) -> Gap {
        let lines = self.weights.len();
        let mut gap = Gap { error: 0.0, worst: from, from, to };
        for row in from + 1..to {
            let share = (times[row] - times[from]) / (times[to] - times[from]);
            for values in &self.samples {
                let at = |row: usize| &values[row * lines..][..lines];
                let ends = at(from).iter().zip(at(to)).zip(at(row)).zip(self.weights);
                for (((&first, &last), &value), &weight) in ends {
                    let error = weight * (value - first - share * (last - first)).abs();
                    if error > gap.error {
                        (gap.error, gap.worst) = (error, row);
                    }
                }
            }
        }
        gap
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_survives() {
        let times: Vec<f64> = (0..1000).map(|row| 1e-3 * row as f64).collect();
        let mut values = vec![0.0; 1000];
        values[437] = 1.0;
        let thinning = Thinning { samples: vec![&values], weights: &[1.0] };
        let (rows, error) = thinning.rows(&times, 10, 1e-9);
        assert_eq!((rows, error), (vec![0, 436, 437, 438, 999], 0.0));
    }

    #[test]
    fn thinning_limits_the_rows_and_states_the_error() {
        let times: Vec<f64> = (0..=100).map(f64::from).collect();
        let parabola: Vec<f64> = times.iter().map(|time| time * time).collect();
        let thinning = Thinning { samples: vec![&parabola], weights: &[2.0] };
        let (rows, error) = thinning.rows(&times, 5, 1e-9);
        assert_eq!(rows, [0, 25, 50, 75, 100]);
        // 2·(h/2)² of a parabola between rows that are h = 25 apart; rows lie next to the middle.
        assert_eq!(error, 2.0 * 12.0 * 13.0);
        assert_eq!(thinning.rows(&times[..1], 5, 0.0).0, [0]);
    }
}
