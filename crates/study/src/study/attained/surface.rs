//! Polynomials through values and gradients at a few points of the box: where ends are to be searched for, and which
//! parameters they come from.

use crate::methods::Sensitivity;
use crate::numerics::{Derivatives, GradientFit, ParameterBox, Range, SobolDecomposition, SparseBasis};

/// The same for all rows and outputs.
pub(super) struct Surfaces {
    fit: GradientFit,
    decomposition: SobolDecomposition,
    /// By parameter: those of its cause.
    causes: Vec<Vec<usize>>,
    /// ξ of the nominal parameters.
    nominal: Vec<f64>,
}

/// An output in a row as a polynomial: coefficients of its terms.
pub(super) struct Surface(pub Vec<f64>);

impl Surfaces {
    /// Polynomials through samples at these ξ, for functions with these derivatives there (in ξ); `None` if they are
    /// too few.
    pub fn new(domain: &ParameterBox, points: Vec<Vec<f64>>, functions: &[Derivatives<'_>]) -> Option<Self> {
        let fit = GradientFit::new(points, functions)?;
        let decomposition = SobolDecomposition::new(fit.basis(), &domain.zones);
        let nominal = domain.xi(&domain.nominal).into_iter().map(|xi| xi.clamp(-1.0, 1.0)).collect();
        let causes = (0..domain.dimension()).map(|axis| domain.cause(axis)).collect();
        Some(Self { fit, decomposition, nominal, causes })
    }

    /// The polynomials' terms.
    pub fn basis(&self) -> &SparseBasis {
        self.fit.basis()
    }

    /// The polynomial of values and gradients (in ξ) at the samples.
    pub fn of(&self, samples: &[&(f64, Vec<f64>)]) -> Surface {
        Surface(self.fit.coefficients(samples.iter().map(|(value, slopes)| (*value, slopes.as_slice()))))
    }

    /// The approximate point of its greatest value, or with the sign −1 of its least.
    pub fn end(&self, Surface(coefficients): &Surface, sign: f64, start: &[f64]) -> Vec<f64> {
        self.fit.maximum(coefficients, sign, start)
    }

    /// Contributions of the parameters to an output's spread, given its range and the points of its ends.
    pub fn sensitivity(&self, Surface(coefficients): &Surface, range: Range, ends: [&[f64]; 2]) -> Sensitivity {
        let k = self.nominal.len();
        let (main, total) = match self.decomposition.indices(coefficients) {
            Some(indices) => (indices.main, indices.total),
            // Nothing varies.
            None => (vec![0.0; k], vec![0.0; k]),
        };
        // The loss of an end by a parameter is the polynomial's difference; its value there may be off.
        let moved = |end: &[f64], axis: usize| {
            let mut place = end.to_vec();
            self.causes[axis].iter().for_each(|&own| place[own] = self.nominal[own]);
            self.fit.value(coefficients, &place) - self.fit.value(coefficients, end)
        };
        let without = |axis: usize| (range.width() + moved(ends[1], axis) - moved(ends[0], axis)).max(0.0);
        Sensitivity { main, total, width_without: (0..k).map(without).collect() }
    }
}
