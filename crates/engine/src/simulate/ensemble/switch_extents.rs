//! Ranges of the equations' switches between rows, step by step.

use crate::compile::SwitchProgram;
use crate::simulate::control::SwitchWatch;
use crate::simulate::step::Stepper;

/// Extent before the first step.
const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// The extents of a tile's switches since the last row.
#[derive(Debug)]
pub(super) struct SwitchExtents<'s> {
    watch: SwitchWatch<'s>,
    /// Switch by switch, lane by lane.
    extents: Vec<[f64; 2]>,
    width: usize,
}

impl<'s> SwitchExtents<'s> {
    /// Extents of the samples of a tile.
    pub fn new(program: &'s SwitchProgram, stepper: &Stepper) -> Self {
        let width = stepper.alive().len();
        let extents = vec![NOTHING; program.switches.len() * width];
        Self { watch: SwitchWatch::new(program, stepper.tile()), extents, width }
    }

    /// Evaluates the switches before a step.
    pub fn begin(&mut self, stepper: &Stepper) {
        self.watch.begin(stepper.tile());
    }

    /// Extends the ranges after a step of length h.
    pub fn end(&mut self, stepper: &Stepper, h: f64) {
        self.watch.end(stepper.tile());
        let width = self.width;
        for (index, extent) in self.extents.iter_mut().enumerate() {
            let [low, high] = self.watch.extent(index / width, index % width, h);
            *extent = [extent[0].min(low), extent[1].max(high)];
        }
    }

    /// Least and largest values of switch after switch, lane by lane in both, and begins anew.
    pub fn take(&mut self, into: &mut [f64]) {
        for (switch, into) in self.extents.chunks_exact(self.width).zip(into.chunks_exact_mut(2 * self.width)) {
            for (lane, [low, high]) in switch.iter().enumerate() {
                (into[lane], into[self.width + lane]) = (*low, *high);
            }
        }
        self.extents.fill(NOTHING);
    }
}
