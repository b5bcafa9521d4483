//! Compiled and omitted parts of a model: the facts behind `mbint explain`.

use serde::Serialize;

use super::Decision;
use super::effect_cost::EffectCost;

/// Result of compiling a model. Plain data: serialised as it stands, shown as text by the command line.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Explanation {
    /// The model's name.
    pub model: String,
    /// Number of dimensions and reason: `planar: nothing leaves the plane`.
    pub space: String,
    /// Analysis, unless it is a motion: `statics: …`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub analysis: Option<String>,
    /// Formulation and reason: `joint coordinates: 148 instructions a step instead of 187`.
    pub formulation: String,
    /// Coordinates by name, e.g. `crank.angle`, in the order of the unknowns.
    pub coordinates: Vec<String>,
    /// Constraint equations by name, e.g. `pin.x`.
    pub constraints: Vec<String>,
    /// Coordinates less independent constraints.
    pub degrees_of_freedom: usize,
    /// Names of constraints that others imply.
    pub redundant_constraints: Vec<String>,
    /// Names of constraints that depend on others at the start only: it is a singular configuration.
    pub singular_at_start: Vec<String>,
    /// Coordinates that share the freedom which the model leaves at the start.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub shared_start: Vec<String>,
    /// Outputs that hang on reactions which equilibrium does not determine.
    pub undetermined_outputs: Vec<String>,
    /// Uncertain parameters; the others were folded into the instructions as numbers.
    pub parameters: Vec<String>,
    /// Forces and torques, in file order.
    pub effects: Vec<EffectExplanation>,
    /// Outputs by name.
    pub outputs: Vec<String>,
    /// Instructions by part; if effects act only sometimes, with all of them active.
    pub instructions: InstructionCounts,
    /// Instructions while none of them acts in any sample of a tile, if that is less.
    pub inactive: Option<InstructionCounts>,
    /// The matrix of Newton's method.
    pub newton: NewtonMatrix,
    /// Parts of the model that the program does not contain.
    pub left_out: Vec<LeftOut>,
    /// Omitted or less frequent computations.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub decisions: Vec<Decision>,
}

/// An effect in the compiled program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EffectExplanation {
    /// Its name in the model.
    pub name: String,
    /// E.g. `spring_damper`.
    pub kind: String,
    /// Generalized forces that it adds to.
    pub forces: usize,
    /// Nodes of its expressions, before they are shared with others.
    pub expressions: usize,
    /// Instructions that it adds to a step, if requested.
    pub adds: Option<EffectCost>,
}

/// Instructions by how often they are run, seldom to often.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct InstructionCounts {
    /// Once a sample: values that depend on parameters alone.
    pub sample: usize,
    /// Once a step size: values that depend on h and α.
    pub step_size: usize,
    /// Once a step: prediction, and values that depend on t.
    pub step: usize,
    /// Once a step, and again where Newton's iteration needs it: the matrix and its factors.
    pub factor: usize,
    /// After a factorisation, at its iterate: residual and substitution, with the values that both need.
    pub first_correction: usize,
    /// Once a further Newton iteration: residual and substitution.
    pub correct: usize,
    /// Once a step, at its end.
    pub advance: usize,
    /// Once a row of output.
    pub observe: usize,
}

impl InstructionCounts {
    /// Stages by name, with when they run and how many instructions they have.
    pub fn stages(&self) -> [(&'static str, &'static str, usize); 8] {
        [
            ("sample", "once a sample", self.sample),
            ("step size", "once a step size", self.step_size),
            ("step", "once a step", self.step),
            ("factor", "when the Newton matrix is factored", self.factor),
            ("first correction", "right after a factorisation", self.first_correction),
            ("correct", "every further Newton iteration", self.correct),
            ("advance", "once a step, at its end", self.advance),
            ("observe", "once a row of output", self.observe),
        ]
    }
}

/// The matrix of Newton's method, its factors and their pivots.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct NewtonMatrix {
    /// Rows, coordinates and constraints together.
    pub size: usize,
    /// Entries that are not always zero.
    pub nonzeros: usize,
    /// Entries of L and U together, the diagonal once.
    pub factor_nonzeros: usize,
    /// Entries of the factors that the matrix does not have.
    pub fill: usize,
    /// (row, column) in the order of elimination, counted from 0.
    pub pivots: Vec<(usize, usize)>,
}

/// A part of the model that the program does not contain.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// E.g. `parameter k2`.
    pub what: String,
    /// E.g. `nothing depends on it`.
    pub why: String,
}
