//! Channels of a motion, and how reduced outputs follow from them.
//!
//! A maximum over the time has a kink over the box where its instant jumps. The time is therefore cut between the local
//! extremes of the nominal motion: the extreme in each window is a channel of its own, which the surrogate expands, and
//! the maximum is the largest of the channels' polynomials, kinks included. The same holds for events: the windows lie
//! around the humps in which they can occur.

use std::sync::Arc;

use super::tuning::TUNING;
use super::values::{ChannelValues, Humps, Value};
use crate::assemble::NumberFormulas;
use crate::model::{Description, ReducedKind, ReducedOutput, Requirement};
use crate::simulate::{Accumulation, Channel};

/// Accumulated quantities, and the values that follow.
#[derive(Debug)]
pub struct ReductionPlan {
    /// Channels that the surrogate expands, then those that are only looked up.
    pub channels: Vec<Channel>,
    /// Number of those that the surrogate expands.
    pub expanded: usize,
    /// Reduced outputs and margins.
    pub values: Arc<ChannelValues>,
    /// For each requirement over the time, the channels with the instant and the value of each least slack.
    whens: Vec<Vec<(usize, usize)>>,
}

/// Makes channels.
struct Planner<'a> {
    channels: Vec<Channel>,
    /// Nominal course of an output in the rows, and their times.
    nominal: &'a dyn Fn(usize) -> Vec<f64>,
    times: &'a [f64],
}

impl ReductionPlan {
    /// The plan of a model whose formulas are among its outputs, given the nominal course of an output in rows at
    /// `times`.
    pub fn of(description: &Description, times: &[f64], nominal: &dyn Fn(usize) -> Vec<f64>) -> Self {
        let end = description.simulation.duration;
        let mut planner = Planner { channels: Vec::new(), nominal, times };
        let mut all: Vec<Value> = description.reduced.iter().map(|reduced| planner.reduced(reduced, end)).collect();
        let mut margins = Vec::with_capacity(description.requirements.len());
        for own in &description.requirements {
            let first = all.len();
            all.extend(planner.margin(description, own));
            margins.push(first..all.len());
        }
        let expanded = planner.channels.len();
        let when = |own: &Requirement| match own.times {
            Some((from, to)) if from < to => {
                let mut add = |index: usize, accumulation| planner.add(index, accumulation, (from, to));
                let of = |&index: &usize| (add(index, Accumulation::WhenLeast), add(index, Accumulation::Least));
                own.outputs.iter().map(of).collect()
            }
            _ => Vec::new(),
        };
        let whens = description.requirements.iter().map(when).collect();
        let values = Arc::new(ChannelValues { all, margins });
        Self { channels: planner.channels, expanded, values, whens }
    }

    /// Outputs that the values follow from, ascending.
    pub fn sources(&self) -> Vec<usize> {
        let mut sources: Vec<usize> = self.channels[..self.expanded].iter().map(|channel| channel.output).collect();
        sources.sort_unstable();
        sources.dedup();
        sources
    }

    /// Interval in which some channels accumulate, s.
    pub fn span(&self, channels: impl Iterator<Item = usize> + Clone) -> [f64; 2] {
        let all = channels.map(|channel| &self.channels[channel]);
        let from = all.clone().map(|channel| channel.from).fold(f64::INFINITY, f64::min);
        [from, all.map(|channel| channel.to).fold(f64::NEG_INFINITY, f64::max)]
    }

    /// When a requirement is nearest to failing in a motion; `None` without a time.
    pub fn when(&self, number: usize, own: &Requirement, channels: &[f64]) -> Option<f64> {
        let (from, to) = own.times?;
        if from == to {
            return Some(from);
        }
        let nearest = self.whens[number].iter().min_by(|a, b| channels[a.1].total_cmp(&channels[b.1]))?;
        Some(channels[nearest.0])
    }
}

impl Planner<'_> {
    fn add(&mut self, output: usize, accumulation: Accumulation, (from, to): (f64, f64)) -> usize {
        let channel = Channel { output, accumulation, from, to };
        // Two values may need the same.
        self.channels.iter().position(|known| *known == channel).unwrap_or_else(|| {
            self.channels.push(channel);
            self.channels.len() - 1
        })
    }

    /// A channel in each window.
    fn windowed(&mut self, output: usize, accumulation: Accumulation, windows: &[(f64, f64)]) -> Vec<usize> {
        windows.iter().map(|&window| self.add(output, accumulation, window)).collect()
    }

    fn extremes(&mut self, output: usize, sign: f64, span: (f64, f64)) -> Vec<usize> {
        let windows = self.windows(output, sign, span);
        let accumulation = if sign > 0.0 { Accumulation::Greatest } else { Accumulation::Least };
        self.windowed(output, accumulation, &windows)
    }

    fn humps(&mut self, output: usize, accumulation: Accumulation, span: (f64, f64)) -> Humps {
        let sign = if accumulation == Accumulation::WhenLeast { -1.0 } else { 1.0 };
        let windows = self.windows(output, sign, span);
        let height = if sign > 0.0 { Accumulation::Greatest } else { Accumulation::Least };
        Humps { heights: self.windowed(output, height, &windows), times: self.windowed(output, accumulation, &windows) }
    }

    fn reduced(&mut self, reduced: &ReducedOutput, end: f64) -> Value {
        let span = (reduced.from, reduced.to);
        let length = reduced.to.min(end) - reduced.from;
        let own = reduced.outputs[0];
        let at = |time: f64| (time, time);
        match reduced.kind {
            ReducedKind::Range => Value::Range(self.extremes(own, 1.0, span), self.extremes(own, -1.0, span)),
            ReducedKind::Max => Value::Greatest(self.extremes(own, 1.0, span)),
            ReducedKind::Min => Value::Least(self.extremes(own, -1.0, span)),
            ReducedKind::MaxAbs => Value::Magnitude(self.extremes(own, 1.0, span), self.extremes(own, -1.0, span)),
            ReducedKind::Value => Value::Mean(self.add(own, Accumulation::AtEnd, at(reduced.to)), 1.0),
            ReducedKind::Mean => Value::Mean(self.add(own, Accumulation::Integral, span), length),
            ReducedKind::Integral => Value::Mean(self.add(own, Accumulation::Integral, span), 1.0),
            ReducedKind::Rms => Value::Rms(self.add(own, Accumulation::IntegralOfSquare, span), length),
            ReducedKind::TimeOfMax => Value::TimeOf(self.humps(own, Accumulation::WhenGreatest, span), 1.0),
            ReducedKind::TimeOfMin => Value::TimeOf(self.humps(own, Accumulation::WhenLeast, span), -1.0),
            ReducedKind::When => Value::First(self.humps(own, Accumulation::First, span)),
            ReducedKind::LastWhen => Value::Last(self.humps(own, Accumulation::Last, span)),
            ReducedKind::Settling => {
                Value::Settling(self.humps(own, Accumulation::Last, span), reduced.from, reduced.to.min(end))
            }
            ReducedKind::Overshoot => {
                let target = reduced.outputs.get(1).copied().unwrap_or(own);
                Value::Overshoot {
                    greatest: self.extremes(own, 1.0, span),
                    least: self.extremes(own, -1.0, span),
                    start: self.add(own, Accumulation::AtEnd, at(reduced.from)),
                    target: self.add(target, Accumulation::AtEnd, at(reduced.to)),
                }
            }
            ReducedKind::Straightness => {
                let path = Accumulation::Zone { abscissa: own };
                Value::Mean(self.add(reduced.outputs[1], path, span), 1.0)
            }
        }
    }

    /// Values whose least is the margin.
    fn margin(&mut self, description: &Description, own: &Requirement) -> Vec<Value> {
        let channels = match own.times {
            Some((from, to)) if from == to => self.windowed_at(&own.outputs, from),
            Some(span) => own.outputs.iter().flat_map(|&place| self.extremes(place, -1.0, span)).collect(),
            None => {
                let formula = |slack: &symdiff::Formula| {
                    let (reduced, names): (Vec<usize>, Vec<&str>) =
                        description.reduced_in(slack).map(|(index, own)| (index, own.name.as_str())).unzip();
                    let formulas = NumberFormulas::of(&description.parameters, &names, std::slice::from_ref(slack));
                    Value::Formulas { formulas: Box::new(formulas), reduced }
                };
                return own.slacks.iter().map(formula).collect();
            }
        };
        channels.into_iter().map(|channel| Value::Least(vec![channel])).collect()
    }

    fn windowed_at(&mut self, places: &[usize], at: f64) -> Vec<usize> {
        places.iter().map(|&index| self.add(index, Accumulation::AtEnd, (at, at))).collect()
    }

    /// The time cut at the dips between the humps of the nominal course times `sign`.
    fn windows(&self, output: usize, sign: f64, (from, to): (f64, f64)) -> Vec<(f64, f64)> {
        let rows: Vec<usize> = (0..self.times.len()).filter(|&row| (from..=to).contains(&self.times[row])).collect();
        let all = (self.nominal)(output);
        let value = |index: usize| sign * all[rows[index]];
        let (low, high) = (0..rows.len())
            .map(value)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        // A dip with its depth below the lower one of the humps next to it.
        let mut dips: Vec<(usize, f64)> = Vec::new();
        for index in 1..rows.len().saturating_sub(1) {
            if value(index) < value(index - 1) && value(index) <= value(index + 1) {
                dips.push((index, 0.0));
            }
        }
        loop {
            let edges: Vec<usize> =
                [0].into_iter().chain(dips.iter().map(|dip| dip.0)).chain([rows.len().saturating_sub(1)]).collect();
            let tops: Vec<f64> =
                edges.windows(2).map(|pair| (pair[0]..=pair[1]).map(value).fold(f64::NEG_INFINITY, f64::max)).collect();
            for (number, dip) in dips.iter_mut().enumerate() {
                dip.1 = tops[number].min(tops[number + 1]) - value(dip.0);
            }
            let shallowest = (0..dips.len()).min_by(|&a, &b| dips[a].1.total_cmp(&dips[b].1));
            match shallowest {
                Some(number) if dips[number].1 < TUNING.deep * (high - low) || dips.len() >= TUNING.most_windows => {
                    dips.remove(number)
                }
                _ => break,
            };
        }
        let cuts = dips.iter().map(|&(index, _)| self.times[rows[index]]);
        let edges: Vec<f64> = [from].into_iter().chain(cuts).chain([to]).collect();
        edges.windows(2).map(|pair| (pair[0], pair[1])).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_is_cut_between_the_highest_humps() {
        let times: Vec<f64> = (0..=400).map(|row| 0.05 * f64::from(row)).collect();
        let course =
            |frequency: f64| times.iter().map(|time| symdiff::math::cos(frequency * time)).collect::<Vec<f64>>();
        let windows = |frequency: f64| {
            let nominal = |_| course(frequency);
            Planner { channels: vec![], nominal: &nominal, times: &times }.windows(0, 1.0, (0.0, f64::INFINITY))
        };
        let found = windows(1.0);
        // Dips at π, 3π and 5π.
        assert_eq!(found.len(), 4);
        assert!((found[0].1 - std::f64::consts::PI).abs() < 0.05 && found[3].1.is_infinite());
        assert_eq!(windows(5.0).len(), TUNING.most_windows);
        assert_eq!(windows(0.1), [(0.0, f64::INFINITY)]);
    }
}
