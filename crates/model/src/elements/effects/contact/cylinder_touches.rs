//! Where surfaces touch a cylinder of the second body.
//!
//! ```text
//! plane              three points of each rim
//! circle             its centre, where the cylinder is nearest
//! capsule            the point of its line that is nearest
//! block, hull        three points of each rim, for the normal n of the face that is farthest away;
//!                    the point of each edge that is nearest
//! ```
//!
//! A face that touches meets a rim: the distances of all of these have the least distance of both bodies among them.

use super::cylinder::ContactCylinder;
use super::facets::Facets;
use super::solid::Solid;
use super::touch::{ContactSurface, Touch, WholeSurface};
use crate::multibody::{Pair, Vector};

/// All points where they may touch.
pub fn touches<'g>(surface: &ContactSurface<'g>, cylinder: &ContactCylinder<'g>, pair: &Pair<'g>) -> Vec<Touch<'g>> {
    let ContactSurface::Whole(shape) = surface else { return Vec::new() };
    let point = cylinder.radius.builder().number(0.0);
    let on_rims =
        |normal: Vector<'g>| cylinder.rims(pair, normal).into_iter().map(|place| shape.touch(pair, place, point, None));
    let origin = pair.first.point.position;
    let (facets, reach) = match *shape {
        WholeSurface::Plane(normal) => return on_rims(pair.outward(normal)).collect(),
        WholeSurface::Round(outer) => {
            let near = cylinder.axis.is_near(pair, point, outer + cylinder.radius);
            return vec![cylinder.touch(pair, origin, outer).only_within(Some(near))];
        }
        WholeSurface::Solid(Solid::Capsule { start, tangent, length }, reach) => {
            let line = (origin + pair.outward(start), pair.outward(tangent), length);
            return vec![cylinder.touch(pair, cylinder.nearest_on(pair, line, reach), reach)];
        }
        WholeSurface::Solid(Solid::Block { half: [Some(x), Some(y), Some(z)] }, reach) => {
            (Facets::of_block([x, y, z]), reach)
        }
        WholeSurface::Hull(ref hull, reach) => (Facets::of_hull(hull, reach.builder()), reach),
        WholeSurface::Solid(..) | WholeSurface::Hollow(_) | WholeSurface::Ground(_) => return Vec::new(),
    };
    let lowest = |normal: Vector<'g>| {
        let normal = pair.outward(normal);
        cylinder.lowest(pair, normal) - normal.dot(origin)
    };
    let facing = pair.outward(facets.facing(reach, lowest));
    let place = |corner: Vector<'g>| origin + pair.outward(corner);
    let edges = facets.edges.iter().map(|&(start, along, length)| {
        cylinder.touch(pair, cylinder.nearest_on(pair, (place(start), pair.outward(along), length), reach), reach)
    });
    on_rims(facing).chain(edges).collect()
}
