//! A jet in the segments of its centre's word: instants are jets as the state is, so that both are Taylor polynomials
//! that go through the events.
//!
//! The length of a segment is solved for by Newton's method in jets on the switch's value at its end. What the state is
//! there follows with it: the saltation matrix of the first order, and all higher ones.

use symdiff::JetMemory;
use symdiff::jet::JetSpace;

use super::followed::Spelled;
use super::nodes;
use super::path::Path;
use super::scheme_steps::SchemeSteps;
use super::segments::{SegmentMethod, Segments};
use super::stretched::SchemeMotion;
use super::tuning::TUNING;
use crate::compile::{SwitchProgram, Tapes};
use crate::numerics::{Sample, SegmentMotions};
use crate::simulate::drive::{Motion, MotionSteps, RowState};
use crate::simulate::ensemble::{JetBox, JetClosure};
use crate::simulate::error::SimulationError;
use crate::simulate::explicit::runge_kutta::RungeKutta;
use crate::simulate::simulator::Simulator;
use crate::simulate::step::Pace;

/// Segments of a jet on a time from 0 to 1.
struct StretchedJet<'s> {
    closure: JetClosure<'s>,
    space: &'s JetSpace,
    /// When the segment begins, and how long it is.
    pace: Pace,
    product: Vec<f64>,
}

impl StretchedJet<'_> {
    fn set_time(&mut self, share: f64) {
        self.pace.set_times(share, self.closure.time_mut());
    }
}

impl Motion for StretchedJet<'_> {
    fn rate(&mut self, share: f64, state: &[f64], into: &mut [f64]) {
        self.set_time(share);
        self.closure.rate_at_time(state, into);
        for line in into.chunks_exact_mut(self.space.len()) {
            self.space.mul(line, &self.pace.length, &mut self.product);
            line.copy_from_slice(&self.product);
        }
    }

    fn close(&mut self, share: f64, state: &mut [f64]) {
        self.set_time(share);
        self.closure.close_at_time(state);
    }

    fn sample(&mut self, _: f64, _: &mut [f64]) -> bool {
        false
    }
}

impl SchemeMotion for StretchedJet<'_> {
    fn unknowns(&self) -> Vec<f64> {
        self.closure.unknowns()
    }

    fn pace(&self) -> Option<&Pace> {
        Some(&self.pace)
    }

    fn moved(&self, share: f64, state: &[f64], accelerations: &[f64]) -> Vec<f64> {
        let (half, terms) = (accelerations.len(), self.space.len());
        let mut moved = state.to_vec();
        let mut time = vec![0.0; terms];
        self.pace.set_steps(share, &mut time);
        let mut product = vec![0.0; terms];
        let mut speed = vec![0.0; terms];
        for line in (0..half).step_by(terms) {
            let accelerations = &accelerations[line..line + terms];
            // The speed half way, whose share of the time positions move by.
            self.space.mul(accelerations, &time, &mut product);
            for (index, change) in product.iter().enumerate() {
                speed[index] = state[half + line + index] + 0.5 * change;
                moved[half + line + index] += change;
            }
            self.space.mul(&speed, &time, &mut product);
            moved[line..line + terms].iter_mut().zip(&product).for_each(|(value, change)| *value += change);
        }
        moved
    }
}

/// Coefficients of the instants and motions about a centre, as the values of as many samples, with the index of its
/// word; `None` where it meets the events of none, or the jet cannot go on.
///
/// # Errors
/// Where the centre cannot be assembled.
pub fn segment_jets(
    simulator: &Simulator,
    space: &JetSpace,
    about: JetBox<'_>,
    segments: &Segments,
    duration: f64,
) -> Result<Option<(usize, SegmentMotions)>, SimulationError> {
    let Some(program) = simulator.switches() else { return Ok(None) };
    let sample: Sample = about.center.iter().copied().collect();
    let spelled = Spelled::by(Path::start(simulator, program, &sample, duration, segments.following())?, segments);
    let Some(number) = spelled.word else { return Ok(None) };
    let word = &segments.words[number];
    let start = simulator.assemble(1, 0.0, |_| sample.clone())?;
    let mut closure = JetClosure::new(simulator, space, about, &start)?;
    let mut state = closure.start(simulator, space, about)?;
    let mut watch = JetWatch::new(program, space, &closure);
    let zero = vec![0.0; space.len()];
    let pace = Pace { begin: zero.clone(), length: zero.clone() };
    let mut motion = StretchedJet { closure, space, pace, product: zero.clone() };
    let mut run: Box<dyn MotionSteps<StretchedJet>> = match segments.method {
        SegmentMethod::Scheme { levels } => {
            Box::new(SchemeSteps::of_jet(simulator, space, about, &start, motion.closure.memory(), levels))
        }
        _ => Box::new(RungeKutta::start(&mut motion, 0.0, state.clone())),
    };
    let mut motions = SegmentMotions {
        samples: (0..space.len()).collect(),
        steps: word.steps.clone(),
        times: vec![zero.clone()],
        nodes: Vec::new(),
    };
    for (segment, steps) in word.steps.iter().enumerate() {
        space.constant(spelled.lengths[segment], &mut motion.pace.length);
        let event = word.events.get(segment);
        if let (None, Some(tail)) = (event, word.tail) {
            motion.pace.length.iter_mut().zip(&motion.pace.begin).for_each(|(length, begin)| *length = -begin);
            motion.pace.length[0] += tail;
        }
        let ends_at_event = event.is_some();
        let mut nodes = nodes::pass(&mut *run, &mut motion, &state, steps, ends_at_event);
        let mut is_solved = event.is_none();
        let mut is_known = is_solved;
        for _ in 0..TUNING.corrections_of_instant {
            let Some(event) = event.filter(|_| !is_solved) else { break };
            let change = watch.change(&motion.closure, event.switch, TUNING.beyond_event * duration);
            motion.pace.length.iter_mut().zip(&change).for_each(|(length, change)| *length += change);
            nodes = nodes::pass(&mut *run, &mut motion, &state, steps, ends_at_event);
            let (first, others) = (change[0].abs(), change[1..].iter().fold(0.0, |most: f64, own| most.max(own.abs())));
            if first.is_nan() {
                return Ok(None);
            }
            is_solved = first <= TUNING.located * duration && others <= TUNING.rounded_instant * duration;
            // Corrections of an instant end in rounding of the switch, which may be larger.
            is_known = first.max(others) <= TUNING.rounded_instant * duration;
        }
        if !is_known {
            return Ok(None);
        }
        motion.pace.begin.iter_mut().zip(&motion.pace.length).for_each(|(begin, length)| *begin += length);
        if let Some(last) = nodes.last() {
            state.clone_from(last);
        }
        motions.times.push(motion.pace.begin.clone());
        motions.nodes.push(nodes);
    }
    let is_known = motions.nodes.iter().flatten().flatten().all(|value| value.is_finite());
    Ok(is_known.then_some((number, motions)))
}

/// Outputs along the jets of [`segment_jets`] in rows at these times, s: row by row, each output's jet one after the
/// other. `None` where a row is in none of the segments.
///
/// # Errors
/// Where the centre cannot be assembled.
pub fn outputs_of_jets(
    simulator: &Simulator,
    space: &JetSpace,
    about: JetBox<'_>,
    motions: &SegmentMotions,
    times: impl Iterator<Item = f64>,
) -> Result<Option<Vec<f64>>, SimulationError> {
    let sample: Sample = about.center.iter().copied().collect();
    let start = simulator.assemble(1, 0.0, |_| sample.clone())?;
    let mut closure = JetClosure::new(simulator, space, about, &start)?;
    let mut row = vec![0.0; simulator.system.outputs.len() * space.len()];
    let mut outputs = Vec::new();
    for time in times {
        let begun = motions.times.partition_point(|begin| begin[0] <= time);
        let segment = begun.clamp(1, motions.nodes.len()) - 1;
        // The last row may be a little beyond the last segment, by rounding.
        let Some(mut motion) = motions.jet_at(space, segment, time, 0.5) else { return Ok(None) };
        closure.close(time, &mut motion);
        closure.observe(&mut row);
        outputs.extend_from_slice(&row);
    }
    Ok(Some(outputs))
}

/// Values of switches in jets.
struct JetWatch<'s> {
    program: &'s SwitchProgram,
    memory: JetMemory<'s>,
    space: &'s JetSpace,
}

impl<'s> JetWatch<'s> {
    fn new(program: &'s SwitchProgram, space: &'s JetSpace, closure: &JetClosure) -> Self {
        let mut memory = JetMemory::new(space, program.registers(), program.constants());
        for register in program.layout.parameters.clone() {
            memory.jet_mut(register).copy_from_slice(closure.jet(register));
        }
        memory.run(program.sample());
        Self { program, memory, space }
    }

    /// Change of a segment's length that moves its end this long behind the zero of a switch.
    fn change(&mut self, closure: &JetClosure, switch: usize, beyond: f64) -> Vec<f64> {
        let layout = &self.program.layout;
        for register in layout.state().chain([layout.time]) {
            self.memory.jet_mut(register).copy_from_slice(closure.jet(register));
        }
        self.memory.run(self.program.evaluate());
        let switch = &self.program.switches[switch];
        let mut change = vec![f64::NAN; self.space.len()];
        if let Some(rate) = switch.rate {
            self.space.div(self.memory.jet(switch.value), self.memory.jet(rate), &mut change);
        }
        change.iter_mut().for_each(|own| *own = -*own);
        change[0] += beyond;
        change
    }
}
