//! States q, v of whatever kind: each of the 2n lines holds values of lanes, or coefficients of a jet.

use super::observed::Observed;

/// Integrated system.
pub(in crate::simulate) trait Motion {
    /// Rates v, w (2n lines) of a state q, v at a time.
    fn rate(&mut self, time: f64, state: &[f64], into: &mut [f64]);

    /// Moves a state onto the constraints.
    fn close(&mut self, time: f64, state: &mut [f64]);

    /// Gives the states that change at instants their new values; returns whether the time is such an instant.
    fn sample(&mut self, time: f64, state: &mut [f64]) -> bool;
}

/// A system whose rows are observed in states that are no step's own.
pub(in crate::simulate) trait RowState: Motion {
    /// Whether the values of a line are one state's, and are lost together.
    const IS_JET: bool;

    /// Values of a line.
    fn width(&self) -> usize;

    /// Outputs (line, value) of the state that was [closed](Motion::close) last.
    fn observe(&mut self, into: &mut [f64]);

    /// Observed values (line, value) of the state that was closed last.
    fn record(&mut self, observed: Observed, state: &[f64], into: &mut [f64]) {
        let own = if observed == Observed::Outputs { 0 } else { state.len() };
        let (before, outputs) = into.split_at_mut(own);
        before.copy_from_slice(&state[..own]);
        self.observe(outputs);
    }
}
