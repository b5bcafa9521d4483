//! Reduced outputs and margins of requirements as functions of channels and parameters.

use std::ops::Range;

use crate::assemble::NumberFormulas;

/// Values that follow from channels.
#[derive(Clone, Debug, Default)]
pub struct Values {
    /// Reduced outputs, then parts of the requirements' margins. A value may read reduced outputs before it.
    pub(super) all: Vec<Value>,
    /// For each requirement, which values are parts of its margin: it is the least of them. Each part is bounded alone,
    /// so that the kinks between them do no harm.
    pub(super) margins: Vec<Range<usize>>,
}

/// Some of the values, which read some of the channels.
pub struct Selection {
    /// The values, of the selected channels.
    pub values: Values,
    /// Index of each among all values.
    pub of: Vec<usize>,
    /// Index of each selected channel among all channels, ascending.
    pub channels: Vec<usize>,
}

/// The extremes of an output in each window: value and time.
#[derive(Clone, Debug)]
pub(super) struct Humps {
    pub heights: Vec<usize>,
    pub times: Vec<usize>,
}

/// How a value follows from channels.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Greatest(Vec<usize>),
    Least(Vec<usize>),
    /// Greatest less least.
    Range(Vec<usize>, Vec<usize>),
    Magnitude(Vec<usize>, Vec<usize>),
    /// A channel over a length of time.
    Mean(usize, f64),
    Rms(usize, f64),
    /// The time in the window with the largest height times the sign.
    TimeOf(Humps, f64),
    First(Humps),
    Last(Humps),
    /// The same, from the beginning where there is none, unknown where it lasts to the end.
    Settling(Humps, f64, f64),
    Overshoot {
        greatest: Vec<usize>,
        least: Vec<usize>,
        start: usize,
        target: usize,
    },
    /// The least of formulas of parameters and of some reduced outputs.
    Formulas {
        formulas: Box<NumberFormulas>,
        reduced: Vec<usize>,
    },
}

impl Values {
    /// Number of values.
    pub fn count(&self) -> usize {
        self.all.len()
    }

    /// Whether a value is made of the largest or the least of some channels.
    pub fn is_extreme(&self, value: usize) -> bool {
        matches!(self.all[value], Value::Greatest(_) | Value::Least(_) | Value::Range(..) | Value::Magnitude(..))
    }

    /// The formula of a value that is a slack of parameters and reduced outputs, and the indices of these.
    pub fn slack(&self, value: usize) -> Option<(&NumberFormulas, &[usize])> {
        match &self.all[value] {
            Value::Formulas { formulas, reduced } => Some((&**formulas, reduced.as_slice())),
            _ => None,
        }
    }

    /// Which values are parts of a requirement's margin.
    pub fn parts(&self, requirement: usize) -> Range<usize> {
        self.margins[requirement].clone()
    }

    /// A requirement's margin, given all values; NaN where a part is unknown.
    pub fn margin(&self, requirement: usize, value: impl Fn(usize) -> f64) -> f64 {
        self.parts(requirement).map(value).fold(f64::INFINITY, |a, b| if b < a || b.is_nan() { b } else { a })
    }

    /// All values of a motion with these channels and parameters.
    pub fn evaluate(&self, channels: &[f64], parameters: &[f64], into: &mut Vec<f64>) {
        into.clear();
        for value in &self.all {
            let found = value.of(channels, parameters, into);
            into.push(found);
        }
    }

    /// The margins of some requirements alone.
    pub fn only(&self, requirements: &[usize]) -> Selection {
        let parts = requirements.iter().flat_map(|&requirement| self.parts(requirement));
        let mut reduced: Vec<usize> = parts.clone().flat_map(|part| self.all[part].reduced().iter().copied()).collect();
        reduced.sort_unstable();
        reduced.dedup();
        let mut all: Vec<Value> =
            reduced.iter().copied().chain(parts.clone()).map(|own| self.all[own].clone()).collect();
        let mut channels: Vec<usize> = all.iter_mut().flat_map(Value::channels).map(|channel| *channel).collect();
        channels.sort_unstable();
        channels.dedup();
        for value in &mut all {
            if let Value::Formulas { reduced: own, .. } = value {
                own.iter_mut().for_each(|value| *value = index_in(&reduced, *value));
            }
            value.channels().into_iter().for_each(|channel| *channel = index_in(&channels, *channel));
        }
        let mut next = reduced.len();
        let mut margin = |&requirement: &usize| {
            let first = next;
            next += self.parts(requirement).len();
            first..next
        };
        let margins = requirements.iter().map(&mut margin).collect();
        let of = reduced.iter().copied().chain(parts).collect();
        Selection { values: Self { all, margins }, of, channels }
    }
}

/// Index of a number in an ascending list that has it.
fn index_in(list: &[usize], number: usize) -> usize {
    list.partition_point(|&own| own < number)
}

impl Value {
    /// The channels that it reads.
    fn channels(&mut self) -> Vec<&mut usize> {
        match self {
            Self::Greatest(own) | Self::Least(own) => own.iter_mut().collect(),
            Self::Range(above, below) | Self::Magnitude(above, below) => above.iter_mut().chain(below).collect(),
            Self::Mean(own, _) | Self::Rms(own, _) => vec![own],
            Self::TimeOf(humps, _) | Self::First(humps) | Self::Last(humps) | Self::Settling(humps, ..) => {
                humps.channels().collect()
            }
            Self::Overshoot { greatest, least, start, target } => {
                greatest.iter_mut().chain(least).chain([start, target]).collect()
            }
            Self::Formulas { .. } => Vec::new(),
        }
    }

    /// The reduced outputs that it reads.
    fn reduced(&self) -> &[usize] {
        if let Self::Formulas { reduced, .. } = self { reduced } else { &[] }
    }

    /// The value, given the values before it.
    fn of(&self, channels: &[f64], parameters: &[f64], before: &[f64]) -> f64 {
        // NaN is passed on.
        let larger = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
        let greatest = |places: &[usize]| places.iter().map(|&index| channels[index]).fold(f64::NEG_INFINITY, larger);
        let least_of = |values: &mut dyn Iterator<Item = f64>| -values.fold(f64::NEG_INFINITY, |a, b| larger(a, -b));
        let least = |places: &[usize]| least_of(&mut places.iter().map(|&index| channels[index]));
        match self {
            Self::Greatest(places) => greatest(places),
            Self::Least(places) => least(places),
            Self::Range(above, below) => greatest(above) - least(below),
            Self::Magnitude(above, below) => larger(greatest(above), -least(below)),
            Self::Mean(index, length) => channels[*index] / length,
            // A polynomial may be below zero where a square is not.
            Self::Rms(index, length) => (channels[*index] / length).max(0.0).sqrt(),
            Self::TimeOf(humps, sign) => {
                let height = |window: usize| sign * channels[humps.heights[window]];
                let best = (0..humps.heights.len()).fold(0, |a, b| if height(b) > height(a) { b } else { a });
                channels[humps.times[best]]
            }
            Self::First(humps) => humps.occurring(channels).next().unwrap_or(f64::NAN),
            Self::Last(humps) => humps.occurring(channels).last().unwrap_or(f64::NAN),
            Self::Settling(humps, from, end) => match humps.occurring(channels).last() {
                None => *from,
                Some(last) if last >= *end => f64::NAN,
                Some(last) => last,
            },
            Self::Overshoot { greatest: above, least: below, start, target } => {
                let (start, target) = (channels[*start], channels[*target]);
                let beyond = if start <= target { greatest(above) - target } else { target - least(below) };
                larger(0.0, beyond)
            }
            Self::Formulas { formulas, reduced } => {
                let known: Vec<f64> = reduced.iter().map(|&value| before[value]).collect();
                least_of(&mut formulas.values(parameters, &known).into_iter())
            }
        }
    }
}

impl Humps {
    fn channels(&mut self) -> impl Iterator<Item = &mut usize> {
        self.heights.iter_mut().chain(&mut self.times)
    }

    /// Times of the windows in which the event occurs.
    fn occurring(&self, channels: &[f64]) -> impl Iterator<Item = f64> {
        // NaN occurs, and is passed on.
        let occurs = |&(height, _): &(&usize, &usize)| channels[*height] >= 0.0 || channels[*height].is_nan();
        self.heights.iter().zip(&self.times).filter(occurs).map(|(_, &time)| channels[time])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_event_that_does_not_occur_is_unknown() {
        let humps = || Humps { heights: vec![0, 1], times: vec![2, 3] };
        assert_eq!(Value::First(humps()).of(&[-0.1, 0.2, 1.0, 2.0], &[], &[]), 2.0);
        assert_eq!(Value::Last(humps()).of(&[0.1, -0.2, 1.0, 2.0], &[], &[]), 1.0);
        assert!(Value::First(humps()).of(&[-0.1, -0.2, 1.0, 2.0], &[], &[]).is_nan());
        assert_eq!(Value::Settling(humps(), 0.5, 9.0).of(&[-0.1, -0.2, 1.0, 2.0], &[], &[]), 0.5);
        assert_eq!(Value::TimeOf(humps(), 1.0).of(&[0.3, 0.2, 1.0, 2.0], &[], &[]), 1.0);
    }

    #[test]
    fn a_selection_has_the_values_of_all() {
        let all = vec![
            Value::Greatest(vec![0, 3]),
            Value::Range(vec![1, 4], vec![2]),
            Value::Least(vec![4]),
            Value::Overshoot { greatest: vec![5], least: vec![1], start: 0, target: 3 },
            Value::TimeOf(Humps { heights: vec![1, 2], times: vec![6, 5] }, -1.0),
        ];
        let values = Values { all, margins: vec![1..3, 3..4, 4..5] };
        let channels = [0.3, -0.2, 0.1, 0.7, -0.6, 0.9, 0.4];
        let mut found = Vec::new();
        values.evaluate(&channels, &[], &mut found);
        for requirements in [vec![0], vec![1, 2], vec![2, 0]] {
            let part = values.only(&requirements);
            let own: Vec<f64> = part.channels.iter().map(|&channel| channels[channel]).collect();
            let mut selected = Vec::new();
            part.values.evaluate(&own, &[], &mut selected);
            assert_eq!(selected, part.of.iter().map(|&value| found[value]).collect::<Vec<_>>());
            for (index, &requirement) in requirements.iter().enumerate() {
                let margin = values.margin(requirement, |value| found[value]);
                assert_eq!(part.values.margin(index, |value| selected[value]), margin);
            }
        }
        assert_eq!(values.only(&[0]).channels, [1, 2, 4]);
    }
}
