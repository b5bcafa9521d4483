//! A tile of samples of one word: lanes in lockstep, each with steps of its own length. Samples of no word, and all
//! samples behind the time up to which words are followed, go on alone.
//!
//! A segment's length is each lane's own unknown. A motion of the lane alone finds its events and guesses the lengths;
//! Newton's method on the switch's value and rate at the segment's end, with the steps that all samples share, solves
//! them to rounding. So instants, and the states there, are as smooth functions of the parameters as the steps are.

use std::collections::VecDeque;

use super::followed::Spelled;
use super::nodes;
use super::path::Path;
use super::path_step::PathStep;
use super::scheme_steps::SchemeSteps;
use super::segments::{SegmentMethod, Segments, Word};
use super::stretched::Stretched;
use super::tuning::TUNING;
use crate::compile::SwitchProgram;
use crate::numerics::{STEP_NODES, Sample, step_weights};
use crate::simulate::control::SwitchWatch;
use crate::simulate::drive::MotionSteps;
use crate::simulate::ensemble::RowClosure;
use crate::simulate::error::SimulationError;
use crate::simulate::explicit::runge_kutta::RungeKutta;
use crate::simulate::simulator::Simulator;
use crate::simulate::step::{Counters, Pace};

/// A segment of all lanes.
#[derive(Debug)]
pub(super) struct Recorded {
    pub number: usize,
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
    /// Word of the samples; `None` for samples that meet the events of no word.
    pub word: Option<&'s Word>,
    /// Time up to which words are followed, s.
    horizon: f64,
    duration: f64,
    motion: Stretched<'s>,
    run: Box<dyn MotionSteps<Stretched<'s>> + 's>,
    watch: SwitchWatch<'s>,
    /// State at the beginning of the next segment.
    state: Vec<f64>,
    next: usize,
    /// Lengths of all segments of each lane as the lane alone finds them, s.
    pub guesses: Vec<Vec<f64>>,
    /// Segments that rows may lie in.
    pub recorded: VecDeque<Recorded>,
    /// Motions of lanes alone, where they are needed.
    alone: Vec<Alone<'s>>,
    /// When a lane first meets an event that its word does not have, or an instant cannot be solved for, s.
    pub deviates: Option<f64>,
    /// Lanes of which an instant cannot be solved for.
    pub lost: Vec<bool>,
    /// Indices of the samples: those of the first lanes.
    pub samples: Vec<usize>,
}

/// Samples of one word, or of none.
#[derive(Debug)]
pub(super) struct Lanes<'s> {
    pub word: Option<&'s Word>,
    /// Indices of the samples, and their words.
    pub indices: Vec<usize>,
    pub spelled: Vec<Spelled>,
}

impl<'s> SegmentTile<'s> {
    /// Tile at the start.
    ///
    /// # Errors
    /// Where a sample cannot be assembled.
    pub fn start(
        simulator: &'s Simulator,
        program: &'s SwitchProgram,
        segments: &'s Segments,
        lanes: Lanes<'s>,
        samples: &[Sample],
        width: usize,
        duration: f64,
    ) -> Result<Self, SimulationError> {
        let Lanes { word, indices, spelled } = lanes;
        let horizon = segments.horizon;
        let alone = |sample: &Sample| {
            let path = Path::start(simulator, program, sample, duration, segments.following())?;
            Ok(Alone { path: path.behind_words(), step: None, lost: false })
        };
        let goes_alone = word.is_none() || horizon < duration;
        let alone: Vec<Alone> = samples
            .iter()
            .take(if goes_alone { samples.len() } else { 0 })
            .map(alone)
            .collect::<Result<_, SimulationError>>()?;
        let first = spelled.iter().map(|spelled| spelled.deviates).fold(horizon, f64::min);
        let deviates = goes_alone.then_some(first);
        let lane = |lane: usize| lane.min(samples.len() - 1);
        let start = simulator.assemble(width, 0.0, |l| samples[lane(l)].clone())?;
        let closure = RowClosure::new(simulator, &start)?;
        let watch = SwitchWatch::new(program, closure.tile());
        let layout = &simulator.start.layout;
        let state = start.block(layout.q.start..layout.v.end).to_vec();
        let guesses = (0..width).map(|l| spelled[lane(l)].lengths.clone()).collect();
        let pace = Pace { begin: vec![0.0; width], length: vec![0.0; width] };
        let mut motion = Stretched { closure, pace };
        let run: Box<dyn MotionSteps<Stretched>> = match segments.method {
            SegmentMethod::Scheme { levels } => Box::new(SchemeSteps::of_lanes(simulator, &start, levels)),
            _ => Box::new(RungeKutta::start(&mut motion, 0.0, state.clone())),
        };
        let (next, recorded) = (0, VecDeque::new());
        Ok(Self {
            word,
            horizon,
            duration,
            motion,
            run,
            watch,
            state,
            next,
            guesses,
            recorded,
            alone,
            deviates,
            lost: vec![false; width],
            samples: indices,
        })
    }

    /// Number of lanes.
    pub fn width(&self) -> usize {
        self.motion.pace.length.len()
    }

    /// Lanes of samples whose instants are all solved for.
    pub fn kept(&self) -> impl Iterator<Item = usize> {
        (0..self.samples.len()).filter(|&lane| !self.lost[lane])
    }

    /// Newton iterations and rank-revealing solves so far.
    pub fn counters(&self) -> Counters {
        let mut total = self.run.counters();
        self.alone.iter().for_each(|alone| total += alone.path.counters());
        total
    }

    /// Number of positions and velocities, 2n.
    pub fn lines(&self) -> usize {
        self.state.len() / self.width()
    }

    /// Positions and velocities (2n lines, lane by lane) at a time that is not before that of the last call; NaN where
    /// a lane cannot be followed.
    pub fn reach(&mut self, time: f64, into: &mut [f64]) {
        let width = self.width();
        let mut own = vec![0.0; into.len() / width];
        let word = self.word.filter(|_| time <= self.horizon || self.alone.is_empty());
        if let Some(word) = word {
            while self.next < word.steps.len() && !self.reaches(time) {
                self.march(word);
            }
        }
        for lane in 0..width {
            match word {
                Some(word) => {
                    let holds = |recorded: &&Recorded| recorded.begin[lane] + recorded.length[lane] >= time;
                    let Some(recorded) = self.recorded.iter().find(holds).or(self.recorded.back()) else { continue };
                    recorded.interpolate(&word.steps[recorded.number], lane, width, time, &mut own);
                }
                // Behind the samples: the last of them once more.
                None => {
                    if let Some(alone) = self.alone.get_mut(lane) {
                        alone.reach(time, &mut own);
                    }
                }
            }
            into.iter_mut().skip(lane).step_by(width).zip(&own).for_each(|(value, own)| *value = *own);
        }
    }

    /// Forgets segments that end before a time.
    pub fn forget_before(&mut self, time: f64) {
        while self.recorded.len() > 1 && self.recorded[0].ends().all(|end| end < time) {
            self.recorded.pop_front();
        }
    }

    /// Whether the segments so far reach a time in all lanes.
    fn reaches(&self, time: f64) -> bool {
        self.recorded.back().is_some_and(|last| last.ends().all(|end| end >= time))
    }

    /// Goes through the next segment of the word.
    fn march(&mut self, word: &Word) {
        let number = self.next;
        let event = word.events.get(number);
        let width = self.width();
        for lane in 0..width {
            self.motion.pace.length[lane] = match (event, word.tail) {
                (None, Some(end)) => end - self.motion.pace.begin[lane],
                _ => self.guesses[lane][number],
            };
        }
        let mut solved = vec![event.is_none(); width];
        let steps = &word.steps[number];
        let ends_at_event = event.is_some();
        let mut nodes = self.pass(steps, ends_at_event);
        for _ in 0..TUNING.corrections_of_instant {
            for lane in (0..width).filter(|&lane| !solved[lane]).collect::<Vec<_>>() {
                let Some(event) = event else { continue };
                let [value, rate] = self.watch.at_end(event.switch, lane);
                let change = TUNING.beyond_event * self.duration - value / rate;
                solved[lane] = change.abs() <= TUNING.located * self.duration || !change.is_finite();
                if !solved[lane] {
                    self.motion.pace.length[lane] += change;
                }
            }
            if !solved.contains(&false) {
                break;
            }
            nodes = self.pass(steps, ends_at_event);
        }
        if let Some(event) = event {
            // Where an event is hardly more than grazed, another one of its switch is close to it.
            let is_off = |lane: usize| {
                let [value, rate] = self.watch.at_end(event.switch, lane);
                let off = (value / rate).abs();
                let is_it = (if event.rises { rate > 0.0 } else { rate < 0.0 }) && self.motion.pace.length[lane] > 0.0;
                off > TUNING.rounded_instant * self.duration || off.is_nan() || !is_it
            };
            for lane in (0..self.samples.len()).filter(|&lane| is_off(lane)).collect::<Vec<_>>() {
                let time = self.motion.pace.begin[lane];
                self.deviates = Some(self.deviates.map_or(time, |first| first.min(time)));
                self.lost[lane] = true;
            }
        }
        let (begin, length) = (self.motion.pace.begin.clone(), self.motion.pace.length.clone());
        self.motion.pace.begin.iter_mut().zip(&length).for_each(|(begin, length)| *begin += length);
        if let Some(last) = nodes.last() {
            self.state.copy_from_slice(last);
        }
        self.recorded.push_back(Recorded { number, begin, length, nodes });
        self.next += 1;
    }

    /// Goes through all segments of the word.
    pub fn march_to_the_end(&mut self) {
        if let Some(word) = self.word {
            word.steps.iter().for_each(|_| self.march(word));
        }
    }

    /// Takes the steps of a segment, which end at these shares of it, with the lengths as they are: the states at its
    /// nodes.
    fn pass(&mut self, steps: &[f64], ends_at_event: bool) -> Vec<Vec<f64>> {
        let Self { motion, run, watch, state, .. } = self;
        let nodes = nodes::pass(&mut **run, motion, state, steps, ends_at_event);
        if ends_at_event {
            watch.end(motion.closure.tile());
        }
        nodes
    }
}

impl Recorded {
    fn ends(&self) -> impl Iterator<Item = f64> {
        self.begin.iter().zip(&self.length).map(|(begin, length)| begin + length)
    }

    /// A lane's positions and velocities (2n) at a time.
    pub fn interpolate(&self, steps: &[f64], lane: usize, width: usize, time: f64, into: &mut [f64]) {
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
            Some(step) => self.path.interpolate(step, time, into),
            None => into.fill(f64::NAN),
        }
    }
}
