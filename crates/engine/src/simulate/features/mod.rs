//! Features of the forces in space: functions of the positions, bounded as a whole, that a step may pass over from one
//! side to the other. The ends of a step that jumps over a bump show nothing of it, and those of its halves neither.
//!
//! Every such function is enclosed over all positions between the ends of a step, and where that shows a feature of a
//! fixed step, over the parts of the step's path on which the forces use it. Functions of the time alone are enclosed
//! before the run (`time_functions`).

mod candidates;
mod path;
pub(crate) mod tuning;

use symdiff::{Expr, Interval, Node, Ranges, Unary};

use self::candidates::{Candidate, candidates};
use self::path::StepCubics;
use super::step::Stepper;
use crate::assemble::System;
use crate::compile::Layout;
use tuning::TUNING;

/// The functions of the positions in a mechanism's forces.
#[derive(Clone, Debug)]
pub(super) struct Features {
    layout: Layout,
    functions: Vec<Function>,
    /// Ranges of all functions at once: they have most of their operations in common.
    ranges: Ranges,
}

#[derive(Clone, Debug)]
struct Function {
    /// Range of this function alone.
    ranges: Ranges,
    /// The width of its range.
    whole: f64,
    /// Conditions of which each has to be positive for the function to be used.
    conditions: Ranges,
}

/// A sample's step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage<'p> {
    /// Its end, s.
    pub end: f64,
    /// Its length, s.
    pub h: f64,
    /// The sample's parameters.
    pub parameters: &'p [f64],
    /// (q, v) at its beginning and at its end, line by line of a tile of this width, and the sample's lane.
    pub states: [&'p [f64]; 2],
    pub width: usize,
    pub lane: usize,
}

/// Memory of enclosures.
#[derive(Clone, Debug, Default)]
pub(super) struct FeatureWork {
    path: StepCubics,
    /// Intervals over the whole step, at its beginning, at its end, and over a part.
    symbols: [Vec<Interval>; 4],
    values: Vec<Interval>,
    /// Indices of functions that change by much over the whole step.
    wide: Vec<usize>,
}

impl Features {
    /// Finds the functions of a mechanism; `None` if no force has any.
    pub fn of(system: &System) -> Option<Self> {
        let mut graph = system.graph.clone();
        let candidates = candidates(system, &mut graph);
        if candidates.is_empty() {
            return None;
        }
        let parameters = system.parameters.iter().map(|parameter| parameter.symbol);
        let symbols: Vec<Expr> =
            std::iter::once(system.time).chain(parameters).chain(system.q.iter().copied()).collect();
        let far = Interval::new(-TUNING.far, TUNING.far);
        let of_parameters = system.parameters.iter().map(|parameter| Interval::new(parameter.lower, parameter.upper));
        let everywhere: Vec<Interval> = std::iter::once(Interval::new(0.0, TUNING.far))
            .chain(of_parameters)
            .chain(std::iter::repeat_n(far, system.q.len()))
            .collect();
        let mut work = Vec::new();
        let (roots, functions): (Vec<Expr>, Vec<Function>) = candidates
            .into_iter()
            .filter_map(|Candidate { of, conditions }| {
                let ranges = Ranges::new(&graph, &symbols, &[of]);
                let range = match graph.node(of) {
                    // A table goes on along a line.
                    Node::Unary(Unary::Spline(table, order), _) => {
                        let (first, last) = table.range();
                        table.enclose(order, Interval::new(first, last))
                    }
                    _ => ranges.enclose(&everywhere, &mut work).next().unwrap_or(Interval::ENTIRE),
                };
                let whole = range.upper() - range.lower();
                (whole.is_finite() && whole > TUNING.constant_function * range.magnitude()).then(|| {
                    let conditions = Ranges::new(&graph, &symbols, &conditions);
                    (of, Function { ranges, whole, conditions })
                })
            })
            .unzip();
        let layout = Layout::of(system);
        let ranges = Ranges::new(&graph, &symbols, &roots);
        (!functions.is_empty()).then_some(Self { layout, functions, ranges })
    }

    /// Whether a function changes by more than this share of its whole range on the way.
    pub fn change(&self, passage: Passage, share: f64, work: &mut FeatureWork) -> bool {
        let FeatureWork { path, symbols: [between, ..], values, .. } = work;
        path.take(passage, &self.layout);
        path.between([0.0, 1.0], between);
        let mut ranges = self.ranges.enclose(between, values).zip(&self.functions);
        ranges.any(|(range, function)| range.upper() - range.lower() > share * function.whole)
    }

    /// Whether a function that forces use changes within a step by as much as its ends may hide.
    pub fn act(&self, passage: Passage, work: &mut FeatureWork) -> bool {
        self.find_wide(passage, work);
        let FeatureWork { path, symbols: [.., part], values, wide } = work;
        wide.iter().any(|&index| {
            let function = &self.functions[index];
            let range = function.along(path, [0.0, 1.0], TUNING.halvings_of_path, part, values);
            range.is_some_and(|range| !function.is_narrow(range))
        })
    }

    /// Finds the functions that change by much over a whole step, as far as an enclosure of both ends shows.
    fn find_wide(&self, passage: Passage, work: &mut FeatureWork) {
        let FeatureWork { path, symbols: [between, ..], values, wide } = work;
        path.take(passage, &self.layout);
        path.between([0.0, 1.0], between);
        wide.clear();
        let ranges = self.ranges.enclose(between, values).zip(&self.functions).enumerate();
        wide.extend(ranges.filter(|(_, (range, function))| !function.is_narrow(*range)).map(|(index, _)| index));
    }

    /// Whether the ends of a step hide the course of functions between them.
    pub fn are_hidden(&self, passage: Passage, work: &mut FeatureWork) -> bool {
        self.find_wide(passage, work);
        let FeatureWork { path, symbols: [_, begin, end, part], values, wide } = work;
        if wide.is_empty() {
            return false;
        }
        path.between([0.0, 0.0], begin);
        path.between([1.0, 1.0], end);
        let mut edges = 0;
        wide.iter().any(|&index| {
            let function = &self.functions[index];
            let used = |symbols: &[Interval], values: &mut _| {
                function.is_used(symbols, values).then(|| function.over(symbols, values))
            };
            let ends = hull(used(begin, values), used(end, values));
            let range = function.along(path, [0.0, 1.0], TUNING.halvings_of_path, part, values);
            let Some(range) = range else { return false };
            edges += usize::from(function.is_edge(range));
            function.is_beyond(range, ends) || edges > 1
        })
    }
}

/// The least interval that holds both; `None` holds nothing.
fn hull(a: Option<Interval>, b: Option<Interval>) -> Option<Interval> {
    let both = |a: Interval, b: Interval| Interval::new(a.lower().min(b.lower()), a.upper().max(b.upper()));
    a.into_iter().chain(b).reduce(both)
}

impl Function {
    /// Whether each condition may be positive somewhere between: a contact's normal does nothing where nothing touches.
    fn is_used(&self, symbols: &[Interval], values: &mut Vec<Interval>) -> bool {
        self.conditions.enclose(symbols, values).all(|condition| condition.upper() > 0.0)
    }

    fn over(&self, symbols: &[Interval], values: &mut Vec<Interval>) -> Interval {
        self.ranges.enclose(symbols, values).next().unwrap_or(Interval::ENTIRE)
    }

    /// Range over those pieces of a part of a path on which it is used; `None` if there are none.
    fn along(
        &self,
        path: &StepCubics,
        part: [f64; 2],
        halvings: u32,
        symbols: &mut Vec<Interval>,
        values: &mut Vec<Interval>,
    ) -> Option<Interval> {
        path.between(part, symbols);
        if !self.is_used(symbols, values) {
            return None;
        }
        let range = self.over(symbols, values);
        if halvings == 0 || self.is_narrow(range) {
            return Some(range);
        }
        let middle = 0.5 * (part[0] + part[1]);
        let mut half = |part| self.along(path, part, halvings - 1, symbols, values);
        hull(half([part[0], middle]), half([middle, part[1]]))
    }

    /// Whether nothing can be hidden in a range.
    fn is_narrow(&self, range: Interval) -> bool {
        range.upper() - range.lower() <= TUNING.beyond_ends * self.whole
    }

    /// Whether values on the way lie far beyond those at the ends; of no ends, far from one another.
    fn is_beyond(&self, range: Interval, ends: Option<Interval>) -> bool {
        let beyond = match ends {
            Some(ends) => (ends.lower() - range.lower()).max(range.upper() - ends.upper()),
            None => range.upper() - range.lower(),
        };
        beyond > TUNING.beyond_ends * self.whole
    }

    /// Whether values on the way make a step from one side of the whole range to the other.
    fn is_edge(&self, range: Interval) -> bool {
        range.upper() - range.lower() > TUNING.edge_of_bump * self.whole
    }
}

/// Compares the states at both ends of a step of a tile.
#[derive(Clone, Debug)]
pub(super) struct FeatureWatch<'s> {
    features: &'s Features,
    before: Vec<f64>,
    after: Vec<f64>,
    parameters: Vec<f64>,
    work: FeatureWork,
}

impl<'s> FeatureWatch<'s> {
    pub fn new(features: &'s Features) -> Self {
        let [before, after, parameters] = [const { Vec::new() }; 3];
        Self { features, before, after, parameters, work: FeatureWork::default() }
    }

    /// Stores the state before a step.
    pub fn begin(&mut self, stepper: &Stepper) {
        copy(&self.features.layout, stepper, &mut self.before);
    }

    /// Stores the state after a step.
    pub fn end(&mut self, stepper: &Stepper) {
        copy(&self.features.layout, stepper, &mut self.after);
    }

    /// Whether a function changes by more than this share of its whole range in a lane's step of length h up to `end`.
    pub fn change(&mut self, stepper: &Stepper, lane: usize, h: f64, end: f64, share: f64) -> bool {
        self.with(stepper, lane, h, end, |features, passage, work| features.change(passage, share, work))
    }

    /// After a step: whether its ends hide the course of functions between them in one of the first `count` lanes.
    pub fn end_hidden(&mut self, stepper: &Stepper, count: usize, h: f64, end: f64) -> bool {
        self.end(stepper);
        let mut lanes = (0..count).filter(|&lane| stepper.alive()[lane]);
        lanes.any(|lane| self.with(stepper, lane, h, end, Features::are_hidden))
    }

    fn with(
        &mut self,
        stepper: &Stepper,
        lane: usize,
        h: f64,
        end: f64,
        ask: impl Fn(&Features, Passage, &mut FeatureWork) -> bool,
    ) -> bool {
        let layout = &self.features.layout;
        self.parameters.clear();
        self.parameters.extend(layout.parameters.clone().map(|register| stepper.tile().lane(register)[lane]));
        let states = [&self.before[..], &self.after[..]];
        let passage = Passage { end, h, parameters: &self.parameters, states, width: stepper.tile().width(), lane };
        ask(self.features, passage, &mut self.work)
    }
}

fn copy(layout: &Layout, stepper: &Stepper, into: &mut Vec<f64>) {
    into.clear();
    into.extend_from_slice(stepper.tile().block(layout.q.start..layout.v.end));
}
