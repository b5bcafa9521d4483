//! Modes of mechanisms with states: vibrations and lags, how they are followed over the box, and their results.
//!
//! A pair σ ± iω is a vibration of frequency |λ| and damping ratio −σ/|λ|, a real eigenvalue a lag of time constant
//! −1/λ; the growth is Re λ. A vibration of the nominal parameters stays one where it becomes two real eigenvalues,
//! √(λ₁λ₂) and −(λ₁ + λ₂)/(2√(λ₁λ₂)), and two lags that become a pair both have its real part.

use std::f64::consts::TAU;

use nalgebra::Complex;

use super::first_order::{Eigenvalue, size};
use crate::numerics::{RowSpace, dot};
use crate::simulate::statics::{Linearised, times};

/// Kind of a mode with the nominal parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeKind {
    /// A pair of eigenvalues.
    Vibration,
    /// A real eigenvalue.
    Lag,
}

/// A mode with its eigenvalues: one pair, one that is real, or two; none where it was not found again.
#[derive(Clone, Debug)]
pub struct Root {
    pub kind: ModeKind,
    pub of: Vec<Eigenvalue>,
}

/// Changes of outputs with a mode.
pub struct OutputChanges<'l> {
    linear: &'l Linearised,
    /// Row space of Φ_q.
    space: RowSpace,
    /// Rows by output: by q, v, w and λ.
    gradients: &'l [Vec<Vec<f64>>; 4],
}

/// Eigenvalues that may be those of known modes.
struct Match {
    likeness: f64,
    known: Vec<usize>,
    found: Vec<usize>,
}

impl ModeKind {
    /// Names and units of a mode's results.
    pub fn quantities(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Vibration => &[("frequency", "Hz"), ("damping", ""), ("growth", "1/s")],
            Self::Lag => &[("time_constant", "s"), ("growth", "1/s")],
        }
    }
}

impl Root {
    /// A mode of an eigenvalue.
    pub fn of(eigenvalue: Eigenvalue) -> Self {
        let kind = if eigenvalue.is_pair() { ModeKind::Vibration } else { ModeKind::Lag };
        Self { kind, of: vec![eigenvalue] }
    }

    /// Results in the order of the quantities. NaN: the time constant of a constant, and the damping without a
    /// vibration.
    pub fn told(&self) -> Vec<f64> {
        let growth = self.growth();
        match (self.kind, self.of.as_slice()) {
            (ModeKind::Vibration, [pair]) => {
                let frequency = size(pair.value);
                vec![frequency / TAU, -growth / frequency, growth]
            }
            (ModeKind::Vibration, [a, b]) => {
                let (sum, product) = (a.value.re + b.value.re, a.value.re * b.value.re);
                let frequency = product.abs().sqrt();
                let damping = if product > 0.0 { -sum / (2.0 * frequency) } else { f64::NAN };
                vec![if product < 0.0 { -frequency } else { frequency } / TAU, damping, growth]
            }
            (ModeKind::Lag, [_]) if growth != 0.0 => vec![-1.0 / growth, growth],
            (ModeKind::Lag, [_]) => vec![f64::NAN, growth],
            (kind, _) => vec![f64::NAN; kind.quantities().len()],
        }
    }

    /// |λ|/2π of its eigenvalues, Hz.
    pub fn frequencies(&self) -> impl Iterator<Item = f64> {
        self.of.iter().map(|own| size(own.value) / TAU)
    }

    /// The largest real part; NaN without eigenvalues.
    fn growth(&self) -> f64 {
        self.slowest().map_or(f64::NAN, |slowest| slowest.value.re)
    }

    /// The eigenvalue with the largest real part.
    pub fn slowest(&self) -> Option<&Eigenvalue> {
        self.of.iter().reduce(|a, b| if b.value.re > a.value.re { b } else { a })
    }

    /// Number of eigenvalues that it has in common with another configuration's.
    fn shared(&self, found: &Eigenvalue) -> f64 {
        if self.kind == ModeKind::Lag && found.value == Complex::new(0.0, 0.0) && self.growth() == 0.0 {
            return 1.0;
        }
        let part = |own: &Eigenvalue| if self.kind == ModeKind::Lag && own.is_pair() { 0.5 } else { 1.0 };
        self.of.iter().map(|own| part(own) * own.shared(found)).sum()
    }
}

impl<'l> OutputChanges<'l> {
    /// Changes about a configuration.
    pub fn of(linear: &'l Linearised, gradients: &'l [Vec<Vec<f64>>; 4]) -> Self {
        Self { linear, space: RowSpace::of(&linear.jacobian, linear.motion.len()), gradients }
    }

    /// Real and imaginary part of each output's change.
    pub fn of_root(&self, root: &Root) -> Vec<[f64; 2]> {
        let [by_q, by_v, by_w, by_lambda] = self.gradients;
        let Some(own) = root.slowest() else { return vec![[f64::NAN; 2]; by_q.len()] };
        let (positions, velocities) = own.right.split_at(own.right.len() / 2);
        let accelerations: Vec<Complex<f64>> = velocities.iter().map(|rate| own.value * rate).collect();
        let parts = |of: fn(&Complex<f64>) -> f64| {
            let [q, v, w] =
                [positions, velocities, &accelerations].map(|part| part.iter().map(of).collect::<Vec<f64>>());
            let [held, damped, inertial] =
                [(&self.linear.stiffness, &q), (&self.linear.damping, &v), (&self.linear.mass, &w)]
                    .map(|(matrix, vector)| times(matrix, vector));
            let rest: Vec<f64> = (0..held.len()).map(|row| -(held[row] + damped[row] + inertial[row])).collect();
            let reactions = self.space.multipliers(&rest, by_lambda.first().map_or(0, Vec::len));
            let change = |output: usize| {
                let moved = dot(&by_q[output], &q) + dot(&by_v[output], &v) + dot(&by_w[output], &w);
                moved + dot(&by_lambda[output], &reactions)
            };
            (0..by_q.len()).map(change).collect::<Vec<f64>>()
        };
        parts(|entry| entry.re).into_iter().zip(parts(|entry| entry.im)).map(|(re, im)| [re, im]).collect()
    }
}

/// The eigenvalues that are those of known modes, in their order, and the least likeness. The most alike are matched
/// first.
pub fn followed(known: &[Root], found: &[Eigenvalue]) -> (Vec<Root>, f64) {
    let mut matches = matches(known, found);
    matches.sort_by(|a, b| b.likeness.total_cmp(&a.likeness).then((&a.known, &a.found).cmp(&(&b.known, &b.found))));
    let mut modes: Vec<Root> = known.iter().map(|root| Root { kind: root.kind, of: Vec::new() }).collect();
    let mut taken = vec![false; found.len()];
    let mut least = 1.0_f64;
    for Match { likeness, known, found: own } in matches {
        if known.iter().all(|&mode| modes[mode].of.is_empty()) && !own.iter().any(|&index| taken[index]) {
            known.iter().for_each(|&mode| modes[mode].of = own.iter().map(|&index| found[index].clone()).collect());
            own.iter().for_each(|&index| taken[index] = true);
            least = least.min(likeness);
        }
    }
    let is_missing = modes.iter().any(|mode| mode.of.is_empty());
    (modes, if is_missing { 0.0 } else { least })
}

/// A vibration may be a pair or two real eigenvalues, a lag a real one, two lags a pair.
fn matches(known: &[Root], found: &[Eigenvalue]) -> Vec<Match> {
    let shared: Vec<Vec<f64>> = known.iter().map(|root| found.iter().map(|own| root.shared(own)).collect()).collect();
    let (pairs, real): (Vec<usize>, Vec<usize>) = (0..found.len()).partition(|&index| found[index].is_pair());
    let two = |places: &[usize]| -> Vec<[usize; 2]> {
        (0..places.len()).flat_map(|b| (0..b).map(move |a| [a, b])).map(|two| two.map(|index| places[index])).collect()
    };
    let of_kind = |kind: ModeKind| (0..known.len()).filter(move |&mode| known[mode].kind == kind);
    let mut matches = Vec::new();
    let mut add = |known: &[usize], found: &[usize], eigenvalues: usize| {
        let all: f64 = known
            .iter()
            .flat_map(|&mode| found.iter().map(move |&own| (mode, own)))
            .map(|(mode, own)| shared[mode][own])
            .sum();
        let share = all / eigenvalues as f64;
        // Spectral projectors grow where eigenvalues meet.
        let likeness = if share > 1.0 { share.recip() } else { share.max(0.0) };
        matches.push(Match { likeness, known: known.to_vec(), found: found.to_vec() });
    };
    for mode in of_kind(ModeKind::Vibration) {
        pairs.iter().for_each(|&pair| add(&[mode], &[pair], 2));
        two(&real).iter().for_each(|both| add(&[mode], both, 2));
    }
    let lags: Vec<usize> = of_kind(ModeKind::Lag).collect();
    for &mode in &lags {
        real.iter().for_each(|&own| add(&[mode], &[own], 1));
    }
    for both in two(&lags) {
        pairs.iter().for_each(|&pair| add(&both, &[pair], 2));
    }
    matches
}

/// The largest real part of the nonzero roots; zero where all are zero.
pub fn growth(found: &[Eigenvalue]) -> f64 {
    let moving = found.iter().filter(|own| own.value != Complex::new(0.0, 0.0)).map(|own| own.value.re);
    moving.reduce(f64::max).unwrap_or(0.0)
}
