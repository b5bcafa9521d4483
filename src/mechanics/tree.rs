//! Which bodies their joints carry.
//!
//! In joint coordinates a body has none of its own: its place follows from that of another body and from the coordinates of
//! the joint between them. The joints chosen for that form trees, whose roots are the ground and bodies with coordinates
//! of their own; what is left of the joints closes loops, by constraints.

use std::collections::VecDeque;

use crate::model::{Body, Coordinate, Description, JointKind, PointRef};

/// A joint that carries a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Carrier {
    /// Joint index.
    pub joint: usize,
    /// On the body that carries.
    pub parent: PointRef,
    /// On the body that is carried.
    pub child: PointRef,
    /// Whether the body that is carried is the joint's first.
    pub reversed: bool,
}

/// The trees.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tree {
    /// What carries each body, if anything does.
    pub carriers: Vec<Option<Carrier>>,
    /// The bodies that are carried, parents first.
    pub order: Vec<usize>,
    /// Whether each joint carries a body.
    carrying: Vec<bool>,
}

impl Tree {
    /// Nothing is carried: every body has coordinates of its own.
    pub fn absolute(description: &Description) -> Self {
        let (bodies, joints) = (description.bodies.len(), description.joints.len());
        Self { carriers: vec![None; bodies], order: Vec::new(), carrying: vec![false; joints] }
    }

    /// As much as can be carried, near the roots first. `steady` says of a joint whether what it is made of stays as it
    /// is.
    pub fn spanning(description: &Description, mut steady: impl FnMut(&JointKind) -> bool) -> Self {
        let bodies = &description.bodies;
        let mut tree = Self::absolute(description);
        let mut joints = vec![Vec::new(); bodies.len()];
        for (index, joint) in description.joints.iter().enumerate() {
            let Some([first, second]) = joint.kind.between().filter(|_| carries(&joint.kind) && steady(&joint.kind))
            else {
                continue;
            };
            joints[first.body].push(Carrier { joint: index, parent: first, child: second, reversed: false });
            joints[second.body].push(Carrier { joint: index, parent: second, child: first, reversed: true });
        }
        let mut reached: Vec<bool> = bodies.iter().map(|body| !is_free(body, description.space.spatial)).collect();
        let mut queue: VecDeque<usize> = (0..bodies.len()).filter(|&body| reached[body]).collect();
        let mut next_root = 0;
        loop {
            while let Some(body) = queue.pop_front() {
                for &carrier in &joints[body] {
                    let child = carrier.child.body;
                    if !reached[child] {
                        reached[child] = true;
                        tree.carriers[child] = Some(carrier);
                        tree.carrying[carrier.joint] = true;
                        tree.order.push(child);
                        queue.push_back(child);
                    }
                }
            }
            // What nothing joins to a root moves freely, and may carry others.
            let Some(root) = (next_root..bodies.len()).find(|&body| !reached[body]) else { break };
            reached[root] = true;
            queue.push_back(root);
            next_root = root + 1;
        }
        tree
    }

    /// Whether nothing is carried.
    pub fn is_absolute(&self) -> bool {
        self.order.is_empty()
    }

    /// Why joint coordinates are not worth a try: joints close loops, or bodies are more than so many joints from their roots
    /// on average.
    pub fn too_involved(&self, description: &Description, deepest: usize) -> Option<String> {
        if self.is_absolute() {
            return None;
        }
        let mut joints = description.joints.iter().zip(&self.carrying);
        if joints.any(|(joint, carrying)| !carrying && joint.kind.between().is_some()) {
            return Some("joints close loops (`formulation: joint` is there to be tried)".to_owned());
        }
        let mut depths = vec![0; self.carriers.len()];
        for &body in &self.order {
            depths[body] = self.carriers[body].map_or(0, |carrier| depths[carrier.parent.body] + 1);
        }
        let depth = depths.iter().sum::<usize>().div_ceil(self.order.len());
        (depth > deepest)
            .then(|| format!("its bodies are {depth} joints from their roots, and each would depend on all before it"))
    }

    /// Whether a joint carries a body.
    pub fn uses(&self, joint: usize) -> bool {
        self.carrying[joint]
    }
}

/// Whether nothing of a body is held, so that a joint alone may say where it is.
fn is_free(body: &Body, spatial: bool) -> bool {
    let has = |coordinate: &Coordinate| body.coordinates.contains(coordinate);
    let freedoms: &[Coordinate] = if spatial {
        &[Coordinate::X, Coordinate::Y, Coordinate::Z, Coordinate::Euler(0)]
    } else {
        &[Coordinate::X, Coordinate::Y, Coordinate::Angle]
    };
    freedoms.iter().all(has) && body.held.is_empty()
}

/// Whether a joint's freedoms are angles about and displacements along an axis.
fn carries(kind: &JointKind) -> bool {
    matches!(
        kind,
        JointKind::Revolute { .. }
            | JointKind::Prismatic { .. }
            | JointKind::Fixed { .. }
            | JointKind::Cylindrical { .. }
            | JointKind::Screw { .. }
    )
}
