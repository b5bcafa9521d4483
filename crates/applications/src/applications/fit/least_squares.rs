//! Weighted least squares by Gauss and Newton on surrogates, over boxes that become smaller around the estimate.

use nalgebra::{DMatrix, DVector};

use super::local::{Local, SkewAxes};
use super::readings::{Finer, SurrogateRun};
use super::tuning::TUNING;
use super::{FitError, Measurements};
use crate::model::Description;
use crate::numerics::{ParameterBox, spread};
use crate::study::Options;

/// Noise is within its bound: the standard deviation of a uniform law.
pub const DEVIATION: f64 = 0.577_350_269_189_625_8;

/// Residuals over their deviations, and derivatives by η.
pub struct Linearised {
    pub residuals: DVector<f64>,
    pub jacobian: DMatrix<f64>,
}

/// Covariance of an estimate in η.
pub struct Covariance {
    /// Standard deviations (k); infinite if the data do not determine them.
    pub deviations: Vec<f64>,
    /// k × k; zero for undetermined parameters, one in the diagonal.
    pub correlations: Vec<Vec<f64>>,
}

/// An estimate on surrogates over a box around it.
pub struct Minimum {
    /// Axes along those of the parameters.
    pub frame: SkewAxes,
    pub local: Local,
    /// η in the frame.
    pub eta: Vec<f64>,
    pub simulations: usize,
}

/// The least sum of squares, from a box on.
///
/// # Errors
/// If a box cannot be run.
pub fn minimum(
    description: &Description,
    measurements: &Measurements,
    prior: &ParameterBox,
    first: SkewAxes,
    options: &Options,
) -> Result<Minimum, FitError> {
    let k = prior.dimension();
    let (mut frame, mut simulations, mut before) = (first, 0, f64::INFINITY);
    let mut best: Option<Minimum> = None;
    for round in 0..TUNING.boxes {
        let run = SurrogateRun::new(description, &frame.domain(prior), Finer::default(), options)?;
        simulations += run.simulations;
        let local = Local::new(&run.readings(measurements)?, &frame, prior, measurements, TUNING.coarse)?;
        let starts = if round == 0 { TUNING.starts } else { 0 };
        let eta = minimised(&local, measurements, k, starts);
        let roughness = local.roughness(measurements);
        let ends: Vec<[f64; 2]> = (0..k).map(|axis| frame.ends(axis)).collect();
        let is_at_edge = (0..k).any(|axis| {
            let is_inside = [ends[axis][0] > -1.0, ends[axis][1] < 1.0];
            (eta[axis] < -TUNING.edge && is_inside[0]) || (eta[axis] > TUNING.edge && is_inside[1])
        });
        let xi = frame.xi(&eta);
        let scale = if is_at_edge { 1.0 } else { TUNING.next_box };
        let halves: Vec<f64> = ends.iter().map(|[lower, upper]| scale * 0.5 * (upper - lower)).collect();
        let next = SkewAxes::around(&xi, &halves);
        best = Some(Minimum { frame: std::mem::replace(&mut frame, next), local, eta, simulations });
        if !is_at_edge && (roughness <= TUNING.rough || roughness > TUNING.better * before) {
            break;
        }
        before = if is_at_edge { f64::INFINITY } else { roughness };
    }
    best.ok_or(FitError::NoSurrogate)
}

/// Linearisation at η of polynomials along a frame.
pub fn linearised(local: &Local, measurements: &Measurements, eta: &[f64]) -> Linearised {
    let mut points = vec![eta.to_vec()];
    for axis in 0..eta.len() {
        for sign in [1.0, -1.0] {
            let mut moved = eta.to_vec();
            moved[axis] += sign * TUNING.step_of_difference;
            points.push(moved);
        }
    }
    let values = local.at(&points);
    let of = |index: usize, point: usize| values[index * points.len() + point];
    let row = |index: usize| &measurements.values[local.rows[index]];
    let residual = |index: usize, _| (of(index, 0) - row(index).value) / (DEVIATION * row(index).noise);
    let derivative = |index: usize, axis: usize| {
        let difference = of(index, 1 + 2 * axis) - of(index, 2 + 2 * axis);
        difference / (2.0 * TUNING.step_of_difference * DEVIATION * row(index).noise)
    };
    Linearised {
        residuals: DVector::from_fn(local.rows.len(), residual),
        jacobian: DMatrix::from_fn(local.rows.len(), eta.len(), derivative),
    }
}

impl Linearised {
    /// The step of Gauss and Newton, damped, clamped to the box.
    pub fn step(&self, eta: &[f64], damping: f64) -> Vec<f64> {
        let mut normal = self.jacobian.tr_mul(&self.jacobian);
        let most = normal.diagonal().max().max(f64::MIN_POSITIVE);
        (0..eta.len()).for_each(|axis| normal[(axis, axis)] += damping * normal[(axis, axis)] + TUNING.singular * most);
        let gradient = self.jacobian.tr_mul(&self.residuals);
        let step = normal.cholesky().map_or_else(|| DVector::zeros(eta.len()), |factor| factor.solve(&gradient));
        eta.iter().zip(step.iter()).map(|(eta, step)| (eta - step).clamp(-1.0, 1.0)).collect()
    }

    /// Covariance of the estimate, of independent noise.
    pub fn covariance(&self) -> Covariance {
        let k = self.jacobian.ncols();
        let eigen = self.jacobian.tr_mul(&self.jacobian).symmetric_eigen();
        let most = eigen.eigenvalues.max();
        let is_known = |index: usize| eigen.eigenvalues[index] > TUNING.singular * most;
        let mut covariance = DMatrix::zeros(k, k);
        for index in (0..k).filter(|&index| is_known(index)) {
            let axis = eigen.eigenvectors.column(index);
            covariance += axis * axis.transpose() / eigen.eigenvalues[index];
        }
        // A parameter that takes part in an undetermined direction is undetermined.
        let is_open =
            |axis: usize| (0..k).any(|index| !is_known(index) && eigen.eigenvectors[(axis, index)].abs() > 1e-6);
        let deviations: Vec<f64> =
            (0..k).map(|axis| if is_open(axis) { f64::INFINITY } else { covariance[(axis, axis)].sqrt() }).collect();
        let correlation = |a: usize, b: usize| match deviations[a] * deviations[b] {
            _ if a == b => 1.0,
            product if product.is_finite() && product > 0.0 => covariance[(a, b)] / product,
            _ => 0.0,
        };
        let correlations = (0..k).map(|a| (0..k).map(|b| correlation(a, b)).collect()).collect();
        Covariance { deviations, correlations }
    }
}

/// Whether a step from one point to another is short.
pub fn is_short(from: &[f64], to: &[f64], deviations: &[f64]) -> bool {
    from.iter()
        .zip(to)
        .zip(deviations)
        .all(|((from, to), deviation)| (to - from).abs() <= TUNING.short_step * deviation.min(1.0))
}

/// The least of several minima on the surrogate, η.
fn minimised(local: &Local, measurements: &Measurements, k: usize, starts: usize) -> Vec<f64> {
    let starts = std::iter::once(vec![0.0; k]).chain(spread(k, starts));
    let ends = starts.map(|start| descended(local, measurements, start));
    let least = ends.min_by(|a, b| a.0.total_cmp(&b.0));
    least.map_or_else(|| vec![0.0; k], |(_, eta)| eta)
}

/// Levenberg's and Marquardt's way down from a start: the sum of squares, and η.
fn descended(local: &Local, measurements: &Measurements, start: Vec<f64>) -> (f64, Vec<f64>) {
    let (mut eta, mut damping) = (start, 1e-3);
    let mut here = linearised(local, measurements, &eta);
    for _ in 0..TUNING.steps {
        let next = here.step(&eta, damping);
        let there = linearised(local, measurements, &next);
        if there.residuals.norm_squared() < here.residuals.norm_squared() {
            let is_done = is_short(&eta, &next, &here.covariance().deviations);
            (eta, here) = (next, there);
            damping *= 0.2;
            if is_done {
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e8 {
                break;
            }
        }
    }
    (here.residuals.norm_squared(), eta)
}
