//! Enclosures of functions of the time over boxes of times and parameters.

use symdiff::{Interval, Ranges};

use super::tuning::TUNING;

/// Memory for enclosures, and their number.
#[derive(Clone, Debug, Default)]
pub(in crate::simulate) struct Work {
    intervals: Vec<Interval>,
    enclosures: usize,
}

impl Work {
    /// Functions that were enclosed over a box.
    pub(in crate::simulate) fn enclosures(&self) -> usize {
        self.enclosures
    }
}

/// Value and rate of a function over a box of the symbols. The rate is enclosed in two ways: with minima and maxima as
/// they are, and as choices.
pub(super) fn pair(ranges: &Ranges, symbols: &[Interval], work: &mut Work) -> (Interval, Interval) {
    work.enclosures += 1;
    let mut found = ranges.enclose(symbols, &mut work.intervals);
    let mut next = || found.next().unwrap_or(Interval::ENTIRE);
    let (value, rate, of_choices) = (next(), next(), next());
    let (lower, upper) = (rate.lower().max(of_choices.lower()), rate.upper().min(of_choices.upper()));
    // At a kink itself the two have different rates.
    (value, if lower <= upper { Interval::new(lower, upper) } else { rate })
}

/// Half the width of the range of a function over the duration, to a factor of two; `None` if it is constant, or has no
/// bound.
pub(super) fn size(ranges: &Ranges, parameters: &[Interval], nominal: &[f64], duration: f64) -> Option<f64> {
    let mut work = Work::default();
    let mut over = |a: f64, b: f64| {
        let symbols: Vec<Interval> = std::iter::once(Interval::new(a, b)).chain(parameters.iter().copied()).collect();
        pair(ranges, &symbols, &mut work).0
    };
    let mut at_work = Work::default();
    let mut at = |t: f64| {
        let point: Vec<Interval> = std::iter::once(t).chain(nominal.iter().copied()).map(Interval::point).collect();
        pair(ranges, &point, &mut at_work).0.middle()
    };
    let (mut least, mut most) = (at(0.0).min(at(duration)), at(0.0).max(at(duration)));
    let mut pieces = vec![(0.0, duration, over(0.0, duration))];
    let mut width = f64::INFINITY;
    while pieces.len() < TUNING.pieces_for_size {
        let extreme = |sign: f64| {
            let end = |piece: &(f64, f64, Interval)| if sign > 0.0 { piece.2.upper() } else { -piece.2.lower() };
            let index = (0..pieces.len()).max_by(|&i, &j| end(&pieces[i]).total_cmp(&end(&pieces[j])));
            index.map(|index| (index, end(&pieces[index])))
        };
        let (Some((lowest, lower)), Some((highest, upper))) = (extreme(-1.0), extreme(1.0)) else { break };
        width = upper + lower;
        if width <= 2.0 * (most - least) {
            break;
        }
        // The piece that may go furthest beyond the values known to be reached.
        let index = if upper - most > least + lower { highest } else { lowest };
        let (a, b, _) = pieces.swap_remove(index);
        let middle = 0.5 * (a + b);
        (least, most) = (least.min(at(middle)), most.max(at(middle)));
        pieces.extend([(a, middle, over(a, middle)), (middle, b, over(middle, b))]);
    }
    let negligible = |width: f64| width <= 1e-12 * least.abs().max(most.abs());
    match most - least {
        seen if !seen.is_finite() => None,
        seen if !negligible(seen) => Some(0.5 * seen),
        // The values show no change, but the enclosure allows one.
        _ if width.is_finite() && !negligible(width) => Some(0.5 * width),
        _ => None,
    }
}
