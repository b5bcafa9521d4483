//! `bodies:`, and references to bodies and their points.

use symdiff::Formula;

use super::description::{Body, Coordinate, Point, PointRef};
use super::diagnostic::Diagnostic;
use super::file;
use super::names::{Context, GROUND, MOTIONS};
use super::quantity::Dimension;
use super::reader::{Fields, Reader};
use super::suggest::{self, clip};
use super::yaml::{Entry, Node, Value};

const COORDINATES: [(&str, Coordinate); 3] = [("x", Coordinate::X), ("y", Coordinate::Y), ("angle", Coordinate::Angle)];

/// Notes the names of the bodies and of their points, so that anything can refer to them.
pub fn declare(reader: &mut Reader, entries: &[Entry]) {
    let empty = |name: &str| Body {
        name: name.to_owned(),
        mass: None,
        inertia: None,
        center_of_mass: None,
        coordinates: Vec::new(),
        held: Vec::new(),
        points: Vec::new(),
    };
    reader.model.bodies.push(empty(GROUND));
    for entry in entries {
        reader.name(entry, "a body");
        let mut body = empty(&entry.key);
        if let Value::Mapping(fields) = &entry.value.value
            && let Some(points) = fields.iter().find(|field| field.key == "points")
            && let Value::Mapping(points) = &points.value.value
        {
            let unknown = || [Formula::number(0.0), Formula::number(0.0)];
            body.points = points.iter().map(|point| Point { name: point.key.clone(), position: unknown() }).collect();
        }
        if entry.key == GROUND {
            reader.model.bodies[0] = body;
        } else {
            reader.model.bodies.push(body);
        }
    }
}

/// Reads the bodies that were declared.
pub fn read(reader: &mut Reader, entries: &[Entry]) {
    let mut next = 1;
    for entry in entries {
        if entry.key == GROUND {
            ground(reader, entry);
        } else {
            body(reader, entry, next);
            next += 1;
        }
    }
}

fn ground(reader: &mut Reader, entry: &Entry) {
    let Some(fields) = reader.fields::<file::Body>(&entry.value, entry.key_span.clone()) else { return };
    for key in ["mass", "inertia", "center_of_mass", "coordinates", "held"] {
        if fields.get(key).is_some() {
            let help = "the ground does not move; it can be given `points` only".to_owned();
            reader.error(fields.key_span(key), format!("the ground has no `{key}`"), help);
        }
    }
    points(reader, &fields, 0);
}

fn body(reader: &mut Reader, entry: &Entry, index: usize) {
    let Some(fields) = reader.fields::<file::Body>(&entry.value, entry.key_span.clone()) else { return };
    let coordinates = match fields.get("coordinates") {
        Some(node) => coordinates(reader, node),
        None => COORDINATES.iter().map(|(_, coordinate)| *coordinate).collect(),
    };
    let turns = coordinates.contains(&Coordinate::Angle);
    let translates = coordinates.contains(&Coordinate::X) || coordinates.contains(&Coordinate::Y);
    let off_center = fields.get("center_of_mass").is_some();

    let positive = |reader: &mut Reader, key: &str, dimension: Dimension, needed: bool| {
        let node = if needed { reader.required(&fields, key) } else { fields.get(key) }?;
        if needed {
            reader.formula_that(node, Context::Constant, dimension, |value| value > 0.0, "must be positive")
        } else {
            reader.formula_that(node, Context::Constant, dimension, |value| value >= 0.0, "must not be negative")
        }
    };
    let mass = positive(reader, "mass", Dimension::MASS, translates || turns && off_center);
    let inertia = positive(reader, "inertia", Dimension::INERTIA, turns);
    let center = fields.get("center_of_mass").and_then(|node| reader.pair(node, Context::Constant, Dimension::LENGTH));
    let held = held(reader, &fields, &coordinates);
    points(reader, &fields, index);

    let body = &mut reader.model.bodies[index];
    body.mass = mass;
    body.inertia = inertia;
    body.center_of_mass = center;
    body.coordinates = coordinates;
    body.held = held;
}

fn coordinates(reader: &mut Reader, node: &Node) -> Vec<Coordinate> {
    let Value::Sequence(items) = &node.value else {
        let message = format!("coordinates are a list, but here is {}", node.kind());
        reader.error(node.span.clone(), message, "write `[x, y, angle]`, or fewer of them".to_owned());
        return COORDINATES.iter().map(|(_, coordinate)| *coordinate).collect();
    };
    if items.is_empty() {
        let help = format!("what does not move is part of the ground: give `{GROUND}` the points");
        reader.error(node.span.clone(), "a body has at least one coordinate", help);
    }
    let mut found: Vec<(Coordinate, &Node)> = Vec::new();
    for item in items {
        let Some(coordinate) = reader.choice(item, &COORDINATES) else { continue };
        match found.iter().find(|(known, _)| *known == coordinate) {
            Some((_, first)) => {
                let name = item.scalar().map_or("", |scalar| scalar.text.as_str());
                let diagnostic = Diagnostic::error(item.span.clone(), format!("coordinate `{name}` is listed twice"));
                reader.diagnostics.push(diagnostic.label("again here").also(first.span.clone(), "first here"));
            }
            None => found.push((coordinate, item)),
        }
    }
    found.into_iter().map(|(coordinate, _)| coordinate).collect()
}

fn held(reader: &mut Reader, fields: &Fields, coordinates: &[Coordinate]) -> Vec<(Coordinate, Formula)> {
    let Some(node) = fields.get("held") else { return Vec::new() };
    let Some(held) = reader.fields::<file::Held>(node, fields.key_span("held")) else { return Vec::new() };
    let mut values = Vec::new();
    for (name, coordinate) in COORDINATES {
        let Some(node) = held.get(name) else { continue };
        if coordinates.contains(&coordinate) {
            let message = format!("`{name}` is a coordinate of the body, so it is not held");
            let help = format!("leave `{name}` out of `coordinates`, or give its start in `initial`");
            reader.error(held.key_span(name), message, help);
        }
        let dimension = if coordinate == Coordinate::Angle { Dimension::ANGLE } else { Dimension::LENGTH };
        if let Some(value) = reader.formula(node, Context::Constant, dimension) {
            values.push((coordinate, value));
        }
    }
    values
}

fn points(reader: &mut Reader, fields: &Fields, body: usize) {
    let Some(node) = fields.get("points") else { return };
    for (index, entry) in reader.entries(node, "points").iter().enumerate() {
        if reader.name(entry, "a point") && MOTIONS.iter().any(|(motion, ..)| *motion == entry.key) {
            let message = format!("`{}` cannot be the name of a point: it is a part of the body's motion", entry.key);
            reader.error(entry.key_span.clone(), message, None);
        }
        if let Some(position) = reader.pair(&entry.value, Context::Constant, Dimension::LENGTH)
            && let Some(point) = reader.model.bodies[body].points.get_mut(index)
        {
            point.position = position;
        }
    }
}

impl Reader<'_> {
    /// The body that is named.
    pub fn body_ref(&mut self, node: &Node) -> Option<usize> {
        let scalar = self.scalar(node, "the name of a body")?;
        let name = scalar.text.as_str();
        let (body, rest) = name.split_once('.').unwrap_or((name, ""));
        let index = self.find_body(node, body)?;
        if !rest.is_empty() {
            let message = format!("`{}` is a point, but a body belongs here", clip(name));
            self.error(node.span.clone(), message, format!("write `{body}`"));
            return None;
        }
        Some(index)
    }

    /// The point that is named: `body.point`, or `body` for the origin of its frame.
    pub fn point_ref(&mut self, node: &Node) -> Option<PointRef> {
        let scalar = self.scalar(node, "`body` or `body.point`")?;
        let Some((name, point)) = scalar.text.split_once('.') else {
            return Some(PointRef { body: self.find_body(node, &scalar.text)?, point: None });
        };
        let body = self.find_body(node, name)?;
        let points: Vec<&str> = self.model.bodies[body].points.iter().map(|point| point.name.as_str()).collect();
        if let Some(found) = points.iter().position(|known| *known == point) {
            return Some(PointRef { body, point: Some(found) });
        }
        let help = if points.is_empty() {
            Some(format!("`{name}` has no points; give it some with `points`, or write `{name}` for its origin"))
        } else {
            suggest::help(point, &format!("points of `{name}`"), points)
        };
        let place = scalar.place(&node.span, name.len() + 1..scalar.text.len());
        self.error(place, format!("body `{name}` has no point `{}`", clip(point)), help);
        None
    }

    fn find_body(&mut self, node: &Node, name: &str) -> Option<usize> {
        let bodies = || self.model.bodies.iter().map(|body| body.name.as_str());
        if let Some(found) = bodies().position(|known| known == name) {
            return Some(found);
        }
        let help = suggest::help(name, "bodies", bodies());
        let place = node.scalar().map_or_else(|| node.span.clone(), |scalar| scalar.place(&node.span, 0..name.len()));
        self.error(place, format!("unknown body `{}`", clip(name)), help);
        None
    }

    /// Two points of different bodies.
    pub fn between_points(&mut self, node: &Node) -> Option<[PointRef; 2]> {
        let [first, second] = self.two(node, "a list of two points")?;
        let (a, b) = (self.point_ref(first), self.point_ref(second));
        let (a, b) = (a?, b?);
        self.different(second, a.body, b.body).then_some([a, b])
    }

    /// Two different bodies.
    pub fn between_bodies(&mut self, node: &Node) -> Option<[usize; 2]> {
        let [first, second] = self.two(node, "a list of two bodies")?;
        let (a, b) = (self.body_ref(first), self.body_ref(second));
        let (a, b) = (a?, b?);
        self.different(second, a, b).then_some([a, b])
    }

    fn different(&mut self, node: &Node, a: usize, b: usize) -> bool {
        if a == b {
            let message = format!("both ends are on `{}`", self.model.bodies[a].name);
            self.error(node.span.clone(), message, "name two different bodies".to_owned());
        }
        a != b
    }
}
