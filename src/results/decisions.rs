//! What is not computed, or less often than it might be: each decision with its reason and what it saves.

use serde::Serialize;

use super::{Explanation, LeftOut};

/// Something that a model's simulation does without.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Decision {
    /// E.g. `bodies of joint grip are one`.
    pub what: String,
    /// E.g. `no output asks for its reaction`.
    pub why: String,
    /// Absent where it was not counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub saves: Option<Saving>,
}

/// Instructions that need not be run, as compiling with and without the decision counts them; negative where it costs some.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Saving {
    #[allow(missing_docs)]
    pub instructions: i64,
    /// How often they would be run.
    pub each: Each,
}

/// How often instructions are run.
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

impl Explanation {
    /// Of a model whose parts move on their own: theirs together.
    ///
    /// # Panics
    /// Without any.
    pub fn of_islands(islands: Vec<Self>) -> Self {
        // A model has at least one: `reduce` sees to it.
        islands.into_iter().reduce(Self::and).expect("a model has an island")
    }

    fn and(mut self, other: Self) -> Self {
        for (line, more) in [(&mut self.space, other.space), (&mut self.formulation, other.formulation)] {
            if line.split("; ").all(|known| known != more) {
                *line += &format!("; {more}");
            }
        }
        self.coordinates.extend(other.coordinates);
        self.constraints.extend(other.constraints);
        self.degrees_of_freedom += other.degrees_of_freedom;
        self.redundant_constraints.extend(other.redundant_constraints);
        self.singular_at_start.extend(other.singular_at_start);
        self.undetermined_outputs.extend(other.undetermined_outputs);
        for parameter in other.parameters {
            if !self.parameters.contains(&parameter) {
                self.parameters.push(parameter);
            }
        }
        for effect in other.effects {
            match self.effects.iter_mut().find(|known| known.name == effect.name) {
                // Gravity acts in every island.
                Some(known) => {
                    known.forces += effect.forces;
                    known.expressions += effect.expressions;
                    known.adds = known.adds.take().zip(effect.adds).map(|(ours, theirs)| ours.and(theirs));
                }
                None => self.effects.push(effect),
            }
        }
        self.outputs.extend(other.outputs);
        if self.apart.is_some() || other.apart.is_some() {
            let apart = self.apart.get_or_insert_with(|| self.instructions.clone());
            apart.add(other.apart.as_ref().unwrap_or(&other.instructions));
        }
        self.instructions.add(&other.instructions);
        // The islands' matrices are blocks on one diagonal.
        let (ours, theirs) = (&mut self.newton, other.newton);
        let first = ours.size;
        ours.pivots.extend(theirs.pivots.into_iter().map(|(row, column)| (first + row, first + column)));
        ours.size += theirs.size;
        ours.nonzeros += theirs.nonzeros;
        ours.factor_nonzeros += theirs.factor_nonzeros;
        ours.fill += theirs.fill;
        let new = |item: &LeftOut| !self.left_out.contains(item);
        let more: Vec<LeftOut> = other.left_out.into_iter().filter(new).collect();
        self.left_out.extend(more);
        self
    }
}
