//! The step within a box at which the least of some linear functions is largest, under linear limits: a linear program,
//! by the simplex method on a dictionary (V. Chvátal, Linear Programming, Freeman 1983, ch. 2 and 3).

use super::cheapest::Linear;
use super::tuning::TUNING;

/// The step s, `least` ≤ s ≤ `most`, at which the least of the `goals` is largest while all `limits` are not negative;
/// where they cannot be, the largest violation, relative to the limit's change over the box, is as small as can be.
/// Values are those at s = 0, slopes are derivatives with respect to s.
pub fn best_step(goals: &[Linear], limits: &[Linear], least: &[f64], most: &[f64]) -> Vec<f64> {
    let k = least.len();
    let widths: Vec<f64> = most.iter().zip(least).map(|(most, least)| most - least).collect();
    let in_box = |own: &Linear| InBox::new(own, &widths, least);
    let goals: Vec<InBox> = goals.iter().map(in_box).collect();
    let limits: Vec<InBox> = limits.iter().map(in_box).collect();
    // Unknowns: shares of the widths, the least goal above its least value in the box, the violation below its largest.
    let scale = goals.iter().map(InBox::change).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let lowest = goals.iter().map(InBox::least).fold(f64::INFINITY, f64::min);
    let violation = limits.iter().map(|own| -own.corner / own.change()).fold(0.0, f64::max);
    let mut dictionary = Dictionary::new(k + 2);
    dictionary.gains[k] = 1.0;
    dictionary.gains[k + 1] = TUNING.penalty;
    for own in &goals {
        let mut row: Vec<f64> = own.slopes.iter().map(|slope| -slope / scale).collect();
        row.extend([1.0, 0.0]);
        dictionary.add(row, (own.corner - lowest) / scale);
    }
    for own in &limits {
        let mut row: Vec<f64> = own.slopes.iter().map(|slope| -slope / own.change()).collect();
        row.extend([0.0, 1.0]);
        dictionary.add(row, own.corner / own.change() + violation);
    }
    for unknown in 0..k {
        dictionary.add((0..k + 2).map(|own| f64::from(u8::from(own == unknown))).collect(), 1.0);
    }
    dictionary.add((0..k + 2).map(|own| f64::from(u8::from(own == k + 1))).collect(), violation);
    if goals.is_empty() {
        dictionary.gains[k] = 0.0;
    }
    let found = dictionary.maximised();
    (0..k).map(|axis| (least[axis] + found[axis] * widths[axis]).clamp(least[axis], most[axis])).collect()
}

/// A linear function of the shares of a box's widths.
struct InBox {
    /// Its value at the lowest corner.
    corner: f64,
    slopes: Vec<f64>,
}

impl InBox {
    fn new(own: &Linear, widths: &[f64], least: &[f64]) -> Self {
        let corner = own.value + own.slopes.iter().zip(least).map(|(slope, step)| slope * step).sum::<f64>();
        Self { corner, slopes: own.slopes.iter().zip(widths).map(|(slope, width)| slope * width).collect() }
    }

    /// Its change over the box, at most; 1 if it does not change.
    fn change(&self) -> f64 {
        let change: f64 = self.slopes.iter().map(|slope| slope.abs()).sum();
        if change > f64::MIN_POSITIVE { change } else { 1.0 }
    }

    fn least(&self) -> f64 {
        self.corner + self.slopes.iter().map(|slope| slope.min(0.0)).sum::<f64>()
    }
}

/// max Σ gainsⱼ xⱼ subject to Σ rowsᵢⱼ xⱼ ≤ limitsᵢ, x ≥ 0, where limits are not negative: basic variables are those of
/// the rows, and x is one of those that are zero until a pivot exchanges it.
struct Dictionary {
    gains: Vec<f64>,
    rows: Vec<Vec<f64>>,
    limits: Vec<f64>,
    /// Number of the variable of each column, and of each row; those below the number of columns are x.
    columns: Vec<usize>,
    basis: Vec<usize>,
}

impl Dictionary {
    fn new(unknowns: usize) -> Self {
        let columns = (0..unknowns).collect();
        Self { gains: vec![0.0; unknowns], rows: Vec::new(), limits: Vec::new(), columns, basis: Vec::new() }
    }

    fn add(&mut self, row: Vec<f64>, limit: f64) {
        self.basis.push(self.columns.len() + self.rows.len());
        self.rows.push(row);
        self.limits.push(limit.max(0.0));
    }

    /// x at the largest sum of gains.
    fn maximised(mut self) -> Vec<f64> {
        let size = self.rows.len() + self.columns.len();
        for pivot in 0..TUNING.most_pivots * size {
            let Some(column) = self.entering(pivot < TUNING.pivots_by_largest * size) else { break };
            // Without a row that limits it, a gain would have no end: every unknown has a row of its own.
            let Some(row) = self.leaving(column) else { break };
            self.exchange(row, column);
        }
        let value = |unknown: usize| {
            let row = self.basis.iter().position(|own| *own == unknown);
            row.map_or(0.0, |row| self.limits[row])
        };
        (0..self.columns.len()).map(value).collect()
    }

    fn entering(&self, largest: bool) -> Option<usize> {
        let gaining = (0..self.gains.len()).filter(|&column| self.gains[column] > TUNING.rounding_of_coefficients);
        match largest {
            true => gaining.max_by(|&a, &b| self.gains[a].total_cmp(&self.gains[b])),
            false => gaining.min_by_key(|&column| self.columns[column]),
        }
    }

    fn leaving(&self, column: usize) -> Option<usize> {
        let limiting = (0..self.rows.len()).filter(|&row| self.rows[row][column] > TUNING.rounding_of_coefficients);
        let reach = |row: usize| self.limits[row] / self.rows[row][column];
        limiting.min_by(|&a, &b| reach(a).total_cmp(&reach(b)).then(self.basis[a].cmp(&self.basis[b])))
    }

    fn exchange(&mut self, row: usize, column: usize) {
        let pivot = self.rows[row][column];
        let mut own = std::mem::take(&mut self.rows[row]);
        own[column] = 1.0;
        own.iter_mut().for_each(|entry| *entry /= pivot);
        self.limits[row] /= pivot;
        for (other, entries) in self.rows.iter_mut().enumerate().filter(|(other, _)| *other != row) {
            let factor = std::mem::replace(&mut entries[column], 0.0);
            entries.iter_mut().zip(&own).for_each(|(entry, own)| *entry -= factor * own);
            self.limits[other] = (self.limits[other] - factor * self.limits[row]).max(0.0);
        }
        let factor = std::mem::replace(&mut self.gains[column], 0.0);
        self.gains.iter_mut().zip(&own).for_each(|(gain, own)| *gain -= factor * own);
        self.rows[row] = own;
        std::mem::swap(&mut self.basis[row], &mut self.columns[column]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn linear(value: f64, slopes: &[f64]) -> Linear {
        Linear { value, slopes: slopes.to_vec() }
    }

    #[test]
    fn the_least_goal_is_largest_where_goals_cross() {
        // min(1 + x, 2 − x + y, 3 − 2 y): at x = 3/2, y = 1/4 · … by hand: 1 + x = 2 − x + y = 3 − 2 y.
        let goals = [linear(1.0, &[1.0, 0.0]), linear(2.0, &[-1.0, 1.0]), linear(3.0, &[0.0, -2.0])];
        let step = best_step(&goals, &[], &[-5.0, -5.0], &[5.0, 5.0]);
        // x = (1 + y)/2 and 1 + x = 3 − 2 y: 3/2 + y/2 = 3 − 2 y, y = 3/5, x = 4/5.
        assert!((step[0] - 0.8).abs() < 1e-12 && (step[1] - 0.6).abs() < 1e-12, "{step:?}");
    }

    #[test]
    fn limits_hold_or_are_violated_by_the_least_amount() {
        let goal = [linear(0.0, &[1.0, 1.0])];
        let step = best_step(&goal, &[linear(1.0, &[-1.0, -2.0])], &[-1.0, -1.0], &[1.0, 1.0]);
        assert!((step[0] - 1.0).abs() < 1e-12 && step[1].abs() < 1e-12, "{step:?}");
        // x ≥ 3 and x ≤ −3 miss both by 3 at x = 0.
        let apart = [linear(-3.0, &[1.0, 0.0]), linear(-3.0, &[-1.0, 0.0])];
        let step = best_step(&goal, &apart, &[-1.0, -1.0], &[1.0, 1.0]);
        assert!(step[0].abs() < 1e-9 && (step[1] - 1.0).abs() < 1e-9, "{step:?}");
    }

    #[test]
    fn a_brute_force_grid_finds_nothing_better() {
        let mut state = 7_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        };
        for _ in 0..50 {
            let mut all = |count: usize, value: f64| -> Vec<Linear> {
                (0..count).map(|_| linear(value + random(), &[random(), random()])).collect()
            };
            let (goals, limits) = (all(4, 0.0), all(3, 1.0));
            let at = |own: &[Linear], x: &[f64]| {
                let of = |own: &Linear| own.value + own.slopes[0] * x[0] + own.slopes[1] * x[1];
                own.iter().map(of).fold(f64::INFINITY, f64::min)
            };
            let step = best_step(&goals, &limits, &[-1.0, -1.0], &[1.0, 1.0]);
            assert!(at(&limits, &step) > -1e-9, "{step:?}");
            for i in 0..=40 {
                for j in 0..=40 {
                    let x = [f64::from(i) / 20.0 - 1.0, f64::from(j) / 20.0 - 1.0];
                    assert!(at(&limits, &x) < 0.0 || at(&goals, &x) <= at(&goals, &step) + 1e-9);
                }
            }
        }
    }
}
