//! Blocks and convex hulls as corners, edges and faces.

use symdiff::{Builder, Scalar};

use super::hull::{Hull, constant};
use super::solid::Segment;
use crate::elements::tuning::TUNING;
use crate::multibody::Vector;

/// A polyhedron in its body's frame.
#[derive(Clone, Debug)]
pub struct Facets<'g> {
    pub corners: Vec<Vector<'g>>,
    pub edges: Vec<Segment<'g>>,
    /// Normals, and how far the faces are from the frame's origin along them.
    faces: Vec<(Vector<'g>, Scalar<'g>)>,
}

impl<'g> Facets<'g> {
    /// Facets of a block of half-sizes about the origin.
    pub fn of_block(half: [Scalar<'g>; 3]) -> Self {
        let g = half[0].builder();
        let sign = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
        let corner = |number: usize| Vector::from([0, 1, 2].map(|axis| sign(number, axis) * half[axis]));
        let edges = (0..3).flat_map(|axis| {
            let starts = (0..8).filter(move |corner| corner >> axis & 1 == 0);
            starts.map(move |start| (corner(start), Vector::along(g, axis), 2.0 * half[axis]))
        });
        let faces = (0..3).flat_map(|axis| [1.0, -1.0].map(|sign| (sign * Vector::along(g, axis), half[axis])));
        Self { corners: (0..8).map(corner).collect(), edges: edges.collect(), faces: faces.collect() }
    }

    /// Facets of a convex hull.
    pub fn of_hull(hull: &Hull, g: &'g Builder) -> Self {
        let edges = hull
            .edges
            .iter()
            .map(|edge| (constant(g, hull.points[edge.ends[0]]), constant(g, edge.along), g.number(hull.length(edge))));
        Self {
            corners: hull.points.iter().map(|&point| constant(g, point)).collect(),
            edges: edges.collect(),
            faces: hull.faces.iter().map(|face| (constant(g, face.normal), g.number(face.height))).collect(),
        }
    }

    /// The normal of the face that a convex body is farthest from; `lowest` is the least of n · p over the body's
    /// points. While the body is at a distance of a face that is more than a tenth of the reach, no other is as far.
    pub fn facing(&self, reach: Scalar<'g>, lowest: impl Fn(Vector<'g>) -> Scalar<'g>) -> Vector<'g> {
        let g = reach.builder();
        let apart: Vec<Scalar<'g>> = self.faces.iter().map(|&(normal, height)| lowest(normal) - height).collect();
        let Some(farthest) = apart.iter().copied().reduce(Scalar::max) else { return Vector::zero(g) };
        let zero = g.number(0.0);
        let width = TUNING.mixed_normals * reach;
        let shares = apart.into_iter().zip(&self.faces);
        let sum =
            shares.fold(Vector::zero(g), |sum, (apart, face)| sum + (width - (farthest - apart)).max(zero) * face.0);
        let least = 1e-6 * width * width;
        sum / sum.dot(sum).max(least).sqrt()
    }
}
