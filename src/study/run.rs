//! One model's study: the schedule that all samples share, the methods, and their results put together.

use std::sync::atomic::AtomicUsize;

use super::apportion::Parts;
use super::certify::MOST_PARAMETERS;
use super::compose;
use super::methods::{Outcome, Progress, Run, TAYLOR_WORK};
use super::probe::Probes;
use super::step_search::StepSearch;
use super::{Options, RunError};
use crate::assemble;
use crate::model::{BoundsRequest, ChebyshevRequest, Degree, Description, Expand, MOST_SOLVES, ScanRequest, Stepping};
use crate::numerics::{BandError, ParameterBox, corners, probes, time_error, time_error_certified, validation};
use crate::results::{Band, Bounds, Contribution, Method, OutputBounds};
use crate::results::{ContributionSummary, ErrorSummary, MethodSummary, ParameterSummary, SingularSummary, Summary};
use crate::simulate::{
    Observed, Schedule, SimulationError, Simulator, Stop, ToleranceSchedule, schedule_for_tolerance,
};

/// Corners of the box that join the nominal sample as pilots of step-size control.
const PILOT_CORNERS: usize = 16;

/// How often samples that turn out to need smaller steps may be added to the pilots.
const PILOT_ROUNDS: usize = 8;

/// Said of results that the user did not wait for.
const INTERRUPTED: &str =
    "interrupted: methods that were done are kept, of the one that was not what it had found of every sample";

/// A model compiled, with what is asked of it.
pub(super) struct Study<'a> {
    description: &'a Description,
    pub(super) simulator: Simulator,
    pub(super) domain: ParameterBox,
    pub(super) request: BoundsRequest,
    /// Whether all samples are simulated with halved steps too.
    certify_time: bool,
    pub(super) progress: &'a (dyn Fn(f64) + Sync),
    /// Asked whether what is finished is enough.
    pub(super) interrupted: &'a (dyn Fn() -> bool + Sync),
}

/// What one schedule yields.
pub(super) struct Results {
    pub(super) schedule: Schedule,
    pub(super) nominal: Outcome,
    /// Absent where no method is asked for.
    pub(super) probes: Option<Probes>,
    pub(super) methods: Vec<(Method, Outcome)>,
    /// The same with halved steps, where asked for.
    pub(super) halved: Vec<(Method, Outcome)>,
}

impl Results {
    fn outcomes(&self) -> impl Iterator<Item = &Outcome> {
        std::iter::once(&self.nominal).chain(self.methods.iter().map(|(_, outcome)| outcome))
    }

    /// Samples that stopped.
    fn stops(&self) -> impl Iterator<Item = &(Stop, Vec<f64>)> {
        let probes = self.probes.iter().filter_map(|probes| probes.done.stop.as_ref());
        self.outcomes().filter_map(|outcome| outcome.stop.as_ref()).chain(probes)
    }

    /// Rows that every sample of every method has reached, and every one of the probes.
    fn whole(&self) -> usize {
        let stops = self.stops().filter(|(stop, _)| {
            !stop.singular && self.nominal.stop.as_ref().is_none_or(|(nominal, _)| nominal != stop)
        });
        stops.map(|(stop, _)| stop.row).min().unwrap_or(self.schedule.rows)
    }

    /// The sample whose local errors add up to most, where that is more than the tolerance.
    fn overstrained(&self) -> Option<(Vec<f64>, f64)> {
        let probes = self.probes.iter().filter_map(|probes| probes.done.strained.as_ref());
        let strained = self.outcomes().filter_map(|outcome| outcome.strained.as_ref()).chain(probes);
        strained.filter(|(_, strain)| *strain > 1.0).max_by(|a, b| a.1.total_cmp(&b.1)).cloned()
    }
}

/// What a study found.
pub(super) struct Ran {
    pub bounds: Bounds,
    pub summary: Summary,
    /// Rows that every sample of every method has reached.
    pub whole: usize,
}

/// How far held-out samples of a box came.
pub(super) struct Tried {
    /// Rows that all have reached.
    pub reached: usize,
    /// ξ of those that did not reach the end.
    pub stopped: Vec<Vec<f64>>,
    /// Whether any did.
    pub any: bool,
}

impl<'a> Study<'a> {
    /// Of a model that is compiled already.
    pub(super) fn new(
        description: &'a Description,
        simulator: Simulator,
        options: &Options<'a>,
    ) -> Result<Self, RunError> {
        let system = &simulator.system;
        let collect = |pick: fn(&assemble::UncertainParameter) -> f64| system.parameters.iter().map(pick).collect();
        let domain = ParameterBox {
            nominal: collect(|parameter| parameter.nominal),
            lower: collect(|parameter| parameter.lower),
            upper: collect(|parameter| parameter.upper),
        };
        let composes = compose::fits(domain.dimension(), system.q.len());
        let request = requested(&description.bounds, options.methods.as_deref(), domain.dimension(), composes)?;
        let Options { certify_time, progress, interrupted, .. } = *options;
        Ok(Self { description, simulator, domain, request, certify_time, progress, interrupted })
    }

    /// The same of a part of the box; a scan's points lie as close as in the whole.
    pub(super) fn over<'b>(&'b self, part: &ParameterBox, progress: &'b (dyn Fn(f64) + Sync)) -> Study<'b> {
        let mut request = self.request.clone();
        for (axis, points) in request.scan.iter_mut().flat_map(|scan| scan.points.iter_mut().enumerate()) {
            let share = part.half_width(axis) / self.domain.half_width(axis);
            let scaled = (*points as f64 * share).ceil() as usize;
            *points = if share < 1.0 { scaled.max(2) } else { *points };
        }
        Study { domain: part.clone(), request, progress, simulator: self.simulator.clone(), ..*self }
    }

    /// Rows of output that are asked for.
    pub(super) fn rows(&self) -> usize {
        Schedule::rows_of(self.description.simulation.duration, self.description.simulation.output_step)
    }

    /// Tries whether held-out samples come to the end: the probes, or with a tolerance the pilots.
    pub(super) fn try_samples(&self) -> Result<Tried, RunError> {
        let simulation = &self.description.simulation;
        let (duration, output_step) = (simulation.duration, simulation.output_step);
        match simulation.stepping {
            Stepping::Fixed(step) => {
                let schedule = Schedule::fixed(duration, step, output_step);
                let progress = Progress { done: AtomicUsize::new(0), total: usize::MAX };
                let run = Run { study: self, schedule: &schedule, tolerance: None, progress: &progress, finish: false };
                let Probes { points, done, .. } = Probes::run(&run, Observed::Outputs)?;
                Ok(Tried {
                    reached: done.stop.as_ref().map_or(schedule.rows, |(stop, _)| stop.row),
                    any: done.stopped.len() < points.len(),
                    stopped: done.stopped.iter().map(|&sample| points[sample].clone()).collect(),
                })
            }
            Stepping::Tolerance(tolerance) => {
                let pilots = self.pilots();
                let piloted = schedule_for_tolerance(&self.simulator, &pilots, duration, output_step, tolerance)?;
                // The nominal pilot may be of another part of the box.
                let inside = |pilot: &Vec<f64>| pilots[0] != *pilot || self.domain.contains(pilot);
                let going = (0..pilots.len()).filter(|pilot| !piloted.dropped.contains(pilot));
                Ok(Tried {
                    reached: piloted.complete_rows.min(piloted.schedule.rows),
                    any: going.into_iter().any(|pilot| inside(&pilots[pilot])),
                    stopped: piloted.dropped.iter().map(|&pilot| self.domain.xi(&pilots[pilot])).collect(),
                })
            }
        }
    }

    /// Runs every method.
    pub(super) fn run(&self) -> Result<Ran, RunError> {
        let simulation = &self.description.simulation;
        match simulation.stepping {
            Stepping::Fixed(step) => {
                let schedule = Schedule::fixed(simulation.duration, step, simulation.output_step);
                let results = self.methods(&schedule, None)?;
                Ok(self.conclude(results, None))
            }
            Stepping::Tolerance(_) if self.request.certified => Err(RunError::CertifiedSteps),
            Stepping::Tolerance(tolerance) => Ok(self.run_controlled(tolerance)?),
        }
    }

    /// The pilots' schedule is tried on all samples; one that needs smaller steps becomes a pilot, and all run again.
    fn run_controlled(&self, tolerance: f64) -> Result<Ran, SimulationError> {
        let simulation = &self.description.simulation;
        let mut pilots = self.pilots();
        let mut round = 1;
        loop {
            let (duration, output_step) = (simulation.duration, simulation.output_step);
            let ToleranceSchedule { schedule, failure, .. } =
                schedule_for_tolerance(&self.simulator, &pilots, duration, output_step, tolerance)?;
            let failure = failure.map(|failure| format!("{failure}; what does not need that sample is kept"));
            let results = self.methods(&schedule, Some(tolerance))?;
            match results.overstrained() {
                None => return Ok(self.conclude(results, failure)),
                Some((_, strain)) if round == PILOT_ROUNDS => {
                    let note =
                        format!("the local errors of a sample's steps add up to {strain:.2} times the tolerance");
                    return Ok(self.conclude(results, Some(note)));
                }
                Some((sample, _)) => pilots.push(sample),
            }
            round += 1;
        }
    }

    /// The nominal sample and corners of the box.
    fn pilots(&self) -> Vec<Vec<f64>> {
        let mut pilots = vec![self.domain.nominal.clone()];
        for corner in corners(self.domain.dimension(), PILOT_CORNERS).iter().map(|xi| self.domain.point(xi)) {
            if !pilots.contains(&corner) {
                pilots.push(corner);
            }
        }
        pilots
    }

    /// Nominal first, then the probes, then every method asked for. With a tolerance for the bounds, the probes decide how
    /// the schedule's steps are divided or joined.
    fn methods(&self, schedule: &Schedule, tolerance: Option<f64>) -> Result<Results, SimulationError> {
        if self.domain.dimension() == 0 {
            return self.deterministic(schedule, tolerance);
        }
        let progress = Progress { done: AtomicUsize::new(0), total: self.total_work(schedule) };
        let (schedule, probes) = if self.request.is_empty() {
            (schedule.clone(), None)
        } else {
            let (schedule, probes) = self.balance(schedule, tolerance, &progress)?;
            (schedule, Some(probes))
        };
        let run = Run { study: self, schedule: &schedule, tolerance, progress: &progress, finish: false };
        let nominal = Run { finish: true, ..run }.nominal()?;
        let (mut methods, mut halved) = (Vec::new(), Vec::new());
        if let Some(probes) = &probes {
            methods = self.requested(&run, probes)?;
            if self.request.certified && !run.is_interrupted() {
                methods.push((Method::Certified, run.certified()));
            }
            if self.certify_time && !run.is_interrupted() {
                let schedule = schedule.refined(2);
                halved = self.requested(&Run { schedule: &schedule, tolerance: None, ..run }, probes)?;
            }
        }
        Ok(Results { schedule, nominal, probes, methods, halved })
    }

    /// What is to be known of the probes.
    fn observed(&self) -> Observed {
        let composed = |request: &ChebyshevRequest| request.expand == Expand::Coordinates && self.composes();
        if self.request.chebyshev.as_ref().is_some_and(composed) { Observed::Motion } else { Observed::Outputs }
    }

    /// Whether outputs can follow from expanded coordinates.
    pub(super) fn composes(&self) -> bool {
        compose::fits(self.domain.dimension(), self.simulator.system.q.len())
    }

    /// The probes, and the schedule whose steps take their share of the bounds' tolerance, where there is one.
    fn balance(
        &self,
        schedule: &Schedule,
        tolerance: Option<f64>,
        progress: &Progress,
    ) -> Result<(Schedule, Probes), SimulationError> {
        let mut steps = StepSearch::new(schedule);
        loop {
            let schedule = steps.schedule();
            let probes = Probes::run(
                &Run { study: self, schedule: &schedule, tolerance, progress, finish: false },
                self.observed(),
            )?;
            let Some(allowed) = self.request.tolerance else { return Ok((schedule, probes)) };
            if !steps.adjust(probes.worst_share(allowed, schedule.rows)) {
                return Ok((schedule, probes));
            }
        }
    }

    fn requested(&self, run: &Run, probes: &Probes) -> Result<Vec<(Method, Outcome)>, SimulationError> {
        // Those that were not begun when the user would not wait any more are left out.
        let goes_on = || !run.is_interrupted();
        let mut outcomes = Vec::new();
        if let Some(request) = &self.request.chebyshev
            && goes_on()
        {
            outcomes.push((Method::Chebyshev, run.chebyshev(request, probes)?));
        }
        if let Some(request) = &self.request.taylor
            && goes_on()
        {
            outcomes.push((Method::Taylor, run.taylor(request, probes)?));
        }
        if let Some(request) = &self.request.scan
            && goes_on()
        {
            outcomes.push((Method::Scan, run.scan(request, probes)?));
        }
        Ok(outcomes)
    }

    /// Samples × rows of all methods; a jet counts as its coefficients.
    fn total_work(&self, schedule: &Schedule) -> usize {
        let chebyshev = self.request.chebyshev.as_ref().map_or(0, |request| match &request.degree {
            Degree::Fixed { nodes, .. } => nodes.iter().product(),
            Degree::Adaptive => self.request.budget.solves,
        });
        let taylor = self.request.taylor.as_ref().map_or(0, |request| TAYLOR_WORK * (request.order + 1));
        let scan = self.request.scan.as_ref().map_or(0, |request| request.points.iter().product());
        let k = self.domain.dimension();
        let probes = if self.request.is_empty() { 0 } else { probes(k).len() + validation(k).len() };
        let methods = (chebyshev + taylor + scan) * if self.certify_time { 2 } else { 1 };
        (1 + probes + methods) * schedule.rows
    }

    /// Bounds up to the last row of which something is known, and the summary.
    fn conclude(&self, results: Results, note: Option<String>) -> Ran {
        let stop = results.stops().min_by_key(|(stop, _)| (stop.row, stop.sample)).cloned();
        // Where one method cannot go on, its bounds are unknown from there on, and the others' are kept.
        let rows = results.outcomes().map(|outcome| outcome.reached).max().unwrap_or(0);
        let outputs = self.simulator.system.outputs.iter().enumerate().map(|(place, output)| OutputBounds {
            name: output.name.clone(),
            unit: output.unit.clone(),
            nominal: results.nominal.bands[place][..rows].iter().map(|range| range.lower).collect(),
            bands: self.bands(&results, place, rows),
        });
        let contributions = self.contributions(&results, rows);
        let bounds = Bounds {
            contributions,
            times: (0..rows).map(|row| results.schedule.time(row)).collect(),
            outputs: outputs.collect(),
            covered: Vec::new(),
        };
        let notes = || results.outcomes().find_map(|outcome| outcome.note.clone());
        let interrupted = || (self.interrupted)().then(|| INTERRUPTED.to_owned());
        let stuck = stop.map(|(stop, sample)| self.failure(&stop, &sample));
        let failure = stuck.or(note).or_else(interrupted).or_else(notes);
        let whole = results.whole().min(rows);
        let summary = self.summary(results, &bounds, failure);
        Ran { bounds, summary, whole }
    }

    /// Every parameter's part in every output's spread, as Chebyshev's surrogate knows it.
    fn contributions(&self, results: &Results, rows: usize) -> Vec<Vec<Contribution>> {
        let chebyshev = results.methods.iter().find(|(method, _)| *method == Method::Chebyshev);
        let known = |outcome: &Outcome| outcome.parts.iter().flatten().any(Option::is_some);
        let Some((_, outcome)) = chebyshev.filter(|(_, outcome)| known(outcome)) else { return Vec::new() };
        let of_parameter = |parts: &[Option<Parts>], place: usize| {
            let line = |pick: fn(&Parts) -> &Vec<f64>| {
                parts[..rows].iter().map(|parts| parts.as_ref().map_or(f64::NAN, |parts| pick(parts)[place])).collect()
            };
            Contribution {
                parameter: self.simulator.system.parameters[place].name.clone(),
                main: line(|parts| &parts.main),
                total: line(|parts| &parts.total),
                width_without: line(|parts| &parts.width_without),
            }
        };
        let of_output =
            |parts: &Vec<Option<Parts>>| (0..self.domain.dimension()).map(|place| of_parameter(parts, place)).collect();
        outcome.parts.iter().map(of_output).collect()
    }

    /// An output's band by every method, with its error.
    fn bands(&self, results: &Results, output: usize, rows: usize) -> Vec<Band> {
        let Some(probes) = &results.probes else { return Vec::new() };
        let band = |(place, (method, outcome)): (usize, &(Method, Outcome))| {
            let ranges = &outcome.bands[output][..rows];
            let halved = results.halved.get(place).map(|(_, halved)| &halved.bands[output]);
            let time: Vec<f64> = (0..rows)
                .map(|row| match halved {
                    Some(halved) => time_error_certified(ranges[row], halved[row]),
                    // Either is enough: what the probes near the ends show, and what the coordinates' errors do to the ends,
                    // which is nothing where a range is saturated. (`min` passes over not a number.)
                    None => time_error(ranges[row], &probes.direct.at(row, output), &probes.halved.at(row, output))
                        .min(outcome.steps[output][row]),
                })
                .collect();
            let surrogate = &outcome.surrogate[output][..rows];
            Band {
                method: *method,
                lower: ranges.iter().map(|range| range.lower).collect(),
                upper: ranges.iter().map(|range| range.upper).collect(),
                error: BandError::new(ranges, surrogate, &time, probes.spans[output], self.request.tolerance),
            }
        };
        results.methods.iter().enumerate().map(band).collect()
    }

    fn failure(&self, stop: &Stop, sample: &[f64]) -> String {
        let parameters = self.simulator.with_names(sample);
        if stop.singular {
            let singular = SimulationError::SingularJet { time: stop.time };
            return format!("{singular}: Taylor bounds are unknown from there on");
        }
        if let Some(open) = stop.open {
            let locked = self.simulator.locked(open, stop.time, parameters);
            return format!("{locked}; results up to that time are kept");
        }
        let stuck = SimulationError::NotConverged {
            sample: stop.sample,
            time: stop.time,
            equation: self.simulator.equation_name(stop.equation),
            parameters,
        };
        format!(
            "{stuck}; bounds that need it are kept up to that time, a scan is of those that went on. Try a smaller step"
        )
    }

    fn summary(&self, results: Results, bounds: &Bounds, failure: Option<String>) -> Summary {
        let system = &self.simulator.system;
        let mobility = &self.simulator.mobility;
        let names = |constraints: &[usize]| constraints.iter().map(|&k| system.constraints[k].name.clone()).collect();
        let singular = results
            .nominal
            .singular
            .iter()
            .map(|pass| SingularSummary { time: pass.time, constraints: names(&pass.constraints) });
        Summary {
            model: self.description.name.clone(),
            mbint: env!("CARGO_PKG_VERSION").to_owned(),
            coordinates: system.q.len(),
            constraints: system.lambda.len(),
            degrees_of_freedom: mobility.degrees_of_freedom,
            redundant_constraints: names(&mobility.redundant),
            undetermined_outputs: self.simulator.undetermined.iter().map(|&k| system.outputs[k].name.clone()).collect(),
            singular_at_start: names(&mobility.singular_at_start),
            singular_configurations: singular.collect(),
            alpha: self.description.simulation.alpha,
            duration: self.description.simulation.duration,
            parameters: system
                .parameters
                .iter()
                .map(|parameter| ParameterSummary {
                    name: parameter.name.clone(),
                    unit: parameter.unit.clone(),
                    nominal: parameter.nominal,
                    lower: parameter.lower,
                    upper: parameter.upper,
                })
                .collect(),
            methods: std::iter::once(results.nominal.summary)
                .chain(results.probes.map(|probes| probes.summary))
                .chain(results.methods.into_iter().map(|(_, outcome)| outcome.summary))
                .chain(results.halved.into_iter().map(|(method, outcome)| MethodSummary {
                    method: format!("{} with halved steps", method.name()),
                    ..outcome.summary
                }))
                .collect(),
            errors: summarised_errors(bounds),
            contributions: contributions(bounds),
            pieces: Vec::new(),
            not_simulated: Vec::new(),
            subsystems: Vec::new(),
            failure,
        }
    }
}

/// Every parameter's mean shares in every output, the largest first.
pub(super) fn contributions(bounds: &Bounds) -> Vec<ContributionSummary> {
    let of_output = |(output, contributions): (&OutputBounds, &Vec<Contribution>)| {
        let band = output.bands.iter().find(|band| band.method == Method::Chebyshev);
        let width = |row: usize| band.map_or(0.0, |band| band.upper[row] - band.lower[row]);
        let mean = |shares: &[f64]| {
            let known = || (0..shares.len()).filter(|&row| shares[row].is_finite() && width(row).is_finite());
            let total = known().map(width).sum::<f64>();
            // Of nothing, nobody has a share.
            if total == 0.0 { 0.0 } else { known().map(|row| width(row) * shares[row]).sum::<f64>() / total }
        };
        let summary = |contribution: &Contribution| ContributionSummary {
            output: output.name.clone(),
            parameter: contribution.parameter.clone(),
            main: mean(&contribution.main),
            total: mean(&contribution.total),
        };
        let mut summaries: Vec<ContributionSummary> = contributions.iter().map(summary).collect();
        summaries.sort_by(|a, b| b.total.total_cmp(&a.total));
        summaries
    };
    bounds.outputs.iter().zip(&bounds.contributions).flat_map(of_output).collect()
}

/// The largest errors of every band.
pub(super) fn summarised_errors(bounds: &Bounds) -> Vec<ErrorSummary> {
    let of_band = |output: &OutputBounds, band: &Band| ErrorSummary {
        output: output.name.clone(),
        method: band.method.name().to_owned(),
        width: band.upper.iter().zip(&band.lower).map(|(upper, lower)| upper - lower).fold(0.0, f64::max),
        error: band.error.largest(),
        surrogate: band.error.surrogate,
        time: band.error.time,
        unresolved_from: band.error.unresolved_from().map(|row| bounds.times[row]),
    };
    bounds.outputs.iter().flat_map(|output| output.bands.iter().map(move |band| of_band(output, band))).collect()
}

/// What is run: the model's requests, or defaults for methods named on the command line.
///
/// # Errors
/// Where a default would make too many samples (the model's own requests were checked when it was read).
fn requested(
    model: &BoundsRequest,
    methods: Option<&[Method]>,
    k: usize,
    composes: bool,
) -> Result<BoundsRequest, RunError> {
    let certified = model.certified || methods.is_some_and(|methods| methods.contains(&Method::Certified));
    if certified && k > MOST_PARAMETERS {
        return Err(RunError::TooManyToCertify { parameters: k });
    }
    let mut request = model.clone();
    request.certified = certified;
    if let Some(methods) = methods {
        let asked = |method: Method| methods.contains(&method);
        let chebyshev = || model.chebyshev.clone().unwrap_or_else(|| ChebyshevRequest::unspecified(k, model.tolerance));
        let taylor = || model.taylor.clone().unwrap_or_default();
        let scan = || model.scan.clone().unwrap_or_else(|| ScanRequest::of_points(ScanRequest::POINTS, k));
        request.chebyshev = asked(Method::Chebyshev).then(chebyshev);
        request.taylor = asked(Method::Taylor).then(taylor);
        request.scan = asked(Method::Scan).then(scan);
    }
    // Degrees grow with coordinates; where those are too many, or nothing is uncertain, outputs are expanded to a usual one.
    if let Some(chebyshev) =
        request.chebyshev.as_mut().filter(|request| request.degree == Degree::Adaptive && !composes)
    {
        let order = if k <= ChebyshevRequest::FEW { ChebyshevRequest::ORDER } else { 2 };
        *chebyshev = ChebyshevRequest { expand: Expand::Output, ..ChebyshevRequest::of_order(order, k) };
    }
    let nodes = |request: &ChebyshevRequest| match &request.degree {
        Degree::Fixed { nodes, .. } => nodes.clone(),
        Degree::Adaptive => Vec::new(),
    };
    let counts = [
        (Method::Chebyshev, request.chebyshev.as_ref().map(nodes)),
        (Method::Scan, request.scan.as_ref().map(|request| request.points.clone())),
    ];
    for (method, counts) in counts {
        let solves: f64 = counts.into_iter().flatten().map(|count| count as f64).product();
        if solves > MOST_SOLVES {
            return Err(RunError::TooMany { method: method.name(), solves, parameters: k });
        }
    }
    Ok(request)
}
