//! Sobol indices of every parameter for every output, row by row: they show which tolerance matters.

use std::f64::consts::PI;

use symdiff::math;

use super::combined::Combined;
use super::composition::Row;
use super::range_search::block;
use super::tuning::TUNING;
use crate::methods::followed::Sensitivity;
use crate::numerics::{
    Extent, ParameterBox, PointSet, Range, SobolDecomposition, SparseBasis, SparseGrid, SparseWork, Surrogate,
    SurrogateWork, TensorGrid,
};

/// Polynomials of the outputs themselves, of a degree that most of them need not have.
struct Fine {
    surrogate: Surrogate,
    decomposition: SobolDecomposition,
    /// C_j of every degree j at the nominal value of each parameter.
    nominal: Vec<Vec<f64>>,
    /// Basis of all parameters but one.
    without: SparseBasis,
    /// ξ of these on which their polynomials' ranges are found.
    lattice: PointSet,
}

/// Outputs as functions of the parameters.
pub(super) trait Predicted {
    /// Number of outputs.
    fn outputs(&self) -> usize;
    /// The surrogate through whose samples they go.
    fn surrogate(&self) -> &Surrogate;
    /// Values of some of them, output by output, point by point.
    fn predict_some(&self, outputs: &[usize], points: &[Vec<f64>]) -> Vec<f64>;
}

impl Predicted for Row<'_> {
    fn outputs(&self) -> usize {
        Row::outputs(self)
    }

    fn surrogate(&self) -> &Surrogate {
        Row::surrogate(self)
    }

    fn predict_some(&self, outputs: &[usize], points: &[Vec<f64>]) -> Vec<f64> {
        Row::predict_some(self, outputs, points)
    }
}

/// Outputs that follow from surrogates over lines through the box.
struct OverLines<'a> {
    combined: &'a Combined<'a>,
    /// Polynomials over the box, of more parameters than fine ones are made of.
    surrogate: Surrogate,
    /// Points on the lines of the samples of these, or of the fine polynomials.
    along: Vec<Vec<f64>>,
}

/// Data of a sensitivity analysis that are the same in all rows.
pub(super) struct SensitivityAnalysis<'a> {
    /// ξ of the nominal parameters.
    nominal: Vec<f64>,
    /// By parameter: those of its cause.
    causes: Vec<Vec<usize>>,
    fine: Option<Fine>,
    lines: Option<OverLines<'a>>,
    own: SobolDecomposition,
    /// Whether any interval is wider than its rounding: else all that varies is rounding.
    varies: bool,
}

impl<'a> SensitivityAnalysis<'a> {
    /// Analysis of outputs that follow from a surrogate over a box.
    pub fn new(domain: &ParameterBox, surrogate: &Surrogate) -> Self {
        let k = domain.dimension();
        let nominal: Vec<f64> = domain.xi(&domain.nominal).into_iter().map(|xi| xi.clamp(-1.0, 1.0)).collect();
        // Fine polynomials hold one parameter at a time.
        let degree = k
            .checked_sub(1)
            .and_then(|index| TUNING.degrees_of_variance.get(index))
            .filter(|_| domain.zones.is_empty());
        let fine = degree.map(|&degree| Fine::new(degree, &nominal));
        let varies = (0..k).any(|axis| domain.half_width(axis) > f64::EPSILON * domain.midpoint(axis).abs());
        let causes = (0..k).map(|axis| domain.cause(axis)).collect();
        let own = SobolDecomposition::new(surrogate.basis(), &domain.zones);
        Self { nominal, causes, fine, lines: None, own, varies }
    }

    /// Analysis of outputs that follow from surrogates over lines through a box: of the parameters of the box.
    pub fn over(combined: &'a Combined<'a>) -> Self {
        let domain = combined.of_box();
        let surrogate = Surrogate::sparse(&of_total_degree(domain.dimension()));
        let of_box = Self::new(domain, &surrogate);
        let samples = of_box.fine.as_ref().map_or(&surrogate, |fine| &fine.surrogate).samples();
        let along = samples.iter().map(|xi| combined.project(xi)).collect();
        Self { lines: Some(OverLines { combined, surrogate, along }), ..of_box }
    }

    /// Sensitivities of every output, whose ranges are known.
    pub fn of_row(&self, row: &impl Predicted, found: &[Extent]) -> Vec<Sensitivity> {
        let (surrogate, decomposition) = match &self.fine {
            Some(fine) => (&fine.surrogate, &fine.decomposition),
            None => (self.lines.as_ref().map_or(row.surrogate(), |lines| &lines.surrogate), &self.own),
        };
        let every: Vec<usize> = (0..row.outputs()).collect();
        let points = self.lines.as_ref().map_or(surrogate.samples(), |lines| &lines.along);
        let values = row.predict_some(&every, points);
        let coefficients = surrogate.coefficients(&values, &mut SurrogateWork::default());
        let k = self.nominal.len();
        let widths: Vec<Vec<f64>> = (0..k).map(|axis| self.widths_without(row, &coefficients, found, axis)).collect();
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

    /// Every output's width with one parameter at its nominal value, from the outputs' `coefficients`. For many
    /// parameters it is estimated at the extremes, which suffices for an output that rises or falls with each.
    fn widths_without(&self, row: &impl Predicted, coefficients: &[f64], found: &[Extent], axis: usize) -> Vec<f64> {
        if let Some(fine) = &self.fine {
            return fine.widths_without(coefficients, axis);
        }
        let replaced = |place: &Vec<f64>| {
            let lines = self.lines.as_ref().map(|lines| lines.combined);
            let mut place = lines.map_or_else(|| place.clone(), |combined| combined.xi(place));
            self.causes[axis].iter().for_each(|&own| place[own] = self.nominal[own]);
            lines.map_or(place.clone(), |combined| combined.project(&place))
        };
        let outputs: Vec<usize> = (0..found.len()).collect();
        let of_block = |outputs: &[usize]| -> Vec<f64> {
            let found = outputs.iter().map(|&output| &found[output]);
            let points: Vec<Vec<f64>> = found.flat_map(|found| found.places.iter().map(replaced)).collect();
            let values = row.predict_some(outputs, &points);
            values.chunks_exact(points.len()).map(|line| Range::of(line).width()).collect()
        };
        outputs.chunk_by(|a, b| block(*a) == block(*b)).flat_map(of_block).collect()
    }
}

/// A sparse grid of all terms up to the highest degree that does not take too many nodes.
fn of_total_degree(k: usize) -> SparseGrid {
    let mut grid = SparseGrid::new(&vec![TUNING.most_degree_of_combined; k]);
    for _ in 0..TUNING.most_degree_of_combined {
        // All of the next degree.
        let next = grid.candidates();
        if grid.len() > 1 && grid.len() + next.len() > TUNING.most_nodes_of_combined {
            break;
        }
        next.iter().for_each(|levels| grid.add(levels));
    }
    grid
}

impl Fine {
    fn new(degree: u8, nominal: &[f64]) -> Self {
        let k = nominal.len();
        let orders = vec![usize::from(degree); k];
        let nodes: Vec<usize> = orders.iter().map(|order| order + 1).collect();
        let surrogate = Surrogate::tensor(&orders, &nodes);
        let decomposition = SobolDecomposition::new(surrogate.basis(), &[]);
        let intervals = TUNING.density_of_widths * usize::from(degree);
        let axis: Vec<f64> = (0..=intervals).map(|l| -math::cos(PI * l as f64 / intervals as f64)).collect();
        let lattice = TensorGrid::new(vec![axis; k - 1]);
        let chebyshev = |xi: f64| {
            let mut last = [1.0, xi];
            let next = |_| {
                let [this, following] = last;
                last = [following, 2.0 * xi * following - this];
                this
            };
            (0..=degree).map(next).collect()
        };
        Self {
            surrogate,
            decomposition,
            nominal: nominal.iter().map(|&xi| chebyshev(xi)).collect(),
            without: SparseBasis::tensor(&vec![degree; k - 1]),
            lattice: PointSet::of(&(0..lattice.len()).map(|index| lattice.sample(index)).collect::<Vec<_>>()),
        }
    }

    /// Widths of the outputs' polynomials with the parameter of an axis at its nominal value.
    fn widths_without(&self, coefficients: &[f64], axis: usize) -> Vec<f64> {
        let values_at = &self.nominal[axis];
        let stride = values_at.len().pow((self.nominal.len() - 1 - axis) as u32);
        let terms = coefficients.len() / values_at.len();
        let mut held = Vec::with_capacity(terms);
        for block in coefficients.chunks_exact(stride * values_at.len()) {
            let at = |index: usize| -> f64 {
                block[index..].iter().step_by(stride).zip(values_at).map(|(c, value)| c * value).sum()
            };
            held.extend((0..stride).map(at));
        }
        let lattice = self.lattice.points();
        let mut values = vec![0.0; terms / self.without.len() * lattice.len()];
        self.without.values(lattice, &held, &mut values, &mut SparseWork::default());
        values.chunks_exact(lattice.len()).map(|line| self.width(line)).collect()
    }

    /// The width of a function's range from its values on the lattice.
    fn width(&self, line: &[f64]) -> f64 {
        let [least, largest] = [-1.0, 1.0].map(|sign| {
            let place = (0..line.len()).max_by(|&a, &b| f64::total_cmp(&(sign * line[a]), &(sign * line[b])));
            place.map_or(f64::NAN, |place| self.peak(line, place, sign))
        });
        largest - least
    }

    /// The extreme next to the lattice's: along each axis a parabola through its neighbours, in the angle whose cosine
    /// ξ is, in which they are equally far. At the ends of an axis the function is even in it.
    fn peak(&self, line: &[f64], index: usize, sign: f64) -> f64 {
        let points = TUNING.density_of_widths * (self.nominal[0].len() - 1) + 1;
        let mut peak = line[index];
        let mut stride = 1;
        while stride < line.len() {
            if (1..points - 1).contains(&(index / stride % points)) {
                let (before, after) = (line[index - stride], line[index + stride]);
                let bend = 2.0 * line[index] - before - after;
                if sign * bend > 0.0 {
                    peak += (after - before) * (after - before) / (8.0 * bend);
                }
            }
            stride *= points;
        }
        peak
    }
}
