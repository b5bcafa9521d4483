//! Equations over Taylor models, with their derivatives by forward differentiation.

use std::collections::BTreeMap;

use symdiff::taylor_model::{ModelScratch, ModelSpace, up};
use symdiff::{Binary, Interval, Unary};

use super::super::matrix::Models;
use super::super::{Equations, Node};

/// A number and its derivatives, a model each; a derivative that is not there is zero.
#[derive(Clone, Debug)]
pub(super) struct Dual {
    pub value: Vec<f64>,
    /// Derivatives: by position i at i, velocity i at n + i, acceleration i at 2n + i, multiplier i at 3n + i.
    pub by: BTreeMap<usize, Vec<f64>>,
}

/// Positions, velocities, accelerations and multipliers of a motion, one column each.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub q: Models,
    pub v: Models,
    pub w: Models,
    pub lambda: Models,
}

impl State {
    /// The state with a function applied to each column.
    pub fn map(&self, of: impl Fn(&Models) -> Models) -> Self {
        Self { q: of(&self.q), v: of(&self.v), w: of(&self.w), lambda: of(&self.lambda) }
    }

    /// The state without radii.
    pub fn bare(&self) -> Self {
        self.map(|models| models.clone().without_radii())
    }

    /// Adds to the radii of positions and velocities, 2n.
    pub fn widen(&mut self, space: &ModelSpace, by: &[f64]) {
        let (n, last) = (self.q.rows, space.size() - 1);
        for (row, by) in by.iter().enumerate() {
            let model = if row < n { self.q.at_mut(row, 0) } else { self.v.at_mut(row - n, 0) };
            model[last] = up(model[last] + by);
        }
    }
}

/// Time and parameters.
pub(super) struct Given<'g> {
    pub space: &'g ModelSpace,
    pub time: &'g [f64],
    pub parameters: &'g [Vec<f64>],
}

/// The arithmetic of one evaluation.
struct Arithmetic<'a> {
    space: &'a ModelSpace,
    scratch: ModelScratch,
}

impl Arithmetic<'_> {
    fn new_model(&self) -> Vec<f64> {
        vec![0.0; self.space.size()]
    }

    fn unary(&mut self, function: Unary, a: &[f64]) -> Vec<f64> {
        let mut out = self.new_model();
        self.space.unary(function, a, &mut out, &mut self.scratch);
        out
    }

    fn binary(&mut self, function: Binary, a: &[f64], b: &[f64]) -> Vec<f64> {
        let mut out = self.new_model();
        self.space.binary(function, a, b, &mut out, &mut self.scratch);
        out
    }

    fn number(&self, number: f64) -> Vec<f64> {
        let mut value = self.new_model();
        value[0] = number;
        value
    }

    /// 1 + sign a².
    fn one_and_square(&mut self, sign: f64, a: &[f64]) -> Vec<f64> {
        let square = self.binary(Binary::Mul, a, a);
        let (one, function) = (self.number(1.0), if sign > 0.0 { Binary::Add } else { Binary::Sub });
        self.binary(function, &one, &square)
    }

    /// a − 1; without a radius if `a` is a number and the difference is exact.
    fn one_less(&mut self, a: &[f64]) -> Vec<f64> {
        let less = a[0] - 1.0;
        // The difference is exact where it gives the number back.
        if less + 1.0 == a[0] && a[1..].iter().all(|&c| c == 0.0) {
            return self.number(less);
        }
        let one = self.number(1.0);
        self.binary(Binary::Sub, a, &one)
    }

    /// number / a.
    fn inverse(&mut self, number: f64, a: &[f64]) -> Vec<f64> {
        let number = self.number(number);
        self.binary(Binary::Div, &number, a)
    }

    fn unknown(&self) -> Dual {
        let mut value = self.new_model();
        self.space.constant(Interval::ENTIRE, &mut value);
        Dual { value, by: BTreeMap::new() }
    }

    fn of_unary(&mut self, function: Unary, a: &Dual) -> Dual {
        let value = self.unary(function, &a.value);
        if a.by.is_empty() {
            return Dual { value, by: BTreeMap::new() };
        }
        let slope = match function {
            Unary::Neg => self.number(-1.0),
            Unary::Sin => self.unary(Unary::Cos, &a.value),
            Unary::Cos => {
                let sine = self.unary(Unary::Sin, &a.value);
                self.unary(Unary::Neg, &sine)
            }
            // 1 + h²
            Unary::Tan => self.one_and_square(1.0, &value),
            // 1 − h²
            Unary::Tanh => self.one_and_square(-1.0, &value),
            Unary::Sqrt => {
                let twice = self.binary(Binary::Add, &value, &value);
                self.inverse(1.0, &twice)
            }
            Unary::Exp => value.clone(),
            Unary::Log => self.inverse(1.0, &a.value),
            Unary::Atan => {
                let size = self.one_and_square(1.0, &a.value);
                self.inverse(1.0, &size)
            }
            Unary::Asin | Unary::Acos => {
                let square = self.one_and_square(-1.0, &a.value);
                let root = self.unary(Unary::Sqrt, &square);
                self.inverse(if function == Unary::Asin { 1.0 } else { -1.0 }, &root)
            }
            Unary::Abs => self.unary(Unary::Sign, &a.value),
            Unary::Spline(spline, order) => self.unary(Unary::Spline(spline, order + 1), &a.value),
            // The derivative is zero where the sign is known. Elsewhere the sign jumps with the motion, and no
            // derivative shows it.
            Unary::Sign if self.space.sign(&a.value).is_some() => return Dual { value, by: BTreeMap::new() },
            Unary::Sign => return self.unknown(),
            // No derivative shows a jump.
            Unary::Floor => return self.unknown(),
        };
        let by = a.by.iter().map(|(&index, own)| (index, self.binary(Binary::Mul, &slope, own))).collect();
        Dual { value, by }
    }

    fn of_binary(&mut self, function: Binary, a: &Dual, b: &Dual) -> Dual {
        let value = self.binary(function, &a.value, &b.value);
        if a.by.is_empty() && b.by.is_empty() {
            return Dual { value, by: BTreeMap::new() };
        }
        let mut by = BTreeMap::new();
        match function {
            Binary::Add | Binary::Sub => {
                by.clone_from(&a.by);
                for (&index, own) in &b.by {
                    let signed = if function == Binary::Add { own.clone() } else { self.unary(Unary::Neg, own) };
                    self.add(&mut by, index, signed);
                }
            }
            Binary::Mul => {
                self.chain(&mut by, &b.value, a);
                self.chain(&mut by, &a.value, b);
            }
            Binary::Div => {
                // (a/b)' = (a' − (a/b) b') / b.
                by.clone_from(&a.by);
                for (&index, own) in &b.by {
                    let product = self.binary(Binary::Mul, &value, own);
                    let product = self.unary(Unary::Neg, &product);
                    self.add(&mut by, index, product);
                }
                by.values_mut().for_each(|own| *own = self.binary(Binary::Div, own, &b.value));
            }
            Binary::Pow => {
                // (aᵇ)' = b aᵇ⁻¹ a' + aᵇ ln a b'.
                let less = self.one_less(&b.value);
                let power = self.binary(Binary::Pow, &a.value, &less);
                let slope = self.binary(Binary::Mul, &b.value, &power);
                self.chain(&mut by, &slope, a);
                if !b.by.is_empty() {
                    let log = self.unary(Unary::Log, &a.value);
                    let slope = self.binary(Binary::Mul, &value, &log);
                    self.chain(&mut by, &slope, b);
                }
            }
            Binary::Atan2 => {
                // atan2(a, b)' = (b a' − a b')/(a² + b²).
                let squares = [a, b].map(|own| self.binary(Binary::Mul, &own.value, &own.value));
                let size = self.binary(Binary::Add, &squares[0], &squares[1]);
                let by_a = self.binary(Binary::Div, &b.value, &size);
                let by_b = self.binary(Binary::Div, &a.value, &size);
                let by_b = self.unary(Unary::Neg, &by_b);
                self.chain(&mut by, &by_a, a);
                self.chain(&mut by, &by_b, b);
            }
            // max(a, b)' = (1 ± s) a'/2 + (1 ∓ s) b'/2, where s is the sign of a − b, or anything between −1 and 1.
            Binary::Min | Binary::Max => {
                let difference = self.binary(Binary::Sub, &a.value, &b.value);
                let sign = self.unary(Unary::Sign, &difference);
                let half = self.number(0.5);
                let shift = self.binary(Binary::Mul, &half, &sign);
                let shares = [Binary::Add, Binary::Sub].map(|side| self.binary(side, &half, &shift));
                let [first, second] = if function == Binary::Max { [a, b] } else { [b, a] };
                self.chain(&mut by, &shares[0], first);
                self.chain(&mut by, &shares[1], second);
            }
            // Nothing is known of them where the condition has no sign.
            Binary::Select | Binary::SelectElse => {
                by.extend(b.by.iter().map(|(&index, own)| (index, self.binary(function, &a.value, own))));
            }
        }
        Dual { value, by }
    }

    /// Adds `slope` times the derivatives of a number.
    fn chain(&mut self, by: &mut BTreeMap<usize, Vec<f64>>, slope: &[f64], of: &Dual) {
        for (&index, own) in &of.by {
            let term = self.binary(Binary::Mul, slope, own);
            self.add(by, index, term);
        }
    }

    fn add(&mut self, by: &mut BTreeMap<usize, Vec<f64>>, index: usize, term: Vec<f64>) {
        let sum = match by.get(&index) {
            Some(known) => self.binary(Binary::Add, known, &term),
            None => term,
        };
        by.insert(index, sum);
    }
}

/// Values of nodes that are needed (all that they need among them), and their derivatives where these are wanted.
pub(super) fn evaluate(
    equations: &Equations,
    needed: &[usize],
    given: &Given,
    state: &State,
    derive: bool,
) -> Vec<Option<Dual>> {
    let Given { space, time, parameters } = *given;
    let mut arithmetic = Arithmetic { space, scratch: ModelScratch::new(space) };
    let n = equations.coordinates;
    let mut found: Vec<Option<Dual>> = vec![None; equations.nodes.len()];
    let constant = |value: &[f64]| Dual { value: value.to_vec(), by: BTreeMap::new() };
    let variable = |models: &Models, row: usize, index: usize, arithmetic: &Arithmetic| {
        let mut one = arithmetic.new_model();
        one[0] = 1.0;
        let by = if derive { BTreeMap::from([(index, one)]) } else { BTreeMap::new() };
        Dual { value: models.at(row, 0).to_vec(), by }
    };
    for &index in needed {
        // Children are needed too, and come first.
        let of = |child: usize| found[child].as_ref().map_or_else(|| arithmetic.unknown(), Dual::clone);
        let value = match equations.nodes[index] {
            Node::Number(number) => {
                let mut value = arithmetic.new_model();
                value[0] = number;
                constant(&value)
            }
            Node::Time => constant(time),
            Node::Parameter(index) => constant(&parameters[index]),
            Node::Position(index) => variable(&state.q, index, index, &arithmetic),
            Node::Velocity(index) => variable(&state.v, index, n + index, &arithmetic),
            Node::Acceleration(index) => variable(&state.w, index, 2 * n + index, &arithmetic),
            Node::Multiplier(index) => variable(&state.lambda, index, 3 * n + index, &arithmetic),
            Node::Unknown => arithmetic.unknown(),
            Node::Unary(function, a) => {
                let a = of(a);
                arithmetic.of_unary(function, &a)
            }
            Node::Binary(function, a, b) => {
                let (a, b) = (of(a), of(b));
                arithmetic.of_binary(function, &a, &b)
            }
        };
        found[index] = Some(value);
    }
    found
}
