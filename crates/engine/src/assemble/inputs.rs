//! Inputs: excitations that are functions of the time, u(t) = level + slope · t over a cell of the time.

use symdiff::{Builder, Expr, Scalar};

use super::questions::Questions;

/// An excitation as a function.
#[derive(Clone, Copy, Debug)]
pub struct InputInfo {
    /// Index of its trajectory in the model.
    pub trajectory: usize,
    /// Symbols of the level and of the slope, 1/s. The value of a function that jumps has no slope.
    pub symbols: [Expr; 2],
}

/// An input of a mechanism.
#[derive(Clone, Copy)]
pub struct MechanismInput<'g> {
    /// Index of its trajectory in the model.
    pub trajectory: usize,
    numbers: [Scalar<'g>; 2],
    /// u(t).
    pub value: Scalar<'g>,
}

impl MechanismInput<'_> {
    /// Its symbols.
    pub fn info(&self) -> InputInfo {
        InputInfo { trajectory: self.trajectory, symbols: self.numbers.map(Scalar::expr) }
    }
}

/// Inputs of all excitations, where the questions ask for functions.
pub fn inputs<'g>(g: &'g Builder, questions: &Questions, time: Scalar<'g>) -> Vec<MechanismInput<'g>> {
    let trajectories = questions.description.trajectories.iter().enumerate();
    let excited = trajectories.filter(|_| questions.as_functions).filter_map(|(index, own)| {
        let excitation = own.excitation()?;
        let numbers = ["level", "slope"].map(|part| g.variable(&format!("u:{}.{part}", own.name)));
        let [level, slope] = numbers;
        let value = if excitation.class.jumps() { level } else { level + slope * time };
        Some(MechanismInput { trajectory: index, numbers, value })
    });
    excited.collect()
}
