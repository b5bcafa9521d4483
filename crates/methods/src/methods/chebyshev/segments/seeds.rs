//! Where a range is searched for: a lattice of the box, and points where it meets the surfaces on which an event is at
//! the row's time.

use super::basis::End;
use super::surrogate::{Point, SegmentSurrogate};
use super::tuning::TUNING;
use crate::numerics::{corners, spread};

/// Points of the box, and which of them are joined by edges.
pub(super) struct Lattice {
    points: Vec<Point>,
    /// Number of the first points, at which edges meet the surfaces that end the part.
    on_ends: usize,
    edges: Vec<(usize, usize)>,
}

impl Lattice {
    /// Lattice with `others` in addition to its own points.
    pub fn new(surrogate: &SegmentSurrogate, others: &[Vec<f64>], k: usize) -> Self {
        let Some(&intervals) = TUNING.intervals.get(k.saturating_sub(1)) else {
            let xi = [&corners(k, TUNING.corners_of_lattice)[..], &spread(k, TUNING.spread_a_parameter * k), others]
                .concat();
            let edges = (1..xi.len()).flat_map(|end| [(end - 1, end), (end / 2, end)]).collect();
            return Self { points: surrogate.points(xi), on_ends: 0, edges }.within(surrogate, others);
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
        Self { points: surrogate.points(xi.collect()), on_ends: 0, edges: edges.collect() }.within(surrogate, others)
    }

    /// The lattice inside of the surfaces that end the part, where there are any: outside of them its polynomials say
    /// nothing of where an event is. A part may be thinner than the lattice's edges are long. Its samples are of it,
    /// wherever these surfaces are.
    fn within(mut self, surrogate: &SegmentSurrogate, samples: &[Vec<f64>]) -> Self {
        let samples = surrogate.points(samples.to_vec());
        if surrogate.ends.is_empty() {
            self.points.extend(samples);
            return self;
        }
        let mut xi: Vec<Vec<f64>> = Vec::new();
        let mut edges = Vec::new();
        for &(a, b) in &self.edges {
            let [from, to] = [a, b].map(|index| &self.points[index].xi);
            let at = |share: f64| -> Vec<f64> { from.iter().zip(to).map(|(a, b)| a + share * (b - a)).collect() };
            for [first, last] in inside_shares(&surrogate.ends, at) {
                edges.push((xi.len(), xi.len() + 1));
                xi.extend([at(first), at(last)]);
            }
        }
        let on_ends = xi.len();
        let mut points: Vec<Point> = surrogate.points(xi);
        points.extend(self.points.into_iter().filter(Point::is_inside).chain(samples));
        Self { points, on_ends, edges }
    }

    /// All points.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Points at which a search begins.
    pub fn looked_at(&self) -> impl Iterator<Item = &Point> {
        let (on_ends, others) = self.points.split_at(self.on_ends);
        // Either end of an edge in turn.
        let every = on_ends.len().div_ceil(TUNING.most_on_surface) | 1;
        on_ends.iter().step_by(every).chain(others)
    }

    /// Points at which the box is at a share of a segment at a time, where edges meet that surface.
    pub fn on_surface(&self, surrogate: &SegmentSurrogate, segment: usize, share: f64, time: f64) -> Vec<Point> {
        let distance = |point: &Point| {
            let [begin, end] = [point.times[segment], point.times[segment + 1]];
            begin + share * (end - begin) - time
        };
        let distances: Vec<f64> = self.points.iter().map(distance).collect();
        let crossed: Vec<(usize, usize)> =
            self.edges.iter().copied().filter(|&(a, b)| distances[a] * distances[b] < 0.0).collect();
        let every = crossed.len().div_ceil(TUNING.most_on_surface).max(1);
        let edges: Vec<(usize, usize)> = crossed.into_iter().step_by(every).collect();
        // The last two shares along each edge, with the distances there: the secant method.
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

/// Intervals of the shares of a line inside of all surfaces that end a part; `at` gives the point at a share.
fn inside_shares(all: &[End], at: impl Fn(f64) -> Vec<f64>) -> Vec<[f64; 2]> {
    // A little inside.
    let margins = |share: f64| -> Vec<f64> {
        let xi = at(share);
        all.iter().map(|end| end.margin(&xi) - TUNING.on_end * end.error()).collect()
    };
    let is_inside = |margins: &[f64]| margins.iter().all(|margin| *margin >= 0.0);
    let count = TUNING.points_of_edge;
    let shares: Vec<f64> = (0..=count).map(|index| index as f64 / count as f64).collect();
    let of_shares: Vec<Vec<f64>> = shares.iter().map(|&share| margins(share)).collect();
    let mut found: Vec<[f64; 2]> = Vec::new();
    for (ends, of_ends) in shares.windows(2).zip(of_shares.windows(2)) {
        let crosses = |end: &usize| (of_ends[0][*end] >= 0.0) != (of_ends[1][*end] >= 0.0);
        // Each crossing is the last share on its inside.
        let crossing = |end: usize| {
            let (mut inside, mut outside) = (ends[0], ends[1]);
            if of_ends[0][end] < 0.0 {
                (inside, outside) = (outside, inside);
            }
            for _ in 0..TUNING.halvings_of_line {
                let middle = 0.5 * (inside + outside);
                if margins(middle)[end] >= 0.0 { inside = middle } else { outside = middle }
            }
            inside
        };
        let mut cuts: Vec<f64> = (0..all.len()).filter(crosses).map(crossing).collect();
        cuts.extend([ends[0], ends[1]]);
        cuts.sort_by(f64::total_cmp);
        for cut in cuts.windows(2) {
            if !is_inside(&margins(0.5 * (cut[0] + cut[1]))) || cut[0] == cut[1] {
                continue;
            }
            // Parts that meet are one.
            match found.last_mut() {
                Some(last) if last[1] == cut[0] => last[1] = cut[1],
                _ => found.push([cut[0], cut[1]]),
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The line from (−1, −1) to (1, 1) is within 0.3 < x < 0.31 between the shares 0.65 and 0.655 only, and with
    /// y < 0.305, too, up to 0.6525.
    #[test]
    fn parts_thinner_than_an_edge_are_found() {
        let at = |share: f64| vec![2.0 * share - 1.0; 2];
        let mut ends = vec![End::across(0, 0.3, 1.0, 2), End::across(0, 0.31, -1.0, 2)];
        let of = |ends: &[End]| inside_shares(ends, at);
        let [[first, last]] = of(&ends)[..] else { panic!("{:?}", of(&ends)) };
        assert!((first - 0.65).abs() < 1e-9 && (last - 0.655).abs() < 1e-9, "{first} {last}");
        ends.push(End::across(1, 0.305, -1.0, 2));
        let [[_, last]] = of(&ends)[..] else { panic!("{:?}", of(&ends)) };
        assert!((last - 0.6525).abs() < 1e-9, "{last}");
        assert_eq!(of(&ends[..1]).len(), 1);
    }
}
