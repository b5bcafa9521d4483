//! `at` and `mirror` of instances: where an assembly's ground is in the model, and where its bodies start.

use std::sync::Arc;

use super::{Writer, mirror};
use crate::grammar::reader::Fields;
use crate::model::file;
use crate::syntax::scope::Scope;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// The body that an instance's ground is.
pub const GROUND: &str = "ground";

/// Whether a name is that of an instance's ground.
pub fn is_ground(name: &str) -> bool {
    name.ends_with(".ground")
}

/// Parameters of the place.
const PLACE: [&str; 3] = ["x", "y", "z"];

/// Where an instance is.
#[derive(Clone, Default)]
pub(super) struct Placement {
    /// The axis across which it is mirrored.
    pub(super) mirror: Option<usize>,
    /// Components of its position.
    position: Vec<Node>,
    /// In the plane.
    angle: Option<Node>,
    /// In space.
    rotation: Option<Node>,
    span: Span,
}

impl Placement {
    /// Whether it has a ground of its own.
    pub fn is_one(&self) -> bool {
        self.mirror.is_some() || !self.position.is_empty() || self.turns()
    }

    /// The axis of the mirror.
    pub fn mirror(&self) -> Option<usize> {
        self.mirror
    }

    /// Whether directions of the ground are others.
    pub fn turns(&self) -> bool {
        self.angle.is_some() || self.rotation.is_some()
    }
}

impl Writer<'_, '_> {
    /// Reads where an instance is.
    pub(super) fn placement(&mut self, fields: &Fields) -> Option<Placement> {
        let mut placement = Placement { span: fields.at.clone(), ..Placement::default() };
        if let Some(node) = fields.get("mirror") {
            placement.mirror = Some(self.reader.choice(node, &[("x", 0), ("y", 1), ("z", 2)])?);
            placement.span = fields.key_span("mirror");
        }
        let Some(node) = fields.get("at") else { return Some(placement) };
        placement.span = fields.key_span("at");
        let position = match &node.value {
            Value::Mapping(_) => {
                let at = self.reader.fields::<file::PlaceFile>(node, fields.key_span("at"))?;
                placement.angle = at.get("angle").cloned();
                placement.rotation = at.get("rotation").cloned();
                if placement.turns() && at.get("angle").is_some() && at.get("rotation").is_some() {
                    self.reader.error(at.key_span("angle"), "`angle` and `rotation` exclude each other", None);
                    return None;
                }
                at.get("position").cloned()
            }
            _ => Some(node.clone()),
        };
        if let Some(position) = position {
            match &position.value {
                Value::Sequence(items) if (2..=3).contains(&items.len()) => placement.position.clone_from(items),
                _ => {
                    let help = "e.g. `at: [0.5 m, 0]`, or `at: { position: [0.5 m, 0], angle: 30 deg }`".to_owned();
                    let message =
                        format!("a position of two or three numbers belongs here, but here is {}", position.kind());
                    self.reader.error(position.span.clone(), message, help);
                    return None;
                }
            }
        }
        Some(placement)
    }

    /// The parameters that say where an instance is: `front_left.at.x`.
    pub(super) fn parameters_of(&mut self, prefix: &str, placement: &Placement) {
        let position = PLACE.into_iter().zip(&placement.position).map(|(axis, node)| (axis, node, "m"));
        let angle = placement.angle.iter().map(|node| ("angle", node, "rad"));
        let all: Vec<_> = position.chain(angle).map(|(key, node, unit)| (key, node.clone(), unit)).collect();
        for (key, node, unit) in all {
            let span = node.span.clone();
            let unit = Node { span: span.clone(), value: Value::Scalar(Scalar::plain(unit, None)) };
            let field = |key: &str, value: Node| Entry { key: key.to_owned(), key_span: span.clone(), value };
            let value = Value::Mapping(vec![field("value", node), field("unit", unit)]);
            let key = format!("{prefix}at.{key}");
            self.add("parameters", Entry { key, key_span: span.clone(), value: Node { span: span.clone(), value } });
        }
    }

    /// The body that the instance's ground is, with the points that the assembly gives it.
    pub(super) fn ground(&mut self, prefix: &str, placement: &Placement, points: Option<Node>, scope: &Arc<Scope>) {
        let at = placement.span.clone();
        let field = |key: &str, value: Node| Entry { key: key.to_owned(), key_span: at.clone(), value };
        let name = |key: &str| scalar(&format!("at.{key}"), scope, &at);
        let mut held: Vec<Entry> =
            PLACE.into_iter().take(placement.position.len()).map(|axis| field(axis, name(axis))).collect();
        held.extend(placement.angle.iter().map(|_| field("angle", name("angle"))));
        held.extend(placement.rotation.iter().map(|rotation| field("orientation", rotation.clone())));
        let mapping = |entries: Vec<Entry>| Node { span: at.clone(), value: Value::Mapping(entries) };
        let none = Node { span: at.clone(), value: Value::Sequence(Vec::new()) };
        let mut keys = vec![field("coordinates", none), field("held", mapping(held))];
        if let Some(mut points) = points {
            if let (Some(axis), Value::Mapping(points)) = (placement.mirror(), &mut points.value) {
                points.iter_mut().for_each(|point| mirror::frame(&mut point.value, axis));
            }
            keys.push(field("points", points));
        }
        self.add("bodies", field(&format!("{prefix}{GROUND}"), mapping(keys)));
    }

    /// The start values of an instance's bodies in the model's frame, by their names in the instance; `bodies` are its bodies.
    pub(super) fn start(
        &mut self,
        placement: &Placement,
        entries: Vec<Entry>,
        bodies: &[String],
        scope: &Arc<Scope>,
    ) -> Vec<Entry> {
        let all = entries.clone();
        let value_of = |body: &str, coordinate: &str| {
            all.iter().find(|entry| entry.key == format!("{body}.{coordinate}")).map(|entry| entry.value.clone())
        };
        let mut written = Vec::with_capacity(entries.len());
        for mut entry in entries {
            let Some((owner, coordinate)) = entry.key.rsplit_once('.').map(|(a, b)| (a.to_owned(), b.to_owned()))
            else {
                written.push(entry);
                continue;
            };
            let is_part = |rest: &&str| rest.is_empty() || rest.starts_with('.');
            let part = bodies.iter().find_map(|body| owner.strip_prefix(body.as_str()).filter(is_part));
            let Some(part) = part else {
                // Of a joint: its angle counts the other way.
                if placement.mirror.is_some() && matches!(coordinate.as_str(), "angle" | "angular_velocity") {
                    mirror::negate(&mut entry.value);
                }
                written.push(entry);
                continue;
            };
            // `omega` and `omega_body`, whole or by their parts.
            let rate = part.strip_prefix('.').unwrap_or(&coordinate);
            if rate == "omega_body" || rate == "omega" && !placement.turns() {
                match placement.mirror {
                    Some(axis) if part.is_empty() => mirror::axial(&mut entry.value, axis),
                    Some(axis) if coordinate != PLACE[axis] => mirror::negate(&mut entry.value),
                    _ => {}
                }
                written.push(entry);
                continue;
            }
            let is_absolute =
                matches!(coordinate.as_str(), "x" | "y" | "z" | "vx" | "vy" | "vz" | "angle" | "angular_velocity");
            let turned = placement.rotation.is_some() || placement.angle.is_some() && !is_absolute;
            if turned || !is_absolute && coordinate != "orientation" && placement.mirror.is_some() {
                let message = format!("`{}` is in the ground's frame, which is turned or mirrored here", entry.key);
                let help = "give the coordinates of joints".to_owned();
                self.reader.error(entry.key_span.clone(), message, help);
                continue;
            }
            if let Some(axis) = placement.mirror {
                match coordinate.as_str() {
                    "orientation" => mirror::rotation(&mut entry.value, axis),
                    _ if mirror::counts_back(&coordinate, axis) => mirror::negate(&mut entry.value),
                    _ => {}
                }
            }
            if is_absolute {
                let other = match coordinate.as_str() {
                    "x" => value_of(&owner, "y"),
                    "y" => value_of(&owner, "x"),
                    "vx" => value_of(&owner, "vy"),
                    "vy" => value_of(&owner, "vx"),
                    _ => None,
                };
                let other = other.map(|mut node| {
                    if let Some(axis) = placement.mirror
                        && mirror::counts_back(other_of(&coordinate), axis)
                    {
                        mirror::negate(&mut node);
                    }
                    node
                });
                self.moved(placement, &mut entry, &coordinate, other.as_ref(), scope);
            }
            written.push(entry);
        }
        written
    }

    /// A start value of a body in the model's frame.
    fn moved(
        &mut self,
        placement: &Placement,
        entry: &mut Entry,
        coordinate: &str,
        other: Option<&Node>,
        scope: &Arc<Scope>,
    ) {
        let Some(own) = text(&entry.value) else { return };
        let place = match coordinate {
            "x" | "y" | "z" => PLACE.iter().take(placement.position.len()).any(|axis| *axis == coordinate),
            "angle" => placement.angle.is_some(),
            _ => false,
        };
        let mut value = own.clone();
        if placement.angle.is_some() && matches!(coordinate, "x" | "y" | "vx" | "vy") {
            let Some(other) = other.and_then(text) else {
                let message =
                    format!("`{}` is given without `{}`, but the instance is turned", entry.key, other_of(coordinate));
                let help = "give both, or the coordinates of joints".to_owned();
                self.reader.error(entry.key_span.clone(), message, help);
                return;
            };
            let sign = if coordinate.ends_with('x') { '-' } else { '+' };
            value = format!("cos(at.angle)*({own}) {sign} sin(at.angle)*({other})");
        }
        if place {
            value = format!("at.{coordinate} + ({value})");
        }
        if value != own {
            let scope =
                entry.value.scalar().and_then(|scalar| scalar.scope.clone()).unwrap_or_else(|| Arc::clone(scope));
            let scope = Arc::new(scope.with_sign(false));
            entry.value = scalar(&value, &scope, &entry.value.span);
        }
    }
}

fn other_of(coordinate: &str) -> &'static str {
    match coordinate {
        "x" => "y",
        "y" => "x",
        "vx" => "vy",
        _ => "vx",
    }
}

/// The formula of a number, its sign included.
fn text(node: &Node) -> Option<String> {
    let scalar = node.scalar()?;
    let is_negated = scalar.scope.as_ref().is_some_and(|scope| scope.is_negated());
    Some(if is_negated { format!("-({})", scalar.text) } else { scalar.text.clone() })
}

fn scalar(text: &str, scope: &Arc<Scope>, span: &Span) -> Node {
    let scalar = Scalar { scope: Some(Arc::clone(scope)), ..Scalar::plain(text, None) };
    Node { span: span.clone(), value: Value::Scalar(scalar) }
}
