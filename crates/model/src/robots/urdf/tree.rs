//! Links and joints must be one tree.

use super::robot::Robot;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};

/// Finds the root and the order of the joints; reports why there is none.
pub fn order(robot: &mut Robot, diagnostics: &mut Diagnostics) -> bool {
    let mut above: Vec<Option<usize>> = vec![None; robot.links.len()];
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); robot.links.len()];
    for (index, joint) in robot.joints.iter().enumerate() {
        if let Some(first) = above[joint.child] {
            let name = &robot.links[joint.child].name;
            let message = format!("link `{name}` is the child of two joints: a URDF is a tree");
            let help = "close a loop by a joint in a YAML model that names the file".to_owned();
            let error = Diagnostic::error(Code::NotATree, joint.span.clone(), message).help(help);
            diagnostics.push(error.also(robot.joints[first].span.clone(), "the first one"));
            return false;
        }
        above[joint.child] = Some(index);
        children[joint.parent].push(index);
    }
    let roots: Vec<usize> = (0..robot.links.len()).filter(|&link| above[link].is_none()).collect();
    let Some(&root) = roots.first() else {
        let message = "every link is the child of a joint: the links form a loop, but a URDF is a tree";
        diagnostics.push(Diagnostic::error(Code::NotATree, robot.links[0].span.clone(), message));
        return false;
    };
    if let Some(&second) = roots.get(1) {
        let [first, other] = [root, second].map(|link| &robot.links[link]);
        let message = format!("no joint leads to link `{}`, nor to `{}`: a URDF has one root", other.name, first.name);
        let error = Diagnostic::error(Code::NotATree, other.span.clone(), message);
        diagnostics.push(error.also(first.span.clone(), "the first root"));
        return false;
    }
    let mut open: Vec<usize> = children[root].iter().rev().copied().collect();
    while let Some(joint) = open.pop() {
        robot.order.push(joint);
        open.extend(children[robot.joints[joint].child].iter().rev());
    }
    robot.root = root;
    if robot.order.len() < robot.joints.len() {
        let reached = |joint: &usize| robot.order.contains(joint);
        let stray = (0..robot.joints.len()).find(|joint| !reached(joint));
        let span = stray.map_or(0..0, |joint| robot.joints[joint].span.clone());
        let message = "this joint is in a loop that the root does not lead to: a URDF is a tree";
        diagnostics.push(Diagnostic::error(Code::NotATree, span, message));
        return false;
    }
    true
}
