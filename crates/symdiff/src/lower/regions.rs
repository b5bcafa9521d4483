//! Regions: nodes of a tape that are used only under a condition, grouped together.
//!
//! A node belongs to the innermost region that contains all its uses. The value of a `Select` (`SelectElse`) node is
//! used in a region of that condition, every other operand in the region of the node that uses it.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use rustc_hash::FxHashMap;

use super::node_table::NodeTable;
use super::readers::Readers;
use super::tape::Guard;
use crate::expr::{Binary, Expr, Graph, Node, Unary};
use crate::tuning::TUNING;

/// Index of a region; 0 is outside of all regions.
pub(crate) type RegionId = usize;
pub(crate) const OUTSIDE: RegionId = 0;

#[derive(Clone, Copy, Debug)]
struct Nested {
    within: RegionId,
    /// `None` for the outside.
    guard: Option<Guard>,
    depth: usize,
}

/// The regions of one tape, with their nodes.
#[derive(Debug)]
pub(crate) struct Regions {
    nested: Vec<Nested>,
    /// The region of each node; empty if there is only the outside.
    of: NodeTable,
}

impl Regions {
    /// The regions of the nodes of `body`, children first; `wanted` are used from outside, some only under a guard.
    pub(crate) fn new(graph: &Graph, body: &[Expr], wanted: impl Iterator<Item = (Expr, Option<Guard>)>) -> Self {
        let outside = Nested { within: OUTSIDE, guard: None, depth: 0 };
        let mut regions = Self { nested: vec![outside], of: NodeTable::new(0) };
        let mut known = FxHashMap::default();
        let guarded = |expr: &Expr| matches!(graph.node(*expr), Node::Binary(Binary::Select | Binary::SelectElse, ..));
        let wanted: Vec<_> = wanted.collect();
        if wanted.iter().all(|(_, guard)| guard.is_none()) && !body.iter().any(guarded) {
            return regions;
        }
        regions.of = NodeTable::new(graph.len());
        for (expr, guard) in wanted {
            let region = guard.map_or(OUTSIDE, |guard| regions.enter(&mut known, OUTSIDE, guard));
            if let Some(guard) = guard {
                regions.use_in(guard.condition, OUTSIDE);
            }
            regions.use_in(expr, region);
        }
        let mut circular: FxHashMap<Expr, Vec<Expr>> = FxHashMap::default();
        for &expr in body {
            if let Node::Unary(Unary::Sin | Unary::Cos, argument) = graph.node(expr) {
                circular.entry(argument).or_default().push(expr);
            }
        }
        // Uses may move a node out of a region, never into one; so this ends.
        let mut settled = false;
        while !settled {
            settled = true;
            for &expr in body.iter().rev() {
                let region = regions.of(expr);
                let mut note = |regions: &mut Self, child: Expr, region: RegionId| {
                    settled &= !regions.use_in(child, region);
                };
                match graph.node(expr) {
                    Node::Binary(function @ (Binary::Select | Binary::SelectElse), condition, value) => {
                        let guard = Guard { condition, elsewhere: function == Binary::SelectElse };
                        let inner = regions.enter(&mut known, region, guard);
                        note(&mut regions, condition, region);
                        note(&mut regions, value, inner);
                    }
                    // Sine and cosine of one argument are one instruction.
                    Node::Unary(Unary::Sin | Unary::Cos, argument) => {
                        note(&mut regions, argument, region);
                        circular[&argument].iter().for_each(|&other| note(&mut regions, other, region));
                    }
                    node => node.children().for_each(|child| note(&mut regions, child, region)),
                }
            }
        }
        regions.dissolve_small(body);
        regions
    }

    /// The region that a node of the tape belongs to.
    pub(crate) fn of(&self, expr: Expr) -> RegionId {
        if self.nested.len() == 1 {
            return OUTSIDE;
        }
        self.of.get(expr).map_or(OUTSIDE, |region| region as RegionId)
    }

    /// The region of a guard within a region, if there is one.
    pub(crate) fn inner(&self, within: RegionId, guard: Guard) -> Option<RegionId> {
        (0..self.nested.len())
            .find(|&region| self.nested[region].within == within && self.nested[region].guard == Some(guard))
    }

    /// Whether there are no regions.
    pub(crate) fn is_empty(&self) -> bool {
        self.nested.iter().all(|region| region.guard.is_none())
    }

    /// Guard of a region; `None` outside.
    pub(crate) fn guard(&self, region: RegionId) -> Option<Guard> {
        self.nested[region].guard
    }

    /// The conditions of a region and of those around it.
    pub(crate) fn conditions(&self, region: RegionId) -> impl Iterator<Item = Expr> {
        self.outward(region).filter_map(|region| self.nested[region].guard).map(|guard| guard.condition)
    }

    /// The number of regions to leave, and the regions to enter, on the way from one to another.
    pub(crate) fn way(&self, from: RegionId, to: RegionId) -> (usize, Vec<RegionId>) {
        let common = self.common(from, to);
        let mut entered: Vec<RegionId> = self.outward(to).take_while(|&region| region != common).collect();
        entered.reverse();
        (self.nested[from].depth - self.nested[common].depth, entered)
    }

    /// A region, the one around it, and so on, without the outside.
    fn outward(&self, region: RegionId) -> impl Iterator<Item = RegionId> {
        std::iter::successors(Some(region), |&region| Some(self.nested[region].within))
            .take_while(|&region| region != OUTSIDE)
    }

    /// The innermost region around both.
    fn common(&self, mut a: RegionId, mut b: RegionId) -> RegionId {
        while a != b {
            if self.nested[a].depth >= self.nested[b].depth {
                a = self.nested[a].within;
            } else {
                b = self.nested[b].within;
            }
        }
        a
    }

    fn enter(
        &mut self,
        known: &mut FxHashMap<(RegionId, Guard), RegionId>,
        within: RegionId,
        guard: Guard,
    ) -> RegionId {
        if self.outward(within).any(|region| self.nested[region].guard == Some(guard)) {
            return within;
        }
        *known.entry((within, guard)).or_insert_with(|| {
            self.nested.push(Nested { within, guard: Some(guard), depth: self.nested[within].depth + 1 });
            self.nested.len() - 1
        })
    }

    /// Adds a use; returns whether it moved the node.
    fn use_in(&mut self, expr: Expr, region: RegionId) -> bool {
        let Some(before) = self.of.get(expr) else {
            self.of.insert(expr, region as u32);
            return false;
        };
        let before = before as RegionId;
        let common = self.common(before, region);
        self.of.insert(expr, common as u32);
        common != before
    }

    /// Moves the nodes of small regions to the regions around them.
    fn dissolve_small(&mut self, body: &[Expr]) {
        let mut sizes = vec![0; self.nested.len()];
        for &expr in body {
            self.outward(self.of(expr)).for_each(|region| sizes[region] += 1);
        }
        // Regions come after those that contain them.
        let mut kept: Vec<RegionId> = vec![OUTSIDE];
        for (region, &size) in sizes.iter().enumerate().skip(1) {
            let Nested { within, .. } = self.nested[region];
            let outer = kept[within];
            self.nested[region].within = outer;
            self.nested[region].depth = self.nested[outer].depth + 1;
            if size < TUNING.least_region {
                self.nested[region].guard = None;
                kept.push(outer);
            } else {
                kept.push(region);
            }
        }
        body.iter().for_each(|&expr| self.of.insert(expr, kept[self.of(expr)] as u32));
    }
}

/// An order of `count` instructions, operands first, that stays within a region as long as an instruction of it can be
/// computed; otherwise in the given order. `block_of` gives the region of an instruction.
pub(crate) fn order(
    regions: &Regions,
    count: usize,
    block_of: impl Fn(usize) -> RegionId,
    readers: &Readers,
) -> Vec<usize> {
    let mut missing = readers.missing(count);
    let mut ready: BTreeMap<RegionId, BinaryHeap<Reverse<usize>>> = BTreeMap::new();
    for index in (0..count).filter(|&index| missing[index] == 0) {
        ready.entry(block_of(index)).or_default().push(Reverse(index));
    }
    let mut ordered = Vec::with_capacity(count);
    let mut current = OUTSIDE;
    loop {
        if let Some(Reverse(index)) = ready.get_mut(&current).and_then(BinaryHeap::pop) {
            ordered.push(index);
            for &reader in readers.of_writer(index) {
                missing[reader] -= 1;
                if missing[reader] == 0 {
                    ready.entry(block_of(reader)).or_default().push(Reverse(reader));
                }
            }
            continue;
        }
        // Into the inner region with the earliest instruction, or out of this one.
        ready.retain(|_, places| !places.is_empty());
        let inner = ready.iter().filter(|&(&region, _)| regions.common(region, current) == current);
        match inner.min_by_key(|(_, places)| places.peek().map(|first| first.0)) {
            Some((&region, _)) => current = region,
            None if current == OUTSIDE => break,
            None => current = regions.nested[current].within,
        }
    }
    debug_assert_eq!(ordered.len(), count, "nothing needs itself");
    ordered
}
