//! `bodies:`, and references to bodies and their points.

use crate::grammar::{Coordinate, Rotation};
use symdiff::Formula;

use super::beams;
use super::description::{Analysis, Body, FlexibleBeam, Inertia, Point};
use crate::elements::shapes::ShapeKind;
use crate::expand::parts;
use crate::grammar::motions::is_motion;
use crate::grammar::names::{Context, GROUND};
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::keys;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::yaml::{Entry, Node, Value};

/// Names of coordinates, and their meanings. The last leave the plane.
const COORDINATES: [(&str, &[Coordinate]); 5] = [
    ("x", &[Coordinate::X]),
    ("y", &[Coordinate::Y]),
    ("angle", &[Coordinate::Angle]),
    ("z", &[Coordinate::Z]),
    ("orientation", &Coordinate::ORIENTATION),
];

/// Coordinates that can be prescribed.
const HELD: [(&str, Coordinate); 4] =
    [("x", Coordinate::X), ("y", Coordinate::Y), ("z", Coordinate::Z), ("angle", Coordinate::Angle)];

/// Notes the names of the bodies and of their points, so that anything can refer to them.
pub fn declare(reader: &mut Reader, entries: &[Entry]) {
    let empty = |name: &str| Body {
        name: name.to_owned(),
        mass: None,
        inertia: None,
        center_of_mass: None,
        coordinates: Vec::new(),
        prescribed: Vec::new(),
        prescribed_orientation: None,
        points: Vec::new(),
        standing: None,
        shapes: Vec::new(),
    };
    reader.model.mechanism_mut().bodies.push(empty(GROUND));
    for entry in entries {
        reader.name(entry, "a body");
        if let Some(elements) = beams::elements(entry).filter(|_| entry.key != GROUND) {
            reader.model.mechanism_mut().bodies.extend(beams::nodes(&entry.key, elements).map(|name| empty(&name)));
            reader.model.mechanism_mut().beams.push(FlexibleBeam { name: entry.key.clone(), elements });
            continue;
        }
        let mut body = empty(&entry.key);
        if let Value::Mapping(fields) = &entry.value.value
            && let Some(points) = fields.iter().find(|field| field.key == "points")
            && let Value::Mapping(points) = &points.value.value
        {
            let unknown = || [0.0; 3].map(Formula::number);
            let named = |point: &Entry| Point { name: point.key.clone(), position: unknown(), rotation: None };
            body.points = points.iter().map(named).collect();
        }
        if entry.key == GROUND {
            reader.model.mechanism_mut().bodies[0] = body;
        } else {
            reader.model.mechanism_mut().bodies.push(body);
        }
    }
}

/// Reads the bodies that were declared.
pub fn read(reader: &mut Reader, entries: &[Entry]) {
    let mut next = 1;
    for entry in entries {
        if entry.key == GROUND {
            ground(reader, entry);
        } else if let Some(elements) = beams::elements(entry) {
            beams::read(reader, entry, next, elements);
            next += elements + 1;
        } else {
            body(reader, entry, next);
            next += 1;
        }
    }
}

fn ground(reader: &mut Reader, entry: &Entry) {
    let Some(fields) = reader.fields::<keys::Body>(&entry.value, entry.key_span.clone()) else { return };
    for key in ["mass", "inertia", "center_of_mass", "coordinates", "held", "beam"] {
        if fields.get(key).is_some() {
            let help = "the ground does not move; it can be given `points` and a `shape` only".to_owned();
            reader.error(Code::MisplacedKey, fields.key_span(key), format!("the ground has no `{key}`"), help);
        }
    }
    points(reader, &fields, 0);
    shapes(reader, &fields, 0);
}

/// Reads the shapes of a body: one, or several.
fn shapes(reader: &mut Reader, fields: &Fields, body: usize) {
    let Some(node) = fields.get("shape") else { return };
    let at = fields.key_span("shape");
    let nodes = if let Value::Sequence(items) = &node.value { items.as_slice() } else { std::slice::from_ref(node) };
    let shapes: Vec<_> = nodes.iter().map(|node| ShapeKind::read(reader, node, at.clone())).collect();
    reader.model.mechanism_mut().bodies[body].shapes = shapes.into_iter().flatten().collect();
}

fn body(reader: &mut Reader, entry: &Entry, index: usize) {
    let Some(fields) = reader.fields::<keys::Body>(&entry.value, entry.key_span.clone()) else { return };
    let coordinates = match fields.get("coordinates") {
        Some(node) => coordinates(reader, node),
        None => usual(reader),
    };
    let turns = coordinates.iter().any(|coordinate| !coordinate.is_length());
    let translates = coordinates.iter().any(|coordinate| coordinate.is_length());
    let off_center = fields.get("center_of_mass").is_some();

    let has_forces = reader.model.analysis != Analysis::Kinematics;
    let positive = |reader: &mut Reader, key: &str, dimension: Dimension, needed: bool| {
        let needed = needed && has_forces;
        let node = if needed { reader.required(&fields, key) } else { fields.get(key) }?;
        let formula = reader.formula(node, Context::Constant, dimension)?;
        // A mass of 0 is allowed: joints or springs have to determine where the body is.
        if needed && formula.as_number() != Some(0.0) {
            reader.require(node, &formula, |value| value > 0.0, "must be positive");
        } else {
            reader.require(node, &formula, |value| value >= 0.0, "must not be negative");
        }
        Some(formula)
    };
    let mass = positive(reader, "mass", Dimension::MASS, translates || turns && off_center);
    let inertia = match fields.get("inertia") {
        Some(node) if !matches!(node.value, Value::Scalar(_)) => tensor(reader, node, fields.key_span("inertia")),
        _ => positive(reader, "inertia", Dimension::INERTIA, turns).map(|value| Inertia::scalar(&value)),
    };
    let center =
        fields.get("center_of_mass").and_then(|node| reader.components(node, Context::Constant, Dimension::LENGTH));
    let (prescribed, prescribed_orientation) = prescribed(reader, &fields, &coordinates);
    let is_ground = || parts::is_ground(&entry.key);
    if let Some(node) = fields.get("coordinates").filter(|_| coordinates.is_empty() && !is_ground()) {
        needs_motion(reader, node, &prescribed);
    }
    points(reader, &fields, index);
    shapes(reader, &fields, index);

    let body = &mut reader.model.mechanism_mut().bodies[index];
    body.mass = mass;
    body.inertia = inertia;
    body.center_of_mass = center;
    body.coordinates = coordinates;
    body.prescribed = prescribed;
    body.prescribed_orientation = prescribed_orientation;
}

/// Reports a body without coordinates of which no value in `held` depends on t.
fn needs_motion(reader: &mut Reader, node: &Node, prescribed: &[(Coordinate, Formula)]) {
    let moves = prescribed.iter().any(|(_, value)| value.names().any(|(name, _)| name == "t"));
    if !moves && matches!(&node.value, Value::Sequence(items) if items.is_empty()) {
        let help = format!(
            "a body that does not move is part of the ground: give `{GROUND}` the points; a driven body has a formula of t in `held`"
        );
        reader.error(Code::BadCoordinates, node.span.clone(), "a body has at least one coordinate", help);
    }
}

/// The coordinates of a body that says nothing of them.
fn usual(reader: &Reader) -> Vec<Coordinate> {
    let [x, y, z] = [Coordinate::X, Coordinate::Y, Coordinate::Z];
    if reader.model.space.spatial {
        [x, y, z].into_iter().chain(Coordinate::ORIENTATION).collect()
    } else {
        vec![x, y, Coordinate::Angle]
    }
}

/// `[xx, yy, zz]` or `{ xx: …, xy: … }`; positive definite at all corners.
fn tensor(reader: &mut Reader, node: &Node, at: crate::syntax::source::Span) -> Option<Inertia> {
    if !reader.model.space.spatial {
        reader.leaves_the_plane(node);
    }
    let zero = || Formula::number(0.0);
    let inertia = if let Value::Sequence(_) = node.value {
        let [xx, yy, zz] = reader.three(node, Context::Constant, Dimension::INERTIA)?;
        Inertia { xx, yy, zz, xy: zero(), xz: zero(), yz: zero() }
    } else {
        let fields = reader.fields::<keys::Tensor>(node, at)?;
        let [xx, yy, zz] = ["xx", "yy", "zz"].map(|key| {
            let node = reader.required(&fields, key)?;
            reader.formula(node, Context::Constant, Dimension::INERTIA)
        });
        let [xy, xz, yz] = ["xy", "xz", "yz"].map(|key| match fields.get(key) {
            Some(node) => reader.formula(node, Context::Constant, Dimension::INERTIA),
            None => Some(zero()),
        });
        Inertia { xx: xx?, yy: yy?, zz: zz?, xy: xy?, xz: xz?, yz: yz? }
    };
    for corner in 0..reader.corners.len() {
        let Inertia { xx, yy, zz, xy, xz, yz } = &inertia;
        let values = [xx, xy, xz, xy, yy, yz, xz, yz, zz].map(|formula| reader.evaluate(formula, corner));
        let Some(values) = values.into_iter().collect::<Option<Vec<f64>>>() else { continue };
        if nalgebra::Matrix3::from_row_slice(&values).cholesky().is_none() {
            let label = &reader.corners[corner].label;
            let message = format!("the inertia tensor is not positive definite{label}");
            let help = "no body turns without inertia; a thin rod has a little about its axis too".to_owned();
            reader.error(Code::BadInertia, node.span.clone(), message, help);
            break;
        }
    }
    Some(inertia)
}

fn coordinates(reader: &mut Reader, node: &Node) -> Vec<Coordinate> {
    let choices = if reader.model.space.spatial { &COORDINATES[..] } else { &COORDINATES[..3] };
    let Value::Sequence(items) = &node.value else {
        let message = format!("coordinates are a list, but here is {}", node.kind());
        let all = if reader.model.space.spatial { "[x, y, z, orientation]" } else { "[x, y, angle]" };
        reader.error(Code::BadCoordinates, node.span.clone(), message, format!("write `{all}`, or fewer of them"));
        return usual(reader);
    };
    let mut found: Vec<(&[Coordinate], &Node)> = Vec::new();
    for item in items {
        let Some(named) = reader.choice(item, choices) else { continue };
        match found.iter().find(|(known, _)| *known == named) {
            Some((_, first)) => {
                let name = item.scalar().map_or("", |scalar| scalar.text.as_str());
                let diagnostic = Diagnostic::error(
                    Code::BadCoordinates,
                    item.span.clone(),
                    format!("coordinate `{name}` is listed twice"),
                );
                reader.diagnostics.push(diagnostic.label("again here").also(first.span.clone(), "first here"));
            }
            None => found.push((named, item)),
        }
    }
    let rotations: Vec<&Node> =
        found.iter().filter(|(named, _)| !named[0].is_length()).map(|(_, node)| *node).collect();
    if let [_, second] = rotations.as_slice() {
        reader.error(
            Code::BadCoordinates,
            second.span.clone(),
            "a body turns by an `angle` about z or by an `orientation`, not by both",
            None,
        );
    }
    found.into_iter().flat_map(|(named, _)| named).copied().collect()
}

fn prescribed(
    reader: &mut Reader,
    fields: &Fields,
    coordinates: &[Coordinate],
) -> (Vec<(Coordinate, Formula)>, Option<Rotation>) {
    let nothing = (Vec::new(), None);
    let Some(node) = fields.get("held") else { return nothing };
    let Some(held) = reader.fields::<keys::Held>(node, fields.key_span("held")) else { return nothing };
    let refuse = |reader: &mut Reader, name: &str| {
        let message = format!("`{name}` is a coordinate of the body, so `held` must not prescribe it");
        let help = format!("leave `{name}` out of `coordinates`, or give its start in `initial`");
        reader.error(Code::BadCoordinates, held.key_span(name), message, help);
    };
    let mut values = Vec::new();
    for (name, coordinate) in HELD {
        let Some(node) = held.get(name) else { continue };
        if coordinates.contains(&coordinate) {
            refuse(reader, name);
        }
        if coordinate == Coordinate::Z && !reader.model.space.spatial {
            reader.leaves_the_plane(node);
        }
        let dimension = if coordinate == Coordinate::Angle { Dimension::ANGLE } else { Dimension::LENGTH };
        if let Some(value) = reader.formula(node, Context::Time, dimension) {
            values.push((coordinate, value));
        }
    }
    let orientation = held.get("orientation").and_then(|node| {
        if !reader.model.space.spatial {
            reader.leaves_the_plane(node);
        }
        if let Some((name, _)) =
            COORDINATES.iter().find(|(_, named)| !named[0].is_length() && coordinates.contains(&named[0]))
        {
            refuse(reader, if *name == "angle" { "orientation" } else { name });
        }
        if held.get("angle").is_some() {
            reader.error(
                Code::ExclusiveKeys,
                held.key_span("angle"),
                "`angle` and `orientation` exclude each other",
                None,
            );
        }
        reader.rotation(node, held.key_span("orientation"))
    });
    (values, orientation)
}

fn points(reader: &mut Reader, fields: &Fields, body: usize) {
    let Some(node) = fields.get("points") else { return };
    for (index, entry) in reader.named_entries(node, "points").iter().enumerate() {
        is_name_of_point(reader, entry);
        let Some((position, rotation)) = point(reader, entry) else { continue };
        if let Some(point) = reader.model.mechanism_mut().bodies[body].points.get_mut(index) {
            point.position = position;
            point.rotation = rotation;
        }
    }
}

/// Whether a point may be called so; reported where it may not.
pub(super) fn is_name_of_point(reader: &mut Reader, entry: &Entry) -> bool {
    let named = reader.name(entry, "a point");
    if named && is_motion(&entry.key) {
        let message = format!("`{}` cannot be the name of a point: it is a part of the body's motion", entry.key);
        reader.error(Code::BadName, entry.key_span.clone(), message, None);
        return false;
    }
    named
}

/// `[x, y, z]` or `{ position: …, rotation: … }`.
pub(super) fn point(reader: &mut Reader, entry: &Entry) -> Option<([Formula; 3], Option<Rotation>)> {
    let Value::Mapping(_) = entry.value.value else {
        return Some((reader.components(&entry.value, Context::Constant, Dimension::LENGTH)?, None));
    };
    let fields = reader.fields::<keys::PointFrame>(&entry.value, entry.key_span.clone())?;
    let position = match fields.get("position") {
        Some(node) => reader.components(node, Context::Constant, Dimension::LENGTH),
        None => Some([0.0; 3].map(Formula::number)),
    };
    let Some(node) = fields.get("rotation") else { return Some((position?, None)) };
    if !reader.model.space.spatial {
        reader.leaves_the_plane(node);
    }
    let rotation = reader.rotation(node, fields.key_span("rotation"));
    Some((position?, Some(rotation?)))
}
