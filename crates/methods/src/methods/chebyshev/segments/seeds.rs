//! Where a range is searched for: a lattice of the box, and points where it meets the surfaces on which an event is at
//! the row's time.

use super::surrogate::{Point, SegmentSurrogate};
use super::tuning::TUNING;
use crate::numerics::{corners, spread};

/// Points of the box, and which of them are joined by edges.
pub(super) struct Lattice {
    pub points: Vec<Point>,
    edges: Vec<(usize, usize)>,
}

impl Lattice {
    /// With `others` beside the lattice's own points.
    pub fn new(surrogate: &SegmentSurrogate, others: &[Vec<f64>], k: usize) -> Self {
        let Some(&intervals) = TUNING.intervals.get(k.saturating_sub(1)) else {
            let xi = [&corners(k, TUNING.corners_of_lattice)[..], &spread(k, TUNING.spread_a_parameter * k), others]
                .concat();
            let edges = (1..xi.len()).flat_map(|end| [(end - 1, end), (end / 2, end)]).collect();
            return Self { points: surrogate.points(xi), edges };
        };
        let count = (intervals + 1).pow(k as u32);
        let stride = |axis: usize| (intervals + 1).pow(axis as u32);
        let place = |index: usize, axis: usize| index / stride(axis) % (intervals + 1);
        let xi = (0..count).map(|index| {
            (0..k).map(|axis| 2.0 * place(index, axis) as f64 / intervals as f64 - 1.0).collect::<Vec<f64>>()
        });
        let edges = (0..count).flat_map(|index| {
            let inner = (0..k).filter(move |&axis| place(index, axis) < intervals);
            inner.map(move |axis| (index, index + stride(axis)))
        });
        Self { points: surrogate.points(xi.chain(others.iter().cloned()).collect()), edges: edges.collect() }
    }

    /// Points at which the box is at a share of a segment at a time, where edges meet that surface.
    pub fn on_surface(&self, surrogate: &SegmentSurrogate, segment: usize, share: f64, time: f64) -> Vec<Point> {
        self.at_zeros(surrogate, |point| {
            let [begin, end] = [point.times[segment], point.times[segment + 1]];
            begin + share * (end - begin) - time
        })
    }

    /// Points where edges meet the zeros of a distance.
    pub fn at_zeros(&self, surrogate: &SegmentSurrogate, distance: impl Fn(&Point) -> f64) -> Vec<Point> {
        let distances: Vec<f64> = self.points.iter().map(&distance).collect();
        let crossed: Vec<(usize, usize)> =
            self.edges.iter().copied().filter(|&(a, b)| distances[a] * distances[b] < 0.0).collect();
        let every = crossed.len().div_ceil(TUNING.most_on_surface).max(1);
        let edges: Vec<(usize, usize)> = crossed.into_iter().step_by(every).collect();
        // The last two places along each edge, with the distances there: the secant method.
        let mut last: Vec<[(f64, f64); 2]> =
            edges.iter().map(|&(a, b)| [(0.0, distances[a]), (1.0, distances[b])]).collect();
        let mut found = Vec::new();
        for _ in 0..TUNING.corrections {
            let next = |&[(before, of_before), (share, of_share)]: &[(f64, f64); 2]| {
                let next = share - of_share * (share - before) / (of_share - of_before);
                if next.is_finite() { next.clamp(0.0, 1.0) } else { share }
            };
            let shares: Vec<f64> = last.iter().map(next).collect();
            let on_edge = |(&(a, b), share): (&(usize, usize), &f64)| {
                let [from, to] = [a, b].map(|index| &self.points[index].xi);
                from.iter().zip(to).map(|(from, to)| from + share * (to - from)).collect()
            };
            found = surrogate.points(edges.iter().zip(&shares).map(on_edge).collect());
            for ((last, share), point) in last.iter_mut().zip(shares).zip(&found) {
                *last = [last[1], (share, distance(point))];
            }
        }
        found
    }
}
