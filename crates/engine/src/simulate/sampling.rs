//! States that change at instants, as those of digital controllers do.
//!
//! Steps end at the instants. There the states take their new values, and accelerations and multipliers those that
//! follow: the next step begins with the forces after the jump, so jumps cost no order.

use symdiff::Tile;

use super::control::Schedule;
use super::simulator::Simulator;
use super::start::Assembly;
use super::step::Stepper;
use crate::compile::SampledValue;

/// The instants of all states that change at some.
#[derive(Clone, Copy, Debug)]
pub(in crate::simulate) struct Instants<'s>(&'s [SampledValue]);

impl<'s> Instants<'s> {
    /// The instants of a mechanism.
    pub fn of(simulator: &'s Simulator) -> Self {
        Self(&simulator.start.sampled)
    }

    /// The instants of these states.
    pub fn at(sampled: &'s [SampledValue]) -> Self {
        Self(sampled)
    }

    /// Whether there are none.
    pub fn is_empty(self) -> bool {
        self.0.is_empty()
    }

    /// Whether a time is one.
    pub fn contain(self, time: f64) -> bool {
        self.0.iter().any(|sampled| sampled.is_due(time))
    }

    /// The first after a time and before another.
    pub fn between(self, from: f64, to: f64) -> Option<f64> {
        self.0.iter().filter_map(|sampled| sampled.due_between(from, to)).reduce(f64::min)
    }

    /// The steps of a schedule that lead to a row, divided at the instants in them: length and end of each, s.
    pub fn steps_to(self, row: usize, schedule: &Schedule) -> impl Iterator<Item = (f64, f64)> {
        schedule.steps_to(row).flat_map(move |(h, end)| self.divide(h, end))
    }

    /// A step of length h, divided at the instants in it: length and end of each part, s.
    pub fn divide(self, h: f64, end: f64) -> impl Iterator<Item = (f64, f64)> + use<'s> {
        let mut from = Some(end - h);
        std::iter::from_fn(move || {
            let begin = from?;
            from = self.between(begin, end);
            Some(match from {
                Some(instant) => (instant - begin, instant),
                // An undivided step keeps its length, to the bit.
                None if begin == end - h => (h, end),
                None => (end - begin, end),
            })
        })
    }
}

/// Lets the states of a tile's samples change.
#[derive(Debug)]
pub(in crate::simulate) struct Sampling<'s> {
    simulator: &'s Simulator,
    assembly: Assembly<'s>,
}

impl<'s> Sampling<'s> {
    /// Sampling of an assembled tile; `None` if no state changes at instants.
    pub fn new(simulator: &'s Simulator, start: &Tile) -> Option<Self> {
        if Instants::of(simulator).is_empty() {
            return None;
        }
        let parameters = simulator.start.layout.parameters.start;
        let parameter = |parameter: usize, lane: usize| start.lane(parameters + parameter)[lane];
        let assembly = Assembly::new(&simulator.start, &simulator.system, start.width(), parameter);
        Some(Self { simulator, assembly })
    }

    /// Samples at the end of a step; returns whether it is an instant.
    pub fn end(&mut self, stepper: &mut Stepper, time: f64) -> bool {
        if !Instants::of(self.simulator).contain(time) {
            return false;
        }
        let layout = &self.simulator.start.layout;
        let width = stepper.tile().width();
        let state = layout.q.start * width..layout.lambda.end * width;
        let tile = self.assembly.tile_mut();
        tile.values_mut()[state.clone()].copy_from_slice(&stepper.tile().values()[state]);
        layout.set_inputs(tile, stepper.tile().block(layout.inputs.clone()));
        tile.lane_mut(layout.time).fill(time);
        self.assembly.sample();
        self.assembly.accelerate();
        self.assembly.shift_accelerations(self.simulator.program.coefficients.shift() * stepper.step_size());
        stepper.begin_anew(self.assembly.tile());
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn divided(periods: &[f64], h: f64, end: f64) -> Vec<(f64, f64)> {
        let sampled: Vec<SampledValue> =
            periods.iter().map(|&period| SampledValue { state: 0, value: 0, period }).collect();
        Instants(&sampled).divide(h, end).collect()
    }

    #[test]
    fn steps_are_divided_only_at_instants_within_them() {
        assert_eq!(divided(&[], 0.1, 0.7), [(0.1, 0.7)]);
        // Ends and beginnings may be off by rounding.
        assert_eq!(divided(&[0.1], 0.1, 0.1 + 0.2), [(0.1, 0.1 + 0.2)]);
        assert_eq!(divided(&[0.1, 0.05], 0.1, 1e3).len(), 2);
        let parts = divided(&[0.3, 0.25], 1.0, 1.0);
        let ends: Vec<f64> = parts.iter().map(|&(_, end)| end).collect();
        assert_eq!(ends.len(), 7);
        for (end, expected) in ends.iter().zip([0.25, 0.3, 0.5, 0.6, 0.75, 0.9, 1.0]) {
            assert!((end - expected).abs() < 1e-15, "{ends:?}");
        }
    }

    #[test]
    fn parts_of_a_step_add_up_to_the_step() {
        for (periods, h, end) in [(&[0.3, 0.25][..], 1.0, 1.0), (&[0.007], 0.02, 12.345), (&[1.0], 0.5, 0.5)] {
            let parts = divided(periods, h, end);
            assert_eq!(parts.last().unwrap().1, end);
            assert!((parts.iter().map(|&(h, _)| h).sum::<f64>() - h).abs() < 1e-14);
            assert!(parts.iter().all(|&(h, _)| h > 0.0));
        }
    }
}
