//! One model's study: the schedule that all samples share, the methods, and their results put together.

use std::sync::atomic::AtomicUsize;

use super::certify::MOST_PARAMETERS;
use super::methods::{Outcome, Run, TAYLOR_WORK};
use super::{Options, RunError, first_step};
use crate::bounds::{Band, Bounds, Method, OutputBounds, ParameterBox, Range};
use crate::integrate::{Piloted, Schedule, SimulationError, Simulator, Stop, schedule_for_tolerance};
use crate::mechanics::{self, System};
use crate::model::{BoundsRequest, ChebyshevRequest, Description, MOST_SOLVES, ScanRequest, Stepping};
use crate::report::{ParameterSummary, Summary};

/// Corners of the box that join the nominal sample as pilots of step-size control.
const PILOT_CORNERS: usize = 16;

/// How often samples that turn out to need smaller steps may be added to the pilots.
const PILOT_ROUNDS: usize = 8;

/// A model compiled, with what is asked of it.
pub(super) struct Study<'a> {
    description: &'a Description,
    pub(super) simulator: Simulator,
    pub(super) domain: ParameterBox,
    request: BoundsRequest,
    pub(super) progress: &'a (dyn Fn(f64) + Sync),
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
        let request = requested(&description.bounds, options.methods.as_deref(), domain.dimension())?;
        let simulator = Simulator::new(system, description.simulation.alpha, first_step(description))?;
        Ok(Self { description, simulator, domain, request, progress: options.progress })
    }

    /// Runs every method.
    pub(super) fn run(&self) -> Result<(Bounds, Summary), RunError> {
        let simulation = &self.description.simulation;
        match simulation.stepping {
            Stepping::Fixed(step) => {
                let schedule = Schedule::fixed(simulation.duration, step, simulation.output_step);
                let outcomes = self.methods(&schedule, None)?;
                Ok(self.conclude(&schedule, outcomes, None))
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
            let outcomes = self.methods(&schedule, Some(tolerance))?;
            let strained = outcomes.iter().filter_map(|outcome| outcome.strained.clone());
            match strained.filter(|(_, strain)| *strain > 1.0).reduce(|a, b| if b.1 > a.1 { b } else { a }) {
                None => return Ok(self.conclude(&schedule, outcomes, failure)),
                Some((_, strain)) if round == PILOT_ROUNDS => {
                    let note = format!("a sample's local error is {strain:.2} times the tolerance in the worst step");
                    return Ok(self.conclude(&schedule, outcomes, Some(note)));
                }
                Some((sample, _)) => pilots.push(sample),
            }
            round += 1;
        }
    }

    /// The nominal sample and corners of the box: all where they are few, else such that any two parameters meet at every
    /// pair of their ends (the signs of Walsh functions).
    fn pilots(&self) -> Vec<Vec<f64>> {
        let k = self.domain.dimension();
        let corner = |index: usize| {
            let mask = |axis: usize| if k <= 4 { 1 << axis } else { axis % (PILOT_CORNERS - 1) + 1 };
            let sign = |axis: usize| (index & mask(axis)).count_ones().is_multiple_of(2);
            let xi: Vec<f64> = (0..k).map(|axis| if sign(axis) { -1.0 } else { 1.0 }).collect();
            let mut values = vec![0.0; k];
            self.domain.map(&xi, &mut values);
            values
        };
        let mut pilots = vec![self.domain.nominal.clone()];
        for corner in (0..if k == 0 { 0 } else { PILOT_CORNERS }).map(corner) {
            if !pilots.contains(&corner) {
                pilots.push(corner);
            }
        }
        pilots
    }

    /// Nominal first, then every method asked for.
    fn methods(&self, schedule: &Schedule, tolerance: Option<f64>) -> Result<Vec<Outcome>, SimulationError> {
        let run = Run { study: self, schedule, tolerance, done: AtomicUsize::new(0), total: self.total_work(schedule) };
        let mut outcomes = vec![run.nominal()?];
        if let Some(request) = &self.request.chebyshev {
            outcomes.push(run.chebyshev(request)?);
        }
        if let Some(request) = &self.request.taylor {
            outcomes.push(run.taylor(request)?);
        }
        if let Some(request) = &self.request.scan {
            outcomes.push(run.scan(request)?);
        }
        if self.request.certified {
            outcomes.push(run.certified());
        }
        Ok(outcomes)
    }

    /// Samples × rows of all methods; a jet counts as its coefficients.
    fn total_work(&self, schedule: &Schedule) -> usize {
        let chebyshev = self.request.chebyshev.as_ref().map_or(0, |request| request.nodes.iter().product());
        let taylor = self.request.taylor.as_ref().map_or(0, |request| TAYLOR_WORK * (request.order + 1));
        let scan = self.request.scan.as_ref().map_or(0, |request| request.points.iter().product());
        (1 + chebyshev + taylor + scan) * schedule.rows
    }

    /// Bounds up to the first row that a sample did not reach, and the summary.
    fn conclude(&self, schedule: &Schedule, outcomes: Vec<Outcome>, note: Option<String>) -> (Bounds, Summary) {
        let stops = || outcomes.iter().filter_map(|outcome| outcome.stop.as_ref());
        let first = |stops: &mut dyn Iterator<Item = &'_ (Stop, Vec<f64>)>| {
            stops.min_by_key(|(stop, _)| (stop.row, stop.sample)).cloned()
        };
        let stop = first(&mut stops());
        // Where only the jet cannot go on, its bounds are unknown from there on, and the others' are kept.
        let end = first(&mut stops().filter(|(stop, _)| !stop.singular));
        let rows = end.map_or(schedule.rows, |(stop, _)| stop.row);
        let times: Vec<f64> = (0..rows).map(|row| schedule.time(row)).collect();
        let methods = self.requested_methods();
        let mut outputs: Vec<OutputBounds> = Vec::new();
        for (place, output) in self.simulator.system.outputs.iter().enumerate() {
            let line =
                |outcome: &Outcome, end: fn(&Range) -> f64| outcome.bands[place][..rows].iter().map(end).collect();
            let bands = methods.iter().zip(&outcomes[1..]).map(|(&method, outcome)| Band {
                method,
                lower: line(outcome, |range| range.lower),
                upper: line(outcome, |range| range.upper),
            });
            outputs.push(OutputBounds {
                name: output.name.clone(),
                unit: output.unit.clone(),
                nominal: line(&outcomes[0], |range| range.lower),
                bands: bands.collect(),
            });
        }
        let failure = stop.map(|(stop, sample)| self.failure(&stop, &sample)).or(note);
        let failure = failure.or_else(|| outcomes.iter().find_map(|outcome| outcome.note.clone()));
        (Bounds { times, outputs }, self.summary(outcomes, failure))
    }

    fn requested_methods(&self) -> Vec<Method> {
        let asked = [
            self.request.chebyshev.is_some(),
            self.request.taylor.is_some(),
            self.request.scan.is_some(),
            self.request.certified,
        ];
        Method::ALL.into_iter().zip(asked).filter(|(_, asked)| *asked).map(|(method, _)| method).collect()
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

    fn summary(&self, outcomes: Vec<Outcome>, failure: Option<String>) -> Summary {
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
            methods: outcomes.into_iter().map(|outcome| outcome.summary).collect(),
            failure,
        }
    }
}

/// What is run: the model's requests, or defaults for methods named on the command line.
///
/// # Errors
/// Where a default would make too many samples (the model's own requests were checked when it was read).
fn requested(model: &BoundsRequest, methods: Option<&[Method]>, k: usize) -> Result<BoundsRequest, RunError> {
    let certified = model.certified || methods.is_some_and(|methods| methods.contains(&Method::Certified));
    if certified && k > MOST_PARAMETERS {
        return Err(RunError::TooManyToCertify { parameters: k });
    }
    let Some(methods) = methods else { return Ok(model.clone()) };
    let asked = |method: Method| methods.contains(&method);
    let chebyshev =
        || model.chebyshev.clone().unwrap_or_else(|| ChebyshevRequest::of_order(ChebyshevRequest::ORDER, k));
    let taylor = || model.taylor.clone().unwrap_or_default();
    let scan = || model.scan.clone().unwrap_or_else(|| ScanRequest::of_points(ScanRequest::POINTS, k));
    let request = BoundsRequest {
        chebyshev: asked(Method::Chebyshev).then(chebyshev),
        taylor: asked(Method::Taylor).then(taylor),
        scan: asked(Method::Scan).then(scan),
        certified,
    };
    let counts = [
        (Method::Chebyshev, request.chebyshev.as_ref().map(|request| &request.nodes)),
        (Method::Scan, request.scan.as_ref().map(|request| &request.points)),
    ];
    for (method, counts) in counts {
        let solves: f64 = counts.into_iter().flatten().map(|&count| count as f64).product();
        if solves > MOST_SOLVES {
            return Err(RunError::TooMany { method: method.name(), solves, parameters: k });
        }
    }
    Ok(request)
}
