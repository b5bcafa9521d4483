//! Trees of bodies: children and their parents.
//!
//! In joint coordinates a child has none of its own: its position follows from that of its parent and from the
//! coordinates of its inboard joint, the one between them. The inboard joints form trees, whose roots are the ground
//! and bodies with coordinates of their own; the joints that are left close loops, by constraints. Bodies that are
//! merged are children of one of them in absolute coordinates too.

use std::collections::VecDeque;

use super::questions::Questions;
use crate::assemble::tuning::TUNING;
use crate::elements::joints::Mobilizer;
use crate::grammar::PointRef;
use crate::model::{Description, StartValue};

/// The joint between a child and its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InboardJoint {
    /// Joint index.
    pub joint: usize,
    /// Its point on the parent.
    pub parent: PointRef,
    /// Its point on the child.
    pub child: PointRef,
    /// Whether the child is the joint's first body.
    pub reversed: bool,
}

/// The trees.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tree {
    /// The inboard joint of each body; `None` of a root.
    pub inboard: Vec<Option<InboardJoint>>,
    /// The children, after their parents.
    pub order: Vec<usize>,
    /// Whether each joint is an inboard joint.
    joints: Vec<bool>,
    /// Whether each body is merged with its parent.
    merged: Vec<bool>,
}

impl Tree {
    /// Every body has coordinates of its own, but those that are merged.
    pub fn absolute(questions: &Questions) -> Self {
        Self::spanning(questions, |_| false)
    }

    /// Makes as many children as possible, near the roots first. `is_time_independent` tests the formulas of a
    /// mobilizer.
    pub fn spanning(questions: &Questions, mut is_time_independent: impl FnMut(&Mobilizer) -> bool) -> Self {
        let description = questions.description;
        let bodies = &description.bodies;
        let mut tree = Self {
            inboard: vec![None; bodies.len()],
            order: Vec::new(),
            joints: vec![false; description.joints.len()],
            merged: vec![false; bodies.len()],
        };
        let (mut joints, mut welds) = (vec![Vec::new(); bodies.len()], vec![Vec::new(); bodies.len()]);
        let mut is_cut = vec![false; description.joints.len()];
        questions.cut.iter().for_each(|&joint| is_cut[joint] = true);
        for (index, joint) in description.joints.iter().enumerate() {
            let Some([first, second]) = joint.kind.between() else { continue };
            let list = match joint.kind.mobilizer() {
                Some(_) if questions.is_merged(index) => &mut welds,
                Some(mobilizer) if !is_cut[index] && is_time_independent(&mobilizer) => &mut joints,
                _ => continue,
            };
            list[first.body].push(InboardJoint { joint: index, parent: first, child: second, reversed: false });
            list[second.body].push(InboardJoint { joint: index, parent: second, child: first, reversed: true });
        }
        let mut reached: Vec<bool> = bodies.iter().map(|body| !body.is_free(description.space.spatial)).collect();
        let mut queue = VecDeque::new();
        for root in (0..bodies.len()).filter(|&body| reached[body]).collect::<Vec<_>>() {
            tree.merge(root, &welds, &mut reached, &mut queue);
        }
        // Bodies that nothing joins to a root move freely, and may have children. The root of merged bodies is the one
        // that the start names.
        let named = if welds.iter().all(Vec::is_empty) { Vec::new() } else { named_at_start(description) };
        let mut roots = named.into_iter().chain(0..bodies.len());
        loop {
            while let Some(body) = queue.pop_front() {
                for &joint in &joints[body] {
                    let child = joint.child.body;
                    if !reached[child] {
                        reached[child] = true;
                        tree.add_child(joint);
                        tree.merge(child, &welds, &mut reached, &mut queue);
                    }
                }
            }
            let Some(root) = roots.find(|&body| !reached[body]) else { break };
            reached[root] = true;
            tree.merge(root, &welds, &mut reached, &mut queue);
        }
        tree
    }

    fn add_child(&mut self, inboard: InboardJoint) {
        self.inboard[inboard.child.body] = Some(inboard);
        self.joints[inboard.joint] = true;
        self.order.push(inboard.child.body);
    }

    /// Merges a body that was reached with all that is welded to it, and lets them have children.
    fn merge(&mut self, body: usize, welds: &[Vec<InboardJoint>], reached: &mut [bool], queue: &mut VecDeque<usize>) {
        let mut next = vec![body];
        while let Some(body) = next.pop() {
            queue.push_back(body);
            for &weld in &welds[body] {
                let child = weld.child.body;
                if !reached[child] {
                    reached[child] = true;
                    self.merged[child] = true;
                    self.add_child(weld);
                    next.push(child);
                }
            }
        }
    }

    /// Whether all children are merged with their parents.
    pub fn is_absolute(&self) -> bool {
        self.order.iter().all(|&body| self.merged[body])
    }

    /// Whether a body is merged with its parent.
    pub fn merges(&self, body: usize) -> bool {
        self.merged[body]
    }

    /// The joints that close loops of the trees.
    pub fn closing(&self, description: &Description) -> Vec<usize> {
        let closes = |&joint: &usize| !self.joints[joint] && description.joints[joint].kind.between().is_some();
        (0..self.joints.len()).filter(closes).collect()
    }

    /// Whether joints close loops of the trees.
    pub fn closes_loops(&self, description: &Description) -> bool {
        !self.closing(description).is_empty()
    }

    /// The inboard joints between two bodies, without those of merged bodies.
    pub fn joints_between(&self, bodies: [usize; 2]) -> Vec<usize> {
        let [mut first, second] = bodies.map(|body| self.joints_to_root(body));
        let (only_second, shared): (Vec<_>, Vec<_>) = second.into_iter().partition(|joint| !first.contains(joint));
        first.retain(|joint| !shared.contains(joint));
        first.extend(only_second);
        first
    }

    /// The root of a body's tree.
    pub fn root_of(&self, mut body: usize) -> usize {
        while let Some(inboard) = self.inboard[body] {
            body = inboard.parent.body;
        }
        body
    }

    fn joints_to_root(&self, mut body: usize) -> Vec<usize> {
        let mut joints = Vec::new();
        while let Some(inboard) = self.inboard[body] {
            if !self.merged[body] {
                joints.push(inboard.joint);
            }
            body = inboard.parent.body;
        }
        joints
    }

    /// Why joint coordinates are not worth a try: bodies are more than `deepest` joints from their roots on average.
    pub fn too_deep(&self, deepest: usize) -> Option<String> {
        if self.is_absolute() {
            return None;
        }
        let depths = self.depths();
        let depth = depths.iter().sum::<usize>().div_ceil(self.order.len());
        (depth > deepest)
            .then(|| format!("its bodies are {depth} joints from their roots, and each would depend on all before it"))
    }

    /// Joints on the way from each body to its root.
    fn depths(&self) -> Vec<usize> {
        let mut depths = vec![0; self.inboard.len()];
        for &body in &self.order {
            depths[body] =
                self.inboard[body].map_or(0, |inboard| depths[inboard.parent.body] + usize::from(!self.merged[body]));
        }
        depths
    }

    /// Least number of multiplications that an elimination takes in joint coordinates. A coordinate's row of M has an
    /// entry for each joint on its way to the root, and changes as many rows (Featherstone, *Rigid Body Dynamics
    /// Algorithms* (2008), ch. 6.5); or links are eliminated one by one.
    pub fn elimination(&self) -> usize {
        let of_joints: Vec<usize> = self.order.iter().copied().filter(|&body| !self.merged[body]).collect();
        let depths = self.depths();
        let whole = of_joints.iter().map(|&body| depths[body] * (depths[body] + 1) / 2).fold(0, usize::saturating_add);
        whole.min(TUNING.link_multiplications * of_joints.len())
    }

    /// Whether a joint is an inboard joint.
    pub fn contains(&self, joint: usize) -> bool {
        self.joints[joint]
    }
}

/// Bodies whose own coordinates the start gives: given values before guesses.
fn named_at_start(description: &Description) -> Vec<usize> {
    let body = |value: &StartValue| match value {
        StartValue::Coordinate { body, .. }
        | StartValue::Orientation { body, .. }
        | StartValue::AngularVelocity { body, .. } => Some(*body),
        StartValue::Joint { .. }
        | StartValue::AngularRate { .. }
        | StartValue::RollPitchYaw { .. }
        | StartValue::Point { .. } => None,
    };
    description.initial.iter().chain(&description.guess).filter_map(body).collect()
}
