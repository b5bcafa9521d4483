//! Polynomials of the measured rows along skew axes, with the intervals in which measured values have them.

use nalgebra::{DMatrix, DVector};

use super::readings::{ReadValues, Readings};
use super::tuning::TUNING;
use super::{FitError, Measurements};
use crate::numerics::{
    Design, ParameterBox, PointSet, SAFETY_OF_SURROGATE, SparseBasis, SparseWork, Surrogate, SurrogateWork, Tubes,
    corners, largest,
};

/// Skew axes: ξ = center + axes · η, η ∈ [−1, 1]^k, in multiples of the half intervals of the model's box.
#[derive(Clone, Debug)]
pub struct SkewAxes {
    pub center: DVector<f64>,
    pub axes: DMatrix<f64>,
}

/// Polynomials along a frame's axes.
pub struct Local {
    pub tubes: Tubes,
    /// Measured row of each quantity; the model's box follows as a quantity for each parameter.
    pub rows: Vec<usize>,
    /// Errors by measured row, in the output's unit.
    pub errors: Vec<f64>,
    basis: SparseBasis,
}

impl SkewAxes {
    /// The model's box.
    pub fn whole(k: usize) -> Self {
        Self { center: DVector::zeros(k), axes: DMatrix::identity(k, k) }
    }

    /// A box within the model's, along the parameters' axes: ξ of its middle, and half extents, before it is cut.
    pub fn around(xi: &[f64], halves: &[f64]) -> Self {
        let ends = xi.iter().zip(halves).map(|(xi, half)| [(xi - half).max(-1.0), (xi + half).min(1.0)]);
        let ends: Vec<[f64; 2]> = ends.collect();
        let center = DVector::from_iterator(ends.len(), ends.iter().map(|[lower, upper]| 0.5 * (lower + upper)));
        let halves = DVector::from_iterator(ends.len(), ends.iter().map(|[lower, upper]| 0.5 * (upper - lower)));
        Self { center, axes: DMatrix::from_diagonal(&halves) }
    }

    /// Ends along ξ of an axis.
    pub fn ends(&self, axis: usize) -> [f64; 2] {
        let reach = self.reach()[axis];
        [self.center[axis] - reach, self.center[axis] + reach]
    }

    /// ξ of a point.
    pub fn xi(&self, eta: &[f64]) -> Vec<f64> {
        (&self.center + &self.axes * DVector::from_column_slice(eta)).iter().copied().collect()
    }

    /// Half of the extent along each ξ.
    pub fn reach(&self) -> Vec<f64> {
        self.axes.row_iter().map(|row| row.iter().map(|entry| entry.abs()).sum()).collect()
    }

    /// The smallest box around the frame within the model's, `prior`, in the parameters' units.
    pub fn domain(&self, prior: &ParameterBox) -> ParameterBox {
        let reach = self.reach();
        let end = |axis: usize, sign: f64| {
            let xi = (self.center[axis] + sign * reach[axis]).clamp(-1.0, 1.0);
            value(prior, axis, xi)
        };
        let k = prior.dimension();
        let lower: Vec<f64> = (0..k).map(|axis| end(axis, -1.0)).collect();
        let upper: Vec<f64> = (0..k).map(|axis| end(axis, 1.0)).collect();
        let nominal = prior.nominal.iter().zip(lower.iter().zip(&upper));
        let nominal = nominal.map(|(nominal, (lower, upper))| nominal.clamp(*lower, *upper)).collect();
        ParameterBox { nominal, lower, upper, zones: prior.zones.clone() }
    }
}

/// Value of a parameter at ξ of the model's box.
pub fn value(prior: &ParameterBox, axis: usize, xi: f64) -> f64 {
    prior.midpoint(axis) + prior.half_width(axis) * xi
}

/// Values of all parameters at ξ.
pub fn values(prior: &ParameterBox, xi: &[f64]) -> Vec<f64> {
    xi.iter().enumerate().map(|(axis, &xi)| value(prior, axis, xi)).collect()
}

impl Local {
    /// Polynomials of the least degree that differs from the surrogate by less than the share `fine` of the noise, or
    /// the finest.
    ///
    /// # Errors
    /// If the outputs have no value within the frame.
    pub fn new(
        readings: &Readings,
        frame: &SkewAxes,
        prior: &ParameterBox,
        measurements: &Measurements,
        fine: f64,
    ) -> Result<Self, FitError> {
        let k = prior.dimension();
        let own = readings.errors();
        let sample = |eta: &Vec<f64>| values(prior, &frame.xi(eta));
        let mut held_out = Design::Sobol.points(k, TUNING.points_an_axis * k, 0..TUNING.points_an_axis * k);
        held_out.iter_mut().flatten().for_each(|u| *u = 2.0 * *u - 1.0);
        held_out.extend(corners(k, TUNING.corners));
        let samples: Vec<Vec<f64>> = held_out.iter().map(sample).collect();
        let direct = readings.at(&samples);
        let mut best: Option<(f64, Self)> = None;
        for degree in 1..=TUNING.most_degree {
            if (degree + 1_usize).checked_pow(k as u32).is_none_or(|nodes| nodes > TUNING.most_nodes) {
                break;
            }
            let surrogate = Surrogate::tensor(&vec![degree; k], &vec![degree + 1; k]);
            let nodes: Vec<Vec<f64>> = surrogate.samples().iter().map(sample).collect();
            let found = Self::fitted(&surrogate, &readings.at(&nodes), &held_out, &direct, degree);
            let Self { errors: between, .. } = &found;
            let shares = between.iter().zip(&measurements.values).zip(&own);
            let shares = shares.filter(|((error, _), own)| own.is_finite() && !error.is_infinite());
            let shares = shares.map(|((error, row), own)| error / row.noise.max(TUNING.fine_beside_error / fine * own));
            let coarseness =
                shares.fold(0.0, |most: f64, own| if own.is_nan() { f64::INFINITY } else { most.max(own) });
            if best.as_ref().is_none_or(|best| coarseness < best.0) {
                best = Some((coarseness, found));
            }
            if coarseness < fine {
                break;
            }
        }
        let (coarseness, found) = best.ok_or(FitError::NoSurrogate)?;
        if !coarseness.is_finite() {
            return Err(FitError::NoSurrogate);
        }
        Ok(found.within(frame, &own, measurements))
    }

    /// Polynomials through nodes, with their differences from held-out values and errors of interpolation in time.
    fn fitted(
        surrogate: &Surrogate,
        nodes: &ReadValues,
        held_out: &[Vec<f64>],
        direct: &ReadValues,
        degree: usize,
    ) -> Self {
        let basis = surrogate.basis().clone();
        let mut work = SurrogateWork::default();
        let coefficients = surrogate.coefficients(&nodes.values.concat(), &mut work);
        let mut found = vec![0.0; direct.values.len() * held_out.len()];
        basis.values(PointSet::of(held_out).points(), &coefficients, &mut found, &mut SparseWork::default());
        let error = |index: usize| {
            let differences = found[index * held_out.len()..][..held_out.len()].iter().zip(&direct.values[index]);
            let most = largest(differences.map(|(a, b)| a - b));
            SAFETY_OF_SURROGATE * most + nodes.interpolation[index].max(direct.interpolation[index])
        };
        let errors: Vec<f64> = (0..direct.values.len()).map(error).collect();
        let k = held_out[0].len();
        let tubes =
            Tubes { orders: vec![degree; k], coefficients, outer: Vec::new(), inner: Vec::new(), scales: Vec::new() };
        Self { tubes, rows: (0..errors.len()).collect(), errors, basis }
    }

    /// Adds the intervals of measured values, without rows whose error is unknown, and the model's box.
    fn within(mut self, frame: &SkewAxes, own: &[f64], measurements: &Measurements) -> Self {
        let size = self.basis.len();
        let mut coefficients = Vec::new();
        self.rows.clear();
        for (row, measured) in measurements.values.iter().enumerate() {
            self.errors[row] = if own[row].is_finite() { self.errors[row] + own[row] } else { f64::INFINITY };
            let error = self.errors[row] + TUNING.rounding * measured.noise;
            if error.is_finite() {
                self.rows.push(row);
                coefficients.extend_from_slice(&self.tubes.coefficients[row * size..][..size]);
                let interval = |noise: f64| [measured.value - noise, measured.value + noise];
                self.tubes.outer.push(interval(measured.noise + error));
                self.tubes.inner.push(interval(measured.noise - error));
                self.tubes.scales.push(measured.noise);
            }
        }
        let strides = strides(&self.tubes.orders);
        for axis in 0..frame.center.len() {
            let mut linear = vec![0.0; size];
            linear[0] = frame.center[axis];
            strides.iter().enumerate().for_each(|(of, &stride)| linear[stride] = frame.axes[(axis, of)]);
            coefficients.extend(linear);
            self.tubes.outer.push([-1.0 - TUNING.rounding, 1.0 + TUNING.rounding]);
            self.tubes.inner.push([-1.0, 1.0]);
            self.tubes.scales.push(1.0);
        }
        self.tubes.coefficients = coefficients;
        self
    }

    /// The largest error in multiples of the noise, of rows that are known.
    pub fn roughness(&self, measurements: &Measurements) -> f64 {
        self.rows.iter().map(|&row| self.errors[row] / measurements.values[row].noise).fold(0.0, f64::max)
    }

    /// Values of the measured rows of [`Self::rows`] at points, row by row, point by point.
    pub fn at(&self, points: &[Vec<f64>]) -> Vec<f64> {
        let mut values = vec![0.0; self.rows.len() * points.len()];
        let coefficients = &self.tubes.coefficients[..self.rows.len() * self.basis.len()];
        self.basis.values(PointSet::of(points).points(), coefficients, &mut values, &mut SparseWork::default());
        values
    }
}

/// Index of the coefficient of each axis' linear polynomial, the last axis fastest.
fn strides(orders: &[usize]) -> Vec<usize> {
    (0..orders.len()).map(|axis| orders[axis + 1..].iter().map(|order| order + 1).product()).collect()
}
