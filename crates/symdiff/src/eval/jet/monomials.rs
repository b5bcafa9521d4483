//! Monomials of a jet's coefficients.

/// All monomials of `variables` variables up to a total degree: ascending in degree, and within a degree with falling
/// powers of the first variable, then of the second, …: 1, x, y, x², xy, y², x³, …
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Monomials {
    variables: usize,
    order: usize,
    exponents: Vec<usize>,
    degrees: Vec<usize>,
}

impl Monomials {
    /// All C(variables + order, order) monomials.
    pub fn new(variables: usize, order: usize) -> Self {
        let mut monomials = Self { variables, order, exponents: Vec::new(), degrees: Vec::new() };
        let mut exponents = vec![0; variables];
        for degree in 0..=order {
            monomials.list(degree, degree, 0, &mut exponents);
        }
        monomials
    }

    /// Appends those of `degree` whose first exponents are chosen; `rest` is the degree left for `variable` and those
    /// after it.
    fn list(&mut self, degree: usize, rest: usize, variable: usize, exponents: &mut [usize]) {
        if variable + 1 >= self.variables {
            if let Some(last) = exponents.last_mut() {
                *last = rest;
            } else if rest > 0 {
                return; // without variables there is only the constant
            }
            self.exponents.extend_from_slice(exponents);
            self.degrees.push(degree);
            return;
        }
        for power in (0..=rest).rev() {
            exponents[variable] = power;
            self.list(degree, rest - power, variable + 1, exponents);
        }
    }

    /// Number of variables.
    pub fn variables(&self) -> usize {
        self.variables
    }

    /// Largest total degree.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Number of monomials.
    #[allow(clippy::len_without_is_empty)] // the constant is always there
    pub fn len(&self) -> usize {
        self.degrees.len()
    }

    /// Power of each variable in a monomial.
    pub fn exponents(&self, monomial: usize) -> &[usize] {
        &self.exponents[monomial * self.variables..(monomial + 1) * self.variables]
    }

    /// Total degree of a monomial.
    pub fn degree(&self, monomial: usize) -> usize {
        self.degrees[monomial]
    }

    /// The polynomial with these coefficients at a point.
    pub fn evaluate(&self, coefficients: &[f64], point: &[f64]) -> f64 {
        let value_of = |monomial: usize| {
            let powers = self.exponents(monomial).iter().zip(point);
            powers.map(|(&power, x)| x.powi(power as i32)).product::<f64>()
        };
        coefficients.iter().enumerate().map(|(monomial, c)| c * value_of(monomial)).sum()
    }
}
