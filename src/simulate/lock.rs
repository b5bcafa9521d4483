//! Whether a mechanism locks: a constraint then stays open whatever the position.

use super::initial::Assembly;
use super::simulator::Simulator;
use crate::compile::compile_start;

impl Simulator {
    /// The constraint that stays open at a time, and by how much (m or rad), wherever positions are looked for from `state`
    /// (the layout's slots). `None` where all can be closed.
    pub(super) fn stays_open(&self, state: &[f64], time: f64) -> Option<(usize, f64)> {
        // Nothing is kept of the start but the constraints.
        let mut free = self.system.clone();
        free.start.position.fill(None);
        let start = compile_start(&free, &self.mobility.redundant, state).ok()?;
        let layout = &start.layout;
        let parameters = layout.parameters.clone();
        let mut assembly = Assembly::new(&start, &free, 1, |parameter, _| state[parameters.start + parameter]);
        for slot in layout.q.clone() {
            assembly.tile_mut().lane_mut(slot)[0] = state[slot];
        }
        assembly.tile_mut().lane_mut(layout.time)[0] = time;
        assembly.descend().err().map(|gap| (gap.constraint, gap.amount.abs()))
    }
}
