//! Bodies: solids and bars through their points.

use svg::node::element::path::Data;
use svg::node::element::{Group, Path, Title};

use super::glyph::{block, line, pair, px};
use super::view::{Px, View};
use crate::results::DrawnBody;

/// Of a body without a shape and with one place only, px: wide enough to be seen with the mark of its centre of mass in it.
const BLOCK: [f64; 2] = [44.0, 28.0];

/// Number of colours.
const COLORS: usize = 6;

/// Places that are nearer than this are one, px.
const NEAR: f64 = 1.0;

/// Where a body is seen: its points, and its centre of mass where it has fewer than two.
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

/// A body, by its index: a solid, a bar or a block.
pub(super) fn body(body: &DrawnBody, index: usize, view: &View) -> Group {
    let corners = hull(places(body).iter().map(|&place| view.px(place)).collect());
    let group = Group::new().set("class", format!("body color{}", index % COLORS)).add(Title::new(body.name.clone()));
    let guide = body.guide.and_then(|axis| view.direction(axis));
    let group = match corners.as_slice() {
        [one] => group.add(block(*one, guide.unwrap_or_else(|| own_axis(body, view)), Px::from(BLOCK))),
        [from, to] => group.add(line(*from, *to).set("class", "bar")),
        [first, others @ ..] => {
            let outline =
                others.iter().fold(Data::new().move_to(pair(*first)), |data, &corner| data.line_to(pair(corner)));
            group.add(Path::new().set("d", outline.close()))
        }
        [] => group,
    };
    match body.center_of_mass {
        Some(center) => group.add(center_mark(view.px(center))),
        None => group,
    }
}

/// The x axis of a body in the plane; horizontal in space, where one place has no direction to be seen from every side.
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

/// The corners of the convex hull, in order (Andrew's monotone chain, Inf. Process. Lett. 9 (1979) 216); both ends of places on a line.
fn hull(mut places: Vec<Px>) -> Vec<Px> {
    places.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    places.dedup_by(|a, b| (*a - *b).norm() < NEAR);
    if places.len() < 3 {
        return places;
    }
    let half = |places: &mut dyn Iterator<Item = Px>| {
        let mut chain: Vec<Px> = Vec::new();
        for place in places {
            while let [.., a, b] = chain[..]
                && (b - a).perp(&(place - a)) <= NEAR * (place - a).norm()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hull_has_the_outer_places() {
        let square = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [5.0, 5.0], [0.0, 0.2]].map(Px::from);
        assert_eq!(hull(square.to_vec()).len(), 4);
        let straight = [[0.0, 0.0], [5.0, 5.0], [10.0, 10.0]].map(Px::from);
        assert_eq!(hull(straight.to_vec()), [Px::new(0.0, 0.0), Px::new(10.0, 10.0)]);
        assert_eq!(hull(vec![Px::new(1.0, 2.0); 5]), [Px::new(1.0, 2.0)]);
    }
}
