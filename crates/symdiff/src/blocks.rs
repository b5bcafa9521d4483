//! Blocks: what is needed only under a condition, found in a tape's nodes and brought together.
//!
//! A node belongs to the innermost block that all its uses have in common. The value of a `Where` (`Elsewhere`) node is used
//! in a block of that condition, everything else where the node that uses it stands.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use rustc_hash::FxHashMap;

use crate::expr::{Binary, Expr, Graph, Node, Unary};
use crate::tape::Guard;

/// Blocks of fewer nodes than this are not worth the question.
const LEAST: usize = 4;

/// A block's place among the blocks; 0 is no block at all.
pub(crate) type BlockId = usize;
pub(crate) const OUTSIDE: BlockId = 0;

#[derive(Clone, Copy, Debug)]
struct Nested {
    within: BlockId,
    /// None outside.
    guard: Option<Guard>,
    depth: usize,
}

/// The blocks of one tape, and which node belongs to which.
#[derive(Debug)]
pub(crate) struct Blocks {
    nested: Vec<Nested>,
    of: FxHashMap<Expr, BlockId>,
}

impl Blocks {
    /// Of the nodes of `body`, children first, of which `wanted` are used from outside, some only under a guard.
    pub(crate) fn new(graph: &Graph, body: &[Expr], wanted: impl Iterator<Item = (Expr, Option<Guard>)>) -> Self {
        let mut blocks =
            Self { nested: vec![Nested { within: OUTSIDE, guard: None, depth: 0 }], of: FxHashMap::default() };
        let mut known = FxHashMap::default();
        let guarded = |expr: &Expr| matches!(graph.node(*expr), Node::Binary(Binary::Where | Binary::Elsewhere, ..));
        for (expr, guard) in wanted {
            let block = guard.map_or(OUTSIDE, |guard| blocks.enter(&mut known, OUTSIDE, guard));
            if let Some(guard) = guard {
                blocks.use_in(guard.condition, OUTSIDE);
            }
            blocks.use_in(expr, block);
        }
        if known.is_empty() && !body.iter().any(guarded) {
            blocks.of.clear();
            return blocks;
        }
        let mut circular: FxHashMap<Expr, Vec<Expr>> = FxHashMap::default();
        for &expr in body {
            if let Node::Unary(Unary::Sin | Unary::Cos, argument) = graph.node(expr) {
                circular.entry(argument).or_default().push(expr);
            }
        }
        // Uses may move a node out of a block, never into one; so this ends.
        let mut settled = false;
        while !settled {
            settled = true;
            for &expr in body.iter().rev() {
                let block = blocks.of(expr);
                let mut note = |blocks: &mut Self, child: Expr, block: BlockId| {
                    settled &= !blocks.use_in(child, block);
                };
                match graph.node(expr) {
                    Node::Binary(function @ (Binary::Where | Binary::Elsewhere), condition, value) => {
                        let guard = Guard { condition, elsewhere: function == Binary::Elsewhere };
                        let inner = blocks.enter(&mut known, block, guard);
                        note(&mut blocks, condition, block);
                        note(&mut blocks, value, inner);
                    }
                    // Sine and cosine of one argument are one instruction.
                    Node::Unary(Unary::Sin | Unary::Cos, argument) => {
                        note(&mut blocks, argument, block);
                        circular[&argument].iter().for_each(|&other| note(&mut blocks, other, block));
                    }
                    node => node.children().for_each(|child| note(&mut blocks, child, block)),
                }
            }
        }
        blocks.dissolve_small(body);
        blocks
    }

    /// The block that a node belongs to.
    pub(crate) fn of(&self, expr: Expr) -> BlockId {
        self.of.get(&expr).copied().unwrap_or(OUTSIDE)
    }

    /// The block of a guard within a block, if there is one.
    pub(crate) fn inner(&self, within: BlockId, guard: Guard) -> Option<BlockId> {
        (0..self.nested.len())
            .find(|&block| self.nested[block].within == within && self.nested[block].guard == Some(guard))
    }

    /// Whether there are any.
    pub(crate) fn is_empty(&self) -> bool {
        self.nested.iter().all(|block| block.guard.is_none())
    }

    /// What opens a block; nothing does outside.
    pub(crate) fn guard(&self, block: BlockId) -> Option<Guard> {
        self.nested[block].guard
    }

    /// The conditions of a block and of those around it.
    pub(crate) fn conditions(&self, block: BlockId) -> impl Iterator<Item = Expr> {
        self.outward(block).filter_map(|block| self.nested[block].guard).map(|guard| guard.condition)
    }

    /// The blocks to be left, and those to be entered, from one to another.
    pub(crate) fn way(&self, from: BlockId, to: BlockId) -> (usize, Vec<BlockId>) {
        let common = self.common(from, to);
        let mut entered: Vec<BlockId> = self.outward(to).take_while(|&block| block != common).collect();
        entered.reverse();
        (self.nested[from].depth - self.nested[common].depth, entered)
    }

    /// A block, the one around it, and so on, but not the outside.
    fn outward(&self, block: BlockId) -> impl Iterator<Item = BlockId> {
        std::iter::successors(Some(block), |&block| Some(self.nested[block].within))
            .take_while(|&block| block != OUTSIDE)
    }

    /// The innermost block around both.
    fn common(&self, mut a: BlockId, mut b: BlockId) -> BlockId {
        while a != b {
            if self.nested[a].depth >= self.nested[b].depth {
                a = self.nested[a].within;
            } else {
                b = self.nested[b].within;
            }
        }
        a
    }

    fn enter(&mut self, known: &mut FxHashMap<(BlockId, Guard), BlockId>, within: BlockId, guard: Guard) -> BlockId {
        if self.outward(within).any(|block| self.nested[block].guard == Some(guard)) {
            return within;
        }
        *known.entry((within, guard)).or_insert_with(|| {
            self.nested.push(Nested { within, guard: Some(guard), depth: self.nested[within].depth + 1 });
            self.nested.len() - 1
        })
    }

    /// Notes a use; whether that moved the node.
    fn use_in(&mut self, expr: Expr, block: BlockId) -> bool {
        let Some(&before) = self.of.get(&expr) else {
            self.of.insert(expr, block);
            return false;
        };
        let common = self.common(before, block);
        self.of.insert(expr, common);
        common != before
    }

    /// Hands the nodes of small blocks to the blocks around them.
    fn dissolve_small(&mut self, body: &[Expr]) {
        let mut sizes = vec![0; self.nested.len()];
        for &expr in body {
            self.outward(self.of(expr)).for_each(|block| sizes[block] += 1);
        }
        // Blocks stand behind those that they are in.
        let mut kept: Vec<BlockId> = vec![OUTSIDE];
        for (block, &size) in sizes.iter().enumerate().skip(1) {
            let Nested { within, .. } = self.nested[block];
            let outer = kept[within];
            self.nested[block].within = outer;
            self.nested[block].depth = self.nested[outer].depth + 1;
            if size < LEAST {
                self.nested[block].guard = None;
                kept.push(outer);
            } else {
                kept.push(block);
            }
        }
        self.of.values_mut().for_each(|block| *block = kept[*block]);
    }
}

/// An order of `count` things, none before what it needs, that stays within a block as long as there is something to do in
/// it; otherwise as they stand. `block_of` tells each one's block, `needs` what it needs.
pub(crate) fn order(
    blocks: &Blocks,
    count: usize,
    block_of: impl Fn(usize) -> BlockId,
    needs: impl Fn(usize) -> Vec<usize>,
) -> Vec<usize> {
    let mut missing = vec![0_usize; count];
    let mut users: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (place, missing) in missing.iter_mut().enumerate() {
        for needed in needs(place) {
            *missing += 1;
            users[needed].push(place);
        }
    }
    let mut ready: BTreeMap<BlockId, BinaryHeap<Reverse<usize>>> = BTreeMap::new();
    for place in (0..count).filter(|&place| missing[place] == 0) {
        ready.entry(block_of(place)).or_default().push(Reverse(place));
    }
    let mut ordered = Vec::with_capacity(count);
    let mut current = OUTSIDE;
    loop {
        if let Some(Reverse(place)) = ready.get_mut(&current).and_then(BinaryHeap::pop) {
            ordered.push(place);
            for &user in &users[place] {
                missing[user] -= 1;
                if missing[user] == 0 {
                    ready.entry(block_of(user)).or_default().push(Reverse(user));
                }
            }
            continue;
        }
        // Into the block whose first instruction stands first, or out of this one.
        ready.retain(|_, places| !places.is_empty());
        let inner = ready.iter().filter(|&(&block, _)| blocks.common(block, current) == current);
        match inner.min_by_key(|(_, places)| places.peek().map(|first| first.0)) {
            Some((&block, _)) => current = block,
            None if current == OUTSIDE => break,
            None => current = blocks.nested[current].within,
        }
    }
    debug_assert_eq!(ordered.len(), count, "nothing needs itself");
    ordered
}
