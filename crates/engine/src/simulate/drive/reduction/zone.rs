//! Straightness of a path: the width of the narrowest strip that holds it (minimum zone, ISO 1101).

use super::tuning::TUNING;

/// A path, represented by its convex hull.
#[derive(Clone, Debug, Default)]
pub(super) struct Zone {
    points: Vec<[f64; 2]>,
    /// Points of the last hull.
    hull: usize,
}

impl Zone {
    /// Goes on to a point.
    pub fn add(&mut self, point: [f64; 2]) {
        self.points.push(point);
        // A round path has a large hull: as many points come as it has, so that a point costs the same however many
        // there are.
        if self.points.len() > TUNING.fewest_hull_points.max(2 * self.hull) {
            self.points = hull(&mut self.points);
            self.hull = self.points.len();
        }
    }

    /// The least distance of two parallel lines that hold the path between them; NaN of none.
    pub fn width(&self) -> f64 {
        let mut points = self.points.clone();
        let hull = hull(&mut points);
        if hull.len() < 3 {
            return if hull.is_empty() { f64::NAN } else { 0.0 };
        }
        let narrowest = narrowest(&hull);
        // A line straight to rounding is straight.
        let size = hull.iter().flatten().fold(0.0, |size: f64, number| size.max(number.abs()));
        if narrowest <= TUNING.rounding_of_zone * size { 0.0 } else { narrowest }
    }
}

/// The width of the narrowest strip that holds a convex polygon. One of its lines is along an edge; the point farthest
/// from the edge goes around with it (M. I. Shamos, Computational Geometry, Yale 1978: rotating calipers).
fn narrowest(hull: &[[f64; 2]]) -> f64 {
    let count = hull.len();
    let distance = |edge: usize, index: usize| {
        let (a, b, point) = (hull[edge], hull[(edge + 1) % count], hull[index % count]);
        let [x, y] = [b[0] - a[0], b[1] - a[1]];
        (x * (point[1] - a[1]) - y * (point[0] - a[0])).abs() / (x * x + y * y).sqrt()
    };
    let mut far = 1;
    let mut widths = Vec::with_capacity(count);
    for edge in 0..count {
        far = far.max(edge + 1);
        // Once around at most.
        while far < edge + count && distance(edge, far + 1) >= distance(edge, far) {
            far += 1;
        }
        widths.push(distance(edge, far));
    }
    // Rounding may have stopped the farthest point early: then a width is too small. The least one is computed again,
    // until it is right.
    loop {
        let edge = (0..count).fold(0, |best, edge| if widths[edge] < widths[best] { edge } else { best });
        let width = (0..count).map(|index| distance(edge, index)).fold(0.0, f64::max);
        // NaN ends, too.
        if width.partial_cmp(&widths[edge]) != Some(std::cmp::Ordering::Greater) {
            return width;
        }
        widths[edge] = width;
    }
}

/// Andrew's monotone chain.
fn hull(points: &mut [[f64; 2]]) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut hull: Vec<[f64; 2]> = Vec::with_capacity(points.len());
    let half = |hull: &mut Vec<[f64; 2]>, points: &mut dyn Iterator<Item = [f64; 2]>| {
        let begin = hull.len();
        for point in points {
            while let [.., a, b] = &hull[begin..] {
                let turn = (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]);
                if turn > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(point);
        }
        hull.pop();
    };
    half(&mut hull, &mut points.iter().copied());
    half(&mut hull, &mut points.iter().rev().copied());
    hull.dedup();
    hull
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_box_is_as_wide_as_its_short_side() {
        let mut zone = Zone::default();
        for index in 0..1000 {
            let (along, across) = (0.01 * f64::from(index), 0.2 * f64::from(index % 7) / 6.0);
            zone.add([0.8 * along - 0.6 * across, 0.6 * along + 0.8 * across]);
        }
        assert!((zone.width() - 0.2).abs() < 1e-9, "{}", zone.width());
        let mut line = Zone::default();
        (0..200).for_each(|index| line.add([f64::from(index), 2.0 * f64::from(index)]));
        assert!(line.width().abs() < 1e-12 && Zone::default().width().is_nan());
    }

    /// Every point of a parabola is on its hull.
    #[test]
    fn curved_path_takes_fewer_hulls_than_points() {
        let mut zone = Zone::default();
        let begun = std::time::Instant::now();
        for index in -100_000..=100_000 {
            let x = 1e-5 * f64::from(index);
            zone.add([x, 0.3 * x * x]);
        }
        assert!((zone.width() - 0.3).abs() < 1e-12, "{}", zone.width());
        // Some 20 hulls; a hull a point would take hours.
        assert!(begun.elapsed().as_secs() < 60);
    }
}
