//! The states between the steps of a tile, which are needed backwards: all of them if there is room, else those at a
//! fixed interval of steps, from which the others are computed once more.

use super::tuning::TUNING;

/// A tile that takes steps.
pub(in crate::simulate) trait Stepping {
    /// Its state.
    fn state(&self) -> &[f64];

    /// Restores a state that it had before a step.
    fn restore(&mut self, step: usize, state: &[f64]);

    /// Takes a step. Returns the state before its change at the step's end, if it changed there.
    fn advance(&mut self, step: usize) -> Option<Vec<f64>>;
}

/// The path of a tile.
#[derive(Debug)]
pub(in crate::simulate) struct TilePath<S> {
    stepping: S,
    steps: usize,
    /// Values of a state.
    size: usize,
    /// Steps between stored states.
    every: usize,
    /// Those states, one after the other.
    kept: Vec<f64>,
    /// The states from this one on, one after the other.
    first: usize,
    window: Vec<f64>,
    /// States before they changed at instants, with the number of steps before.
    unchanged: Vec<(usize, Vec<f64>)>,
}

impl<S: Stepping> TilePath<S> {
    /// Takes all steps; `visit` gets every state with the number of steps before it.
    pub fn new(stepping: S, steps: usize, visit: &mut dyn FnMut(usize, &[f64])) -> Self {
        let size = stepping.state().len();
        let of_one = size_of_val(stepping.state()).max(1);
        let every = if (steps + 1) * of_one <= TUNING.path_bytes { steps.max(1) } else { steps.isqrt() + 1 };
        let (kept, window, unchanged) = (Vec::new(), Vec::new(), Vec::new());
        let mut path = Self { stepping, steps, size, every, kept, first: 0, window, unchanged };
        visit(0, path.stepping.state());
        for first in (0..steps.max(1)).step_by(every) {
            path.kept.extend_from_slice(path.stepping.state());
            path.fill(first, visit);
        }
        path
    }

    /// The tile that takes the steps.
    pub fn stepping(&self) -> &S {
        &self.stepping
    }

    /// Number of steps.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Takes steps from the tile's state, before the step `first`, to the next stored state.
    fn fill(&mut self, first: usize, visit: &mut dyn FnMut(usize, &[f64])) {
        self.first = first;
        self.window.clear();
        self.unchanged.clear();
        self.window.extend_from_slice(self.stepping.state());
        for step in first..(first + self.every).min(self.steps) {
            let unchanged = self.stepping.advance(step);
            visit(step + 1, self.stepping.state());
            self.window.extend_from_slice(self.stepping.state());
            self.unchanged.extend(unchanged.map(|state| (step + 1, state)));
        }
    }

    /// The state before a step, the one after it, and that before it changed at an instant, where it did.
    pub fn around(&mut self, step: usize) -> (&[f64], &[f64], Option<&[f64]>) {
        if step < self.first || (step + 2 - self.first) * self.size > self.window.len() {
            let number = step / self.every;
            self.stepping.restore(number * self.every, &self.kept[number * self.size..][..self.size]);
            self.fill(number * self.every, &mut |_, _| {});
        }
        let both = &self.window[(step - self.first) * self.size..][..2 * self.size];
        let unchanged = self.unchanged.iter().find(|(before, _)| *before == step + 1);
        (&both[..self.size], &both[self.size..], unchanged.map(|(_, state)| state.as_slice()))
    }

    /// The state at the start.
    pub fn start(&self) -> &[f64] {
        &self.kept[..self.size]
    }
}
