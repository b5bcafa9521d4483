//! Effects of a [`Robot`](crate::robots::urdf::robot::Robot)'s joints: damping and friction as the file has them
//! and, where the model asks for it, stops at their limits.
//!
//! Damping is −d v, Coulomb friction −f v/√(v² + v₀²), each between the joint's two bodies, v the joint's velocity.
//! They are called `JOINT.damping`, `JOINT.friction` and `JOINT.limit`, and can be omitted by these names.

use crate::grammar::{FrictionMode, JointCoordinate, OnJoint, Quantity, Value};
use symdiff::Formula;

use super::source::{Built, ParsedUrdf, coordinate, formula};
use crate::elements::effects::joint_friction::FrictionJoint;
use crate::elements::effects::{DryFriction, EffectKind, Impact, JointFriction, Stop};
use crate::expand::scenes::{self, OmittedEffects};
use crate::keys;
use crate::model::description::Effect;
use crate::model::names::Reader;
use crate::robots::number::Number;
use crate::robots::tuning::TUNING;
use crate::robots::urdf::robot::{Joint, Limits, UrdfJointType};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::yaml::Node;

/// An effect that may yet be omitted.
pub struct RobotEffect<'r> {
    effect: Effect,
    /// Its numbers of the file.
    numbers: Vec<&'r Number>,
}

/// Reads the effects in the joints.
pub fn read<'r>(
    reader: &mut Reader,
    source: &ParsedUrdf<'r>,
    built: &Built,
    limits: Option<(&Node, Span)>,
) -> Vec<RobotEffect<'r>> {
    let mut found = Vec::new();
    if let Some((_, at)) = limits.as_ref().filter(|_| !source.robot.joints.iter().any(is_limited)) {
        reader.error(Code::BadLimits, at.clone(), "no joint of the robot has limits", None);
    }
    let impacts = limits.map(|(node, at)| {
        [UrdfJointType::Revolute, UrdfJointType::Prismatic].map(|kind| impact(reader, source, node, &at, kind))
    });
    for &index in &source.robot.order {
        let joint = &source.robot.joints[index];
        let (Some(number), Some((coordinate, ..))) = (built.joints[index], coordinate(joint.kind)) else { continue };
        found.extend(friction(reader, source, joint, number));
        let impact = impacts
            .as_ref()
            .and_then(|[rotational, sliding]| if joint.kind.turns() { rotational.clone() } else { sliding.clone() });
        let on = OnJoint { joint: number, coordinate };
        if let Some(impact) = impact {
            if let (Some(limits), true) = (&joint.limits, is_limited(joint)) {
                found.push(stop(reader, source, joint, limits, on, impact));
            } else if joint.kind != UrdfJointType::Continuous {
                let message = format!("joint `{}` has no limits: no stop acts in it", joint.name);
                reader.diagnostics.push(Diagnostic::warning(Code::NoLimits, joint.span.clone(), message));
            }
        }
    }
    found
}

/// Whether the joint's position has a smallest or a largest value.
fn is_limited(joint: &Joint) -> bool {
    matches!(joint.kind, UrdfJointType::Revolute | UrdfJointType::Prismatic)
        && joint.limits.as_ref().is_some_and(|limits| limits.lower.is_some() || limits.upper.is_some())
}

/// Damping and friction, where the file has them.
fn friction<'r>(reader: &mut Reader, source: &ParsedUrdf<'r>, joint: &'r Joint, found: usize) -> Vec<RobotEffect<'r>> {
    let acts = |number: &Number| number.value != 0.0 || source.named.contains(&number.name);
    let mut effects = Vec::new();
    for (number, what) in [(&joint.damping, "damping"), (&joint.friction, "friction")] {
        if !acts(number) {
            continue;
        }
        let value = formula(reader, &source.value(number));
        let none = || Formula::number(0.0);
        let (viscous, coulomb) = if what == "damping" { (value, none()) } else { (none(), value) };
        let (mode, slow) = if joint.kind.turns() {
            (FrictionMode::Rotating, TUNING.slow_turn)
        } else {
            (FrictionMode::Sliding, TUNING.slow_slide)
        };
        let dry = DryFriction {
            breakaway: Formula::number(1.0),
            stribeck_velocity: None,
            transition_velocity: Formula::number(slow),
        };
        let on = FrictionJoint { joint: found, mode };
        let kind = JointFriction { on, coefficient: none(), dry, coulomb, viscous, radius: None, length: None };
        let effect = Effect { name: format!("{}.{what}", joint.name), kind: kind.into() };
        effects.push(RobotEffect { effect, numbers: vec![number] });
    }
    effects
}

/// How stops of joints of a kind push back; `None` if there are none.
fn impact(reader: &mut Reader, source: &ParsedUrdf, node: &Node, at: &Span, kind: UrdfJointType) -> Option<Impact> {
    let coordinate = if kind.turns() { JointCoordinate::Angle } else { JointCoordinate::Displacement };
    if !source.robot.joints.iter().any(|joint| joint.kind == kind && is_limited(joint)) {
        return None;
    }
    let fields = reader.fields::<keys::Limits>(node, at.clone())?;
    let node = reader.required(&fields, "impact")?;
    let units = Quantity { choice: coordinate.unit_choice(), ..Quantity::default() };
    Impact::read(reader, node, fields.key_span("impact"), &units)
}

fn stop<'r>(
    reader: &mut Reader,
    source: &ParsedUrdf<'r>,
    joint: &Joint,
    limits: &'r Limits,
    on: OnJoint,
    impact: Impact,
) -> RobotEffect<'r> {
    let ends = [&limits.lower, &limits.upper].map(Option::as_ref);
    let [lower, upper] = ends.map(|number| Some(formula(reader, &source.value(number?))));
    let effect = Effect { name: format!("{}.limit", joint.name), kind: Stop { on, lower, upper, impact }.into() };
    RobotEffect { effect, numbers: ends.into_iter().flatten().collect() }
}

/// Adds the effects that are not omitted.
pub fn add(reader: &mut Reader, source: &ParsedUrdf, effects: Vec<RobotEffect>, left_out: &OmittedEffects) {
    for (name, span) in left_out.given() {
        if !effects.iter().any(|known| known.effect.name == *name) {
            let robot = effects.iter().map(|known| known.effect.name.clone());
            let own = reader.model.effects.iter().map(|effect| effect.name.clone());
            let known: Vec<String> =
                robot.chain(own).chain(reader.model.joints.iter().map(|joint| joint.name.clone())).collect();
            scenes::unknown(reader, name, span.clone(), known.iter().map(String::as_str));
        }
    }
    let mut acting: Vec<&str> = Vec::new();
    for RobotEffect { effect, numbers } in effects {
        if left_out.leaves_out(&effect.name) {
            continue;
        }
        if let EffectKind::Stop(Stop { lower: Some(lower), upper: Some(upper), .. }) = &effect.kind {
            check_range(reader, &effect.name, numbers[0].span.clone(), lower, upper);
        }
        acting.extend(numbers.iter().map(|number| number.name.as_str()));
        reader.model.mechanism_mut().effects.push(effect);
    }
    // Bodies and frames use their own numbers; the numbers of effects are used if the effects are not omitted.
    for number in source.robot.numbers().filter(|number| source.named.contains(&number.name)) {
        let of_effect = number.name.starts_with("joint.") && !number.name.contains(".origin.");
        let place = reader.model.parameters.iter().position(|parameter| parameter.name == number.name);
        if let Some(used) = place.and_then(|place| reader.used.get_mut(place)) {
            *used |= !of_effect || acting.contains(&number.name.as_str());
        }
    }
}

/// Reports limits between which a joint cannot move, at any corner.
fn check_range(reader: &mut Reader, name: &str, span: Span, lower: &Formula, upper: &Formula) {
    for corner in 0..reader.corners.len() {
        let values = reader.evaluate(lower, corner).zip(reader.evaluate(upper, corner));
        if let Some((lower, upper)) = values.filter(|(lower, upper)| lower >= upper) {
            let label = reader.corners[corner].label.clone();
            let message = format!("a stop at {lower} and one at {upper} leave this joint no room to move{label}");
            reader.error(
                Code::BadLimits,
                span,
                message,
                format!("correct the limits, or leave the stops out: `without: [{name}]`"),
            );
            return;
        }
    }
}
