//! Lowering: expressions → tapes, split by *when values can change*.
//!
//! Inputs carry a stage: 0 changes least often, `shared` (the last) most often. A node's stage is the highest of what it
//! depends on. The caller asks for kernels, each with outputs; whatever a kernel needs of a lower stage is computed by
//! that stage's own tape and kept in a slot of its own, so that nothing is evaluated more often than it can change.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::expr::{Binary, Expr, Graph, Node, Unary};
use crate::stages::{Input, Stages, UNKNOWN};
use crate::tape::{Op, Operands, Tape};

/// Instructions are grouped by operation within stretches of this many: grouping saves dispatches, a limit keeps what
/// is alive within the first-level cache.
const WINDOW: usize = 256;

/// What a kernel computes: expressions, each with the slot that it must end up in or `None` for any.
pub type Outputs = Vec<(Expr, Option<u32>)>;

/// Tapes that share one memory.
#[derive(Clone, Debug, Default)]
pub struct Lowered {
    /// One tape for each shared stage, to be run when an input of that stage (or a lower one) has changed.
    pub stages: Vec<Tape>,
    /// One tape for each kernel asked for.
    pub kernels: Vec<Tape>,
    /// Where each kernel's outputs stand after it has run.
    pub outputs: Vec<Vec<u32>>,
    /// Slots that hold numbers, to be set once.
    pub constants: Vec<(u32, f64)>,
    /// Number of slots of the memory.
    pub slots: usize,
}

/// Lowers `kernels` with `shared` lower stages; slots below `reserved` belong to the caller.
///
/// # Panics
/// If a kernel depends on a symbol that is not among `inputs`: a defect of the caller.
pub fn lower(graph: &Graph, inputs: &[Input], shared: usize, reserved: u32, kernels: &[Outputs]) -> Lowered {
    let mut stages = Stages::new(inputs);
    stages.update(graph);
    let mut lowering = Lowering {
        graph,
        stages,
        slot_of: inputs.iter().map(|input| (input.symbol, input.slot)).collect(),
        constants: Vec::new(),
        next: reserved,
    };
    // From the last stage down: what a stage needs of the ones below is pinned there.
    let mut pinned: Vec<FxHashSet<Expr>> = vec![FxHashSet::default(); shared];
    let mut bodies = Vec::with_capacity(kernels.len());
    for outputs in kernels {
        let wanted: Vec<Expr> = outputs.iter().map(|&(expr, _)| expr).collect();
        bodies.push(lowering.body(shared, &wanted, &mut pinned));
    }
    let mut stage_bodies = Vec::with_capacity(shared);
    for stage in (0..shared).rev() {
        let mut wanted: Vec<Expr> = pinned[stage].iter().copied().collect();
        wanted.sort_unstable();
        stage_bodies.push(lowering.body(stage, &wanted, &mut pinned));
        for &expr in &wanted {
            lowering.pin(expr);
        }
    }
    // All kept values have their slots now; every tape may use what lies above as scratch.
    let mut lowered = Lowered::default();
    let mut targets = Vec::with_capacity(kernels.len());
    for outputs in kernels {
        let replaced: FxHashSet<u32> = outputs.iter().filter_map(|&(_, slot)| slot).collect();
        let target =
            |&(expr, slot): &(Expr, Option<u32>)| (expr, slot.unwrap_or_else(|| lowering.keep(expr, &replaced)));
        targets.push(outputs.iter().map(target).collect::<Vec<_>>());
    }
    for body in stage_bodies.iter().rev() {
        lowered.stages.push(lowering.emit(body, &[]));
    }
    for (body, targets) in bodies.iter().zip(&targets) {
        lowered.kernels.push(lowering.emit(body, targets));
        lowered.outputs.push(targets.iter().map(|&(_, slot)| slot).collect());
    }
    let highest = lowered.stages.iter().chain(&lowered.kernels).map(Tape::slots).max().unwrap_or(0);
    lowered.constants = lowering.constants;
    lowered.slots = highest.max(lowering.next as usize);
    lowered
}

struct Lowering<'g> {
    graph: &'g Graph,
    stages: Stages,
    /// Symbols, constants and values that outlive their tape.
    slot_of: FxHashMap<Expr, u32>,
    constants: Vec<(u32, f64)>,
    next: u32,
}

impl Lowering<'_> {
    fn pin(&mut self, expr: Expr) -> u32 {
        let next = &mut self.next;
        *self.slot_of.entry(expr).or_insert_with(|| {
            *next += 1;
            *next - 1
        })
    }

    /// A slot in which a kernel's output outlives it: its own where it has one that the kernel does not replace, else a
    /// new one.
    fn keep(&mut self, expr: Expr, replaced: &FxHashSet<u32>) -> u32 {
        match self.slot_of.get(&expr) {
            Some(&slot) if !replaced.contains(&slot) => slot,
            _ => {
                self.next += 1;
                self.next - 1
            }
        }
    }

    /// The nodes that one tape has to compute for `wanted`, operands first (depth first, so that what is used together
    /// stands together). What belongs to a lower stage is noted in `pinned`, constants get their slots.
    fn body(&mut self, stage: usize, wanted: &[Expr], pinned: &mut [FxHashSet<Expr>]) -> Vec<Expr> {
        let mut order = Vec::new();
        let mut done = FxHashSet::default();
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
                    if !self.slot_of.contains_key(&expr) {
                        let slot = self.pin(expr);
                        self.constants.push((slot, f64::from_bits(bits)));
                    }
                }
                (Some(lower), _) if lower < stage => {
                    pinned[lower].insert(expr);
                }
                (_, node) => {
                    stack.push((expr, true));
                    let children: Vec<Expr> = node.children().collect();
                    stack.extend(children.into_iter().rev().map(|child| (child, false)));
                }
            }
        }
        order
    }

    /// One tape: fused, grouped, with slots.
    fn emit(&self, body: &[Expr], targets: &[(Expr, u32)]) -> Tape {
        let wanted: FxHashSet<Expr> = targets.iter().map(|&(expr, _)| expr).collect();
        self.allocate(&group(self.fuse(body, &wanted)), targets)
    }

    /// Nodes → operations: a product that a single sum needs becomes part of it, and sine and cosine of one argument
    /// are found together.
    fn fuse(&self, body: &[Expr], wanted: &FxHashSet<Expr>) -> Vec<Pending> {
        let inside: FxHashSet<Expr> = body.iter().copied().collect();
        let mut uses: FxHashMap<Expr, usize> = FxHashMap::default();
        let mut circular: FxHashMap<Expr, [Option<Expr>; 2]> = FxHashMap::default();
        for &expr in body {
            let node = self.graph.node(expr);
            node.children().for_each(|child| *uses.entry(child).or_default() += 1);
            match node {
                Node::Unary(Unary::Sin, a) => circular.entry(a).or_default()[0] = Some(expr),
                Node::Unary(Unary::Cos, a) => circular.entry(a).or_default()[1] = Some(expr),
                _ => {}
            }
        }
        let product = |expr: Expr| match self.graph.node(expr) {
            Node::Binary(Binary::Mul, a, b)
                if inside.contains(&expr)
                    && uses[&expr] == 1
                    && !wanted.contains(&expr)
                    && !self.slot_of.contains_key(&expr) =>
            {
                Some((a, b))
            }
            _ => None,
        };
        let mut absorbed = FxHashSet::default();
        let mut pending: Vec<Pending> = Vec::with_capacity(body.len());
        for &expr in body {
            pending.push(match self.graph.node(expr) {
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
                    Some(writes) => Pending { op: Op::SinCos, reads: [a; 3], count: 1, writes },
                    None => continue,
                },
                Node::Unary(function, a) => Pending::new(Op::Unary(function), [a; 3], 1, expr),
                Node::Constant(_) | Node::Symbol(_) => continue,
            });
        }
        pending.retain(|pending| !pending.written().any(|expr| absorbed.contains(&expr)));
        pending
    }

    /// Slots by linear scan: a scratch slot is free again after its value's last use. A target is written at once
    /// unless this tape still reads what stands there; then it is copied at the end.
    fn allocate(&self, pending: &[Pending], targets: &[(Expr, u32)]) -> Tape {
        let mut last_use: FxHashMap<Expr, usize> = FxHashMap::default();
        let mut read_slots: FxHashSet<u32> = FxHashSet::default();
        for (place, instruction) in pending.iter().enumerate() {
            for read in instruction.read() {
                last_use.insert(read, place);
                read_slots.extend(self.slot_of.get(&read));
            }
        }
        read_slots.extend(targets.iter().filter_map(|(expr, _)| self.slot_of.get(expr)));
        let computed: FxHashSet<Expr> = pending.iter().flat_map(Pending::written).collect();
        let mut place_of: FxHashMap<Expr, u32> = FxHashMap::default();
        let mut copies = Vec::new();
        for &(expr, slot) in targets {
            if computed.contains(&expr) && !read_slots.contains(&slot) && !place_of.contains_key(&expr) {
                place_of.insert(expr, slot);
            } else if self.slot_of.get(&expr) != Some(&slot) {
                copies.push((expr, slot));
                last_use.insert(expr, pending.len());
            }
        }
        let mut free: Vec<u32> = Vec::new();
        let mut next = self.next;
        let mut instructions = Vec::with_capacity(pending.len() + copies.len());
        for (place, instruction) in pending.iter().enumerate() {
            let slot = |place_of: &FxHashMap<Expr, u32>, expr: Expr| {
                *self
                    .slot_of
                    .get(&expr)
                    .or_else(|| place_of.get(&expr))
                    .expect("operands are computed before their use")
            };
            let [a, b, c] = instruction.reads.map(|read| slot(&place_of, read));
            let already_free = free.len();
            for read in instruction.read().filter(|read| last_use[read] == place) {
                // An operand may stand there twice.
                if let Some(&old) = place_of.get(&read)
                    && old >= self.next
                    && !free[already_free..].contains(&old)
                {
                    free.push(old);
                }
            }
            let mut unused = None;
            let mut destinations = instruction.writes.map(|write| match write {
                Some(expr) => self.slot_of.get(&expr).or_else(|| place_of.get(&expr)).copied().unwrap_or_else(|| {
                    let fresh = take(&mut free, &mut next);
                    place_of.insert(expr, fresh);
                    fresh
                }),
                None => u32::MAX,
            });
            if instruction.op == Op::SinCos {
                for destination in &mut destinations {
                    if *destination == u32::MAX {
                        *destination = take(&mut free, &mut next);
                        unused = Some(*destination);
                    }
                }
            }
            let [d, second] = destinations;
            let b = if instruction.op == Op::SinCos { second } else { b };
            instructions.push((instruction.op, Operands { a, b, c, d }));
            free.extend(unused);
        }
        // All copies happen at once: what another copy overwrites is put aside first.
        let overwritten: FxHashSet<u32> = copies.iter().map(|&(_, slot)| slot).collect();
        let copy = |from: u32, to: u32| (Op::Copy, Operands { a: from, b: from, c: from, d: to });
        let mut last = Vec::with_capacity(copies.len());
        for &(expr, slot) in &copies {
            let kept = self.slot_of.get(&expr).or_else(|| place_of.get(&expr)).copied();
            let mut source = kept.expect("an output is a symbol, a constant, kept, or computed here");
            if overwritten.contains(&source) {
                let aside = take(&mut free, &mut next);
                instructions.push(copy(source, aside));
                source = aside;
            }
            last.push(copy(source, slot));
        }
        instructions.extend(last);
        Tape::new(instructions)
    }
}

fn take(free: &mut Vec<u32>, next: &mut u32) -> u32 {
    free.pop().unwrap_or_else(|| {
        *next += 1;
        *next - 1
    })
}

/// An instruction before it has slots.
#[derive(Clone, Debug)]
struct Pending {
    op: Op,
    /// Operands; the first `count` count.
    reads: [Expr; 3],
    count: usize,
    /// Result, and for `SinCos` the sine and the cosine, of which one may not be wanted.
    writes: [Option<Expr>; 2],
}

impl Pending {
    fn new(op: Op, reads: [Expr; 3], count: usize, write: Expr) -> Self {
        Self { op, reads, count, writes: [Some(write), None] }
    }

    fn read(&self) -> impl Iterator<Item = Expr> {
        self.reads.into_iter().take(self.count)
    }

    fn written(&self) -> impl Iterator<Item = Expr> + use<> {
        self.writes.into_iter().flatten()
    }
}

/// Within stretches of [`WINDOW`] instructions, brings equal operations together: of those that are ready, always all of
/// the operation that has most.
fn group(pending: Vec<Pending>) -> Vec<Pending> {
    let mut grouped = Vec::with_capacity(pending.len());
    for window in pending.chunks(WINDOW) {
        let writer: FxHashMap<Expr, usize> =
            window.iter().enumerate().flat_map(|(place, one)| one.written().map(move |expr| (expr, place))).collect();
        let mut missing = vec![0_usize; window.len()];
        let mut readers: Vec<Vec<usize>> = vec![Vec::new(); window.len()];
        for (place, instruction) in window.iter().enumerate() {
            for producer in instruction.read().filter_map(|read| writer.get(&read)) {
                missing[place] += 1;
                readers[*producer].push(place);
            }
        }
        let mut ready: Vec<(Op, Vec<usize>)> = Vec::new();
        let enqueue = |ready: &mut Vec<(Op, Vec<usize>)>, place: usize| {
            let op = window[place].op;
            match ready.iter_mut().find(|(known, _)| *known == op) {
                Some((_, places)) => places.push(place),
                None => ready.push((op, vec![place])),
            }
        };
        (0..window.len()).filter(|&place| missing[place] == 0).for_each(|place| enqueue(&mut ready, place));
        while let Some(most) = (0..ready.len()).max_by_key(|&queue| (ready[queue].1.len(), usize::MAX - queue)) {
            if ready[most].1.is_empty() {
                break;
            }
            for place in std::mem::take(&mut ready[most].1) {
                grouped.push(window[place].clone());
                for &reader in &readers[place] {
                    missing[reader] -= 1;
                    if missing[reader] == 0 {
                        enqueue(&mut ready, reader);
                    }
                }
            }
        }
    }
    grouped
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::Tile;

    #[test]
    fn each_value_is_computed_at_its_stage() {
        let mut g = Graph::new();
        let (p, h, x) = (g.symbol("p"), g.symbol("h"), g.symbol("x"));
        let root = g.sqrt(p);
        let scaled = g.mul(root, h);
        let kernel = g.mul(scaled, x);
        let inputs = [(p, 0, 0), (h, 1, 1), (x, 2, 2)].map(|(symbol, stage, slot)| Input { symbol, stage, slot });
        let lowered = lower(&g, &inputs, 2, 3, &[vec![(kernel, None)]]);
        assert_eq!(lowered.stages.iter().map(Tape::len).collect::<Vec<_>>(), [1, 1]);
        assert_eq!(lowered.kernels[0].len(), 1);
    }

    #[test]
    fn outputs_may_replace_inputs_that_others_still_read() {
        let mut g = Graph::new();
        let (x, y) = (g.symbol("x"), g.symbol("y"));
        let (sum, difference) = (g.add(x, y), g.sub(x, y));
        let inputs = [(x, 0, 0), (y, 0, 1)].map(|(symbol, stage, slot)| Input { symbol, stage, slot });
        let lowered = lower(&g, &inputs, 0, 2, &[vec![(sum, Some(0)), (difference, Some(1)), (x, Some(2))]]);
        let mut tile = Tile::new(1, lowered.slots + 1, &lowered.constants);
        tile.lane_mut(0)[0] = 5.0;
        tile.lane_mut(1)[0] = 3.0;
        tile.run(&lowered.kernels[0]);
        assert_eq!((tile.lane(0)[0], tile.lane(1)[0]), (8.0, 2.0));
    }
}
