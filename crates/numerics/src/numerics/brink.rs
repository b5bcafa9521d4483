//! Ends of ranges next to jumps. Where a function jumps, its range ends at the brink, and a search that fits peaks
//! stops short of it.

use super::extent::Extent;
use super::extremes::ValuesAt;
use super::tuning::TUNING;

/// Moves ends that stand short of a jump to its brink: along each axis, the first drop next to the end is halved until
/// nothing lies between its two sides. `evaluate` gives all functions at some ξ, function by function.
///
/// Over several parameters the brink may rise along itself; an end that was moved may be off by as much again.
pub fn to_brinks(extents: &mut [Extent], evaluate: &ValuesAt) {
    let mut drops = drops(extents, evaluate);
    for _ in 0..TUNING.halvings_of_brink {
        drops.retain(|drop| !drop.is_halved());
        if drops.is_empty() {
            break;
        }
        let middles: Vec<Vec<f64>> = drops.iter().map(|drop| drop.point(drop.middle())).collect();
        let values = evaluate(&middles);
        for (index, drop) in drops.iter_mut().enumerate() {
            drop.halve(values[drop.function * middles.len() + index]);
            let value = &values[drop.function * middles.len() + index..][..1];
            include(&mut extents[drop.function], &middles[index..=index], value);
        }
    }
}

/// Takes in values next to a brink. Over one parameter the range ends there, and the gap stays.
fn include(extent: &mut Extent, points: &[Vec<f64>], values: &[f64]) {
    let gap = extent.gap;
    extent.include(points, values);
    if extent.places[0].len() == 1 {
        extent.gap = gap;
    }
}

/// Two points on a line along an axis through an end, between which a function drops.
struct Drop {
    function: usize,
    sign: f64,
    end: Vec<f64>,
    axis: usize,
    /// Coordinate and value on the high side, and on the low side.
    high: (f64, f64),
    low: (f64, f64),
}

impl Drop {
    fn point(&self, xi: f64) -> Vec<f64> {
        let mut point = self.end.clone();
        point[self.axis] = xi;
        point
    }

    fn middle(&self) -> f64 {
        0.5 * (self.high.0 + self.low.0)
    }

    /// Whether no number lies between its sides.
    fn is_halved(&self) -> bool {
        let middle = self.middle();
        middle == self.high.0 || middle == self.low.0
    }

    /// Takes in the value at the middle: it belongs to the side whose value it is nearer to.
    fn halve(&mut self, value: f64) {
        let middle = (self.middle(), value);
        let is_low = (value - self.low.1).abs() < (value - self.high.1).abs();
        *(if is_low { &mut self.low } else { &mut self.high }) = middle;
    }
}

/// Finds the first drop next to each end, along each axis, either way.
fn drops(extents: &mut [Extent], evaluate: &ValuesAt) -> Vec<Drop> {
    let mut drops = Vec::new();
    let mut points = Vec::new();
    // Number of the points along each line.
    let mut lines = Vec::new();
    for (function, extent) in extents.iter().enumerate().filter(|(_, extent)| extent.range.width() > 0.0) {
        let ends = [(-1.0, extent.range.lower), (1.0, extent.range.upper)];
        for (end, (sign, value)) in extent.places.iter().zip(ends) {
            for axis in 0..end.len() {
                for way in [-1.0, 1.0] {
                    let from = end[axis];
                    let distances = (0..TUNING.distances).rev().map(|power| 2.0 * 0.25_f64.powi(power));
                    let mut along: Vec<f64> = distances.map(|by| (from + way * by).clamp(-1.0, 1.0)).collect();
                    along.dedup();
                    along.retain(|&xi| xi != from);
                    let side = (from, value);
                    let drop = Drop { function, sign, end: end.clone(), axis, high: side, low: side };
                    points.extend(along.iter().map(|&xi| drop.point(xi)));
                    lines.push(along);
                    drops.push(drop);
                }
            }
        }
    }
    let values = evaluate(&points);
    let mut first = 0;
    let mut lines = lines.into_iter();
    drops.retain_mut(|drop| {
        let along = lines.next().unwrap_or_default();
        let values = &values[drop.function * points.len() + first..][..along.len()];
        let least = TUNING.drop * extents[drop.function].range.width();
        include(&mut extents[drop.function], &points[first..][..along.len()], values);
        first += along.len();
        for (&xi, &value) in along.iter().zip(values) {
            if drop.sign * (drop.high.1 - value) > least {
                drop.low = (xi, value);
                return true;
            }
            drop.high = (xi, value);
        }
        false
    });
    drops
}

#[cfg(test)]
mod tests {
    use super::super::extremes::extremes;
    use super::*;
    use crate::numerics::Lattices;

    /// A sawtooth over two parameters ends at its teeth, where the search alone stops a millionth short.
    #[test]
    fn a_sawtooth_ends_at_its_teeth() {
        let saw = |xi: &[f64]| (3.0 + 1.3 * xi[0] + 0.4 * xi[1]).rem_euclid(1.0);
        let evaluate = |points: &[Vec<f64>]| points.iter().map(|xi| saw(xi)).collect::<Vec<f64>>();
        let mut found = extremes(&Lattices::default(), &[8, 8], &[0.0], &evaluate);
        to_brinks(&mut found, &evaluate);
        assert!(found[0].range.lower < 1e-15 && found[0].range.upper > 1.0 - 1e-15, "{found:?}");
    }

    /// A smooth function is left as it was, and so is one that is constant.
    #[test]
    fn smooth_function_is_left_unchanged() {
        let evaluate = |points: &[Vec<f64>]| -> Vec<f64> {
            points.iter().map(|xi| (2.0 * xi[0]).sin()).chain(points.iter().map(|_| 3.0)).collect()
        };
        let found = extremes(&Lattices::default(), &[16], &[0.0; 2], &evaluate);
        let mut moved = found.clone();
        to_brinks(&mut moved, &evaluate);
        assert!((moved[0].range.upper - 1.0).abs() < 1e-12 && (moved[0].range.lower + 1.0).abs() < 1e-12);
        assert_eq!(moved[1], found[1]);
    }
}
