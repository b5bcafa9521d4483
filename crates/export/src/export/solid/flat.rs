//! Lines of edges and arcs as points, and flat polygons as triangles.

use nalgebra::Vector3;
use symdiff::math;

use crate::elements::Bend;
use crate::export::tuning::TUNING;

/// The points of a line with arcs as short straight pieces; in a closed line, the last point precedes the first.
pub(in crate::export) fn polyline(bends: &[Bend<f64>], is_closed: bool) -> Vec<[f64; 3]> {
    let mut points = Vec::new();
    for (index, bend) in bends.iter().enumerate() {
        let before = if index > 0 { bends.get(index - 1) } else { bends.last().filter(|_| is_closed) };
        if let Some((radius, before)) = bend.radius.zip(before) {
            points.extend(arc(before.to, bend.to, radius));
        }
        points.push(bend.to);
    }
    points
}

/// Points between the ends of an arc of less than half a turn.
fn arc(from: [f64; 3], to: [f64; 3], radius: f64) -> Vec<[f64; 3]> {
    let (x, y) = (to[0] - from[0], to[1] - from[1]);
    let chord = math::hypot(x, y);
    let height = (radius * radius - 0.25 * chord * chord).max(0.0).sqrt() * radius.signum();
    // The centre is on the left of the chord if the arc turns left.
    let centre = [0.5 * (from[0] + to[0]) - height * y / chord, 0.5 * (from[1] + to[1]) + height * x / chord];
    let turn = 2.0 * math::atan2(0.5 * chord, height.abs()) * radius.signum();
    let pieces = ((turn.abs() / std::f64::consts::TAU * TUNING.pieces_of_turn as f64 - 1e-9).ceil() as usize).max(1);
    let offset = [from[0] - centre[0], from[1] - centre[1]];
    let at = |piece: usize| {
        let angle = turn * piece as f64 / pieces as f64;
        let (sin, cos) = (math::sin(angle), math::cos(angle));
        [centre[0] + cos * offset[0] - sin * offset[1], centre[1] + sin * offset[0] + cos * offset[1], from[2]]
    };
    (1..pieces).map(at).collect()
}

/// The triangles of a flat polygon, by cutting off its ears (Meisters, Amer. Math. Monthly 82 (1975) 648).
pub(in crate::export) fn triangulated(corners: &[[f64; 3]]) -> Vec<[[f64; 3]; 3]> {
    let normal = normal(corners);
    let mut left: Vec<Vector3<f64>> = corners.iter().copied().map(Vector3::from).collect();
    let mut found = Vec::with_capacity(corners.len().saturating_sub(2));
    while left.len() > 2 {
        let count = left.len();
        let ear = |index: usize| [left[(index + count - 1) % count], left[index], left[(index + 1) % count]];
        let side = |a: Vector3<f64>, b: Vector3<f64>, c: Vector3<f64>| (b - a).cross(&(c - b)).dot(&normal);
        let is_ear = |&index: &usize| {
            let [a, b, c] = ear(index);
            let within = |p: &Vector3<f64>| {
                ![a, b, c].contains(p) && side(a, b, *p) >= 0.0 && side(b, c, *p) >= 0.0 && side(c, a, *p) >= 0.0
            };
            side(a, b, c) > 0.0 && !left.iter().any(within)
        };
        // A line that crosses itself has no ear; any corner will do then.
        let index = (0..count).find(is_ear).unwrap_or(0);
        found.push(ear(index).map(Into::into));
        left.remove(index);
    }
    found
}

/// The normal of a flat polygon, on the side from which its corners turn left (Newell); its length is twice the area.
pub(in crate::export) fn normal(corners: &[[f64; 3]]) -> Vector3<f64> {
    let next = corners.iter().cycle().skip(1);
    let pairs = corners.iter().zip(next).map(|(a, b)| Vector3::from(*a).cross(&Vector3::from(*b)));
    pairs.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arcs_have_their_radius_and_angle() {
        let bend = |to: [f64; 3], radius: Option<f64>| Bend { to, radius };
        let line = [bend([1.0, 0.0, 0.0], None), bend([0.0, 1.0, 0.0], Some(1.0))];
        let points = polyline(&line, false);
        assert_eq!(points.len(), 2 + TUNING.pieces_of_turn / 4 - 1);
        assert!(points.iter().all(|[x, y, _]| (math::hypot(*x, *y) - 1.0).abs() < 1e-12), "{points:?}");
        let right = [bend([1.0, 0.0, 0.0], None), bend([0.0, 1.0, 0.0], Some(-1.0))];
        assert!(polyline(&right, false).iter().all(|[x, y, _]| (math::hypot(x - 1.0, y - 1.0) - 1.0).abs() < 1e-12));
    }

    #[test]
    fn triangles_of_a_polygon_have_its_area() {
        // An L of area 3, and the same the other way round.
        let mut corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        for _ in 0..2 {
            let points: Vec<[f64; 3]> = corners.iter().map(|[x, y]| [*x, *y, 0.5]).collect();
            let found = triangulated(&points);
            assert_eq!(found.len(), 4);
            let areas: Vec<f64> = found.iter().map(|triangle| 0.5 * normal(triangle).norm()).collect();
            assert!((areas.iter().sum::<f64>() - 3.0).abs() < 1e-12, "{areas:?}");
            corners.reverse();
        }
    }
}
