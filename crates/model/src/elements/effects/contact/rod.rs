//! A capsule on the second body of a contact, about a line in that body's frame.
//!
//! ```text
//! line from b along v, length M, against one from a along u, length L; r = a − b:
//! s = (v·r u·v − u·r + ε² m)/(|u × v|² + ε²) within 0 … L,    t = v·r + s u·v within 0 … M,    centre = b + t v
//! ```
//!
//! Against a block see `beside`, against a hull `along_hull`. Lines that cross have one nearest pair of points.
//! Parallel ones have many: m is the middle of their common part, and ε = 10⁻⁴ the angle at which it takes over.

use symdiff::Scalar;

use super::along_hull::nearest_to_hull;
use super::beside::nearest_to_block;
use super::course::Points;
use super::hull::Hull;
use super::solid::Segment;
use crate::elements::tuning::TUNING;
use crate::grammar::{Fields, Reader, SymbolTable};
use crate::multibody::{Pair, Vector};
use crate::syntax::codes::Code;

/// A line in the second frame.
#[derive(Clone, Copy, Debug)]
pub struct Rod<'g> {
    start: Vector<'g>,
    /// v
    tangent: Vector<'g>,
    /// M, m
    pub length: Scalar<'g>,
}

impl<'g> Rod<'g> {
    /// Rod between two points.
    pub fn between(start: Vector<'g>, end: Vector<'g>) -> Self {
        let way = end - start;
        let length = way.norm();
        Self { start, tangent: way / length, length }
    }

    /// Rod from a point along a unit vector.
    pub fn along(start: Vector<'g>, tangent: Vector<'g>, length: Scalar<'g>) -> Self {
        Self { start, tangent, length }
    }

    /// Both ends.
    pub fn ends(&self, pair: &Pair<'g>) -> [Vector<'g>; 2] {
        let (start, along) = self.outward(pair);
        [start, start + self.length * along]
    }

    /// The point that is nearest to one.
    pub fn nearest_to_point(&self, pair: &Pair<'g>, point: Vector<'g>) -> Vector<'g> {
        let (start, along) = self.outward(pair);
        start + self.within(along.dot(point - start)) * along
    }

    /// The point that is nearest to a block about the first point; `reach` is ρ + r.
    pub fn nearest_to_block(&self, pair: &Pair<'g>, half: [Option<Scalar<'g>>; 3], reach: Scalar<'g>) -> Vector<'g> {
        let (start, along) = self.outward(pair);
        start + nearest_to_block(self.in_first(pair), half, reach) * along
    }

    /// The point that is nearest to a hull in the first frame.
    pub fn nearest_to_hull(&self, pair: &Pair<'g>, hull: &Hull) -> Vector<'g> {
        let (start, along) = self.outward(pair);
        start + nearest_to_hull(hull, self.in_first(pair)) * along
    }

    /// Positive where the line may be within `reach` of a body that a ball of some radius about the first point holds.
    pub fn is_near(&self, pair: &Pair<'g>, radius: Scalar<'g>, reach: Scalar<'g>) -> Scalar<'g> {
        let (start, along) = self.outward(pair);
        let offset = start + 0.5 * self.length * along - pair.first.point.position;
        let sum = radius + reach + 0.5 * self.length;
        sum * sum - offset.dot(offset)
    }

    /// The point that is nearest to a line of the first frame: from a point along a unit vector.
    pub fn nearest_to_line(&self, pair: &Pair<'g>, (from, tangent, length): Segment<'g>) -> Vector<'g> {
        let (start, along) = self.outward(pair);
        let across = pair.outward(tangent);
        let offset = pair.first.point.position + pair.outward(from) - start;
        let (cosine, normal) = (across.dot(along), across.cross(along));
        let (ahead, aside) = (along.dot(offset), across.dot(offset));
        let zero = length.builder().number(0.0);
        let on_first = |place: Scalar<'g>| place.max(zero).min(length);
        let middle = 0.5 * (on_first(-aside) + on_first(cosine * self.length - aside));
        let small = TUNING.parallel_rods * TUNING.parallel_rods;
        let place = (cosine * ahead - aside + small * middle) / (normal.dot(normal) + small);
        start + self.within(ahead + cosine * on_first(place)) * along
    }

    /// A unit vector across it, in the second frame (Duff et al., J. Comput. Graph. Tech. 6 (2017) 1).
    pub fn aside(&self) -> Vector<'g> {
        let [x, y, z] = self.tangent.components();
        let one = z.builder().number(1.0);
        let sign = z.select(one, -one);
        let factor = -1.0 / (sign + z);
        Vector::from([1.0 + sign * x * x * factor, sign * x * y * factor, -(sign * x)])
    }

    /// Start and direction in the ground's frame.
    pub fn outward(&self, pair: &Pair<'g>) -> (Vector<'g>, Vector<'g>) {
        (pair.second.point.position + pair.outward_of_second(self.start), pair.outward_of_second(self.tangent))
    }

    /// Start, direction and length in the first frame.
    fn in_first(&self, pair: &Pair<'g>) -> Segment<'g> {
        let (start, along) = self.outward(pair);
        let axes = [0, 1, 2].map(|axis| pair.outward(Vector::along(self.length.builder(), axis)));
        let local = |vector: Vector<'g>| Vector::from(axes.map(|axis| axis.dot(vector)));
        (local(start - pair.first.point.position), local(along), self.length)
    }

    fn within(&self, place: Scalar<'g>) -> Scalar<'g> {
        place.max(self.length.builder().number(0.0)).min(self.length)
    }
}

/// Reports more corners than a contact has.
pub fn check_corners<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, corners: &Points) {
    if corners.len() > TUNING.corners_of_contact {
        let message = format!("a contact has at most {} `corners`, not {}", TUNING.corners_of_contact, corners.len());
        let help = "points inside of their hull touch nothing: leave them out".to_owned();
        reader.error(Code::MisplacedKey, fields.key_span("corners"), message, help);
    }
}

/// Surfaces that a key of the second body goes with.
const TOUCHED: [(&str, &[&str], &str); 4] = [
    (
        "line",
        &["plane", "circle", "hollow", "capsule", "block", "hull"],
        "a `line` touches a `plane`, `circle` (without `axis`), `hollow`, `capsule`, `block` or `hull`",
    ),
    (
        "cylinder",
        &["plane", "circle", "capsule", "block", "hull"],
        "a `cylinder` touches a `plane`, `circle` (without `axis`), `capsule`, `block` or `hull`",
    ),
    (
        "box",
        &["plane", "circle", "hollow", "capsule", "block", "hull"],
        "a `box` touches a `plane`, `circle` (without `axis`), `hollow`, `capsule`, `block` or `hull`; elsewhere name its `corners`",
    ),
    (
        "polyhedron",
        &["plane", "circle", "hollow", "capsule", "block", "hull"],
        "a `polyhedron` touches a `plane`, `circle` (without `axis`), `hollow`, `capsule`, `block` or `hull`; elsewhere name its `corners`",
    ),
];

/// Reports shapes of the second body that exclude each other, that lack a radius, and surfaces that they do not touch.
pub fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, all: &[&'static str]) {
    let shapes = ["corners", "line", "cylinder", "box", "polyhedron"].into_iter();
    let shapes: Vec<&str> = shapes.filter(|key| fields.get(key).is_some()).collect();
    if let [first, second, ..] = shapes.as_slice() {
        reader.error(
            Code::ExclusiveKeys,
            fields.key_span(second),
            format!("`{first}` and `{second}` exclude each other"),
            None,
        );
        return;
    }
    let planar = [
        ("cylinder", "in the plane it is a ball: give its `radius` alone"),
        ("box", "in the plane name its `corners`"),
    ];
    if let Some((key, help)) =
        planar.into_iter().find(|(key, _)| fields.get(key).is_some() && !reader.model.is_spatial())
    {
        reader.error(
            Code::NotPlanar,
            fields.key_span(key),
            format!("a `{key}` needs `space: spatial`"),
            help.to_owned(),
        );
    }
    let Some((key, surfaces, help)) = TOUCHED.into_iter().find(|(key, ..)| fields.get(key).is_some()) else { return };
    if matches!(key, "line" | "cylinder") && fields.lacks_all(&["radius"]) {
        reader.error(Code::IncompleteElement, fields.key_span(key), format!("a `{key}` needs its `radius`"), None);
    }
    if key == "cylinder"
        && let Some(edges) = ["block", "hull"].into_iter().find(|edges| fields.get(edges).is_some())
        && fields.lacks_all(&["rounding"])
    {
        let message = format!("a `{edges}` that a `cylinder` touches needs `rounding`");
        reader.error(
            Code::IncompleteElement,
            fields.key_span(edges),
            message,
            "surfaces are told apart to that depth".to_owned(),
        );
    }
    let others = all.iter().copied().filter(|surface| !surfaces.contains(surface));
    let is_turned = fields.get("circle").is_some();
    if let Some(other) = others.chain(is_turned.then_some("axis")).find(|other| fields.get(other).is_some()) {
        reader.error(
            Code::MisplacedKey,
            fields.key_span(key),
            format!("`{key}` does not go with `{other}`"),
            help.to_owned(),
        );
    }
}
