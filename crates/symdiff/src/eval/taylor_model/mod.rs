//! Taylor models: polynomials of ξ ∈ [−1, 1]^k with a bound on their remainder.
//!
//! A model is a slice: the coefficients of a jet, followed by a radius e ≥ 0. It encloses a function f if |f(ξ) − Σ aᵣ
//! ξ^r| ≤ e for every ξ of the box. Polynomials are computed by the jets' arithmetic, and the radius is proven
//! afterwards from the equation that defines the result: a quotient h = a/b by the size of a − h b, a root by a − h²,
//! sine and cosine by their differential equation. So rounding, cut-off terms and the operands' radii are bounded in
//! one way, and a wrongly computed jet would only have a large radius. A radius that is infinite or NaN means that
//! nothing is known.
//!
//! Sums of magnitudes are rounded to nearest and enlarged by [`up`]. A coefficient of a product of monomials'
//! coefficients sums at most (D+1)^k terms, D its degree, and D+1 ≤ (d+1)(d'+1) for the degrees d, d' of its factors;
//! hence the weights (d+1)^k by which norms bound the rounding errors of all coefficients at once.

mod memory;
mod smooth;
mod spline;

pub use memory::ModelMemory;

use crate::eval::functions;
use crate::eval::interval::Interval;
use crate::eval::jet::{JetScratch, JetSpace};
use crate::expr::{Binary, Unary};

/// Largest order, so that norms by degree fit on the stack.
pub const MAX_ORDER: usize = 24;

/// Half a unit in the last place, plus second-order terms.
const HALF_UNIT: f64 = 0.51 * f64::EPSILON;

/// A sum or product of non-negative numbers, computed by up to a thousand rounded operations, rounded up. (The constant
/// covers underflow.)
#[inline]
pub fn up(x: f64) -> f64 {
    x * (1.0 + 1e-12) + 1e-290
}

/// Norms of a model's polynomial.
#[derive(Clone, Copy, Debug)]
pub struct Norms {
    /// Σ|aᵣ|.
    total: f64,
    /// Σ (d+1)^k |aᵣ|.
    weighted: f64,
    /// Σ|aᵣ| over the monomials of each degree.
    of_degree: [f64; MAX_ORDER + 2],
    /// Σ|aᵣ| over the monomials of each degree and above.
    tails: [f64; MAX_ORDER + 2],
    /// The radius.
    radius: f64,
}

impl Norms {
    /// Bound of |f| over the box.
    pub fn bound(&self) -> f64 {
        up(self.total + self.radius)
    }
}

/// Arithmetic of models of one shape.
#[derive(Clone, Debug)]
pub struct ModelSpace {
    jets: JetSpace,
    degrees: Vec<usize>,
    /// First monomial of each degree, and the end.
    starts: Vec<usize>,
    /// (d+1)^k of each degree.
    weights: Vec<f64>,
    /// See [`ModelSpace::with_ranges_of_signs`].
    signs_are_ranges: bool,
}

/// Memory for intermediate models.
#[derive(Clone, Debug)]
pub struct ModelScratch {
    jets: JetScratch,
    registers: [Vec<f64>; 3],
    /// Memory for functions composed of others.
    spare: [Vec<f64>; 2],
}

impl ModelScratch {
    /// Memory for models of this shape.
    pub fn new(space: &ModelSpace) -> Self {
        let model = || vec![0.0; space.size()];
        Self {
            jets: JetScratch::new(&space.jets),
            registers: std::array::from_fn(|_| model()),
            spare: std::array::from_fn(|_| model()),
        }
    }
}

/// Every slice that an operation takes has [`size`](ModelSpace::size) numbers; a shorter one panics.
impl ModelSpace {
    /// Models in `variables` variables, their polynomials up to the total degree `order`.
    ///
    /// # Panics
    /// If `order` is above [`MAX_ORDER`].
    pub fn new(variables: usize, order: usize) -> Self {
        assert!(order <= MAX_ORDER, "models have an order of at most {MAX_ORDER}");
        let jets = JetSpace::new(variables, order);
        let degrees: Vec<usize> = (0..jets.len()).map(|r| jets.monomials().degree(r)).collect();
        let starts = (0..=order + 1).map(|d| degrees.partition_point(|&degree| degree < d)).collect();
        let weights = (0..=order).map(|d| ((d + 1) as f64).powi(variables.max(1) as i32)).collect();
        Self { jets, degrees, starts, weights, signs_are_ranges: false }
    }

    /// Makes unknown signs range between −1 and 1 instead of being unknown: correct for the derivative of a maximum,
    /// and for a sign of the time. The caller ensures that nothing jumps with the unknowns.
    #[must_use]
    pub fn with_ranges_of_signs(self) -> Self {
        Self { signs_are_ranges: true, ..self }
    }

    /// The polynomials' arithmetic.
    pub fn jets(&self) -> &JetSpace {
        &self.jets
    }

    /// Numbers of a model: coefficients and radius.
    pub fn size(&self) -> usize {
        self.degrees.len() + 1
    }

    fn split<'a>(&self, a: &'a [f64]) -> (&'a [f64], f64) {
        (&a[..self.degrees.len()], a[self.degrees.len()])
    }

    fn split_mut<'a>(&self, a: &'a mut [f64]) -> (&'a mut [f64], &'a mut f64) {
        let (polynomial, radius) = a.split_at_mut(self.degrees.len());
        (polynomial, &mut radius[0])
    }

    /// Norms of a model.
    pub fn norms(&self, a: &[f64]) -> Norms {
        let (polynomial, radius) = self.split(a);
        let mut of_degree = [0.0; MAX_ORDER + 2];
        // Monomials ascend in degree: each sum stays in a register.
        let ends = self.starts.windows(2);
        for (sum, ends) in of_degree.iter_mut().zip(ends) {
            *sum = polynomial[ends[0]..ends[1]].iter().fold(0.0, |sum, c| sum + c.abs());
        }
        let mut weighted = 0.0;
        let mut tails = [0.0; MAX_ORDER + 2];
        for degree in (0..self.weights.len()).rev() {
            weighted += self.weights[degree] * of_degree[degree];
            tails[degree] = of_degree[degree] + tails[degree + 1];
        }
        Norms { total: tails[0], weighted, of_degree, tails, radius }
    }

    /// Bound of |f| over the box.
    pub fn bound(&self, a: &[f64]) -> f64 {
        let (polynomial, radius) = self.split(a);
        up(polynomial.iter().map(|c| c.abs()).sum::<f64>() + radius)
    }

    /// Error of the product of two polynomials: terms above the order, and rounding.
    fn product_error(&self, a: &Norms, b: &Norms) -> f64 {
        let order = self.weights.len() - 1;
        let cut: f64 = (1..=order).map(|d| a.of_degree[d] * b.tails[order + 1 - d]).sum();
        up(cut + HALF_UNIT * a.weighted * b.weighted)
    }

    /// Radius of the product of two models.
    pub fn product_radius(&self, a: &Norms, b: &Norms) -> f64 {
        up(self.product_error(a, b) + a.total * b.radius + b.total * a.radius + a.radius * b.radius)
    }

    /// `out = value`.
    pub fn constant(&self, value: Interval, out: &mut [f64]) {
        out.fill(0.0);
        out[0] = value.middle();
        *self.split_mut(out).1 = if value.lower() == value.upper() { 0.0 } else { value.radius_about(out[0]) };
    }

    /// `out` = the numbers from `lower` to `upper` (slightly enlarged) for ξ_variable from −1 to 1.
    pub fn variable(&self, variable: usize, lower: f64, upper: f64, out: &mut [f64]) {
        if lower == upper || self.weights.len() == 1 {
            return self.constant(Interval::new(lower, upper), out);
        }
        let middle = Interval::new(lower, upper).middle();
        let half = Interval::new(lower, upper).radius_about(middle);
        self.jets.variable(variable, middle, half, self.split_mut(out).0);
        *self.split_mut(out).1 = 0.0;
    }

    fn sum(&self, a: &[f64], b: &[f64], out: &mut [f64], function: impl Fn(f64, f64) -> f64) {
        let ((x, e), (y, f)) = (self.split(a), self.split(b));
        let (polynomial, radius) = self.split_mut(out);
        let mut rounding = 0.0;
        for ((h, &x), &y) in polynomial.iter_mut().zip(x).zip(y) {
            *h = function(x, y);
            // Sums with zero are exact.
            rounding += if x == 0.0 || y == 0.0 { 0.0 } else { h.abs() };
        }
        *radius = if rounding == 0.0 && e == 0.0 && f == 0.0 { 0.0 } else { up(e + f + HALF_UNIT * rounding) };
    }

    /// `out = a + b`.
    pub fn add(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        self.sum(a, b, out, |a, b| a + b);
    }

    /// `out = a - b`.
    pub fn sub(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        self.sum(a, b, out, |a, b| a - b);
    }

    /// `out = factor · a`.
    pub fn scale(&self, factor: Interval, a: &[f64], out: &mut [f64]) {
        let (x, e) = self.split(a);
        let (middle, total) = (factor.middle(), x.iter().map(|c| c.abs()).sum::<f64>());
        let (polynomial, radius) = self.split_mut(out);
        self.jets.scale(middle, x, polynomial);
        *radius = up(factor.radius_about(middle) * total + HALF_UNIT * middle.abs() * total + factor.magnitude() * e);
    }

    /// `out = a b`.
    pub fn mul(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        let (x, y) = (self.split(a).0, self.split(b).0);
        let radius = self.product_radius(&self.norms(a), &self.norms(b));
        self.jets.mul(x, y, self.split_mut(out).0);
        *self.split_mut(out).1 = radius;
    }

    /// `out += a b`, as one of at most `count` products that are summed into `out`, which was zero at first.
    pub fn accumulate(&self, a: (&[f64], &Norms), b: (&[f64], &Norms), count: usize, out: &mut [f64]) {
        // A coefficient's running sum has `count` times as many terms as one product.
        let summing = count as f64 * HALF_UNIT * a.1.weighted * b.1.weighted;
        self.jets.accumulate(self.split(a.0).0, self.split(b.0).0, self.split_mut(out).0);
        let radius = self.split_mut(out).1;
        *radius = up(*radius + self.product_radius(a.1, b.1) + summing);
    }

    /// `out = a / b`: |a/b − h| = |a − h b| / |b|.
    pub fn div(&self, a: &[f64], b: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        let (x, y) = (self.split(a).0, self.split(b).0);
        self.jets.div(x, y, self.split_mut(out).0);
        *self.split_mut(out).1 = 0.0;
        let residual = &mut scratch.registers[0];
        self.jets.sub_mul(self.split(out).0, y, x, self.split_mut(residual).0);
        let (left, quotient, right) = (self.norms(a), self.norms(out), self.norms(b));
        let missed = self.product_radius(&quotient, &right) + left.radius + f64::EPSILON * left.total;
        let missed = self.split(residual).0.iter().map(|c| c.abs()).sum::<f64>() + missed;
        let smallest = self.away_from_zero(y, &right);
        *self.split_mut(out).1 = if smallest > 0.0 { up(up(missed) / smallest) } else { f64::INFINITY };
    }

    /// Least |a| over the box, rounded down; not positive if a may be zero.
    fn away_from_zero(&self, polynomial: &[f64], norms: &Norms) -> f64 {
        let constant = polynomial[0].abs();
        constant - up(norms.tails[1] + norms.radius) - f64::EPSILON * constant
    }

    /// `out = √a`: |√a − h| = |a − h²| / (√a + h), h > 0.
    fn sqrt(&self, a: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        if a.iter().all(|&c| c == 0.0) {
            return out.fill(0.0);
        }
        let x = self.split(a).0;
        self.jets.unary(Unary::Sqrt, x, self.split_mut(out).0, &mut scratch.jets);
        *self.split_mut(out).1 = 0.0;
        let residual = &mut scratch.registers[0];
        let root = self.split(out).0;
        self.jets.sub_mul(root, root, x, self.split_mut(residual).0);
        let (argument, norms) = (self.norms(a), self.norms(out));
        let missed = self.product_radius(&norms, &norms) + argument.radius + f64::EPSILON * argument.total;
        let missed = up(self.split(residual).0.iter().map(|c| c.abs()).sum::<f64>() + missed);
        let smallest = self.away_from_zero(root, &norms);
        // h ≥ smallest and |a − h²| < smallest² imply a > 0.
        let proven = root[0] > 0.0 && smallest > 0.0 && missed < 0.5 * smallest * smallest;
        *self.split_mut(out).1 = if proven { up(missed / smallest) } else { f64::INFINITY };
    }

    /// `sine = sin a`, `cosine = cos a`.
    ///
    /// Along the ray to ξ, z = c + i s has |e^{−ia} z|' = |z' − i a' z|. So the distance of z from e^{ia} is at most
    /// that at 0, plus Σ |ρᵣ|/deg r over the coefficients of ρ = E z − i z E a, where E multiplies each by its degree.
    pub fn sin_cos(&self, a: &[f64], sine: &mut [f64], cosine: &mut [f64], scratch: &mut ModelScratch) {
        let (x, e) = self.split(a);
        self.jets.sin_cos(x, self.split_mut(sine).0, self.split_mut(cosine).0, &mut scratch.jets);
        *self.split_mut(sine).1 = 0.0;
        *self.split_mut(cosine).1 = 0.0;
        let (exact_sine, exact_cosine) = Interval::point(x[0]).sin_cos();
        let mut missed = exact_sine.radius_about(sine[0]) + exact_cosine.radius_about(cosine[0]) + e;
        let [slope, residual, _] = &mut scratch.registers;
        self.slopes(a, slope);
        let slope_norms = self.norms(slope);
        let pairs: [(&[f64], &[f64], f64); 2] = [(sine, cosine, 1.0), (cosine, sine, -1.0)];
        for (this, other, sign) in pairs {
            self.jets.mul(self.split(other).0, self.split(slope).0, self.split_mut(residual).0);
            for ((&product, &c), &degree) in residual.iter().zip(this).zip(&self.degrees).skip(1) {
                let left = degree as f64 * c;
                missed += ((left - sign * product).abs() + 2.0 * f64::EPSILON * left.abs()) / degree as f64;
            }
            let norms = self.norms(other);
            missed += 2.0 * self.product_error(&norms, &slope_norms) + f64::EPSILON * norms.total * slope_norms.total;
        }
        let missed = up(missed);
        *self.split_mut(sine).1 = missed;
        *self.split_mut(cosine).1 = missed;
    }

    /// `out = function(a)`; unknown (an infinite radius) if the function is not smooth over the box.
    pub fn unary(&self, function: Unary, a: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        let (x, e) = self.split(a);
        match function {
            Unary::Neg => {
                self.jets.scale(-1.0, x, self.split_mut(out).0);
                *self.split_mut(out).1 = e;
            }
            Unary::Sqrt => self.sqrt(a, out, scratch),
            Unary::Abs | Unary::Sign if a.iter().all(|&c| c == 0.0) => out.fill(0.0),
            Unary::Abs | Unary::Sign if self.away_from_zero(x, &self.norms(a)) > 0.0 => {
                let sign = functions::sign(x[0]);
                if function == Unary::Sign {
                    return self.constant(Interval::point(sign), out);
                }
                self.jets.scale(sign, x, self.split_mut(out).0);
                *self.split_mut(out).1 = e;
            }
            Unary::Floor => {
                let range = self.range(a);
                self.constant(Interval::new(range.lower().floor(), range.upper().floor()), out);
            }
            Unary::Exp => self.exp(a, out, scratch),
            Unary::Log => self.log(a, out, scratch),
            Unary::Atan => self.atan(a, out, scratch),
            Unary::Tanh => self.tanh(a, out, scratch),
            Unary::Asin => self.asin(a, out, scratch),
            Unary::Acos => self.acos(a, out, scratch),
            Unary::Spline(spline, order) => self.spline(spline, order, a, out, scratch),
            Unary::Abs => self.with_spare(scratch, |opposite, _, _| {
                opposite.copy_from_slice(a);
                self.negate(opposite);
                self.extreme(Binary::Max, a, opposite, out);
            }),
            Unary::Sign if self.signs_are_ranges => self.constant(Interval::new(-1.0, 1.0), out),
            Unary::Sign => self.unknown(out),
            Unary::Sin => self.with_spare(scratch, |other, _, scratch| self.sin_cos(a, out, other, scratch)),
            Unary::Cos => self.with_spare(scratch, |other, _, scratch| self.sin_cos(a, other, out, scratch)),
            Unary::Tan => self.with_spare(scratch, |sine, cosine, scratch| {
                self.sin_cos(a, sine, cosine, scratch);
                self.div(sine, cosine, out, scratch);
            }),
        }
    }

    /// `out = function(a, b)`; unknown if the function may jump over the box.
    pub fn binary(&self, function: Binary, a: &[f64], b: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        match function {
            Binary::Add => self.add(a, b, out),
            Binary::Sub => self.sub(a, b, out),
            Binary::Mul => self.mul(a, b, out),
            Binary::Div => self.div(a, b, out, scratch),
            Binary::Select | Binary::SelectElse => match self.sign(a) {
                Some(sign) if (sign <= 0.0) == (function == Binary::SelectElse) => out.copy_from_slice(b),
                Some(_) => out.fill(0.0),
                None => self.unknown(out),
            },
            Binary::Min | Binary::Max => self.extreme(function, a, b, out),
            Binary::Pow => self.pow(a, b, out, scratch),
            Binary::Atan2 => self.atan2(a, b, out, scratch),
        }
    }

    /// The sign of a model over the whole box, if it has one; zero counts as negative.
    pub fn sign(&self, a: &[f64]) -> Option<f64> {
        let range = self.range(a);
        if range.upper() <= 0.0 { Some(-1.0) } else { (range.lower() > 0.0).then_some(1.0) }
    }

    /// Range of a model over the box.
    fn range(&self, a: &[f64]) -> Interval {
        let (polynomial, _) = self.split(a);
        let norms = self.norms(a);
        if norms.tails[1] == 0.0 && norms.radius == 0.0 {
            return Interval::point(polynomial[0]);
        }
        let spread = up(norms.tails[1] + norms.radius);
        Interval::point(polynomial[0]) + Interval::new(-spread, spread)
    }

    /// `out` = any number.
    pub(crate) fn unknown(&self, out: &mut [f64]) {
        self.constant(Interval::ENTIRE, out);
    }
}

#[cfg(test)]
mod tests;
