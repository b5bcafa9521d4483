//! Allocation of registers to the values of a tape.

use rustc_hash::{FxHashMap, FxHashSet};

use super::node_table::{NodeSet, NodeTable};
use super::schedule::Step;
use super::tape::{Item, Op, Operands, Tape};
use crate::expr::Expr;

/// Allocates registers by linear scan: a scratch register is free again after its value's last use. A target is written
/// at once unless this tape still reads its old value; then it is copied at the end. `register_of` has the registers of
/// values that exist before or stay; scratch registers begin at `first`.
pub(crate) fn allocate(steps: &[Step], targets: &[(Expr, u32)], register_of: &NodeTable, first: u32) -> Tape {
    let nodes = register_of.nodes();
    let Uses { last_use, mut reads_register, computed } = Uses::of(steps, register_of, first);
    let read = targets.iter().filter_map(|&(expr, _)| register_of.get(expr));
    read.for_each(|register| reads_register[register as usize] = true);
    let placed = NodeSet::of(nodes, targets.iter().map(|&(expr, _)| expr));
    let may_share = |expr: Expr| computed.contains(expr) && !placed.contains(expr) && !register_of.contains(expr);
    let shared = Shared::new(steps, &last_use, may_share);
    let mut last_use_of = last_use;
    if shared.next.is_some() {
        for (index, step) in steps.iter().enumerate() {
            step.read().for_each(|read| last_use_of.insert(shared.root(read), index as u32));
        }
    }
    let mut registers = Registers {
        register_of,
        shared: &shared,
        place_of: NodeTable::new(nodes),
        free: Vec::new(),
        first,
        next: first,
    };
    let mut copies = Vec::new();
    for &(expr, register) in targets {
        let is_free = reads_register.get(register as usize) != Some(&true);
        if computed.contains(expr) && is_free && !registers.place_of.contains(expr) {
            registers.place_of.insert(expr, register);
        } else if register_of.get(expr) != Some(register) {
            copies.push((expr, register));
            last_use_of.insert(expr, steps.len() as u32);
        }
    }
    let mut items = Vec::with_capacity(steps.len() + copies.len());
    for (index, step) in steps.iter().enumerate() {
        let instruction = match step {
            Step::Enter(guard) => {
                items.push(Item::Enter(registers.of(guard.condition), guard.elsewhere));
                continue;
            }
            Step::Leave => {
                items.push(Item::Leave);
                continue;
            }
            Step::Do(_) if shared.is_needless(index) => continue,
            Step::Do(instruction) => instruction,
        };
        let [a, b, c] = instruction.reads.map(|read| registers.of(read));
        let read = instruction.read().map(|read| shared.root(read));
        registers.release(read.filter(|&read| last_use_of.get(read) == Some(index as u32)));
        let [sine, cosine] = instruction.writes;
        if instruction.op == Op::SinCos {
            // An unwanted one takes a register for this operation alone.
            let written = [sine, cosine].map(|write| write.map(|expr| registers.place(expr)));
            let [d, b] = written.map(|register| register.unwrap_or_else(|| registers.take()));
            items.push(Item::Do(instruction.op, Operands { a, b, c, d }));
            let fresh = [(sine, d), (cosine, b)].into_iter().filter(|(write, _)| write.is_none());
            registers.free.extend(fresh.map(|(_, register)| register));
        } else {
            let d = instruction.writes[0].map_or(u32::MAX, |expr| registers.place(expr));
            items.push(Item::Do(instruction.op, Operands { a, b, c, d }));
        }
    }
    let copies: Vec<(u32, u32)> = copies.into_iter().map(|(expr, register)| (registers.of(expr), register)).collect();
    copy_at_once(copies, || registers.take(), &mut items);
    Tape::new(items)
}

/// Registers of values, and the free scratch registers.
struct Registers<'a> {
    /// Registers of values that exist before or stay.
    register_of: &'a NodeTable,
    shared: &'a Shared,
    /// Registers of computed values, by the last of those that share a register.
    place_of: NodeTable,
    free: Vec<u32>,
    /// The first scratch register, and the first one that was never taken.
    first: u32,
    next: u32,
}

impl Registers<'_> {
    fn find(&self, expr: Expr) -> Option<u32> {
        let root = self.shared.root(expr);
        self.register_of.get(root).or_else(|| self.place_of.get(root))
    }

    /// The register of a value.
    fn of(&self, expr: Expr) -> u32 {
        // The order of the computation has each operand before its use.
        self.find(expr).expect("an operand is a symbol, a constant, stored, or computed before")
    }

    /// The register of a value, a new one if it has none yet.
    fn place(&mut self, expr: Expr) -> u32 {
        self.find(expr).unwrap_or_else(|| {
            let fresh = self.take();
            self.place_of.insert(self.shared.root(expr), fresh);
            fresh
        })
    }

    fn take(&mut self) -> u32 {
        self.free.pop().unwrap_or_else(|| {
            self.next += 1;
            self.next - 1
        })
    }

    /// Frees the scratch registers of values whose last reader is one operation.
    fn release(&mut self, values: impl Iterator<Item = Expr>) {
        let already_free = self.free.len();
        for value in values {
            // An operand may occur twice.
            if let Some(old) = self.place_of.get(value)
                && old >= self.first
                && !self.free[already_free..].contains(&old)
            {
                self.free.push(old);
            }
        }
    }
}

/// Values and registers that a list of steps reads and writes.
#[derive(Debug)]
struct Uses {
    /// The last step that reads a value.
    last_use: NodeTable,
    /// By register below the scratch registers: whether its value from before is read.
    reads_register: Vec<bool>,
    /// Values that are written.
    computed: NodeSet,
}

impl Uses {
    fn of(steps: &[Step], register_of: &NodeTable, first: u32) -> Self {
        let nodes = register_of.nodes();
        let mut uses = Self {
            last_use: NodeTable::new(nodes),
            reads_register: vec![false; first as usize],
            computed: NodeSet::new(nodes),
        };
        for (index, step) in steps.iter().enumerate() {
            for read in step.read() {
                uses.last_use.insert(read, index as u32);
                if let Some(register) = register_of.get(read) {
                    uses.reads_register[register as usize] = true;
                }
            }
            if let Step::Do(instruction) = step {
                instruction.written().for_each(|expr| _ = uses.computed.insert(expr));
            }
        }
        uses
    }
}

/// Copies from register to register as if all happened at once: a value that another copy overwrites is saved first, in
/// a `fresh` register.
fn copy_at_once(copies: Vec<(u32, u32)>, mut fresh: impl FnMut() -> u32, items: &mut Vec<Item>) {
    let overwritten: FxHashSet<u32> = copies.iter().map(|&(_, register)| register).collect();
    let copy = |from: u32, to: u32| Item::Do(Op::Copy, Operands { a: from, b: from, c: from, d: to });
    let mut last = Vec::with_capacity(copies.len());
    for (mut source, register) in copies {
        if overwritten.contains(&source) {
            let aside = fresh();
            items.push(copy(source, aside));
            source = aside;
        }
        last.push(copy(source, register));
    }
    items.extend(last);
}

/// Values that share a register successively: the value elsewhere, and then the choice that a region makes.
#[derive(Debug, Default)]
struct Shared {
    /// By value, the next one in its register; `None` if no values share one.
    next: Option<NodeTable>,
    /// Copies that are not needed, because their value is already in the register of the choice.
    needless: FxHashSet<usize>,
}

impl Shared {
    fn new(steps: &[Step], last_use: &NodeTable, may_share: impl Fn(Expr) -> bool) -> Self {
        let mut shared = Self::default();
        let nodes = last_use.nodes();
        let mut put_down: FxHashMap<Expr, (Expr, usize)> = FxHashMap::default();
        for (index, step) in steps.iter().enumerate() {
            let Step::Do(instruction) = step else { continue };
            let [_, _, last] = instruction.reads;
            match (instruction.op, instruction.writes[0]) {
                (Op::Copy, Some(copied)) => {
                    put_down.insert(copied, (last, index));
                }
                (Op::Select, Some(chosen)) => {
                    let Some(&(value, copied_at)) = put_down.get(&last) else { continue };
                    let next = shared.next.get_or_insert_with(|| NodeTable::new(nodes));
                    next.insert(last, chosen.0);
                    // The choice overwrites the value, which must not be read afterwards.
                    if may_share(value)
                        && last_use.get(value).is_some_and(|last| (last as usize) < index)
                        && !next.contains(value)
                    {
                        next.insert(value, chosen.0);
                        shared.needless.insert(copied_at);
                    }
                }
                _ => {}
            }
        }
        shared
    }

    /// The last of the values that share a register.
    fn root(&self, mut expr: Expr) -> Expr {
        let Some(next) = &self.next else { return expr };
        while let Some(after) = next.get(expr) {
            expr = Expr(after);
        }
        expr
    }

    fn is_needless(&self, index: usize) -> bool {
        self.needless.contains(&index)
    }
}
