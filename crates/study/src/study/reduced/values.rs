//! Reduced outputs and margins of requirements as functions of channels and parameters.

use std::ops::Range;

use crate::assemble::NumberFormulas;

/// Values that follow from channels.
#[derive(Clone, Debug, Default)]
pub struct ChannelValues {
    /// Reduced outputs, then parts of the requirements' margins. A value may read reduced outputs before it.
    pub(super) all: Vec<Value>,
    /// For each requirement, the values that are parts of its margin: it is the least of them. Each part is bounded
    /// alone, so that the kinks between them do no harm.
    pub(super) margins: Vec<Range<usize>>,
}

/// Some of the values, which read some of the channels.
pub struct Selection {
    /// The values, of the selected channels.
    pub values: ChannelValues,
    /// Index of each among all values.
    pub of: Vec<usize>,
    /// Index of each selected channel among all channels, ascending.
    pub channels: Vec<usize>,
}

/// Derivatives of a value.
pub struct ValueSlope {
    /// By channels, those that count.
    pub by_channels: Vec<(usize, f64)>,
    /// By all parameters; empty if they count through channels alone.
    pub by_parameters: Vec<f64>,
}

/// The extremes of an output in each window: value and time.
#[derive(Clone, Debug)]
pub(super) struct Humps {
    pub heights: Vec<usize>,
    pub times: Vec<usize>,
}

/// Formula of a value in terms of channels.
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
    /// The last instant outside the band: the beginning if there is none, unknown if it lasts to the end.
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

impl ChannelValues {
    /// Number of values.
    pub fn count(&self) -> usize {
        self.all.len()
    }

    /// Whether a value is made of the largest or the least of some channels.
    pub fn is_extreme(&self, value: usize) -> bool {
        matches!(self.all[value], Value::Greatest(_) | Value::Least(_) | Value::Range(..) | Value::Magnitude(..))
    }

    /// The humps in which a value's event may occur, and whether it is the last of these: of instants alone.
    pub(super) fn event(&self, value: usize) -> Option<(&Humps, bool)> {
        match &self.all[value] {
            Value::First(humps) => Some((humps, false)),
            Value::Last(humps) => Some((humps, true)),
            _ => None,
        }
    }

    /// The formula of a value that is a slack of parameters and reduced outputs, and the indices of these.
    pub fn slack(&self, value: usize) -> Option<(&NumberFormulas, &[usize])> {
        match &self.all[value] {
            Value::Formulas { formulas, reduced } => Some((&**formulas, reduced.as_slice())),
            _ => None,
        }
    }

    /// Values that are parts of a requirement's margin.
    pub fn parts(&self, requirement: usize) -> Range<usize> {
        self.margins[requirement].clone()
    }

    /// A requirement's margin, given all values; NaN if a part is unknown.
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

    /// Derivatives of a value of a motion with these channels, parameters and values.
    pub fn slope(&self, value: usize, channels: &[f64], parameters: &[f64], values: &[f64]) -> ValueSlope {
        let Value::Formulas { formulas, reduced } = &self.all[value] else {
            return ValueSlope {
                by_channels: self.all[value].slope(channels, values[value]),
                by_parameters: Vec::new(),
            };
        };
        let numbers: Vec<f64> = reduced.iter().map(|&own| values[own]).collect();
        let of_formulas = formulas.values(parameters, &numbers);
        let least = (0..of_formulas.len()).min_by(|&a, &b| of_formulas[a].total_cmp(&of_formulas[b]));
        let derivatives = least.map(|least| formulas.derivatives(parameters, &numbers).swap_remove(least));
        let derivatives = derivatives.unwrap_or_default();
        let (by_numbers, by_parameters) = derivatives.split_at(numbers.len().min(derivatives.len()));
        let of_number = |(&own, &factor): (&usize, &f64)| {
            let inner = self.all[own].slope(channels, values[own]).into_iter();
            inner.map(move |(channel, by)| (channel, factor * by))
        };
        let by_channels = reduced.iter().zip(by_numbers).flat_map(of_number).collect();
        ValueSlope { by_channels, by_parameters: by_parameters.to_vec() }
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
            Self::TimeOf(humps, sign) => channels[humps.highest(channels, *sign)],
            Self::First(humps) => humps.occurring(channels).next().map_or(f64::NAN, |time| channels[time]),
            Self::Last(humps) => humps.occurring(channels).last().map_or(f64::NAN, |time| channels[time]),
            Self::Settling(humps, from, end) => match humps.occurring(channels).last().map(|time| channels[time]) {
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

impl Value {
    /// Derivatives by channels, given the value itself; of formulas there are none.
    fn slope(&self, channels: &[f64], value: f64) -> Vec<(usize, f64)> {
        let most = |places: &[usize], sign: f64| {
            let size = |index: &&usize| sign * channels[**index];
            places.iter().max_by(|a, b| size(a).total_cmp(&size(b))).map(|&index| (index, 1.0))
        };
        let less = |one: Option<(usize, f64)>| one.map(|(index, by)| (index, -by));
        let both = |a: Option<(usize, f64)>, b| a.into_iter().chain(b).collect();
        match self {
            Self::Greatest(places) => both(most(places, 1.0), None),
            Self::Least(places) => both(most(places, -1.0), None),
            Self::Range(above, below) => both(most(above, 1.0), less(most(below, -1.0))),
            Self::Magnitude(above, below) => {
                let above = most(above, 1.0).filter(|(index, _)| channels[*index] >= value);
                both(above.or_else(|| less(most(below, -1.0))), None)
            }
            Self::Mean(index, length) => vec![(*index, 1.0 / length)],
            Self::Rms(index, length) => vec![(*index, 0.5 / (length * value))],
            Self::TimeOf(humps, sign) => vec![(humps.highest(channels, *sign), 1.0)],
            Self::First(humps) => both(humps.occurring(channels).next().map(|time| (time, 1.0)), None),
            Self::Last(humps) | Self::Settling(humps, ..) => {
                both(humps.occurring(channels).last().map(|time| (time, 1.0)), None)
            }
            Self::Overshoot { greatest, least, start, target } => match value > 0.0 {
                true if channels[*start] <= channels[*target] => both(most(greatest, 1.0), Some((*target, -1.0))),
                true => both(less(most(least, -1.0)), Some((*target, 1.0))),
                false => Vec::new(),
            },
            Self::Formulas { .. } => Vec::new(),
        }
    }
}

impl Humps {
    /// The channel with the time of the largest height times the sign.
    fn highest(&self, channels: &[f64], sign: f64) -> usize {
        let height = |window: usize| sign * channels[self.heights[window]];
        let best = (0..self.heights.len()).fold(0, |a, b| if height(b) > height(a) { b } else { a });
        self.times[best]
    }

    fn channels(&mut self) -> impl Iterator<Item = &mut usize> {
        self.heights.iter_mut().chain(&mut self.times)
    }

    /// The channels with the times of the windows in which the event occurs.
    fn occurring(&self, channels: &[f64]) -> impl Iterator<Item = usize> {
        // NaN occurs, and is passed on.
        let occurs = |&(height, _): &(&usize, &usize)| channels[*height] >= 0.0 || channels[*height].is_nan();
        self.heights.iter().zip(&self.times).filter(occurs).map(|(_, &time)| time)
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

    /// Central differences of the values themselves.
    #[test]
    fn slopes_match_central_differences() {
        let humps = Humps { heights: vec![0, 1], times: vec![6, 5] };
        let all = vec![
            Value::Greatest(vec![0, 3]),
            Value::Least(vec![4, 2]),
            Value::Range(vec![1, 4], vec![2]),
            Value::Magnitude(vec![0], vec![4]),
            Value::Magnitude(vec![3], vec![4]),
            Value::Mean(2, 1.6),
            Value::Rms(3, 0.4),
            Value::TimeOf(humps.clone(), 1.0),
            Value::First(humps.clone()),
            Value::Last(humps.clone()),
            Value::Settling(humps, 0.0, 9.0),
            Value::Overshoot { greatest: vec![5], least: vec![1], start: 0, target: 3 },
            Value::Overshoot { greatest: vec![5], least: vec![4], start: 3, target: 0 },
            Value::Overshoot { greatest: vec![0], least: vec![1], start: 0, target: 3 },
        ];
        let count = all.len();
        let values = ChannelValues { all, margins: Vec::new() };
        let channels = [0.3, -0.2, 0.1, 0.7, -0.6, 0.9, 0.4];
        let of = |channels: &[f64]| {
            let mut found = Vec::new();
            values.evaluate(channels, &[], &mut found);
            found
        };
        let found = of(&channels);
        let mut by_channels = vec![[0.0; 7]; count];
        for (value, sums) in by_channels.iter_mut().enumerate() {
            let slope = values.slope(value, &channels, &[], &found);
            slope.by_channels.into_iter().for_each(|(channel, by)| sums[channel] += by);
        }
        for channel in 0..channels.len() {
            let moved = |by: f64| {
                let mut moved = channels;
                moved[channel] += by;
                of(&moved)
            };
            let [above, below] = [moved(1e-6), moved(-1e-6)];
            for value in 0..count {
                let difference = (above[value] - below[value]) / 2e-6;
                let by = by_channels[value][channel];
                assert!((difference - by).abs() < 1e-6, "value {value} by channel {channel}: {by}, not {difference}");
            }
        }
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
        let values = ChannelValues { all, margins: vec![1..3, 3..4, 4..5] };
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
