//! Derivatives of reduced outputs and of requirements' margins, from those of their sources over the time.
//!
//! Where an extreme is taken, its instant may move with a parameter, but that does not change it to first order. An
//! instant at which a source passes zero moves by −(∂y/∂p)/ẏ, one at which it is greatest by −(∂ẏ/∂p)/ÿ.

use symdiff::Formula;

use super::curve::Curve;
use crate::assemble::NumberFormulas;
use crate::grammar::display_unit::DisplayUnit;
use crate::model::{Description, ReducedKind, ReducedOutput, Requirement};
use crate::results::{Gradients, OutputGradients, ReducedGradients};
use crate::simulate::{Accumulation, Channel, Term};

/// A number a motion: its value, the instant that decides it, and its derivatives by outputs in rows.
pub struct InRows {
    /// SI.
    pub value: f64,
    time: Option<f64>,
    /// The derivatives that are not zero.
    pub terms: Vec<Term>,
}

/// Derivatives of all reduced outputs and margins that are of the motion; `found` has their sources among its outputs.
pub(super) fn of_sources(description: &Description, found: &Gradients) -> Vec<ReducedGradients> {
    let Gradients { times, outputs, .. } = found;
    let nominal: Vec<f64> = found.parameters.iter().map(|parameter| parameter.value).collect();
    let curve = |output: usize, sign: f64| Curve { times, values: &outputs[output].values, output, sign };
    let reduced = description.reduced.iter().filter(|own| !own.of_results).filter_map(|own| {
        let found = of_reduced(own, description.simulation.duration, &curve)?.by_parameters(outputs, nominal.len());
        let display = description.display.get(&own.name).cloned();
        Some(found.named(own.name.clone(), own.unit.clone(), display, false))
    });
    let mut all: Vec<ReducedGradients> = reduced.collect();
    let margins = description.requirements.iter().filter(|own| !own.of_results).filter_map(|own| {
        let found = match own.times {
            Some((from, to)) => of_margin(own, from, to.min(description.simulation.duration), &curve)
                .map(|found| found.by_parameters(outputs, nominal.len())),
            None => of_values(own, description, &nominal, &all),
        };
        Some(found?.named(own.name.clone(), own.unit.clone(), own.display.clone(), true))
    });
    let margins: Vec<ReducedGradients> = margins.collect();
    all.extend(margins);
    all
}

/// The same by parameters.
struct Found {
    value: f64,
    time: Option<f64>,
    by_parameters: Vec<f64>,
}

impl Found {
    fn named(self, name: String, unit: String, display: Option<DisplayUnit>, is_margin: bool) -> ReducedGradients {
        let Self { value, time, by_parameters } = self;
        ReducedGradients { name, unit, display, is_margin, value, time, by_parameters }
    }
}

impl InRows {
    /// Derivatives by `parameters` parameters, from the outputs' derivatives.
    fn by_parameters(self, outputs: &[OutputGradients], parameters: usize) -> Found {
        let mut by_parameters = vec![0.0; parameters];
        for Term { row, output, weight } in &self.terms {
            let of_row = by_parameters.iter_mut().zip(&outputs[*output].by_parameters[*row]);
            // A parameter without influence has none on an instant either, however slowly its source passes zero.
            of_row.filter(|(_, by)| **by != 0.0).for_each(|(sum, by)| *sum += weight * by);
        }
        Found { value: self.value, time: self.time, by_parameters }
    }

    /// Value at an instant that does not matter to first order.
    fn at(curve: &Curve, time: f64) -> Self {
        Self { value: curve.value(time), time: Some(time), terms: curve.terms(time).collect() }
    }

    /// An instant, with its derivatives by those of its function that is zero then: −(∂y/∂p)/ẏ.
    fn instant(time: f64, terms: impl Iterator<Item = Term>, rate: f64) -> Self {
        let terms = terms.map(|term| Term { weight: -term.weight / rate, ..term });
        Self { value: time, time: Some(time), terms: terms.collect() }
    }

    /// An instant that nothing moves.
    fn fixed(time: f64) -> Self {
        Self { value: time, time: Some(time), terms: Vec::new() }
    }

    fn less(self, other: Self) -> Self {
        let Self { value, mut terms, .. } = self;
        let other = other.times(-1.0);
        terms.extend(other.terms);
        Self { value: value + other.value, time: None, terms }
    }

    fn times(self, factor: f64) -> Self {
        let terms = self.terms.into_iter().map(|term| Term { weight: factor * term.weight, ..term });
        let terms = if factor == 0.0 { Vec::new() } else { terms.collect() };
        Self { value: factor * self.value, time: self.time, terms }
    }
}

/// A reduced output of outputs in rows at these times, s; `series` has an output's rows. `None` if it has no
/// derivatives.
pub fn in_rows<'s>(
    own: &ReducedOutput,
    duration: f64,
    times: &'s [f64],
    series: impl Fn(usize) -> &'s [f64],
) -> Option<InRows> {
    of_reduced(own, duration, &|output, sign| Curve { times, values: series(output), output, sign })
}

/// The same for an accumulated quantity of an output.
pub fn accumulated_in_rows<'s>(channel: Channel, times: &'s [f64], series: &'s [f64]) -> Option<InRows> {
    let last = times.last().copied().unwrap_or(channel.to);
    let within = Channel { to: channel.to.min(last), ..channel };
    accumulated(within, &|sign| Curve { times, values: series, output: channel.output, sign })
}

/// A quantity that is accumulated from one time to another; `None` if it has no derivatives: for a path, and for an
/// instant that does not exist.
fn accumulated<'a>(channel: Channel, curve: &impl Fn(f64) -> Curve<'a>) -> Option<InRows> {
    let Channel { accumulation, from, to, .. } = channel;
    let extreme = |sign: f64| {
        let curve = curve(sign);
        InRows::at(&curve, curve.highest(from, to)).times(sign)
    };
    let integral = |of: fn(f64) -> [f64; 2]| {
        let (value, terms) = curve(1.0).integral(from, to, of);
        InRows { value, time: None, terms }
    };
    let when = |sign: f64| {
        let curve = curve(sign);
        let time = curve.highest(from, to);
        if time == from || time == to {
            return InRows::fixed(time);
        }
        let step = 1e-3 * (to - from) / curve.times.len() as f64;
        let before = InRows::at(&curve, time - step);
        let of_rate = InRows::at(&curve, time + step).less(before).times(0.5 / step).terms;
        InRows::instant(time, of_rate.into_iter(), curve.rates(time)[1])
    };
    let change = |is_first: bool| {
        let plain = curve(1.0);
        let ([first, last], [met_at_start, met_at_end]) = plain.changes(from, to);
        let time = match is_first {
            true if met_at_start => return Some(InRows::fixed(from)),
            false if met_at_end => return Some(InRows::fixed(to)),
            true => first?,
            false => last?,
        };
        Some(InRows::instant(time, plain.terms(time), plain.rates(time)[0]))
    };
    Some(match accumulation {
        Accumulation::Greatest => extreme(1.0),
        Accumulation::Least => extreme(-1.0),
        Accumulation::WhenGreatest => when(1.0),
        Accumulation::WhenLeast => when(-1.0),
        Accumulation::First => change(true)?,
        Accumulation::Last => change(false)?,
        Accumulation::Integral => integral(|value| [value, 1.0]),
        Accumulation::IntegralOfSquare => integral(|value| [value * value, 2.0 * value]),
        Accumulation::AtEnd => InRows::at(&curve(1.0), to),
        Accumulation::Zone { .. } => return None,
    })
}

/// `None` if a reduced output has no derivatives here.
fn of_reduced<'a>(own: &ReducedOutput, end: f64, curve: &impl Fn(usize, f64) -> Curve<'a>) -> Option<InRows> {
    let (from, to) = (own.from, own.to.min(end));
    let source = *own.outputs.first()?;
    let of =
        |accumulation| accumulated(Channel { output: source, accumulation, from, to }, &|sign| curve(source, sign));
    let [greatest, least] = [Accumulation::Greatest, Accumulation::Least].map(|extreme| move || of(extreme));
    Some(match own.kind {
        ReducedKind::Max => greatest()?,
        ReducedKind::Min => least()?,
        ReducedKind::Range => greatest()?.less(least()?),
        ReducedKind::MaxAbs => {
            let (above, below) = (greatest()?, least()?.times(-1.0));
            if above.value >= below.value { above } else { below }
        }
        ReducedKind::Value => of(Accumulation::AtEnd)?,
        ReducedKind::Mean => of(Accumulation::Integral)?.times(1.0 / (to - from)),
        ReducedKind::Integral => of(Accumulation::Integral)?,
        ReducedKind::Rms => {
            let squares = of(Accumulation::IntegralOfSquare)?;
            let value = (squares.value / (to - from)).sqrt();
            InRows { value, ..squares.times(0.5 / ((to - from) * value)) }
        }
        ReducedKind::TimeOfMax => of(Accumulation::WhenGreatest)?,
        ReducedKind::TimeOfMin => of(Accumulation::WhenLeast)?,
        ReducedKind::When => of(Accumulation::First)?,
        ReducedKind::LastWhen => of(Accumulation::Last)?,
        ReducedKind::Settling => {
            let ([_, last], [_, met_at_end]) = curve(source, 1.0).changes(from, to);
            match last {
                _ if met_at_end => return None,
                None => InRows::fixed(from),
                Some(_) => of(Accumulation::Last)?,
            }
        }
        ReducedKind::Overshoot => {
            let target = InRows::at(&curve(own.outputs.get(1).copied().unwrap_or(source), 1.0), to);
            let rises = curve(source, 1.0).value(from) <= target.value;
            let beyond = if rises { greatest()?.less(target) } else { target.less(least()?) };
            if beyond.value > 0.0 { beyond } else { beyond.times(0.0) }
        }
        ReducedKind::Straightness => return None,
    })
}

/// The least slack of a requirement on reduced outputs and parameters; `None` if one of those has no derivatives.
fn of_values(
    own: &Requirement,
    description: &Description,
    nominal: &[f64],
    reduced: &[ReducedGradients],
) -> Option<Found> {
    let of_slack = |slack: &Formula| {
        let read =
            description.reduced_in(slack).map(|(_, known)| reduced.iter().find(|found| found.name == known.name));
        let read: Vec<&ReducedGradients> = read.collect::<Option<_>>()?;
        let (names, numbers): (Vec<&str>, Vec<f64>) =
            read.iter().map(|found| (found.name.as_str(), found.value)).unzip();
        let formulas = NumberFormulas::of(&description.parameters, &names, std::slice::from_ref(slack));
        let value = formulas.values(nominal, &numbers)[0];
        let derivatives = formulas.derivatives(nominal, &numbers).swap_remove(0);
        let (by_numbers, by_parameters) = derivatives.split_at(numbers.len());
        let mut sum = by_parameters.to_vec();
        for (by_number, found) in by_numbers.iter().zip(read) {
            sum.iter_mut().zip(&found.by_parameters).for_each(|(sum, by)| *sum += by_number * by);
        }
        Some(Found { value, time: None, by_parameters: sum })
    };
    let slacks = own.slacks.iter().map(of_slack).collect::<Option<Vec<Found>>>()?;
    slacks.into_iter().min_by(|a, b| a.value.total_cmp(&b.value))
}

/// The least slack of a requirement from one time to another.
fn of_margin<'a>(own: &Requirement, from: f64, to: f64, curve: &impl Fn(usize, f64) -> Curve<'a>) -> Option<InRows> {
    let least = |&output: &usize| {
        let curve = curve(output, -1.0);
        let time = if from < to { curve.highest(from, to) } else { from };
        InRows::at(&curve, time).times(-1.0)
    };
    own.outputs.iter().map(least).min_by(|a, b| a.value.total_cmp(&b.value))
}
