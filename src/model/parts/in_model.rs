//! What an assembly says of its parts, as it is in the model: images in mirrors, and numbers in the model's frame.

use std::ops::Range;
use std::sync::Arc;

use super::placement::{AXES, GROUND, scalar};
use super::{Writer, mirror, patterns};
use crate::syntax::frame::{self, Frame, PLACE, Turned, Vector, about, product, signed, sum};
use crate::syntax::scope::Scope;
use crate::syntax::source::Span;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Entry, Node, Value};

/// Where the entries of an instance are in the sections of the model.
#[derive(Default)]
pub(super) struct Places {
    pub(super) bodies: Range<usize>,
    pub(super) joints: Range<usize>,
    pub(super) effects: Range<usize>,
    pub(super) starts: [(&'static str, Range<usize>); 2],
}

/// Effects with vectors along the axes of the ground.
const DIRECTED: [(&str, &str); 4] =
    [("spring_damper", "along"), ("force", "value"), ("drag", "wind"), ("torque", "value")];

/// What a start value is of.
enum Of {
    /// A body, or a point of one.
    Place,
    /// A body's rate of rotation, by its parts.
    Rate,
    Joint,
}

impl Writer<'_, '_> {
    /// Makes images of bodies, joints and effects, and turns directions of the ground.
    pub(super) fn image(&mut self, places: &Places, scope: &Arc<Scope>) {
        let effects = self.taken("effects", &places.effects);
        let mut images = Vec::with_capacity(effects.len());
        let frame = scope.frame().unwrap_or_default();
        for mut effect in effects {
            let is_turning = self.is_on_turning(&effect, scope);
            if is_turning != Some(false) && mirror::measures_turns(&effect) {
                self.parts.turning_effects.insert(effect.key.clone());
            }
            if frame.mirrors.axes().next().is_some() {
                self.image_of_kind(&mut effect, frame.mirrors, is_turning);
            }
            if frame.is_turned() {
                turn_directions(&mut effect, frame, scope);
            }
            images.push(effect);
        }
        self.put("effects", &places.effects, images);
        if scope.frame().is_none() {
            return;
        }
        let mut joints = self.taken("joints", &places.joints);
        if frame.mirrors.axes().next().is_some() {
            for joint in &mut joints {
                let is_turning = self.is_on_turning(joint, scope);
                self.image_of_kind(joint, frame.mirrors, is_turning);
            }
        }
        self.put("joints", &places.joints, joints);
        let mut bodies = self.taken("bodies", &places.bodies);
        for body in bodies.iter_mut().filter(|body| body.key != scope.full(GROUND)) {
            self.image_of_body(body, frame.mirrors);
            self.hold(body, frame, scope);
        }
        self.put("bodies", &places.bodies, bodies);
    }

    /// Whether an effect or a drive is on joints that turn; nothing where it is on nothing.
    fn is_on_turning(&mut self, entry: &Entry, scope: &Scope) -> Option<bool> {
        let Value::Mapping(kinds) = &entry.value.value else { return None };
        let on = kinds.first()?.value.get("on")?.scalar()?;
        let Some(wanted) = on.text.trim().strip_prefix("all ").map(str::trim) else {
            return Some(self.turning.get(on.name().as_ref()) == Some(&true));
        };
        if !patterns::is_pattern(wanted) {
            return Some(wanted == REVOLUTE);
        }
        let matches =
            |name: &str| name.strip_prefix(scope.prefix()).is_some_and(|name| patterns::matches(wanted, name));
        let turns = |which: bool| self.turning.iter().any(|(name, turns)| *turns == which && matches(name));
        let (some, others) = (turns(true), turns(false));
        let is_odd = scope.frame().is_some_and(|frame| frame.mirrors.is_odd());
        if some && others && is_odd && mirror::tells_turns(entry) {
            let message = format!("`{}` is joints that turn and others, which have other images", clip(&on.text));
            let at = kinds.first()?.value.get("on")?.span.clone();
            self.reader.error(at, message, "write an effect for those that turn and one for the others".to_owned());
        }
        Some(some)
    }

    /// Gives start values of bodies in the model's frame, and those of joints in a mirror.
    pub(super) fn starts(&mut self, places: &Places, scope: &Arc<Scope>) {
        let Some(frame) = scope.frame() else { return };
        for (section, range) in &places.starts {
            let said = self.taken(section, range);
            let mut starts = said.clone();
            for (index, start) in starts.iter_mut().enumerate() {
                let Some((owner, _)) = said[index].key.rsplit_once('.') else { continue };
                match self.of(owner) {
                    Some(Of::Joint) => {
                        let is_angle = start.key.ends_with(".angle") || start.key.ends_with(".angular_velocity");
                        if is_angle && frame.mirrors.is_odd() {
                            mirror::negate(&mut start.value);
                        }
                    }
                    Some(of) => self.start(start, &of, &said, (frame, scope)),
                    None => {}
                }
            }
            self.put(section, range, starts);
        }
    }

    /// What something is that has start values.
    fn of(&self, owner: &str) -> Option<Of> {
        let target = |name: &str| self.parts.port(name).unwrap_or(name).to_owned();
        let is_body = |name: &str| self.bodies.contains(target(name).as_str());
        if is_body(owner) {
            return Some(Of::Place);
        }
        if self.turning.contains_key(owner) {
            return Some(Of::Joint);
        }
        match owner.rsplit_once('.') {
            Some((body, "omega" | "omega_body")) if is_body(body) => Some(Of::Rate),
            _ => target(owner).rsplit_once('.').filter(|(body, _)| is_body(body)).map(|_| Of::Place),
        }
    }

    fn start(&mut self, start: &mut Entry, of: &Of, said: &[Entry], (frame, scope): (Frame, &Arc<Scope>)) {
        let Some((owner, coordinate)) = start.key.rsplit_once('.').map(|(a, b)| (a.to_owned(), b.to_owned())) else {
            return;
        };
        let mirrors = frame.mirrors;
        match (of, coordinate.as_str()) {
            (Of::Place, "omega_body") | (Of::Rate, _)
                if coordinate == "omega_body" || owner.ends_with(".omega_body") =>
            {
                match AXES.iter().position(|axis| *axis == coordinate) {
                    Some(axis) if mirrors.turns_back(axis) => mirror::negate(&mut start.value),
                    Some(_) => {}
                    None => mirrors.axes().for_each(|axis| mirror::axial(&mut start.value, axis)),
                }
            }
            (Of::Place, "omega") => {
                mirrors.axes().for_each(|axis| mirror::axial(&mut start.value, axis));
                if frame.is_turned() {
                    turn(&mut start.value, frame, scope);
                }
            }
            (Of::Place, "orientation") => {
                mirrors.axes().for_each(|axis| mirror::rotation(&mut start.value, axis));
                if frame.is_turned() {
                    orient(&mut start.value, frame, scope);
                }
            }
            (Of::Place, "roll" | "pitch" | "yaw") if frame.is_turned() => {
                let message = format!("`{}` is about an axis of the model, but the instance is turned", start.key);
                self.reader.error(
                    start.key_span.clone(),
                    message,
                    "give `orientation`, or coordinates of joints".to_owned(),
                );
            }
            (Of::Place, "roll" | "pitch" | "yaw") => {
                let axis = usize::from(coordinate == "pitch") + 2 * usize::from(coordinate == "yaw");
                if mirrors.turns_back(axis) {
                    mirror::negate(&mut start.value);
                }
            }
            (Of::Place, "angle" | "angular_velocity") => self.angle(start, coordinate == "angle", (frame, scope)),
            _ => self.component(start, &owner, &coordinate, said, (frame, scope)),
        }
    }

    /// The start of a body's angle or of its rate.
    fn angle(&mut self, start: &mut Entry, is_angle: bool, (frame, scope): (Frame, &Arc<Scope>)) {
        if frame.turned == Turned::InSpace {
            let message = format!("`{}` is about the model's z, but the instance is turned in space", start.key);
            self.reader.error(start.key_span.clone(), message, "give coordinates of joints".to_owned());
            return;
        }
        if frame.mirrors.turns_back(2) {
            mirror::negate(&mut start.value);
        }
        if is_angle && frame.turned == Turned::ByAngle {
            let Some(text) = text(&start.value) else { return };
            replace(&mut start.value, &sum([format!("{PLACE}angle"), text].iter()), scope);
        }
    }

    /// The start of a component of a place, of its velocity, or of a body's rate of rotation.
    fn component(
        &mut self,
        start: &mut Entry,
        owner: &str,
        coordinate: &str,
        said: &[Entry],
        (frame, scope): (Frame, &Arc<Scope>),
    ) {
        let (is_velocity, letter) = match coordinate.strip_prefix('v') {
            Some(letter) => (true, letter),
            None => (owner.ends_with(".omega"), coordinate),
        };
        let Some(axis) = AXES.iter().position(|axis| *axis == letter) else { return };
        let is_rate = owner.ends_with(".omega");
        let row = frame.rotation(PLACE)[axis].clone();
        let mut vector: Vector = ["0"; 3].map(str::to_owned);
        for other in (0..3).filter(|&other| row[other] != "0") {
            let key = format!("{owner}.{}{}", &coordinate[..coordinate.len() - 1], AXES[other]);
            let Some(found) = said.iter().find(|known| known.key == key) else {
                let name = key.rsplit('.').next().unwrap_or(&key);
                let message = format!("`{}` is given without `{name}`, but the instance is turned", start.key);
                let all = if frame.turned == Turned::InSpace { "all three" } else { "both" };
                self.reader.error(start.key_span.clone(), message, format!("give {all}, or the coordinates of joints"));
                return;
            };
            let is_negative = if is_rate { frame.mirrors.turns_back(other) } else { frame.mirrors.flips(other) };
            let Some(text) = text(&found.value) else { return };
            vector[other] = signed(&text, is_negative);
        }
        let origin = frame.origin(PLACE)[axis].clone();
        if !frame.is_turned() && (is_velocity || origin == "0") {
            // Nothing but its sign can be another.
            let is_negative = if is_rate { frame.mirrors.turns_back(axis) } else { frame.mirrors.flips(axis) };
            if is_negative {
                mirror::negate(&mut start.value);
            }
            return;
        }
        let origin = if is_velocity { "0".to_owned() } else { origin };
        let seen = frame.turn(PLACE, &vector)[axis].clone();
        replace(&mut start.value, &sum([origin, seen].iter()), scope);
    }

    /// Holds the coordinates that a body does not have where the instance has them.
    fn hold(&mut self, body: &mut Entry, frame: Frame, scope: &Arc<Scope>) {
        let Value::Mapping(keys) = &mut body.value.value else { return };
        let Some(coordinates) = keys.iter().find(|key| key.key == "coordinates") else { return };
        let (span, at) = (coordinates.value.span.clone(), coordinates.key_span.clone());
        let Value::Sequence(items) = &coordinates.value.value else { return };
        let is_free = |name: &str| items.iter().any(|item| item.scalar().is_some_and(|scalar| scalar.text == name));
        let free = AXES.map(is_free);
        let (has_angle, has_orientation) = (is_free("angle"), is_free("orientation"));
        let is_mixed = match frame.turned {
            Turned::Not => false,
            Turned::ByAngle => free[0] != free[1],
            Turned::InSpace => has_angle || free != [free[0]; 3],
        };
        if is_mixed {
            let name = body.key.rsplit('.').next().unwrap_or_default();
            let message = format!("the coordinates of `{name}` are along the model's axes, but the instance is turned");
            let help = "give it all coordinates, and guide it by a joint such as `prismatic`".to_owned();
            self.reader.error(span, message, help);
            return;
        }
        let held = keys.iter().find(|key| key.key == "held").map(|key| key.value.clone());
        let mut held: Vec<Entry> = match held.map(|node| node.value) {
            Some(Value::Mapping(entries)) => entries,
            Some(_) => return,
            None => Vec::new(),
        };
        let number = |name: &str| match held.iter().find(|key| key.key == name) {
            Some(key) => text(&key.value),
            None => Some("0".to_owned()),
        };
        let [Some(x), Some(y), Some(z), Some(own_angle)] = ["x", "y", "z", "angle"].map(number) else { return };
        let (origin, seen) = (frame.origin(PLACE), frame.turn(PLACE, &[x, y, z]));
        let mut wanted: Vec<(&str, Node)> = Vec::new();
        for axis in (0..3).filter(|&axis| !free[axis] && (frame.is_turned() || origin[axis] != "0")) {
            let value = sum([origin[axis].clone(), seen[axis].clone()].iter());
            if value != "0" {
                wanted.push((AXES[axis], scalar(&value, scope, &span)));
            }
        }
        let orientation = held.iter().find(|key| key.key == "orientation").map(|key| key.value.clone());
        if !has_angle && !has_orientation && frame.is_turned() {
            if frame.turned == Turned::ByAngle && orientation.is_none() {
                let angle = sum([format!("{PLACE}angle"), own_angle].iter());
                wanted.push(("angle", scalar(&angle, scope, &span)));
            } else {
                let own = match &orientation {
                    Some(node) => quaternion(node),
                    None => Some(frame::about_z(&own_angle)),
                };
                let Some(own) = own else { return };
                held.retain(|key| key.key != "angle");
                let p = product(&frame.quaternion(PLACE), &own).map(|p| scalar(&p, scope, &span));
                wanted.push(("orientation", euler(p, &span)));
            }
        }
        for (name, value) in wanted {
            held.retain(|key| key.key != name);
            held.push(Entry { key: name.to_owned(), key_span: at.clone(), value });
        }
        if held.is_empty() {
            return;
        }
        keys.retain(|key| key.key != "held");
        let value = Node { span, value: Value::Mapping(held) };
        keys.push(Entry { key: "held".to_owned(), key_span: at, value });
    }
}

/// The kind of joints that turn, with an angle that a mirror counts the other way.
pub(super) const REVOLUTE: &str = "revolute";

/// Turns the directions of the ground that an effect has.
fn turn_directions(effect: &mut Entry, frame: Frame, scope: &Arc<Scope>) {
    let Value::Mapping(kinds) = &mut effect.value.value else { return };
    let [kind] = kinds.as_mut_slice() else { return };
    let in_body = kind.value.get("frame").and_then(Node::scalar).is_some_and(|frame| frame.text == "body");
    let Value::Mapping(keys) = &mut kind.value.value else { return };
    for key in keys.iter_mut().filter(|key| !in_body && DIRECTED.contains(&(kind.key.as_str(), key.key.as_str()))) {
        mirror::written_out(&mut key.value);
        turn(&mut key.value, frame, scope);
    }
}

/// Turns a list of components; a number stays, and so does a list that is none.
fn turn(node: &mut Node, frame: Frame, scope: &Arc<Scope>) {
    let span = node.span.clone();
    let scope = scope_of(node, scope);
    let Value::Sequence(items) = &mut node.value else { return };
    let Some(mut parts) = texts(items).filter(|parts| (2..=3).contains(&parts.len())) else { return };
    let count = if frame.turned == Turned::InSpace { 3 } else { items.len() };
    let z = if parts.len() == 3 { parts.remove(2) } else { "0".to_owned() };
    let [x, y] = [parts.remove(0), parts.remove(0)];
    let turned = frame.turn(PLACE, &[x, y, z]);
    *items = turned.iter().take(count).map(|text| scalar(text, &scope, &span)).collect();
}

/// Turns an orientation.
fn orient(node: &mut Node, frame: Frame, scope: &Arc<Scope>) {
    let Some(own) = quaternion(node) else { return };
    let scope = scope_of(node, scope);
    let span = node.span.clone();
    let p = product(&frame.quaternion(PLACE), &own).map(|p| scalar(&p, &scope, &span));
    *node = euler(p, &span);
}

/// A rotation by its Euler parameters.
fn euler(p: [Node; 4], span: &Span) -> Node {
    let value = Node { span: span.clone(), value: Value::Sequence(p.into()) };
    let key = Entry { key: "quaternion".to_owned(), key_span: span.clone(), value };
    Node { span: span.clone(), value: Value::Mapping(vec![key]) }
}

/// The Euler parameters of a rotation, of any length; nothing where it is not well formed, which its reader reports.
fn quaternion(node: &Node) -> Option<[String; 4]> {
    let list = |node: &Node| match &node.value {
        Value::Sequence(items) => texts(items),
        _ => None,
    };
    if let Some(p) = node.get("quaternion") {
        return list(p)?.try_into().ok();
    }
    if let Some(angles) = node.get("rpy") {
        let [roll, pitch, yaw]: [String; 3] = list(angles)?.try_into().ok()?;
        return Some(product(&about(2, &yaw), &product(&about(1, &pitch), &about(0, &roll))));
    }
    let angle = text(node.get("angle")?)?;
    let mut axis = node.get("axis")?.clone();
    if let Some(letter) = axis.scalar().and_then(|scalar| AXES.iter().position(|axis| *axis == scalar.text)) {
        return Some(about(letter, &angle));
    }
    mirror::written_out(&mut axis);
    let mut axis = list(&axis)?;
    axis.resize(3, "0".to_owned());
    let length = format!("sqrt(({})^2 + ({})^2 + ({})^2)", axis[0], axis[1], axis[2]);
    let part = |component: &String| format!("({component})*sin(({angle})/2)/{length}");
    Some([format!("cos(({angle})/2)"), part(&axis[0]), part(&axis[1]), part(&axis[2])])
}

/// The scope of the numbers of a node, without their signs; the instance's where they have none.
fn scope_of(node: &Node, instance: &Arc<Scope>) -> Arc<Scope> {
    fn found(node: &Node) -> Option<&Scope> {
        match &node.value {
            Value::Scalar(scalar) => scalar.scope.as_deref(),
            Value::Sequence(items) => items.iter().find_map(found),
            Value::Mapping(entries) => entries.iter().find_map(|entry| found(&entry.value)),
        }
    }
    // What a mirror wrote out by itself has no names, and no prefix.
    let own = found(node).filter(|scope| scope.prefix() == instance.prefix());
    Arc::new(own.unwrap_or(instance).with_sign(false))
}

/// The formula of a number, its sign included; nothing for what is no number, which its reader reports.
fn text(node: &Node) -> Option<String> {
    let scalar = node.scalar()?;
    let is_negated = scalar.scope.as_ref().is_some_and(|scope| scope.is_negated());
    let text = if scalar.text.parse() == Ok(0.0) { "0" } else { scalar.text.trim() };
    Some(signed(text, is_negated))
}

fn texts(items: &[Node]) -> Option<Vec<String>> {
    items.iter().map(text).collect()
}

/// Writes another formula instead of a number.
fn replace(node: &mut Node, text: &str, scope: &Arc<Scope>) {
    *node = scalar(text, &scope_of(node, scope), &node.span.clone());
}
