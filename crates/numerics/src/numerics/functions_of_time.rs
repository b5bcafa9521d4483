//! The function of a class that makes a linear functional largest: the end of an output over all functions of the time
//! within limits, as far as the output is linear in them.
//!
//! Functions are u(t) = level + slope · t over cells of the time; the functional is Σ gₖ levelₖ + sₖ slopeₖ.
//!
//! - *Bounded*, |u| ≤ 1: levelₖ = sign gₖ, and the largest value is Σ |gₖ|, in the limit ∫ |h(t, τ)| dτ.
//! - *Held*, constant over each period: the same with sums of gₖ over periods.
//! - *Rate*, |u̇| ≤ 1 and u(0) = 0: in terms of slopes the functional has the coefficients
//!   cₖ = sₖ − gₖ tₖ₋₁ + dₖ Σⱼ﹥ₖ gⱼ, and slopeₖ = sign cₖ.
//! - *Bounded rate*, |u| ≤ 1 and |u̇| ≤ ρ: a chain of values u₀ … u_N with |uₖ − uₖ₋₁| ≤ ρ dₖ, by dynamic
//!   programming. The best value of the first cells as a function of uₖ is concave and piecewise linear: its
//!   breakpoints move apart by ρ dₖ, and a linear term moves some of them over the maximum, each a few times in all.
//!
//! Balakrishnan & Boyd, Syst. Control Lett. 19 (1992) 265 has the first; the last is Bellman's principle.

use std::collections::VecDeque;

/// Functions within limits, over their reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FunctionClass {
    /// |u| ≤ 1.
    Bounded,
    /// The same, constant over each period, s.
    Held(f64),
    /// |u̇| ≤ 1, u(0) = 0.
    Rate,
    /// |u| ≤ 1, and |u̇| at most this, 1/s.
    BoundedRate(f64),
}

/// Level and slope (1/s) in a cell; or the functional's coefficients of both.
pub type Cell = [f64; 2];

/// Ends of cells are the same up to this share of a period.
const SAME: f64 = 1e-9;

impl FunctionClass {
    /// The function that goes as far as it can, upwards (1) or downwards (−1), as soon as it can, in so many cells.
    pub fn constant(self, sign: f64, cells: usize) -> Vec<Cell> {
        match self {
            Self::Rate => vec![[0.0, sign]; cells],
            _ => vec![[sign, 0.0]; cells],
        }
    }

    /// The function that makes the functional largest, cell by cell, over cells that end at these times (s, ascending,
    /// the first begins at 0); and the functional's value.
    pub fn worst(self, ends: &[f64], functional: &[Cell]) -> (f64, Vec<Cell>) {
        let function = match self {
            Self::Bounded => with_signs(functional.iter().map(|[level, _]| *level)),
            Self::Held(period) => held(period, ends, functional),
            Self::Rate => by_rate(ends, functional),
            Self::BoundedRate(ratio) => by_bounded_rate(ratio, ends, functional),
        };
        (value(functional, &function), function)
    }

    /// What cells cost, within which no function changes: at most as much as a kernel costs that is straight in them.
    /// Periods end where cells do, and cost nothing; of functions that are bounded with their rate it is what joining
    /// cells in pairs costs.
    pub fn loss_of_cells(self, ends: &[f64], functional: &[Cell]) -> f64 {
        match self {
            Self::Bounded => at_changes(ends, &functional.iter().map(|[level, _]| *level).collect::<Vec<f64>>()),
            Self::Held(_) => 0.0,
            Self::Rate => at_changes(ends, &by_slopes(ends, functional)),
            Self::BoundedRate(_) => self.in_pairs(ends, functional),
        }
    }

    fn in_pairs(self, ends: &[f64], functional: &[Cell]) -> f64 {
        // From the end, where the kernel is largest as a rule.
        let joined = |pair: &[Cell]| pair.iter().fold([0.0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
        let mut pairs: Vec<Cell> = functional.rchunks(2).map(joined).collect();
        let mut of_pairs: Vec<f64> = ends.rchunks(2).map(|pair| pair[pair.len() - 1]).collect();
        pairs.reverse();
        of_pairs.reverse();
        (self.worst(ends, functional).0 - self.worst(&of_pairs, &pairs).0).max(0.0)
    }
}

/// What cells cost in which a kernel changes its sign, given its integrals over them. A straight one of slope s costs
/// s d² min(x, 1 − x)² where its zero is at the share x of a cell of length d.
fn at_changes(ends: &[f64], integrals: &[f64]) -> f64 {
    let length = |cell: usize| ends[cell] - begin(ends, cell);
    let cost = |cell: usize| {
        let [before, after] = [length(cell - 1), length(cell)];
        let slope = (integrals[cell] / after - integrals[cell - 1] / before) / (0.5 * (before + after));
        0.25 * slope.abs() * before.max(after).powi(2)
    };
    let changes = (1..integrals.len()).filter(|&cell| integrals[cell] * integrals[cell - 1] <= 0.0);
    changes.map(cost).sum()
}

/// The functional's value for a function.
pub fn value(functional: &[Cell], function: &[Cell]) -> f64 {
    functional.iter().zip(function).map(|(by, of)| by[0] * of[0] + by[1] * of[1]).sum()
}

/// 1, −1, or 0 of zero.
fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

/// Levels with the signs of numbers; where one is zero, as before.
fn with_signs(numbers: impl Iterator<Item = f64>) -> Vec<Cell> {
    let mut level = 0.0;
    let of_number = |number: f64| {
        level = if number == 0.0 { level } else { number.signum() };
        [level, 0.0]
    };
    numbers.map(of_number).collect()
}

fn held(period: f64, ends: &[f64], functional: &[Cell]) -> Vec<Cell> {
    let number = |end: f64| (end / period - SAME).floor();
    let mut function = Vec::with_capacity(functional.len());
    let mut first = 0;
    while first < ends.len() {
        let own = number(ends[first]);
        let count = ends[first..].iter().take_while(|end| number(**end) == own).count();
        let sum: f64 = functional[first..first + count].iter().map(|[level, _]| level).sum();
        function.resize(first + count, [sign(sum), 0.0]);
        first += count;
    }
    function
}

/// When a cell begins, s.
fn begin(ends: &[f64], cell: usize) -> f64 {
    cell.checked_sub(1).map_or(0.0, |before| ends[before])
}

/// The cell of a function that goes straight from a value to another.
fn straight(ends: &[f64], cell: usize, from: f64, to: f64) -> Cell {
    let begin = begin(ends, cell);
    let slope = (to - from) / (ends[cell] - begin);
    [from - slope * begin, slope]
}

/// The functional's coefficients in terms of slopes.
fn by_slopes(ends: &[f64], functional: &[Cell]) -> Vec<f64> {
    let mut slopes = vec![0.0; functional.len()];
    let mut levels_after = 0.0;
    for (cell, [level, slope]) in functional.iter().enumerate().rev() {
        let begin = begin(ends, cell);
        slopes[cell] = slope - level * begin + (ends[cell] - begin) * levels_after;
        levels_after += level;
    }
    slopes
}

fn by_rate(ends: &[f64], functional: &[Cell]) -> Vec<Cell> {
    let mut from = 0.0;
    let of_cell = |(cell, slope): (usize, f64)| {
        let to = from + sign(slope) * (ends[cell] - begin(ends, cell));
        let own = straight(ends, cell, from, to);
        from = to;
        own
    };
    by_slopes(ends, functional).into_iter().enumerate().map(of_cell).collect()
}

/// Breakpoints of a concave function within −1 and 1 on one side of where it is largest, the nearest to it first: how
/// far out they are before `shift` is added, and by how much the slope changes there. Beyond the last one is a limit.
#[derive(Default)]
struct Side {
    points: VecDeque<(f64, f64)>,
    shift: f64,
}

impl Side {
    /// The end of where the function is largest, outwards.
    fn nearest(&self) -> f64 {
        self.points.front().map_or(1.0, |(point, _)| (point + self.shift).min(1.0))
    }

    /// Moves the maximum outwards, until slopes have changed by so much: what it passes goes to the other side.
    fn climb(&mut self, mut slope: f64, other: &mut Self) {
        while slope > 0.0 {
            let (point, change) = match self.points.pop_front() {
                Some((point, change)) if point + self.shift < 1.0 => (point + self.shift, change),
                // All others are beyond the limit too.
                _ => {
                    self.points.clear();
                    other.points.push_front((-1.0 - other.shift, slope));
                    return;
                }
            };
            let passed = change.min(slope);
            other.points.push_front((-point - other.shift, passed));
            if change > slope {
                self.points.push_front((point - self.shift, change - slope));
            }
            slope -= passed;
        }
    }
}

fn by_bounded_rate(ratio: f64, ends: &[f64], functional: &[Cell]) -> Vec<Cell> {
    // Coefficients of the values at the cells' ends, of which the first is that at the beginning.
    let mut by_values = vec![0.0; ends.len() + 1];
    for (cell, [level, slope]) in functional.iter().enumerate() {
        let begin = begin(ends, cell);
        let by_slope = (slope - level * begin) / (ends[cell] - begin);
        by_values[cell] += level - by_slope;
        by_values[cell + 1] += by_slope;
    }
    let (mut above, mut below) = (Side::default(), Side::default());
    // Where the value of the cells so far is largest.
    let mut largest = Vec::with_capacity(by_values.len());
    for (number, &by_value) in by_values.iter().enumerate() {
        if let Some(cell) = number.checked_sub(1) {
            let reach = ratio * (ends[cell] - begin(ends, cell));
            above.shift += reach;
            below.shift += reach;
        }
        if by_value > 0.0 {
            above.climb(by_value, &mut below);
        } else {
            below.climb(-by_value, &mut above);
        }
        largest.push((-below.nearest(), above.nearest()));
    }
    let mut values = vec![0.0; by_values.len()];
    for number in (0..values.len()).rev() {
        let (from, to) = largest[number];
        values[number] = match ends.get(number) {
            None => 0.5 * (from + to),
            Some(end) => {
                let (next, reach) = (values[number + 1], ratio * (end - begin(ends, number)));
                next.max(from).min(to).clamp(next - reach, next + reach)
            }
        };
    }
    (0..ends.len()).map(|cell| straight(ends, cell, values[cell], values[cell + 1])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in [−1, 1) that are spread evenly.
    fn spread(number: usize) -> f64 {
        2.0 * (number as f64 * 0.618_033_988_749_895).fract() - 1.0
    }

    fn kernel(count: usize, seed: usize) -> Vec<Cell> {
        (0..count).map(|cell| [spread(7 * cell + seed), 0.3 * spread(11 * cell + seed)]).collect()
    }

    /// The largest value of all chains over a grid of values, by trying them all.
    fn tried(ratio: f64, ends: &[f64], functional: &[Cell], points: usize) -> f64 {
        let grid: Vec<f64> = (0..points).map(|point| 2.0 * point as f64 / (points - 1) as f64 - 1.0).collect();
        let mut best: Vec<f64> = vec![0.0; points];
        for (cell, by) in functional.iter().enumerate() {
            let reach = ratio * (ends[cell] - begin(ends, cell)) * (1.0 + 1e-9);
            let of_end = |to: f64| {
                let from = grid.iter().zip(&best).filter(|(from, _)| (to - **from).abs() <= reach);
                let values = from.map(|(from, best)| {
                    let own = straight(ends, cell, *from, to);
                    best + by[0] * own[0] + by[1] * own[1]
                });
                values.fold(f64::NEG_INFINITY, f64::max)
            };
            best = grid.iter().map(|to| of_end(*to)).collect();
        }
        best.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn chains_of_values_are_the_best_of_all() {
        for seed in 0..12 {
            let ends = [0.1, 0.2, 0.35, 0.5, 0.6, 0.8, 1.0];
            let functional = kernel(ends.len(), seed);
            // Steps of the grid are divisors of what a cell allows, so that the grid holds a best chain.
            let (best, function) = FunctionClass::BoundedRate(4.0).worst(&ends, &functional);
            let expected = tried(4.0, &ends, &functional, 101);
            assert!((best - expected).abs() < 1e-9, "{best}, not {expected}, of {seed}");
            let mut before = None;
            for (cell, [level, slope]) in function.iter().enumerate() {
                let [from, to] = [begin(&ends, cell), ends[cell]].map(|time| level + slope * time);
                assert!(slope.abs() <= 4.0 + 1e-9 && from.abs() <= 1.0 + 1e-12 && to.abs() <= 1.0 + 1e-12);
                assert!(before.is_none_or(|before: f64| (before - from).abs() < 1e-9));
                before = Some(to);
            }
        }
    }

    #[test]
    fn a_rate_beyond_all_limits_does_not_limit() {
        let ends: Vec<f64> = (1..=400).map(|end| 0.01 * f64::from(end)).collect();
        // The kernel cos(3 τ): ∫|cos 3τ| over 4 s.
        let functional: Vec<Cell> = ends.iter().map(|end| [0.01 * (3.0 * (end - 0.005)).cos(), 0.0]).collect();
        let (free, _) = FunctionClass::Bounded.worst(&ends, &functional);
        let integral = (8.0 + 12.0_f64.sin()) / 3.0;
        assert!((free - integral).abs() < 1e-3, "{free}, not {integral}");
        let slopes: Vec<Cell> =
            functional.iter().enumerate().map(|(cell, by)| [by[0], by[0] * (begin(&ends, cell) + 0.005)]).collect();
        let (fast, _) = FunctionClass::BoundedRate(1e4).worst(&ends, &slopes);
        let (slow, _) = FunctionClass::BoundedRate(1.0).worst(&ends, &slopes);
        assert!(fast > 0.98 * free && fast <= free * (1.0 + 1e-12) && slow < 0.5 * free, "{slow} {fast} {free}");
    }

    #[test]
    fn of_a_bounded_rate_the_integral_of_the_step_response_counts() {
        // y(T) = ∫ u dτ with |u̇| ≤ 1: T²/2, of all slopes 1.
        let ends: Vec<f64> = (1..=50).map(|end| 0.1 * f64::from(end)).collect();
        let functional: Vec<Cell> = (0..50).map(|cell| [0.1, 0.1 * (begin(&ends, cell) + 0.05)]).collect();
        let (best, function) = FunctionClass::Rate.worst(&ends, &functional);
        assert!((best - 12.5).abs() < 1e-9 && function.iter().all(|[_, slope]| (*slope - 1.0).abs() < 1e-9));
    }

    #[test]
    fn what_is_held_has_the_sign_of_its_period() {
        let ends = [0.1, 0.2, 0.3, 0.4, 0.5];
        let functional = [[1.0, 0.0], [-3.0, 0.0], [1.0, 0.0], [1.0, 0.0], [-0.5, 0.0]];
        let (best, function) = FunctionClass::Held(0.2).worst(&ends, &functional);
        assert_eq!(best, 2.0 + 2.0 + 0.5);
        assert_eq!(function.map_levels(), [-1.0, -1.0, 1.0, 1.0, -1.0]);
    }

    trait Levels {
        fn map_levels(&self) -> Vec<f64>;
    }

    impl Levels for Vec<Cell> {
        fn map_levels(&self) -> Vec<f64> {
            self.iter().map(|[level, _]| *level).collect()
        }
    }

    #[test]
    fn cells_cost_no_more_than_a_straight_kernel_loses_in_them() {
        // h = τ − z over four cells: cells have the integrals k − 1/2 − z, and lose (z − 2)² or (3 − z)² of it.
        let ends = [1.0, 2.0, 3.0, 4.0];
        for z in [2.0, 2.2, 2.5, 2.9] {
            let functional: Vec<Cell> = (1..=4).map(|k| [f64::from(k) - 0.5 - z, 0.0]).collect();
            let found = FunctionClass::Bounded.loss_of_cells(&ends, &functional);
            let whole = 0.5 * (z * z + (4.0 - z).powi(2));
            let lost = whole - FunctionClass::Bounded.worst(&ends, &functional).0;
            let expected = (z - 2.0).min(3.0 - z).powi(2);
            assert!((lost - expected).abs() < 1e-12 && lost <= found + 1e-12 && found <= 0.5, "{z}: {lost} {found}");
        }
        assert_eq!(FunctionClass::Held(2.0).loss_of_cells(&ends, &[[1.0, 0.0]; 4]), 0.0);
    }
}
