//! An ensemble without coordinates: outputs that cannot be composed are expanded themselves, also to a degree that a
//! tolerance asks for.

use std::ops::Range as Rows;

use symdiff::jet::JetSpace;
use symdiff::taylor_model::ModelSpace;

use crate::methods::closure::Closure;
use crate::methods::ensemble::{Combination, Ensemble, EnsembleError, Observed, Sampling, Simulated};
use crate::methods::proof::{EnclosedRow, EnclosureEnd, Proof};
use crate::numerics::{ParameterBox, Range, Sample};

/// The outputs of an ensemble, and nothing that they follow from.
pub(super) struct OutputsAlone<'a>(pub &'a dyn Ensemble);

impl Ensemble for OutputsAlone<'_> {
    fn domain(&self) -> &ParameterBox {
        self.0.domain()
    }

    fn outputs(&self) -> usize {
        self.0.outputs()
    }

    fn rows(&self) -> usize {
        self.0.rows()
    }

    fn time(&self, row: usize) -> f64 {
        self.0.time(row)
    }

    fn rounding(&self, output: usize) -> f64 {
        self.0.rounding(output)
    }

    fn has_kink(&self, output: usize) -> bool {
        self.0.has_kink(output)
    }

    fn jumps(&self, output: usize) -> bool {
        self.0.jumps(output)
    }

    fn combinations(&self) -> Vec<Combination<'_>> {
        self.0.combinations()
    }

    fn seen(&self, row: usize, output: usize) -> Range {
        self.0.seen(row, output)
    }

    fn is_interrupted(&self) -> bool {
        self.0.is_interrupted()
    }

    fn simulate(
        &self,
        samples: &[Sample],
        sampling: Sampling,
        reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
    ) -> Result<Simulated, EnsembleError> {
        self.0.simulate(samples, Sampling { observed: Observed::Outputs, ..sampling }, reduce)
    }

    fn jets(&self, space: &JetSpace, reduce: &mut dyn FnMut(Rows<usize>, &[f64])) -> Result<Simulated, EnsembleError> {
        self.0.jets(space, reduce)
    }

    fn obstacle_to_enclosure(&self, proof: Proof) -> Option<String> {
        self.0.obstacle_to_enclosure(proof)
    }

    fn enclose(&self, proof: Proof, space: &ModelSpace, piece: &ParameterBox, row: &mut EnclosedRow) -> EnclosureEnd {
        self.0.enclose(proof, space, piece, row)
    }

    fn scales(&self) -> &[f64] {
        &[]
    }

    fn independent(&self, _: &[f64], _: &[f64], _: f64) -> Vec<usize> {
        Vec::new()
    }

    fn closure(&self, _: Vec<usize>) -> Result<Box<dyn Closure + '_>, EnsembleError> {
        Ok(Box::new(Nothing { outputs: self.outputs() }))
    }
}

/// A closure without coordinates, from which no output follows.
struct Nothing {
    outputs: usize,
}

impl Closure for Nothing {
    fn independent(&self) -> &[usize] {
        &[]
    }

    fn needs_velocities(&self) -> bool {
        false
    }

    fn outputs(&self, _: f64, count: usize, _: Vec<f64>, _: Vec<f64>) -> Vec<f64> {
        vec![f64::NAN; self.outputs * count]
    }
}
