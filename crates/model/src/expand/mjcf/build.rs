//! [`Robot`] → bodies, joints and start values of the model.
//!
//! Bodies without joints are part of the one that they are in: points of it, called after them. Several joints of a
//! body have bodies without mass between them.

use std::collections::HashSet;

use super::tree::{Sections, in_unit, keys, lengths, list, map, text, values};
use crate::grammar::motions::is_motion;
use crate::robots::algebra::{self, Pose, Value, Vector};
use crate::robots::masses::{self, MassPart};
use crate::robots::mjcf::robot::{Body, Joint, MjcfType, Robot};
use crate::robots::names;
use crate::robots::number::Number;
use crate::syntax::source::Span;
use crate::syntax::yaml::Node;

/// A robot on its way into the model.
pub struct PlacedRobot<'r> {
    pub robot: &'r Robot,
    /// Numbers that are parameters.
    pub named: &'r HashSet<String>,
    /// Per body, the body that it is part of, and its pose in that one.
    pub holders: Vec<(usize, Pose)>,
}

impl<'r> PlacedRobot<'r> {
    /// `words` are all of the model.
    pub fn new(robot: &'r Robot, named: &'r HashSet<String>, words: &HashSet<String>) -> Self {
        let mut source = Self { robot, named, holders: vec![(0, Pose::identity())] };
        for (index, body) in robot.bodies.iter().enumerate().skip(1) {
            let is_held = body.joints.is_empty() && !names::is_reaction_asked(words, &weld_of(body));
            let holder = if is_held {
                let (holder, pose) = &source.holders[body.parent];
                (*holder, pose.then(&source.vector(&body.position), &body.rotation))
            } else {
                (index, Pose::identity())
            };
            source.holders.push(holder);
        }
        source
    }

    pub fn value(&self, number: &Number) -> Value {
        if self.named.contains(&number.name) { Value::Text(number.name.clone()) } else { Value::Number(number.value) }
    }

    /// A mass, a length or a moment of inertia over its unit: a product of them has its unit when it is whole.
    fn plain(&self, number: &Number) -> Value {
        let units = number.unit.split('*').map(|unit| format!("/ 1 {unit}")).collect::<Vec<_>>().join(" ");
        match self.value(number) {
            Value::Text(name) => Value::Text(format!("({name} {units})")),
            value => value,
        }
    }

    /// Whether a number is a parameter, or not zero.
    pub fn acts(&self, number: &Number) -> bool {
        number.value != 0.0 || self.named.contains(&number.name)
    }

    fn vector(&self, numbers: &[Number; 3]) -> Vector {
        numbers.each_ref().map(|number| self.plain(number))
    }

    /// A frame at a point of a body, in the body that holds it.
    pub fn frame(&self, body: usize, position: [f64; 3], rotation: &algebra::Quaternion) -> (usize, Pose) {
        let (holder, pose) = &self.holders[body];
        (*holder, pose.then(&algebra::vector(position), rotation))
    }
}

/// The fixed joint of a body without joints, which is there where the model speaks of its reaction.
fn weld_of(body: &Body) -> String {
    format!("{}_weld", body.name)
}

/// A point with its frame.
pub fn point(span: &Span, pose: &Pose) -> Node {
    let position = lengths(span, &pose.position);
    if pose.rotation.iter().skip(1).all(Value::is_zero) {
        return keys(span, [("position", position)]);
    }
    let rotation = keys(span, [("quaternion", values(span, &pose.rotation))]);
    keys(span, [("position", position), ("rotation", rotation)])
}

/// Adds bodies and joints.
pub fn bodies(sections: &mut Sections, source: &PlacedRobot) {
    let robot = source.robot;
    let mut points: Vec<Vec<(String, Node)>> = robot.bodies.iter().map(|_| Vec::new()).collect();
    for (index, body) in robot.bodies.iter().enumerate() {
        let (holder, pose) = &source.holders[index];
        if index != 0 && *holder != index {
            add(&mut points[*holder], &body.name, point(&body.span, pose));
        }
        for site in &body.sites {
            let (holder, pose) = source.frame(index, site.position, &site.rotation);
            add(&mut points[holder], &site.name, point(&body.span, &pose));
        }
    }
    let mut between = Vec::new();
    for (index, body) in robot.bodies.iter().enumerate().skip(1) {
        if body.joints.is_empty() && source.holders[index].0 == index {
            weld(source, body, &mut points, &mut between);
        }
        joints(source, body, &mut points, &mut between);
    }
    for (index, body) in robot.bodies.iter().enumerate() {
        let own = std::mem::take(&mut points[index]);
        if index == 0 {
            if !own.is_empty() {
                ground(sections, &body.span, own);
            }
        } else if source.holders[index].0 == index {
            sections.add_body(&body.name, rigid(source, index, own));
        }
    }
    for entry in between {
        match entry {
            Between::Body(name, node) => sections.add("bodies", &name, node),
            Between::Joint(name, node) => sections.add("joints", &name, node),
        }
    }
}

/// Bodies without mass, and joints, in their order.
enum Between {
    Body(String, Node),
    Joint(String, Node),
}

fn add(points: &mut Vec<(String, Node)>, name: &str, node: Node) -> String {
    let mut name = name.to_owned();
    while is_motion(&name) || points.iter().any(|(known, _)| *known == name) {
        name.push('_');
    }
    points.push((name.clone(), node));
    name
}

/// Adds points of the ground to those that the model has.
fn ground(sections: &mut Sections, span: &Span, points: Vec<(String, Node)>) {
    let Some(bodies) = sections.of("bodies", span) else { return };
    let mut own = Sections(match bodies.iter().position(|entry| entry.key == "ground") {
        Some(index) => match bodies.remove(index).value.value {
            crate::syntax::yaml::Value::Mapping(entries) => entries,
            _ => Vec::new(),
        },
        None => Vec::new(),
    });
    points.into_iter().for_each(|(name, node)| own.add("points", &name, node));
    let value = Node { span: span.clone(), value: crate::syntax::yaml::Value::Mapping(own.0) };
    sections.add("bodies", "ground", value);
}

/// A body with all that is part of it.
fn rigid(source: &PlacedRobot, index: usize, points: Vec<(String, Node)>) -> Node {
    let body = &source.robot.bodies[index];
    let span = &body.span;
    let parts: Vec<MassPart> = (0..source.robot.bodies.len()).filter_map(|part| part_of(source, part, index)).collect();
    let masses: Vec<Value> = parts.iter().map(|part| part.mass.clone()).collect();
    let mass = algebra::sum(&masses);
    let center = masses::center(&parts, &mass);
    let [x, y, z] = masses::inertia(&parts, &center);
    let inertia = if parts.is_empty() {
        text(span, "0")
    } else {
        let [[xx, xy, xz], [_, yy, yz], [.., zz]] = [x, y, z];
        let elements = [("xx", xx), ("yy", yy), ("zz", zz), ("xy", xy), ("xz", xz), ("yz", yz)];
        keys(span, elements.map(|(key, element)| (key, in_unit(span, &element, "1 kg * 1 m^2"))))
    };
    let center = lengths(span, &center);
    let points = map(span, points);
    keys(
        span,
        [("mass", in_unit(span, &mass, "1 kg")), ("inertia", inertia), ("center_of_mass", center), ("points", points)],
    )
}

/// The mass of a body that is part of `holder`; `None` for any other.
fn part_of(source: &PlacedRobot, index: usize, holder: usize) -> Option<MassPart> {
    let (held_by, pose) = &source.holders[index];
    let mass = source.robot.bodies[index].mass.as_ref().filter(|_| *held_by == holder)?;
    let pose = pose.then(&source.vector(&mass.center), &mass.rotation);
    let (total, nominal) = (source.plain(&mass.mass), mass.mass.value);
    let [xx, yy, zz, xy, xz, yz] = mass.inertia.each_ref().map(|number| match (&total, mass.of_geoms) {
        // A body of another density.
        (Value::Text(_), true) => algebra::mul(&total, &Value::Number(number.value / nominal)),
        _ => source.plain(number),
    });
    let tensor = [[xx, xy.clone(), xz.clone()], [xy, yy, yz.clone()], [xz, yz, zz]];
    Some(MassPart { mass: total, center: pose.position, inertia: algebra::rotate_tensor(&pose.rotation, &tensor) })
}

/// The fixed joint of a body that has no other.
fn weld(source: &PlacedRobot, body: &Body, points: &mut [Vec<(String, Node)>], between: &mut Vec<Between>) {
    let (holder, pose) = &source.holders[body.parent];
    let pose = pose.then(&source.vector(&body.position), &body.rotation);
    let at = add(&mut points[*holder], &weld_of(body), point(&body.span, &pose));
    let ends = [format!("{}.{at}", source.robot.bodies[*holder].name), body.name.clone()];
    let ends = list(&body.span, ends.map(|end| text(&body.span, end)));
    let node = keys(&body.span, [("fixed", keys(&body.span, [("between", ends)]))]);
    between.push(Between::Joint(weld_of(body), node));
}

/// The joints of a body, from the one that it is in outwards.
fn joints(source: &PlacedRobot, body: &Body, points: &mut [Vec<(String, Node)>], between: &mut Vec<Between>) {
    let index = source.robot.joints.get(*body.joints.first().unwrap_or(&0)).map_or(0, |joint| joint.body);
    let mut previous: Option<String> = None;
    for (place, &joint) in body.joints.iter().enumerate() {
        let joint = &source.robot.joints[joint];
        if joint.kind == MjcfType::Free {
            return;
        }
        let (span, here) = (&joint.span, algebra::vector(joint.position));
        let at_child = keys(span, [("position", values(span, &here))]);
        let first = match &previous {
            // The frame that the body has in the file's configuration, moved to the joint.
            None => {
                let (holder, pose) = &source.holders[body.parent];
                let pose = pose.then(&source.vector(&body.position), &body.rotation);
                let pose = pose.then(&here, &algebra::identity());
                let name = add(&mut points[*holder], &at(joint), point(span, &pose));
                format!("{}.{name}", source.robot.bodies[*holder].name)
            }
            Some(body) => format!("{body}.{}", at(joint)),
        };
        let is_last = place + 1 == body.joints.len();
        let second = if is_last {
            format!("{}.{}", body.name, add(&mut points[index], &at(joint), at_child.clone()))
        } else {
            let name = format!("{}_{}", body.name, joint.name);
            let next = &source.robot.joints[body.joints[place + 1]];
            let next_at = keys(span, [("position", values(span, &algebra::vector(next.position)))]);
            let ends = map(span, [(at(joint), at_child), (at(next), next_at)]);
            let node = keys(span, [("mass", text(span, "0")), ("inertia", text(span, "0")), ("points", ends)]);
            between.push(Between::Body(name.clone(), node));
            previous = Some(name.clone());
            format!("{name}.{}", at(joint))
        };
        between.push(Between::Joint(joint.name.clone(), node_of(joint, &first, &second)));
    }
}

/// The point of a joint on each of its bodies.
fn at(joint: &Joint) -> String {
    format!("{}_joint", joint.name)
}

fn node_of(joint: &Joint, first: &str, second: &str) -> Node {
    let span = &joint.span;
    let between = list(span, [text(span, first), text(span, second)]);
    let axis = values(span, &algebra::vector(joint.axis));
    match joint.kind {
        MjcfType::Hinge => keys(span, [("revolute", keys(span, [("between", between), ("axis", axis)]))]),
        MjcfType::Slide => keys(span, [("prismatic", keys(span, [("between", between), ("axis", axis)]))]),
        _ => keys(span, [("spherical", between)]),
    }
}
