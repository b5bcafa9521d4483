//! Polynomials of time and parameters over a cell, and of the parameters alone.
//!
//! Variable 0 of a cell's polynomials is τ ∈ [−1, 1] with t = middle + half τ, the others are ξ. Half the cell's length
//! is a power of two and its ends are multiples of it, so that t(τ) has no rounding.

use symdiff::Interval;
use symdiff::taylor_model::{MAX_ORDER, ModelSpace, up};

use super::matrix::Models;
use super::tuning::TUNING;

/// Half a unit in the last place, rounded up.
const HALF_UNIT: f64 = 0.51 * f64::EPSILON;

/// Polynomials of (τ, ξ) next to those of ξ, of the same order. Signs are ranges: an enclosure of a motion refuses
/// signs of it that are not known.
#[derive(Clone, Debug)]
pub struct Space {
    /// Polynomials of (τ, ξ).
    pub cell: ModelSpace,
    /// Polynomials of ξ.
    pub box_of: ModelSpace,
    /// Power of τ in each monomial of (τ, ξ).
    power: Vec<usize>,
    /// Monomial of ξ that is left without τ.
    without_time: Vec<usize>,
    /// Monomial of (τ, ξ) without τ, for each of ξ.
    constant_in_time: Vec<usize>,
    /// Monomial with one more τ, where the order allows it.
    raised: Vec<Option<usize>>,
    /// Monomial with one less τ, if it has τ.
    lowered: Vec<Option<usize>>,
    /// Range of each monomial's powers of ξ.
    of_parameters: Vec<Interval>,
    /// Range of each power of τ, in each of the parts of [−1, 1].
    of_time: Vec<Vec<Interval>>,
}

/// An interval of time: t = middle + half τ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// s
    pub middle: f64,
    /// s, a power of two.
    pub half: f64,
}

impl Cell {
    /// Last instant, s.
    pub fn end(self) -> f64 {
        self.middle + self.half
    }
}

impl Space {
    /// In `parameters` parameters.
    pub fn new(parameters: usize, order: usize) -> Self {
        let [cell, box_of] =
            [parameters + 1, parameters].map(|variables| ModelSpace::new(variables, order).with_ranges_of_signs());
        let (all, own) = (cell.jets().monomials(), box_of.jets().monomials());
        let index = |exponents: &[usize]| (0..all.len()).find(|&r| all.exponents(r) == exponents);
        let index_of_own = |exponents: &[usize]| (0..own.len()).find(|&r| own.exponents(r) == exponents);
        let with_power = |r: usize, power: Option<usize>| {
            let mut exponents = all.exponents(r).to_vec();
            exponents[0] = power?;
            index(&exponents)
        };
        let power: Vec<usize> = (0..all.len()).map(|r| all.exponents(r)[0]).collect();
        let without_time = (0..all.len()).filter_map(|r| index_of_own(&all.exponents(r)[1..])).collect();
        let constant_in_time = (0..own.len()).filter_map(|r| index(&[&[0], own.exponents(r)].concat())).collect();
        let raised = (0..all.len()).map(|r| with_power(r, Some(power[r] + 1))).collect();
        let lowered = (0..all.len()).map(|r| with_power(r, power[r].checked_sub(1))).collect();
        let of_parameters = (0..all.len()).map(|r| match &all.exponents(r)[1..] {
            exponents if exponents.iter().all(|e| *e == 0) => Interval::point(1.0),
            exponents if exponents.iter().all(|e| e % 2 == 0) => Interval::new(0.0, 1.0),
            _ => Interval::new(-1.0, 1.0),
        });
        let of_parameters = of_parameters.collect();
        let part = |part: i32| {
            // No part has zero inside: powers are monotone there.
            let ends = [part, part + 1].map(|end| Interval::point(f64::from(end) / f64::from(TUNING.parts_of_cell)));
            let mut powers = [Interval::point(1.0); 2];
            let mut next = || {
                let range = powers[0].hull(powers[1]);
                powers = [powers[0] * ends[0], powers[1] * ends[1]];
                range
            };
            (0..=order).map(|_| next()).collect()
        };
        let of_time = (-TUNING.parts_of_cell..TUNING.parts_of_cell).map(part).collect();
        Self { of_parameters, of_time, power, without_time, constant_in_time, raised, lowered, cell, box_of }
    }

    /// Range of a model of (τ, ξ).
    pub fn range(&self, model: &[f64]) -> Interval {
        let radius = model[model.len() - 1];
        let error = Interval::new(-radius, radius);
        let part = |powers: &Vec<Interval>| {
            let terms = model.iter().zip(&self.power).zip(&self.of_parameters);
            let terms = terms.filter(|((c, _), _)| **c != 0.0);
            terms.fold(error, |sum, ((&c, &power), &xi)| sum + Interval::point(c) * powers[power] * xi)
        };
        self.of_time.iter().map(part).reduce(Interval::hull).unwrap_or(Interval::ENTIRE)
    }

    /// A polynomial of ξ as one of (τ, ξ).
    pub fn lift(&self, of_box: &[f64], into: &mut [f64]) {
        into.fill(0.0);
        self.constant_in_time.iter().zip(of_box).for_each(|(&r, &c)| into[r] = c);
    }

    /// The model at an instant τ ∈ [−1, 1], which is known to the relative rounding error of two operations.
    pub fn at(&self, model: &[f64], tau: f64, into: &mut [f64]) {
        into.fill(0.0);
        let (mut size, mut slope) = (0.0, 0.0);
        let order = self.cell.jets().monomials().order();
        let mut powers = [0.0; MAX_ORDER + 1];
        powers[..=order].iter_mut().enumerate().for_each(|(power, of_tau)| *of_tau = tau.powi(power as i32));
        for ((&c, &power), &to) in model.iter().zip(&self.power).zip(&self.without_time) {
            into[to] += c * powers[power];
            size += c.abs();
            slope += power as f64 * c.abs();
        }
        let order = order as f64;
        // A power has at most twice `order` roundings, and a sum at most order + 1 terms; ends are exact.
        let roundings = if tau.abs() == 1.0 { 0.0 } else { 2.0 * order };
        let late = if tau.abs() == 1.0 { 0.0 } else { 2.0 * f64::EPSILON * slope };
        let radius = model[model.len() - 1] + HALF_UNIT * (order + 3.0 + roundings) * size + late;
        into[self.box_of.size() - 1] = up(radius);
    }

    /// Polynomial of `constant` + `half` ∫ model dτ from τ = −1, without powers above the order.
    pub fn integral(&self, constant: &[f64], half: f64, model: &[f64], into: &mut [f64]) {
        self.lift(constant, into);
        for (r, &raised) in self.raised.iter().enumerate() {
            let Some(raised) = raised else { continue };
            let power = self.power[raised];
            let c = model[r] * half / power as f64;
            into[raised] += c;
            let start = self.constant_in_time[self.without_time[raised]];
            into[start] -= if power.is_multiple_of(2) { c } else { -c };
        }
    }

    /// Polynomial with `shift` + `scale` τ in place of τ.
    pub fn substituted(&self, model: &[f64], shift: f64, scale: f64, into: &mut [f64]) {
        into.fill(0.0);
        for (r, &power) in self.power.iter().enumerate().filter(|(r, _)| model[*r] != 0.0) {
            // C(power, j) shift^(power − j) scale^j, from j = power down.
            let (mut to, mut factor) = (Some(r), scale.powi(power as i32));
            for j in (0..=power).rev() {
                let Some(index) = to else { break };
                into[index] += model[r] * factor;
                factor *= shift / scale * j as f64 / (power - j + 1) as f64;
                to = self.lowered[index];
            }
        }
    }

    /// d/dt of a polynomial, with its rounding as radius.
    pub fn rate(&self, model: &[f64], half: f64, into: &mut [f64]) {
        into.fill(0.0);
        let mut size = 0.0;
        for (r, &lowered) in self.lowered.iter().enumerate() {
            let Some(lowered) = lowered else { continue };
            // The quotient by a power of two is exact.
            let c = model[r] * self.power[r] as f64 / half;
            into[lowered] = c;
            size += c.abs();
        }
        into[self.cell.size() - 1] = up(HALF_UNIT * size);
    }

    /// Σ|c| over the monomials of the order's last degree with τ, where each power of τ is multiplied by a factor.
    pub fn last_in_time(&self, model: &[f64], of_power: f64) -> f64 {
        let monomials = self.cell.jets().monomials();
        let last = |r: &usize| monomials.degree(*r) == monomials.order() && self.power[*r] > 0;
        (0..monomials.len()).filter(last).map(|r| model[r].abs() * of_power.powi(self.power[r] as i32)).sum()
    }

    /// Σ|c| over the monomials of high degree without τ, by the power that a parameter has in each.
    pub fn last_of_parameter(&self, model: &[f64], axis: usize) -> f64 {
        let monomials = self.box_of.jets().monomials();
        let high = (0..monomials.len()).filter(|own| 2 * monomials.degree(*own) > monomials.order());
        high.map(|own| model[self.constant_in_time[own]].abs() * monomials.exponents(own)[axis] as f64).sum()
    }

    /// Σ|c| over the monomials of the order's last degree without τ: the polynomial's end in ξ.
    pub fn last_in_parameters(&self, model: &[f64]) -> f64 {
        let (monomials, order) = (self.box_of.jets().monomials(), self.cell.jets().monomials().order());
        let last = |own: &usize| monomials.degree(*own) == order && order > 0 && monomials.variables() > 0;
        (0..monomials.len()).filter(last).map(|own| model[self.constant_in_time[own]].abs()).sum()
    }
}

/// Copies a model into one of lower order; the cut-off terms become radius.
pub fn truncate(model: &[f64], to: &ModelSpace, into: &mut [f64]) {
    // Monomials ascend in degree: those of the lower order come first.
    let kept = to.size() - 1;
    into[..kept].copy_from_slice(&model[..kept]);
    into[kept] = up(model[kept..model.len() - 1].iter().map(|c| c.abs()).sum::<f64>() + model[model.len() - 1]);
}

/// A matrix at an instant.
pub fn matrix_at(space: &Space, matrix: &Models, tau: f64) -> Models {
    let mut at = Models::zero(&space.box_of, matrix.rows, matrix.columns);
    for row in 0..matrix.rows {
        for column in 0..matrix.columns {
            space.at(matrix.at(row, column), tau, at.at_mut(row, column));
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_and_differentiated() {
        let space = Space::new(1, 4);
        let size = space.cell.size();
        // w = (1 + ξ) τ over t = 3 + τ/4.
        let (mut w, mut v, mut rate) = (vec![0.0; size], vec![0.0; size], vec![0.0; size]);
        let monomials = space.cell.jets().monomials();
        let index = |exponents: [usize; 2]| (0..size - 1).find(|&r| monomials.exponents(r) == exponents).unwrap();
        w[index([1, 0])] = 1.0;
        w[index([1, 1])] = 1.0;
        space.integral(&[0.5, 0.0, 0.0, 0.0, 0.0], 0.25, &w, &mut v);
        // v(τ) = 0.5 + (1 + ξ) (τ² − 1)/8.
        let mut end = vec![0.0; space.box_of.size()];
        space.at(&v, 1.0, &mut end);
        assert_eq!(end[..3], [0.5, 0.0, 0.0]);
        space.at(&v, 0.0, &mut end);
        assert_eq!(end[..3], [0.375, -0.125, 0.0]);
        assert!(end[space.box_of.size() - 1] < 1e-14);
        space.rate(&v, 0.25, &mut rate);
        assert_eq!(rate[..size - 1], w[..size - 1]);
        // (2 + τ/2)² = 4 + 2 τ + τ²/4.
        let (mut square, mut moved) = (vec![0.0; size], vec![0.0; size]);
        square[index([2, 0])] = 1.0;
        space.substituted(&square, 2.0, 0.5, &mut moved);
        assert_eq!([[0, 0], [1, 0], [2, 0]].map(|exponents| moved[index(exponents)]), [4.0, 2.0, 0.25]);
    }

    #[test]
    fn ranges_over_a_cell_are_tight_in_time() {
        let space = Space::new(1, 4);
        let monomials = space.cell.jets().monomials();
        let index =
            |exponents: [usize; 2]| (0..monomials.len()).find(|&r| monomials.exponents(r) == exponents).unwrap();
        let mut model = vec![0.0; space.cell.size()];
        // 2 + τ − τ² + 0.25 ξ ± 0.125: from 0 − 0.375 to 2.25 + 0.375.
        for (exponents, c) in [([0, 0], 2.0), ([1, 0], 1.0), ([2, 0], -1.0), ([0, 1], 0.25)] {
            model[index(exponents)] = c;
        }
        *model.last_mut().unwrap() = 0.125;
        let range = space.range(&model);
        assert!(range.lower() <= -0.375 && range.lower() > -0.475, "{range:?}");
        assert!(range.upper() >= 2.625 && range.upper() < 2.7, "{range:?}");
    }

    #[test]
    fn truncated_terms_become_radius() {
        let (wide, narrow) = (ModelSpace::new(2, 3), ModelSpace::new(2, 1));
        let mut model: Vec<f64> = (1..=wide.size()).map(|c| c as f64).collect();
        model[4] = -5.0;
        let mut cut = vec![0.0; narrow.size()];
        truncate(&model, &narrow, &mut cut);
        assert_eq!(cut[..3], [1.0, 2.0, 3.0]);
        // 4 + 5 + … + 10, and the radius 11.
        assert!((60.0..60.001).contains(&cut[3]));
    }
}
