//! References to bodies, points and joints by their names.

use super::mentions::NameKind;
use super::names;
use super::reader::Reader;
use super::report::Fields;
use super::rotating::Rotating;
use super::symbols::{JointCoordinate, OnJoint, PointRef, SymbolTable};
use crate::syntax::codes::Code;
use crate::syntax::frame::Turned;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Node, Value};

impl<S: SymbolTable> Reader<'_, S> {
    /// Reads the name of a body.
    pub fn body_ref(&mut self, node: &Node) -> Option<usize> {
        let scalar = self.scalar(node, "the name of a body")?;
        self.mentions_node(Some(NameKind::Body), node);
        let name = &*scalar.name();
        if let Some(body) = self.model.body(name) {
            return Some(body);
        }
        if let Some(port) = self.model.port(name)
            && let Some(body) = self.model.body(port)
        {
            return Some(body);
        }
        let (body, rest) = self.owner(name);
        let index = self.find_body(node, body)?;
        if !rest.is_empty() {
            let message = format!("`{}` is a point, but a body belongs here", clip(name));
            self.error(Code::WrongShape, node.span.clone(), message, format!("write `{body}`"));
            return None;
        }
        Some(index)
    }

    /// Reads the name of a point: `body.point`, or `body` for the origin of its frame.
    pub fn point_ref(&mut self, node: &Node) -> Option<PointRef> {
        let scalar = self.scalar(node, "`body` or `body.point`")?;
        self.mentions_node(Some(NameKind::Body), node);
        let text = &*scalar.name();
        if let Some(index) = self.model.link(text.strip_prefix("link.").unwrap_or(text)) {
            return Some(index);
        }
        if let Some(index) = self.point_of_body(text) {
            return Some(index);
        }
        if let Some(body) = self.model.body(text) {
            return Some(PointRef { body, point: None });
        }
        if let Some(index) = self.model.port(text).and_then(|_| names::place(&self.model, text)) {
            return Some(index);
        }
        let (name, point) = self.owner(text);
        if self.is_instance(name) && !point.is_empty() {
            self.unknown_port(node, name, point);
            return None;
        }
        let body = self.find_body(node, name)?;
        if point.is_empty() {
            return Some(PointRef { body, point: None });
        }
        let points: Vec<&str> = self.model.points(body).collect();
        if let Some(found) = points.iter().position(|known| *known == point) {
            return Some(PointRef { body, point: Some(found) });
        }
        let help = if points.is_empty() {
            Some(format!("`{name}` has no points; give it some with `points`, or write `{name}` for its origin"))
        } else {
            suggest::help(point, &format!("points of `{name}`"), points)
        };
        let index = scalar.place_of_name(&node.span, name.len() + 1..text.len());
        self.error(Code::UnknownName, index, format!("body `{name}` has no point `{}`", clip(point)), help);
        None
    }

    /// Looks up `body.point`, the form of most points, before any other form of a name.
    fn point_of_body(&self, text: &str) -> Option<PointRef> {
        let (name, point) = text.split_once('.')?;
        let body = self.model.body(name)?;
        let point = self.model.points(body).position(|known| known == point)?;
        Some(PointRef { body, point: Some(point) })
    }

    /// Splits a name into its owner and the rest. In an instance the owner is all but the last part, else the first
    /// part.
    fn owner<'n>(&self, name: &'n str) -> (&'n str, &'n str) {
        let first = name.split_once('.').unwrap_or((name, ""));
        let in_instance = || self.model.instances().any(|known| name.starts_with(&format!("{known}.")));
        if !first.1.is_empty() && in_instance() { name.rsplit_once('.').unwrap_or(first) } else { first }
    }

    fn is_instance(&self, name: &str) -> bool {
        self.model.instances().any(|known| known == name)
    }

    /// Reports that an instance has no such port and no such body.
    fn unknown_port(&mut self, node: &Node, instance: &str, name: &str) {
        let known: Vec<String> = self.model.parts_of(instance);
        let help = suggest::help(name, "ports and bodies of it", known.iter().map(String::as_str));
        let message = format!("instance `{instance}` has no port or body `{}`", clip(name));
        self.error(Code::UnknownName, node.span.clone(), message, help);
    }

    fn find_body(&mut self, node: &Node, name: &str) -> Option<usize> {
        if let Some(found) = self.model.body(name) {
            return Some(found);
        }
        let bodies = || self.model.bodies();
        // Braces that could not be filled in.
        let filled = node.scalar().filter(|_| name.contains('{')).and_then(|scalar| scalar.filled().err());
        if let Some(error) = filled {
            self.error(Code::BadRepetition, node.span.clone(), error.message, error.help);
            return None;
        }
        let (message, help) = match self.model.parts_of_beam(name) {
            Some(parts) => (format!("`{name}` is a beam, but one of its nodes belongs here"), Some(parts)),
            None => (format!("unknown body `{}`", clip(name)), suggest::help(name, "bodies", bodies())),
        };
        let place =
            node.scalar().map_or_else(|| node.span.clone(), |scalar| scalar.place_of_name(&node.span, 0..name.len()));
        self.error(Code::UnknownName, place, message, help);
        None
    }

    /// Two points of different bodies.
    pub fn between_points(&mut self, node: &Node) -> Option<[PointRef; 2]> {
        let [first, second] = self.two(node, "a list of two points")?;
        let (a, b) = (self.point_ref(first), self.point_ref(second));
        let (a, b) = (a?, b?);
        self.different(second, a.body, b.body).then_some([a, b])
    }

    /// A list of points.
    pub fn points(&mut self, node: &Node) -> Option<Vec<PointRef>> {
        let Value::Sequence(items) = &node.value else {
            let message = format!("a list of points belongs here, but here is {}", node.kind());
            self.error(Code::WrongShape, node.span.clone(), message, None);
            return None;
        };
        let points: Vec<_> = items.iter().map(|item| self.point_ref(item)).collect();
        points.into_iter().collect()
    }

    /// Reads the name of a joint that has this coordinate.
    pub fn joint_ref(&mut self, node: &Node, coordinate: JointCoordinate) -> Option<usize> {
        let scalar = self.scalar(node, "the name of a joint")?;
        self.mentions_node(Some(NameKind::Joint), node);
        let name = &*scalar.name();
        let Some(found) = self.model.joint(name) else {
            let help = suggest::help(name, "joints", self.model.joints());
            self.error(Code::UnknownName, node.span.clone(), format!("unknown joint `{}`", clip(name)), help);
            return None;
        };
        if !self.model.has_coordinate(found, coordinate) && self.unread_joints.iter().any(|unread| unread == name) {
            return None;
        }
        if !self.model.has_coordinate(found, coordinate) {
            let (what, help) = match coordinate {
                JointCoordinate::Angle => {
                    ("turns", "revolute, cylindrical, screw and planar joints turn about their axis")
                }
                JointCoordinate::Displacement => {
                    ("slides", "prismatic, cylindrical and screw joints slide along theirs")
                }
            };
            self.error(
                Code::UnsuitableJoint,
                node.span.clone(),
                format!("`{}` is no joint that {what}", clip(name)),
                help.to_owned(),
            );
            return None;
        }
        Some(found)
    }

    /// Whether a node names a joint and no body.
    pub fn names_joint(&self, node: &Node) -> bool {
        let Some(scalar) = node.scalar() else { return false };
        let name = &*scalar.name();
        self.model.joint(name).is_some() && self.model.body(name).is_none()
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
            let message = format!("both ends are on `{}`", self.model.body_name(a));
            self.error(Code::SameBody, node.span.clone(), message, "name two different bodies".to_owned());
        }
        a != b
    }

    /// Reads the joint of `on`, and its coordinate: that of `coordinate`, else the displacement if the joint only
    /// slides, else the angle.
    pub fn on_joint(&mut self, fields: &Fields) -> Option<OnJoint> {
        let coordinate = fields.get("coordinate").map(|node| {
            let names = [("angle", JointCoordinate::Angle), ("displacement", JointCoordinate::Displacement)];
            self.choice(node, &names)
        });
        let node = self.required(fields, "on");
        let coordinate = match coordinate {
            Some(coordinate) => coordinate?,
            None => {
                let joint = node.and_then(Node::scalar).and_then(|name| self.model.joint(&name.name()));
                let has = |coordinate| joint.is_some_and(|joint| self.model.has_coordinate(joint, coordinate));
                let slides = has(JointCoordinate::Displacement) && !has(JointCoordinate::Angle);
                if slides { JointCoordinate::Displacement } else { JointCoordinate::Angle }
            }
        };
        let joint = self.joint_ref(node?, coordinate)?;
        Some(OnJoint { joint, coordinate })
    }

    /// Index of the ground that a name refers to: the model's, or that of a turned instance.
    fn ground_of(&self, node: &Node) -> usize {
        let scope = node.scalar().and_then(|scalar| scalar.scope.as_deref());
        let turned = scope.filter(|scope| scope.frame().is_some_and(|frame| frame.turned == Turned::ByAngle));
        turned.and_then(|scope| self.model.body(&scope.full("ground"))).unwrap_or(0)
    }

    /// Reads two bodies with angles, or two joints with angles.
    pub fn two_rotating(&mut self, node: &Node) -> Option<[Rotating; 2]> {
        let pair = self.two(node, "a list of two bodies or joints")?;
        if !pair.iter().any(|node| self.names_joint(node)) {
            let bodies = self.between_bodies(node)?;
            for (body, node) in bodies.into_iter().zip(pair) {
                if self.model.has_orientation(body) {
                    let name = self.model.body_name(body);
                    let message = format!("`{name}` turns about more than z, so it has no angle");
                    let help = "name two joints, or give the body the coordinate `angle` instead of `orientation`";
                    self.error(Code::NoAngle, node.span.clone(), message, help.to_owned());
                }
            }
            let ground = self.ground_of(pair[0]);
            return Some(bodies.map(|body| Rotating::Body { body, ground }));
        }
        let [first, second] = pair.map(|node| self.joint_ref(node, JointCoordinate::Angle));
        let (first, second) = (first?, second?);
        if first == second {
            self.error(Code::SameBody, pair[1].span.clone(), "a joint is not geared with itself", None);
        }
        Some([Rotating::Joint(first), Rotating::Joint(second)])
    }
}
