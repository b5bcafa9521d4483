//! Whether steps resolve the functions of the time: bounds of their rates of change, and of the number of times that
//! they jump.

use std::f64::consts::TAU;
use std::sync::Arc;

use symdiff::{Expr, Interval, Ranges};

use super::enclosed::{Work, pair, size};
use super::terms::{Condition, functions};
use super::tuning::TUNING;
use crate::assemble::{System, UncertainParameter};
use crate::compile::Layout;
use crate::numerics::Sample;
use crate::simulate::diagnostics::written;

/// The functions of the time in a mechanism's equations of motion.
#[derive(Clone, Debug)]
pub struct TimeFunctions {
    /// s
    duration: f64,
    /// Intervals of the parameters.
    parameters: Vec<Interval>,
    terms: Arc<[Term]>,
    switches: Arc<[Switch]>,
    /// Most halvings of a step.
    halvings: u32,
}

/// A function that steps do not resolve.
pub(super) struct Unresolved<'f> {
    pub formula: &'f str,
    pub of: Expr,
    /// s
    pub period: f64,
}

/// A function of the time.
#[derive(Clone, Debug)]
struct Term {
    of: Expr,
    formula: String,
    /// Value and rate.
    ranges: Ranges,
    /// Half the width of its range.
    size: f64,
    /// Whether it depends on the state too, of which it has the values at the start.
    frozen: bool,
}

/// The argument of a jump.
#[derive(Clone, Debug)]
struct Switch {
    of: Expr,
    formula: String,
    /// Value and rate.
    ranges: Ranges,
    /// Indices of switches at which the value itself jumps.
    jumps_with: Vec<usize>,
}

/// Whether something switches at some time of an interval.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Switches {
    Never,
    /// At most once, or once for sure.
    Once {
        surely: bool,
    },
    Unknown,
}

impl TimeFunctions {
    /// Finds the functions of a mechanism over its box of parameters; `None` if no equation of motion depends on the
    /// time. The nominal start has the layout's registers.
    pub(in crate::simulate) fn of(
        system: &System,
        layout: &Layout,
        nominal_start: &[f64],
        duration: f64,
    ) -> Option<Self> {
        let mut functions = functions(system, layout, nominal_start)?;
        let symbols: Vec<Expr> =
            std::iter::once(system.time).chain(system.parameters.iter().map(|parameter| parameter.symbol)).collect();
        let graph = &mut functions.graph;
        let mut with_rate = |of: Expr| {
            let by_choices = graph.with_choices(&[of])[0];
            let [rate, of_choices] = [of, by_choices].map(|of| graph.derivative(of, system.time));
            (Ranges::new(graph, &symbols, &[of, rate, of_choices]), written(graph, of))
        };
        // One realisation of a random excitation is as fast as another.
        let interval = |own: &UncertainParameter| match own.is_seed {
            true => Interval::point(own.nominal),
            false => Interval::new(own.lower, own.upper),
        };
        let parameters: Vec<Interval> = system.parameters.iter().map(interval).collect();
        let nominal: Vec<f64> = system.parameters.iter().map(|parameter| parameter.nominal).collect();
        let mut terms = Vec::new();
        for (expr, frozen) in functions.terms {
            let (ranges, formula) = with_rate(expr);
            if let Some(size) = size(&ranges, &parameters, &nominal, duration) {
                terms.push(Term { of: expr, formula, ranges, size, frozen });
            }
        }
        let switch = |Condition { of, jumps_with }: Condition| {
            let (ranges, formula) = with_rate(of);
            Switch { of, formula, ranges, jumps_with }
        };
        let switches: Vec<Switch> = functions.conditions.into_iter().map(switch).collect();
        let halvings =
            if system.constraint.is_empty() { TUNING.most_halvings } else { TUNING.most_halvings_with_constraints };
        let found = Self { duration, parameters, terms: terms.into(), switches: switches.into(), halvings };
        (!(found.terms.is_empty() && found.switches.is_empty())).then_some(found)
    }

    /// The same functions of one sample.
    pub(in crate::simulate) fn of_sample(&self, sample: &Sample) -> Self {
        Self { parameters: sample.iter().map(|&value| Interval::point(value)).collect(), ..self.clone() }
    }

    /// Those of the functions that change within some time, s, of one of some samples.
    pub(in crate::simulate) fn changing<'a>(
        &self,
        samples: impl Iterator<Item = (&'a Sample, (f64, f64))>,
        work: &mut Work,
    ) -> Self {
        let boxes: Vec<Vec<Interval>> = samples.map(|(sample, (a, b))| self.of_sample(sample).over(a, b)).collect();
        let mut changes = |term: &&Term| {
            boxes.iter().any(|symbols| {
                let rate = term.over(symbols, work).1.magnitude();
                rate * (symbols[0].upper() - symbols[0].lower()) > f64::EPSILON * term.size
            })
        };
        let terms = self.terms.iter().filter(&mut changes).cloned().collect();
        Self { terms, ..self.clone() }
    }

    /// Most halvings of a step.
    pub(in crate::simulate) fn halvings(&self) -> u32 {
        self.halvings
    }

    /// Whether steps of length h resolve every function from a to b, which may change by `share` of its size within a
    /// step.
    pub(in crate::simulate) fn are_resolved(&self, (a, b): (f64, f64), h: f64, share: f64, work: &mut Work) -> bool {
        self.are_slow((a, b), h, share, work) && self.jumps_are_apart(a, b, h, work)
    }

    /// The same of steps that end at jumps: a jump may be missed only if there are two of the same function.
    pub(in crate::simulate) fn are_resolved_between_jumps(
        &self,
        span: (f64, f64),
        h: f64,
        share: f64,
        work: &mut Work,
    ) -> bool {
        let symbols = self.over(span.0, span.1);
        let is_grazed = h <= TUNING.coinciding_jumps * self.duration;
        let mut is_known = |switch: &Switch| is_grazed || switch.over(&symbols, work) != Switches::Unknown;
        self.switches.iter().all(&mut is_known) && self.are_slow(span, h, share, work)
    }

    /// Whether no function changes by more than `share` of its size within steps of length h from a to b.
    pub(in crate::simulate) fn are_slow(&self, span: (f64, f64), h: f64, share: f64, work: &mut Work) -> bool {
        self.are_slow_over(&self.over(span.0, span.1), h, share, work)
    }

    /// The same as [`are_slow`](Self::are_slow) where times and parameters are taken part by part: a pulse at an
    /// uncertain time is fast in a part of them only.
    pub(in crate::simulate) fn are_slow_in_parts(&self, span: (f64, f64), h: f64, share: f64, work: &mut Work) -> bool {
        let mut parts = vec![self.over(span.0, span.1)];
        let mut seen = 0;
        while let Some(symbols) = parts.pop() {
            if self.are_slow_over(&symbols, h, share, work) {
                continue;
            }
            seen += 1;
            let middle: Vec<Interval> = symbols.iter().map(|own| Interval::point(own.middle())).collect();
            if seen == TUNING.most_parts_of_box || !self.are_slow_over(&middle, h, share, work) {
                return false;
            }
            // The symbol is halved without which the rates are least.
            let at_middle = |index: usize| with(&symbols, index, middle[index]);
            let uncertain = (0..symbols.len()).filter(|&index| symbols[index].upper() > symbols[index].lower());
            let by_share = uncertain.map(|index| (index, self.share_of_step(&at_middle(index), h, work)));
            let Some((index, _)) = by_share.min_by(|a, b| a.1.total_cmp(&b.1)) else { return false };
            parts.extend(halves(&symbols, index));
        }
        true
    }

    /// Largest change of a function within a step of length h, as a share of its size.
    fn share_of_step(&self, symbols: &[Interval], h: f64, work: &mut Work) -> f64 {
        self.terms.iter().map(|term| term.over(symbols, work).1.magnitude() * h / term.size).fold(0.0, f64::max)
    }

    /// Whether no function changes by more than `share` of its size within a step of length h.
    fn are_slow_over(&self, symbols: &[Interval], h: f64, share: f64, work: &mut Work) -> bool {
        self.terms.iter().all(|term| term.is_slow(symbols, h, share, work))
    }

    /// The functions that steps of length h do not resolve from a time on: the first of them as a formula, its
    /// expression, and its period, s, as far as its rate or its jumps determine it.
    pub(super) fn first_unresolved(&self, from: f64, h: f64, work: &mut Work) -> Option<Unresolved<'_>> {
        let symbols = self.over(from, from + h);
        let term = self.terms.iter().find(|term| !term.is_slow(&symbols, h, TUNING.resolved, work));
        if let Some(term) = term {
            let (_, rate) = term.over(&symbols, work);
            let period = if rate.magnitude().is_finite() { TAU * term.size / rate.magnitude() } else { h };
            return Some(Unresolved { formula: &term.formula, of: term.of, period });
        }
        // Two jumps lie in the surroundings of the step.
        let near = self.switches.iter().find(|switch| switch.over(&symbols, work) != Switches::Never);
        let switch = near.or(self.switches.first())?;
        Some(Unresolved {
            formula: &switch.formula,
            of: switch.of,
            period: (1.0 + 2.0 * TUNING.steps_between_jumps) * h,
        })
    }

    /// s
    pub(super) fn duration(&self) -> f64 {
        self.duration
    }

    /// The symbols' intervals for a span of time.
    fn over(&self, a: f64, b: f64) -> Vec<Interval> {
        std::iter::once(Interval::new(a, b)).chain(self.parameters.iter().copied()).collect()
    }

    /// Whether at most one jump lies in a step and its neighbours, for all parameters.
    fn jumps_are_apart(&self, a: f64, b: f64, h: f64, work: &mut Work) -> bool {
        if self.switches.is_empty() {
            return true;
        }
        let (first, last) =
            ((a - TUNING.steps_between_jumps * h).max(0.0), (b + TUNING.steps_between_jumps * h).min(self.duration));
        let mut boxes = vec![(self.over(first, last), 0)];
        let mut seen = 0;
        while let Some((symbols, depth)) = boxes.pop() {
            let (mut possible, mut sure, mut unknown) = (0, 0, false);
            let states: Vec<Switches> = self.switches.iter().map(|switch| switch.over(&symbols, work)).collect();
            for (switch, &state) in self.switches.iter().zip(&states) {
                let with = switch.jumps_with.iter().find(|&&other| matches!(states[other], Switches::Once { .. }));
                let state = match with {
                    Some(&other) if state != Switches::Never => switch.beside(&self.switches[other], &symbols, work),
                    _ => state,
                };
                match state {
                    Switches::Never => {}
                    Switches::Once { surely } => {
                        possible += 1;
                        sure += usize::from(surely);
                    }
                    Switches::Unknown => unknown = true,
                }
            }
            if !unknown && possible <= 1 {
                continue;
            }
            // Jumps that some parameters bring together make a pulse of no more than a step, which no one sees.
            let shortest = if sure < 2 { TUNING.coinciding_jumps } else { TUNING.one_jump };
            if !unknown && h <= shortest * self.duration {
                continue;
            }
            seen += 1;
            let widest = (1..symbols.len()).max_by(|&i, &j| {
                let share =
                    |index: usize| (symbols[index].upper() - symbols[index].lower()) / symbols[index].magnitude();
                share(i).total_cmp(&share(j))
            });
            let splits = widest.filter(|_| sure < 2 && depth < TUNING.deepest_part && seen < TUNING.most_parts_of_box);
            let Some(index) = splits.filter(|&index| symbols[index].upper() > symbols[index].lower()) else {
                return false;
            };
            boxes.extend(halves(&symbols, index).map(|half| (half, depth + 1)));
        }
        true
    }
}

/// A box with another interval of one symbol.
fn with(symbols: &[Interval], index: usize, interval: Interval) -> Vec<Interval> {
    let mut symbols = symbols.to_vec();
    symbols[index] = interval;
    symbols
}

/// Halves of a box along one symbol.
fn halves(symbols: &[Interval], index: usize) -> [Vec<Interval>; 2] {
    let (range, middle) = (symbols[index], symbols[index].middle());
    [Interval::new(range.lower(), middle), Interval::new(middle, range.upper())].map(|half| with(symbols, index, half))
}

impl Term {
    /// Value and rate over a box.
    fn over(&self, symbols: &[Interval], work: &mut Work) -> (Interval, Interval) {
        pair(&self.ranges, symbols, work)
    }

    /// Whether it changes by no more than `share` of its size within steps of length h over a box.
    fn is_slow(&self, symbols: &[Interval], h: f64, share: f64, work: &mut Work) -> bool {
        let (_, rate) = self.over(symbols, work);
        if rate.magnitude().is_finite() {
            return rate.magnitude() * h <= share * self.size;
        }
        let (a, b) = (symbols[0].lower(), symbols[0].upper());
        if b - a > 1.5 * h {
            return false;
        }
        let during = |a: f64, b: f64| with(symbols, 0, Interval::new(a, b));
        // A rate without bound, as that of a root where it begins: the criterion is how far the value goes beyond those
        // at the ends.
        let [first, last] = [a, b].map(|t| self.over(&during(t, t), work).0);
        let beyond = share * self.size;
        let (least, most) = (first.lower().min(last.lower()) - beyond, first.upper().max(last.upper()) + beyond);
        let part = |part: usize| a + (b - a) * part as f64 / TUNING.parts_of_step as f64;
        let within = (0..TUNING.parts_of_step).all(|index| {
            let (value, _) = self.over(&during(part(index), part(index + 1)), work);
            least <= value.lower() && value.upper() <= most
        });
        // Elsewhere in the state it may have one.
        within || self.frozen
    }
}

impl Switch {
    /// Switches other than the jump that `other` causes, which counts by itself: before it and after it.
    fn beside(&self, other: &Self, symbols: &[Interval], work: &mut Work) -> Switches {
        let during = |a: f64, b: f64| with(symbols, 0, Interval::new(a, b));
        let (first, last) = (symbols[0].lower(), symbols[0].upper());
        let (mut low, mut high) = (first, last);
        for _ in 0..TUNING.most_cuts {
            let quarter = 0.25 * (high - low);
            let mut cut = |a: f64, b: f64| other.over(&during(a, b), work) == Switches::Never;
            match (cut(low, low + quarter), cut(high - quarter, high)) {
                (false, false) => break,
                (from_below, from_above) => {
                    low += if from_below { quarter } else { 0.0 };
                    high -= if from_above { quarter } else { 0.0 };
                }
            }
        }
        // Where a whole number is passed is rounded.
        let slack = 1e-9 * (last - first);
        let (low, high) = ((low - slack).max(first), (high + slack).min(last));
        let mut side = |a: f64, b: f64| if b - a <= slack { Switches::Never } else { self.over(&during(a, b), work) };
        match (side(first, low), side(high, last)) {
            (Switches::Never, state) | (state, Switches::Never) => state,
            _ => Switches::Unknown,
        }
    }

    fn over(&self, symbols: &[Interval], work: &mut Work) -> Switches {
        let (value, rate) = pair(&self.ranges, symbols, work);
        if value.lower() > 0.0 || value.upper() < 0.0 {
            return Switches::Never;
        }
        if rate.contains(0.0) {
            return Switches::Unknown;
        }
        let mut at = |t: f64| pair(&self.ranges, &with(symbols, 0, Interval::point(t)), work).0;
        let (first, last) = (at(symbols[0].lower()), at(symbols[0].upper()));
        let surely = first.upper() < 0.0 && last.lower() > 0.0 || first.lower() > 0.0 && last.upper() < 0.0;
        Switches::Once { surely }
    }
}
