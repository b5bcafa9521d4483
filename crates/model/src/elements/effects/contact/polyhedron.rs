//! Boxes and convex hulls of the second body, and all points within its radius of them.
//!
//! ```text
//! plane, hollow      each corner
//! circle             the ball's centre, where the polyhedron is nearest
//! capsule            the point of its line that is nearest to the polyhedron
//! block, hull        each corner of both, where the other is nearest; each two edges, where they are nearest
//! ```
//!
//! Two convex polyhedra are nearest at a corner of one of them or where two edges cross. Where faces lie on one another
//! these are the corners of the faces' common part. Distances of edges have no sign: edges that cross may be as deep as
//! ρ + r. Each push is the gradient of an energy of its own distance, so that the sum keeps energy, also while a corner
//! passes over an edge.

use std::rc::Rc;

use symdiff::Scalar;

use super::course::Points;
use super::facets::Facets;
use super::hull::{self, Hull};
use super::rod::Rod;
use super::solid::Solid;
use super::touch::{ContactSurface, Touch, WholeSurface};
use crate::elements::tuning::TUNING;
use crate::grammar::{Reader, Span, SymbolTable};
use crate::multibody::{Pair, Vector};
use crate::syntax::codes::Code;

/// Edges of a box.
const EDGES: usize = 12;

/// A polyhedron of the second body.
#[derive(Clone, Debug)]
pub struct Polyhedron<'g> {
    body: Body<'g>,
    facets: Facets<'g>,
    /// r, m
    radius: Scalar<'g>,
}

#[derive(Clone, Debug)]
enum Body<'g> {
    Block([Scalar<'g>; 3]),
    Hull(Rc<Hull>),
}

impl<'g> Polyhedron<'g> {
    /// A block of half-sizes about the second point.
    pub fn block(half: [Scalar<'g>; 3], radius: Scalar<'g>) -> Self {
        Self { body: Body::Block(half), facets: Facets::of_block(half), radius }
    }

    /// A convex hull in the second frame.
    pub fn hull(hull: Rc<Hull>, radius: Scalar<'g>) -> Self {
        Self { facets: Facets::of_hull(&hull, radius.builder()), body: Body::Hull(hull), radius }
    }

    /// All points where they may touch.
    pub fn touches(&self, surface: &ContactSurface<'g>, pair: &Pair<'g>) -> Vec<Touch<'g>> {
        let ContactSurface::Whole(shape) = surface else { return Vec::new() };
        let on_corners = || {
            let corners =
                self.facets.corners.iter().map(|&corner| pair.second.point.position + pair.outward_of_second(corner));
            corners.map(|corner| shape.touch(pair, corner, self.radius, None)).collect::<Vec<_>>()
        };
        let back = Pair { first: pair.second, second: pair.first };
        let origin = pair.first.point.position;
        let (facets, reach, radius) = match *shape {
            WholeSurface::Plane(_) | WholeSurface::Hollow(_) => return on_corners(),
            WholeSurface::Round(outer) => {
                let touch = self.shape(outer + self.radius).touch(&back, origin, outer, None).reversed();
                return vec![self.near(touch, outer + self.radius, self.radius.builder().number(0.0), pair)];
            }
            WholeSurface::Solid(solid @ Solid::Capsule { start, tangent, length }, reach) => {
                let line = Rod::along(start, tangent, length);
                let nearest = match &self.body {
                    Body::Block(half) => line.nearest_to_block(&back, half.map(Some), reach),
                    Body::Hull(hull) => line.nearest_to_hull(&back, hull),
                };
                let touch = self.shape(reach).touch(&back, nearest, reach - self.radius, None).reversed();
                return vec![self.near(touch, reach, solid.radius(reach.builder()), pair)];
            }
            WholeSurface::Solid(solid @ Solid::Block { half: [Some(x), Some(y), Some(z)] }, reach) => {
                (Facets::of_block([x, y, z]), reach, solid.radius(reach.builder()))
            }
            WholeSurface::Hull(ref hull, reach) => {
                (Facets::of_hull(hull, reach.builder()), reach, reach.builder().number(hull.radius()))
            }
            WholeSurface::Solid(..) | WholeSurface::Ground(_) => return Vec::new(),
        };
        let mut all = on_corners();
        let body = self.shape(reach);
        all.extend(
            facets
                .corners
                .iter()
                .map(|&corner| body.touch(&back, origin + pair.outward(corner), reach - self.radius, None).reversed()),
        );
        for &(start, tangent, length) in &facets.edges {
            let capsule = WholeSurface::Solid(Solid::Capsule { start, tangent, length }, reach);
            all.extend(self.facets.edges.iter().map(|&(from, along, its_length)| {
                let centre = Rod::along(from, along, its_length).nearest_to_line(pair, (start, tangent, length));
                capsule.touch(pair, centre, self.radius, None)
            }));
        }
        all.into_iter().map(|touch| self.near(touch, reach, radius, pair)).collect()
    }

    /// The polyhedron as a surface, for contacts with whatever is within a reach of it.
    fn shape(&self, reach: Scalar<'g>) -> WholeSurface<'g> {
        match &self.body {
            Body::Block(half) => WholeSurface::Solid(Solid::Block { half: half.map(Some) }, reach),
            Body::Hull(hull) => WholeSurface::Hull(hull.clone(), reach),
        }
    }

    /// None where balls about both points are apart.
    fn near(&self, touch: Touch<'g>, reach: Scalar<'g>, radius: Scalar<'g>, pair: &Pair<'g>) -> Touch<'g> {
        let g = reach.builder();
        let its_radius = match &self.body {
            Body::Block(half) => Vector::from(*half).norm(),
            Body::Hull(hull) => g.number(hull.radius()),
        };
        let sum = radius + its_radius + reach;
        touch.only_within(Some(sum * sum - pair.offset().dot(pair.offset())))
    }
}

/// Reports two polyhedra of too many edges; of a box there are no points.
pub fn check_edges<S: SymbolTable>(
    reader: &mut Reader<'_, S>,
    at: Span,
    first: Option<&Points>,
    second: Option<&Points>,
) {
    let [first, second] = [first, second].map(|points| points.map_or(EDGES, |points| hull::edges(reader, points)));
    if first * second > TUNING.pairs_of_edges {
        let message = format!(
            "polyhedra of {first} and {second} edges have {} pairs of edges that may touch; a contact has at most {}",
            first * second,
            TUNING.pairs_of_edges
        );
        let help = "leave out points, or say `corners` instead, which touch alone".to_owned();
        reader.error(Code::TooLarge, at, message, help);
    }
}
