//! Which register each value of a tape takes.

use rustc_hash::{FxHashMap, FxHashSet};

use super::schedule::Step;
use super::tape::{Item, Op, Operands, Tape};
use crate::expr::Expr;

/// Registers by linear scan: a scratch register is free again after its value's last use. A target is written at once
/// unless this tape still reads what stands there; then it is copied at the end. `register_of` tells where values stand that are
/// there before or stay; scratch registers begin at `first`.
pub(crate) fn allocate(
    steps: &[Step],
    targets: &[(Expr, u32)],
    register_of: &FxHashMap<Expr, u32>,
    first: u32,
) -> Tape {
    let mut last_use: FxHashMap<Expr, usize> = FxHashMap::default();
    let mut read_registers: FxHashSet<u32> = FxHashSet::default();
    let mut computed: FxHashSet<Expr> = FxHashSet::default();
    for (place, step) in steps.iter().enumerate() {
        for read in step.read() {
            last_use.insert(read, place);
            read_registers.extend(register_of.get(&read));
        }
        if let Step::Do(instruction) = step {
            computed.extend(instruction.written());
        }
    }
    read_registers.extend(targets.iter().filter_map(|(expr, _)| register_of.get(expr)));
    let placed: FxHashSet<Expr> = targets.iter().map(|&(expr, _)| expr).collect();
    let may_share = |expr: &Expr| computed.contains(expr) && !placed.contains(expr) && !register_of.contains_key(expr);
    let shared = Shared::new(steps, &last_use, may_share);
    let mut last_use_of: FxHashMap<Expr, usize> = FxHashMap::default();
    for (&expr, &place) in &last_use {
        let last = last_use_of.entry(shared.root(expr)).or_default();
        *last = place.max(*last);
    }
    let mut place_of: FxHashMap<Expr, u32> = FxHashMap::default();
    let mut copies = Vec::new();
    for &(expr, register) in targets {
        if computed.contains(&expr) && !read_registers.contains(&register) && !place_of.contains_key(&expr) {
            place_of.insert(expr, register);
        } else if register_of.get(&expr) != Some(&register) {
            copies.push((expr, register));
            last_use_of.insert(expr, steps.len());
        }
    }
    let kept = |place_of: &FxHashMap<Expr, u32>, expr: Expr| {
        let root = shared.root(expr);
        register_of.get(&root).or_else(|| place_of.get(&root)).copied()
    };
    let mut free: Vec<u32> = Vec::new();
    let mut next = first;
    let mut items = Vec::with_capacity(steps.len() + copies.len());
    for (place, step) in steps.iter().enumerate() {
        let register = |place_of: &FxHashMap<Expr, u32>, expr| {
            kept(place_of, expr).expect("operands are computed before their use")
        };
        let instruction = match step {
            Step::Enter(guard) => {
                items.push(Item::Enter(register(&place_of, guard.condition), guard.elsewhere));
                continue;
            }
            Step::Leave => {
                items.push(Item::Leave);
                continue;
            }
            Step::Do(_) if shared.is_needless(place) => continue,
            Step::Do(instruction) => instruction,
        };
        let [a, b, c] = instruction.reads.map(|read| register(&place_of, read));
        let already_free = free.len();
        for read in instruction.read().map(|read| shared.root(read)).filter(|read| last_use_of[read] == place) {
            // An operand may stand there twice.
            if let Some(&old) = place_of.get(&read)
                && old >= first
                && !free[already_free..].contains(&old)
            {
                free.push(old);
            }
        }
        let mut unused = None;
        let mut destinations = instruction.writes.map(|write| match write {
            Some(expr) => kept(&place_of, expr).unwrap_or_else(|| {
                let fresh = take(&mut free, &mut next);
                place_of.insert(shared.root(expr), fresh);
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
        items.push(Item::Do(instruction.op, Operands { a, b, c, d }));
        free.extend(unused);
    }
    // All copies happen at once: what another copy overwrites is put aside first.
    let overwritten: FxHashSet<u32> = copies.iter().map(|&(_, register)| register).collect();
    let copy = |from: u32, to: u32| Item::Do(Op::Copy, Operands { a: from, b: from, c: from, d: to });
    let mut last = Vec::with_capacity(copies.len());
    for &(expr, register) in &copies {
        let mut source = kept(&place_of, expr).expect("an output is a symbol, a constant, kept, or computed here");
        if overwritten.contains(&source) {
            let aside = take(&mut free, &mut next);
            items.push(copy(source, aside));
            source = aside;
        }
        last.push(copy(source, register));
    }
    items.extend(last);
    Tape::new(items)
}

/// Values that take one register after the other: what holds elsewhere, and then the choice that a region makes in its place.
#[derive(Debug, Default)]
struct Shared {
    next: FxHashMap<Expr, Expr>,
    /// Copies that are not needed, because their value already stands where the choice is made.
    needless: FxHashSet<usize>,
}

impl Shared {
    fn new(steps: &[Step], last_use: &FxHashMap<Expr, usize>, may_share: impl Fn(&Expr) -> bool) -> Self {
        let mut shared = Self::default();
        let mut put_down: FxHashMap<Expr, (Expr, usize)> = FxHashMap::default();
        for (place, step) in steps.iter().enumerate() {
            let Step::Do(instruction) = step else { continue };
            let [_, _, last] = instruction.reads;
            match (instruction.op, instruction.writes[0]) {
                (Op::Copy, Some(copied)) => {
                    put_down.insert(copied, (last, place));
                }
                (Op::Select, Some(chosen)) => {
                    let Some(&(value, copied_at)) = put_down.get(&last) else { continue };
                    shared.next.insert(last, chosen);
                    // The choice overwrites the value, which nobody may look for afterwards.
                    if may_share(&value) && last_use[&value] < place && !shared.next.contains_key(&value) {
                        shared.next.insert(value, chosen);
                        shared.needless.insert(copied_at);
                    }
                }
                _ => {}
            }
        }
        shared
    }

    /// The value that all others of its register become at last.
    fn root(&self, mut expr: Expr) -> Expr {
        while let Some(&next) = self.next.get(&expr) {
            expr = next;
        }
        expr
    }

    fn is_needless(&self, place: usize) -> bool {
        self.needless.contains(&place)
    }
}

fn take(free: &mut Vec<u32>, next: &mut u32) -> u32 {
    free.pop().unwrap_or_else(|| {
        *next += 1;
        *next - 1
    })
}
