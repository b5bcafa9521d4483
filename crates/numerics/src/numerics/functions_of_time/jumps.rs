//! Bounded functions, which may jump, and those that are constant over periods.

use super::tuning::TUNING;
use super::{Cell, sign};

/// Levels with the signs of numbers; zero keeps the level before it.
pub fn with_signs(numbers: impl Iterator<Item = f64>) -> Vec<Cell> {
    let mut level = 0.0;
    let of_number = |number: f64| {
        level = if number == 0.0 { level } else { number.signum() };
        [level, 0.0]
    };
    numbers.map(of_number).collect()
}

/// The best function that is constant over each period.
pub fn held(period: f64, ends: &[f64], functional: &[Cell]) -> Vec<Cell> {
    let number = |end: f64| (end / period - TUNING.same_cell).floor();
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
