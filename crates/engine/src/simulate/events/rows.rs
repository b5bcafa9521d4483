//! Rows of samples in segments between events.

use super::tile::SegmentTile;
use crate::simulate::control::{Schedule, Steps};
use crate::simulate::drive::{
    Accumulator, Channel, Motion, Observed, RowState, RowTile, Stop, forget_lost, lost_lanes,
};
use crate::simulate::ensemble::RowClosure;
use crate::simulate::explicit::tuning::TUNING as EXPLICIT;
use crate::simulate::interruption::StepInterruption;
use crate::simulate::simulator::Simulator;
use crate::simulate::step::Counters;

/// A tile, and its rows.
#[derive(Debug)]
pub(in crate::simulate) struct SegmentRows<'s> {
    pub(super) tile: SegmentTile<'s>,
    rows: RowClosure<'s>,
    alive: Vec<bool>,
    /// The state at the row.
    at_row: Vec<f64>,
    /// The first row behind the first event that others do not meet.
    deviates: Option<usize>,
    /// Reductions of outputs to one number, by lane: each lane has steps of its own.
    reduced: Vec<Reduced<'s>>,
    /// Segments that are reduced.
    segments: usize,
    /// Number of outputs.
    outputs: usize,
}

/// The reduction of a lane's outputs, and the time up to which they are, s.
#[derive(Debug)]
struct Reduced<'s> {
    reduction: Accumulator<'s>,
    time: f64,
}

impl<'s> SegmentRows<'s> {
    /// Rows at the start.
    pub(super) fn new(tile: SegmentTile<'s>, rows: RowClosure<'s>) -> Self {
        let (width, lines) = (tile.width(), tile.lines());
        Self {
            tile,
            rows,
            alive: vec![true; width],
            at_row: vec![0.0; width * lines],
            deviates: None,
            reduced: Vec::new(),
            segments: 0,
            outputs: 0,
        }
    }

    /// Reduces outputs over the segments that were passed since the last call, up to the end of the rows.
    fn accumulate(&mut self, end: f64) {
        let Some(word) = self.tile.word.filter(|_| !self.reduced.is_empty()) else { return };
        let (width, lines) = (self.tile.width(), self.tile.lines());
        let mut state = vec![0.0; lines * width];
        let mut own = vec![0.0; lines];
        let mut outputs = vec![0.0; self.outputs * width];
        while let Some(recorded) = self.tile.recorded.iter().find(|recorded| recorded.number == self.segments) {
            let steps = &word.steps[recorded.number];
            let begins = std::iter::once(0.0).chain(steps.iter().copied());
            let of_step = |(begin, end): (f64, f64)| {
                (0..=EXPLICIT.places_of_reduced)
                    .map(move |part| begin + (end - begin) * part as f64 / EXPLICIT.places_of_reduced as f64)
            };
            for share in begins.zip(steps.iter().copied()).flat_map(of_step) {
                for lane in 0..width {
                    let time = (recorded.begin[lane] + share * recorded.length[lane]).min(end);
                    self.rows.times_mut()[lane] = time;
                    recorded.interpolate(steps, lane, width, time, &mut own);
                    state.iter_mut().skip(lane).step_by(width).zip(&own).for_each(|(value, own)| *value = *own);
                }
                self.rows.close_at_times(&mut state);
                self.rows.observe(&mut outputs);
                let times = self.rows.times_mut().to_vec();
                for ((lane, reduced), time) in self.reduced.iter_mut().enumerate().zip(times) {
                    // The end of one step is the beginning of the next, and nothing is behind the end.
                    if time > reduced.time {
                        let mut values = reduced.reduction.buffer();
                        values
                            .iter_mut()
                            .zip(outputs.iter().skip(lane).step_by(width))
                            .for_each(|(own, value)| *own = *value);
                        reduced.reduction.push(time, values, &[true]);
                        reduced.time = time;
                    }
                }
            }
            self.segments += 1;
        }
    }
}

impl<'s> RowTile<'s> for SegmentRows<'s> {
    type Plan<'p> = &'p Schedule;

    fn plan<'p>(_: &Simulator, steps: Steps<'p>) -> &'p Schedule {
        steps.schedule
    }

    fn width(&self) -> usize {
        self.tile.width()
    }

    fn samples(&self) -> Vec<usize> {
        self.tile.samples.clone()
    }

    fn reach(&mut self, schedule: &&Schedule, row: usize, asked: &mut StepInterruption<'s>) -> Vec<Stop> {
        if asked.ends_now() {
            return Vec::new();
        }
        let time = schedule.time(row);
        if self.tile.deviates.is_some_and(|from| from <= time) {
            self.deviates.get_or_insert(row);
        }
        self.tile.reach(time, &mut self.at_row);
        self.accumulate(schedule.end());
        self.tile.forget_before(time);
        self.rows.close(time, &mut self.at_row);
        lost_lanes(&mut self.alive, self.tile.samples.len(), &self.at_row, row, time)
    }

    fn record(&mut self, observed: Observed, into: &mut [f64]) {
        self.rows.record(observed, &self.at_row, into);
        forget_lost(&self.alive, into);
    }

    /// Nothing is reduced for samples that spell no word.
    fn reduce(&mut self, channels: &'s [Channel], outputs: usize) {
        let start = |_| Reduced { reduction: Accumulator::new(channels, outputs, 1), time: f64::NEG_INFINITY };
        self.reduced = self.tile.samples.iter().map(start).collect();
        self.outputs = outputs;
    }

    fn reduced(&mut self) -> Vec<f64> {
        let (width, is_known) = (self.tile.width(), self.tile.deviates.is_none());
        let mut values = Vec::new();
        for (lane, reduced) in self.reduced.iter_mut().enumerate() {
            let found = reduced.reduction.finish();
            values.resize(found.len() * width, f64::NAN);
            for (channel, value) in found.into_iter().enumerate().filter(|_| is_known) {
                values[channel * width + lane] = value;
            }
        }
        values
    }

    fn counters(&self) -> Counters {
        self.tile.counters()
    }

    /// The first row behind an event that some sample meets and others do not.
    fn beyond_tolerance_from(&self) -> Option<usize> {
        self.deviates
    }
}
