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
use crate::simulate::Term;

/// A number a motion: its value, the instant that decides it, and its derivatives.
struct Found {
    value: f64,
    time: Option<f64>,
    by_parameters: Vec<f64>,
}

/// Derivatives of all reduced outputs and margins that are of the motion; `found` has their sources among its outputs.
pub(super) fn of_sources(description: &Description, found: &Gradients) -> Vec<ReducedGradients> {
    let Gradients { times, outputs, .. } = found;
    let nominal: Vec<f64> = found.parameters.iter().map(|parameter| parameter.value).collect();
    let curve = |output: usize, sign: f64| Curve { times, of: &outputs[output], sign };
    let reduced = description.reduced.iter().filter(|own| !own.of_results).filter_map(|own| {
        let found = of_reduced(own, description.simulation.duration, &curve)?;
        let display = description.display.get(&own.name).cloned();
        Some(found.named(own.name.clone(), own.unit.clone(), display, false))
    });
    let mut all: Vec<ReducedGradients> = reduced.collect();
    let margins = description.requirements.iter().filter(|own| !own.of_results).filter_map(|own| {
        let found = match own.times {
            Some((from, to)) => of_margin(own, from, to.min(description.simulation.duration), &curve),
            None => of_values(own, description, &nominal, &all),
        };
        Some(found?.named(own.name.clone(), own.unit.clone(), own.display.clone(), true))
    });
    let margins: Vec<ReducedGradients> = margins.collect();
    all.extend(margins);
    all
}

impl Found {
    fn named(self, name: String, unit: String, display: Option<DisplayUnit>, is_margin: bool) -> ReducedGradients {
        let Self { value, time, by_parameters } = self;
        ReducedGradients { name, unit, display, is_margin, value, time, by_parameters }
    }

    /// At an instant that does not matter to first order.
    fn at(curve: &Curve, time: f64) -> Self {
        Self { value: curve.value(time), time: Some(time), by_parameters: curve.by_parameters(time) }
    }

    /// An instant, with its derivatives by those of what is zero then: −(∂y/∂p)/ẏ.
    fn instant(time: f64, by_parameters: Vec<f64>, rate: f64) -> Self {
        let by_parameters = by_parameters.into_iter().map(|by| if by == 0.0 { 0.0 } else { -by / rate }).collect();
        Self { value: time, time: Some(time), by_parameters }
    }

    /// An instant that no parameter moves.
    fn fixed(time: f64, parameters: usize) -> Self {
        Self { value: time, time: Some(time), by_parameters: vec![0.0; parameters] }
    }

    fn less(self, other: Self) -> Self {
        let by_parameters = self.by_parameters.iter().zip(&other.by_parameters).map(|(a, b)| a - b).collect();
        Self { value: self.value - other.value, time: None, by_parameters }
    }

    fn times(self, factor: f64) -> Self {
        let by_parameters = self.by_parameters.iter().map(|by| factor * by).collect();
        Self { value: factor * self.value, by_parameters, ..self }
    }
}

/// A reduced output of a motion, with its derivatives by its sources in all rows.
pub struct InRows {
    /// Its value, SI.
    pub value: f64,
    /// The derivatives that are not zero.
    pub terms: Vec<Term>,
}

/// A reduced output of outputs in rows at these times, s, by its derivatives there; `series` has an output's rows.
/// `None` where it has none.
pub fn in_rows<'s>(
    own: &ReducedOutput,
    duration: f64,
    times: &[f64],
    series: impl Fn(usize) -> &'s [f64],
) -> Option<InRows> {
    let mut sources = own.outputs.clone();
    sources.dedup();
    let (rows, count) = (times.len(), times.len() * sources.len());
    let unit = |index: usize| {
        let mut by = vec![0.0; count];
        by[index] = 1.0;
        by
    };
    let of_source = |(number, output): (usize, &usize)| OutputGradients {
        name: String::new(),
        unit: String::new(),
        display: None,
        values: series(*output).to_vec(),
        by_parameters: (0..rows).map(|row| unit(number * rows + row)).collect(),
    };
    let of: Vec<OutputGradients> = sources.iter().enumerate().map(of_source).collect();
    let curve = |output: usize, sign: f64| {
        let number = sources.iter().position(|own| *own == output).unwrap_or(0);
        Curve { times, of: &of[number], sign }
    };
    let found = of_reduced(own, duration, &curve)?;
    let term = |(index, weight): (usize, f64)| Term { row: index % rows, output: sources[index / rows], weight };
    let terms = found.by_parameters.into_iter().enumerate().filter(|(_, weight)| *weight != 0.0).map(term).collect();
    Some(InRows { value: found.value, terms })
}

/// `None` where a reduced output has no derivatives here: a path's straightness, and an instant that is not there.
fn of_reduced<'a>(own: &ReducedOutput, end: f64, curve: &impl Fn(usize, f64) -> Curve<'a>) -> Option<Found> {
    let (from, to) = (own.from, own.to.min(end));
    let source = *own.outputs.first()?;
    let plain = curve(source, 1.0);
    let extreme = |sign: f64| {
        let curve = curve(source, sign);
        Found::at(&curve, curve.highest(from, to)).times(sign)
    };
    let parameters = plain.by_parameters(from).len();
    let mean = || {
        let all = plain.integral(from, to, |value, by| std::iter::once(value).chain(by.iter().copied()).collect());
        Found { value: all[0], time: None, by_parameters: all[1..].to_vec() }
    };
    Some(match own.kind {
        ReducedKind::Max => extreme(1.0),
        ReducedKind::Min => extreme(-1.0),
        ReducedKind::Range => extreme(1.0).less(extreme(-1.0)),
        ReducedKind::MaxAbs => {
            let (above, below) = (extreme(1.0), extreme(-1.0).times(-1.0));
            if above.value >= below.value { above } else { below }
        }
        ReducedKind::Value => Found::at(&plain, to),
        ReducedKind::Mean => mean().times(1.0 / (to - from)),
        ReducedKind::Integral => mean(),
        ReducedKind::Rms => {
            let of = |value: f64, by: &[f64]| {
                std::iter::once(value * value).chain(by.iter().map(|by| value * by)).collect::<Vec<f64>>()
            };
            let all = plain.integral(from, to, of);
            let value = (all[0] / (to - from)).sqrt();
            let by_parameters = all[1..].iter().map(|own| own / ((to - from) * value)).collect();
            Found { value, time: None, by_parameters }
        }
        ReducedKind::TimeOfMax | ReducedKind::TimeOfMin => {
            let curve = curve(source, if own.kind == ReducedKind::TimeOfMax { 1.0 } else { -1.0 });
            let time = curve.highest(from, to);
            if time == from || time == to {
                return Some(Found::fixed(time, parameters));
            }
            let step = 1e-3 * (to - from) / curve.times.len() as f64;
            let [before, after] = [-step, step].map(|shift| curve.by_parameters(time + shift));
            let of_rate = before.iter().zip(&after).map(|(before, after)| (after - before) / (2.0 * step)).collect();
            Found::instant(time, of_rate, curve.rates(time)[1])
        }
        ReducedKind::When | ReducedKind::LastWhen | ReducedKind::Settling => {
            let ([first, last], [met_at_start, met_at_end]) = plain.changes(from, to);
            let is_first = own.kind == ReducedKind::When;
            let time = match own.kind {
                ReducedKind::When if met_at_start => return Some(Found::fixed(from, parameters)),
                ReducedKind::LastWhen if met_at_end => return Some(Found::fixed(to, parameters)),
                ReducedKind::Settling if met_at_end => return None,
                ReducedKind::Settling if last.is_none() => return Some(Found::fixed(from, parameters)),
                _ if is_first => first?,
                _ => last?,
            };
            Found::instant(time, plain.by_parameters(time), plain.rates(time)[0])
        }
        ReducedKind::Overshoot => {
            let target = Found::at(&curve(own.outputs.get(1).copied().unwrap_or(source), 1.0), to);
            let rises = plain.value(from) <= target.value;
            let beyond = if rises { extreme(1.0).less(target) } else { target.less(extreme(-1.0)) };
            if beyond.value > 0.0 { beyond } else { beyond.times(0.0) }
        }
        ReducedKind::Straightness => return None,
    })
}

/// The least slack of a requirement on reduced outputs and parameters; `None` where one of those has no derivatives.
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
fn of_margin<'a>(own: &Requirement, from: f64, to: f64, curve: &impl Fn(usize, f64) -> Curve<'a>) -> Option<Found> {
    let least = |&output: &usize| {
        let curve = curve(output, -1.0);
        let time = if from < to { curve.highest(from, to) } else { from };
        Found::at(&curve, time).times(-1.0)
    };
    own.outputs.iter().map(least).min_by(|a, b| a.value.total_cmp(&b.value))
}
