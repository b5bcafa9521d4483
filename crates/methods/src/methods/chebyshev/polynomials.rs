//! Outputs that are polynomials themselves: they are expanded, as in the paper, not composed.

use rayon::prelude::*;

use super::sensitivity::{Predicted, SensitivityAnalysis};
use super::tuning::TUNING;
use crate::methods::ensemble::{Ensemble, EnsembleError, Observed, Sampling, Simulated, Until};
use crate::methods::followed::Sensitivity;
use crate::methods::kept::KeptRow;
use crate::methods::result::{BandBuilder, PolynomialEstimate};
use crate::methods::tuning::TUNING as METHODS;
use crate::methods::validation::Validation;
use crate::numerics::{
    Extent, PointSet, PolynomialRange, Range, Sample, SparseWork, Surrogate, SurrogateWork, corners, truncation,
};

/// Polynomials through the outputs' own samples.
pub(super) struct Polynomials<'a> {
    /// The surrogate through whose samples the polynomials go.
    pub surrogate: &'a Surrogate,
    /// Output by output.
    pub coefficients: &'a [f64],
}

impl Polynomials<'_> {
    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        self.coefficients.len() / self.surrogate.basis().len()
    }

    /// Values of some of them, output by output, point by point.
    pub fn values(&self, outputs: &[usize], points: &[Vec<f64>]) -> Vec<f64> {
        let count = self.surrogate.basis().len();
        let own = |&output: &usize| self.coefficients[output * count..][..count].iter().copied();
        let coefficients: Vec<f64> = outputs.iter().flat_map(own).collect();
        let mut values = vec![0.0; outputs.len() * points.len()];
        let points = PointSet::of(points);
        self.surrogate.basis().values(points.points(), &coefficients, &mut values, &mut SparseWork::default());
        values
    }

    /// Sensitivities, if all values are known; zero for outputs whose range is rounding.
    pub fn sensitivities(&self, analysis: &SensitivityAnalysis, rounding: f64) -> Option<Vec<Sensitivity>> {
        self.coefficients.iter().all(|value| value.is_finite()).then_some(())?;
        let extents = self.extents();
        let mut found = analysis.of_row(self, &extents);
        for (own, extent) in found.iter_mut().zip(&extents) {
            let size = extent.range.lower.abs().max(extent.range.upper.abs());
            if extent.range.width() <= rounding.max(METHODS.rounding_of_width * size) {
                own.main.iter_mut().chain(&mut own.total).for_each(|share| *share = 0.0);
            }
        }
        Some(found)
    }

    /// Extents of the outputs, among the samples and the corners of the box.
    fn extents(&self) -> Vec<Extent> {
        let mut points = self.surrogate.samples().to_vec();
        let k = points.first().map_or(0, Vec::len);
        if k <= TUNING.most_corners {
            points.extend(corners(k, 1 << k));
        }
        let every: Vec<usize> = (0..self.outputs()).collect();
        let of_line = |line: &[f64]| {
            let end = |sign: f64| (0..line.len()).max_by(|&a, &b| (sign * line[a]).total_cmp(&(sign * line[b])));
            let index = |sign: f64| end(sign).map_or_else(|| vec![0.0; k], |index| points[index].clone());
            Extent::at(Range::of(line), 0.0, [index(-1.0), index(1.0)])
        };
        self.values(&every, &points).chunks_exact(points.len()).map(of_line).collect()
    }
}

impl Predicted for Polynomials<'_> {
    fn outputs(&self) -> usize {
        Polynomials::outputs(self)
    }

    fn surrogate(&self) -> &Surrogate {
        self.surrogate
    }

    fn predict_some(&self, outputs: &[usize], points: &[Vec<f64>]) -> Vec<f64> {
        self.values(outputs, points)
    }
}

/// The outputs themselves are expanded.
pub(super) fn expanded(
    ensemble: &dyn Ensemble,
    surrogate: &Surrogate,
    range: PolynomialRange,
    samples: &[Sample],
    validation: &Validation,
    mut kept: Option<&mut Vec<KeptRow>>,
) -> Result<(BandBuilder, Simulated), EnsembleError> {
    let mut bands = BandBuilder::new(ensemble.outputs(), ensemble.rows());
    let sensitivity = SensitivityAnalysis::new(ensemble.domain(), surrogate);
    let rounding: Vec<f64> = (0..ensemble.outputs()).map(|output| ensemble.rounding(output)).collect();
    let kinks: Vec<bool> = (0..ensemble.outputs()).map(|output| ensemble.has_kink(output)).collect();
    let sampling = Sampling { observed: Observed::Outputs, until: Until::FirstStop, whole: false };
    let validation_points = PointSet::of(&validation.points);
    let mut reached = 0;
    let mut simulated = ensemble.simulate(samples, sampling, &mut |rows, values| {
        let keeps = kept.is_some();
        let found: Option<Vec<PolynomialEstimate>> = values
            .par_chunks_exact(samples.len())
            .enumerate()
            .map_init(
                || (range.clone(), SurrogateWork::default(), SparseWork::default()),
                |(range, work, sparse), (line, responses)| {
                    ensemble.go_on().ok()?;
                    let coefficients = surrogate.coefficients(responses, work);
                    let mut at_validation = vec![0.0; validation.points.len()];
                    surrogate.basis().values(validation_points.points(), &coefficients, &mut at_validation, sparse);
                    let enclosed = range.enclose(&coefficients);
                    let truncation = truncation(surrogate.basis(), &coefficients);
                    let (range, excess) = (enclosed.outer, enclosed.excess());
                    let own = Polynomials { surrogate, coefficients: &coefficients };
                    let sensitivity = own
                        .sensitivities(&sensitivity, rounding[line % rounding.len()])
                        .map(|mut found| found.swap_remove(0));
                    let coefficients = if keeps { coefficients } else { Vec::new() };
                    Some(PolynomialEstimate { range, excess, truncation, at_validation, sensitivity, coefficients })
                },
            )
            .collect();
        let Some(mut found) = found else { return };
        reached = rows.end;
        bands.set_polynomials(rows.clone(), &mut found, validation, &kinks);
        if let Some(kept) = &mut kept {
            let lines: Vec<&[f64]> = found.iter().map(|found| found.coefficients.as_slice()).collect();
            let of_rows = rows.zip(lines.chunks_exact(ensemble.outputs().max(1)));
            kept.extend(of_rows.map(|(row, lines)| KeptRow::of_outputs(ensemble.time(row), lines)));
        }
    })?;
    simulated.end_at(reached, ensemble);
    Ok((bands, simulated))
}
