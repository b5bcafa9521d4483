//! A tile of samples in segments: lanes of the same events in lockstep, each with steps of its own length, and lanes
//! that meet others alone.
//!
//! A segment's length is each lane's own unknown. A motion of the lane alone finds its events and guesses the lengths;
//! Newton's method on the switch's value and rate at the segment's end, with the steps that all samples share, solves
//! them to rounding. So instants, and the states there, are as smooth functions of the parameters as the steps are.

use std::collections::VecDeque;

use super::path::{BEYOND, CORRECTIONS, LOCATED, Path, PathStep, ROUNDED};
use super::segments::Segments;
use super::stretched::Stretched;
use crate::compile::SwitchProgram;
use crate::numerics::{STEP_NODES, Sample, step_nodes, step_weights};
use crate::simulate::control::SwitchWatch;
use crate::simulate::ensemble::RowClosure;
use crate::simulate::error::SimulationError;
use crate::simulate::explicit::runge_kutta::RungeKutta;
use crate::simulate::simulator::Simulator;

/// A segment of all lanes.
#[derive(Debug)]
pub(super) struct Recorded {
    number: usize,
    /// When it begins and how long it is, s; lane by lane.
    pub begin: Vec<f64>,
    pub length: Vec<f64>,
    /// Positions and velocities (2n lines, lane by lane) at the nodes of its steps, which share those at their ends.
    pub nodes: Vec<Vec<f64>>,
}

/// A lane that goes on alone.
#[derive(Debug)]
struct Alone<'s> {
    path: Path<'s>,
    /// The step that was taken last, from which it has not gone on yet.
    step: Option<PathStep>,
    lost: bool,
}

/// Samples on their way.
#[derive(Debug)]
pub(super) struct SegmentTile<'s> {
    segments: &'s Segments,
    duration: f64,
    motion: Stretched<'s>,
    watch: SwitchWatch<'s>,
    /// At the beginning of the next segment.
    state: Vec<f64>,
    next: usize,
    /// Lengths of all segments of each lane as the lane alone finds them, s.
    guesses: Vec<Vec<f64>>,
    /// Segments that rows may lie in.
    pub recorded: VecDeque<Recorded>,
    alone: Vec<Option<Alone<'s>>>,
    /// When a lane first meets another event than the others, or an instant cannot be solved for, s.
    pub deviates: Option<f64>,
    /// First sample, and how many lanes are samples.
    pub first: usize,
    pub count: usize,
}

impl<'s> SegmentTile<'s> {
    /// At the start.
    ///
    /// # Errors
    /// Where a sample cannot be assembled.
    pub fn start(
        simulator: &'s Simulator,
        (program, segments): (&'s SwitchProgram, &'s Segments),
        (first, samples, width): (usize, &[Sample], usize),
        duration: f64,
    ) -> Result<Self, SimulationError> {
        let path = |sample: &Sample| Path::start(simulator, program, sample, (duration, segments.tolerance));
        let (mut alone, mut guesses, mut deviates) = (Vec::new(), Vec::new(), None::<f64>);
        for sample in samples {
            let found = lengths(path(sample)?, segments);
            if let Err(time) = found {
                deviates = Some(deviates.map_or(time, |first| first.min(time)));
            }
            alone.push(match found {
                Ok(_) => None,
                Err(_) => Some(Alone { path: path(sample)?, step: None, lost: false }),
            });
            guesses.push(found.unwrap_or_else(|_| vec![f64::NAN; segments.steps.len()]));
        }
        let lane = |lane: usize| lane.min(samples.len() - 1);
        let start = simulator.assemble(width, 0.0, |l| samples[lane(l)].clone())?;
        let closure = RowClosure::new(simulator, &start)?;
        let watch = SwitchWatch::new(program, closure.tile());
        let layout = &simulator.start.layout;
        let state = start.values()[layout.q.start * width..layout.v.end * width].to_vec();
        let guesses = (0..width).map(|l| guesses[lane(l)].clone()).collect();
        let motion = Stretched { closure, begin: vec![0.0; width], length: vec![0.0; width] };
        let (next, recorded, count) = (0, VecDeque::new(), samples.len());
        Ok(Self { segments, duration, motion, watch, state, next, guesses, recorded, alone, deviates, first, count })
    }

    /// Number of lanes.
    pub fn width(&self) -> usize {
        self.motion.length.len()
    }

    /// Number of positions and velocities, 2n.
    pub fn lines(&self) -> usize {
        self.state.len() / self.width()
    }

    /// Positions and velocities (2n lines, lane by lane) at a time that is not before that of the last call; NaN where
    /// a lane cannot be followed.
    pub fn reach(&mut self, time: f64, into: &mut [f64]) {
        while self.next < self.segments.steps.len() && !self.reaches(time) {
            self.march();
        }
        while self.recorded.len() > 1 && self.recorded[0].ends().all(|end| end < time) {
            self.recorded.pop_front();
        }
        let width = self.width();
        let mut own = vec![0.0; into.len() / width];
        for lane in 0..width {
            match self.alone.get_mut(lane) {
                Some(Some(alone)) => alone.reach(time, &mut own),
                _ => {
                    let holds = |recorded: &&Recorded| recorded.begin[lane] + recorded.length[lane] >= time;
                    let Some(recorded) = self.recorded.iter().find(holds).or(self.recorded.back()) else { continue };
                    recorded.interpolate(&self.segments.steps[recorded.number], (lane, width), time, &mut own);
                }
            }
            into.iter_mut().skip(lane).step_by(width).zip(&own).for_each(|(value, own)| *value = *own);
        }
    }

    /// Whether the segments so far reach a time in all lanes.
    fn reaches(&self, time: f64) -> bool {
        // NaN, of lanes that go on alone, is beyond.
        self.recorded.back().is_some_and(|last| last.ends().all(|end| end >= time || end.is_nan()))
    }

    /// Goes through the next segment.
    pub fn march(&mut self) {
        let (segments, number) = (self.segments, self.next);
        let event = segments.events.get(number);
        let width = self.width();
        for lane in 0..width {
            self.motion.length[lane] = match (event, segments.tail) {
                // NaN of a lane that goes on alone stays.
                (None, Some(end)) => end - self.motion.begin[lane] + 0.0 * self.guesses[lane][number],
                _ => self.guesses[lane][number],
            };
        }
        let mut solved: Vec<bool> =
            self.motion.length.iter().map(|length| event.is_none() || length.is_nan()).collect();
        let mut nodes = self.pass(number);
        for _ in 0..CORRECTIONS {
            for lane in (0..width).filter(|&lane| !solved[lane]).collect::<Vec<_>>() {
                let Some(event) = event else { continue };
                let [value, rate] = self.watch.at_end(event.switch, lane);
                let change = BEYOND * self.duration - value / rate;
                solved[lane] = change.abs() <= LOCATED * self.duration || !change.is_finite();
                if !solved[lane] {
                    self.motion.length[lane] += change;
                }
            }
            if !solved.contains(&false) {
                break;
            }
            nodes = self.pass(number);
        }
        if let Some(event) = event {
            let is_off = |lane: &usize| {
                let [value, rate] = self.watch.at_end(event.switch, *lane);
                let off = (value / rate).abs();
                !self.motion.length[*lane].is_nan() && (off > ROUNDED * self.duration || off.is_nan())
            };
            if let Some(lane) = (0..self.count).find(is_off) {
                let time = self.motion.begin[lane];
                self.deviates = Some(self.deviates.map_or(time, |first| first.min(time)));
            }
        }
        let (begin, length) = (self.motion.begin.clone(), self.motion.length.clone());
        self.motion.begin.iter_mut().zip(&length).for_each(|(begin, length)| *begin += length);
        if let Some(last) = nodes.last() {
            self.state.copy_from_slice(last);
        }
        self.recorded.push_back(Recorded { number, begin, length, nodes });
        self.next += 1;
    }

    /// Takes the steps of a segment with the lengths as they are: the states at its nodes.
    fn pass(&mut self, number: usize) -> Vec<Vec<f64>> {
        let Self { motion, watch, state, segments, .. } = self;
        let mut run = RungeKutta::start(motion, 0.0, state.clone());
        let mut nodes = vec![state.clone()];
        for &end in &segments.steps[number] {
            run.attempt(motion, end);
            run.finish(motion, end);
            if end == 1.0 {
                watch.end(motion.closure.tile());
            }
            run.prepare_dense(motion, end);
            for share in &step_nodes()[1..STEP_NODES - 1] {
                let mut node = vec![0.0; state.len()];
                run.interpolate(*share, &mut node);
                nodes.push(node);
            }
            run.accept(motion, end);
            nodes.push(run.state.clone());
        }
        nodes
    }
}

impl Recorded {
    fn ends(&self) -> impl Iterator<Item = f64> {
        self.begin.iter().zip(&self.length).map(|(begin, length)| begin + length)
    }

    /// A lane's positions and velocities (2n) at a time.
    fn interpolate(&self, steps: &[f64], (lane, width): (usize, usize), time: f64, into: &mut [f64]) {
        let share = ((time - self.begin[lane]) / self.length[lane]).clamp(0.0, 1.0);
        let (step, weights) = step_weights(steps, share);
        let nodes = &self.nodes[step * (STEP_NODES - 1)..][..STEP_NODES];
        for (line, value) in into.iter_mut().enumerate() {
            *value = weights.iter().zip(nodes).map(|(weight, node)| weight * node[line * width + lane]).sum();
        }
    }
}

impl Alone<'_> {
    fn reach(&mut self, time: f64, into: &mut [f64]) {
        while !self.lost && self.step.is_none_or(|step| step.end < time) {
            if let Some(step) = self.step {
                self.path.go_on(step);
            }
            match self.path.step(f64::INFINITY) {
                Ok(step) => {
                    self.path.prepare_dense(step);
                    self.step = Some(step);
                }
                Err(_) => self.lost = true,
            }
        }
        match self.step.filter(|_| !self.lost) {
            Some(step) => self.path.interpolate((time - step.begin) / (step.end - step.begin), into),
            None => into.fill(f64::NAN),
        }
    }
}

/// Lengths of the segments of a motion, s.
///
/// # Errors
/// When it first meets another event, s.
fn lengths(mut path: Path, segments: &Segments) -> Result<Vec<f64>, f64> {
    let (mut lengths, mut time, mut begin) = (Vec::new(), 0.0, 0.0);
    while lengths.len() < segments.steps.len() {
        let expected = segments.events.get(lengths.len());
        let goal = if expected.is_some() { f64::INFINITY } else { segments.tail.unwrap_or(time) };
        let step = path.step(goal).map_err(|_| time)?;
        path.go_on(step);
        time = step.end;
        if step.event.is_some() && step.event.as_ref() != expected {
            return Err(time);
        }
        if step.event.is_some() || time >= goal {
            lengths.push(time - begin);
            begin = time;
        }
    }
    Ok(lengths)
}
