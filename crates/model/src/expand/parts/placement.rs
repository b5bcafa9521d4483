//! `at` and `mirror` of instances: where an assembly's ground is in the model.
//!
//! The placement of an instance is given by its parameters `at.x` and so on, in the frame of the instance that it is
//! in. Its placement in the model follows: `at.model.x`, … ([`crate::syntax::frame`]).

use std::sync::Arc;

use super::{Writer, mirror};
use crate::grammar::report::Fields;
use crate::keys;
use crate::syntax::codes::Code;
use crate::syntax::frame::{InstanceFrame, PLACE, Turned, about, about_z, product, signed, sum};
use crate::syntax::mirrors::Mirrors;
use crate::syntax::scope::Scope;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// The body that an instance's ground is.
pub const GROUND: &str = "ground";

/// Whether a name is that of an instance's ground.
pub fn is_ground(name: &str) -> bool {
    name.ends_with(".ground")
}

/// Names of axes.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// Names of the angles of `rpy`.
const ANGLES: [&str; 3] = ["roll", "pitch", "yaw"];

/// Placement of an instance, as written.
#[derive(Clone, Default)]
pub(super) struct InstancePlacement {
    mirrors: Mirrors,
    /// Its numbers with the names of their parameters behind `at.`, and their units.
    numbers: Vec<(String, Node, &'static str)>,
    /// The Euler parameters by those, where they are not those of an angle about z.
    quaternion: Option<[String; 4]>,
    pub(super) span: Span,
}

impl InstancePlacement {
    fn has(&self, name: &str) -> bool {
        self.numbers.iter().any(|(known, ..)| known == name)
    }

    /// The frame by itself.
    fn frame(&self) -> InstanceFrame {
        let turned = match self.quaternion {
            Some(_) => Turned::InSpace,
            None if self.has("angle") => Turned::ByAngle,
            None => Turned::Not,
        };
        InstanceFrame { mirrors: self.mirrors, moved: AXES.map(|axis| self.has(axis)), turned }
    }

    /// The frame in the model of an instance that is in another.
    pub fn frame_in(&self, outer: Option<InstanceFrame>) -> Option<InstanceFrame> {
        let own = self.frame();
        match outer {
            Some(outer) => Some(outer.within(own)),
            None => (own != InstanceFrame::default()).then_some(own),
        }
    }
}

impl Writer<'_, '_> {
    /// Reads where an instance is; `prefix` stands before the names of its parts.
    pub(super) fn placement(&mut self, prefix: &str, fields: &Fields) -> Option<InstancePlacement> {
        let mut placement = InstancePlacement { span: fields.at.clone(), ..InstancePlacement::default() };
        if let Some(node) = fields.get("mirror") {
            placement.mirrors = Mirrors::across(self.report.choice(node, &[("x", 0), ("y", 1), ("z", 2)])?);
            placement.span = fields.key_span("mirror");
        }
        let Some(node) = fields.get("at") else { return Some(placement) };
        placement.span = fields.key_span("at");
        let position = match &node.value {
            Value::Mapping(_) => {
                let at = self.report.fields::<keys::PlaceFile>(node, fields.key_span("at"))?;
                if at.get("angle").is_some() && at.get("rotation").is_some() {
                    self.report.error(
                        Code::ExclusiveKeys,
                        at.key_span("angle"),
                        "`angle` and `rotation` exclude each other",
                        None,
                    );
                    return None;
                }
                placement.numbers.extend(at.get("angle").map(|angle| ("angle".to_owned(), angle.clone(), "rad")));
                if let Some(rotation) = at.get("rotation") {
                    self.rotation(&mut placement, prefix, rotation, at.key_span("rotation"))?;
                }
                at.get("position").cloned()
            }
            _ => Some(node.clone()),
        };
        if let Some(position) = position {
            match &position.value {
                Value::Sequence(items) if (2..=3).contains(&items.len()) => {
                    let named = AXES.into_iter().zip(items).map(|(axis, item)| (axis.to_owned(), item.clone(), "m"));
                    placement.numbers.extend(named);
                }
                _ => {
                    let help = "e.g. `at: [0.5 m, 0]`, or `at: { position: [0.5 m, 0], angle: 30 deg }`".to_owned();
                    let message =
                        format!("a position of two or three numbers belongs here, but here is {}", position.kind());
                    self.report.error(Code::WrongShape, position.span.clone(), message, help);
                    return None;
                }
            }
        }
        Some(placement)
    }

    /// Reads the rotation of a placement; its numbers are parameters, too.
    fn rotation(&mut self, placement: &mut InstancePlacement, prefix: &str, node: &Node, at: Span) -> Option<()> {
        let (kind, fields) = self.report.kind_of_rotation(node, at)?;
        let value = fields.get(kind)?;
        let own = |name: &str| format!("{prefix}at.{name}");
        let mut list = |names: &[&str], unit| {
            let items = self.report.list_of(value, names.len())?;
            let numbers = names.iter().zip(items).map(|(name, item)| ((*name).to_owned(), item.clone(), unit));
            placement.numbers.extend(numbers);
            Some(())
        };
        placement.quaternion = Some(match kind {
            "rpy" => {
                list(&ANGLES, "rad")?;
                let [roll, pitch, yaw] = [0, 1, 2].map(|axis| about(axis, &own(ANGLES[axis])));
                product(&yaw, &product(&pitch, &roll))
            }
            "axis" => return self.about_axis(placement, prefix, &fields, value),
            _ => {
                let names = ["p0", "p1", "p2", "p3"];
                list(&names, "")?;
                let p = names.map(own);
                let length = format!("sqrt({}^2 + {}^2 + {}^2 + {}^2)", p[0], p[1], p[2], p[3]);
                p.map(|name| format!("{name}/{length}"))
            }
        });
        Some(())
    }

    /// Reads a rotation about an axis; that about z is an angle, as in the plane.
    fn about_axis(
        &mut self,
        placement: &mut InstancePlacement,
        prefix: &str,
        fields: &Fields,
        axis: &Node,
    ) -> Option<()> {
        let angle = self.report.required(fields, "angle")?;
        placement.numbers.push(("angle".to_owned(), angle.clone(), "rad"));
        let angle = format!("{prefix}at.angle");
        if let Some(letter) = axis.scalar().and_then(|scalar| AXES.iter().position(|axis| *axis == scalar.text)) {
            placement.quaternion = (letter < 2).then(|| about(letter, &angle));
            return Some(());
        }
        let Value::Sequence(items) = &axis.value else {
            let message = format!("`x`, `y`, `z` or a list of three numbers belongs here, but here is {}", axis.kind());
            self.report.error(Code::WrongShape, axis.span.clone(), message, None);
            return None;
        };
        self.report.list_of(axis, 3)?;
        if items.iter().all(|item| item.scalar().is_some_and(|scalar| scalar.text.parse() == Ok(0.0))) {
            self.report.error(
                Code::ZeroDirection,
                axis.span.clone(),
                "a direction of length zero points nowhere",
                None,
            );
            return None;
        }
        let names = AXES.map(|axis| format!("axis_{axis}"));
        let numbers = names.iter().zip(items).map(|(name, item)| (name.clone(), item.clone(), ""));
        placement.numbers.extend(numbers);
        let [x, y, z] = names.map(|name| format!("{prefix}at.{name}"));
        let part = |component: &String| format!("{component}*sin({angle}/2)/sqrt({x}^2 + {y}^2 + {z}^2)");
        placement.quaternion = Some([format!("cos({angle}/2)"), part(&x), part(&y), part(&z)]);
        Some(())
    }

    /// The parameters that say where an instance is: `front_left.at.x` as it says itself, `front_left.at.model.x` in
    /// the model.
    pub(super) fn parameters_of(
        &mut self,
        prefix: &str,
        placement: &InstancePlacement,
        outer: Option<&Scope>,
        frame: Option<InstanceFrame>,
    ) {
        for (key, node, unit) in &placement.numbers {
            let span = node.span.clone();
            let field = |key: &str, value: Node| Entry { key: key.to_owned(), key_span: span.clone(), value };
            let mut fields = vec![field("value", node.clone())];
            if !unit.is_empty() {
                fields.push(field("unit", plain(unit, &span)));
            }
            let value = Node { span: span.clone(), value: Value::Mapping(fields) };
            self.add("parameters", Entry { key: format!("{prefix}at.{key}"), key_span: span, value });
        }
        let Some(frame) = frame else { return };
        for (key, text) in in_model(placement, prefix, outer, frame) {
            let span = placement.span.clone();
            let entry =
                Entry { key: format!("{prefix}{PLACE}{key}"), key_span: span.clone(), value: plain(&text, &span) };
            self.add("parameters", entry);
        }
    }

    /// The body that the instance's ground is, with the points that the assembly gives it.
    pub(super) fn ground(&mut self, prefix: &str, at: &Span, points: Option<Node>, scope: &Arc<Scope>) {
        let field = |key: &str, value: Node| Entry { key: key.to_owned(), key_span: at.clone(), value };
        let name = |text: &str| scalar(text, scope, at);
        let frame = scope.frame().unwrap_or_default();
        let sequence = |items: Vec<Node>| Node { span: at.clone(), value: Value::Sequence(items) };
        let mapping = |entries: Vec<Entry>| Node { span: at.clone(), value: Value::Mapping(entries) };
        let origin = frame.origin(PLACE);
        let coordinates = AXES.into_iter().zip(&origin).filter(|(_, origin)| *origin != "0");
        let mut held: Vec<Entry> = coordinates.map(|(axis, origin)| field(axis, name(origin))).collect();
        match frame.turned {
            Turned::Not => {}
            Turned::ByAngle => held.push(field("angle", name(&format!("{PLACE}angle")))),
            Turned::InSpace => {
                let p = frame.quaternion(PLACE).map(|p| name(&p));
                held.push(field("orientation", mapping(vec![field("quaternion", sequence(p.into()))])));
            }
        }
        let mut keys = vec![field("coordinates", sequence(Vec::new())), field("held", mapping(held))];
        if let Some(mut points) = points {
            if let Value::Mapping(points) = &mut points.value {
                points
                    .iter_mut()
                    .for_each(|point| frame.mirrors.axes().for_each(|axis| mirror::point(&mut point.value, axis)));
            }
            keys.push(field("points", points));
        }
        self.add("bodies", field(&format!("{prefix}{GROUND}"), mapping(keys)));
    }
}

/// The parameters of an instance's frame in the model, with their formulas.
fn in_model(
    placement: &InstancePlacement,
    prefix: &str,
    outer: Option<&Scope>,
    frame: InstanceFrame,
) -> Vec<(String, String)> {
    let own = placement.frame();
    let (around, place) = outer.and_then(|outer| Some((outer.frame()?, outer.full(PLACE)))).unwrap_or_default();
    // The position of an image is the image of the position.
    let position = [0, 1, 2].map(|axis| {
        let text = if own.moved[axis] { format!("{prefix}at.{}", AXES[axis]) } else { "0".to_owned() };
        signed(&text, around.mirrors.flips(axis))
    });
    let (origin, seen) = (around.origin(&place), around.turn(&place, &position));
    let mut parameters = Vec::new();
    for axis in (0..3).filter(|&axis| frame.moved[axis]) {
        parameters.push((AXES[axis].to_owned(), sum([origin[axis].clone(), seen[axis].clone()].iter())));
    }
    let angle = format!("{prefix}at.angle");
    match frame.turned {
        Turned::Not => {}
        Turned::ByAngle => {
            let outer = if around.is_turned() { format!("{place}angle") } else { "0".to_owned() };
            let inner = if own.is_turned() { signed(&angle, around.mirrors.turns_back(2)) } else { "0".to_owned() };
            parameters.push(("angle".to_owned(), sum([outer, inner].iter())));
        }
        Turned::InSpace => {
            let inner = match (&placement.quaternion, own.turned) {
                (Some(p), _) => p.clone(),
                (None, Turned::ByAngle) => about_z(&angle),
                _ => InstanceFrame::default().quaternion(""),
            };
            let [p0, x, y, z] = inner;
            let image = [(x, 0), (y, 1), (z, 2)].map(|(text, axis)| signed(&text, around.mirrors.turns_back(axis)));
            let [x, y, z] = image;
            let p = product(&around.quaternion(&place), &[p0, x, y, z]);
            parameters.extend((0..4).zip(p).map(|(index, text)| (format!("p{index}"), text)));
        }
    }
    parameters
}

/// A text without quotes.
fn plain(text: &str, span: &Span) -> Node {
    Node { span: span.clone(), value: Value::Scalar(Scalar::plain(text, None)) }
}

/// The same whose names are those of an instance.
pub(super) fn scalar(text: &str, scope: &Arc<Scope>, span: &Span) -> Node {
    let scalar = Scalar { scope: Some(Arc::clone(scope)), ..Scalar::plain(text, None) };
    Node { span: span.clone(), value: Value::Scalar(scalar) }
}
