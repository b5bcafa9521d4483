//! The surrogates of a run, stored after it: outputs at any point of the box, in any row, without simulation.
//!
//! Nothing is stored unless [`run_keeping`](super::run_keeping) is asked. It stores coefficients and the compiled
//! mechanism, from which [`Kept::evaluator`] compiles the loop closures that determine the outputs from expanded
//! coordinates.

use std::borrow::Cow;

use crate::study::ensemble::closure::MotionClosure;
use crate::study::reduced::{KeptReduced, Margins, MarginsOfPart, ReducedValues};

use super::tuning::TUNING;
use crate::methods::{self, KeptSurrogate};
use crate::numerics::{BandError, Points, SparseBasis};
use crate::reduce::Subsystem;
use crate::simulate::{SimulationError, Simulator};

/// A subsystem's surrogate.
#[derive(Clone, Debug)]
pub struct KeptPart {
    pub simulator: Simulator,
    pub surrogate: KeptSurrogate,
    /// Errors of the values, by output.
    pub errors: Vec<BandError>,
    /// Output times, s.
    pub times: Vec<f64>,
    /// Reduced outputs and margins, if the model has some.
    pub reduced: Option<KeptReduced>,
}

/// The surrogates of all subsystems of a run.
#[derive(Clone, Debug)]
pub struct Kept {
    parts: Vec<Placed>,
    /// By output of the model: its subsystem, and its number there.
    indices: Vec<(usize, usize)>,
    times: Vec<f64>,
}

/// A subsystem's surrogate among the whole model's parameters.
#[derive(Clone, Debug)]
struct Placed {
    part: KeptPart,
    /// Numbers of its uncertain parameters among those of the model.
    parameters: Vec<usize>,
    /// Numbers of its reduced outputs in the model.
    reduced: Vec<usize>,
    /// Numbers of its requirements in the model.
    requirements: Vec<usize>,
}

/// Evaluates the stored surrogate of a run.
pub struct Evaluator<'k> {
    kept: &'k Kept,
    /// By subsystem, for each choice of independent coordinates.
    closures: Vec<Vec<Box<dyn methods::Closure + 'k>>>,
}

impl KeptPart {
    /// The loop closures through which its outputs follow.
    pub fn closures(&self) -> Result<Vec<Box<dyn methods::Closure + '_>>, SimulationError> {
        let closure = |independent: Vec<usize>| -> Result<Box<dyn methods::Closure + '_>, SimulationError> {
            Ok(Box::new(MotionClosure::new(&self.simulator, independent)?))
        };
        self.surrogate.independent().into_iter().map(closure).collect()
    }
}

impl Placed {
    fn margins(&self) -> Option<MarginsOfPart<'_>> {
        let kept = self.part.reduced.as_ref()?;
        let Self { parameters, reduced, requirements, .. } = self;
        let (kept, requirements) = (Cow::Borrowed(kept), Cow::Borrowed(&requirements[..]));
        Some(MarginsOfPart { kept, parameters, reduced, requirements })
    }
}

impl Kept {
    /// Surrogates of all subsystems of a model with `outputs` outputs.
    pub(in crate::study) fn of_parts(parts: Vec<(KeptPart, &Subsystem)>, outputs: usize) -> Self {
        let mut indices = vec![(0, 0); outputs];
        for (number, (_, subsystem)) in parts.iter().enumerate() {
            subsystem.outputs.iter().enumerate().for_each(|(index, &output)| indices[output] = (number, index));
        }
        // Further outputs that an analysis of one system adds.
        if let [(part, _)] = parts.as_slice() {
            indices.extend((outputs..part.errors.len()).map(|index| (0, index)));
        }
        let shortest = parts.iter().map(|(part, _)| &part.times).min_by_key(|times| times.len());
        let times = shortest.cloned().unwrap_or_default();
        let placed = |(part, Subsystem { parameters, requirements, reduced, .. }): (KeptPart, &Subsystem)| Placed {
            part,
            parameters: parameters.clone(),
            reduced: reduced.clone(),
            requirements: requirements.clone(),
        };
        Self { parts: parts.into_iter().map(placed).collect(), indices, times }
    }

    /// Output times, s, up to the last row that all samples of all subsystems have reached.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Errors of an output's values, in each row, anywhere in the box, and rows in which they cannot be relied on.
    pub fn error(&self, output: usize) -> &BandError {
        let (part, index) = self.indices[output];
        &self.parts[part].part.errors[index]
    }

    /// Whether values of the first `outputs` outputs, and all reduced outputs and margins, are within the tolerance.
    pub fn is_resolved(&self, outputs: usize) -> bool {
        let mut reduced = self.parts.iter().filter_map(|placed| placed.part.reduced.as_ref());
        (0..outputs).all(|output| !self.error(output).unresolved.contains(&true))
            && reduced.all(KeptReduced::is_resolved)
    }

    /// Whether some values are of motions that are cut at events.
    pub fn is_cut(&self) -> bool {
        self.parts.iter().any(|placed| placed.part.surrogate.is_cut())
    }

    /// Numbers of the uncertain parameters on which an output may depend.
    pub fn parameters(&self, output: usize) -> &[usize] {
        &self.parts[self.indices[output].0].parameters
    }

    /// Whether an output is one polynomial of the parameters over the whole box in a row: then it takes nanoseconds,
    /// else a loop closure.
    pub fn is_polynomial(&self, row: usize, output: usize) -> bool {
        let (part, index) = self.indices[output];
        self.parts[part].part.surrogate.is_polynomial(row, index)
    }

    /// The polynomial through an output's own samples in a row: its terms in ξ ∈ \[−1, 1\] of
    /// [`parameters`](Self::parameters), and the coefficients before them. `None` if the box was split.
    pub fn polynomial(&self, row: usize, output: usize) -> Option<(&SparseBasis, &[f64])> {
        let (part, index) = self.indices[output];
        self.parts[part].part.surrogate.polynomial(row, index)
    }

    /// Values of the polynomial through an output's own samples in a row, at samples of the model's box. `None` where
    /// the box was split.
    pub fn own_values(&self, row: usize, output: usize, samples: Points) -> Option<Vec<f64>> {
        let (number, index) = self.indices[output];
        let Placed { part, parameters, .. } = &self.parts[number];
        part.surrogate.own_values(row, &[index], samples.coordinates(parameters).points())
    }

    /// Margins of all requirements. `None` if the model has none, or one of them is not known.
    pub fn margins(&self) -> Option<Margins<'_>> {
        let asked = self.parts.iter().filter(|placed| !placed.requirements.is_empty());
        Margins::of(asked.map(Placed::margins).collect::<Option<Vec<_>>>()?).filter(|margins| margins.count() > 0)
    }

    /// All `count` reduced outputs. `None` if there are none, or one of them is not known.
    pub fn reduced(&self, count: usize) -> Option<ReducedValues<'_>> {
        let asked = self.parts.iter().filter(|placed| !placed.reduced.is_empty());
        ReducedValues::of(asked.map(Placed::margins).collect::<Option<Vec<_>>>()?, count).filter(|_| count > 0)
    }

    /// Whether equations of motion switch.
    pub fn switches(&self) -> bool {
        self.parts.iter().any(|placed| placed.part.simulator.switches().is_some())
    }

    /// Number of outputs: the model's, and those that an analysis adds.
    pub fn outputs(&self) -> usize {
        self.indices.len()
    }

    /// Name and unit of an output.
    pub fn named(&self, output: usize) -> (&str, &str) {
        let (part, index) = self.indices[output];
        let own = &self.parts[part].part.simulator.system.outputs[index];
        (&own.name, &own.unit)
    }

    /// Prepares evaluation: compiles the loop closures that outputs need.
    ///
    /// # Errors
    /// If a closure's equations have no finite values at the start.
    pub fn evaluator(&self) -> Result<Evaluator<'_>, SimulationError> {
        let closures = self.parts.iter().map(|placed| placed.part.closures()).collect::<Result<_, _>>()?;
        Ok(Evaluator { kept: self, closures })
    }
}

impl Evaluator<'_> {
    /// Outputs in one row at samples of the model's box (values of all its uncertain parameters, in their units),
    /// output by output, sample by sample; NaN if a closure has no solution. In parallel, with the same bits for any
    /// number of threads.
    pub fn values(&self, row: usize, outputs: &[usize], samples: Points) -> Vec<f64> {
        samples.lines(TUNING.samples_at_once, outputs.len(), &|samples| self.values_of_chunk(row, outputs, samples))
    }

    fn values_of_chunk(&self, row: usize, outputs: &[usize], samples: Points) -> Vec<f64> {
        let mut values = vec![f64::NAN; outputs.len() * samples.len()];
        for (number, (Placed { part, parameters, .. }, closures)) in
            self.kept.parts.iter().zip(&self.closures).enumerate()
        {
            let asked = |index: &usize| self.kept.indices[outputs[*index]].0 == number;
            let indices: Vec<usize> = (0..outputs.len()).filter(asked).collect();
            if indices.is_empty() {
                continue;
            }
            let own = samples.coordinates(parameters);
            let of_part: Vec<usize> = indices.iter().map(|&index| self.kept.indices[outputs[index]].1).collect();
            let found = part.surrogate.values(row, &of_part, own.points(), closures);
            for (&index, found) in indices.iter().zip(found.chunks_exact(samples.len().max(1))) {
                values[index * samples.len()..][..samples.len()].copy_from_slice(found);
            }
        }
        values
    }
}
