//! Functions of models beyond arithmetic, roots and waves: each from its defining equation, like those, or from others.
//!
//! Along the ray to ξ with s from 0 to 1, E multiplies each coefficient by its degree, and
//! ∫ |ρ(s ξ)|/s ds ≤ Σ |ρᵣ|/deg r:
//!
//! ```text
//! h ≈ eᵃ       (h e⁻ᵃ)' = e⁻ᵃ ρ/s           ρ = E h − h E a
//! h ≈ ln a     (h − ln a)' = ρ/(a s)         ρ = a E h − E a
//! h ≈ atan a   (h − atan a)' = ρ/((1 + a²) s)   ρ = (1 + a²) E h − E a
//! ```

use std::f64::consts::FRAC_PI_2;

use super::{HALF_UNIT, ModelScratch, ModelSpace, Norms, up};
use crate::eval::enclosed;
use crate::eval::interval::Interval;
use crate::expr::{Binary, Unary};
use crate::tuning::TUNING;

/// π/2, between the neighbours of its rounded value.
fn quarter_turn() -> Interval {
    Interval::new(FRAC_PI_2.next_down(), FRAC_PI_2.next_up())
}

impl ModelSpace {
    /// Σ |ρᵣ|/deg r of ρ = `product` − `right`, where `right` is rounded once.
    fn missed_along_rays(&self, product: &[f64], right: &[f64]) -> f64 {
        let mut missed = 0.0;
        for ((&product, &right), &degree) in product.iter().zip(right).zip(&self.degrees).skip(1) {
            missed += ((product - right).abs() + f64::EPSILON * right.abs()) / degree as f64;
        }
        missed
    }

    /// `out = E a`, rounded; its radius is zero.
    pub(super) fn slopes(&self, a: &[f64], out: &mut [f64]) {
        for ((slope, &c), &degree) in out.iter_mut().zip(a).zip(&self.degrees) {
            *slope = degree as f64 * c;
        }
        *self.split_mut(out).1 = 0.0;
    }

    /// Bound of the error of a product with rounded slopes.
    fn lost(&self, factor: &Norms, slopes: &Norms) -> f64 {
        self.product_error(factor, slopes) + f64::EPSILON * factor.total * slopes.total
    }

    /// `out = eᵃ`.
    pub(super) fn exp(&self, a: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        let (x, e) = self.split(a);
        self.jets.unary(Unary::Exp, x, self.split_mut(out).0, &mut scratch.jets);
        *self.split_mut(out).1 = 0.0;
        let [slope, product, _] = &mut scratch.registers;
        self.slopes(a, slope);
        self.jets.mul(self.split(out).0, self.split(slope).0, self.split_mut(product).0);
        let lost = self.lost(&self.norms(out), &self.norms(slope));
        self.slopes(out, slope);
        let missed = self.missed_along_rays(product, slope) + lost;
        let at_zero = enclosed::unary(Unary::Exp, Interval::point(x[0])).radius_about(out[0]);
        let spread = up(self.norms(a).tails[1]);
        let size = |x: f64| enclosed::unary(Unary::Exp, Interval::point(x)).upper();
        // |e^(p ± e) − eᵖ| ≤ eᵖ e eᵉ.
        let by_radius = if e == 0.0 { 0.0 } else { size((x[0] + spread).next_up()) * e * size(e) };
        *self.split_mut(out).1 = up(size(2.0 * spread) * (at_zero + missed) + by_radius);
    }

    /// `out = ln a`; unknown if a may be zero or negative.
    pub(super) fn log(&self, a: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        let (x, e) = self.split(a);
        let norms = self.norms(a);
        let least = self.away_from_zero(x, &norms);
        if x[0] <= 0.0 || least.is_nan() || least <= 0.0 {
            return self.unknown(out);
        }
        self.jets.unary(Unary::Log, x, self.split_mut(out).0, &mut scratch.jets);
        *self.split_mut(out).1 = 0.0;
        let [slope, product, _] = &mut scratch.registers;
        self.slopes(out, slope);
        self.jets.mul(x, self.split(slope).0, self.split_mut(product).0);
        let of_slope = self.norms(slope);
        self.slopes(a, slope);
        let missed = self.missed_along_rays(product, slope) + self.lost(&norms, &of_slope);
        let at_zero = enclosed::unary(Unary::Log, Interval::point(x[0])).radius_about(out[0]);
        *self.split_mut(out).1 = up(at_zero + up(missed + e) / least);
    }

    /// `out = atan a`.
    pub(super) fn atan(&self, a: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        let (x, e) = self.split(a);
        self.jets.unary(Unary::Atan, x, self.split_mut(out).0, &mut scratch.jets);
        *self.split_mut(out).1 = 0.0;
        let [slope, product, weight] = &mut scratch.registers;
        self.jets.mul(x, x, self.split_mut(weight).0);
        weight[0] += 1.0;
        *self.split_mut(weight).1 = 0.0;
        let of_argument = Norms { radius: 0.0, ..self.norms(a) };
        let cut = self.product_error(&of_argument, &of_argument) + f64::EPSILON * weight[0];
        self.slopes(out, slope);
        self.jets.mul(self.split(weight).0, self.split(slope).0, self.split_mut(product).0);
        let of_slope = self.norms(slope);
        let lost = self.lost(&self.norms(weight), &of_slope) + cut * of_slope.total;
        self.slopes(a, slope);
        let missed = self.missed_along_rays(product, slope) + lost;
        let at_zero = enclosed::unary(Unary::Atan, Interval::point(x[0])).radius_about(out[0]);
        *self.split_mut(out).1 = up(at_zero + missed + e);
    }

    /// `out = tanh a` = ± (1 − 2/(1 + e^{±2a})), with the sign for which the exponential is at most about 1.
    pub(super) fn tanh(&self, a: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        let sign = if a[0] > 0.0 { -1.0 } else { 1.0 };
        self.with_spare(scratch, |first, second, scratch| {
            self.scale(Interval::point(2.0 * sign), a, first);
            self.exp(first, second, scratch);
            self.shift(Interval::point(1.0), second);
            self.constant(Interval::point(-2.0 * sign), first);
            self.div(first, second, out, scratch);
            self.shift(Interval::point(sign), out);
        });
    }

    /// Calls `run` with two spare models.
    pub(super) fn with_spare(
        &self,
        scratch: &mut ModelScratch,
        run: impl FnOnce(&mut [f64], &mut [f64], &mut ModelScratch),
    ) {
        let [mut first, mut second] = std::mem::take(&mut scratch.spare);
        run(&mut first, &mut second, scratch);
        scratch.spare = [first, second];
    }

    /// `a += value`.
    pub(super) fn shift(&self, value: Interval, a: &mut [f64]) {
        let middle = value.middle();
        a[0] += middle;
        let rounding = HALF_UNIT * a[0].abs() + value.radius_about(middle);
        let radius = self.split_mut(a).1;
        *radius = up(*radius + rounding);
    }

    /// `a = −a`.
    pub(super) fn negate(&self, a: &mut [f64]) {
        self.split_mut(a).0.iter_mut().for_each(|c| *c = -*c);
    }

    /// `out = asin a` = atan(a/√(1 − a²)); unknown if |a| may be 1.
    pub(super) fn asin(&self, a: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        self.with_spare(scratch, |first, second, scratch| {
            // (1 − a) (1 + a) has no cancellation near the ends.
            first.copy_from_slice(a);
            self.negate(first);
            self.shift(Interval::point(1.0), first);
            second.copy_from_slice(a);
            self.shift(Interval::point(1.0), second);
            self.mul(first, second, out);
            self.sqrt(out, first, scratch);
            self.div(a, first, second, scratch);
            self.atan(second, out, scratch);
        });
    }

    /// `out = acos a` = π/2 − asin a.
    pub(super) fn acos(&self, a: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        self.asin(a, out, scratch);
        self.negate(out);
        self.shift(quarter_turn(), out);
    }

    /// `out = aᵇ`: multiplied out if b is an integer, e^{b ln a} if a is positive, and unknown otherwise.
    pub(super) fn pow(&self, a: &[f64], b: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        let (base, exponent) = (self.range(a), self.range(b));
        let is_point = |range: Interval| range.lower() == range.upper();
        if is_point(base) && is_point(exponent) {
            // Zero has powers, too.
            return self.constant(enclosed::binary(Binary::Pow, base, exponent), out);
        }
        let is_whole = is_point(exponent) && exponent.lower().fract() == 0.0;
        self.with_spare(scratch, |first, second, scratch| {
            if !is_whole || exponent.magnitude() > TUNING.factors_of_model {
                self.log(a, first, scratch);
                self.mul(b, first, second);
                return self.exp(second, out, scratch);
            }
            self.constant(Interval::point(1.0), out);
            for _ in 0..exponent.magnitude() as u32 {
                self.mul(out, a, first);
                out.copy_from_slice(first);
            }
            if exponent.lower() < 0.0 {
                self.constant(Interval::point(1.0), second);
                self.div(second, first, out, scratch);
            }
        });
    }

    /// `out` = the angle of (b, a): from a/b on the right of the second axis, from b/a above and below the first one,
    /// and unknown elsewhere.
    pub(super) fn atan2(&self, a: &[f64], b: &[f64], out: &mut [f64], scratch: &mut ModelScratch) {
        self.with_spare(scratch, |first, _, scratch| {
            if self.range(b).lower() > 0.0 {
                self.div(a, b, first, scratch);
                return self.atan(first, out, scratch);
            }
            let height = self.range(a);
            let turn = match (height.lower() > 0.0, height.upper() < 0.0) {
                (true, _) => quarter_turn(),
                (_, true) => -quarter_turn(),
                _ => return self.unknown(out),
            };
            self.div(b, a, first, scratch);
            self.atan(first, out, scratch);
            self.negate(out);
            self.shift(turn, out);
        });
    }

    /// `out` = the smaller or the larger of both: the one that is chosen in most of the box, with a radius for the
    /// excess of the other.
    pub(super) fn extreme(&self, function: Binary, a: &[f64], b: &[f64], out: &mut [f64]) {
        self.sub(a, b, out);
        let difference = self.range(out);
        let of_a = if function == Binary::Max { difference } else { -difference };
        // Largest excess of b over a, and of a over b, in the sense of the function.
        let [b_beyond, a_beyond] = [(-of_a.lower()).max(0.0), of_a.upper().max(0.0)];
        let (chosen, beyond) = if b_beyond <= a_beyond { (a, b_beyond) } else { (b, a_beyond) };
        out.copy_from_slice(chosen);
        if beyond != 0.0 {
            let radius = self.split_mut(out).1;
            *radius = up(*radius + beyond);
        }
    }
}
