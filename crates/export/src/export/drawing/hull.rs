//! Convex hulls on the paper.

use super::view::Px;
use crate::export::tuning::TUNING;

/// The corners of the convex hull, in order (Andrew's monotone chain, Inf. Process. Lett. 9 (1979) 216); both ends of
/// collinear points.
pub(super) fn hull(mut places: Vec<Px>) -> Vec<Px> {
    places.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    places.dedup_by(|a, b| (*a - *b).norm() < TUNING.same_point);
    if places.len() < 3 {
        return places;
    }
    let half = |places: &mut dyn Iterator<Item = Px>| {
        let mut chain: Vec<Px> = Vec::new();
        for place in places {
            while let [.., a, b] = chain[..]
                && (b - a).perp(&(place - a)) <= TUNING.same_point * (place - a).norm()
            {
                chain.pop();
            }
            chain.push(place);
        }
        chain.pop();
        chain
    };
    let mut corners = half(&mut places.iter().copied());
    corners.extend(half(&mut places.iter().rev().copied()));
    corners
}

/// The corners in x and y of the convex hull of points, in order.
pub(in crate::export) fn flat_hull(points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    // Scaled to 1e4 px, since `hull` distinguishes points by px.
    let size = points.iter().flatten().fold(0.0_f64, |size, part| size.max(part.abs()));
    let scale = 1e4 / size.max(f64::MIN_POSITIVE);
    let corners = hull(points.iter().map(|[x, y, _]| scale * Px::new(*x, *y)).collect());
    corners.into_iter().map(|corner| [corner.x / scale, corner.y / scale, 0.0]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hull_has_the_outermost_points() {
        let square = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [5.0, 5.0], [0.0, 0.2]].map(Px::from);
        assert_eq!(hull(square.to_vec()).len(), 4);
        let straight = [[0.0, 0.0], [5.0, 5.0], [10.0, 10.0]].map(Px::from);
        assert_eq!(hull(straight.to_vec()), [Px::new(0.0, 0.0), Px::new(10.0, 10.0)]);
        assert_eq!(hull(vec![Px::new(1.0, 2.0); 5]), [Px::new(1.0, 2.0)]);
    }
}
