//! The states between the steps of a tile, which are needed backwards: all of them where there is room, else those
//! after every so many steps, from which the others are computed once more.

/// Room for the states of a tile, bytes.
const ROOM: usize = 32 << 20;

/// A tile that takes steps.
pub(in crate::simulate) trait Stepping {
    /// Its state.
    fn state(&self) -> &[f64];

    /// Goes on before a step from a state that it had there.
    fn restore(&mut self, step: usize, state: &[f64]);

    /// Takes a step. The state before it changed at the step's end, where it does.
    fn advance(&mut self, step: usize) -> Option<Vec<f64>>;
}

/// A state between two steps.
#[derive(Clone, Debug)]
struct Between {
    state: Vec<f64>,
    /// Before it changed at the instant.
    unchanged: Option<Vec<f64>>,
}

/// The path of a tile.
#[derive(Debug)]
pub(in crate::simulate) struct Path<S> {
    stepping: S,
    steps: usize,
    /// Steps between states that are kept.
    every: usize,
    kept: Vec<Vec<f64>>,
    /// The states from this one on.
    first: usize,
    window: Vec<Between>,
}

impl<S: Stepping> Path<S> {
    /// Takes all steps; `visit` gets every state with the number of steps before it.
    pub fn new(stepping: S, steps: usize, visit: &mut dyn FnMut(usize, &[f64])) -> Self {
        let of_one = size_of_val(stepping.state()).max(1);
        let every = if (steps + 1) * of_one <= ROOM { steps.max(1) } else { steps.isqrt() + 1 };
        let mut path = Self { stepping, steps, every, kept: Vec::new(), first: 0, window: Vec::new() };
        visit(0, path.stepping.state());
        for first in (0..steps.max(1)).step_by(every) {
            path.kept.push(path.stepping.state().to_vec());
            path.fill(first, visit);
        }
        path
    }

    /// What takes the steps.
    pub fn stepping(&self) -> &S {
        &self.stepping
    }

    /// Number of steps.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// From the state that the tile has, before the step `first`, to the next that is kept.
    fn fill(&mut self, first: usize, visit: &mut dyn FnMut(usize, &[f64])) {
        self.first = first;
        self.window.clear();
        self.window.push(Between { state: self.stepping.state().to_vec(), unchanged: None });
        for step in first..(first + self.every).min(self.steps) {
            let unchanged = self.stepping.advance(step);
            visit(step + 1, self.stepping.state());
            self.window.push(Between { state: self.stepping.state().to_vec(), unchanged });
        }
    }

    /// The state before a step, the one after it, and that before it changed at an instant, where it did.
    pub fn around(&mut self, step: usize) -> (&[f64], &[f64], Option<&[f64]>) {
        if step < self.first || step + 1 >= self.first + self.window.len() {
            let number = step / self.every;
            let state = std::mem::take(&mut self.kept[number]);
            self.stepping.restore(number * self.every, &state);
            self.kept[number] = state;
            self.fill(number * self.every, &mut |_, _| {});
        }
        let [before, after] = [step, step + 1].map(|step| &self.window[step - self.first]);
        (&before.state, &after.state, after.unchanged.as_deref())
    }

    /// The state at the start.
    pub fn start(&self) -> &[f64] {
        &self.kept[0]
    }
}
