//! Lowering: expressions → tapes, split by *when values can change*.
//!
//! Inputs carry a stage: 0 changes least often, `shared` (the last) most often. A node's stage is the highest of its
//! operands. The caller requests kernels, each with outputs; values of a lower stage that a kernel needs are computed
//! by that stage's own tape and stored in a slot of their own, so that nothing is evaluated more often than it can
//! change.

mod c;
mod node_table;
mod readers;
mod reciprocals;
mod regions;
mod registers;
mod schedule;
mod stages;
pub(crate) mod tape;

use rustc_hash::{FxHashMap, FxHashSet};

pub use self::c::{CWriter, c_number};
pub use self::reciprocals::with_reciprocals;
pub use self::stages::{Input, Stages};
pub use self::tape::{Guard, Op, Operands, Tape};

use self::node_table::{NodeSet, NodeTable};
use self::regions::Regions;
use self::registers::allocate;
use self::schedule::{Pending, in_regions};
use self::stages::UNKNOWN;
use crate::expr::{Binary, Choice, Expr, Graph, Node, Unary};

/// Outputs of a kernel: expressions, each with the register that it must end up in or `None` for any.
pub type Outputs = Vec<(Expr, Option<u32>)>;

/// Tapes that share one memory.
#[derive(Clone, Debug, Default)]
pub struct Lowered {
    /// One tape for each shared stage, to be run when an input of that stage (or a lower one) has changed.
    pub stages: Vec<Tape>,
    /// One tape for each requested kernel.
    pub kernels: Vec<Tape>,
    /// Registers of each kernel's outputs after it has run.
    pub outputs: Vec<Vec<u32>>,
    /// Registers that hold numbers, to be set once.
    pub constants: Vec<(u32, f64)>,
    /// Number of registers of the memory.
    pub registers: usize,
}

/// Lowers `kernels` with `shared` lower stages; registers below `reserved` belong to the caller.
///
/// # Panics
/// If a kernel depends on a symbol that is not among `inputs`: a defect of the caller.
pub fn lower(graph: &Graph, inputs: &[Input], shared: usize, reserved: u32, kernels: &[Outputs]) -> Lowered {
    lower_where(graph, inputs, shared, reserved, kernels, &FxHashMap::default())
}

/// Lowers likewise; some outputs (by their kernel) matter only under a guard, and are arbitrary elsewhere.
///
/// # Panics
/// As [`lower`].
pub fn lower_where(
    graph: &Graph,
    inputs: &[Input],
    shared: usize,
    reserved: u32,
    kernels: &[Outputs],
    guards: &FxHashMap<(usize, Expr), Guard>,
) -> Lowered {
    let mut stages = Stages::new(inputs);
    stages.update(graph);
    let mut lowering =
        Lowering { graph, stages, register_of: NodeTable::new(graph.len()), constants: Vec::new(), next: reserved };
    inputs.iter().for_each(|input| lowering.register_of.insert(input.symbol, input.register));
    // From the last stage down: each stage pins the values that it needs of those below.
    let mut pinned: Vec<FxHashSet<Expr>> = vec![FxHashSet::default(); shared];
    let mut bodies = Vec::with_capacity(kernels.len());
    for (kernel, outputs) in kernels.iter().enumerate() {
        let mut wanted: Vec<Expr> = outputs.iter().map(|&(expr, _)| expr).collect();
        let conditions = wanted.iter().filter_map(|&expr| guards.get(&(kernel, expr))).map(|guard| guard.condition);
        let conditions: FxHashSet<Expr> = conditions.collect();
        wanted.extend(conditions);
        bodies.push(lowering.body(shared, &wanted, &mut pinned));
    }
    let mut stage_bodies = Vec::with_capacity(shared);
    for stage in (0..shared).rev() {
        let mut wanted: Vec<Expr> = pinned[stage].iter().copied().collect();
        wanted.sort_unstable();
        let body = lowering.body(stage, &wanted, &mut pinned);
        for &expr in &wanted {
            lowering.pin(expr);
        }
        stage_bodies.push((body, wanted));
    }
    // All stored values have their registers now; every tape may use those above as scratch.
    let mut lowered = Lowered::default();
    let mut targets = Vec::with_capacity(kernels.len());
    for outputs in kernels {
        let replaced: FxHashSet<u32> = outputs.iter().filter_map(|&(_, register)| register).collect();
        let target =
            |&(expr, slot): &(Expr, Option<u32>)| (expr, slot.unwrap_or_else(|| lowering.keep(expr, &replaced)));
        targets.push(outputs.iter().map(target).collect::<Vec<_>>());
    }
    for (body, wanted) in stage_bodies.iter().rev() {
        lowered.stages.push(lowering.emit(body, wanted.iter().map(|&expr| (expr, None)), &[]));
    }
    for (kernel, (body, targets)) in bodies.iter().zip(&targets).enumerate() {
        let wanted = targets.iter().map(|&(expr, _)| (expr, guards.get(&(kernel, expr)).copied()));
        lowered.kernels.push(lowering.emit(body, wanted, targets));
        lowered.outputs.push(targets.iter().map(|&(_, register)| register).collect());
    }
    let highest = lowered.stages.iter().chain(&lowered.kernels).map(Tape::registers).max().unwrap_or(0);
    lowered.constants = lowering.constants;
    lowered.registers = highest.max(lowering.next as usize);
    lowered
}

struct Lowering<'g> {
    graph: &'g Graph,
    stages: Stages,
    /// Symbols, constants and values that outlive their tape.
    register_of: NodeTable,
    constants: Vec<(u32, f64)>,
    next: u32,
}

impl Lowering<'_> {
    fn pin(&mut self, expr: Expr) -> u32 {
        self.register_of.get(expr).unwrap_or_else(|| {
            self.register_of.insert(expr, self.next);
            self.next += 1;
            self.next - 1
        })
    }

    /// A register in which a kernel's output outlives it: its own if it has one that the kernel does not replace,
    /// otherwise a new one.
    fn keep(&mut self, expr: Expr, replaced: &FxHashSet<u32>) -> u32 {
        match self.register_of.get(expr) {
            Some(register) if !replaced.contains(&register) => register,
            _ => {
                self.next += 1;
                self.next - 1
            }
        }
    }

    /// The nodes that one tape has to compute for `wanted`, operands first (depth first, so that values used together
    /// are near each other). Values of a lower stage are added to `pinned`; constants get their registers.
    fn body(&mut self, stage: usize, wanted: &[Expr], pinned: &mut [FxHashSet<Expr>]) -> Vec<Expr> {
        let mut order = Vec::new();
        let mut done = NodeSet::new(self.graph.len());
        let mut stack: Vec<(Expr, bool)> = wanted.iter().rev().map(|&expr| (expr, false)).collect();
        while let Some((expr, children_done)) = stack.pop() {
            if children_done {
                order.push(expr);
                continue;
            }
            if !done.insert(expr) {
                continue;
            }
            match (self.stages.of(expr), self.graph.node(expr)) {
                (stage, Node::Symbol(_)) => {
                    assert_ne!(
                        stage,
                        Some(UNKNOWN),
                        "symbol `{}` is no input",
                        self.graph.symbol_name(expr).unwrap_or_default()
                    );
                }
                (_, Node::Constant(bits)) => {
                    if !self.register_of.contains(expr) {
                        let register = self.pin(expr);
                        self.constants.push((register, f64::from_bits(bits)));
                    }
                }
                (Some(lower), _) if lower < stage => {
                    pinned[lower].insert(expr);
                }
                (_, node) => {
                    stack.push((expr, true));
                    let above = stack.len();
                    stack.extend(node.children().map(|child| (child, false)));
                    stack[above..].reverse();
                }
            }
        }
        order
    }

    /// Emits one tape: fused, in regions, grouped, with registers. `wanted` are the nodes that are used outside, some
    /// under a guard only.
    fn emit(
        &self,
        body: &[Expr],
        wanted: impl Iterator<Item = (Expr, Option<Guard>)>,
        targets: &[(Expr, u32)],
    ) -> Tape {
        if body.is_empty() && targets.is_empty() {
            return Tape::default();
        }
        let regions = Regions::new(self.graph, body, wanted);
        let wanted = NodeSet::of(self.graph.len(), targets.iter().map(|&(expr, _)| expr));
        let pending = self.fuse(body, &wanted, &regions);
        allocate(&in_regions(self.graph.len(), pending, &regions), targets, &self.register_of, self.next)
    }

    /// Nodes → operations: a product needed by a single sum becomes part of it, and sine and cosine of one argument are
    /// computed together.
    fn fuse(&self, body: &[Expr], wanted: &NodeSet, regions: &Regions) -> Vec<Pending> {
        let nodes = self.graph.len();
        let inside = NodeSet::of(nodes, body.iter().copied());
        let [mut used, mut used_again] = [NodeSet::new(nodes), NodeSet::new(nodes)];
        let mut circular: FxHashMap<Expr, [Option<Expr>; 2]> = FxHashMap::default();
        for &expr in body {
            let node = self.graph.node(expr);
            for child in node.children() {
                if !used.insert(child) {
                    used_again.insert(child);
                }
            }
            match node {
                Node::Unary(Unary::Sin, a) => circular.entry(a).or_default()[0] = Some(expr),
                Node::Unary(Unary::Cos, a) => circular.entry(a).or_default()[1] = Some(expr),
                _ => {}
            }
        }
        let only_here = |expr: Expr| {
            inside.contains(expr)
                && !used_again.contains(expr)
                && !wanted.contains(expr)
                && !self.register_of.contains(expr)
        };
        let product = |expr: Expr| match self.graph.node(expr) {
            Node::Binary(Binary::Mul, a, b) if only_here(expr) => Some((a, b)),
            _ => None,
        };
        let mut absorbed = NodeSet::new(nodes);
        let mut pending: Vec<Pending> = Vec::with_capacity(body.len());
        for &expr in body {
            let region = regions.of(expr);
            if let Node::Binary(Binary::Add, x, y) = self.graph.node(expr)
                && let Some(choice) = self.graph.choice(x, y)
            {
                let Choice { condition, halves: [(wanted, a), (elsewhere, b)] } = choice;
                match regions.inner(region, Guard { condition, elsewhere: false }) {
                    // The value elsewhere is written first; the region, if it is not skipped, chooses.
                    Some(inner) if only_here(wanted) && only_here(elsewhere) => {
                        [wanted, elsewhere].into_iter().for_each(|half| _ = absorbed.insert(half));
                        pending.push(Pending::new(Op::Copy, [b; 3], 1, elsewhere).within(region));
                        pending.push(Pending::new(Op::Select, [condition, a, elsewhere], 3, expr).within(inner));
                    }
                    _ => {
                        // A half may itself be needed, or computed at an earlier stage.
                        let [a, b] = choice.halves.map(|(half, value)| if only_here(half) { value } else { half });
                        let halves = [wanted, elsewhere].into_iter().filter(|&half| only_here(half));
                        halves.for_each(|half| _ = absorbed.insert(half));
                        pending.push(Pending::new(Op::Select, [condition, a, b], 3, expr).within(region));
                    }
                }
                continue;
            }
            let Some(instruction) = self.instruction(expr, product, &mut absorbed, &mut circular) else { continue };
            pending.push(instruction.within(region));
        }
        pending.retain(|pending| pending.op == Op::Copy || !pending.written().any(|expr| absorbed.contains(expr)));
        pending
    }

    /// The operation of a node; `None` if another one writes its value too, or none is needed. `product` gives the
    /// factors of a product that may become part of a sum, which is then `absorbed`; `circular` has the sine and cosine
    /// of each argument.
    fn instruction(
        &self,
        expr: Expr,
        product: impl Fn(Expr) -> Option<(Expr, Expr)>,
        absorbed: &mut NodeSet,
        circular: &mut FxHashMap<Expr, [Option<Expr>; 2]>,
    ) -> Option<Pending> {
        Some(match self.graph.node(expr) {
            Node::Binary(function @ (Binary::Add | Binary::Sub), x, y) => match (product(x), product(y)) {
                (_, Some((a, b))) => {
                    absorbed.insert(y);
                    let op = if function == Binary::Add { Op::MulAdd } else { Op::NegMulAdd };
                    Pending::new(op, [a, b, x], 3, expr)
                }
                (Some((a, b)), None) => {
                    absorbed.insert(x);
                    let op = if function == Binary::Add { Op::MulAdd } else { Op::MulSub };
                    Pending::new(op, [a, b, y], 3, expr)
                }
                (None, None) => Pending::new(Op::Binary(function), [x, y, x], 2, expr),
            },
            Node::Binary(function, a, b) => Pending::new(Op::Binary(function), [a, b, a], 2, expr),
            Node::Unary(Unary::Sin | Unary::Cos, a) => match circular.remove(&a) {
                Some(writes) => Pending { writes, ..Pending::new(Op::SinCos, [a; 3], 1, expr) },
                None => return None,
            },
            Node::Unary(function, a) => Pending::new(Op::Unary(function), [a; 3], 1, expr),
            Node::Constant(_) | Node::Symbol(_) => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eval::tile::Tile;

    #[test]
    fn each_value_is_computed_at_its_stage() {
        let mut g = Graph::new();
        let (p, h, x) = (g.symbol("p"), g.symbol("h"), g.symbol("x"));
        let root = g.sqrt(p);
        let scaled = g.mul(root, h);
        let kernel = g.mul(scaled, x);
        let inputs =
            [(p, 0, 0), (h, 1, 1), (x, 2, 2)].map(|(symbol, stage, register)| Input { symbol, stage, register });
        let lowered = lower(&g, &inputs, 2, 3, &[vec![(kernel, None)]]);
        assert_eq!(lowered.stages.iter().map(Tape::len).collect::<Vec<_>>(), [1, 1]);
        assert_eq!(lowered.kernels[0].len(), 1);
    }

    #[test]
    fn outputs_may_replace_inputs_still_in_use() {
        let mut g = Graph::new();
        let (x, y) = (g.symbol("x"), g.symbol("y"));
        let (sum, difference) = (g.add(x, y), g.sub(x, y));
        let inputs = [(x, 0, 0), (y, 0, 1)].map(|(symbol, stage, register)| Input { symbol, stage, register });
        let lowered = lower(&g, &inputs, 0, 2, &[vec![(sum, Some(0)), (difference, Some(1)), (x, Some(2))]]);
        let mut tile = Tile::new(1, lowered.registers + 1, &lowered.constants);
        tile.lane_mut(0)[0] = 5.0;
        tile.lane_mut(1)[0] = 3.0;
        tile.run(&lowered.kernels[0]);
        assert_eq!((tile.lane(0)[0], tile.lane(1)[0]), (8.0, 2.0));
    }
}
