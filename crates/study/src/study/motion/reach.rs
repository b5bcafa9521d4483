//! The configuration that is nearest to a wanted one: least squares over the independent coordinates, by the method of
//! Levenberg and Marquardt (Marquardt, J. SIAM 11 (1963) 431), each of whose points is closed.
//!
//! Independent coordinates are chosen anew where the mechanism is, so that no dead centre ends the way. The others are
//! predicted to first order from those, and a closure that is far from the prediction is on another branch: it is no
//! way to go.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};

use super::tuning::TUNING;
use crate::numerics::Sample;
use crate::simulate::{Closure, Configuration, Points, Simulator, choose_independent};

/// A configuration, closed.
#[derive(Clone, Debug)]
pub(super) struct Reached {
    /// n values of the coordinates.
    positions: Vec<f64>,
    /// Values of the outputs; none at the start.
    pub outputs: Vec<f64>,
    /// The largest residual of the constraints, SI.
    pub residual: f64,
    /// Independent coordinates that move a body.
    pub freedom: usize,
}

impl Reached {
    /// The nominal start.
    pub fn start(simulator: &Simulator) -> Self {
        let positions = simulator.nominal[simulator.start.layout.q.clone()].to_vec();
        Self { positions, outputs: Vec::new(), residual: 0.0, freedom: 0 }
    }
}

/// Searches of a mechanism, with the closures that they needed.
pub(super) struct Reach<'s> {
    simulator: &'s Simulator,
    /// By independent coordinates; `None` if there is no such closure.
    closures: HashMap<Vec<usize>, Option<Closure<'s>>>,
}

/// A point of the search, and its sum of squares.
struct Candidate {
    found: Configuration,
    cost: f64,
}

impl<'s> Reach<'s> {
    /// The reach of a mechanism at the start of its time.
    pub fn new(simulator: &'s Simulator) -> Self {
        Self { simulator, closures: HashMap::new() }
    }

    /// Moves from a configuration towards one where all `wanted` of the outputs, m, vanish; ends if no step comes
    /// nearer.
    pub fn towards(&mut self, from: &Reached, sample: &Sample, wanted: &dyn Fn(&[f64]) -> Vec<f64>) -> Reached {
        let scale: Vec<f64> = self.simulator.system.coordinates.iter().map(|own| own.scale).collect();
        let mut now = from.clone();
        for _ in 0..TUNING.steps_of_search {
            let independent: Vec<usize> = choose_independent(self.simulator, sample, &now.positions, 0.0)
                .into_iter()
                .map(|id| id.number())
                .collect();
            let simulator = self.simulator;
            let closure = self
                .closures
                .entry(independent.clone())
                .or_insert_with(|| Closure::new(simulator, independent.clone()).ok());
            let Some(closure) = closure else { return now };
            let moved: Vec<usize> =
                independent.into_iter().filter(|&own| !simulator.system.coordinates[own].is_state).collect();
            let at = |motions: &[Vec<f64>]| closure.configurations(0.0, &points(sample, motions));
            let changed = |coordinate: usize| {
                let mut motion = now.positions.clone();
                motion[coordinate] += TUNING.step_of_difference * scale[coordinate];
                motion
            };
            let motions: Vec<Vec<f64>> =
                std::iter::once(now.positions.clone()).chain(moved.iter().map(|&own| changed(own))).collect();
            let mut found = at(&motions).into_iter();
            let Some(base) = found.next().filter(|base| base.is_closed) else { return now };
            let nearby: Vec<Configuration> = found.collect();
            let away = wanted(&base.outputs);
            now = Reached {
                positions: base.positions.clone(),
                outputs: base.outputs.clone(),
                residual: base.residual,
                freedom: moved.len(),
            };
            if moved.is_empty() {
                return now;
            }
            // Per step of TUNING.step_of_difference; a coordinate that cannot be changed stays.
            let slope = |own: &Configuration| {
                let of = if own.is_closed { wanted(&own.outputs) } else { away.clone() };
                DVector::from_iterator(
                    away.len(),
                    of.iter().zip(&away).map(|(to, from)| (to - from) / TUNING.step_of_difference),
                )
            };
            let slopes = DMatrix::from_columns(&nearby.iter().map(slope).collect::<Vec<_>>());
            let away = DVector::from_vec(away);
            let predicted = |step: &DVector<f64>| {
                let mut motion = base.positions.clone();
                for (own, share) in nearby.iter().zip(step.iter()).filter(|(own, _)| own.is_closed) {
                    for ((value, to), from) in motion.iter_mut().zip(&own.positions).zip(&base.positions) {
                        *value += share * (to - from) / TUNING.step_of_difference;
                    }
                }
                motion
            };
            let motions: Vec<Vec<f64>> = steps(&slopes, &away).iter().map(predicted).collect();
            let is_near = |(found, motion): &(Configuration, &Vec<f64>)| {
                let mut far = found.positions.iter().zip(*motion).zip(&scale);
                found.is_closed
                    && far.all(|((found, wanted), scale)| (found - wanted).abs() <= TUNING.other_branch * scale)
            };
            let cost = |outputs: &[f64]| wanted(outputs).iter().map(|away| away * away).sum::<f64>();
            let before = away.norm_squared();
            let candidates = at(&motions).into_iter().zip(&motions).filter(is_near);
            let best = candidates
                .map(|(found, _)| Candidate { cost: cost(&found.outputs), found })
                .min_by(|a, b| a.cost.total_cmp(&b.cost));
            let Some(Candidate { found, cost }) = best.filter(|best| best.cost < before) else { return now };
            let Configuration { positions, outputs, residual, .. } = found;
            now = Reached { positions, outputs, residual, freedom: moved.len() };
            if cost >= before * (1.0 - TUNING.settled) {
                break;
            }
        }
        now
    }
}

/// Steps in the scales of the coordinates that may lead nearer.
fn steps(slopes: &DMatrix<f64>, away: &DVector<f64>) -> Vec<DVector<f64>> {
    if slopes.ncols() == 0 {
        return Vec::new();
    }
    let normal = slopes.transpose() * slopes;
    let right = -(slopes.transpose() * away);
    let largest = normal.diagonal().max();
    let damped = |damping: f64| {
        let mut matrix = normal.clone();
        (0..matrix.nrows()).for_each(|own| matrix[(own, own)] += damping * largest.max(f64::MIN_POSITIVE));
        let step = matrix.cholesky()?.solve(&right);
        let furthest = step.amax();
        furthest
            .is_finite()
            .then(|| if furthest > TUNING.furthest { step * (TUNING.furthest / furthest) } else { step })
    };
    let whole = TUNING.dampings.into_iter().filter_map(damped);
    whole.flat_map(|step| TUNING.shares_of_step.map(|share| share * &step)).collect()
}

/// A sample with motions at rest.
fn points(sample: &Sample, motions: &[Vec<f64>]) -> Points {
    let count = motions.len();
    let n = motions.first().map_or(0, Vec::len);
    let parameters = sample.iter().flat_map(|&value| std::iter::repeat_n(value, count)).collect();
    let positions = (0..n).flat_map(|own| motions.iter().map(move |motion| motion[own]));
    let motion = positions.chain(std::iter::repeat_n(0.0, n * count)).collect();
    Points { count, parameters, motion }
}
