//! A tape's instructions before they have registers, and their order: region by region, equal operations together.

use super::node_table::NodeTable;
use super::readers::Readers;
use super::regions::{OUTSIDE, RegionId, Regions, order};
use super::tape::{Guard, Op};
use crate::expr::Expr;
use crate::tuning::TUNING;

/// An instruction before it has registers.
#[derive(Clone, Debug)]
pub(crate) struct Pending {
    pub op: Op,
    /// Operands; the first `count` are used.
    pub reads: [Expr; 3],
    pub count: usize,
    /// Result, or for `SinCos` the sine and the cosine, one of which may be unwanted.
    pub writes: [Option<Expr>; 2],
    pub region: RegionId,
}

impl Pending {
    pub fn new(op: Op, reads: [Expr; 3], count: usize, write: Expr) -> Self {
        Self { op, reads, count, writes: [Some(write), None], region: OUTSIDE }
    }

    pub fn within(self, region: RegionId) -> Self {
        Self { region, ..self }
    }

    pub fn read(&self) -> impl Iterator<Item = Expr> {
        self.reads.into_iter().take(self.count)
    }

    pub fn written(&self) -> impl Iterator<Item = Expr> + use<> {
        self.writes.into_iter().flatten()
    }
}

/// A tape before it has registers.
pub(crate) enum Step {
    Do(Pending),
    Enter(Guard),
    Leave,
}

impl Step {
    pub fn read(&self) -> impl Iterator<Item = Expr> {
        let (instruction, condition) = match self {
            Self::Do(instruction) => (Some(instruction), None),
            Self::Enter(guard) => (None, Some(guard.condition)),
            Self::Leave => (None, None),
        };
        instruction.into_iter().flat_map(Pending::read).chain(condition)
    }
}

/// Groups instructions by region, and equal operations within it.
pub(crate) fn in_regions(nodes: usize, pending: Vec<Pending>, regions: &Regions) -> Vec<Step> {
    let mut grouping = Grouping { writer: NodeTable::new(nodes) };
    if regions.is_empty() {
        return grouping.group(pending).into_iter().map(Step::Do).collect();
    }
    let needs = |index: usize| pending[index].read().chain(regions.conditions(pending[index].region));
    let readers = grouping.readers(&pending, needs);
    let order = order(regions, pending.len(), |index| pending[index].region, &readers);
    let mut steps = Vec::with_capacity(pending.len());
    let mut current = OUTSIDE;
    let mut go_to = |steps: &mut Vec<Step>, region: RegionId| {
        let (left, entered) = regions.way(current, region);
        steps.extend((0..left).map(|_| Step::Leave));
        steps.extend(entered.into_iter().filter_map(|region| regions.guard(region)).map(Step::Enter));
        current = region;
    };
    for together in order.chunk_by(|&a, &b| pending[a].region == pending[b].region) {
        go_to(&mut steps, pending[together[0]].region);
        let together = together.iter().map(|&index| pending[index].clone()).collect();
        steps.extend(grouping.group(together).into_iter().map(Step::Do));
    }
    go_to(&mut steps, OUTSIDE);
    steps
}

/// Instructions of a window that are ready, operation by operation, first come, first served.
struct Ready {
    queues: Vec<Queue>,
    /// By instruction, its successor in its queue.
    after: Vec<Option<usize>>,
}

/// Ready instructions of one operation.
struct Queue {
    op: Op,
    /// The first and the last, if there are any.
    ends: Option<(usize, usize)>,
    count: usize,
}

impl Ready {
    /// No instructions yet, for a window of `window`.
    fn of(window: usize) -> Self {
        Self { queues: Vec::new(), after: vec![None; window] }
    }

    fn enqueue(&mut self, op: Op, index: usize) {
        match self.queues.iter_mut().find(|queue| queue.op == op) {
            Some(Queue { ends, count, .. }) => {
                let first = ends.map_or(index, |(first, last)| {
                    self.after[last] = Some(index);
                    first
                });
                (*ends, *count) = (Some((first, index)), *count + 1);
            }
            None => self.queues.push(Queue { op, ends: Some((index, index)), count: 1 }),
        }
    }

    /// Removes all instructions of the most frequent operation, the first one of several; returns their first.
    fn take_most(&mut self) -> Option<usize> {
        let counts = self.queues.iter_mut().enumerate();
        let (_, most) = counts.max_by_key(|(place, queue)| (queue.count, usize::MAX - place))?;
        most.count = 0;
        most.ends.take().map(|(first, _)| first)
    }
}

/// Groups equal operations.
struct Grouping {
    /// Index in the current list of the instruction that writes a value; empty between lists.
    writer: NodeTable,
}

impl Grouping {
    /// The readers among the instructions of a list. `needs` gives the values that one reads.
    fn readers<N: Iterator<Item = Expr>>(&mut self, list: &[Pending], needs: impl Fn(usize) -> N) -> Readers {
        for (index, one) in list.iter().enumerate() {
            one.written().for_each(|expr| self.writer.insert(expr, index as u32));
        }
        let readers = Readers::of(list.len(), &self.writer, needs);
        list.iter().flat_map(Pending::written).for_each(|expr| self.writer.remove(expr));
        readers
    }

    /// Groups equal operations within stretches of a fixed number of instructions: always all ready instructions of the
    /// most frequent operation.
    fn group(&mut self, pending: Vec<Pending>) -> Vec<Pending> {
        let mut grouped = Vec::with_capacity(pending.len());
        for window in pending.chunks(TUNING.window_of_grouping) {
            let readers = self.readers(window, |index| window[index].read());
            let mut missing = readers.missing(window.len());
            let mut ready = Ready::of(window.len());
            let free = (0..window.len()).filter(|&index| missing[index] == 0);
            free.for_each(|index| ready.enqueue(window[index].op, index));
            while let Some(first) = ready.take_most() {
                let mut left = Some(first);
                while let Some(index) = left {
                    left = ready.after[index];
                    grouped.push(window[index].clone());
                    for &reader in readers.of_writer(index) {
                        missing[reader] -= 1;
                        if missing[reader] == 0 {
                            ready.enqueue(window[reader].op, reader);
                        }
                    }
                }
            }
        }
        grouped
    }
}
