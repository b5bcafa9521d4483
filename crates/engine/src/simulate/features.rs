//! Features of the forces in space: functions of the positions, bounded as a whole, that a step may pass over from one
//! side to the other. The ends of a step that jumps over a bump show nothing of it, and those of its halves neither.
//!
//! Every such function is enclosed over all positions between the ends of a step. Functions of the time alone are
//! enclosed before the run (`time_functions`).

use rustc_hash::{FxHashMap, FxHashSet};
use symdiff::{Binary, Expr, Graph, Interval, Node, Ranges, Unary};

use super::step::Stepper;
use crate::assemble::System;
use crate::compile::Layout;

/// Positions over which a function's whole range is taken.
const FAR: f64 = 1e6;

/// Operations of a function, counted as if nothing were shared; those of long chains of bodies are left out.
const MOST_OPERATIONS: usize = 2000;

/// A function that changes by less than this, relative to its values, is constant.
const CONSTANT: f64 = 1e-9;

/// Of its whole range, what a function may go beyond its values at the ends of a fixed step.
const BEYOND: f64 = 0.25;

/// Of its whole range, what two functions may change by in a fixed step: together they may be a bump.
const EDGE: f64 = 0.75;

/// The functions of the positions in a mechanism's forces.
#[derive(Clone, Debug)]
pub(super) struct Features {
    layout: Layout,
    functions: Vec<Function>,
}

#[derive(Clone, Debug)]
struct Function {
    ranges: Ranges,
    /// The width of its range.
    whole: f64,
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
    symbols: [Vec<Interval>; 3],
    values: Vec<Interval>,
}

impl Features {
    /// Of a mechanism; `None` where no force has any.
    pub fn of(system: &System) -> Option<Self> {
        let mut graph = system.graph.clone();
        let candidates = candidates(system, &mut graph);
        if candidates.is_empty() {
            return None;
        }
        let parameters = system.parameters.iter().map(|parameter| parameter.symbol);
        let symbols: Vec<Expr> =
            std::iter::once(system.time).chain(parameters).chain(system.q.iter().copied()).collect();
        let far = Interval::new(-FAR, FAR);
        let of_parameters = system.parameters.iter().map(|parameter| Interval::new(parameter.lower, parameter.upper));
        let everywhere: Vec<Interval> = std::iter::once(Interval::new(0.0, FAR))
            .chain(of_parameters)
            .chain(std::iter::repeat_n(far, system.q.len()))
            .collect();
        let mut work = Vec::new();
        let functions: Vec<Function> = candidates
            .into_iter()
            .filter_map(|of| {
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
                (whole.is_finite() && whole > CONSTANT * range.magnitude()).then_some(Function { ranges, whole })
            })
            .collect();
        let layout = Layout::new(system.parameters.len(), system.q.len(), system.lambda.len());
        (!functions.is_empty()).then_some(Self { layout, functions })
    }

    /// Whether a function changes by more than this share of its whole range on the way.
    pub fn change(&self, passage: Passage, share: f64, work: &mut FeatureWork) -> bool {
        self.take(passage, work);
        let FeatureWork { symbols: [between, ..], values } = work;
        self.functions.iter().any(|function| {
            let range = function.over(between, values);
            range.upper() - range.lower() > share * function.whole
        })
    }

    /// Whether the ends of a step hide what functions do on the way.
    pub fn are_hidden(&self, passage: Passage, work: &mut FeatureWork) -> bool {
        self.take(passage, work);
        let FeatureWork { symbols: [between, begin, end], values } = work;
        let mut edges = 0;
        self.functions.iter().any(|function| {
            let range = function.over(between, values);
            if range.upper() - range.lower() <= BEYOND * function.whole {
                return false;
            }
            edges += usize::from(range.upper() - range.lower() > EDGE * function.whole);
            let (first, last) = (function.over(begin, values), function.over(end, values));
            let beyond =
                (first.lower().min(last.lower()) - range.lower()).max(range.upper() - first.upper().max(last.upper()));
            beyond > BEYOND * function.whole || edges > 1
        })
    }

    /// Intervals of time, parameters and positions between the ends of a step, and at both.
    fn take(&self, passage: Passage, work: &mut FeatureWork) {
        let Passage { end, h, parameters, states: [before, after], width, lane } = passage;
        let n = self.layout.q.len();
        let line = |state: &[f64], line: usize| state[line * width + lane];
        let times = [Interval::new(end - h, end), Interval::point(end - h), Interval::point(end)];
        for (symbols, time) in work.symbols.iter_mut().zip(times) {
            symbols.clear();
            symbols.push(time);
            symbols.extend(parameters.iter().copied().map(Interval::point));
        }
        let [between, begin, ending] = &mut work.symbols;
        for coordinate in 0..n {
            let (a, b) = (line(before, coordinate), line(after, coordinate));
            // The cubic through both ends lies between these.
            let control = [line(before, n + coordinate), -line(after, n + coordinate)].map(|rate| h / 3.0 * rate);
            let (low, high) = (a.min(a + control[0]), a.max(a + control[0]));
            let (low, high) = (low.min(b).min(b + control[1]), high.max(b).max(b + control[1]));
            between.push(Interval::new(low, high));
            begin.push(Interval::point(a));
            ending.push(Interval::point(b));
        }
    }
}

impl Function {
    fn over(&self, symbols: &[Interval], values: &mut Vec<Interval>) -> Interval {
        self.ranges.enclose(symbols, values).next().unwrap_or(Interval::ENTIRE)
    }
}

/// On what an expression depends, and how many operations it has at most.
#[derive(Clone, Copy, Default)]
struct Known {
    on_positions: bool,
    on_rates: bool,
    operations: usize,
}

/// Functions of the positions that may be bounded: waves, bells, steps, tables and quotients.
fn candidates(system: &System, graph: &mut Graph) -> Vec<Expr> {
    let positions: FxHashSet<Expr> = system.q.iter().copied().collect();
    let rates: FxHashSet<Expr> = system.v.iter().chain(&system.w).chain(&system.lambda).copied().collect();
    let mut known: FxHashMap<Expr, Known> = FxHashMap::default();
    let mut found = Vec::new();
    for expr in graph.reachable(&system.force) {
        let node = graph.node(expr);
        let mut of = Known { on_positions: positions.contains(&expr), on_rates: rates.contains(&expr), operations: 1 };
        for child in node.children() {
            of.on_positions |= known[&child].on_positions;
            of.on_rates |= known[&child].on_rates;
            of.operations = of.operations.saturating_add(known[&child].operations);
        }
        known.insert(expr, of);
        if !of.on_positions || of.on_rates || of.operations > MOST_OPERATIONS {
            continue;
        }
        match node {
            // Turning bodies make waves that are as long as a turn.
            Node::Unary(Unary::Sin | Unary::Cos, a) if is_sum(graph, a) => {}
            Node::Unary(Unary::Sin | Unary::Cos | Unary::Exp | Unary::Tanh | Unary::Atan | Unary::Spline(..), _)
            | Node::Binary(Binary::Pow, ..) => found.push(expr),
            Node::Binary(Binary::Div, _, divisor) if known[&divisor].on_positions => {
                let one = graph.constant(1.0);
                found.push(graph.div(one, divisor));
            }
            _ => {}
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// Whether an expression is a sum of symbols and numbers.
fn is_sum(graph: &Graph, expr: Expr) -> bool {
    match graph.node(expr) {
        Node::Constant(_) | Node::Symbol(_) => true,
        Node::Unary(Unary::Neg, a) => is_sum(graph, a),
        Node::Binary(Binary::Add | Binary::Sub, a, b) => is_sum(graph, a) && is_sum(graph, b),
        _ => false,
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

    /// Before a step.
    pub fn begin(&mut self, stepper: &Stepper) {
        copy(&self.features.layout, stepper, &mut self.before);
    }

    /// After a step.
    pub fn end(&mut self, stepper: &Stepper) {
        copy(&self.features.layout, stepper, &mut self.after);
    }

    /// Whether a function changes by more than this share of its whole range in a lane's step of length h up to `end`.
    pub fn change(&mut self, stepper: &Stepper, lane: usize, (h, end): (f64, f64), share: f64) -> bool {
        self.with(stepper, lane, (h, end), |features, passage, work| features.change(passage, share, work))
    }

    /// After a step: whether its ends hide in one of the first `count` lanes what functions do on the way.
    pub fn end_hidden(&mut self, stepper: &Stepper, count: usize, step: (f64, f64)) -> bool {
        self.end(stepper);
        let mut lanes = (0..count).filter(|&lane| stepper.alive()[lane]);
        lanes.any(|lane| self.with(stepper, lane, step, Features::are_hidden))
    }

    fn with(
        &mut self,
        stepper: &Stepper,
        lane: usize,
        (h, end): (f64, f64),
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
