//! Which tolerance matters: Sobol indices of every parameter for every output, row by row.

use super::composition::Row;
use super::range_search::intervals;
use crate::methods::result::Sensitivity;
use crate::numerics::{Extent, ParameterBox, Range, SobolDecomposition, Surrogate, SurrogateWork, extremes};

/// Degree of the polynomials whose variance is decomposed, by the number of parameters: those of the outputs, which follow from
/// the coordinates' at any number of points. For more parameters it is the surrogate's own basis.
const DEGREES: [usize; 3] = [24, 12, 8];

/// Widths without a parameter are known to this share of the whole: nothing hangs on them but the order of the parameters.
const RESOLVED: f64 = 1e-3;

/// What is the same in all rows.
pub(super) struct SensitivityAnalysis {
    /// ξ of the nominal parameters.
    nominal: Vec<f64>,
    fine: Option<(Surrogate, SobolDecomposition)>,
    own: SobolDecomposition,
    /// Whether any interval is wider than its rounding: else all that varies is rounding.
    varies: bool,
}

impl SensitivityAnalysis {
    /// For outputs that are composed from a surrogate over a box.
    pub fn new(domain: &ParameterBox, surrogate: &Surrogate) -> Self {
        let k = domain.dimension();
        let fine = k.checked_sub(1).and_then(|place| DEGREES.get(place)).map(|&degree| {
            let fine = Surrogate::tensor(&vec![degree; k], &vec![degree + 1; k]);
            let decomposition = SobolDecomposition::new(fine.basis());
            (fine, decomposition)
        });
        let nominal = domain.xi(&domain.nominal).into_iter().map(|xi| xi.clamp(-1.0, 1.0)).collect();
        let varies = (0..k).any(|axis| domain.half_width(axis) > f64::EPSILON * domain.midpoint(axis).abs());
        Self { nominal, fine, own: SobolDecomposition::new(surrogate.basis()), varies }
    }

    /// Sensitivities of every output, whose ranges are known.
    pub fn of_row(&self, row: &Row, found: &[Extent]) -> Vec<Sensitivity> {
        let (surrogate, decomposition) = match &self.fine {
            Some((fine, decomposition)) => (fine, decomposition),
            None => (row.surrogate(), &self.own),
        };
        let coefficients = surrogate.coefficients(&row.evaluate(surrogate.samples()), &mut SurrogateWork::default());
        let k = self.nominal.len();
        let widths: Vec<Vec<f64>> = (0..k).map(|axis| self.widths_without(row, found, axis)).collect();
        let of_output = |(output, coefficients): (usize, &[f64])| {
            let (main, total) = match decomposition.indices(coefficients).filter(|_| self.varies) {
                Some(indices) => (indices.main, indices.total),
                // Nothing varies.
                None => (vec![0.0; k], vec![0.0; k]),
            };
            Sensitivity { main, total, width_without: widths.iter().map(|widths| widths[output]).collect() }
        };
        coefficients.chunks_exact(surrogate.basis().len()).enumerate().map(of_output).collect()
    }

    /// Every output's width with one parameter at its nominal value. For many parameters, as far as the places of the extremes
    /// tell, which is all there is to know of an output that rises or falls with each.
    fn widths_without(&self, row: &Row, found: &[Extent], axis: usize) -> Vec<f64> {
        if self.fine.is_some() {
            let insert = |xi: &Vec<f64>| [&xi[..axis], &[self.nominal[axis]], &xi[axis..]].concat();
            let evaluate = |points: &[Vec<f64>]| row.evaluate(&points.iter().map(insert).collect::<Vec<_>>());
            let others: Vec<usize> = (0..self.nominal.len()).filter(|&other| other != axis).collect();
            let resolved: Vec<f64> = found.iter().map(|found| RESOLVED * found.range.width()).collect();
            let ranges = extremes(&intervals(row.degrees(), &others, false), &resolved, evaluate);
            return ranges.into_iter().map(|found| found.range.width()).collect();
        }
        let replaced = |place: &Vec<f64>| {
            let mut place = place.clone();
            place[axis] = self.nominal[axis];
            place
        };
        let points: Vec<Vec<f64>> = found.iter().flat_map(|found| found.places.iter().map(replaced)).collect();
        let values = row.evaluate(&points);
        values.chunks_exact(points.len()).map(|line| Range::of(line).width()).collect()
    }
}
