//! Attained ends: samples at which outputs are least and largest, found along gradients.
//!
//! In the middle of the box the signs of a gradient name a corner. There the gradient is taken anew, until its signs
//! name the corner itself. A parameter along which the derivative changes its sign from one point to the next has an
//! extreme between them: it goes where the secant of the derivative vanishes, which is a quasi-Newton step with a
//! diagonal matrix, within the box. A step that does not improve the end is shortened.
//!
//! All of it is simulated, so that bands are widened to it, and rows are distrusted in which it lies beyond a band's
//! error. Each sample serves all rows, whichever it was found for.

use super::bounding::{Attained, Outcome, simulation_error, timed};
use super::ensemble::Motions;
use super::problem::Study;
use crate::methods::{Budget, Chebyshev, Degree, Ensemble, MethodResult, Observed, Sampling, Simulated, Until};
use crate::numerics::Sample;
use crate::simulate::{NoGradient, Schedule, SimulationError, Wanted, gradients};

/// Fewer parameters are searched by the surrogate alone, whose samples are dense enough.
const MANY: usize = 6;

/// Most rows, outputs and ends whose gradients are followed; the samples serve the others.
const FOLLOWED: usize = 128;

/// Rounds of gradients and steps.
const ROUNDS: usize = 8;

/// A step that promises less than this share of all parameters' influence is left out.
const WORTH: f64 = 1e-3;

/// Simulations that a gradient costs, for the count.
const COST: usize = 4;

/// Values of outputs, each with its gradient (in ξ).
type Slopes = Vec<(f64, Vec<f64>)>;

/// A point with a gradient (both in ξ).
#[derive(Clone, Debug)]
struct Known {
    point: Vec<f64>,
    /// Of the output, upwards for the upper end, downwards for the lower.
    slope: Vec<f64>,
}

/// An end that is followed.
struct End {
    row: usize,
    output: usize,
    /// 1 of the upper end, −1 of the lower.
    sign: f64,
    /// The best point so far, and its value times the sign.
    best: Known,
    value: f64,
    /// The point before it, or the last that was not better.
    other: Option<Known>,
    /// Of the whole step.
    share: f64,
    /// Influence of all parameters on the output in the middle, by its gradient.
    reach: f64,
    is_done: bool,
}

impl End {
    /// The next point; `None` where nothing is to be gained.
    fn step(&self) -> Option<Vec<f64>> {
        let Known { point, slope } = &self.best;
        let target = (0..point.len()).map(|axis| {
            let (x, own) = (point[axis], slope[axis]);
            if let Some(other) = &self.other {
                let (from, before) = (other.point[axis], other.slope[axis]);
                // An extreme between the two.
                if before * own < 0.0 && from != x {
                    return (x - own * (x - from) / (own - before)).clamp(-1.0, 1.0);
                }
            }
            if own == 0.0 || !own.is_finite() { x } else { own.signum() }
        });
        let target: Vec<f64> = target.collect();
        let gain: f64 = target.iter().zip(point).zip(slope).map(|((to, x), slope)| slope * (to - x)).sum();
        let is_worth = gain.is_finite() && gain > WORTH * self.reach;
        is_worth.then(|| target.iter().zip(point).map(|(to, x)| x + self.share * (to - x)).collect())
    }
}

/// Searches the ends of all outputs over time; `None` where surrogates need no help, or motions have no gradients.
/// The simulations are noted by `motions`.
///
/// # Errors
/// Where a sample cannot be simulated.
pub(super) fn attained(
    study: &Study,
    motions: &Motions,
    schedule: &Schedule,
) -> Result<Option<(Outcome, Attained)>, SimulationError> {
    let is_adaptive = matches!(&study.request.chebyshev, Some(Chebyshev { degree: Degree::Adaptive, .. }));
    let has_motion = !study.simulator.system.analysis.visits() && schedule.segments().is_none();
    // A smaller budget is left to the surrogate.
    let is_afforded = study.request.budget.simulations >= Budget::default().simulations;
    let is_wanted = is_adaptive && is_afforded && study.domain.dimension() >= MANY;
    if !is_wanted || !has_motion || study.interruption.is_asked() {
        return Ok(None);
    }
    (study.stage)("attained ends");
    let found = timed(schedule, "attained", || {
        let mut search = AttainedSearch::new(study, motions, schedule);
        search.run()?;
        let result = MethodResult { simulations: search.simulations, ..MethodResult::default() };
        Ok((MethodResult { simulated: search.simulated, ..result }, search.attained))
    });
    match found {
        // Shards, or nobody, simulate the rest.
        Err(SimulationError::Deferred | SimulationError::Interrupted) => Ok(None),
        found => found.map(Some),
    }
}

/// The search.
struct AttainedSearch<'s, 'm> {
    study: &'s Study<'m>,
    motions: &'s dyn Ensemble,
    schedule: &'s Schedule,
    attained: Attained,
    simulations: usize,
    simulated: Simulated,
}

impl<'s, 'm> AttainedSearch<'s, 'm> {
    fn new(study: &'s Study<'m>, motions: &'s dyn Ensemble, schedule: &'s Schedule) -> Self {
        let attained = Attained::new(motions.rows(), motions.outputs());
        Self { study, motions, schedule, attained, simulations: 0, simulated: Simulated::default() }
    }

    fn run(&mut self) -> Result<(), SimulationError> {
        let mut ends = self.begin()?;
        for _ in 0..ROUNDS {
            let steps: Vec<Option<Vec<f64>>> =
                ends.iter().map(|end| if end.is_done { None } else { end.step() }).collect();
            ends.iter_mut().zip(&steps).for_each(|(end, step)| end.is_done = step.is_none());
            let mut points: Vec<Vec<f64>> = Vec::new();
            let numbers: Vec<Option<usize>> = steps
                .into_iter()
                .map(|step| {
                    let step = step?;
                    Some(points.iter().position(|known| *known == step).unwrap_or_else(|| {
                        points.push(step);
                        points.len() - 1
                    }))
                })
                .collect();
            if points.is_empty() || self.study.interruption.is_asked() {
                break;
            }
            self.simulate(&points)?;
            let going: Vec<(&mut End, usize)> =
                ends.iter_mut().zip(numbers).filter_map(|(end, number)| Some((end, number?))).collect();
            let wanted = going.iter().map(|(end, number)| (*number, end.row, end.output)).collect::<Vec<_>>();
            let Some(found) = self.slopes(&points, &wanted)? else { break };
            for ((end, number), (value, mut slope)) in going.into_iter().zip(found) {
                slope.iter_mut().for_each(|slope| *slope *= end.sign);
                end.take(Known { point: points[number].clone(), slope }, end.sign * value);
            }
        }
        Ok(())
    }

    /// The ends that are followed, from the middle of the box.
    fn begin(&mut self) -> Result<Vec<End>, SimulationError> {
        let middle = vec![0.0; self.study.domain.dimension()];
        self.simulate(std::slice::from_ref(&middle))?;
        let (rows, outputs) = (self.motions.rows(), self.motions.outputs());
        let every = (2 * rows * outputs).div_ceil(FOLLOWED).max(1);
        let wanted: Vec<(usize, usize, usize)> =
            (0..rows).rev().step_by(every).flat_map(|row| (0..outputs).map(move |output| (0, row, output))).collect();
        let Some(found) = self.slopes(std::slice::from_ref(&middle), &wanted)? else { return Ok(Vec::new()) };
        let ends = wanted.into_iter().zip(found).flat_map(|((_, row, output), (value, slope))| {
            let reach: f64 = slope.iter().map(|slope| slope.abs()).sum();
            let middle = middle.clone();
            [1.0, -1.0].map(move |sign| End {
                row,
                output,
                sign,
                best: Known { point: middle.clone(), slope: slope.iter().map(|slope| sign * slope).collect() },
                value: sign * value,
                other: None,
                share: 1.0,
                reach,
                is_done: reach == 0.0,
            })
        });
        Ok(ends.collect())
    }

    /// Simulates points, and keeps those at which an output is least or largest.
    fn simulate(&mut self, points: &[Vec<f64>]) -> Result<(), SimulationError> {
        let samples = self.study.domain.samples(points);
        let can = self.study.simulator.can_assemble(&samples);
        let samples: Vec<Sample> =
            samples.into_iter().zip(can).filter_map(|(sample, can)| can.then_some(sample)).collect();
        if samples.is_empty() {
            return Ok(());
        }
        let sampling = Sampling { observed: Observed::Outputs, until: Until::End, whole: false };
        let attained = &mut self.attained;
        let simulated = self.motions.simulate(&samples, sampling, &mut |rows, values| {
            attained.note(rows.start, &samples, values);
        });
        self.simulated.add(self.simulations, simulated.map_err(simulation_error)?);
        self.simulations += samples.len();
        Ok(())
    }

    /// Values and gradients (in ξ) of outputs: by point, row and output. `None` where there are no gradients.
    fn slopes(
        &mut self,
        points: &[Vec<f64>],
        wanted: &[(usize, usize, usize)],
    ) -> Result<Option<Slopes>, SimulationError> {
        let study = self.study;
        let samples = study.domain.samples(points);
        let wanted: Vec<Wanted> = wanted.iter().map(|&(sample, row, output)| Wanted { sample, row, output }).collect();
        self.simulations += COST * wanted.len();
        let found = match gradients(&study.simulator, self.schedule, &samples, &wanted, study.interruption) {
            Err(NoGradient::Simulation(SimulationError::Interrupted)) => return Err(SimulationError::Interrupted),
            // Some corner cannot be assembled: the ends so far are kept.
            Err(_) => return Ok(None),
            Ok(found) => found,
        };
        let scaled = |by_parameters: Vec<f64>| {
            by_parameters.into_iter().enumerate().map(|(axis, by)| by * study.domain.half_width(axis)).collect()
        };
        Ok(Some(found.into_iter().map(|found| (found.value, scaled(found.by_parameters))).collect()))
    }
}

impl End {
    /// Takes in a point.
    fn take(&mut self, found: Known, value: f64) {
        let is_known = value.is_finite() && found.slope.iter().all(|slope| slope.is_finite());
        if is_known && value > self.value {
            self.other = Some(std::mem::replace(&mut self.best, found));
            self.value = value;
            self.share = 1.0;
        } else {
            self.share *= 0.5;
            if is_known {
                self.other = Some(found);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// −(x − a)² − … + b y: an extreme within, and one at the end.
    #[test]
    fn a_step_finds_what_lies_within_and_what_lies_at_an_end() {
        let value = |point: &[f64]| -(point[0] - 0.3).powi(2) + 2.0 * point[1];
        let slope = |point: &[f64]| vec![-2.0 * (point[0] - 0.3), 2.0];
        let known = |point: Vec<f64>| Known { slope: slope(&point), point };
        let middle = vec![0.0, 0.0];
        let mut end = End {
            row: 0,
            output: 0,
            sign: 1.0,
            value: value(&middle),
            best: known(middle),
            other: None,
            share: 1.0,
            reach: 2.6,
            is_done: false,
        };
        for _ in 0..4 {
            let Some(step) = end.step() else { break };
            let found = value(&step);
            end.take(known(step), found);
        }
        assert!(end.step().is_none(), "{:?}", end.best);
        assert!((end.best.point[0] - 0.3).abs() < 1e-12 && end.best.point[1] == 1.0, "{:?}", end.best);
    }
}
