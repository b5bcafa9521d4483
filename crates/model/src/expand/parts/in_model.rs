//! Bodies, joints and effects of an assembly, as they are in the model: images in mirrors, and directions of the model.

use std::ops::Range;
use std::sync::Arc;

use super::placement::{AXES, GROUND, scalar};
use super::turned::{euler, quaternion, text, turn};
use super::{Writer, mirror, patterns};
use crate::elements::effects::{self, EffectKind};
use crate::elements::joints::JointKind;
use crate::grammar::Image;
use crate::syntax::codes::Code;
use crate::syntax::frame::{InstanceFrame, PLACE, Turned, about_z, product, sum};
use crate::syntax::scope::Scope;
use crate::syntax::source::Span;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// Where the entries of an instance are in the sections of the model.
#[derive(Default)]
pub(super) struct InstanceEntries {
    pub(super) bodies: Range<usize>,
    pub(super) joints: Range<usize>,
    pub(super) effects: Range<usize>,
    pub(super) starts: [(&'static str, Range<usize>); 2],
}

/// An effect on level ground in an instance that is turned or mirrored.
#[derive(Clone)]
pub struct Inclined {
    pub at: Span,
    /// Its kind, quoted.
    pub name: String,
    /// Whether the ground is level there, in the plane and in space.
    pub is_level: [bool; 2],
}

impl Writer<'_, '_> {
    /// Makes images of bodies, joints and effects, and turns directions of the ground.
    pub(super) fn image(&mut self, places: &InstanceEntries, scope: &Arc<Scope>) {
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
            self.check_level(&effect, frame);
            if frame.is_turned() {
                turn_directions(&mut effect, frame, scope, is_turning == Some(true));
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

    /// Notes an effect on level ground in an instance whose ground is not level. The ground of an effect with a wheel
    /// in the plane is across y.
    fn check_level(&mut self, effect: &Entry, frame: InstanceFrame) {
        let Value::Mapping(kinds) = &effect.value.value else { return };
        let on_level_ground = |kind: &&Entry| EffectKind::scope_of(&kind.key) == Some(effects::Scope::LevelGround);
        let Some(kind) = kinds.first().filter(on_level_ground) else { return };
        let is_mirrored = |up: usize| frame.mirrors.axes().any(|axis| axis == up);
        // A turn about z leaves the ground across z as it is.
        let in_space = frame.turned != Turned::InSpace && !is_mirrored(2);
        let in_plane = (!frame.is_turned() && !is_mirrored(1)) || kind.value.get("wheel").is_none();
        let name = format!("`{}`", kind.key);
        self.parts.inclined.push(Inclined { at: kind.key_span.clone(), name, is_level: [in_plane, in_space] });
    }

    /// Whether an effect or a drive is on joints that turn; `None` if it has no `on`.
    fn is_on_turning(&mut self, entry: &Entry, scope: &Scope) -> Option<bool> {
        let Value::Mapping(kinds) = &entry.value.value else { return None };
        let on = kinds.first()?.value.get("on")?.scalar()?;
        match kinds.first()?.value.get("coordinate").and_then(Node::scalar).map(|word| word.text.as_str()) {
            Some("angle") => return Some(true),
            Some("displacement") => return Some(false),
            _ => {}
        }
        let Some(wanted) = on.text.trim().strip_prefix("all ").map(str::trim) else {
            return Some(self.turning.get(on.name().as_ref()) == Some(&true));
        };
        if !patterns::is_pattern(wanted) {
            return Some(JointKind::turns(wanted));
        }
        let matches =
            |name: &str| name.strip_prefix(scope.prefix()).is_some_and(|name| patterns::matches(wanted, name));
        let turns = |which: bool| self.turning.iter().any(|(name, turns)| *turns == which && matches(name));
        let (some, others) = (turns(true), turns(false));
        let is_odd = scope.frame().is_some_and(|frame| frame.mirrors.is_odd());
        if some && others && is_odd && mirror::tells_turns(entry) {
            let message = format!(
                "`{}` matches joints that turn and joints that do not: their mirror images differ",
                clip(&on.text)
            );
            let at = kinds.first()?.value.get("on")?.span.clone();
            self.report.error(
                Code::BadPlacement,
                at,
                message,
                "write an effect for those that turn and one for the others".to_owned(),
            );
        }
        Some(some)
    }

    /// Holds the coordinates that a body does not have where the instance has them.
    fn hold(&mut self, body: &mut Entry, frame: InstanceFrame, scope: &Arc<Scope>) {
        let Value::Mapping(keys) = &mut body.value.value else { return };
        let Some(coordinates) = keys.iter().find(|key| key.key == "coordinates") else { return };
        let (span, at) = (coordinates.value.span.clone(), coordinates.key_span.clone());
        let Value::Sequence(items) = &coordinates.value.value else { return };
        let is_free = |name: &str| items.iter().any(|item| item.scalar().is_some_and(|scalar| scalar.text == name));
        let (free, turns) = (AXES.map(is_free), ["angle", "orientation"].map(is_free));
        let is_mixed = match frame.turned {
            Turned::Not => false,
            Turned::ByAngle => free[0] != free[1],
            Turned::InSpace => turns[0] || free != [free[0]; 3],
        };
        if is_mixed {
            let name = body.key.strip_prefix(scope.prefix()).unwrap_or(&body.key);
            let message = format!("the coordinates of `{name}` are along the model's axes, but the instance is turned");
            let help = "give it all coordinates, and guide it by a joint such as `prismatic`".to_owned();
            self.report.error(Code::BadPlacement, span, message, help);
            return;
        }
        let mut held: Vec<Entry> = match keys.iter().find(|key| key.key == "held").map(|key| &key.value.value) {
            Some(Value::Mapping(entries)) => entries.clone(),
            Some(_) => return,
            None => Vec::new(),
        };
        // The reader reports malformed values.
        let Some(wanted) = held_in_model(&held, frame, free, turns.contains(&true), scope, &span) else { return };
        for (name, value) in wanted {
            held.retain(|key| key.key != name && !(name == "orientation" && key.key == "angle"));
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

/// Prescribed coordinates of a body, in the model's frame. `free`: its lengths that are coordinates; `turns`: whether
/// it can turn.
fn held_in_model(
    held: &[Entry],
    frame: InstanceFrame,
    free: [bool; 3],
    turns: bool,
    scope: &Arc<Scope>,
    span: &Span,
) -> Option<Vec<(&'static str, Node)>> {
    let of = |name: &str| held.iter().find(|key| key.key == name).map(|key| &key.value);
    let number = |name: &str| of(name).map_or_else(|| Some("0".to_owned()), text);
    let (origin, angle) = (frame.origin(PLACE), number("angle")?);
    let seen = frame.turn(PLACE, &[number("x")?, number("y")?, number("z")?]);
    let mut wanted = Vec::new();
    for axis in (0..3).filter(|&axis| !free[axis] && (frame.is_turned() || origin[axis] != "0")) {
        let value = sum([origin[axis].clone(), seen[axis].clone()].iter());
        if value != "0" {
            wanted.push((AXES[axis], scalar(&value, scope, span)));
        }
    }
    if turns || !frame.is_turned() {
        return Some(wanted);
    }
    let orientation = of("orientation");
    if frame.turned == Turned::ByAngle && orientation.is_none() {
        let angle = sum([format!("{PLACE}angle"), angle].iter());
        wanted.push(("angle", scalar(&angle, scope, span)));
        return Some(wanted);
    }
    let own = orientation.map_or_else(|| Some(about_z(&angle)), quaternion)?;
    let p = product(&frame.quaternion(PLACE), &own).map(|p| scalar(&p, scope, span));
    wanted.push(("orientation", euler(p, span)));
    Some(wanted)
}

/// Turns the directions of the ground that an effect has. One number about z is one about an axis of any direction in a
/// frame that is turned in space, but for one about a joint's axis.
fn turn_directions(effect: &mut Entry, frame: InstanceFrame, scope: &Arc<Scope>, is_on_turning: bool) {
    let Value::Mapping(kinds) = &mut effect.value.value else { return };
    let [kind] = kinds.as_mut_slice() else { return };
    let in_body = kind.value.get("frame").and_then(Node::scalar).is_some_and(|frame| frame.text == "body");
    let images = mirror::images(&kind.key);
    let Value::Mapping(keys) = &mut kind.value.value else { return };
    let directed = |key: &str| images.iter().find(|known| known.in_ground && known.name == key);
    for key in keys.iter_mut().filter(|_| !in_body) {
        let Some(known) = directed(&key.key) else { continue };
        mirror::written_out(&mut key.value);
        if matches!(known.image, Image::Axial) && frame.turned == Turned::InSpace && !is_on_turning {
            about_axes(&mut key.value);
        }
        turn(&mut key.value, frame, scope);
    }
}

/// One number about z as a list.
fn about_axes(node: &mut Node) {
    let Value::Scalar(number) = &node.value else { return };
    let zero = || Node { span: node.span.clone(), value: Value::Scalar(Scalar::plain("0", None)) };
    let about_z = Node { span: node.span.clone(), value: Value::Scalar(number.clone()) };
    node.value = Value::Sequence(vec![zero(), zero(), about_z]);
}
