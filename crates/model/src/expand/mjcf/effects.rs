//! Effects of a robot: gravity, damping, friction, springs, rotors, limits, tendons, actuators; and equalities.
//!
//! Damping is −d v, friction −f v/√(v² + v₀²) as that of a URDF, a spring −k (s − s₀), a rotor −a dv/dt.

use super::build::PlacedRobot;
use super::drives::{self, sum};
use super::tree::{Sections, keys, list, map, text, value, values};
use crate::robots::algebra::{self, Pose, Value};
use crate::robots::mjcf::robot::{At, Coupling, Equality, Joint, MjcfType, Tendon};
use crate::robots::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Value as Tree};

/// Adds everything that acts; `limits` is the section of that name, `controls` the actuators' commands.
pub fn add(
    sections: &mut Sections,
    source: &PlacedRobot,
    limits: Option<&Entry>,
    controls: &[Entry],
    diagnostics: &mut Diagnostics,
) {
    let robot = source.robot;
    let world = &robot.bodies[0].span;
    if robot.gravity != [0.0; 3] {
        let gravity = keys(world, [("acceleration", values(world, &algebra::vector(robot.gravity)))]);
        sections.add("effects", "gravity", keys(world, [("gravity", gravity)]));
    }
    for joint in &robot.joints {
        match joint.kind {
            MjcfType::Hinge | MjcfType::Slide => single(sections, source, joint),
            MjcfType::Ball | MjcfType::Free => several(sections, source, joint, diagnostics),
        }
    }
    if let Some(limits) = limits {
        stops(sections, source, limits, diagnostics);
    }
    robot.tendons.iter().for_each(|tendon| act(sections, source, tendon));
    drives::add(sections, source, controls);
    robot.equalities.iter().for_each(|equality| couple(sections, source, equality));
    for entry in controls {
        if entry.value.scalar().is_none() {
            let message = format!("a number or a formula belongs here, but here is {}", entry.value.kind());
            diagnostics.push(Diagnostic::error(Code::WrongShape, entry.value.span.clone(), message));
        }
        if !robot.actuators.iter().any(|actuator| actuator.name == entry.key) {
            let names = robot.actuators.iter().map(|actuator| actuator.name.as_str());
            let help = suggest::help(&entry.key, "actuators", names);
            let message = format!("the MJCF has no actuator `{}`", clip(&entry.key));
            diagnostics.push(Diagnostic::error(Code::UnknownName, entry.key_span.clone(), message).help(help));
        }
    }
}

fn friction(joint: &Joint, key: &str, number: &Value) -> Node {
    let span = &joint.span;
    let slow = if joint.kind == MjcfType::Slide { TUNING.slow_slide } else { TUNING.slow_turn };
    let entries = [
        ("on", text(span, &joint.name)),
        (key, value(span, number)),
        ("transition_velocity", text(span, slow.to_string())),
    ];
    keys(span, [("joint_friction", keys(span, entries))])
}

/// Adds the effects in a joint of one coordinate.
fn single(sections: &mut Sections, source: &PlacedRobot, joint: &Joint) {
    let (span, name) = (&joint.span, &joint.name);
    if source.acts(&joint.damping) {
        let node = friction(joint, "viscous", &source.value(&joint.damping));
        sections.add("effects", &format!("{name}_damping"), node);
    }
    if source.acts(&joint.friction) {
        let node = friction(joint, "coulomb", &source.value(&joint.friction));
        sections.add("effects", &format!("{name}_friction"), node);
    }
    if source.acts(&joint.stiffness) {
        let (on, rate) = (text(span, name), value(span, &source.value(&joint.stiffness)));
        let rest = value(span, &source.value(&joint.spring_at));
        let node = if joint.kind == MjcfType::Hinge {
            keys(
                span,
                [("torsional_spring_damper", keys(span, [("on", on), ("stiffness", rate), ("free_angle", rest)]))],
            )
        } else {
            keys(span, [("servo", keys(span, [("on", on), ("target", rest), ("proportional", rate)]))])
        };
        sections.add("effects", &format!("{name}_spring"), node);
    }
    if source.acts(&joint.armature) {
        // A rotor by itself that turns as the joint moves: 1 rad for 1 m where it slides.
        let rotor = format!("{name}_rotor");
        let inertia = match joint.kind {
            MjcfType::Slide if source.named.contains(&joint.armature.name) => {
                format!("{} * 1 m^2", source.value(&joint.armature).text())
            }
            _ => source.value(&joint.armature).text(),
        };
        let coordinates = list(span, [text(span, "angle")]);
        sections.add("bodies", &rotor, keys(span, [("inertia", text(span, inertia)), ("coordinates", coordinates)]));
        let turned =
            if joint.kind == MjcfType::Slide { format!("{rotor}.angle * 1 m") } else { format!("{rotor}.angle") };
        let equation = text(span, format!("{turned} = {}", joint.coordinate(false)));
        sections.add("joints", &rotor, keys(span, [("equation", equation)]));
    }
}

/// Adds the damping of a ball joint or a free body, and reports other effects there.
fn several(sections: &mut Sections, source: &PlacedRobot, joint: &Joint, diagnostics: &mut Diagnostics) {
    let span = &joint.span;
    for (number, what) in
        [(&joint.stiffness, "stiffness"), (&joint.armature, "armature"), (&joint.friction, "frictionloss")]
    {
        // The format has them for free joints too, where they are rarely meant.
        if source.acts(number) {
            let message = format!("joint `{}` has {what}, which only hinges and slides may have", joint.name);
            diagnostics.push(
                Diagnostic::error(Code::BadLimits, number.span.clone(), message).help("leave it out, or 0".to_owned()),
            );
        }
    }
    if !source.acts(&joint.damping) {
        return;
    }
    let damping = || value(span, &source.value(&joint.damping));
    let body = &source.robot.bodies[joint.body];
    let ends = |first: &str| list(span, [text(span, first), text(span, &body.name)]);
    let node = if joint.kind == MjcfType::Free {
        keys(span, [("between", ends("ground")), ("damping", damping()), ("torsional_damping", damping())])
    } else {
        let parent = &source.robot.bodies[source.holders[body.parent].0].name;
        keys(span, [("between", ends(parent)), ("torsional_damping", damping())])
    };
    sections.add("effects", &format!("{}_damping", joint.name), keys(span, [("bushing", node)]));
}

/// Stops at the ends of ranges, as `limits` says.
fn stops(sections: &mut Sections, source: &PlacedRobot, limits: &Entry, diagnostics: &mut Diagnostics) {
    let Some(impact) = limits.value.get("impact") else {
        let help = "e.g. `limits: { impact: { stiffness: 1e4 } }`".to_owned();
        diagnostics
            .push(Diagnostic::error(Code::BadLimits, limits.key_span.clone(), "`limits` needs `impact`").help(help));
        return;
    };
    let mut acts = false;
    for joint in &source.robot.joints {
        let Some([lower, upper]) = &joint.range else { continue };
        let (span, end) = (&joint.span, |number| value(&joint.span, &source.value(number)));
        let entries =
            [("on", text(span, &joint.name)), ("lower", end(lower)), ("upper", end(upper)), ("impact", impact.clone())];
        sections.add("effects", &format!("{}_limit", joint.name), keys(span, [("stop", keys(span, entries))]));
        acts = true;
    }
    if !acts {
        diagnostics.push(Diagnostic::error(
            Code::BadLimits,
            limits.key_span.clone(),
            "no joint of the robot has limits",
        ));
    }
}

/// Spring and damper of a tendon.
fn act(sections: &mut Sections, source: &PlacedRobot, tendon: &Tendon) {
    if ![&tendon.stiffness, &tendon.damping, &tendon.friction].into_iter().any(|number| source.acts(number)) {
        return;
    }
    let (length, rate) = (sum(source, &tendon.length, false), sum(source, &tendon.length, true));
    let mut terms = Vec::new();
    if source.acts(&tendon.stiffness) {
        let [lower, upper] = tendon.slack;
        let stretch = if lower == upper {
            format!("({length} - ({lower:?}))")
        } else {
            format!("(max({length} - ({upper:?}), 0) + min({length} - ({lower:?}), 0))")
        };
        terms.push(format!("- {}*{stretch}", source.value(&tendon.stiffness).text()));
    }
    if source.acts(&tendon.damping) {
        terms.push(format!("- {}*{rate}", source.value(&tendon.damping).text()));
    }
    if source.acts(&tendon.friction) {
        let slides = |&(joint, _): &(usize, f64)| source.robot.joints[joint].kind == MjcfType::Slide;
        let slow = if tendon.length.terms.iter().any(slides) { TUNING.slow_slide } else { TUNING.slow_turn };
        terms.push(format!("- {}*{rate}/sqrt({rate}^2 + {slow}^2)", source.value(&tendon.friction).text()));
    }
    let shares = drives::shares(source, &tendon.name, &tendon.length, &terms.join(" "), &tendon.span);
    shares.iter().for_each(|share| drives::push(sections, source, share));
}

/// Adds the constraint of an entry of `<equality>`.
fn couple(sections: &mut Sections, source: &PlacedRobot, equality: &Equality) {
    let (span, name) = (&equality.span, &equality.name);
    let node = match &equality.what {
        Coupling::Connect(ends) => {
            let ends = [0, 1].map(|end| end_of(sections, source, equality, &ends[end], end));
            keys(span, [("spherical", list(span, ends))])
        }
        Coupling::Weld(ends) => {
            let ends = [0, 1].map(|end| end_of(sections, source, equality, &ends[end], end));
            keys(span, [("fixed", keys(span, [("between", list(span, ends))]))])
        }
        Coupling::Polynomial { first, second, coefficients } => {
            let mut right = format!("({:?})", coefficients[0]);
            if let Some(second) = second {
                let x = sum(source, second, false);
                for (power, coefficient) in coefficients.iter().enumerate().skip(1).filter(|(_, by)| **by != 0.0) {
                    right.push_str(&match power {
                        1 => format!(" + ({coefficient:?})*{x}"),
                        power => format!(" + ({coefficient:?})*{x}^{power}"),
                    });
                }
            }
            keys(span, [("equation", text(span, format!("{} = {right}", sum(source, first, false))))])
        }
    };
    sections.add("joints", name, node);
}

/// A point at an end of a constraint, by its name.
fn end_of(sections: &mut Sections, source: &PlacedRobot, equality: &Equality, at: &At, end: usize) -> Node {
    let span = &equality.span;
    let (holder, pose): (usize, Pose) = source.frame(at.body, at.position, &at.rotation);
    let body = &source.robot.bodies[holder].name;
    let name = format!("{}_{}", equality.name, end + 1);
    let node = super::build::point(span, &pose);
    let bodies = sections.of("bodies", span);
    if let Some(bodies) = bodies {
        if !bodies.iter().any(|entry| entry.key == *body) {
            bodies.push(Entry { key: body.clone(), key_span: span.clone(), value: map(span, []) });
        }
        for entry in bodies.iter_mut().filter(|entry| entry.key == *body) {
            if let Tree::Mapping(fields) = &mut entry.value.value {
                let mut fields_of = Sections(std::mem::take(fields));
                fields_of.add("points", &name, node.clone());
                *fields = fields_of.0;
            }
        }
    }
    text(span, format!("{body}.{name}"))
}
