//! Adjoints through events: the saltation matrix, transposed.
//!
//! A change δx of the state just before an event, and δξ of the parameters, move its instant by
//! δT = −(g_x δx + g_ξ δξ)/ġ. The rates are F⁻ before it and F⁺ behind it, so that the motion goes on with
//! δx + (F⁻ − F⁺) δT (Kong, Payne, Zhu & Johnson, arXiv 2306.06862). Adjoints λ behind it are λ + g_xᵀ μ before it, and
//! those of the parameters get g_ξᵀ μ, with μ = (F⁺ − F⁻)ᵀ λ/ġ. Where forces have a kink only, μ is zero.

use symdiff::{Adjoints, Tile};

use super::followed::Followed;
use super::path::Path;
use super::segments::{Event, SegmentMethod, Segments};
use super::tuning::TUNING;
use crate::compile::{SwitchProgram, Tapes};
use crate::numerics::Sample;
use crate::simulate::adjoint::{StartAdjoints, add};
use crate::simulate::error::SimulationError;
use crate::simulate::simulator::Simulator;

/// Steps of one sample that end at its events.
#[derive(Clone, Debug, Default)]
pub(in crate::simulate) struct EventSteps {
    /// Ends of the steps, s.
    pub ends: Vec<f64>,
    /// Events with the indices of the steps that end there.
    pub events: Vec<(usize, Event)>,
}

impl EventSteps {
    /// Follows a sample up to a time, s, of a motion of a duration, s, or as far as it can be followed.
    ///
    /// # Errors
    /// Where it cannot be assembled.
    pub fn of(
        simulator: &Simulator,
        segments: &Segments,
        sample: &Sample,
        until: f64,
        duration: f64,
    ) -> Result<Self, SimulationError> {
        // Adjoints are those of the explicit method's steps.
        let is_explicit = !matches!(segments.method, SegmentMethod::Scheme { .. });
        let Some(program) = simulator.switches().filter(|_| is_explicit) else { return Ok(Self::default()) };
        let path = Path::start(simulator, program, sample, duration, segments.following())?.behind_words();
        let Followed { events, steps, .. } = Followed::to(path, until);
        let mut own = Self::default();
        for (segment, ends) in steps.into_iter().enumerate() {
            own.ends.extend(ends);
            if let (Some((event, _)), Some(last)) = (events.get(segment), own.ends.len().checked_sub(1)) {
                own.events.push((last, *event));
            }
        }
        Ok(own)
    }
}

/// Pulls adjoints of a tile of lanes, all of one sample, through its events.
#[derive(Debug)]
pub(in crate::simulate) struct EventAdjoints<'s> {
    program: &'s SwitchProgram,
    /// Values and adjoints of the switches.
    tile: Tile,
    adjoints: Adjoints,
    /// Accelerations on both sides.
    memory: StartAdjoints<'s>,
    events: Vec<(usize, Event)>,
    /// Time by which a state is moved to before an event, s: at first, and at most.
    back: [f64; 2],
}

impl<'s> EventAdjoints<'s> {
    /// Adjoints through events at the ends of steps of an assembled tile, whose motion has a duration, s.
    ///
    /// # Errors
    /// Where the closure's equations have no factors.
    pub fn new(
        simulator: &'s Simulator,
        start: &Tile,
        events: Vec<(usize, Event)>,
        duration: f64,
    ) -> Result<Option<Self>, SimulationError> {
        let Some(program) = simulator.switches().filter(|_| !events.is_empty()) else { return Ok(None) };
        let tile = program.memory_for(start);
        let adjoints = Adjoints::new(&tile);
        let memory = StartAdjoints::new(simulator, simulator.free_closure()?, start);
        let back = [2.0 * TUNING.beyond_event, TUNING.rounded_instant].map(|share| share * duration);
        Ok(Some(Self { program, tile, adjoints, memory, events, back }))
    }

    /// Pulls adjoints of a state (q, v) behind the event at a step's end to before it, if there is an event.
    pub fn pull(&mut self, step: usize, end: f64, state: &[f64], adjoints: &mut [f64]) {
        let Some(event) = self.event(step) else { return };
        let behind = self.accelerations(end, state);
        let (half, mut time, mut moved) = (state.len() / 2, end, state.to_vec());
        self.move_before(event, &mut time, &mut moved);
        let before = self.accelerations(time, &moved);
        let width = self.tile.width();
        let mut products = vec![0.0; width];
        for (line, (behind, before)) in behind.iter().zip(&before).enumerate() {
            products[line % width] += (behind - before) * adjoints[half + line];
        }
        let [_, rates] = self.switch(event.switch);
        let switch = self.adjoints.lane_mut(self.program.switches[event.switch].value);
        for ((seed, product), rate) in switch.iter_mut().zip(products).zip(rates).filter(|((_, own), _)| *own != 0.0) {
            *seed = product / rate;
        }
        self.adjoints.pull(self.program.evaluate(), &mut self.tile);
        self.share(adjoints);
    }

    fn event(&self, step: usize) -> Option<Event> {
        self.events.iter().find(|(own, _)| *own == step).map(|(_, event)| *event)
    }

    /// Moves a state behind an event back along its motion to before it: a step's end is behind by rounding. The lanes
    /// are of one sample, so that the first lane decides for all.
    fn move_before(&mut self, event: Event, time: &mut f64, state: &mut [f64]) {
        let half = state.len() / 2;
        let [mut more, most] = self.back;
        while more <= most {
            let accelerations = self.accelerations(*time, state);
            let [value, rate] = self.switch(event.switch).map(|lanes| lanes[0]);
            let back = value / rate + more;
            if (value > 0.0) != event.rises || !back.is_finite() {
                break;
            }
            *time -= back;
            let (positions, velocities) = state.split_at_mut(half);
            add(positions, -back, velocities);
            add(velocities, -back, &accelerations);
            more *= 2.0;
        }
    }

    /// Moves adjoints of a switch's arguments to those of positions and velocities; those of the parameters stay.
    fn share(&mut self, adjoints: &mut [f64]) {
        let layout = &self.program.layout;
        let mut take = |registers: std::ops::Range<usize>| {
            let own = self.adjoints.block_mut(registers);
            let taken = own.to_vec();
            own.fill(0.0);
            taken
        };
        let of_motion = take(layout.q.start..layout.v.end);
        let unknowns = take(layout.w.start..layout.lambda.end);
        self.memory.add(layout.q.start, &of_motion);
        self.memory.add(layout.w.start, &unknowns);
        self.memory.pull_acceleration();
        let total = self.memory.take(layout.q.start..layout.v.end);
        add(adjoints, 1.0, &total);
    }

    /// Accelerations (n lines) of a state at a time.
    fn accelerations(&mut self, time: f64, state: &[f64]) -> Vec<f64> {
        let layout = self.memory.layout();
        self.memory.set(time, layout.q.start, state);
        self.memory.assembly().accelerate();
        self.memory.values(layout.w.clone()).to_vec()
    }

    /// Values and rates of a switch, by lane, at the state that accelerations were asked for last.
    fn switch(&mut self, number: usize) -> [Vec<f64>; 2] {
        self.program.evaluate_at(self.memory.assembly().tile(), &mut self.tile);
        let switch = &self.program.switches[number];
        let rate = switch.rate.map_or_else(|| vec![f64::NAN; self.tile.width()], |rate| self.tile.lane(rate).to_vec());
        [self.tile.lane(switch.value).to_vec(), rate]
    }

    /// The adjoints of the parameters, k lines.
    pub fn finish(&mut self) -> Vec<f64> {
        self.adjoints.pull(self.program.sample(), &mut self.tile);
        let parameters = self.program.layout.parameters.clone();
        let mut total = self.adjoints.block(parameters).to_vec();
        add(&mut total, 1.0, &self.memory.finish());
        total
    }
}
