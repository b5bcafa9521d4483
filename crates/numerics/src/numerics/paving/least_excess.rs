//! The least by which some quantity misses its interval, over the whole box.

use std::collections::BinaryHeap;

use super::Tubes;
use super::parts::{PavingBox, Shape};
use crate::numerics::range::Range;
use crate::numerics::ranked::Ranked;

/// The least largest excess.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeastExcess {
    /// No parameters have less, in units of the quantities' scales; negative where all lie within their intervals.
    pub lower: f64,
    /// Attained at `at`.
    pub upper: f64,
    /// ξ (k).
    pub at: Vec<f64>,
}

/// A box by the least excess that is possible on it, with its sign changed: the heap has the least on top.
type Candidate = Ranked<PavingBox>;

/// Minimises, over the box, the largest excess of a quantity beyond its outer interval, in units of its scale: by
/// branch and bound to a tolerance, or over at most `boxes` boxes.
pub fn least_excess(
    tubes: &Tubes,
    tolerance: f64,
    boxes: usize,
    interrupted: &(dyn Fn() -> bool + Sync),
) -> LeastExcess {
    let shape = Shape::new(&tubes.orders);
    let mut best = LeastExcess { lower: f64::NEG_INFINITY, upper: f64::INFINITY, at: vec![0.0; shape.dimension()] };
    let mut heap = BinaryHeap::new();
    let whole = PavingBox::whole(&shape, tubes);
    heap.extend(examined(whole, &shape, tubes, &mut best));
    for _ in 0..boxes {
        let Some(Candidate { rank, item: part }) = heap.pop() else { break };
        let bound = -rank;
        best.lower = bound;
        if best.upper - bound <= tolerance || interrupted() {
            return best;
        }
        for half in part.halves(&shape, tubes) {
            heap.extend(examined(half, &shape, tubes, &mut best));
        }
    }
    best.lower = heap.peek().map_or(best.upper, |least| (-least.rank).min(best.upper));
    best
}

/// A box that may have less than the best so far, with the quantities that decide on it.
fn examined(part: PavingBox, shape: &Shape, tubes: &Tubes, best: &mut LeastExcess) -> Option<Candidate> {
    let least = |row: usize, range: Range| {
        let [lower, upper] = tubes.outer[row];
        (lower - range.upper).max(range.lower - upper) / tubes.scales[row]
    };
    let most = |row: usize, range: Range| {
        let [lower, upper] = tubes.outer[row];
        (lower - range.lower).max(range.upper - upper) / tubes.scales[row]
    };
    let bound = part.ranges(shape).map(|(row, range)| least(row, range)).fold(f64::NEG_INFINITY, f64::max);
    let attained = part.ranges(shape).map(|(row, range)| most(row, range)).fold(f64::NEG_INFINITY, f64::max);
    if attained < best.upper {
        // All of the box has at most this.
        (best.upper, best.at) = (attained, part.middle());
    }
    // A quantity that has less everywhere than another has at least is never the largest.
    let part = part.only(shape, |row, range| most(row, range) >= bound);
    (bound < best.upper).then_some(Candidate { rank: -bound, item: part })
}
