//! One model's study: the schedule that all samples share, the methods, and their results put together.

use std::sync::atomic::AtomicUsize;

use super::apportion::Parts;
use super::certify::MOST_PARAMETERS;
use super::compose;
use super::methods::{Outcome, Progress, Run, TAYLOR_WORK};
use super::probe::Probes;
use super::step_search::StepSearch;
use super::{Options, RunError, first_step, scheme};
use crate::bounds::{
    Band, BandError, Bounds, Contribution, Method, OutputBounds, ParameterBox, corners, largest, probes, time_error,
    time_error_certified, validation,
};
use crate::integrate::{Observed, Piloted, Schedule, SimulationError, Simulator, Stop, schedule_for_tolerance};
use crate::mechanics::{self, System};
use crate::model::{BoundsRequest, ChebyshevRequest, Degree, Description, Expand, MOST_SOLVES, ScanRequest, Stepping};
use crate::report::{ContributionSummary, ErrorSummary, MethodSummary, ParameterSummary, Summary};

/// Corners of the box that join the nominal sample as pilots of step-size control.
const PILOT_CORNERS: usize = 16;

/// How often samples that turn out to need smaller steps may be added to the pilots.
const PILOT_ROUNDS: usize = 8;

/// A model compiled, with what is asked of it.
pub(super) struct Study<'a> {
    description: &'a Description,
    pub(super) simulator: Simulator,
    pub(super) domain: ParameterBox,
    pub(super) request: BoundsRequest,
    /// Whether all samples are simulated with halved steps too.
    certify_time: bool,
    pub(super) progress: &'a (dyn Fn(f64) + Sync),
}

/// What one schedule yields.
struct Results {
    schedule: Schedule,
    nominal: Outcome,
    /// Absent where no method is asked for.
    probes: Option<Probes>,
    methods: Vec<(Method, Outcome)>,
    /// The same with halved steps, where asked for.
    halved: Vec<(Method, Outcome)>,
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

    /// The sample whose local error was largest against the tolerance, where it was larger.
    fn overstrained(&self) -> Option<(Vec<f64>, f64)> {
        let probes = self.probes.iter().filter_map(|probes| probes.done.strained.as_ref());
        let strained = self.outcomes().filter_map(|outcome| outcome.strained.as_ref()).chain(probes);
        strained.filter(|(_, strain)| *strain > 1.0).max_by(|a, b| a.1.total_cmp(&b.1)).cloned()
    }
}

impl<'a> Study<'a> {
    /// Builds, assembles and compiles.
    pub(super) fn new(description: &'a Description, system: System, options: &Options<'a>) -> Result<Self, RunError> {
        let collect = |pick: fn(&mechanics::UncertainParameter) -> f64| system.parameters.iter().map(pick).collect();
        let domain = ParameterBox {
            nominal: collect(|parameter| parameter.nominal),
            lower: collect(|parameter| parameter.lower),
            upper: collect(|parameter| parameter.upper),
        };
        let composes = compose::fits(domain.dimension(), system.q.len());
        let request = requested(&description.bounds, options.methods.as_deref(), domain.dimension(), composes)?;
        let simulator = Simulator::new(system, scheme(description), first_step(description))?;
        let Options { certify_time, progress, .. } = *options;
        Ok(Self { description, simulator, domain, request, certify_time, progress })
    }

    /// Runs every method.
    pub(super) fn run(&self) -> Result<(Bounds, Summary), RunError> {
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
    fn run_controlled(&self, tolerance: f64) -> Result<(Bounds, Summary), SimulationError> {
        let simulation = &self.description.simulation;
        let mut pilots = self.pilots();
        let mut round = 1;
        loop {
            let (duration, output_step) = (simulation.duration, simulation.output_step);
            let Piloted { schedule, failure } =
                schedule_for_tolerance(&self.simulator, &pilots, duration, output_step, tolerance)?;
            let failure = failure.map(|failure| format!("{failure}; results up to that time are kept"));
            let results = self.methods(&schedule, Some(tolerance))?;
            match results.overstrained() {
                None => return Ok(self.conclude(results, failure)),
                Some((_, strain)) if round == PILOT_ROUNDS => {
                    let note = format!("a sample's local error is {strain:.2} times the tolerance in the worst step");
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
        let progress = Progress { done: AtomicUsize::new(0), total: self.total_work(schedule) };
        let (schedule, probes) = if self.request.is_empty() {
            (schedule.clone(), None)
        } else {
            let (schedule, probes) = self.balance(schedule, tolerance, &progress)?;
            (schedule, Some(probes))
        };
        let run = Run { study: self, schedule: &schedule, tolerance, progress: &progress };
        let nominal = run.nominal()?;
        let (mut methods, mut halved) = (Vec::new(), Vec::new());
        if let Some(probes) = &probes {
            methods = self.requested(&run, probes)?;
            if self.request.certified {
                methods.push((Method::Certified, run.certified()));
            }
            if self.certify_time {
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
            let probes = Probes::run(&Run { study: self, schedule: &schedule, tolerance, progress }, self.observed())?;
            let Some(allowed) = self.request.tolerance else { return Ok((schedule, probes)) };
            let outputs = 0..self.simulator.program.outputs.len();
            let share = |output: usize| {
                let span = probes.direct.span(output);
                let error = largest(probes.time_error(output, schedule.rows));
                if span > 0.0 { error / (allowed * span) } else { 0.0 }
            };
            if !steps.adjust(largest(outputs.map(share))) {
                return Ok((schedule, probes));
            }
        }
    }

    fn requested(&self, run: &Run, probes: &Probes) -> Result<Vec<(Method, Outcome)>, SimulationError> {
        let mut outcomes = Vec::new();
        if let Some(request) = &self.request.chebyshev {
            outcomes.push((Method::Chebyshev, run.chebyshev(request, probes)?));
        }
        if let Some(request) = &self.request.taylor {
            outcomes.push((Method::Taylor, run.taylor(request, probes)?));
        }
        if let Some(request) = &self.request.scan {
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

    /// Bounds up to the first row that a sample did not reach, and the summary.
    fn conclude(&self, results: Results, note: Option<String>) -> (Bounds, Summary) {
        let stop = results.stops().min_by_key(|(stop, _)| (stop.row, stop.sample)).cloned();
        // Where only the jet cannot go on, its bounds are unknown from there on, and the others' are kept.
        let end = results.stops().filter(|(stop, _)| !stop.singular).map(|(stop, _)| stop.row).min();
        let rows = end.unwrap_or(results.schedule.rows);
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
        };
        let notes = || results.outcomes().find_map(|outcome| outcome.note.clone());
        let failure = stop.map(|(stop, sample)| self.failure(&stop, &sample)).or(note).or_else(notes);
        let summary = self.summary(results, &bounds, failure);
        (bounds, summary)
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
                error: BandError::new(ranges, surrogate, &time, probes.direct.span(output), self.request.tolerance),
            }
        };
        results.methods.iter().enumerate().map(band).collect()
    }

    fn failure(&self, stop: &Stop, sample: &[f64]) -> String {
        let names = self.simulator.system.parameters.iter().map(|parameter| parameter.name.clone());
        if stop.singular {
            let singular = SimulationError::SingularJet { time: stop.time };
            return format!("{singular}: Taylor bounds are unknown from there on");
        }
        let stuck = SimulationError::Stuck {
            sample: stop.sample,
            time: stop.time,
            equation: self.simulator.equation_name(stop.equation),
            parameters: names.zip(sample.iter().copied()).collect(),
        };
        format!(
            "{stuck}; results up to that time are kept. Try a smaller step, or see whether the mechanism locks there"
        )
    }

    fn summary(&self, results: Results, bounds: &Bounds, failure: Option<String>) -> Summary {
        let system = &self.simulator.system;
        let mobility = &self.simulator.mobility;
        Summary {
            model: self.description.name.clone(),
            mbint: env!("CARGO_PKG_VERSION").to_owned(),
            coordinates: system.q.len(),
            constraints: system.lambda.len(),
            degrees_of_freedom: mobility.degrees_of_freedom,
            redundant_constraints: mobility.redundant.iter().map(|&k| system.constraints[k].name.clone()).collect(),
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
            errors: errors(bounds),
            contributions: contributions(bounds),
            failure,
        }
    }
}

/// Every parameter's mean shares in every output, the largest first.
fn contributions(bounds: &Bounds) -> Vec<ContributionSummary> {
    let of_output = |(output, contributions): (&OutputBounds, &Vec<Contribution>)| {
        let band = output.bands.iter().find(|band| band.method == Method::Chebyshev);
        let width = |row: usize| band.map_or(0.0, |band| band.upper[row] - band.lower[row]);
        let mean = |shares: &[f64]| {
            let known = || (0..shares.len()).filter(|&row| shares[row].is_finite() && width(row).is_finite());
            known().map(|row| width(row) * shares[row]).sum::<f64>() / known().map(width).sum::<f64>()
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
fn errors(bounds: &Bounds) -> Vec<ErrorSummary> {
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
