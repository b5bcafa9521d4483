//! Jets: polynomials of several variables, cut off after a total degree, as numbers to calculate with.
//!
//! A jet a(ξ) = Σ aᵣ ξ^r is the slice of its coefficients in the order of [`Monomials`]; `a[0]` is its value at ξ = 0
//! and is computed by the same scalar functions as anywhere else, to the bit. Functions follow from their differential
//! equations. Let E = Σ ξᵢ ∂/∂ξᵢ, which multiplies the coefficient of a monomial of degree d by d. Then h = f(a) has E
//! h = f'(a) E a: one sum over products for each coefficient, as in univariate automatic differentiation with the
//! degree instead of the index. Each function's equation is next to its code.
//!
//! At a kink of a function the branch is that of the constant term, and for a constant term at the kink itself the mean
//! of both sides, as in [`Graph::derivative`](crate::Graph::derivative). At a singularity (√0, log 0, asin 1, …) the
//! coefficients are infinite or NaN, unless the argument is a constant.

mod memory;
mod monomials;

use rustc_hash::FxHashMap;

use crate::eval::functions;
use crate::expr::{Binary, Unary};

pub use memory::JetMemory;
pub use monomials::Monomials;

/// Table of products of two monomials, for jets of one shape. Immutable: one serves all threads.
#[derive(Clone, Debug)]
pub struct JetSpace {
    monomials: Monomials,
    /// Total degree of each monomial.
    degrees: Vec<f64>,
    /// All (i, j) with ξ^i ξ^j = ξ^r, for each r in turn; i ascends, so (0, r) is first and (r, 0) last.
    products: Vec<[u32; 2]>,
    /// Start of the pairs of each r in `products`, and the end.
    starts: Vec<usize>,
    /// The r with ξ^i ξ^j = ξ^r, for each i in turn and each j up to the order.
    targets: Vec<u32>,
    /// Start of the targets of each i in `targets`, and the end.
    rows: Vec<usize>,
}

/// Memory for intermediate jets, so that no operation allocates.
#[derive(Clone, Debug)]
pub struct JetScratch {
    registers: [Vec<f64>; 4],
}

impl JetScratch {
    /// Memory for jets of this shape.
    pub fn new(space: &JetSpace) -> Self {
        Self { registers: std::array::from_fn(|_| vec![0.0; space.len()]) }
    }
}

/// Σ xᵢ yⱼ.
#[inline]
fn sum(pairs: &[[u32; 2]], x: &[f64], y: &[f64]) -> f64 {
    pairs.iter().map(|&[i, j]| x[i as usize] * y[j as usize]).sum()
}

fn is_constant(a: &[f64]) -> bool {
    a[1..].iter().all(|&c| c == 0.0)
}

/// Every slice that an operation takes has [`len`](JetSpace::len) coefficients; a shorter one panics.
impl JetSpace {
    /// Jets of `variables` variables up to the total degree `order`.
    pub fn new(variables: usize, order: usize) -> Self {
        let monomials = Monomials::new(variables, order);
        let count = monomials.len();
        let index: FxHashMap<&[usize], usize> = (0..count).map(|r| (monomials.exponents(r), r)).collect();
        let mut by_result = vec![Vec::new(); count];
        let mut exponents = vec![0; variables];
        let (mut targets, mut rows) = (Vec::new(), vec![0]);
        for i in 0..count {
            for j in (0..count).take_while(|&j| monomials.degree(i) + monomials.degree(j) <= order) {
                for (power, (a, b)) in
                    exponents.iter_mut().zip(monomials.exponents(i).iter().zip(monomials.exponents(j)))
                {
                    *power = a + b;
                }
                let r = index[exponents.as_slice()];
                by_result[r].push([i as u32, j as u32]);
                targets.push(r as u32);
            }
            rows.push(targets.len());
        }
        let mut starts = vec![0];
        for pairs in &by_result {
            starts.push(starts[starts.len() - 1] + pairs.len());
        }
        let degrees = (0..count).map(|r| monomials.degree(r) as f64).collect();
        Self { degrees, products: by_result.concat(), starts, targets, rows, monomials }
    }

    /// Number of coefficients.
    #[allow(clippy::len_without_is_empty)] // the constant is always there
    pub fn len(&self) -> usize {
        self.degrees.len()
    }

    /// The monomials of the coefficients.
    pub fn monomials(&self) -> &Monomials {
        &self.monomials
    }

    /// All (i, j) with ξ^i ξ^j = ξ^r.
    #[inline]
    fn pairs(&self, r: usize) -> &[[u32; 2]] {
        &self.products[self.starts[r]..self.starts[r + 1]]
    }

    /// The pairs without i = 0.
    #[inline]
    fn upper(&self, r: usize) -> &[[u32; 2]] {
        &self.products[self.starts[r] + 1..self.starts[r + 1]]
    }

    /// The pairs without i = 0 and j = 0; r > 0.
    #[inline]
    fn inner(&self, r: usize) -> &[[u32; 2]] {
        &self.products[self.starts[r] + 1..self.starts[r + 1] - 1]
    }

    /// `out = value`.
    pub fn constant(&self, value: f64, out: &mut [f64]) {
        out.fill(0.0);
        out[0] = value;
    }

    /// `out = value + slope ξ_variable`; with order 0, `value`.
    pub fn variable(&self, variable: usize, value: f64, slope: f64, out: &mut [f64]) {
        self.constant(value, out);
        if self.monomials.order() > 0 {
            out[1 + variable] = slope;
        }
    }

    /// `out = factor · a`.
    pub fn scale(&self, factor: f64, a: &[f64], out: &mut [f64]) {
        out.iter_mut().zip(a).for_each(|(h, a)| *h = factor * a);
    }

    /// `out = a b`.
    pub fn mul(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        if is_constant(a) {
            return self.scale(a[0], b, out);
        }
        if is_constant(b) {
            return self.scale(b[0], a, out);
        }
        // −0 changes no number by addition, not even its sign.
        out.fill(-0.0);
        self.accumulate(a, b, out);
    }

    /// `out += a b`.
    pub fn accumulate(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        // Row by row of the products' table: one factor's products go to as many sums, so that no addition waits for
        // the one before. Each sum is in the order of i.
        for (&factor, row) in a.iter().zip(self.rows.windows(2)) {
            for (&r, y) in self.targets[row[0]..row[1]].iter().zip(b) {
                out[r as usize] += factor * y;
            }
        }
    }

    /// `out = a b + c`.
    pub fn mul_add(&self, a: &[f64], b: &[f64], c: &[f64], out: &mut [f64]) {
        self.mul(a, b, out);
        out.iter_mut().zip(c).for_each(|(h, c)| *h += c);
    }

    /// `out = a b - c`.
    pub fn mul_sub(&self, a: &[f64], b: &[f64], c: &[f64], out: &mut [f64]) {
        self.mul(a, b, out);
        out.iter_mut().zip(c).for_each(|(h, c)| *h -= c);
    }

    /// `out = c - a b`.
    pub fn sub_mul(&self, a: &[f64], b: &[f64], c: &[f64], out: &mut [f64]) {
        self.mul(a, b, out);
        out.iter_mut().zip(c).for_each(|(h, c)| *h = c - *h);
    }

    /// `out = a / b`: h b = a.
    pub fn div(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        if is_constant(b) {
            return out.iter_mut().zip(a).for_each(|(h, a)| *h = a / b[0]);
        }
        out[0] = a[0] / b[0];
        for r in 1..self.len() {
            out[r] = (a[r] - sum(self.upper(r), b, out)) / b[0];
        }
    }

    /// `sine = sin a`, `cosine = cos a`: E s = c E a, E c = -s E a.
    pub fn sin_cos(&self, a: &[f64], sine: &mut [f64], cosine: &mut [f64], scratch: &mut JetScratch) {
        self.sin_cos_with(a, sine, cosine, &mut scratch.registers[0]);
    }

    fn sin_cos_with(&self, a: &[f64], sine: &mut [f64], cosine: &mut [f64], slope: &mut [f64]) {
        self.euler(a, slope);
        sine[0] = functions::unary(Unary::Sin, a[0]);
        cosine[0] = functions::unary(Unary::Cos, a[0]);
        for r in 1..self.len() {
            let (s, c) = (sum(self.upper(r), slope, cosine), sum(self.upper(r), slope, sine));
            sine[r] = s / self.degrees[r];
            cosine[r] = -c / self.degrees[r];
        }
    }

    /// `out = function(a)`.
    pub fn unary(&self, function: Unary, a: &[f64], out: &mut [f64], scratch: &mut JetScratch) {
        let value = functions::unary(function, a[0]);
        // A constant stays constant, even if the function is singular there.
        if is_constant(a) {
            return self.constant(value, out);
        }
        let [first, second, third, _] = &mut scratch.registers;
        match function {
            Unary::Neg => out.iter_mut().zip(a).for_each(|(h, a)| *h = -a),
            Unary::Sin => self.sin_cos_with(a, out, first, second),
            Unary::Cos => self.sin_cos_with(a, first, out, second),
            // E h = (1 ± h²) E a
            Unary::Tan => self.tangent(a, 1.0, value, out, first, second),
            Unary::Tanh => self.tangent(a, -1.0, value, out, first, second),
            // √(1 - a²) E h = ± E a
            Unary::Asin | Unary::Acos => {
                self.euler(a, first);
                self.mul(a, a, second);
                second.iter_mut().for_each(|c| *c = -*c);
                second[0] = (1.0 - a[0]) * (1.0 + a[0]);
                self.root(second, third);
                if function == Unary::Acos {
                    first.iter_mut().for_each(|c| *c = -*c);
                }
                self.integrate(first, third, value, out, second);
            }
            // (1 + a²) E h = E a
            Unary::Atan => {
                self.euler(a, first);
                self.mul(a, a, second);
                second[0] += 1.0;
                self.integrate(first, second, value, out, third);
            }
            Unary::Sqrt => self.root(a, out),
            Unary::Exp => self.exponential(a, value, out, first),
            // a E h = E a
            Unary::Log => {
                self.euler(a, first);
                self.integrate(first, a, value, out, second);
            }
            Unary::Abs => {
                self.scale(functions::sign(a[0]), a, out);
                out[0] = value;
            }
            Unary::Sign | Unary::Floor => self.constant(value, out),
            // A polynomial in a − a₀, by Horner.
            Unary::Spline(spline, order) => {
                let [constant, linear, square, cube] = spline.taylor(order, a[0]);
                first.copy_from_slice(a);
                first[0] = 0.0;
                self.constant(cube, out);
                for coefficient in [square, linear, constant] {
                    self.mul(first, out, second);
                    out.copy_from_slice(second);
                    out[0] = coefficient;
                }
            }
        }
    }

    /// `out = function(a, b)`.
    pub fn binary(&self, function: Binary, a: &[f64], b: &[f64], out: &mut [f64], scratch: &mut JetScratch) {
        match function {
            Binary::Add => out.iter_mut().zip(a.iter().zip(b)).for_each(|(h, (a, b))| *h = a + b),
            Binary::Sub => out.iter_mut().zip(a.iter().zip(b)).for_each(|(h, (a, b))| *h = a - b),
            Binary::Mul => self.mul(a, b, out),
            Binary::Div => self.div(a, b, out),
            Binary::Pow => self.power(a, b, out, scratch),
            Binary::Atan2 => self.atan2(a, b, out, scratch),
            Binary::Min | Binary::Max => {
                let first_wins = if function == Binary::Min { a[0] < b[0] } else { a[0] > b[0] };
                if first_wins {
                    out.copy_from_slice(a);
                } else if a[0] == b[0] {
                    out.iter_mut().zip(a.iter().zip(b)).for_each(|(h, (a, b))| *h = 0.5 * (a + b));
                } else {
                    out.copy_from_slice(b);
                }
                out[0] = functions::binary(function, a[0], b[0]);
            }
            Binary::Select | Binary::SelectElse if (a[0] <= 0.0) == (function == Binary::SelectElse) => {
                out.copy_from_slice(b);
            }
            Binary::Select | Binary::SelectElse => out.fill(0.0),
        }
    }

    /// `out = E a`.
    fn euler(&self, a: &[f64], out: &mut [f64]) {
        out.iter_mut().zip(a.iter().zip(&self.degrees)).for_each(|(h, (a, degree))| *h = degree * a);
    }

    /// The h with h(0) = `value` and w E h = `right`: the equation of the coefficients at r, solved for w₀ (E h)ᵣ.
    fn integrate(&self, right: &[f64], w: &[f64], value: f64, out: &mut [f64], slope: &mut [f64]) {
        out[0] = value;
        slope[0] = 0.0;
        for r in 1..self.len() {
            slope[r] = (right[r] - sum(self.inner(r), slope, w)) / w[0];
            out[r] = slope[r] / self.degrees[r];
        }
    }

    /// `out = √a`: h h = a.
    fn root(&self, a: &[f64], out: &mut [f64]) {
        out[0] = functions::unary(Unary::Sqrt, a[0]);
        for r in 1..self.len() {
            out[r] = (a[r] - sum(self.inner(r), out, out)) / (2.0 * out[0]);
        }
    }

    /// The h with h(0) = `value` and E h = h E a.
    fn exponential(&self, a: &[f64], value: f64, out: &mut [f64], slope: &mut [f64]) {
        self.euler(a, slope);
        out[0] = value;
        for r in 1..self.len() {
            out[r] = sum(self.upper(r), slope, out) / self.degrees[r];
        }
    }

    /// The h with h(0) = `value` and E h = (1 + sign h²) E a.
    fn tangent(&self, a: &[f64], sign: f64, value: f64, out: &mut [f64], slope: &mut [f64], outer: &mut [f64]) {
        self.euler(a, slope);
        out[0] = value;
        outer[0] = 1.0 + sign * (value * value);
        for r in 1..self.len() {
            out[r] = sum(self.upper(r), slope, outer) / self.degrees[r];
            outer[r] = sign * sum(self.pairs(r), out, out);
        }
    }

    /// `out = a^b`. For a constant b = p: a E h = p h E a. Otherwise h = exp(b log a): E h = h E(b log a).
    fn power(&self, a: &[f64], b: &[f64], out: &mut [f64], scratch: &mut JetScratch) {
        let value = functions::binary(Binary::Pow, a[0], b[0]);
        let [first, second, third, fourth] = &mut scratch.registers;
        if !is_constant(b) {
            self.euler(a, first);
            self.integrate(first, a, functions::unary(Unary::Log, a[0]), second, third);
            self.mul(b, second, fourth);
            return self.exponential(fourth, value, out, first);
        }
        let p = b[0];
        if is_constant(a) {
            self.constant(value, out);
        } else if a[0] == 0.0 && p >= 0.0 && p.fract() == 0.0 {
            // Integer powers are polynomials; each factor without a constant term raises the least degree by one.
            self.constant(1.0, out);
            if p > self.monomials.order() as f64 {
                out.fill(0.0);
            } else {
                for _ in 0..p as usize {
                    self.mul(a, out, first);
                    out.copy_from_slice(first);
                }
            }
            out[0] = value;
        } else {
            out[0] = value;
            for r in 1..self.len() {
                let term = |&[i, j]: &[u32; 2]| {
                    let (i, j) = (i as usize, j as usize);
                    (p * self.degrees[i] - self.degrees[j]) * a[i] * out[j]
                };
                out[r] = self.upper(r).iter().map(term).sum::<f64>() / (self.degrees[r] * a[0]);
            }
        }
    }

    /// `out = atan2(a, b)`: (a² + b²) E h = b E a - a E b.
    fn atan2(&self, a: &[f64], b: &[f64], out: &mut [f64], scratch: &mut JetScratch) {
        let value = functions::binary(Binary::Atan2, a[0], b[0]);
        if is_constant(a) && is_constant(b) {
            return self.constant(value, out);
        }
        let [first, second, third, right] = &mut scratch.registers;
        self.euler(a, first);
        self.euler(b, second);
        self.mul(b, first, third);
        self.mul(a, second, right);
        right.iter_mut().zip(third.iter()).for_each(|(right, third)| *right = third - *right);
        self.mul(a, a, first);
        self.mul_add(b, b, first, second);
        self.integrate(right, second, value, out, third);
    }
}
