//! Straightness of a path: the width of the narrowest strip that holds it (minimum zone, ISO 1101).

/// Points before they are reduced to their convex hull.
const MOST: usize = 64;

/// A path, of which the convex hull is kept.
#[derive(Clone, Debug, Default)]
pub(super) struct Zone {
    points: Vec<[f64; 2]>,
}

impl Zone {
    /// Goes on to a point.
    pub fn add(&mut self, point: [f64; 2]) {
        self.points.push(point);
        if self.points.len() > MOST {
            let hull = hull(&mut self.points);
            // A round path has a large hull: it may grow as long as it has to.
            if 2 * hull.len() <= MOST || hull.len() < self.points.len() {
                self.points = hull;
            }
        }
    }

    /// The least distance of two parallel lines that hold the path between them; NaN of none.
    pub fn width(&self) -> f64 {
        let mut points = self.points.clone();
        let hull = hull(&mut points);
        if hull.len() < 3 {
            return if hull.is_empty() { f64::NAN } else { 0.0 };
        }
        // The narrowest strip has one of its lines along an edge.
        let along = |edge: usize| {
            let (a, b) = (hull[edge], hull[(edge + 1) % hull.len()]);
            let [x, y] = [b[0] - a[0], b[1] - a[1]];
            let length = (x * x + y * y).sqrt();
            hull.iter().map(|point| (x * (point[1] - a[1]) - y * (point[0] - a[0])).abs() / length).fold(0.0, f64::max)
        };
        (0..hull.len()).map(along).fold(f64::INFINITY, f64::min)
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
        for place in 0..1000 {
            let (along, across) = (0.01 * f64::from(place), 0.2 * f64::from(place % 7) / 6.0);
            zone.add([0.8 * along - 0.6 * across, 0.6 * along + 0.8 * across]);
        }
        assert!((zone.width() - 0.2).abs() < 1e-9, "{}", zone.width());
        let mut line = Zone::default();
        (0..200).for_each(|place| line.add([f64::from(place), 2.0 * f64::from(place)]));
        assert!(line.width().abs() < 1e-12 && Zone::default().width().is_nan());
    }
}
