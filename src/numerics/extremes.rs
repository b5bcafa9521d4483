//! The extremes of functions of few parameters: the best of a grid over the box, and then the peak beside it.

use super::peak::Peak;
use super::range::Range;
use super::samples::TensorGrid;

/// First distance of neighbours in the search near a known extreme.
const NEAR: f64 = 0.1;

/// The least and the largest value are sought.
const SIGNS: [f64; 2] = [-1.0, 1.0];

/// An end is found when a step changes less than this share of the range's width.
const SETTLED: f64 = 1e-6;

/// Most steps of the search for an end.
const ROUNDS: usize = 10;

/// A function's range.
#[derive(Clone, Debug, PartialEq)]
pub struct Extent {
    /// The least and the largest value found.
    pub range: Range,
    /// How far the search may have missed its ends.
    pub gap: f64,
    /// ξ of the least and of the largest value.
    pub places: [Vec<f64>; 2],
}

/// Extremes of many functions over [−1, 1]^k at once: `evaluate` gives their values at some ξ, function by function. The grid
/// has `points` ≥ 3 along each axis. Unknown where a value on it is NaN.
pub fn extremes(k: usize, points: usize, evaluate: impl Fn(&[Vec<f64>]) -> Vec<f64>) -> Vec<Extent> {
    let grid = TensorGrid::full_factorial(&vec![points; k]);
    let samples: Vec<Vec<f64>> = (0..grid.len()).map(|index| grid.sample(index)).collect();
    let values = evaluate(&samples);
    let mut ends: Vec<End> =
        values.chunks_exact(grid.len()).flat_map(|line| SIGNS.map(|sign| End::on_grid(line, &grid, sign))).collect();
    climb(&mut ends, &evaluate);
    ends.chunks_exact(2).map(extent).collect()
}

/// Extremes of other functions, not far from those of similar ones.
pub fn extremes_near(known: &[Extent], evaluate: impl Fn(&[Vec<f64>]) -> Vec<f64>) -> Vec<Extent> {
    let near = |extent: &Extent| [0, 1].map(|end| End::near(extent.places[end].clone(), SIGNS[end]));
    let mut ends: Vec<End> = known.iter().flat_map(near).collect();
    climb(&mut ends, &evaluate);
    ends.chunks_exact(2).map(extent).collect()
}

/// Searches until all ends are found.
fn climb(ends: &mut [End], evaluate: &impl Fn(&[Vec<f64>]) -> Vec<f64>) {
    for _ in 0..ROUNDS {
        let searched: Vec<usize> = (0..ends.len()).filter(|&end| !ends[end].found).collect();
        let around: Vec<Vec<Vec<f64>>> = searched.iter().map(|&end| ends[end].points()).collect();
        let points = around.concat();
        if points.is_empty() {
            break;
        }
        let values = evaluate(&points);
        let mut first = 0;
        for (&end, around) in searched.iter().zip(&around) {
            let width = ends[end | 1].best - ends[end & !1].best;
            ends[end].refine(around, &values[end / 2 * points.len() + first..][..around.len()], width);
            first += around.len();
        }
    }
}

fn extent(ends: &[End]) -> Extent {
    Extent {
        range: Range { lower: ends[0].best, upper: ends[1].best },
        gap: ends[0].gap.max(ends[1].gap),
        places: [0, 1].map(|end| ends[end].best_xi.clone()),
    }
}

/// One end of a function's range, as it is found.
struct End {
    sign: f64,
    /// Where the peak is looked for, and where it is believed to be.
    around: Peak,
    xi: Vec<f64>,
    /// The best value seen, and where; NaN where one was not.
    best: f64,
    best_xi: Vec<f64>,
    /// What the last step of the search changed.
    gap: f64,
    found: bool,
}

impl End {
    /// The best of the values on a grid, and the peak that its neighbours tell.
    fn on_grid(values: &[f64], grid: &TensorGrid, sign: f64) -> Self {
        let better = |a: usize, b: usize| if sign * values[b] > sign * values[a] { b } else { a };
        let place = (0..values.len()).fold(0, better);
        let unknown = values.iter().any(|value| value.is_nan());
        let best = if unknown { f64::NAN } else { values[place] };

        let peak = Peak::new(grid.sample(place), grid.spacing());
        let middle = grid.inner(place);
        let stencil: Vec<f64> = peak.stencil().iter().map(|offsets| values[grid.beside(middle, offsets)]).collect();
        let xi = peak.vertex(&stencil, sign);
        Self { sign, around: peak.next(&xi), xi, best, best_xi: grid.sample(place), gap: 0.0, found: unknown }
    }

    /// Not far from a place; nothing is known of the function.
    fn near(xi: Vec<f64>, sign: f64) -> Self {
        let around = Peak::new(xi.clone(), vec![NEAR; xi.len()]);
        Self { sign, around, best_xi: xi.clone(), xi, best: -sign * f64::INFINITY, gap: f64::NAN, found: false }
    }

    /// Where the function is needed for the next step: around the peak, and on it.
    fn points(&self) -> Vec<Vec<f64>> {
        let stencil = self.around.stencil();
        stencil.iter().map(|offsets| self.around.neighbour(offsets)).chain([self.xi.clone()]).collect()
    }

    /// Takes in the values there. `width` is that of the range so far.
    fn refine(&mut self, points: &[Vec<f64>], values: &[f64], width: f64) {
        let best = (0..values.len()).fold(0, |a, b| if self.sign * values[b] > self.sign * values[a] { b } else { a });
        let gain = self.sign * (values[best] - self.best);
        // NaN beside the grid's points changes nothing.
        if gain > 0.0 {
            self.gap = gain;
            self.found = gain <= SETTLED * width;
            self.best = values[best];
            self.best_xi.clone_from(&points[best]);
            self.xi = self.around.vertex(&values[..values.len() - 1], self.sign);
            self.around = self.around.next(&self.xi);
        } else {
            // Nothing better around the best, or the quadratic led away from it.
            self.gap = 0.0;
            self.found = self.xi == self.best_xi;
            self.xi.clone_from(&self.best_xi);
            self.around = self.around.nearer(&self.xi);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(k: usize, points: usize, f: impl Fn(&[f64]) -> f64) -> Extent {
        extremes(k, points, |points| points.iter().map(|xi| f(xi)).collect()).swap_remove(0)
    }

    #[test]
    fn a_peak_beside_an_edge_is_found() {
        // Between the last two points of the grid.
        let found = range(1, 9, |xi| (xi[0] - 0.93).powi(2) + 0.1 * (xi[0] - 0.93).powi(3));
        assert!(found.range.lower.abs() < 1e-9 && found.gap < 1e-6, "{found:?}");
        assert!((found.range.upper - (1.93_f64.powi(2) - 0.1 * 1.93_f64.powi(3))).abs() < 1e-12);
    }

    #[test]
    fn a_ridge_is_followed_to_its_end() {
        // Along x ≈ y the function hardly changes; its least value is where the ridge leaves the box.
        let f = |xi: &[f64]| 100.0 * (xi[0] - xi[1] + 0.3 * xi[0] * xi[0]).powi(2) + 0.1 * xi[1] + 0.05 * xi[2];
        let least = |y: f64| {
            // The best x for this y, by a dense search.
            (0..=200_000).map(|i| f(&[-1.0 + 1e-5 * f64::from(i), y, -1.0])).fold(f64::INFINITY, f64::min)
        };
        let found = range(3, 7, f);
        let truth = (0..=40).map(|i| least(-1.0 + 0.01 * f64::from(i))).fold(f64::INFINITY, f64::min);
        assert!((found.range.lower - truth).abs() < 1e-3 * found.range.width(), "{found:?}, {truth}");
    }

    #[test]
    fn a_function_that_is_shifted_has_its_extremes_nearby() {
        let wave = |shift: f64| {
            move |points: &[Vec<f64>]| points.iter().map(|xi| (9.0 * xi[0] + shift).sin() + 0.1 * xi[1]).collect()
        };
        let known: Vec<Extent> = extremes(2, 25, wave(0.0));
        let shifted = extremes_near(&known, wave(0.4));
        assert!(
            (shifted[0].range.upper - 1.1).abs() < 1e-6 && (shifted[0].range.lower + 1.1).abs() < 1e-6,
            "{shifted:?}"
        );
        let slope = |shift: f64| move |points: &[Vec<f64>]| points.iter().map(|xi| xi[0] + shift).collect();
        let shifted = extremes_near(&extremes(1, 5, slope(0.0)), slope(0.4));
        assert!((shifted[0].range.upper - 1.4).abs() < 1e-12 && (shifted[0].range.lower + 0.6).abs() < 1e-12);
    }

    #[test]
    fn nothing_uncertain_and_the_unknown() {
        assert_eq!(range(0, 9, |_| 3.0).range, Range { lower: 3.0, upper: 3.0 });
        assert!(range(1, 9, |xi| if xi[0] == 0.0 { f64::NAN } else { 1.0 }).range.lower.is_nan());
    }
}
