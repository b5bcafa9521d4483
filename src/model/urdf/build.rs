//! [`Robot`] → bodies, joints and start values.
//!
//! Links that are welded together are one body, whose frame is that of the link nearest to the root:
//!
//! ```text
//! m = Σ mᵢ,   m c = Σ mᵢ cᵢ,   J = Σ Rᵢ Jᵢ Rᵢᵀ + mᵢ (dᵢ² 1 − dᵢ dᵢᵀ),   dᵢ = cᵢ − c
//! ```
//!
//! The others are frames at points of it, named after them.

use crate::grammar::{Axis, Coordinate, Direction, JointCoordinate, PointRef, Rotation, TimeOrder, Turning};
use std::collections::{HashMap, HashSet};

use symdiff::Formula;

use super::algebra::{self, Quaternion, Value, Vector};
use super::robot::{Joint as UrdfJoint, Kind, Number, Robot};
use crate::elements::joints::{Equation, Gear, JointKind, Planar, Prismatic, Revolute};
use crate::model::description::{Body, Inertia, Joint, Output, Point, RobotTree, StartValue, TreeJoint, TreeLink};
use crate::model::names::Reader;
use crate::syntax::diagnostic::Diagnostic;

/// What a body without mass gets that cannot be left out (kg, kg m²), and the least radius of gyration squared, m².
const LEAST_MASS: f64 = 1e-3;
const LEAST_INERTIA: f64 = 1e-6;
const LEAST_RADIUS_SQUARED: f64 = 1e-8;

/// A frame in another: position, and rotation into the other.
#[derive(Clone)]
struct Pose {
    position: Vector,
    turn: Quaternion,
}

impl Pose {
    fn identity() -> Self {
        Self { position: algebra::vector([0.0; 3]), turn: algebra::identity() }
    }

    fn then(&self, xyz: &Vector, turn: &Quaternion) -> Self {
        let position = algebra::add(&self.position, &algebra::rotate(&self.turn, xyz));
        Self { position, turn: algebra::product(&self.turn, turn) }
    }
}

/// Links that are welded together.
struct Group {
    /// The first is nearest to the root.
    links: Vec<usize>,
    /// Index into the model's bodies; absent where it is left out.
    body: Option<usize>,
}

/// Where everything of the robot is in the model.
pub struct Built {
    /// Of each of the robot's joints that moves and is not left out: the model's.
    pub joints: Vec<Option<usize>>,
    /// Of each link, its body and pose in it.
    places: Vec<(Option<usize>, Pose)>,
    /// Of each link, its frame as others can name it; absent where it is left out.
    frames: Vec<Option<PointRef>>,
}

/// What is read of a URDF, and how numbers are looked at.
pub struct Source<'s> {
    pub robot: &'s Robot,
    pub floating: bool,
    /// Words of the model that names the file.
    pub words: &'s HashSet<String>,
    /// Numbers that are parameters.
    pub named: &'s HashSet<String>,
}

impl Source<'_> {
    pub fn value(&self, number: &Number) -> Value {
        if self.named.contains(&number.name) { Value::Text(number.name.clone()) } else { Value::Number(number.value) }
    }

    fn vector(&self, numbers: &[Number; 3]) -> Vector {
        numbers.each_ref().map(|number| self.value(number))
    }

    fn mass(&self, links: &[usize]) -> f64 {
        links.iter().filter_map(|&link| Some(self.robot.links[link].inertial.as_ref()?.mass.value)).sum()
    }
}

/// Adds bodies and joints to the model.
pub fn declare(reader: &mut Reader, source: &Source) -> Built {
    let robot = source.robot;
    let mut groups = vec![Group { links: vec![robot.root], body: None }];
    let mut of_link = vec![(0, Pose::identity()); robot.links.len()];
    for &index in &robot.order {
        let joint = &robot.joints[index];
        if joint.kind == Kind::Fixed {
            let turn = algebra::roll_pitch_yaw(&source.vector(&joint.origin.rpy));
            let (group, pose) = &of_link[joint.parent];
            of_link[joint.child] = (*group, pose.then(&source.vector(&joint.origin.xyz), &turn));
            groups[of_link[joint.child].0].links.push(joint.child);
        } else {
            of_link[joint.child] = (groups.len(), Pose::identity());
            groups.push(Group { links: vec![joint.child], body: None });
        }
    }
    let left_out = left_out(reader, source, &groups, &of_link);
    let mut frames = vec![None; robot.links.len()];
    for index in 0..groups.len() {
        groups[index].body = if index == 0 && !source.floating {
            Some(0)
        } else if left_out[index] {
            None
        } else {
            let body = body(reader, source, &groups[index], &of_link);
            reader.model.bodies.push(body);
            Some(reader.model.bodies.len() - 1)
        };
        let Some(body) = groups[index].body else { continue };
        for (place, &link) in groups[index].links.iter().enumerate() {
            // A body's frame is that of its first link.
            if body != 0 && place == 0 {
                frames[link] = Some(PointRef { body, point: None });
                continue;
            }
            let point = point(reader, robot.links[link].name.clone(), &of_link[link].1);
            let points = &mut reader.model.bodies[body].points;
            points.push(point);
            frames[link] = Some(PointRef { body, point: Some(points.len() - 1) });
        }
    }
    let places: Vec<(Option<usize>, Pose)> =
        of_link.into_iter().map(|(group, pose)| (groups[group].body, pose)).collect();
    let mut built = Built { joints: vec![None; robot.joints.len()], places, frames };
    for &index in &robot.order {
        built.joints[index] = joint(reader, source, &built, index);
    }
    for &index in &robot.order {
        mimic(reader, source, &built, index);
    }
    reader.model.robot = Some(tree(source, &built));
    built
}

/// Ends of the chain without mass, on which nothing acts.
fn left_out(reader: &mut Reader, source: &Source, groups: &[Group], of_link: &[(usize, Pose)]) -> Vec<bool> {
    let robot = source.robot;
    let mut left_out = vec![false; groups.len()];
    let mut holds = vec![false; groups.len()];
    for &index in robot.order.iter().rev() {
        let joint = &robot.joints[index];
        if joint.kind == Kind::Fixed {
            continue;
        }
        let (group, parent) = (of_link[joint.child].0, of_link[joint.parent].0);
        let named = |link: &usize| source.words.contains(&robot.links[*link].name);
        let wanted = groups[group].links.iter().any(named) || source.words.contains(&joint.name);
        if source.mass(&groups[group].links) > 0.0 || holds[group] || wanted {
            holds[parent] = true;
            continue;
        }
        left_out[group] = true;
        let link = &robot.links[joint.child];
        let message =
            format!("link `{}` moves, but has no mass: it is left out, with its joint `{}`", link.name, joint.name);
        reader.diagnostics.push(Diagnostic::warning(link.span.clone(), message));
    }
    left_out
}

/// The formula of a value that is not too long.
pub fn formula(reader: &mut Reader, value: &Value) -> Formula {
    value.formula().unwrap_or_else(|| {
        let message = "too many links are welded together with uncertain numbers";
        reader.diagnostics.push(Diagnostic::of_file(message));
        Formula::number(f64::NAN)
    })
}

fn formulas<const N: usize>(reader: &mut Reader, values: &[Value; N]) -> [Formula; N] {
    values.each_ref().map(|value| formula(reader, value))
}

fn point(reader: &mut Reader, name: String, pose: &Pose) -> Point {
    let position = formulas(reader, &pose.position);
    let rotation = Some(Rotation::Quaternion(formulas(reader, &pose.turn)));
    Point { name, position, rotation }
}

/// The body of links that are welded together.
fn body(reader: &mut Reader, source: &Source, group: &Group, of_link: &[(usize, Pose)]) -> Body {
    let root = &source.robot.links[group.links[0]];
    let heavy = group.links.iter().filter_map(|&link| {
        let inertial = source.robot.links[link].inertial.as_ref()?;
        let named = source.named.contains(&inertial.mass.name);
        (inertial.mass.value > 0.0 || named).then_some((link, inertial))
    });
    let parts: Vec<(Value, Vector, [Vector; 3])> = heavy
        .map(|(link, inertial)| {
            let turn = algebra::roll_pitch_yaw(&source.vector(&inertial.origin.rpy));
            let pose = of_link[link].1.then(&source.vector(&inertial.origin.xyz), &turn);
            let [xx, yy, zz, xy, xz, yz] = inertial.inertia.each_ref().map(|number| source.value(number));
            let tensor = [[xx, xy.clone(), xz.clone()], [xy, yy, yz.clone()], [xz, yz, zz]];
            (source.value(&inertial.mass), pose.position, algebra::turn_tensor(&pose.turn, &tensor))
        })
        .collect();
    let masses: Vec<Value> = parts.iter().map(|(mass, ..)| mass.clone()).collect();
    let mut mass = algebra::sum(&masses);
    let center: Vector = match parts.as_slice() {
        [] => algebra::vector([0.0; 3]),
        [(_, center, _)] => center.clone(),
        parts => std::array::from_fn(|i| {
            let moments: Vec<Value> = parts.iter().map(|(mass, center, _)| algebra::mul(mass, &center[i])).collect();
            algebra::div(&algebra::sum(&moments), &mass)
        }),
    };
    let mut inertia: [Vector; 3] = std::array::from_fn(|i| {
        std::array::from_fn(|k| {
            let terms: Vec<Value> = parts
                .iter()
                .flat_map(|(mass, at, tensor)| {
                    let d: Vector = std::array::from_fn(|i| algebra::sub(&at[i], &center[i]));
                    let apart =
                        if parts.len() > 1 { algebra::steiner(mass, &d)[i][k].clone() } else { algebra::number(0.0) };
                    [tensor[i][k].clone(), apart]
                })
                .collect();
            algebra::sum(&terms)
        })
    });
    if mass.is_zero() {
        let message =
            format!("link `{}` moves, but has no mass: {LEAST_MASS} kg and {LEAST_INERTIA} kg m² are taken", root.name);
        reader.diagnostics.push(Diagnostic::warning(root.span.clone(), message));
        mass = algebra::number(LEAST_MASS);
        (0..3).for_each(|i| inertia[i][i] = algebra::number(LEAST_INERTIA));
    } else if let Some(least) = too_small(&mass, &inertia) {
        let message = format!(
            "link `{}` has next to no inertia about some axis: {least:.1e} kg m² are added about each",
            root.name
        );
        reader.diagnostics.push(Diagnostic::warning(root.span.clone(), message));
        (0..3).for_each(|i| inertia[i][i] = algebra::sum(&[inertia[i][i].clone(), algebra::number(least)]));
    }
    let coordinates = [Coordinate::X, Coordinate::Y, Coordinate::Z].into_iter().chain(Coordinate::ORIENTATION);
    let mut element = |i: usize, k: usize| formula(reader, &inertia[i][k]);
    let inertia = Inertia {
        xx: element(0, 0),
        yy: element(1, 1),
        zz: element(2, 2),
        xy: element(0, 1),
        xz: element(0, 2),
        yz: element(1, 2),
    };
    Body {
        name: root.name.clone(),
        mass: Some(formula(reader, &mass)),
        inertia: Some(inertia),
        center_of_mass: Some(formulas(reader, &center)),
        coordinates: coordinates.collect(),
        held: Vec::new(),
        held_orientation: None,
        points: Vec::new(),
    }
}

/// What has to be added to a tensor that turns the equations singular, or nearly; uncertain ones are as they are said to be.
fn too_small(mass: &Value, inertia: &[Vector; 3]) -> Option<f64> {
    let Value::Number(mass) = mass else { return None };
    let mut numbers = [0.0; 9];
    for (slot, value) in numbers.iter_mut().zip(inertia.iter().flatten()) {
        let Value::Number(value) = value else { return None };
        *slot = *value;
    }
    let moments = nalgebra::Matrix3::from_row_slice(&numbers).symmetric_eigenvalues();
    let least = LEAST_RADIUS_SQUARED * mass;
    (moments.min().abs() < least).then_some(least)
}

/// A joint that moves, with the frame it is at on its parent.
fn joint(reader: &mut Reader, source: &Source, built: &Built, index: usize) -> Option<usize> {
    let joint = &source.robot.joints[index];
    let (parent, pose) = &built.places[joint.parent];
    let (parent, child) = ((*parent)?, built.places[joint.child].0?);
    if matches!(joint.kind, Kind::Fixed | Kind::Floating) {
        return None;
    }
    let turn = algebra::roll_pitch_yaw(&source.vector(&joint.origin.rpy));
    let pose = pose.then(&source.vector(&joint.origin.xyz), &turn);
    let mut name = joint.name.clone();
    while reader.model.bodies[parent].points.iter().any(|point| point.name == name) {
        name.push_str("_joint");
    }
    let at = point(reader, name, &pose);
    let points = &mut reader.model.bodies[parent].points;
    points.push(at);
    let between = [PointRef { body: parent, point: Some(points.len() - 1) }, PointRef { body: child, point: None }];
    let axis = unit(joint.axis).map(Formula::number);
    let kind: JointKind = match joint.kind {
        Kind::Prismatic => Prismatic { between, axis: Direction(axis), angle: Formula::number(0.0) }.into(),
        Kind::Planar => Planar { between, normal: Direction(axis) }.into(),
        _ => Revolute { between, axis: Axis(axis) }.into(),
    };
    reader.model.joints.push(Joint::new(joint.name.clone(), kind));
    Some(reader.model.joints.len() - 1)
}

fn unit(axis: [f64; 3]) -> [f64; 3] {
    let length = axis.iter().map(|part| part * part).sum::<f64>().sqrt();
    axis.map(|part| part / length)
}

/// The coordinate of a joint that has one, and the names of it and its rate.
pub fn coordinate(kind: Kind) -> Option<(JointCoordinate, &'static str, &'static str)> {
    match kind {
        Kind::Revolute | Kind::Continuous => Some((JointCoordinate::Angle, "angle", "angular_velocity")),
        Kind::Prismatic => Some((JointCoordinate::Displacement, "displacement", "velocity")),
        _ => None,
    }
}

fn mimic(reader: &mut Reader, source: &Source, built: &Built, index: usize) {
    let joint = &source.robot.joints[index];
    let Some(mimic) = &joint.mimic else { return };
    let (Some(this), Some(other)) = (built.joints[index], built.joints[mimic.joint]) else { return };
    let leader = &source.robot.joints[mimic.joint];
    let (Some((_, position, _)), Some((_, followed, _))) = (coordinate(joint.kind), coordinate(leader.kind)) else {
        return;
    };
    let kind = if joint.kind.turns() && leader.kind.turns() && mimic.multiplier != 0.0 {
        JointKind::from(Gear {
            between: [Turning::Joint(other), Turning::Joint(this)],
            ratio: Formula::number(mimic.multiplier),
            offset: Formula::number(mimic.offset),
        })
    } else {
        let text = format!("({:e})*{}.{followed} + ({:e})", mimic.multiplier, leader.name, mimic.offset);
        JointKind::from(Equation {
            left: formula(reader, &Value::Text(format!("{}.{position}", joint.name))),
            right: formula(reader, &Value::Text(text)),
        })
    };
    let mut name = format!("{}_mimic", joint.name);
    while reader.model.joints.iter().any(|joint| joint.name == name) {
        name.push('_');
    }
    reader.model.joints.push(Joint::new(name, kind));
}

/// The zero configuration, for what the model says nothing of.
pub fn start(reader: &mut Reader, source: &Source, built: &Built) {
    let robot = source.robot;
    let mut poses = vec![Pose::identity(); robot.links.len()];
    let said: HashSet<usize> = reader.model.initial.iter().chain(&reader.model.guess).filter_map(joint_of).collect();
    let bodies: HashSet<usize> = reader.model.initial.iter().chain(&reader.model.guess).filter_map(body_of).collect();
    let place = |reader: &mut Reader, body: usize, pose: &Pose, kept: bool| {
        if bodies.contains(&body) {
            return;
        }
        let coordinates = [Coordinate::X, Coordinate::Y, Coordinate::Z];
        let mut values: Vec<StartValue> = Vec::new();
        for (coordinate, value) in coordinates.into_iter().zip(formulas(reader, &pose.position)) {
            values.push(StartValue::Coordinate { body, coordinate, order: TimeOrder::Position, value });
        }
        let rotation = Rotation::Quaternion(formulas(reader, &pose.turn));
        values.push(StartValue::Orientation { body, rotation });
        if kept { reader.model.initial.extend(values) } else { reader.model.guess.extend(values) }
    };
    if let (true, Some(body)) = (source.floating, built.places[robot.root].0) {
        place(reader, body, &Pose::identity(), true);
    }
    for &index in &robot.order {
        let joint = &robot.joints[index];
        let nominal = |numbers: &[Number; 3]| numbers.each_ref().map(|number| Value::Number(number.value));
        let turn = algebra::roll_pitch_yaw(&nominal(&joint.origin.rpy));
        poses[joint.child] = poses[joint.parent].then(&nominal(&joint.origin.xyz), &turn);
        let body = built.places[joint.child].0;
        match (joint.kind, built.joints[index], coordinate(joint.kind), body) {
            (Kind::Floating, _, _, Some(body)) => place(reader, body, &poses[joint.child], true),
            (Kind::Planar, Some(_), _, Some(body)) => place(reader, body, &poses[joint.child], false),
            (_, Some(found), Some((coordinate, ..)), _) if joint.mimic.is_none() && !said.contains(&found) => {
                let value = Formula::number(0.0);
                let order = TimeOrder::Position;
                reader.model.initial.push(StartValue::Joint { joint: found, coordinate, order, value });
            }
            _ => {}
        }
    }
}

fn joint_of(value: &StartValue) -> Option<usize> {
    match value {
        StartValue::Joint { joint, order: TimeOrder::Position, .. } => Some(*joint),
        _ => None,
    }
}

fn body_of(value: &StartValue) -> Option<usize> {
    match value {
        StartValue::Coordinate { body, order: TimeOrder::Position, .. } | StartValue::Orientation { body, .. } => {
            Some(*body)
        }
        _ => None,
    }
}

/// What is observed where the model says nothing: the joints' positions, and the place of a base that floats.
pub fn outputs(reader: &mut Reader, source: &Source, built: &Built) {
    let mut push = |name: String, text: String, unit: &str| {
        let formula = formula(reader, &Value::Text(text));
        reader.model.outputs.push(Output { name, formula, unit: unit.to_owned() });
    };
    if source.floating {
        let root = &source.robot.links[source.robot.root].name;
        ["x", "y", "z"].into_iter().for_each(|axis| push(format!("{root}_{axis}"), format!("{root}.{axis}"), "m"));
    }
    for &index in &source.robot.order {
        let joint = &source.robot.joints[index];
        let child = &source.robot.links[joint.child].name;
        match (coordinate(joint.kind), built.joints[index]) {
            (Some((_, position, _)), Some(_)) => {
                let unit = if joint.kind.turns() { "rad" } else { "m" };
                push(joint.name.clone(), format!("{}.{position}", joint.name), unit);
            }
            (None, _) if joint.kind != Kind::Fixed && built.places[joint.child].0.is_some() => {
                let mut part = |axis: &str| push(format!("{}_{axis}", joint.name), format!("{child}.{axis}"), "m");
                ["x", "y", "z"].into_iter().for_each(&mut part);
            }
            _ => {}
        }
    }
}

fn tree(source: &Source, built: &Built) -> RobotTree {
    let robot = source.robot;
    let mut depth = vec![0; robot.links.len()];
    let above: HashMap<usize, &UrdfJoint> = robot.joints.iter().map(|joint| (joint.child, joint)).collect();
    let links = std::iter::once(robot.root).chain(robot.order.iter().map(|&joint| robot.joints[joint].child));
    let links = links.map(|link| {
        let joint = above.get(&link).map(|joint| {
            depth[link] = depth[joint.parent] + 1;
            let word = Kind::ALL.iter().find(|(_, kind)| *kind == joint.kind).map_or("", |(word, _)| word);
            let limits = joint.limits.as_ref().filter(|_| joint.kind != Kind::Continuous);
            TreeJoint {
                name: joint.name.clone(),
                kind: word,
                axis: coordinate(joint.kind).map(|_| joint.axis),
                limits: limits.map(|limits| [limits.lower.value, limits.upper.value]),
                unit: if joint.kind.turns() { "rad" } else { "m" },
                damping: joint.damping.value,
                friction: joint.friction.value,
                mimics: joint.mimic.as_ref().map(|mimic| robot.joints[mimic.joint].name.clone()),
            }
        });
        let (name, place) = (robot.links[link].name.clone(), built.frames[link]);
        let mass = robot.links[link].inertial.as_ref().map(|inertial| inertial.mass.value);
        TreeLink { name, depth: depth[link], mass, place, joint }
    });
    RobotTree { name: robot.name.clone(), links: links.collect() }
}
