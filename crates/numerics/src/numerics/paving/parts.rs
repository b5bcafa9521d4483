//! A box with the Bernstein coefficients of the quantities that are not decided on it.

use super::{Tubes, volume};
use crate::numerics::bernstein::{from_chebyshev, halve};
use crate::numerics::range::Range;
use crate::numerics::tensor::{Separable, Work};

/// Sizes of the polynomials.
pub(super) struct Shape {
    orders: Vec<usize>,
    /// Coefficients of one quantity.
    size: usize,
    conversion: Separable,
}

/// A box.
#[derive(Clone, Debug)]
pub(super) struct PavingBox {
    /// Lower ends (k), then upper ends (k).
    pub ends: Vec<f64>,
    /// Quantities that are not decided.
    pub rows: Vec<u32>,
    /// Their Bernstein coefficients, quantity by quantity.
    coefficients: Vec<f64>,
}

impl Shape {
    pub fn new(orders: &[usize]) -> Self {
        let conversion = Separable::new(orders.iter().map(|&order| from_chebyshev(order)).collect());
        Self { orders: orders.to_vec(), size: orders.iter().map(|order| order + 1).product(), conversion }
    }

    pub fn dimension(&self) -> usize {
        self.orders.len()
    }

    /// Largest difference of neighbours along each axis, times the degree: a bound of the slope.
    fn slopes(&self, coefficients: &[f64], slopes: &mut [f64], weight: f64) {
        let mut block = self.size;
        for (slope, order) in slopes.iter_mut().zip(&self.orders) {
            let inner = block / (order + 1);
            let pairs = coefficients.chunks_exact(block).flat_map(|lines| lines.iter().zip(lines.iter().skip(inner)));
            let most = pairs.fold(0.0_f64, |most, (a, b)| most.max((b - a).abs()));
            *slope += weight * *order as f64 * most;
            block = inner;
        }
    }
}

impl PavingBox {
    /// The box [−1, 1]^k with all quantities.
    pub fn whole(shape: &Shape, tubes: &Tubes) -> Self {
        let mut work = Work::default();
        let lines = tubes.coefficients.chunks_exact(shape.size);
        let coefficients = lines.flat_map(|line| shape.conversion.apply(line, &mut work).clone()).collect();
        let k = shape.dimension();
        let ends = [vec![-1.0; k], vec![1.0; k]].concat();
        // Fewer than 2³² measured values.
        Self { ends, rows: (0..tubes.outer.len() as u32).collect(), coefficients }
    }

    pub fn numbers(&self) -> usize {
        self.coefficients.len()
    }

    /// Volume as a share of the whole box.
    pub fn volume(&self) -> f64 {
        let (lower, upper) = self.ends.split_at(self.ends.len() / 2);
        volume(lower, upper)
    }

    pub fn middle(&self) -> Vec<f64> {
        let (lower, upper) = self.ends.split_at(self.ends.len() / 2);
        lower.iter().zip(upper).map(|(lower, upper)| 0.5 * (lower + upper)).collect()
    }

    /// Quantities with bounds of their values.
    pub fn ranges(&self, shape: &Shape) -> impl Iterator<Item = (usize, Range)> {
        let ranges = self.coefficients.chunks_exact(shape.size).map(Range::of);
        self.rows.iter().map(|&row| row as usize).zip(ranges)
    }

    /// The first quantity about its plane through averages of the corners: slopes by the shares of the edges (k), then
    /// the value at the lower corner; and the largest distance from it.
    pub fn linear(&self, shape: &Shape) -> (Vec<f64>, f64) {
        let line = &self.coefficients[..shape.size];
        let k = shape.dimension();
        let index = |corner: usize| {
            shape.orders.iter().enumerate().fold(0, |at, (axis, n)| at * (n + 1) + (corner >> axis & 1) * n)
        };
        let corners: Vec<f64> = (0..1_usize << k).map(|corner| line[index(corner)]).collect();
        let half = (corners.len() / 2).max(1) as f64;
        let slope = |axis: usize| {
            let signed =
                corners.iter().enumerate().map(|(own, value)| if own >> axis & 1 == 1 { *value } else { -value });
            signed.sum::<f64>() / half
        };
        let mut linear: Vec<f64> = (0..k).map(slope).collect();
        let middle = corners.iter().sum::<f64>() / corners.len() as f64;
        linear.push(middle - 0.5 * linear.iter().sum::<f64>());
        // Bernstein coefficients of a plane are its values at the grid's points.
        let mut error = 0.0_f64;
        for (flat, value) in line.iter().enumerate() {
            let (mut rest, mut plane) = (flat, linear[k]);
            for axis in (0..k).rev() {
                let order = shape.orders[axis];
                plane += linear[axis] * (rest % (order + 1)) as f64 / order.max(1) as f64;
                rest /= order + 1;
            }
            error = error.max((value - plane).abs());
        }
        (linear, error)
    }

    /// Removes the quantities that are decided; `None` if one is impossible.
    pub fn classified(self, shape: &Shape, tubes: &Tubes) -> Option<Self> {
        let is_beyond = |row: usize, range: Range| {
            let [lower, upper] = tubes.outer[row];
            range.upper < lower || range.lower > upper
        };
        if self.ranges(shape).any(|own| is_beyond(own.0, own.1)) {
            return None;
        }
        let is_open = |row: usize, range: Range| {
            let [lower, upper] = tubes.inner[row];
            !(range.lower >= lower && range.upper <= upper)
        };
        Some(self.only(shape, is_open))
    }

    /// Keeps some of its quantities.
    pub fn only(mut self, shape: &Shape, is_kept: impl Fn(usize, Range) -> bool) -> Self {
        let mut kept = 0;
        for index in 0..self.rows.len() {
            let own = index * shape.size..(index + 1) * shape.size;
            if is_kept(self.rows[index] as usize, Range::of(&self.coefficients[own.clone()])) {
                self.rows[kept] = self.rows[index];
                self.coefficients.copy_within(own, kept * shape.size);
                kept += 1;
            }
        }
        self.rows.truncate(kept);
        self.coefficients.truncate(kept * shape.size);
        self
    }

    /// Halves along the axis on which the quantities change the most.
    pub fn halves(self, shape: &Shape, tubes: &Tubes) -> [Self; 2] {
        let mut slopes = vec![0.0; shape.dimension()];
        for (row, line) in self.rows.iter().zip(self.coefficients.chunks_exact(shape.size)) {
            shape.slopes(line, &mut slopes, tubes.scales[*row as usize].recip());
        }
        let axis = (0..slopes.len()).max_by(|&a, &b| slopes[a].total_cmp(&slopes[b])).unwrap_or(0);
        let Self { ends, rows, coefficients: mut right } = self;
        let mut left = Vec::with_capacity(right.len());
        let mut half = Vec::new();
        for line in right.chunks_exact_mut(shape.size) {
            halve(&shape.orders, axis, line, &mut half);
            left.extend_from_slice(&half);
        }
        let k = shape.dimension();
        let middle = 0.5 * (ends[axis] + ends[k + axis]);
        let (mut of_left, mut of_right) = (ends.clone(), ends);
        (of_left[k + axis], of_right[axis]) = (middle, middle);
        let left = Self { ends: of_left, rows: rows.clone(), coefficients: left };
        [left, Self { ends: of_right, rows, coefficients: right }]
    }
}
