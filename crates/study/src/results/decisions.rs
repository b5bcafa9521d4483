//! Omitted or less frequent computations: each decision with its reason and its saving.

use serde::Serialize;

/// Something that a model's simulation does without.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Decision {
    /// E.g. `bodies of joint grip are one`.
    pub what: String,
    /// E.g. `no output asks for its reaction`.
    pub why: String,
    /// Absent if it was not counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub saves: Option<Saving>,
}

/// Instructions that need not be run, as compiling with and without the decision counts them; negative if it costs
/// some.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Saving {
    /// Number of instructions.
    pub instructions: i64,
    /// Frequency of the instructions.
    pub each: Each,
}

/// Frequency of instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Each {
    /// A step of one sample, with one correction.
    Step,
    /// A step of all samples that the bounds ask for.
    StepOfAllSamples,
    /// A row of output.
    Row,
}

impl Saving {
    /// For people.
    pub fn text(self) -> String {
        let each = match self.each {
            Each::Step => "a step",
            Each::StepOfAllSamples => "a step of all samples",
            Each::Row => "a row of output",
        };
        let (count, verb) = (self.instructions.unsigned_abs(), if self.instructions < 0 { "costs" } else { "saves" });
        format!("{verb} {count} {} {each}", if count == 1 { "instruction" } else { "instructions" })
    }
}
