//! Where forces are in equilibrium: Φ_qᵀ λ = Q(q, v = 0, λ) and Φ(q) = 0.
//!
//! Newton's method on the motions that the constraints allow: with Φ̂_q = L B and N orthogonal to B, the correction of
//! the coordinates is the shortest one that closes the constraints, and N p with Nᵀ K N p = −Nᵀ(M w + Φ_qᵀ λ − Q). Near
//! a solution that is all: it is the nearest equilibrium, stable or not. Further away each eigenvalue of Nᵀ K N is
//! taken positive, and the step is shortened: that leads downhill, to a stable one. States of controllers rest there,
//! too: their rates are zero. Their drives have no hill; Newton's steps are shortened then, and stability is not
//! examined, for it depends on how the states move.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::configuration::{Linearised, StaticConfiguration, reduced, times};
use super::scaled::Scaled;
use super::stability::Stability;
use super::tuning::TUNING;
use crate::assemble::{ConstraintId, CoordinateId, System};
use crate::compile::{EquationsProgram, Layout, compile_equations};
use crate::numerics::{RowSpace, combined, dot};
use crate::simulate::start::tuning::TUNING as START;
use crate::simulate::tuning::TUNING as SIMULATE;

/// Finds equilibria of a mechanism.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    pub(super) program: EquationsProgram,
    pub(super) scale: Vec<f64>,
    pub(super) redundant: Vec<ConstraintId>,
    pub(super) states: Vec<RestState>,
}

/// A state, whose coordinate's position it is here.
#[derive(Clone, Copy, Debug)]
pub(super) struct RestState {
    /// Index of the coordinate in q.
    index: usize,
    /// Registers of the coordinate, and of the state elsewhere.
    position: usize,
    value: usize,
}

/// The reason why there is no equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct NoEquilibrium {
    /// The coordinate that is pushed most.
    pub coordinate: CoordinateId,
    /// The force on it, N or N m.
    pub force: f64,
    /// Whether nothing holds it, wherever it is.
    pub is_free: bool,
}

impl Equilibrium {
    /// For a mechanism with these redundant constraints.
    pub fn new(system: &System, redundant: &[ConstraintId]) -> Self {
        let scale = system.coordinates.iter().map(|coordinate| coordinate.scale).collect();
        let program = compile_equations(&system.at_rest());
        let Layout { q, v, .. } = &program.layout;
        let indices = (0..q.len()).filter(|&index| system.coordinates[index].is_state);
        let states =
            indices.map(|index| RestState { index, position: q.start + index, value: v.start + index }).collect();
        Self { program, scale, redundant: redundant.to_vec(), states }
    }

    /// The equations at rest.
    pub fn program(&self) -> &EquationsProgram {
        &self.program
    }

    /// Registers of the position of each state's coordinate, and of the state elsewhere.
    pub fn states(&self) -> impl Iterator<Item = (usize, usize)> {
        self.states.iter().map(|state| (state.position, state.value))
    }

    /// The equations at rest with these parameters.
    pub fn configuration(&self, parameters: &[f64]) -> StaticConfiguration<'_> {
        StaticConfiguration::new(&self.program, &self.scale, &self.redundant, parameters)
    }

    /// The equilibrium with `parameters` near that of `nominal` parameters at `state`: its state (the layout's
    /// registers), at rest.
    ///
    /// # Errors
    /// Where none is found.
    pub fn near(&self, state: &[f64], nominal: &[f64], parameters: &[f64]) -> Result<Vec<f64>, NoEquilibrium> {
        let at_once = self.find(state, parameters);
        let is_far = |found: &Vec<f64>| {
            let change = |(register, scale): (usize, &f64)| ((found[register] - state[register]) / scale).abs();
            !self.program.layout.q.clone().zip(&self.scale).map(change).all(|change| change <= START.far_sample)
        };
        if at_once.as_ref().is_ok_and(|found| !is_far(found)) {
            return at_once;
        }
        let mut followed = state.to_vec();
        for step in 1..=SIMULATE.continuation_steps {
            let share = step as f64 / SIMULATE.continuation_steps as f64;
            let between: Vec<f64> =
                nominal.iter().zip(parameters).map(|(nominal, value)| nominal + share * (value - nominal)).collect();
            let last = if step == SIMULATE.continuation_steps { parameters } else { &between };
            match self.find(&followed, last) {
                Ok(found) => followed = found,
                Err(_) => return at_once,
            }
        }
        Ok(followed)
    }

    /// The equilibrium near a state.
    ///
    /// # Errors
    /// Where none is found.
    pub fn find(&self, state: &[f64], parameters: &[f64]) -> Result<Vec<f64>, NoEquilibrium> {
        let layout = &self.program.layout;
        let mut at = self.configuration(parameters);
        self.set_positions(&mut at, state);
        let mut last = f64::INFINITY;
        let mut balance = self.balanced(&mut at);
        for _ in 0..TUNING.max_corrections {
            let before = at.get(layout.q.clone());
            let Some(step) = balance.step(&self.states) else { break };
            let size = self.size(&step, &before);
            let settles = size <= START.settled || size <= TUNING.stalled && size >= 0.5 * last;
            last = if step.is_newton { size } else { f64::INFINITY };
            let mut share = 1.0;
            for _ in 0..TUNING.most_halvings {
                let places = before.iter().zip(&step.all).zip(&self.scale);
                let moved: Vec<f64> = places.map(|((q, change), scale)| q + share * change * scale).collect();
                at.set(layout.q.clone(), &moved);
                balance = self.balanced(&mut at);
                let work = -dot(&balance.linear.motion, &step.allowed);
                if step.is_newton || !step.is_downhill || work > -0.5 * step.work {
                    break;
                }
                share *= 0.5;
            }
            if settles && step.is_newton {
                let mut found = state.to_vec();
                found[layout.q.clone()].copy_from_slice(&at.get(layout.q.clone()));
                found[layout.v.start..layout.w.end].fill(0.0);
                self.states.iter().for_each(|state| found[state.value] = found[state.position]);
                found[layout.lambda.clone()].copy_from_slice(&at.get(layout.lambda.clone()));
                return Ok(found);
            }
        }
        Err(balance.why(&self.scale, &self.states))
    }

    /// The largest change of a step from these positions, per scale; of states relative to their values.
    fn size(&self, step: &Step, before: &[f64]) -> f64 {
        let mut sizes: Vec<f64> = step.all.iter().map(|change| change.abs()).collect();
        for &RestState { index, .. } in &self.states {
            sizes[index] /= (before[index] / self.scale[index]).abs().max(1.0);
        }
        sizes.into_iter().fold(0.0, f64::max)
    }

    /// Stability of an equilibrium's state by its stiffness.
    pub fn stability(&self, state: &[f64], parameters: &[f64]) -> Stability {
        Stability::of(&self.at(state, parameters).linearise())
    }

    /// The equations at an equilibrium's state.
    pub fn at(&self, state: &[f64], parameters: &[f64]) -> StaticConfiguration<'_> {
        let layout = &self.program.layout;
        let mut at = self.configuration(parameters);
        self.set_positions(&mut at, state);
        at.set(layout.lambda.clone(), &state[layout.lambda.clone()]);
        at
    }

    /// Sets positions, and those of the states' coordinates to the states.
    fn set_positions(&self, at: &mut StaticConfiguration, state: &[f64]) {
        let registers = self.program.layout.q.clone();
        at.set(registers.clone(), &state[registers]);
        self.states.iter().for_each(|own| at.set(own.position..own.position + 1, &[state[own.value]]));
    }

    /// The equations with the multipliers that leave the smallest forces.
    fn balanced(&self, at: &mut StaticConfiguration) -> Balance {
        let (n, registers) = (self.scale.len(), self.program.layout.lambda.clone());
        let linear = at.linearise();
        let space = RowSpace::of(&linear.jacobian, n);
        let change = space.multipliers(&linear.motion, registers.len());
        let lambda: Vec<f64> = at.get(registers.clone()).iter().zip(&change).map(|(a, b)| a - b).collect();
        at.set(registers, &lambda);
        let linear = at.linearise();
        let held = combined(&linear.jacobian, &lambda, n);
        let applied = linear.motion.iter().zip(&held).map(|(all, held)| (all - held).abs()).fold(0.0, f64::max);
        Balance { linear, space, applied }
    }
}

/// The equations at a configuration, with the multipliers that leave the smallest forces.
struct Balance {
    linear: Linearised,
    space: RowSpace,
    /// The largest of the forces that no constraint exerts.
    applied: f64,
}

/// A correction, per scale of the coordinates.
struct Step {
    all: Vec<f64>,
    /// The part along motions that the constraints allow.
    allowed: Vec<f64>,
    /// Work of the forces along that part.
    work: f64,
    /// Whether it is that of Newton's method.
    is_newton: bool,
    /// Whether the forces along it are to do work.
    is_downhill: bool,
}

impl Balance {
    /// `None` where a number is not finite. Without states a long step leads downhill; with them it is that of Newton's
    /// method, shortened so that no coordinate of the mechanism goes far.
    fn step(&self, states: &[RestState]) -> Option<Step> {
        let Linearised { motion, constraint, stiffness, .. } = &self.linear;
        let (basis, n) = (&self.space.null, motion.len());
        let right: Vec<f64> = constraint.iter().map(|value| -value).collect();
        let closing = self.space.shortest(&right);
        let closing = if closing.is_empty() { vec![0.0; n] } else { closing };
        let along = times(stiffness, &closing);
        let missing: Vec<f64> = motion.iter().zip(&along).map(|(force, along)| force + along).collect();
        let forces: Vec<f64> = basis.iter().map(|vector| -dot(vector, &missing)).collect();
        let small = reduced(stiffness, basis);
        if forces.iter().chain(small.iter()).chain(&closing).any(|value| !value.is_finite()) {
            return None;
        }
        let leads_downhill = states.is_empty();
        let longest = |parts: &[f64]| {
            let mut sizes: Vec<f64> = parts.iter().map(|part| part.abs()).collect();
            states.iter().for_each(|state| sizes[state.index] = 0.0);
            sizes.into_iter().fold(0.0, f64::max)
        };
        let nothing = TUNING.zero_stiffness * self.applied.max(longest_of(stiffness));
        let solve = if leads_downhill { newton } else { shortest };
        let (newton, is_regular) = solve(&small, &forces, nothing);
        let allowed = combined(basis, &newton, n);
        let is_near = longest(&allowed) <= TUNING.near_correction;
        let is_downhill = leads_downhill && !(is_regular && is_near);
        let (allowed, is_newton) = if !is_downhill {
            let share = if is_near { 1.0 } else { (TUNING.longest_correction / longest(&allowed)).min(1.0) };
            (allowed.iter().map(|part| share * part).collect::<Vec<f64>>(), is_near && is_regular)
        } else {
            let downhill = combined(basis, &downhill(&small, &forces), n);
            let share = (TUNING.longest_correction / longest(&downhill)).min(1.0);
            (downhill.iter().map(|part| share * part).collect(), false)
        };
        let shortened = (TUNING.longest_correction / longest(&closing)).min(1.0);
        let all = allowed.iter().zip(&closing).map(|(a, b)| a + shortened * b).collect();
        let work = -dot(motion, &allowed);
        Some(Step { all, allowed, work, is_newton: is_newton && shortened == 1.0, is_downhill })
    }

    fn why(&self, scale: &[f64], states: &[RestState]) -> NoEquilibrium {
        let (basis, n) = (&self.space.null, scale.len());
        let forces: Vec<f64> = basis.iter().map(|vector| -dot(vector, &self.linear.motion)).collect();
        let pushed = combined(basis, &forces, n);
        let nothing = TUNING.zero_stiffness * longest_of(&self.linear.stiffness).max(1e-300);
        let by_push = |a: &usize, b: &usize| pushed[*a].abs().total_cmp(&pushed[*b].abs());
        let is_alone = |index: &usize| self.linear.stiffness.column(*index).iter().all(|entry| entry.abs() <= nothing);
        // A state that nothing depends on cannot be brought to rest; it is reported before others that are not in
        // balance.
        let least = TUNING.zero_stiffness * pushed.iter().fold(0.0_f64, |most, push| most.max(push.abs()));
        let states = states.iter().map(|state| state.index).filter(|&index| pushed[index].abs() > least);
        let open = states.filter(is_alone).max_by(by_push);
        let coordinate = open.or_else(|| (0..n).max_by(by_push)).unwrap_or(0);
        let yields = times(&reduced(&self.linear.stiffness, basis), &forces);
        let is_free = open.is_some() || yields.iter().all(|part| part.abs() <= nothing * dot(&forces, &forces).sqrt());
        NoEquilibrium {
            coordinate: CoordinateId::new(coordinate),
            force: pushed.get(coordinate).map_or(0.0, |force| force / scale[coordinate]),
            is_free,
        }
    }
}

fn longest_of(matrix: &DMatrix<f64>) -> f64 {
    matrix.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()))
}

/// K⁻¹ f, and whether there is one. Forces below `nothing` push nothing where nothing is stiff.
fn newton(small: &DMatrix<f64>, forces: &[f64], nothing: f64) -> (Vec<f64>, bool) {
    // Constraints may allow no motion.
    if forces.is_empty() {
        return (Vec::new(), true);
    }
    let is_symmetric =
        (small - small.transpose()).iter().all(|part| part.abs() <= TUNING.zero_stiffness * longest_of(small));
    if !is_symmetric && let Some(found) = small.clone().full_piv_lu().solve(&DVector::from_column_slice(forces)) {
        return (found.iter().copied().collect(), true);
    }
    let eigen = SymmetricEigen::new((small + small.transpose()) * 0.5);
    let largest = eigen.eigenvalues.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let mut is_regular = true;
    let mut found = vec![0.0; forces.len()];
    for (index, value) in eigen.eigenvalues.iter().enumerate() {
        let vector = eigen.eigenvectors.column(index);
        let force: f64 = vector.iter().zip(forces).map(|(a, b)| a * b).sum();
        if value.abs() > TUNING.zero_stiffness * largest {
            found.iter_mut().zip(vector.iter()).for_each(|(sum, part)| *sum += force / value * part);
        } else {
            is_regular &= force.abs() <= nothing;
        }
    }
    (found, is_regular)
}

/// The shortest x with the least |K x − f|, and whether that is zero. Forces below `nothing` are.
fn shortest(small: &DMatrix<f64>, forces: &[f64], nothing: f64) -> (Vec<f64>, bool) {
    if forces.is_empty() {
        return (Vec::new(), true);
    }
    let Scaled { matrix, rows, columns } = Scaled::of(small);
    let right = DVector::from_iterator(forces.len(), forces.iter().zip(&rows).map(|(force, factor)| force * factor));
    let factors = matrix.svd(true, true);
    let Ok(found) = factors.solve(&right, TUNING.zero_stiffness * factors.singular_values.max()) else {
        return (vec![0.0; forces.len()], false);
    };
    let found: Vec<f64> = found.iter().zip(&columns).map(|(part, factor)| part * factor).collect();
    let is_met = |((image, force), row): ((f64, &f64), &f64)| {
        (image - force).abs() <= nothing.max(TUNING.zero_stiffness * (force.abs() + row.recip()))
    };
    let is_met = times(small, &found).into_iter().zip(forces).zip(&rows).all(is_met);
    (found, is_met)
}

/// K⁻¹ f with every eigenvalue positive.
fn downhill(small: &DMatrix<f64>, forces: &[f64]) -> Vec<f64> {
    if forces.is_empty() {
        return Vec::new();
    }
    let eigen = SymmetricEigen::new((small + small.transpose()) * 0.5);
    let largest = eigen.eigenvalues.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let size = forces.iter().fold(0.0_f64, |size, force| size.max(force.abs()));
    // No direction counts as softer than this: the force moves it by a scale at most.
    let least = (TUNING.zero_stiffness * largest).max(size);
    let mut found = vec![0.0; forces.len()];
    for (index, value) in eigen.eigenvalues.iter().enumerate() {
        let vector = eigen.eigenvectors.column(index);
        let force: f64 = vector.iter().zip(forces).map(|(a, b)| a * b).sum();
        found.iter_mut().zip(vector.iter()).for_each(|(sum, part)| *sum += force / value.abs().max(least) * part);
    }
    found
}
