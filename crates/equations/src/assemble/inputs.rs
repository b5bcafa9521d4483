//! Inputs: excitations that are functions of the time, u(t) = level + slope · t over a cell of the time, and random
//! ones of a linearised mechanism.

use symdiff::{Builder, Expr, Scalar};

use super::questions::Questions;
use crate::model::Analysis;
use crate::numerics::Spectrum;

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

/// A random excitation about which a mechanism is linearised: its value is zero, and its effect on the mechanism
/// follows from the derivatives by it.
#[derive(Clone, Debug)]
pub struct RandomInput {
    /// Symbols of its value, rate and acceleration.
    pub symbols: [Expr; 3],
    /// Parameter that chooses the realisation: excitations that share it follow one another.
    pub seed: String,
    /// Level of its density, of parameters.
    pub level: Expr,
    /// Speed at which the density's frequencies are passed, of parameters.
    pub speed: Expr,
    /// Delay, s, of parameters.
    pub delay: Expr,
    /// Density.
    pub spectrum: Spectrum,
    /// Least and largest frequency of the density.
    pub band: [f64; 2],
}

/// Symbols of a random excitation, where the questions are those of a linearised mechanism.
pub struct RandomSymbols<'g> {
    /// Index of its trajectory in the model.
    pub trajectory: usize,
    /// Its value, rate and acceleration.
    pub values: [Scalar<'g>; 3],
}

/// Symbols of all random excitations, where vibrations are asked for.
pub fn random_symbols<'g>(g: &'g Builder, questions: &Questions) -> Vec<RandomSymbols<'g>> {
    if !matches!(questions.description.analysis, Analysis::Modes(_)) {
        return Vec::new();
    }
    let trajectories = questions.description.trajectories.iter().enumerate();
    let random = trajectories.filter(|(_, own)| own.random().is_some()).map(|(trajectory, own)| {
        let values = ["value", "rate", "acceleration"].map(|part| g.variable(&format!("x:{}.{part}", own.name)));
        RandomSymbols { trajectory, values }
    });
    random.collect()
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
