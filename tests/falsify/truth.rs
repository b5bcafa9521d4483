//! The true range of an output: of every term over its own parameters, and of a formula of independent ranges.

use crate::draw::{Combine, Draw, Output, Term, Wrap};
use crate::search;

/// Least and greatest value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub lower: f64,
    pub upper: f64,
}

impl Range {
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        let [a, b] = [f(self.lower), f(self.upper)];
        Self { lower: a.min(b), upper: a.max(b) }
    }
}

/// Range of every output at every time. A higher level searches more densely.
pub fn ranges(draw: &Draw, times: &[f64], level: u32) -> Vec<Vec<Range>> {
    let needed = |term: usize, channel: usize| draw.outputs.iter().any(|own| own.inputs.contains(&(term, channel)));
    let of_term = |(index, term): (usize, &Term)| {
        if (0..term.channels.len()).any(|channel| needed(index, channel)) {
            search::ranges(term, times, level, &|channel| needed(index, channel))
        } else {
            Vec::new()
        }
    };
    let of_terms: Vec<Vec<Vec<Range>>> = draw.terms.iter().enumerate().map(of_term).collect();
    let of_output = |output: &Output| {
        let at = |row: usize| {
            let inputs = output.inputs.iter().map(|&(term, channel)| of_terms[term][channel][row]);
            wrapped(output.wrap, inputs.reduce(|a, b| combined(output.combine, a, b)).expect("an output has an input"))
        };
        (0..times.len()).map(at).collect()
    };
    draw.outputs.iter().map(of_output).collect()
}

/// The ranges are of different parameters, so that every pair of values occurs.
fn combined(combine: Combine, a: Range, b: Range) -> Range {
    let both = |f: fn(f64, f64) -> f64| Range { lower: f(a.lower, b.lower), upper: f(a.upper, b.upper) };
    match combine {
        Combine::Sum => both(|a, b| a + b),
        Combine::Max => both(f64::max),
        Combine::Min => both(f64::min),
        Combine::Product => {
            let corners = [a.lower * b.lower, a.lower * b.upper, a.upper * b.lower, a.upper * b.upper];
            Range {
                lower: corners.into_iter().fold(f64::INFINITY, f64::min),
                upper: corners.into_iter().fold(f64::NEG_INFINITY, f64::max),
            }
        }
    }
}

/// Range of a continuous function over an interval.
fn wrapped(wrap: Wrap, range: Range) -> Range {
    match wrap {
        Wrap::Nothing => range,
        Wrap::Above(c) => range.map(|x| x.max(c)),
        Wrap::Below(c) => range.map(|x| x.min(c)),
        Wrap::Abs => distance(range),
        Wrap::Distance(c) => distance(Range { lower: range.lower - c, upper: range.upper - c }),
        Wrap::Square => distance(range).map(|x| x * x),
        Wrap::Sine(b) => {
            use std::f64::consts::{FRAC_PI_2, TAU};
            let ends = range.map(|x| b * x);
            // Whether the sine is 1 somewhere at `peak` + 2πn.
            let reaches = |peak: f64| ((ends.lower - peak) / TAU).ceil() <= ((ends.upper - peak) / TAU).floor();
            let sines = range.map(|x| (b * x).sin());
            Range {
                lower: if reaches(-FRAC_PI_2) { -1.0 } else { sines.lower },
                upper: if reaches(FRAC_PI_2) { 1.0 } else { sines.upper },
            }
        }
    }
}

fn distance(range: Range) -> Range {
    let magnitude = range.map(f64::abs);
    if range.lower < 0.0 && range.upper > 0.0 { Range { lower: 0.0, ..magnitude } } else { magnitude }
}

/// Values of an output with nominal parameters: only to choose constants near them.
pub fn nominal(draw: &Draw, output: &Output, times: &[f64]) -> Vec<f64> {
    let curves: Vec<Vec<Vec<f64>>> = draw
        .terms
        .iter()
        .map(|term| {
            let values: Vec<f64> = term.seen().iter().map(|parameter| parameter.value).collect();
            (term.curves)(&values, times)
        })
        .collect();
    let at = |row: usize| {
        let point = |&(term, channel): &(usize, usize)| {
            let value = curves[term][channel][row];
            Range { lower: value, upper: value }
        };
        let range = output.inputs.iter().map(point).reduce(|a, b| combined(output.combine, a, b));
        range.expect("an output has an input").lower
    };
    (0..times.len()).map(at).collect()
}
