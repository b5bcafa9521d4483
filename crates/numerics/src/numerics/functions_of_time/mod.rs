//! The function of a class that makes a linear functional largest: the end of an output over all functions of the time
//! within limits, as far as the output is linear in them.
//!
//! Functions are u(t) = level + slope · t over cells of the time; the functional is Σ gₖ levelₖ + sₖ slopeₖ.
//!
//! - *Bounded*, |u| ≤ 1: levelₖ = sign gₖ, and the largest value is Σ |gₖ|, in the limit ∫ |h(t, τ)| dτ.
//! - *Held*, constant over each period: the same with sums of gₖ over periods.
//! - *Rate*, |u̇| ≤ 1 and u(0) = 0: in terms of slopes the functional has the coefficients
//!   cₖ = sₖ − gₖ tₖ₋₁ + dₖ Σⱼ﹥ₖ gⱼ, and slopeₖ = sign cₖ.
//! - *Bounded rate*, between limits with |u̇| ≤ ρ: a chain of values, by dynamic programming (`rate`).
//! - *Mean* and *energy* over the whole time: `budget`.
//! - *Band*: sines of a band of frequencies and their mixtures (`band`).
//!
//! Balakrishnan & Boyd, Syst. Control Lett. 19 (1992) 265 has the first.

mod band;
mod budget;
mod jumps;
mod rate;
#[cfg(test)]
mod tests;
pub(crate) mod tuning;

use std::sync::Arc;

use self::rate::Limits;
use tuning::TUNING;

/// Functions within limits.
#[derive(Clone, Debug, PartialEq)]
pub enum FunctionClass {
    /// |u| ≤ 1.
    Bounded,
    /// The same, constant over each period, s.
    Held(f64),
    /// |u̇| ≤ 1, u(0) = 0.
    Rate,
    /// |u| ≤ 1, and |u̇| at most this, 1/s.
    BoundedRate(f64),
    /// |u| ≤ 1 between limits that move, x = middle + reach · u, and |ẋ| at most `rate`.
    Moving {
        /// Middle and reach at the beginning, and at the end of each cell. They move no faster than `rate`.
        limits: Arc<[[f64; 2]]>,
        /// Largest |ẋ|, in the unit of x per s.
        rate: f64,
    },
    /// |u| ≤ 1, with a mean over the whole time between these.
    Mean([f64; 2]),
    /// ∫ u² dt is at most `energy` (s) over the whole time; `bounded` ones have |u| ≤ 1 too.
    Energy {
        /// s
        energy: f64,
        /// Whether |u| ≤ 1.
        bounded: bool,
    },
    /// Mixtures of sines of frequencies between these (Hz), whose amplitudes add up to 1 at most.
    Band([f64; 2]),
}

/// Level and slope (1/s) in a cell; or the functional's coefficients of both.
pub type Cell = [f64; 2];

/// The best function of a class for a functional.
#[derive(Clone, Debug)]
pub struct Worst {
    /// The functional's value.
    pub value: f64,
    /// Cell by cell.
    pub function: Vec<Cell>,
    /// Cost of cells, within which no function changes: at most as much as a kernel costs that is straight in them. Of
    /// functions that are bounded with their rate it is that of joining cells in pairs; of sines, by how much their
    /// chords are smaller.
    pub loss: f64,
}

impl FunctionClass {
    /// The function in the middle of the class, over cells that end at these times (s, ascending, the first begins at
    /// 0).
    pub fn middle(&self, ends: &[f64]) -> Vec<Cell> {
        match self {
            Self::Mean([least, most]) => vec![[0.5 * (least + most), 0.0]; ends.len()],
            _ => vec![[0.0; 2]; ends.len()],
        }
    }

    /// The function that goes as far as it can, upwards (1) or downwards (−1), as soon as it can and for the whole
    /// time, over such cells.
    pub fn constant(&self, sign: f64, ends: &[f64]) -> Vec<Cell> {
        let level = |level: f64| vec![[level, 0.0]; ends.len()];
        match self {
            Self::Rate => vec![[0.0, sign]; ends.len()],
            Self::Mean(mean) => level(mean[usize::from(sign > 0.0)]),
            Self::Energy { energy, bounded } => {
                let most = (energy / ends.last().copied().unwrap_or(0.0)).sqrt();
                level(sign * if *bounded { most.min(1.0) } else { most })
            }
            Self::Band([least, _]) => level(if *least > 0.0 { 0.0 } else { sign }),
            Self::Bounded | Self::Held(_) | Self::BoundedRate(_) | Self::Moving { .. } => level(sign),
        }
    }

    /// The function that makes the functional largest.
    pub fn worst(&self, ends: &[f64], functional: &[Cell]) -> Worst {
        let (function, loss) = match self {
            Self::Bounded => {
                let levels = levels(functional);
                (jumps::with_signs(levels.iter().copied()), at_changes(ends, &levels))
            }
            // Periods end where cells do.
            Self::Held(period) => (jumps::held(*period, ends, functional), 0.0),
            Self::Rate => {
                let slopes = rate::by_slopes(ends, functional);
                (rate::from_zero(ends, &slopes), at_changes(ends, &slopes))
            }
            Self::BoundedRate(ratio) => between(*ratio, &rate::Still, ends, functional),
            Self::Moving { limits, rate } => between(*rate, limits, ends, functional),
            Self::Mean(mean) => {
                let (function, multiplier) = budget::with_mean(*mean, ends, functional);
                (function, loss_by_mean(multiplier, ends, functional))
            }
            Self::Energy { energy, bounded } => {
                let (function, factor) = budget::with_energy(*energy, *bounded, ends, functional);
                let loss = if factor.is_finite() {
                    budget::loss_by_energy(factor, ends, functional, &function)
                } else {
                    at_changes(ends, &levels(functional))
                };
                (function, loss)
            }
            Self::Band(band) => {
                let (function, frequency) = band::worst_sine(*band, ends, functional);
                let loss = value(functional, &function) * band::share_of_chords(frequency, ends);
                (function, loss)
            }
        };
        Worst { value: value(functional, &function), function, loss }
    }

    /// Times, s, at which the best function would switch, if it could within cells: zeros of the kernel, which is
    /// straight between the middles of cells. Empty of functions that do not switch anywhere, and of those with a mean:
    /// they switch where the kernel is not zero, and steps of different lengths smear that differently.
    pub fn switches(&self, ends: &[f64], functional: &[Cell]) -> Vec<f64> {
        match self {
            Self::Bounded => zeros(ends, &levels(functional)),
            Self::Rate => zeros(ends, &rate::by_slopes(ends, functional)),
            _ => Vec::new(),
        }
    }
}

fn levels(functional: &[Cell]) -> Vec<f64> {
    functional.iter().map(|[level, _]| *level).collect()
}

fn length(ends: &[f64], cell: usize) -> f64 {
    ends[cell] - begin(ends, cell)
}

/// Cost of cells and steps to a function with a mean: a step smears a switch over a cell, and so changes the mean.
fn loss_by_mean(multiplier: f64, ends: &[f64], functional: &[Cell]) -> f64 {
    let beyond = levels(functional).into_iter().enumerate();
    let beyond: Vec<f64> = beyond.map(|(cell, level)| level - multiplier * length(ends, cell)).collect();
    let longest = (0..ends.len()).map(|cell| length(ends, cell)).fold(0.0, f64::max);
    at_changes(ends, &beyond) + multiplier.abs() * longest
}

/// The best function between limits with a limited rate, and the cost of joining cells in pairs.
fn between(rate: f64, limits: &impl Limits, ends: &[f64], functional: &[Cell]) -> (Vec<Cell>, f64) {
    // Pairs from the end, where the kernel is largest as a rule.
    let joined = |pair: &[Cell]| pair.iter().fold([0.0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
    let mut pairs: Vec<Cell> = functional.rchunks(2).map(joined).collect();
    let mut of_pairs: Vec<f64> = ends.rchunks(2).map(|pair| pair[pair.len() - 1]).collect();
    pairs.reverse();
    of_pairs.reverse();
    let every_other = rate::EveryOther { limits, alone: ends.len() % 2 };
    let function = rate::between(rate, limits, ends, functional);
    let in_pairs = value(&pairs, &rate::between(rate, &every_other, &of_pairs, &pairs));
    let loss = (value(functional, &function) - in_pairs).max(0.0);
    (function, loss)
}

/// Cost of a switch where a cell begins, and not at the zero of the kernel, given the kernel's
/// integrals over cells: s δ² of a straight one of slope s whose zero is δ away.
fn at_changes(ends: &[f64], integrals: &[f64]) -> f64 {
    let cost = |cell: usize| {
        let [before, after] = [cell - 1, cell].map(|cell| length(ends, cell));
        let (distance, longest) = (0.5 * (before + after), before.max(after));
        let slope = (integrals[cell] / after - integrals[cell - 1] / before) / distance;
        // Where there is a jump, or nothing on one side, the zero may be anywhere.
        let zero = if integrals[cell] * integrals[cell - 1] < 0.0 {
            middle(ends, cell - 1) - integrals[cell - 1] / before / slope
        } else {
            f64::INFINITY
        };
        let away = ((zero - begin(ends, cell)).abs() + TUNING.zero_off * longest).min(0.5 * longest);
        slope.abs() * away * away
    };
    let changes = (1..integrals.len()).filter(|&cell| integrals[cell] * integrals[cell - 1] <= 0.0);
    changes.map(cost).sum()
}

/// Zeros of a kernel that is straight between the cells' middles, given its integrals over cells.
fn zeros(ends: &[f64], integrals: &[f64]) -> Vec<f64> {
    let density = |cell: usize| integrals[cell] / length(ends, cell);
    let changes = (1..integrals.len()).filter(|&cell| integrals[cell] * integrals[cell - 1] < 0.0);
    let zero = |cell: usize| {
        let ([from, to], [a, b]) =
            ([cell - 1, cell].map(|cell| middle(ends, cell)), [density(cell - 1), density(cell)]);
        from + (to - from) * a / (a - b)
    };
    changes.map(zero).collect()
}

/// The functional's value for a function.
pub fn value(functional: &[Cell], function: &[Cell]) -> f64 {
    functional.iter().zip(function).map(|(by, of)| by[0] * of[0] + by[1] * of[1]).sum()
}

/// 1, −1, or 0 of zero.
fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

/// Beginning of a cell, s.
fn begin(ends: &[f64], cell: usize) -> f64 {
    cell.checked_sub(1).map_or(0.0, |before| ends[before])
}

/// The middle of a cell, s.
fn middle(ends: &[f64], cell: usize) -> f64 {
    0.5 * (begin(ends, cell) + ends[cell])
}

/// The cell of a function that goes straight from a value to another.
fn straight(ends: &[f64], cell: usize, from: f64, to: f64) -> Cell {
    let begin = begin(ends, cell);
    let slope = (to - from) / (ends[cell] - begin);
    [from - slope * begin, slope]
}

/// The function that is straight between values at the ends of cells; the first is that at the beginning.
fn along(ends: &[f64], value: impl Fn(usize) -> f64) -> Vec<Cell> {
    (0..ends.len()).map(|cell| straight(ends, cell, value(cell), value(cell + 1))).collect()
}
