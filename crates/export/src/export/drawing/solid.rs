//! Shapes of bodies and surfaces of effects, as a view shows them.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use svg::node::element::path::Data;
use svg::node::element::{Circle, Group, Path, Title};

use super::AddAll;
use super::glyph::{across, line, pair, px};
use super::hull::hull;
use super::view::{Px, View};
use crate::elements::Form;
use crate::export::solid::{Face, SolidFrame, core, faces, normal, polyline, reach};
use crate::export::tuning::TUNING;
use crate::results::{Drawing, DrawnSolid};

/// Half the width of a plane, and the distance of its hatching, px.
const PLANE: f64 = 90.0;
const HATCHING: f64 = 12.0;

fn frame(solid: &DrawnSolid, drawing: &Drawing) -> SolidFrame {
    SolidFrame::in_ground(solid, &drawing.bodies[solid.body])
}

/// Positions that enclose a solid, in the ground's frame.
pub(super) fn places(solid: &DrawnSolid, drawing: &Drawing) -> Vec<[f64; 3]> {
    let frame = frame(solid, drawing);
    reach(&solid.form).into_iter().map(|point| frame.place(point)).collect()
}

/// A solid; `None` if no part of it is visible.
pub(super) fn solid(solid: &DrawnSolid, drawing: &Drawing, view: &View) -> Option<Group> {
    let frame = frame(solid, drawing);
    let seen = |point: [f64; 3]| view.px(frame.place(point));
    let group = Group::new();
    let group = match &solid.surface {
        Some(name) => group.add(Title::new(format!("surface of {name}"))),
        None => group,
    };
    let drawn = match &solid.form {
        Form::Sphere { radius } => group.add(disc(seen([0.0; 3]), view.scale * radius)),
        Form::HalfSpace { normal } => half_space(group, frame.position(), frame.direction(*normal), view)?,
        Form::Ground { points } => group.add(open(&points.iter().map(|&point| seen(point)).collect::<Vec<_>>())),
        Form::Bore { axis, radius } => {
            let edge = Form::Cylinder { axis: *axis, length: 0.0, radius: *radius };
            let ring = faces(&edge).pop()?;
            group.add(closed(&ring.iter().map(|&point| seen(point)).collect::<Vec<_>>()).set("class", "rim"))
        }
        Form::Outline { points, is_closed: false, radius, .. } => {
            let width = (2.0 * view.scale * radius).max(2.0);
            let line = polyline(points, false).into_iter().map(seen).collect::<Vec<_>>();
            group.add(open(&line).set("stroke-width", px(width)).set("stroke-opacity", 0.5))
        }
        form @ (Form::Box { radius: 0.0, .. } | Form::Cylinder { .. } | Form::Mesh { .. }) => {
            group.add_all(polyhedron(&faces(form), &frame, view))
        }
        form @ Form::Outline { radius, .. } => {
            let rim = 2.0 * view.scale * radius;
            let faces = faces(form);
            let around = faces.last().filter(|_| rim > 1.0).map(|face| {
                let corners: Vec<Px> = face.iter().map(|&point| seen(point)).collect();
                closed(&corners).set("class", "rim").set("stroke-width", px(rim)).set("stroke-opacity", 0.3)
            });
            group.add_all(around).add_all(polyhedron(&faces, &frame, view))
        }
        form @ (Form::Box { .. } | Form::Capsule { .. } | Form::Hull { .. }) => {
            let (points, radius) = core(form)?;
            group.add(rounded(&hull(points.into_iter().map(seen).collect()), view.scale * radius))
        }
    };
    Some(drawn)
}

fn disc(at: Px, radius: f64) -> Circle {
    Circle::new().set("cx", px(at.x)).set("cy", px(at.y)).set("r", px(radius))
}

fn path(corners: &[Px]) -> Option<Data> {
    let (&first, others) = corners.split_first()?;
    Some(others.iter().fold(Data::new().move_to(pair(first)), |data, &corner| data.line_to(pair(corner))))
}

fn open(corners: &[Px]) -> Path {
    Path::new().set("d", path(corners).unwrap_or_default()).set("class", "rim")
}

fn closed(corners: &[Px]) -> Path {
    Path::new().set("d", path(corners).unwrap_or_default().close())
}

/// The points within a radius of a convex polygon, whose corners turn one way.
fn rounded(corners: &[Px], radius: f64) -> Path {
    let next = |index: usize| corners[(index + 1) % corners.len()];
    if radius < 0.05 {
        return closed(corners);
    }
    if let [one] = corners {
        let right = Px::new(radius, 0.0);
        let half = |to: Px| (px(radius), px(radius), 0, 0, 1, px(to.x), px(to.y));
        let data = Data::new().move_to(pair(one - right));
        let data = data.elliptical_arc_to(half(one + right)).elliptical_arc_to(half(one - right)).close();
        return Path::new().set("d", data);
    }
    // The inside of a hull is on the side of `across`.
    let outward = |index: usize| -radius * across((next(index) - corners[index]).normalize());
    let mut data = Data::new();
    for (index, &corner) in corners.iter().enumerate() {
        let (from, to) = (corner + outward(index), next(index) + outward(index));
        data = match index {
            0 => data.move_to(pair(from)),
            _ => data,
        };
        let end = next(index) + outward((index + 1) % corners.len());
        data = data.line_to(pair(to)).elliptical_arc_to((px(radius), px(radius), 0, 0, 1, px(end.x), px(end.y)));
    }
    Path::new().set("d", data.close())
}

/// The faces that are turned to the reader, and the sharp edges between them.
fn polyhedron(faces: &[Face], frame: &SolidFrame, view: &View) -> Vec<Path> {
    let placed = |face: &Face| face.iter().map(|&corner| frame.place(corner)).collect::<Face>();
    let shown: Vec<(Face, Vector3<f64>)> =
        faces.iter().map(placed).map(|face| (normal(&face), face)).map(|(normal, face)| (face, normal)).collect();
    let shown: Vec<_> = shown.into_iter().filter(|(_, normal)| view.shows(normal)).collect();
    let mut fill = Data::new();
    let mut edges: BTreeMap<[[i64; 2]; 2], Vec<Vector3<f64>>> = BTreeMap::new();
    for (face, normal) in &shown {
        let corners: Vec<[i64; 2]> = face.iter().map(|&corner| tenths(view.px(corner))).collect();
        for (index, &corner) in corners.iter().enumerate() {
            let at = (corner[0] as f64 / 10.0, corner[1] as f64 / 10.0);
            fill = if index == 0 { fill.move_to(at) } else { fill.line_to(at) };
            let mut ends = [corner, corners[(index + 1) % corners.len()]];
            ends.sort_unstable();
            if ends[0] != ends[1] {
                edges.entry(ends).or_default().push(normal.normalize());
            }
        }
        fill = fill.close();
    }
    let is_sharp = |normals: &[Vector3<f64>]| match normals {
        [first, second] => first.dot(second) < TUNING.smooth_edge,
        _ => true,
    };
    let sharp = edges.iter().filter(|(_, normals)| is_sharp(normals));
    let lines = sharp.fold(Data::new(), |data, ([from, to], _)| {
        let [from, to] = [from, to].map(|end| (end[0] as f64 / 10.0, end[1] as f64 / 10.0));
        data.move_to(from).line_to(to)
    });
    vec![Path::new().set("d", fill).set("class", "fill"), Path::new().set("d", lines).set("class", "rim")]
}

/// A point in tenths of px, in which corners of neighbours coincide.
fn tenths(at: Px) -> [i64; 2] {
    [at.x, at.y].map(|side| (10.0 * side).round() as i64)
}

/// A part of a plane: a hatched line if it is seen from its side, otherwise a square.
fn half_space(group: Group, at: [f64; 3], normal: [f64; 3], view: &View) -> Option<Group> {
    let middle = view.px(at);
    let unit = Vector3::from(normal).try_normalize(0.0)?;
    let helper = if unit.z.abs() < 0.9 { Vector3::z() } else { Vector3::x() };
    let first = unit.cross(&helper).normalize();
    let half = PLANE / view.scale;
    let corner = |x: f64, y: f64| {
        let place = Vector3::from(at) + half * (x * first + y * unit.cross(&first));
        view.px(place.into())
    };
    let square = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)];
    let doubled = (square[0] - square[2]).perp(&(square[1] - square[3])).abs();
    if doubled > 0.02 * PLANE * PLANE {
        return Some(group.add(closed(&square).set("class", "fill")).add(closed(&square).set("class", "rim thin")));
    }
    let outside = view.direction(normal)?;
    let along = across(outside);
    let steps = (PLANE / HATCHING) as i32;
    let hatched = (-steps..=steps).fold(Group::new().set("class", "hatch"), |hatched, step| {
        let from = middle + f64::from(step) * HATCHING * along;
        hatched.add(line(from, from - 8.0 * outside - 6.0 * along))
    });
    Some(group.add(line(middle - PLANE * along, middle + PLANE * along)).add(hatched))
}
