//! Solid surfaces in space: capsules and blocks, and all points within a rounding of them.
//!
//! ```text
//! capsule from a along u, length L; w = p − a:    e = w − t u,    t = w · u within 0 … L
//! block of half-sizes h about the origin:         eᵢ = ⟨pᵢ − hᵢ⟩ − ⟨−pᵢ − hᵢ⟩
//! gap = |e| − ρ − r,    normal = e/|e|
//! ```
//!
//! p is the other's centre in the first frame; e leads to it from the nearest point, so that normals turn smoothly
//! about edges and corners. Inside of a block, where e = 0, the nearest face pushes: gap = maxᵢ(|pᵢ| − hᵢ) − ρ − r,
//! which is continuous. A centre on a capsule's line has no nearest side: nothing pushes it.

use symdiff::{Builder, Formula, Scalar};

use super::course::Points;
use crate::grammar::{Reader, Span, SymbolTable};
use crate::multibody::{Pair, Vector};
use crate::syntax::codes::Code;

/// Where two surfaces are to one another.
#[derive(Clone, Copy, Debug)]
pub struct Gap<'g> {
    /// How far they are apart, m.
    pub gap: Scalar<'g>,
    /// The direction in which the second is pushed.
    pub normal: Vector<'g>,
    /// Positive where they overlap; computed with the fewest operations.
    pub overlap: Scalar<'g>,
    /// Not positive where both are so far apart that nothing else is needed, if there is anything so cheap.
    pub near: Option<Scalar<'g>>,
}

/// A line: from a point along a unit vector, with a length.
pub type Segment<'g> = (Vector<'g>, Vector<'g>, Scalar<'g>);

/// A convex body in the first frame.
#[derive(Clone, Copy, Debug)]
pub enum Solid<'g> {
    /// From a point along a unit vector.
    Capsule { start: Vector<'g>, tangent: Vector<'g>, length: Scalar<'g> },
    /// Half-sizes; one that is not there is in the plane.
    Block { half: [Option<Scalar<'g>>; 3] },
}

impl<'g> Solid<'g> {
    /// The line between two points.
    pub fn between(start: Vector<'g>, end: Vector<'g>) -> Self {
        let way = end - start;
        let length = way.norm();
        Self::Capsule { start, tangent: way / length, length }
    }

    /// The radius of a ball about the first point that holds it.
    pub fn radius(&self, g: &'g Builder) -> Scalar<'g> {
        match *self {
            Self::Capsule { start, tangent, length } => {
                let end = start + length * tangent;
                start.norm().max(end.norm())
            }
            Self::Block { half } => {
                let square = half.into_iter().flatten().fold(g.number(0.0), |sum, half| sum + half * half);
                square.sqrt()
            }
        }
    }

    /// The gap to a centre at `offset` from the first point; `reach` is ρ + r.
    pub fn gap(&self, pair: &Pair<'g>, offset: Vector<'g>, reach: Scalar<'g>) -> Gap<'g> {
        let g = reach.builder();
        let axes = [0, 1, 2].map(|axis| pair.outward(Vector::along(g, axis)));
        let outward = |local: [Scalar<'g>; 3]| {
            axes.into_iter().zip(local).fold(Vector::zero(g), |sum, (axis, part)| sum + part * axis)
        };
        let place = axes.map(|axis| axis.dot(offset));
        let away = self.away(place);
        let square = g.dot(&away, &away);
        let overlap = reach * reach - square;
        // Avoids the root of zero, even where its result is not used.
        let distance = square.select(square, g.number(1.0)).sqrt();
        let normal = away.map(|part| part / distance);
        let Self::Block { half } = self else {
            return Gap {
                gap: square.select(distance, g.number(0.0)) - reach,
                normal: outward(normal),
                overlap,
                near: None,
            };
        };
        let (depth, face) = inside(place, half, g.number(0.0));
        let chosen = [0, 1, 2].map(|axis| square.select(normal[axis], face[axis]));
        Gap { gap: square.select(distance, depth) - reach, normal: outward(chosen), overlap, near: None }
    }

    /// e
    fn away(&self, place: [Scalar<'g>; 3]) -> [Scalar<'g>; 3] {
        match *self {
            Self::Capsule { start, tangent, length } => {
                let from = Vector::from(place) - start;
                let zero = length.builder().number(0.0);
                let along = tangent.dot(from).max(zero).min(length);
                (from - along * tangent).components()
            }
            Self::Block { half } => [0, 1, 2].map(|axis| {
                let zero = place[axis].builder().number(0.0);
                match half[axis] {
                    Some(half) => (place[axis] - half).max(zero) + (place[axis] + half).min(zero),
                    None => zero,
                }
            }),
        }
    }
}

/// How far a point is beyond the nearest face of a block, negative inside, and that face's normal.
fn inside<'g>(
    place: [Scalar<'g>; 3],
    half: &[Option<Scalar<'g>>; 3],
    zero: Scalar<'g>,
) -> (Scalar<'g>, [Scalar<'g>; 3]) {
    let one = zero.builder().number(1.0);
    let mut nearest: Option<(Scalar<'g>, [Scalar<'g>; 3])> = None;
    for axis in 0..3 {
        let Some(half) = half[axis] else { continue };
        for sign in [1.0, -1.0] {
            let beyond = sign * place[axis] - half;
            let normal = [0, 1, 2].map(|other| if other == axis { sign * one } else { zero });
            nearest = Some(match nearest {
                None => (beyond, normal),
                Some((best, its)) => {
                    let nearer = beyond - best;
                    let normal = [0, 1, 2].map(|other| nearer.select(normal[other], its[other]));
                    (nearer.select(beyond, best), normal)
                }
            });
        }
    }
    nearest.unwrap_or((zero, [zero; 3]))
}

/// Reports a capsule of other than two points, or of one twice, somewhere in the box of parameters.
pub(in crate::elements) fn check_ends<S: SymbolTable>(reader: &mut Reader<'_, S>, at: Span, key: &str, ends: &Points) {
    let [start, end] = &**ends else {
        let message = format!("a `{key}` has 2 points, not {}", ends.len());
        let help = (key == "capsule").then(|| "several in a row are a `path`, in the plane".to_owned());
        reader.error(Code::BadSurface, at, message, help);
        return;
    };
    for corner in 0..reader.corners.len() {
        let is_same = |axis: usize| {
            let [start, end] = [start, end].map(|point| reader.evaluate(&point[axis], corner));
            start.is_some() && start == end
        };
        if (0..3).all(is_same) {
            let label = &reader.corners[corner].label;
            let message = format!("the ends of the `{key}` are one point{label}");
            let help = (key == "capsule").then(|| "a ball is a `circle`, as a shape a `sphere`".to_owned());
            reader.error(Code::BadSurface, at, message, help);
            return;
        }
    }
}

/// Reports a block that is flat somewhere in the box of parameters.
pub(in crate::elements) fn check_lengths<S: SymbolTable>(
    reader: &mut Reader<'_, S>,
    at: Span,
    key: &str,
    lengths: &[Formula; 3],
) {
    let needed = if reader.model.is_spatial() { 3 } else { 2 };
    for corner in 0..reader.corners.len() {
        let lengths = lengths[..needed].iter().map(|length| reader.evaluate(length, corner));
        if let Some((axis, length)) = lengths.enumerate().find(|(_, length)| length.is_some_and(|length| length <= 0.0))
        {
            let (axis, length) = (["x", "y", "z"][axis], length.unwrap_or_default());
            let label = &reader.corners[corner].label;
            let message = format!("a `{key}` has a length above 0 along {axis}, not {length}{label}");
            reader.error(Code::BadSurface, at, message, None);
            return;
        }
    }
}
