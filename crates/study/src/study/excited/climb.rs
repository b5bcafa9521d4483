//! A climb to an end of an output over functions of the time and over the box: to where its gradient points.
//!
//! If an output is linear in the functions, the first step ends there: the worst function has the sign of the kernel,
//! h(t, τ) = ∂y(t)/∂u(τ), and the end is ∫ b |h| dτ (Balakrishnan & Boyd, Syst. Control Lett. 19 (1992) 265). Else the
//! kernel under that function is another one, and so is the function: u ← sign(Bᵀλ) until the end stops growing. A step
//! that is worse is halved.

use super::motions::{ExcitedMotions, WeightedPoint, functional, in_row};
use super::point::Point;
use super::tuning::TUNING;
use crate::numerics::{Worst, value};
use crate::simulate::Gradient;

/// A climb to an end.
pub struct FunctionClimb {
    pub row: usize,
    pub output: usize,
    /// 1 of the upper end, −1 of the lower.
    pub sign: f64,
    /// The best point, the value there (upwards), and the gain that gradients promise from there on.
    pub best: Option<(Point, f64)>,
    pub promise: f64,
    /// The same before halved steps have reduced it.
    pub promised: f64,
    /// The value at its start, upwards, and the gain that the gradient promised there.
    first: Option<(f64, f64)>,
    /// Part of each parameter, then of each input, in that promise.
    pub parts: Vec<f64>,
    /// Error of the cells at the best point.
    pub cells: f64,
    /// Improvement of the end by starts from elsewhere.
    pub improved: f64,
    /// The point to go to.
    pub next: Option<Point>,
    halvings: i32,
    /// Whether the point to go to is no end.
    is_guided: bool,
    /// Derivatives by the parameters (ξ) at the best point, upwards.
    slopes: Vec<f64>,
    /// By parameter: ξ and the derivative beyond its best value, as far as that is known.
    beyond: Vec<Option<(f64, f64)>>,
    /// Promise of the gradient at the best point, by parameter and input.
    promises: Vec<f64>,
}

impl FunctionClimb {
    /// A climb from a point.
    pub fn new(row: usize, output: usize, sign: f64, start: Point) -> Self {
        Self {
            row,
            output,
            sign,
            best: None,
            promise: f64::NAN,
            promised: f64::NAN,
            first: None,
            parts: Vec::new(),
            cells: f64::NAN,
            improved: 0.0,
            next: Some(start),
            halvings: 0,
            is_guided: false,
            slopes: Vec::new(),
            beyond: Vec::new(),
            promises: Vec::new(),
        }
    }

    /// A climb from the point to which the gradient at `guide` points. `guide` may lie outside the class: it is no end
    /// itself.
    pub fn guided(row: usize, output: usize, sign: f64, guide: Point) -> Self {
        Self { is_guided: true, ..Self::new(row, output, sign, guide) }
    }

    /// The value at its start, upwards.
    pub fn start(&self) -> Option<f64> {
        self.first.map(|(start, _)| start)
    }

    /// Distance of the best value from that at the start.
    pub fn gain(&self) -> f64 {
        self.best.as_ref().zip(self.start()).map_or(0.0, |((_, reached), start)| reached - start)
    }

    /// Distance that the end may still be off.
    pub fn open(&self) -> f64 {
        self.promise.max(0.0) + self.cells + self.improved
    }

    /// The point to go to, with the output that is asked for there.
    pub fn asked(&self) -> Option<WeightedPoint<'_>> {
        self.next.as_ref().map(|point| (point, in_row(self.row, self.output)))
    }

    /// The best value, upwards.
    pub fn reached(&self) -> f64 {
        self.best.as_ref().map_or(f64::NEG_INFINITY, |(_, value)| *value)
    }

    /// Takes the value at the point that it went to, if that is where the gradient said: the end of an output that is
    /// linear. Whether it is.
    pub fn arrive(&mut self, value: f64) -> bool {
        let reached = self.sign * value;
        let Some((start, promise)) = self.first else { return false };
        let beside = (reached - start - promise).abs();
        let arrives = beside <= TUNING.bent * promise;
        if arrives && let Some(point) = self.next.take() {
            self.promise = beside;
            self.best = Some((point, reached));
        }
        arrives
    }

    /// Takes the result of a climb to the same end from elsewhere, if it is better.
    pub fn learn(&mut self, other: Self) {
        let gain = other.reached() - self.reached();
        if gain > 0.0 {
            self.improved = self.improved.max(if gain.is_finite() { gain } else { 0.0 });
            (self.best, self.promise, self.cells) = (other.best, other.promise, other.cells);
            (self.promised, self.promises) = (other.promised, other.promises);
            (self.slopes, self.beyond) = (other.slopes, other.beyond);
        }
    }

    /// Takes the value and the gradient at the point that it went to.
    pub fn take(&mut self, found: &Gradient, motions: &ExcitedMotions) {
        let Some(point) = self.next.take() else { return };
        let reached = self.sign * found.value;
        let before = self.reached();
        // A point that cannot be simulated is no better.
        let is_better = reached > before;
        let scaled = |(axis, by): (usize, &f64)| self.sign * by * motions.study.domain.half_width(axis);
        let slopes: Vec<f64> = found.by_parameters.iter().enumerate().map(scaled).collect();
        if !is_better {
            self.step_back(&point, &slopes);
            return;
        }
        self.halvings = 0;
        let passed = |axis: usize| self.slopes[axis] * slopes[axis] < 0.0;
        let before = self.best.as_ref().map(|(best, _)| &best.xi);
        self.beyond = match before {
            Some(xi) => (0..slopes.len())
                .map(|axis| if passed(axis) { Some((xi[axis], self.slopes[axis])) } else { self.beyond[axis] })
                .collect(),
            None => vec![None; slopes.len()],
        };
        self.slopes = slopes;
        let (worst, parts, cells) = self.along(found, &point, motions);
        let promise: f64 = parts.iter().sum();
        let (_, first) = *self.first.get_or_insert((reached, promise));
        if self.parts.is_empty() {
            self.parts.clone_from(&parts);
        }
        self.next = (promise > TUNING.worth_of_step * first).then_some(worst);
        (self.promise, self.promised, self.cells) = (promise, promise, cells);
        self.promises = parts;
        if std::mem::take(&mut self.is_guided) {
            self.first = None;
            return;
        }
        self.best = Some((point, reached));
    }

    /// Steps back from a point that is no better: halfway to it. Parameters that have passed their best value go to the
    /// zero of the secant of their derivatives.
    fn step_back(&mut self, point: &Point, slopes: &[f64]) {
        let Some((best, _)) = &self.best else { return };
        self.halvings += 1;
        let mut next = best.halfway(point);
        for (axis, (own, other)) in self.slopes.iter().zip(slopes).enumerate() {
            if own * other < 0.0 && (point.xi[axis] - best.xi[axis]) * own > 0.0 {
                self.beyond[axis] = Some((point.xi[axis], *other));
            }
            if let Some((target, promise)) = secant(best.xi[axis], *own, self.beyond[axis]) {
                next.xi[axis] = target;
                self.promises[axis] = promise;
            }
        }
        self.promise = self.promises.iter().sum();
        self.promised = self.promise;
        if self.halvings <= TUNING.halvings {
            self.next = Some(next);
        } else {
            // A part of the step that gains nothing bounds the gain of the whole step, along its line.
            self.promise *= 0.5_f64.powi(self.halvings - 1);
        }
    }

    /// The point to which a gradient points, its promise there by each parameter and each input, and the cost of cells.
    fn along(&self, found: &Gradient, from: &Point, motions: &ExcitedMotions) -> (Point, Vec<f64>, f64) {
        let mut worst = from.clone();
        let mut parts = vec![0.0; found.by_parameters.len()];
        let mut cost = 0.0;
        for (axis, &by) in self.slopes.iter().enumerate().filter(|(_, by)| **by != 0.0) {
            let to_corner = (by.signum(), by * (by.signum() - from.xi[axis]));
            (worst.xi[axis], parts[axis]) = secant(from.xi[axis], by, self.beyond[axis]).unwrap_or(to_corner);
        }
        // Functions of the parameters to go to.
        let classes = motions.classes(&worst.xi);
        for (input, class) in classes.iter().enumerate() {
            let functional = functional(found, self.sign, input, classes.len());
            let Worst { value: largest, function, loss } = class.worst(&motions.ends, &functional);
            parts.push(largest - value(&functional, &from.functions[input]));
            cost += loss;
            worst.functions[input] = function;
        }
        (worst, parts, cost)
    }
}

/// The zero of the secant of two derivatives, and the gain of a parabola there; for a parameter at `xi` with a
/// derivative `slope`, whose sign is another `beyond`.
fn secant(xi: f64, slope: f64, beyond: Option<(f64, f64)>) -> Option<(f64, f64)> {
    let (other, by) = beyond.filter(|(other, by)| slope * by < 0.0 && (other - xi) * slope > 0.0)?;
    let target = xi + slope * (other - xi) / (slope - by);
    Some((target, 0.5 * slope * (target - xi)))
}
