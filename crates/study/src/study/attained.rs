//! Attained ends: samples at which outputs are least and largest, found along gradients, and bounds of them.
//!
//! In some rows each end is climbed to from three points: from the middle of the box, where the signs of the gradient
//! name a corner; from where a polynomial through values and gradients is largest; and from the best sample so far.
//! From there on quasi-Newton steps within the box go on (`climb`). Each sample serves all rows; an end that another
//! one's sample improves is climbed to once more from there, and the rows between begin at the best of all samples.
//!
//! An end is attained. Its error is the increase that its gradient still promises, and the distance by which the second
//! best of its climbs stayed behind: if they agree, there is one end; if they do not, there may be a better one as far
//! beyond.

mod climb;
mod ends;
mod kept;
mod model;
mod slopes;
mod surface;
pub(crate) mod tuning;

use super::bounding::{Attained, Outcome, bound, simulation_error, timed};
use super::ensemble::Progress;
use super::internal::InternalError;
use super::problem::Study;
use crate::methods::{
    BoundsRequest, Budget, Chebyshev, Degree, Ensemble, FollowedEnds, Method, MethodResult, Observed, Sampling,
    Simulated, Until, Validation,
};
use crate::numerics::clock::Instant;
use crate::numerics::{Derivatives, Ledger, Range, SAFETY_OF_SURROGATE, Sample, spread};
use crate::simulate::{Schedule, SimulationError, Steps, Wanted};
use climb::{Climb, End, Known};
use slopes::OfRows;
pub(super) use slopes::{Slope, Slopes};
use surface::{Surface, Surfaces};
use tuning::TUNING;

/// Result of the search: its cost, the samples, and bounds.
type AttainedEnds = (Outcome, Attained, FollowedEnds);

/// Results of the methods, and the ends that were searched for before.
type BoundsAlong = (Vec<(Method, Outcome)>, Option<(Outcome, Attained)>);

/// Bounds by every method that is wanted, which know the ends that were searched for before, if any.
///
/// # Errors
/// If a sample cannot be simulated.
pub(super) fn bound_along(
    study: &Study,
    steps: Steps<'_>,
    progress: &Progress<'_>,
    seen: Option<&Ledger>,
    validation: &Validation,
    internal: &mut Vec<InternalError>,
    wanted: impl Fn(Method) -> bool,
) -> Result<BoundsAlong, SimulationError> {
    let motions = study.motions(steps, progress).noting(seen);
    let slopes = OfRows { study, schedule: steps.schedule };
    let found = attained(study, &motions, &slopes, steps.schedule, validation)?;
    let motions = motions.following(found.as_ref().map(|(_, _, followed)| followed));
    let methods = bound(study, &motions, steps.schedule, validation, internal, wanted)?;
    Ok((methods, found.map(|(outcome, attained, _)| (outcome, attained))))
}

/// Searches the ends of all outputs of an ensemble; `None` if surrogates need no help, or motions have no gradients.
/// The simulations are noted by the ensemble.
///
/// # Errors
/// If a sample cannot be simulated.
pub(super) fn attained(
    study: &Study,
    motions: &dyn Ensemble,
    slopes: &dyn Slopes,
    schedule: &Schedule,
    validation: &Validation,
) -> Result<Option<AttainedEnds>, SimulationError> {
    let is_adaptive = matches!(&study.request.chebyshev, Some(Chebyshev { degree: Degree::Adaptive, .. }));
    let has_motion = !study.simulator.system.analysis.visits();
    // A smaller budget is left to the surrogate.
    let is_afforded = study.request.budget.simulations >= Budget::default().simulations;
    let is_wanted = is_adaptive && is_afforded && study.domain.dimension() >= TUNING.fewest_parameters;
    let has_jumps = || (0..motions.outputs()).any(|output| motions.jumps(output));
    if !is_wanted || !has_motion || study.interruption.is_asked() || has_jumps() {
        return Ok(None);
    }
    (study.stage)("attained ends");
    let found = timed(schedule, "attained", || {
        let mut search = AttainedSearch::new(study, motions, slopes, validation);
        let ends = search.run()?;
        let result = MethodResult { simulations: search.work, ..MethodResult::default() };
        Ok((MethodResult { simulated: search.simulated, ..result }, (search.attained, ends)))
    });
    match found {
        // Shards, or nobody, simulate the rest.
        Err(SimulationError::Deferred | SimulationError::Interrupted) => Ok(None),
        found => found.map(|(outcome, (attained, ends))| Some((outcome, attained, ends?))),
    }
}

/// An output in a row whose ends are climbed to from several points.
struct FollowedRow {
    row: usize,
    output: usize,
    surface: Option<Surface>,
}

/// Polynomials, if there are points enough for any, and the rows that are followed.
type Followable = (Option<Surfaces>, Vec<FollowedRow>);

/// The search.
struct AttainedSearch<'s, 'm> {
    study: &'s Study<'m>,
    motions: &'s dyn Ensemble,
    slopes: &'s dyn Slopes,
    attained: Attained,
    /// Error allowed of each output.
    allowed: Vec<f64>,
    /// Number of simulations, with gradients counted by their cost.
    work: usize,
    /// The part of `work` for a surrogate that is stored, which does not count against the budget of the ends.
    work_of_kept: usize,
    begun: Instant,
    simulated: Simulated,
}

impl<'s, 'm> AttainedSearch<'s, 'm> {
    fn new(
        study: &'s Study<'m>,
        motions: &'s dyn Ensemble,
        slopes: &'s dyn Slopes,
        validation: &'s Validation,
    ) -> Self {
        let mut attained = Attained::new(motions.rows(), motions.outputs());
        let samples = study.domain.samples(&validation.points);
        let of_samples = validation.direct.of_outputs().enumerate();
        of_samples.for_each(|(row, values)| attained.note(row, &samples, values));
        let tolerance = study.request.tolerance.unwrap_or(BoundsRequest::TOLERANCE);
        let allowed = validation.spans.iter().map(|span| tolerance * span).collect();
        let (begun, simulated) = (Instant::now(), Simulated::default());
        Self { study, motions, slopes, attained, allowed, work: 0, work_of_kept: 0, begun, simulated }
    }

    /// Ends of all rows and outputs; `None` if gradients do not reach them.
    fn run(&mut self) -> Result<Option<FollowedEnds>, SimulationError> {
        let (rows, outputs) = (self.motions.rows(), self.motions.outputs());
        let every = (2 * rows * outputs).div_ceil(TUNING.followed_ends).max(1);
        let chosen: Vec<usize> = (0..rows).rev().step_by(every).collect();
        let Some((surfaces, followed)) = self.surfaces(&chosen)? else { return Ok(None) };
        if self.study.request.keep.is_any() {
            self.work_of_kept = self.work;
        }
        let middle = vec![0.0; self.study.domain.dimension()];
        let mut climbs = Vec::new();
        for FollowedRow { row, output, surface } in &followed {
            for sign in [-1.0, 1.0] {
                let end = End { row: *row, output: *output, sign };
                climbs.push(self.climb(end, middle.clone()));
                climbs.extend(self.best_sample(end).map(|(_, point)| self.climb(end, point)));
                if let (Some(surfaces), Some(surface)) = (&surfaces, surface) {
                    climbs.push(self.climb(end, surfaces.end(surface, sign, &middle)));
                }
            }
        }
        self.follow(&mut climbs)?;
        self.share(&mut climbs)?;
        let mut doubted = self.doubted(&mut climbs);
        self.follow(&mut doubted)?;
        climbs.append(&mut doubted);
        self.share(&mut climbs)?;
        // Rows between them begin where the others ended.
        let between: Vec<End> = (0..rows)
            .filter(|row| !chosen.contains(row))
            .flat_map(|row| (0..outputs).flat_map(move |output| [-1.0, 1.0].map(|sign| End { row, output, sign })))
            .collect();
        let mut others: Vec<Climb> = between
            .into_iter()
            .filter_map(|end| self.best_sample(end).map(|(_, point)| self.climb(end, point)))
            .collect();
        self.follow(&mut others)?;
        climbs.append(&mut others);
        self.share(&mut climbs)?;
        // Nothing is known of a sample after it stops.
        if self.simulated.stop.is_some() {
            return Ok(None);
        }
        let kept = surfaces.as_ref().filter(|_| self.study.request.keep.is_any());
        let kept = kept.and_then(|surfaces| kept::surrogate(self, surfaces, &followed));
        let ends = ends::ends(self, &mut climbs, surfaces.as_ref(), &followed);
        Ok(Some(FollowedEnds::new(ends, kept)))
    }

    /// A climb to an end from a point.
    fn climb(&self, end: End, start: Vec<f64>) -> Climb {
        let width = self.attained.range(end.row, end.output).map_or(0.0, Range::width);
        Climb::new(end, start, width, self.allowed[end.output])
    }

    /// The best sample so far of an end: its value, upwards, and ξ.
    fn best_sample(&self, end: End) -> Option<(f64, Vec<f64>)> {
        let (value, sample) = self.attained.ends(end.row, end.output)[end.side()]?;
        Some((end.sign * value, self.study.domain.xi(sample)))
    }

    /// Whether time or simulations are used up.
    fn is_spent(&self) -> bool {
        let Budget { simulations, seconds } = self.study.request.budget;
        self.study.interruption.is_asked()
            || self.work >= TUNING.work_of_budget * simulations + self.work_of_kept
            || seconds.is_some_and(|seconds| self.begun.elapsed().as_secs_f64() >= seconds)
    }

    /// Goes on with climbs until all are done.
    fn follow(&mut self, climbs: &mut [Climb]) -> Result<(), SimulationError> {
        for _ in 0..TUNING.steps_of_climb {
            let mut points: Vec<Vec<f64>> = Vec::new();
            let mut going: Vec<(&mut Climb, usize)> = Vec::new();
            for climb in climbs.iter_mut().filter(|climb| !climb.is_done) {
                let Some(step) = climb.step() else {
                    climb.is_done = true;
                    continue;
                };
                let number = points.iter().position(|known| *known == step).unwrap_or_else(|| {
                    points.push(step);
                    points.len() - 1
                });
                going.push((climb, number));
            }
            if points.is_empty() || self.is_spent() {
                break;
            }
            self.simulate(&points)?;
            let wanted: Vec<Wanted> = going
                .iter()
                .map(|(climb, number)| Wanted { sample: *number, row: climb.end.row, output: climb.end.output })
                .collect();
            let Some(found) = self.slopes(&points, &wanted)? else { break };
            for ((climb, number), (value, slope)) in going.into_iter().zip(found) {
                let sign = climb.end.sign;
                let slope = slope.into_iter().map(|slope| sign * slope).collect();
                climb.take(Known { point: points[number].clone(), value: sign * value, slope });
            }
        }
        Ok(())
    }

    /// Climbs on from samples that are better than all climbs to an end.
    fn share(&mut self, climbs: &mut Vec<Climb>) -> Result<(), SimulationError> {
        for _ in 0..TUNING.shared_rounds {
            let mut better: Vec<Climb> = Vec::new();
            for of_end in by_end(climbs) {
                let Some(best) = best(of_end) else { continue };
                let reached = best.best.as_ref().map_or(f64::NEG_INFINITY, |known| known.value);
                let sample = self.best_sample(best.end).filter(|(value, _)| *value > reached + best.worth());
                better.extend(sample.map(|(_, point)| self.climb(best.end, point)));
            }
            if better.is_empty() || self.is_spent() {
                break;
            }
            self.follow(&mut better)?;
            climbs.append(&mut better);
        }
        Ok(())
    }

    /// Climbs from other corners to ends at which those so far do not agree, or that they did not reach.
    fn doubted(&self, climbs: &mut [Climb]) -> Vec<Climb> {
        let corner = |point: Vec<f64>| -> Vec<f64> { point.into_iter().map(f64::signum).collect() };
        let corners: Vec<Vec<f64>> =
            spread(self.study.domain.dimension(), TUNING.corners_of_doubt).into_iter().map(corner).collect();
        let is_doubted = |of_end: &&[Climb]| {
            let open = ends::open_of(self, of_end);
            SAFETY_OF_SURROGATE * (open.promise + open.gap) > self.allowed[of_end[0].end.output]
        };
        let doubted: Vec<End> = by_end(climbs).filter(is_doubted).map(|of_end| of_end[0].end).collect();
        doubted.iter().flat_map(|&end| corners.iter().map(move |corner| self.climb(end, corner.clone()))).collect()
    }

    /// Polynomials of outputs in some rows, as far as points are enough for any; `None` if gradients are not known.
    fn surfaces(&mut self, rows: &[usize]) -> Result<Option<Followable>, SimulationError> {
        let k = self.study.domain.dimension();
        let mut points = vec![vec![0.0; k]];
        let count = if self.study.request.keep.is_any() {
            TUNING.kept_points
        } else {
            (k + 2).clamp(TUNING.least_points, TUNING.most_points)
        };
        points.extend(spread(k, count));
        self.simulate(&points)?;
        let outputs = self.motions.outputs();
        let of_row = |row: usize| (0..outputs).map(move |output| (row, output));
        let all: Vec<(usize, usize)> = rows.iter().flat_map(|&row| of_row(row)).collect();
        let of_point = |sample: usize| all.iter().map(move |&(row, output)| Wanted { sample, row, output });
        let wanted: Vec<Wanted> = (0..points.len()).flat_map(of_point).collect();
        let Some(found) = self.slopes(&points, &wanted)? else { return Ok(None) };
        let is_known = |(value, slopes): &Slope| value.is_finite() && slopes.iter().all(|slope| slope.is_finite());
        if !found.iter().all(is_known) {
            return Ok(None);
        }
        let derivatives = |(line, (_, output)): (usize, &(usize, usize))| Derivatives {
            slopes: found.iter().skip(line).step_by(all.len()).map(|(_, slopes)| slopes.as_slice()).collect(),
            scale: self.allowed[*output],
        };
        let functions: Vec<Derivatives> = all.iter().enumerate().map(derivatives).collect();
        let surfaces = Surfaces::new(&self.study.domain, points, &functions);
        let followed = all.iter().enumerate().map(|(index, &(row, output))| {
            let samples: Vec<&Slope> = found.iter().skip(index).step_by(all.len()).collect();
            FollowedRow { row, output, surface: surfaces.as_ref().map(|surfaces| surfaces.of(&samples)) }
        });
        let followed = followed.collect();
        Ok(Some((surfaces, followed)))
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
        self.simulated.add(self.work, simulated.map_err(simulation_error)?);
        self.work += samples.len();
        Ok(())
    }

    /// Values and gradients (in ξ) of outputs, one for each that is wanted of the points. `None` if there are no
    /// gradients.
    fn slopes(&mut self, points: &[Vec<f64>], wanted: &[Wanted]) -> Result<Option<Vec<Slope>>, SimulationError> {
        let study = self.study;
        let samples = study.domain.samples(points);
        let rows: usize = wanted.iter().map(|wanted| wanted.row + 1).sum();
        self.work += (TUNING.cost_of_gradient * rows).div_ceil(self.motions.rows().max(1));
        let Some(found) = self.slopes.slopes(&samples, wanted)? else { return Ok(None) };
        let scaled = |by_parameters: Vec<f64>| {
            by_parameters.into_iter().enumerate().map(|(axis, by)| by * study.domain.half_width(axis)).collect()
        };
        Ok(Some(found.into_iter().map(|(value, by_parameters)| (value, scaled(by_parameters))).collect()))
    }
}

/// The climb that reached most.
fn best(climbs: &[Climb]) -> Option<&Climb> {
    let value = |climb: &Climb| climb.best.as_ref().map_or(f64::NEG_INFINITY, |known| known.value);
    climbs.iter().max_by(|a, b| value(a).total_cmp(&value(b)))
}

/// Climbs to the same end, end by end.
fn by_end(climbs: &mut [Climb]) -> impl Iterator<Item = &[Climb]> {
    climbs.sort_by_key(|climb| (climb.end.row, climb.end.output, climb.end.side()));
    climbs.chunk_by(|a, b| a.end == b.end)
}
