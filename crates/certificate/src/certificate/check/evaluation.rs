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
    /// By position i at i, velocity i at n + i, acceleration i at 2n + i, multiplier i at 3n + i.
    pub by: BTreeMap<usize, Vec<f64>>,
}

/// What a motion is, in columns.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub q: Models,
    pub v: Models,
    pub w: Models,
    pub lambda: Models,
}

impl State {
    /// The same of each column.
    pub fn map(&self, of: impl Fn(&Models) -> Models) -> Self {
        Self { q: of(&self.q), v: of(&self.v), w: of(&self.w), lambda: of(&self.lambda) }
    }

    /// Without radii.
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
        match function {
            Unary::Sin | Unary::Cos => {
                let mut other = self.new_model();
                let (sine, cosine) =
                    if function == Unary::Sin { (&mut out, &mut other) } else { (&mut other, &mut out) };
                self.space.sin_cos(a, sine, cosine, &mut self.scratch);
            }
            Unary::Tan => {
                let [sine, cosine] = [Unary::Sin, Unary::Cos].map(|part| self.unary(part, a));
                return self.binary(Binary::Div, &sine, &cosine);
            }
            _ => self.space.unary(function, a, &mut out, &mut self.scratch),
        }
        out
    }

    fn binary(&mut self, function: Binary, a: &[f64], b: &[f64]) -> Vec<f64> {
        let mut out = self.new_model();
        self.space.binary(function, a, b, &mut out, &mut self.scratch);
        out
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
        let one = |arithmetic: &Self| {
            let mut one = arithmetic.new_model();
            one[0] = 1.0;
            one
        };
        let slope = match function {
            Unary::Neg => self.unary(Unary::Neg, &one(self)),
            Unary::Sin => self.unary(Unary::Cos, &a.value),
            Unary::Cos => {
                let sine = self.unary(Unary::Sin, &a.value);
                self.unary(Unary::Neg, &sine)
            }
            Unary::Tan => {
                let square = self.binary(Binary::Mul, &value, &value);
                self.binary(Binary::Add, &one(self), &square)
            }
            Unary::Sqrt => {
                let twice = self.binary(Binary::Add, &value, &value);
                self.binary(Binary::Div, &one(self), &twice)
            }
            Unary::Abs => self.unary(Unary::Sign, &a.value),
            // Constant where its sign is known, and unknown elsewhere.
            Unary::Sign => return Dual { value, by: BTreeMap::new() },
            // No derivative shows a jump, and the others have no enclosure.
            _ => return self.unknown(),
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
                for (from, other) in [(a, b), (b, a)] {
                    for (&index, own) in &from.by {
                        let product = self.binary(Binary::Mul, own, &other.value);
                        self.add(&mut by, index, product);
                    }
                }
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
            // Nothing is known of them where the condition has no sign.
            Binary::Select | Binary::SelectElse => {
                by.extend(b.by.iter().map(|(&index, own)| (index, self.binary(function, &a.value, own))));
            }
            _ => return self.unknown(),
        }
        Dual { value, by }
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
