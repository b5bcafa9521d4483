//! The point of a line that is nearest to a convex hull.
//!
//! ```text
//! line p = b + t v, t within 0 … M; ends p₀, p₁                             distance                 t
//! face over which an end is       n · p − d, of the lower end               n · p − d                0 or M
//! edge and line that cross        e = u × v                                 |e · (b − a)|/|e|        where they cross
//! edge beside an end              w = (p − a) − ((p − a) · u) u             |w|                      0 or M
//! corner beside the line          w = (b − c) − ((b − c) · v) v             |w|                      −(b − c) · v
//! corner beside an end            w = p − c                                 |w|                      0 or M
//! ```
//!
//! Each is taken where the hull does not reach beyond the feature along w, n or e, and the line does not come nearer.
//! The plane across that direction lies between both then, so that no such value is more than the distance, and the
//! largest is the distance (Ericson, *Real-Time Collision Detection* (2005), ch. 5 and 9).
//!
//! Where the line is parallel to a face or an edge several are the largest. Those within s = 10⁻⁴ M of it have a share
//! that falls with their distance to it: t is their mean, the middle of the part next to the hull, and moves to the
//! lower end within an angle of 10⁻⁴. Where the line passes through the hull, t is the middle of the part within.

use symdiff::Scalar;

use super::hull::{Hull, constant};
use super::solid::Segment;
use crate::elements::tuning::TUNING;
use crate::multibody::Vector;

/// Candidate for the nearest feature: its distance, not positive where the feature is not nearest, and t.
type Candidate<'g> = (Scalar<'g>, Scalar<'g>);

/// A line in the hull's frame.
struct Line<'g> {
    /// v
    along: Vector<'g>,
    /// M
    length: Scalar<'g>,
    /// Each end with its t and the way along the line from it.
    ends: [(Vector<'g>, Scalar<'g>, Vector<'g>); 2],
    /// Amount by which conditions may fall short.
    slack: f64,
}

/// t: how far along the line from `start` along the unit vector `along`.
pub fn nearest_to_hull<'g>(hull: &Hull, (start, along, length): Segment<'g>) -> Scalar<'g> {
    let zero = length.builder().number(0.0);
    let ends = [(start, zero, along), (start + length * along, length, -along)];
    let line = Line { along, length, ends, slack: TUNING.meeting_features * hull.radius() };
    let mut candidates = Vec::new();
    line.over_faces(hull, &mut candidates);
    line.beside_edges(hull, &mut candidates);
    line.beside_corners(hull, &mut candidates);
    let best = candidates.iter().fold(zero, |best, (distance, _)| best.max(*distance));
    let share = TUNING.smooth_lines_of_hull * length;
    let (mut sum, mut moment) = (zero, zero);
    for (distance, place) in candidates {
        let weight = distance.select((share - (best - distance)).max(zero), zero);
        sum += weight;
        moment += weight * place;
    }
    let is_outside = best;
    let mean = moment / is_outside.select(sum, share);
    is_outside.select(mean, line.middle_within(hull)).max(zero).min(length)
}

impl<'g> Line<'g> {
    /// A distance where all of some lengths are positive.
    fn only_where(&self, conditions: impl IntoIterator<Item = Scalar<'g>>, distance: Scalar<'g>) -> Scalar<'g> {
        let zero = distance.builder().number(0.0);
        let least = conditions.into_iter().reduce(Scalar::min).unwrap_or(zero);
        (least + self.slack).select(distance, zero)
    }

    /// |w|, without a root of zero.
    fn size(w: Vector<'g>) -> Scalar<'g> {
        let square = w.dot(w);
        let one = square.builder().number(1.0);
        square.select(square.select(square, one).sqrt(), square)
    }

    fn over_faces(&self, hull: &Hull, into: &mut Vec<Candidate<'g>>) {
        let g = self.length.builder();
        for (number, face) in hull.faces.iter().enumerate() {
            let normal = constant(g, face.normal);
            let heights = self.ends.map(|(end, ..)| normal.dot(end) - face.height);
            let lowest = heights[0].min(heights[1]);
            let sides = || hull.edges.iter().filter_map(|edge| Some((edge, edge.inward_of(number)?)));
            for ((end, index, _), height) in self.ends.into_iter().zip(heights) {
                let inside =
                    sides().map(|(edge, inward)| constant(g, inward).dot(end - constant(g, hull.points[edge.ends[0]])));
                into.push((self.only_where(inside, 2.0 * lowest - height), index));
            }
        }
    }

    fn beside_edges(&self, hull: &Hull, into: &mut Vec<Candidate<'g>>) {
        let g = self.length.builder();
        let (start, ..) = self.ends[0];
        for edge in &hull.edges {
            let [a, b] = edge.ends.map(|end| hull.points[end]);
            let reach = [0, 1, 2].map(|axis| (b[axis] - a[axis]) * edge.along[axis]).iter().sum::<f64>();
            let (from, along) = (constant(g, a), constant(g, edge.along));
            let inward = edge.inward.map(|inward| constant(g, inward));
            let within = |place: Scalar<'g>| [place, reach - place];
            let across = along.cross(self.along);
            let square = across.dot(across);
            let (offset, cosine) = (start - from, along.dot(self.along));
            let height = across.dot(offset);
            let crossed = (square - TUNING.crossing_lines).select(square, g.number(1.0));
            let (on_edge, on_line) = (along.dot(offset), self.along.dot(offset));
            let place = (cosine * on_edge - on_line) / crossed;
            let conditions = within(on_edge + cosine * place)
                .into_iter()
                .chain([place, self.length - place])
                .chain(inward.map(|inward| -height * across.dot(inward)));
            let distance = self.only_where(conditions, height.abs() / crossed.sqrt());
            into.push(((square - TUNING.crossing_lines).select(distance, g.number(0.0)), place));
            for (end, place, ahead) in self.ends {
                let offset = end - from;
                let on_edge = along.dot(offset);
                let way = offset - on_edge * along;
                let conditions =
                    within(on_edge).into_iter().chain(inward.map(|inward| -inward.dot(way))).chain([ahead.dot(way)]);
                into.push((self.only_where(conditions, Self::size(way)), place));
            }
        }
    }

    fn beside_corners(&self, hull: &Hull, into: &mut Vec<Candidate<'g>>) {
        let g = self.length.builder();
        let (start, ..) = self.ends[0];
        for (corner, &point) in hull.points.iter().enumerate() {
            let edges: Vec<Vector<'g>> = hull.edges_from(corner).map(|along| constant(g, along)).collect();
            if edges.is_empty() {
                continue;
            }
            let point = constant(g, point);
            let beside = |way: Vector<'g>| edges.iter().map(move |edge| -edge.dot(way)).collect::<Vec<_>>();
            let offset = start - point;
            let index = -self.along.dot(offset);
            let way = offset + index * self.along;
            let conditions = beside(way).into_iter().chain([index, self.length - index]);
            into.push((self.only_where(conditions, Self::size(way)), index));
            for (end, index, ahead) in self.ends {
                let way = end - point;
                let conditions = beside(way).into_iter().chain([ahead.dot(way)]);
                into.push((self.only_where(conditions, Self::size(way)), index));
            }
        }
    }

    /// Where the line passes through the hull: the middle of the part within.
    fn middle_within(&self, hull: &Hull) -> Scalar<'g> {
        let g = self.length.builder();
        let (mut enters, mut leaves) = (g.number(0.0), self.length);
        for face in &hull.faces {
            let normal = constant(g, face.normal);
            let [first, second] = self.ends.map(|(end, ..)| normal.dot(end) - face.height);
            let passed = |beyond: Scalar<'g>, otherwise: Scalar<'g>| {
                let fall = beyond.select(first - second, g.number(1.0));
                beyond.select(self.length * first / fall, otherwise)
            };
            enters = enters.max(passed(first, enters));
            leaves = leaves.min(passed(second, leaves));
        }
        0.5 * (enters + leaves)
    }
}
