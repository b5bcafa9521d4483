//! Which bodies their joints carry.
//!
//! In joint coordinates a body has none of its own: its place follows from that of another body and from the coordinates of
//! the joint between them. The joints chosen for that form trees, whose roots are the ground and bodies with coordinates
//! of their own; what is left of the joints closes loops, by constraints. Bodies that are merged follow one of them in absolute coordinates too.

use std::collections::VecDeque;

use crate::elements::joints::Mobilizer;
use crate::grammar::PointRef;
use crate::model::{Description, StartValue};

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
    /// Whether each body is merged with what carries it.
    merged: Vec<bool>,
}

impl Tree {
    /// Every body has coordinates of its own, but those that are merged.
    pub fn absolute(description: &Description) -> Self {
        Self::spanning(description, |_| false)
    }

    /// As much as can be carried, near the roots first. `steady` says of a joint whether what it is made of stays as it
    /// is.
    pub fn spanning(description: &Description, mut steady: impl FnMut(&Mobilizer) -> bool) -> Self {
        let bodies = &description.bodies;
        let mut tree = Self {
            carriers: vec![None; bodies.len()],
            order: Vec::new(),
            carrying: vec![false; description.joints.len()],
            merged: vec![false; bodies.len()],
        };
        let (mut joints, mut welds) = (vec![Vec::new(); bodies.len()], vec![Vec::new(); bodies.len()]);
        for (index, joint) in description.joints.iter().enumerate() {
            let Some([first, second]) = joint.kind.between() else { continue };
            let list = match joint.kind.mobilizer() {
                Some(_) if joint.merged => &mut welds,
                Some(mobilizer) if steady(&mobilizer) => &mut joints,
                _ => continue,
            };
            list[first.body].push(Carrier { joint: index, parent: first, child: second, reversed: false });
            list[second.body].push(Carrier { joint: index, parent: second, child: first, reversed: true });
        }
        let mut reached: Vec<bool> = bodies.iter().map(|body| !body.is_free(description.space.spatial)).collect();
        let mut queue = VecDeque::new();
        for root in (0..bodies.len()).filter(|&body| reached[body]).collect::<Vec<_>>() {
            tree.merge(root, &welds, &mut reached, &mut queue);
        }
        // What nothing joins to a root moves freely, and may carry others; of merged bodies the one that the start names.
        let named = if welds.iter().all(Vec::is_empty) { Vec::new() } else { named_at_start(description) };
        let mut roots = named.into_iter().chain(0..bodies.len());
        loop {
            while let Some(body) = queue.pop_front() {
                for &carrier in &joints[body] {
                    let child = carrier.child.body;
                    if !reached[child] {
                        reached[child] = true;
                        tree.carry(carrier);
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

    fn carry(&mut self, carrier: Carrier) {
        self.carriers[carrier.child.body] = Some(carrier);
        self.carrying[carrier.joint] = true;
        self.order.push(carrier.child.body);
    }

    /// Merges a body that was reached with all that is welded to it, and lets them carry others.
    fn merge(&mut self, body: usize, welds: &[Vec<Carrier>], reached: &mut [bool], queue: &mut VecDeque<usize>) {
        let mut next = vec![body];
        while let Some(body) = next.pop() {
            queue.push_back(body);
            for &carrier in &welds[body] {
                let child = carrier.child.body;
                if !reached[child] {
                    reached[child] = true;
                    self.merged[child] = true;
                    self.carry(carrier);
                    next.push(child);
                }
            }
        }
    }

    /// Whether nothing is carried but what is merged.
    pub fn is_absolute(&self) -> bool {
        self.order.iter().all(|&body| self.merged[body])
    }

    /// Whether a body is merged with what carries it.
    pub fn merges(&self, body: usize) -> bool {
        self.merged[body]
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
            depths[body] =
                self.carriers[body].map_or(0, |carrier| depths[carrier.parent.body] + usize::from(!self.merged[body]));
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

/// Bodies whose own coordinates the start gives, what is kept before what is guessed.
fn named_at_start(description: &Description) -> Vec<usize> {
    let body = |value: &StartValue| match value {
        StartValue::Coordinate { body, .. }
        | StartValue::Orientation { body, .. }
        | StartValue::AngularVelocity { body, .. } => Some(*body),
        StartValue::Joint { .. } => None,
    };
    description.initial.iter().chain(&description.guess).filter_map(body).collect()
}
