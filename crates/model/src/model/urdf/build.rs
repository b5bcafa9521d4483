//! [`Robot`](crate::robots::urdf::robot::Robot) → bodies and joints of the model.

use std::collections::HashMap;

use super::bodies::{Group, body};
use super::joints::{joint, mimic};
use super::source::{Built, ParsedUrdf, coordinate, point};
use crate::grammar::{JointCoordinate, PointRef};
use crate::model::description::{RobotTree, TreeJoint, TreeLink};
use crate::model::names::Reader;
use crate::robots::algebra::{self, Pose};
use crate::robots::number::Number;
use crate::robots::urdf::robot::{Joint as UrdfJoint, UrdfJointType};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;

/// Adds bodies and joints to the model.
pub fn declare(reader: &mut Reader, source: &ParsedUrdf) -> Built {
    let robot = source.robot;
    let mut groups = vec![Group { links: vec![robot.root], behind: None, body: None }];
    let mut of_link = vec![(0, Pose::identity()); robot.links.len()];
    for &index in &robot.order {
        let joint = &robot.joints[index];
        if source.welds(joint) {
            let rotation = algebra::roll_pitch_yaw(&source.vector(&joint.origin.rpy));
            let (group, pose) = &of_link[joint.parent];
            of_link[joint.child] = (*group, pose.then(&source.vector(&joint.origin.xyz), &rotation));
            groups[of_link[joint.child].0].links.push(joint.child);
        } else {
            of_link[joint.child] = (groups.len(), Pose::identity());
            groups.push(Group { links: vec![joint.child], behind: Some(index), body: None });
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
            reader.model.mechanism_mut().bodies.push(body);
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
            let points = &mut reader.model.mechanism_mut().bodies[body].points;
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
    reader.model.mechanism_mut().robot = Some(tree(source, &built));
    built
}

/// Ends of the chain without mass, on which nothing acts.
fn left_out(reader: &mut Reader, source: &ParsedUrdf, groups: &[Group], of_link: &[(usize, Pose)]) -> Vec<bool> {
    let robot = source.robot;
    let mut left_out = vec![false; groups.len()];
    let mut holds = vec![false; groups.len()];
    for &index in robot.order.iter().rev() {
        let joint = &robot.joints[index];
        if source.welds(joint) {
            continue;
        }
        let (group, parent) = (of_link[joint.child].0, of_link[joint.parent].0);
        let named = |link: &usize| source.words.contains(&robot.links[*link].name);
        let wanted = groups[group].links.iter().any(named) || source.words.contains(&joint.name);
        if source.has_inertia(&groups[group].links) || holds[group] || wanted {
            holds[parent] = true;
            continue;
        }
        left_out[group] = true;
        let link = &robot.links[joint.child];
        let message =
            format!("link `{}` moves, but has no mass: it is omitted, with its joint `{}`", link.name, joint.name);
        reader.diagnostics.push(Diagnostic::warning(Code::MasslessLink, link.span.clone(), message));
    }
    left_out
}

/// The tree as the file has it.
fn tree(source: &ParsedUrdf, built: &Built) -> RobotTree {
    let robot = source.robot;
    let mut depth = vec![0; robot.links.len()];
    let above: HashMap<usize, &UrdfJoint> = robot.joints.iter().map(|joint| (joint.child, joint)).collect();
    let links = std::iter::once(robot.root).chain(robot.order.iter().map(|&joint| robot.joints[joint].child));
    let links = links.map(|link| {
        let joint = above.get(&link).map(|joint| {
            depth[link] = depth[joint.parent] + 1;
            let limits = joint.limits.as_ref().filter(|_| joint.kind != UrdfJointType::Continuous);
            let end = |number: &Option<Number>| number.as_ref().map(|number| number.value);
            TreeJoint {
                name: joint.name.clone(),
                kind: joint.kind.word(),
                axis: coordinate(joint.kind).map(|_| joint.axis),
                limits: limits.map_or([None; 2], |limits| [end(&limits.lower), end(&limits.upper)]),
                coordinate: if joint.kind.turns() { JointCoordinate::Angle } else { JointCoordinate::Displacement },
                damping: joint.damping.value,
                friction: joint.friction.value,
                mimics: joint.mimic.as_ref().map(|mimic| robot.joints[mimic.joint].name.clone()),
            }
        });
        let (name, place) = (robot.links[link].name.clone(), built.frames[link]);
        let mass = robot.links[link].inertial.as_ref().map(|inertial| inertial.mass.value);
        let visuals = robot.links[link].visuals.clone();
        TreeLink { name, depth: depth[link], mass, place, joint, visuals }
    });
    RobotTree { name: robot.name.clone(), links: links.collect() }
}
