//! The convex hull of points in space as a surface: the gap to a centre p, and the direction in which it is pushed.
//!
//! ```text
//! faces      n_f · p − d_f
//! edges      |e|,  e = w − (w · u) u,  w = p − a,     where e · m ≤ 0 for both of its faces
//! corners    |w|,  w = p − a,                         where w · u ≤ 0 for all of its edges
//! gap = the largest of these − ρ − r
//! ```
//!
//! u is the unit vector along an edge (away from the corner), m that in a face across the edge, to its inside: where
//! the conditions hold, the direction is one in which the hull does not reach beyond the edge or the corner, so that
//! the value is no more than the distance, and for the nearest of them it is the distance (Ericson, *Real-Time
//! Collision Detection* (2005), ch. 5). Inside, the nearest face pushes.
//!
//! Which faces there are follows from the points, so these are the same for all samples.

use symdiff::{Builder, Formula, Scalar};

use super::course::Points;
use super::solid::Gap;
use crate::elements::tuning::TUNING;
use crate::grammar::{Fields, Reader, SymbolTable};
use crate::multibody::{Pair, Vector};
use crate::syntax::codes::Code;

type Point = [f64; 3];

fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn scaled(a: Point, factor: f64) -> Point {
    a.map(|part| factor * part)
}

fn unit(a: Point) -> Point {
    scaled(a, dot(a, a).sqrt().recip())
}

/// A plane that all points are below.
#[derive(Clone, Debug)]
pub struct Face {
    pub normal: Point,
    pub height: f64,
    /// Points in it.
    corners: Vec<usize>,
}

/// The line between two corners.
#[derive(Clone, Debug)]
pub struct Edge {
    pub ends: [usize; 2],
    /// Unit vector from the first end.
    pub along: Point,
    /// Numbers of both faces.
    faces: [usize; 2],
    /// Unit vector in each of both faces, across the edge to the inside.
    pub inward: [Point; 2],
}

impl Edge {
    /// Direction in a face, across the edge to the inside; `None` if the edge is not one of that face.
    pub fn inward_of(&self, face: usize) -> Option<Point> {
        self.faces.iter().zip(self.inward).find(|(number, _)| **number == face).map(|(_, inward)| inward)
    }
}

/// A convex hull.
#[derive(Clone, Debug)]
pub struct Hull {
    pub points: Vec<Point>,
    pub faces: Vec<Face>,
    pub edges: Vec<Edge>,
}

impl Hull {
    /// Convex hull of points; `None` if they lie in a plane.
    pub fn of(points: Vec<Point>) -> Option<Self> {
        let size = points
            .iter()
            .map(|&point| dot(minus(point, points[0]), minus(point, points[0])))
            .fold(0.0, f64::max)
            .sqrt();
        let mut faces: Vec<Face> = Vec::new();
        for i in 0..points.len() {
            for j in i + 1..points.len() {
                for k in j + 1..points.len() {
                    let normal = cross(minus(points[j], points[i]), minus(points[k], points[i]));
                    if dot(normal, normal).sqrt() <= TUNING.points_of_plane * size * size {
                        continue;
                    }
                    for normal in [unit(normal), scaled(unit(normal), -1.0)] {
                        let height = dot(normal, points[i]);
                        let above = |point: &Point| dot(normal, *point) - height;
                        let is_known = faces.iter().any(|face| dot(face.normal, normal) > 1.0 - TUNING.points_of_plane);
                        if !is_known && points.iter().all(|point| above(point) <= TUNING.points_of_plane * size) {
                            let corners = (0..points.len())
                                .filter(|&index| above(&points[index]) >= -TUNING.points_of_plane * size);
                            faces.push(Face { normal, height, corners: corners.collect() });
                        }
                    }
                }
            }
        }
        let mut edges = Vec::new();
        for (index, first) in faces.iter().enumerate() {
            for (other, second) in faces.iter().enumerate().skip(index + 1) {
                let both: Vec<usize> =
                    first.corners.iter().copied().filter(|corner| second.corners.contains(corner)).collect();
                let Some(ends) = farthest(&points, &both) else { continue };
                let along = unit(minus(points[ends[1]], points[ends[0]]));
                let inward = [first, second].map(|face| {
                    let across = cross(face.normal, along);
                    let side: f64 =
                        face.corners.iter().map(|&corner| dot(across, minus(points[corner], points[ends[0]]))).sum();
                    scaled(across, side.signum())
                });
                edges.push(Edge { ends, along, faces: [index, other], inward });
            }
        }
        (faces.len() >= 4).then_some(Self { points, faces, edges })
    }

    /// The radius of a ball about the origin that holds it.
    pub fn radius(&self) -> f64 {
        self.points.iter().map(|&point| dot(point, point)).fold(0.0, f64::max).sqrt()
    }

    /// The gap to a centre at `offset` from the first point; `reach` is ρ + r.
    pub fn gap<'g>(&self, pair: &Pair<'g>, offset: Vector<'g>, reach: Scalar<'g>) -> Gap<'g> {
        let g = reach.builder();
        let axes = [0, 1, 2].map(|axis| pair.outward(Vector::along(g, axis)));
        let place = Vector::from(axes.map(|axis| axis.dot(offset)));
        let (depth, face) = self.over_faces(g, place);
        let (square, way) = self.beside_edges(g, place);
        let above = depth.max(g.number(0.0));
        let is_beside = square - above * above;
        // Avoids the root of zero, even where its result is not used.
        let distance = is_beside.select(square, g.number(1.0)).sqrt();
        let gap = is_beside.select(distance, depth) - reach;
        let normal = [0, 1, 2].map(|axis| is_beside.select(way[axis] / distance, face[axis]));
        let normal = axes.into_iter().zip(normal).fold(Vector::zero(g), |sum, (axis, part)| sum + part * axis);
        let around = g.number(self.radius()) + reach;
        let near = around * around - place.dot(place);
        Gap { gap, normal, overlap: near.select(-gap, near), near: Some(near) }
    }

    /// The length of an edge, m.
    pub fn length(&self, edge: &Edge) -> f64 {
        let [from, to] = edge.ends.map(|end| self.points[end]);
        dot(minus(to, from), edge.along)
    }

    /// Unit vectors along the edges that end at a corner, away from it.
    pub fn edges_from(&self, corner: usize) -> impl Iterator<Item = Point> {
        self.edges.iter().filter_map(move |edge| match edge.ends {
            [first, _] if first == corner => Some(edge.along),
            [_, second] if second == corner => Some(scaled(edge.along, -1.0)),
            _ => None,
        })
    }

    /// The greatest height over a face, and that face's normal.
    fn over_faces<'g>(&self, g: &'g Builder, place: Vector<'g>) -> (Scalar<'g>, [Scalar<'g>; 3]) {
        let mut best: Option<(Scalar<'g>, [Scalar<'g>; 3])> = None;
        for face in &self.faces {
            let height = constant(g, face.normal).dot(place) - face.height;
            let normal = face.normal.map(|part| g.number(part));
            best = Some(match best {
                None => (height, normal),
                Some((before, its)) => {
                    let better = height - before;
                    (better.select(height, before), [0, 1, 2].map(|axis| better.select(normal[axis], its[axis])))
                }
            });
        }
        best.unwrap_or((g.number(0.0), [g.number(0.0); 3]))
    }

    /// Square of the greatest distance from an edge or corner whose region contains the place, and the vector from
    /// there; zero where no region does.
    fn beside_edges<'g>(&self, g: &'g Builder, place: Vector<'g>) -> (Scalar<'g>, [Scalar<'g>; 3]) {
        let zero = g.number(0.0);
        let mut best = (zero, [zero; 3]);
        let mut take = |way: Vector<'g>, beside: Scalar<'g>| {
            let square = beside.select(way.dot(way), zero);
            let better = square - best.0;
            let way = way.components();
            best = (better.select(square, best.0), [0, 1, 2].map(|axis| better.select(way[axis], best.1[axis])));
        };
        for edge in &self.edges {
            let from = place - constant(g, self.points[edge.ends[0]]);
            let along = constant(g, edge.along);
            let way = from - along.dot(from) * along;
            let [first, second] = edge.inward.map(|inward| -constant(g, inward).dot(from));
            take(way, first.min(second));
        }
        for (corner, &point) in self.points.iter().enumerate() {
            let from = place - constant(g, point);
            let beside = self.edges_from(corner).map(|along| -constant(g, along).dot(from)).reduce(Scalar::min);
            if let Some(beside) = beside {
                take(from, beside);
            }
        }
        best
    }
}

/// The faces of the convex hull of points, each with its corners in order, seen from outside; `None` if they lie in a
/// plane.
pub fn faces_of_hull(points: Vec<[f64; 3]>) -> Option<Vec<Vec<[f64; 3]>>> {
    let hull = Hull::of(points)?;
    let corners = |(index, face): (usize, &Face)| {
        // Edges of the face one after the other, each on from the end of the one before.
        let mut edges: Vec<[usize; 2]> =
            hull.edges.iter().filter(|edge| edge.faces.contains(&index)).map(|edge| edge.ends).collect();
        let mut ring = vec![edges.first()?[0]];
        while let Some(next) = edges.iter().position(|ends| ends.contains(&ring[ring.len() - 1])) {
            let [one, other] = edges.swap_remove(next);
            ring.push(if one == ring[ring.len() - 1] { other } else { one });
        }
        ring.pop();
        let mut ring: Vec<Point> = ring.into_iter().map(|corner| hull.points[corner]).collect();
        if let [a, b, c, ..] = ring[..]
            && dot(cross(minus(b, a), minus(c, b)), face.normal) < 0.0
        {
            ring.reverse();
        }
        Some(ring)
    };
    Some(hull.faces.iter().enumerate().filter_map(corners).collect())
}

pub fn constant(g: &Builder, point: Point) -> Vector<'_> {
    point.map(|part| g.number(part)).into()
}

/// The two of some points that are farthest apart, if there are two.
fn farthest(points: &[Point], some: &[usize]) -> Option<[usize; 2]> {
    let mut best: Option<([usize; 2], f64)> = None;
    for (index, &first) in some.iter().enumerate() {
        for &second in &some[index + 1..] {
            let way = minus(points[second], points[first]);
            if best.is_none_or(|(_, square)| dot(way, way) > square) {
                best = Some(([first, second], dot(way, way)));
            }
        }
    }
    best.map(|(ends, _)| ends)
}

/// Reports points that make no hull, and those that are not the same for all samples.
pub fn check<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, key: &str, points: &Points) {
    let at = fields.key_span(key);
    if !reader.model.is_spatial() {
        let help = if key == "hull" { "in the plane it is a `polygon`" } else { "in the plane name its `corners`" };
        reader.error(Code::NotPlanar, at, format!("a `{key}` needs `space: spatial`"), help.to_owned());
        return;
    }
    if points.iter().flatten().any(|formula| reader.is_uncertain(formula)) {
        let other = if key == "hull" { "block" } else { "box" };
        let help = format!("which faces it has would depend on them; a `{other}` may have uncertain lengths");
        let message = format!(
            "points of a `{key}` are the same for all samples, so they cannot depend on an uncertain parameter"
        );
        reader.error(Code::MustBeCertain, at, message, help);
        return;
    }
    if points.len() > TUNING.points_of_hull {
        reader.error(
            Code::BadSurface,
            at,
            format!("a `{key}` has at most {} points, not {}", TUNING.points_of_hull, points.len()),
            None,
        );
        return;
    }
    let Some(numbers) = numbers(reader, points) else { return };
    if numbers.len() < 4 || Hull::of(numbers).is_none() {
        let help = if key == "hull" {
            "a plate of no thickness is a `polygon` that extends along z, or a thin `block`"
        } else {
            "a plate of no thickness is a thin `box`"
        };
        let message = format!("a `{key}` needs four points or more that do not lie in one plane");
        reader.error(Code::BadSurface, at, message, help.to_owned());
    }
}

/// Points that are the same for all samples.
fn numbers<S: SymbolTable>(reader: &Reader<'_, S>, points: &Points) -> Option<Vec<Point>> {
    let number = |point: &[Formula; 3]| {
        let [x, y, z] = [0, 1, 2].map(|axis| reader.evaluate(&point[axis], 0));
        Some([x?, y?, z?])
    };
    points.iter().map(number).collect()
}

/// Number of edges of the hull of points; 0 if they make none.
pub fn edges<S: SymbolTable>(reader: &Reader<'_, S>, points: &Points) -> usize {
    let hull =
        numbers(reader, points).filter(|points| (4..=TUNING.points_of_hull).contains(&points.len())).and_then(Hull::of);
    hull.map_or(0, |hull| hull.edges.len())
}
