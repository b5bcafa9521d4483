//! The motion of one sample, with steps of its own that end at events.
//!
//! The instant of an event is solved to rounding: the step that crosses it is taken again with its length as the
//! unknown, by Newton's method on the switch's value and rate at the step's end. It ends beyond the event by so little
//! that the next step begins on the event's other side.

use super::path_step::{Lost, PathStep};
use super::scheme_steps::SchemeSteps;
use super::segments::{Event, Following, SegmentMethod};
use super::tuning::TUNING;
use crate::compile::SwitchProgram;
use crate::numerics::Sample;
use crate::simulate::control::SwitchWatch;
use crate::simulate::drive::MotionSteps;
use crate::simulate::ensemble::RowClosure;
use crate::simulate::error::SimulationError;
use crate::simulate::explicit::movement::Movement;
use crate::simulate::explicit::runge_kutta::{RungeKutta, before_event, end_of_stages};
use crate::simulate::features::{FeatureWork, Features, Passage};
use crate::simulate::simulator::Simulator;
use crate::simulate::step::Counters;
use crate::simulate::time_functions::ResolvingSteps;

/// One sample on its way.
#[derive(Debug)]
pub struct Path<'s> {
    closure: RowClosure<'s>,
    run: Box<dyn MotionSteps<RowClosure<'s>> + 's>,
    watch: SwitchWatch<'s>,
    movement: Movement,
    start: Vec<f64>,
    features: Option<&'s Features>,
    work: FeatureWork,
    functions: Option<ResolvingSteps>,
    parameters: Sample,
    /// Largest value of each switch so far.
    sizes: Vec<f64>,
    duration: f64,
    tolerance: f64,
    /// Length of the step to try next, s.
    h: f64,
    /// When the last event was, s.
    event: f64,
    tries: usize,
    most: usize,
    method: SegmentMethod,
    /// Whether others take its steps on fewer levels, and divide them.
    divides: bool,
}

impl<'s> Path<'s> {
    /// Path at the start of a sample.
    ///
    /// # Errors
    /// Where the sample cannot be assembled.
    pub fn start(
        simulator: &'s Simulator,
        program: &'s SwitchProgram,
        sample: &Sample,
        duration: f64,
        Following { tolerance, method, of_steps }: Following,
    ) -> Result<Self, SimulationError> {
        let assembled = simulator.assemble(1, 0.0, |_| sample.clone())?;
        let mut closure = RowClosure::new(simulator, &assembled)?;
        let layout = &simulator.start.layout;
        let start = assembled.values()[layout.q.start..layout.v.end].to_vec();
        let run: Box<dyn MotionSteps<RowClosure>> = match method {
            SegmentMethod::Scheme { levels } => {
                let mut run = SchemeSteps::of_lanes(simulator, &assembled, TUNING.levels_of_paths);
                if let Some(of_steps) = of_steps.filter(|_| levels < TUNING.levels_of_paths) {
                    run.judge(levels, of_steps / duration);
                }
                run.begin(&mut closure, 0.0, &start);
                Box::new(run)
            }
            _ => Box::new(RungeKutta::start(&mut closure, 0.0, start.clone())),
        };
        let mut watch = SwitchWatch::new(program, closure.tile());
        watch.begin(closure.tile());
        let sizes = (0..program.switches.len()).map(|switch| watch.at_beginning(switch, 0)[0].abs()).collect();
        let movement = Movement::new(&simulator.system.coordinates, duration);
        let functions = simulator.time_functions(duration);
        Ok(Self {
            closure,
            run,
            watch,
            movement,
            start,
            features: simulator.features(),
            work: FeatureWork::default(),
            functions: functions.map(|functions| ResolvingSteps::between_jumps(&functions, sample)),
            parameters: sample.clone(),
            sizes,
            duration,
            tolerance,
            h: TUNING.first_step * duration,
            event: 0.0,
            tries: 0,
            method,
            divides: of_steps.is_some() && method != SegmentMethod::Explicit,
            most: method.most_steps(TUNING.most_steps),
        })
    }

    /// The same with steps enough to go on where words end.
    #[must_use]
    pub fn behind_words(self) -> Self {
        Self { most: self.method.most_steps(TUNING.most_steps_behind_words), ..self }
    }

    /// Takes a step that ends at `goal` at the latest, from which [`go_on`](Self::go_on) goes on.
    ///
    /// # Errors
    /// Where no step can be taken.
    pub fn step(&mut self, goal: f64) -> Result<PathStep, Lost> {
        let begin = self.run.time();
        // The length of a step that a crossing cut short, and the switch that crosses.
        let mut cut: Option<(f64, usize)> = None;
        loop {
            self.tries += 1;
            if self.tries > self.most || self.h < TUNING.smallest_step * self.duration {
                return Err(Lost);
            }
            let longest = self.h.min(TUNING.longest_step * self.duration);
            let step = self.functions.as_mut().map_or(longest, |functions| functions.resolving(begin, longest));
            let is_shortened = step < longest;
            let mut end = if begin + step * (1.0 + 1e-9) >= goal { goal } else { begin + step };
            let step = end - begin;
            let mut ratio = self.attempt(end);
            let crossing = self.crossing(begin, step);
            if let Some((switch, share)) = crossing.filter(|(_, share)| *share < TUNING.near_end) {
                self.closure.forget();
                cut = Some(cut.map_or((self.h, switch), |(uncut, _)| (uncut, switch)));
                // If the step does not resolve the later motion, its end says little of when that begins.
                self.h = step * if ratio <= 1.0 { share } else { share.max(TUNING.least_share) };
                continue;
            }
            if let Some((time, switch)) =
                self.touched(PathStep { begin, end, event: None, parts: 1 }).filter(|_| crossing.is_none())
            {
                cut = Some(cut.map_or((self.h, switch), |(uncut, _)| (uncut, switch)));
                self.h = time - begin;
                continue;
            }
            let near = |(_, switch): &(f64, usize)| {
                let [value, rate] = self.watch.at_end(*switch, 0);
                value * rate < 0.0 && (value / rate).abs() < (1.0 - TUNING.near_end) * step
            };
            let switch = crossing.map(|(switch, _)| switch).or(cut.filter(near).map(|(_, switch)| switch));
            let mut event = None;
            if let Some(switch) = switch {
                match self.located(switch, begin, end) {
                    Some(found) => (end, ratio, event) = found,
                    None => ratio = f64::INFINITY,
                }
            }
            let passes_over = ratio <= 1.0 && self.passes_over(begin, end);
            if ratio > 1.0 || passes_over {
                self.closure.forget();
                self.h = if passes_over { step * TUNING.passing_share } else { self.run.next_length(step, ratio) };
                cut = None;
                continue;
            }
            self.h = match cut {
                Some((uncut, _)) if event.is_some() => uncut,
                // A step cut short at the goal, or by a function of the time, is no reason against the longer one.
                _ if is_shortened || end == goal && step < self.h => self.h,
                _ => self.run.next_length(step, ratio),
            };
            let parts = if self.divides { self.run.parts(end, &self.sizes_of_lines()) } else { 1 };
            return Ok(PathStep { begin, end, event, parts });
        }
    }

    /// Takes the step again until it ends at the event: its end, its error over the tolerance, and the event; `None`
    /// where the switch does not pass zero there.
    fn located(&mut self, switch: usize, begin: f64, mut end: f64) -> Option<(f64, f64, Option<Event>)> {
        let rises = self.watch.at_beginning(switch, 0)[0] < 0.0;
        let (mut ratio, mut is_located) = (f64::INFINITY, false);
        for _ in 0..TUNING.corrections_of_instant {
            let [value, rate] = self.watch.at_end(switch, 0);
            // Written so that an unknown rate ends it, too.
            if !(if rises { rate > 0.0 } else { rate < 0.0 }) {
                return None;
            }
            let change = TUNING.beyond_event * self.duration - value / rate;
            is_located = change.abs() <= TUNING.rounded_instant * self.duration;
            if change.abs() <= TUNING.located * self.duration && ratio.is_finite() {
                break;
            }
            end += change;
            if end <= begin || end.is_nan() {
                return None;
            }
            ratio = self.attempt_to_event(end);
        }
        is_located.then(|| (end, ratio, Some(self.first_of(Event { switch, rises }))))
    }

    /// The event by which those at the end of the step that was tried are named: of switches that pass zero at once
    /// the first by number. Which of them a cubic finds first is an accident of the step.
    fn first_of(&self, event: Event) -> Event {
        let passes = |switch: usize| {
            let ([before, _], [value, rate]) = (self.watch.at_beginning(switch, 0), self.watch.at_end(switch, 0));
            let is_now = before * rate < 0.0 && (value / rate).abs() <= TUNING.same_event * self.duration;
            is_now.then_some(Event { switch, rises: rate > 0.0 })
        };
        (0..event.switch).find_map(passes).unwrap_or(event)
    }

    /// Tries a step: its error over the tolerance.
    fn attempt(&mut self, end: f64) -> f64 {
        let Self { run, closure, watch, .. } = self;
        run.attempt(closure, end);
        watch.end(closure.tile());
        self.error(end)
    }

    /// The same of a step that ends at an event, or where one is sought.
    fn attempt_to_event(&mut self, end: f64) -> f64 {
        let before = before_event(self.run.time(), end);
        self.run.attempt(&mut self.closure, before);
        let ratio = self.error(before);
        self.run.extrapolate(&mut self.closure, before, end);
        self.watch.end(self.closure.tile());
        ratio
    }

    /// Error over the tolerance of the step that was finished.
    fn error(&self, end: f64) -> f64 {
        let mut sizes = self.sizes_of_lines();
        if self.method != SegmentMethod::Explicit {
            self.allow_rounding(end, &mut sizes);
        }
        self.run.ratio(end, &sizes, self.tolerance)
    }

    /// Scale of each line at the end of the step that was tried.
    fn sizes_of_lines(&self) -> Vec<f64> {
        self.movement.clone().reaching(&self.start, self.run.next(), 1).sizes()
    }

    /// Adds the rounding of each line over the tolerance to its scale. Positions are rounded, and velocities change by
    /// that over the shortest step: accelerations by a spring that steps resolve are no larger.
    fn allow_rounding(&self, end: f64, sizes: &mut [f64]) {
        let n = sizes.len() / 2;
        let shortest = (end - self.run.time()) * self.run.shortest();
        for (line, size) in sizes.iter_mut().enumerate() {
            let of_position = TUNING.rounding_of_steps * f64::EPSILON * self.run.next()[line % n].abs();
            *size += if line < n { of_position } else { of_position / shortest } / self.tolerance;
        }
    }

    /// Tries the step that was taken once more.
    fn retake(&mut self, step: PathStep) {
        match step.event {
            Some(_) => self.attempt_to_event(step.end),
            None => self.attempt(step.end),
        };
    }

    /// Whether the step that was tried passes over a feature of a force in space.
    fn passes_over(&mut self, begin: f64, end: f64) -> bool {
        self.has_features(begin, end, Features::are_hidden)
    }

    /// Whether a feature of a force in space acts in the step that was taken.
    pub fn meets_feature(&mut self, step: PathStep) -> bool {
        self.has_features(step.begin, step.end, Features::act)
    }

    fn has_features(
        &mut self,
        begin: f64,
        end: f64,
        has: fn(&Features, Passage<'_>, &mut FeatureWork) -> bool,
    ) -> bool {
        let Some(features) = self.features else { return false };
        let states = [self.run.state(), self.run.next()];
        let passage = Passage { end, h: end - begin, parameters: &self.parameters, states, width: 1, lane: 0 };
        has(features, passage, &mut self.work)
    }

    /// The first switch that crosses in the step that was tried, and when, as a share of it.
    fn crossing(&self, begin: f64, step: f64) -> Option<(usize, f64)> {
        let counts = |(switch, share): &(usize, f64)| {
            let [start, end] = [self.watch.at_beginning(*switch, 0), self.watch.at_end(*switch, 0)];
            let moves = start[0].abs().max(end[0].abs()) > TUNING.zero_of_switch * self.sizes[*switch];
            moves && begin + share * step - self.event > TUNING.same_event * self.duration
        };
        let found: Vec<(usize, f64)> =
            self.watch.crossings(0, step).map(|(switch, crossing)| (switch, crossing.share)).filter(counts).collect();
        let first = found.iter().map(|(_, share)| *share).fold(f64::INFINITY, f64::min);
        // The first by number of the switches that cross at once.
        let at_once = |(_, share): &(usize, f64)| (share - first) * step <= TUNING.same_event * self.duration;
        found.into_iter().find(at_once)
    }

    /// Newton iterations and rank-revealing solves so far.
    pub fn counters(&self) -> Counters {
        self.run.counters()
    }

    /// (value, rate) of a switch at the end of the step that was taken.
    pub fn at_end(&self, switch: usize) -> [f64; 2] {
        self.watch.at_end(switch, 0)
    }

    /// Change of a switch's rate with the time at the end of the step that was taken.
    pub fn bend(&mut self, step: PathStep, switch: usize) -> f64 {
        let back = TUNING.share_for_bend * (step.end - step.begin);
        let [_, rate] = self.at_end(switch);
        self.attempt(step.end - back);
        let [_, before] = self.at_end(switch);
        self.retake(step);
        (rate - before) / back
    }

    /// Time and value of the minimum of `sign` times a switch within the step that was taken, where it falls first and
    /// rises at the end: the zero of its rate by the secant method that keeps both sides.
    pub fn least(&mut self, step: PathStep, switch: usize, sign: f64) -> Option<(f64, f64)> {
        let [[_, first], [_, last]] = [self.watch.at_beginning(switch, 0), self.at_end(switch)];
        let (mut low, mut high) = ((step.begin, sign * first), (step.end, sign * last));
        // Written so that unknown rates end it.
        if !(low.1 < 0.0 && high.1 > 0.0) {
            return None;
        }
        let mut least = (step.end, f64::INFINITY);
        for _ in 0..TUNING.corrections_of_instant {
            let time = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            if !(time > step.begin && time < step.end) {
                break;
            }
            self.attempt(time);
            let [value, rate] = self.at_end(switch).map(|value| sign * value);
            if value < least.1 {
                least = (time, value);
            }
            if rate.abs() <= TUNING.flat_rate * (first.abs() + last.abs()) {
                break;
            }
            // The end that stays counts half the next time.
            if rate < 0.0 {
                (low, high.1) = ((time, rate), 0.5 * high.1);
            } else {
                (high, low.1) = ((time, rate), 0.5 * low.1);
            }
        }
        self.retake(step);
        Some(least)
    }

    /// When a switch passes zero and comes back within the step that was tried, if both of its ends approach zero: a
    /// step is long compared with a small stop, and a cubic through its ends passes over it.
    fn touched(&mut self, step: PathStep) -> Option<(f64, usize)> {
        let count = self.sizes.len();
        let mut found = |switch: usize| {
            let sign = self.at_end(switch)[0].signum();
            let (time, least) = self.least(step, switch, sign)?;
            (least < -TUNING.zero_of_switch * self.sizes[switch]
                && time - self.event > TUNING.same_event * self.duration)
                .then_some((time, switch))
        };
        (0..count).filter_map(&mut found).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Prepares [`interpolate`](Self::interpolate) in the step that was taken; one that ends at an event is prepared.
    pub fn prepare_dense(&mut self, step: PathStep) {
        if step.event.is_none() {
            self.run.prepare_dense(&mut self.closure, step.end);
        }
    }

    /// Positions and velocities (2n) at a time within the step that was taken.
    pub fn interpolate(&self, step: PathStep, time: f64, into: &mut [f64]) {
        let end = end_of_stages(step.begin, step.end, step.event.is_some());
        self.run.interpolate((time - step.begin) / (end - step.begin), into);
    }

    /// Goes on from the end of the step that was taken.
    pub fn go_on(&mut self, step: PathStep) {
        self.watch.go_on();
        for (switch, size) in self.sizes.iter_mut().enumerate() {
            *size = size.max(self.watch.at_beginning(switch, 0)[0].abs());
        }
        if step.event.is_some() {
            self.event = step.end;
            self.most = self.most.max(self.method.most_steps(TUNING.most_steps_with_events));
            self.run.accept_event(&mut self.closure, step.end);
        } else {
            self.run.accept(&mut self.closure, step.end);
        }
        self.movement = self.movement.clone().reaching(&self.start, self.run.state(), 1);
    }
}
