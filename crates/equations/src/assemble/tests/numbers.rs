//! Numbers for symbols, and small dense solves.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};
use symdiff::{Expr, Graph};

use crate::assemble::System;

/// A value for each symbol.
#[derive(Clone)]
pub struct State(pub HashMap<Expr, f64>);

impl State {
    /// Made-up values in (−1, 1) for q, v, w and λ, t = 0.7, nominal parameters.
    pub fn random(system: &System, seed: u64) -> Self {
        let mut bits = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut next = || {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            (bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for _ in 0..10 {
            next();
        }
        let mut values: HashMap<Expr, f64> =
            system.parameters.iter().map(|parameter| (parameter.symbol, parameter.nominal)).collect();
        values.insert(system.time, 0.7);
        for symbol in [&system.q, &system.v, &system.w, &system.lambda].into_iter().flatten() {
            values.insert(*symbol, next());
        }
        Self(values)
    }

    /// A state at rest at given positions, with nominal parameters, at t = 0.
    pub fn at(system: &System, positions: &[f64]) -> Self {
        let mut state = Self::random(system, 1);
        for symbol in [&system.v, &system.w, &system.lambda].into_iter().flatten().chain([&system.time]) {
            state.0.insert(*symbol, 0.0);
        }
        state.0.extend(system.q.iter().copied().zip(positions.iter().copied()));
        state
    }

    /// The same motion, a little later.
    pub fn later(&self, system: &System, h: f64) -> Self {
        let mut state = self.clone();
        for ((q, v), w) in system.q.iter().zip(&system.v).zip(&system.w) {
            let (velocity, acceleration) = (self.0[v], self.0[w]);
            *state.0.get_mut(q).unwrap() += h * velocity + h * h / 2.0 * acceleration;
            *state.0.get_mut(v).unwrap() += h * acceleration;
        }
        *state.0.get_mut(&system.time).unwrap() += h;
        state
    }

    pub fn values(&self, g: &Graph, exprs: &[Expr]) -> Vec<f64> {
        g.evaluate(exprs, |symbol| self.0[&symbol])
    }

    pub fn value(&self, g: &Graph, expr: Expr) -> f64 {
        self.values(g, &[expr])[0]
    }

    pub fn list(&self, symbols: &[Expr]) -> Vec<f64> {
        symbols.iter().map(|symbol| self.0[symbol]).collect()
    }
}

pub fn output(system: &System, name: &str) -> Expr {
    system.outputs.iter().find(|output| output.name == name).unwrap().expr
}

#[track_caller]
pub fn assert_close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * 1.0f64.max(a.abs()).max(b.abs()), "{a} is not {b}");
}

#[track_caller]
pub fn assert_all_close(a: &[f64], b: &[f64], tolerance: f64) {
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        assert_close(*a, *b, tolerance);
    }
}

/// M w.
pub fn inertia_times(system: &System, state: &State) -> Vec<f64> {
    let mut product = vec![0.0; system.q.len()];
    for &(row, column, value) in &system.mass {
        product[row] += state.value(&system.graph, value) * state.0[&system.w[column]];
    }
    product
}

/// Φ_qᵀ λ, n.
pub fn constraint_forces(system: &mut System, state: &State) -> Vec<f64> {
    let jacobian = system.graph.jacobian(&system.constraint, &system.q);
    let mut forces = vec![0.0; system.q.len()];
    for (row, column, value) in jacobian.entries() {
        forces[column] += state.value(&system.graph, value) * state.0[&system.lambda[row]];
    }
    forces
}

/// d/dt of an expression over t, q and v.
pub fn time_derivative(system: &mut System, of: Expr) -> Expr {
    let g = &mut system.graph;
    let mut total = g.derivative(of, system.time);
    for ((&q, &v), &w) in system.q.iter().zip(&system.v).zip(&system.w) {
        for (by, rate) in [(q, v), (v, w)] {
            let slope = g.derivative(of, by);
            let part = g.mul(slope, rate);
            total = g.add(total, part);
        }
    }
    total
}

/// Sets w and λ by solving the equations of motion and the twice differentiated constraints.
pub fn solve_motion(system: &mut System, state: &mut State) {
    let (n, m) = (system.q.len(), system.lambda.len());
    let mut matrix = DMatrix::zeros(n + m, n + m);
    let mut right = DVector::zeros(n + m);
    for &(row, column, value) in &system.mass {
        matrix[(row, column)] += state.value(&system.graph, value);
    }
    let jacobian = system.graph.jacobian(&system.constraint, &system.q);
    for (row, column, value) in jacobian.entries() {
        let value = state.value(&system.graph, value);
        matrix[(n + row, column)] = value;
        matrix[(column, n + row)] = value;
    }
    for (row, value) in state.values(&system.graph, &system.force).into_iter().enumerate() {
        right[row] = value;
    }
    for (row, phi) in system.constraint.clone().into_iter().enumerate() {
        let first = time_derivative(system, phi);
        let second = time_derivative(system, first);
        let mut still = state.clone();
        still.0.extend(system.w.iter().map(|&w| (w, 0.0)));
        right[n + row] = -still.value(&system.graph, second);
    }
    let solution = matrix.lu().solve(&right).unwrap();
    for (symbol, &value) in system.w.iter().chain(&system.lambda).zip(solution.iter()) {
        state.0.insert(*symbol, value);
    }
}
