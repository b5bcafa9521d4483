//! Bodies: solids and bars through their points.

use svg::node::element::path::Data;
use svg::node::element::{Group, Path, Title};

use super::glyph::{block, line, pair, px};
use super::hull::hull;
use super::view::{Px, View};
use super::{AddAll, solid};
use crate::results::{Drawing, DrawnBody};

/// Size of a body without a shape and with one point only, px: wide enough to be seen with the mark of its centre of
/// mass in it.
const BLOCK: [f64; 2] = [44.0, 28.0];

/// Number of colours.
const COLORS: usize = 6;

/// Points at which a body is drawn: its own, and its centre of mass if it has fewer than two.
pub(super) fn places(body: &DrawnBody) -> Vec<[f64; 3]> {
    let mut places: Vec<[f64; 3]> = body.points.iter().map(|point| point.position).collect();
    if places.len() < 2 {
        places.extend(body.center_of_mass);
    }
    if places.is_empty() {
        places.push(body.position);
    }
    places
}

/// A body, by its index: its shapes, or a solid, a bar or a block.
pub(super) fn body(drawing: &Drawing, index: usize, view: &View) -> Group {
    let body = &drawing.bodies[index];
    let class = format!("body color{}", (index + COLORS - 1) % COLORS);
    let group = Group::new().set("class", class).add(Title::new(body.name.clone()));
    let own = drawing.solids.iter().filter(|solid| solid.body == index && solid.surface.is_none());
    let surfaces = drawing.solids.iter().filter(|solid| solid.body == index && solid.surface.is_some());
    let shapes: Vec<Group> = own.filter_map(|solid| solid::solid(solid, drawing, view)).collect();
    let surfaces: Vec<Group> = surfaces.filter_map(|solid| solid::solid(solid, drawing, view)).collect();
    let corners = hull(places(body).iter().map(|&place| view.px(place)).collect());
    // A surface represents a body that has only one point.
    let is_seen = !shapes.is_empty() || !surfaces.is_empty() && corners.len() < 2;
    let group = if is_seen { group } else { by_places(group, body, &corners, view) };
    let group = group.add_all(shapes).add_all(surfaces);
    match body.center_of_mass {
        Some(center) => group.add(center_mark(view.px(center))),
        None => group,
    }
}

/// A solid, a bar or a block.
fn by_places(group: Group, body: &DrawnBody, corners: &[Px], view: &View) -> Group {
    let guide = body.guide.and_then(|axis| view.direction(axis));
    match corners {
        [one] => group.add(block(*one, guide.unwrap_or_else(|| own_axis(body, view)), Px::from(BLOCK))),
        [from, to] => group.add(line(*from, *to).set("class", "bar")),
        [first, others @ ..] => {
            let outline =
                others.iter().fold(Data::new().move_to(pair(*first)), |data, &corner| data.line_to(pair(corner)));
            group.add(Path::new().set("d", outline.close()))
        }
        [] => group,
    }
}

/// The x axis of a body in the plane; horizontal in space, where a single point has no direction visible from every
/// side.
fn own_axis(body: &DrawnBody, view: &View) -> Px {
    let (sin, cos) = body.angle.map_or((0.0, 1.0), |angle| (symdiff::math::sin(angle), symdiff::math::cos(angle)));
    view.direction([cos, sin, 0.0]).unwrap_or_else(|| Px::new(1.0, 0.0))
}

/// The mark of a centre of mass: two quarters of a disc filled.
fn center_mark(at: Px) -> Path {
    let arc = |data: Data, to: Px| data.elliptical_arc_to((4, 4, 0, 0, 1, px(to.x), px(to.y)));
    let (right, down) = (Px::new(4.0, 0.0), Px::new(0.0, 4.0));
    let data = arc(Data::new().move_to(pair(at)).line_to(pair(at + right)), at + down).close();
    let data = arc(data.move_to(pair(at)).line_to(pair(at - right)), at - down).close();
    Path::new().set("d", data).set("class", "center")
}
