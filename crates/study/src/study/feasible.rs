//! A box in part of which the mechanism cannot be assembled, or does not move to the end: how much of it that is and
//! where, and bounds of the rest.
//!
//! The box is cut into pieces, across the parameter that separates failing samples from others best, as long as
//! held-out samples of a piece fail. Each piece whose samples do not is bounded as if it were the whole; a row's bounds
//! are those of the pieces that reached it together, and are reported with the share of the box of these pieces.

use std::fmt;

use super::answers::Ran;
use super::problem::Study;
use super::single::{self, Tried, try_samples};

use super::RunError;
use super::tuning::TUNING;
use crate::numerics::{ParameterBox, Range, spread, validation};
use crate::results::{self, Bounds, ErrorSummary, PieceSummary, Summary, add_methods, bounds_of_pieces};
use crate::simulate::SimulationError;

/// Samples spread over the box of which some cannot be assembled.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// The first sample that was met.
    first: SimulationError,
    /// All that were tried, and those that cannot be.
    samples: usize,
    /// Number of samples that fail.
    failing: usize,
    /// Ranges in which these lie, parameter by parameter, if they are informative.
    places: Vec<FailureRange>,
}

/// Range of one parameter in which samples fail.
#[derive(Clone, Debug, PartialEq)]
pub struct FailureRange {
    /// Name of the parameter.
    parameter: String,
    /// Least and largest value of samples that fail.
    lower: f64,
    upper: f64,
    /// The end of the interval that most of them are near to, if they are from all of it.
    towards: Option<f64>,
}

impl fmt::Display for Survey {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { first, samples, failing, places } = self;
        write!(formatter, "{first}; so it is with {failing} of {samples} samples spread over the box")?;
        let place = |FailureRange { parameter, lower, upper, towards }: &FailureRange| match towards {
            Some(end) => format!("mostly towards {parameter} = {end}"),
            None => format!("with {parameter} from {lower} to {upper}"),
        };
        let places: Vec<String> = places.iter().map(place).collect();
        if places.is_empty() { Ok(()) } else { write!(formatter, ", {}", places.join(", ")) }
    }
}

/// Messages of a run with a sample that cannot be assembled.
pub(super) fn explained(study: &Study, error: RunError) -> RunError {
    match error {
        RunError::Simulation(source @ (SimulationError::Assembly { .. } | SimulationError::OffBranch { .. }))
            if study.domain.dimension() > 0 =>
        {
            RunError::Infeasible(Box::new(survey(study, source)))
        }
        other => other,
    }
}

fn survey(study: &Study, first: SimulationError) -> Survey {
    let domain = &study.domain;
    let mut points = validation(domain.dimension(), study.request.degree());
    points.extend(spread(domain.dimension(), TUNING.surveyed));
    let can = study.simulator.can_assemble(&domain.samples(&points));
    let failing: Vec<&Vec<f64>> = points.iter().zip(&can).filter(|(_, can)| !**can).map(|(xi, _)| xi).collect();
    let place = |axis: usize| {
        let along = failing.iter().map(|xi| xi[axis]);
        let range = Range::of(&along.clone().collect::<Vec<f64>>());
        let mean = along.sum::<f64>() / failing.len() as f64;
        let all = range.width() > 1.9;
        let towards = all.then(|| domain.value(axis, mean.signum()));
        let [lower, upper] = [range.lower, range.upper].map(|xi| domain.value(axis, xi));
        let parameter = study.simulator.system.parameters[axis].name.clone();
        let says = !(all && mean.abs() < TUNING.leans) && domain.half_width(axis) > 0.0;
        says.then_some(FailureRange { parameter, lower, upper, towards })
    };
    let places = (0..domain.dimension()).filter_map(place).collect();
    Survey { first, samples: points.len(), failing: failing.len(), places }
}

/// A part of the box.
struct Piece {
    domain: ParameterBox,
    /// Share of the whole box.
    share: f64,
    found: Found,
}

/// Outcome of a piece's held-out samples.
enum Found {
    /// All reach the end.
    Whole,
    /// Some do not; how much of the time is lost, and ξ of the ones that fail first.
    Partly { lost: f64, failing: Vec<Vec<f64>> },
    /// None does; all can be assembled.
    Ending,
    /// None can be assembled.
    Nothing,
}

/// Bounds of the part of the box that is feasible.
///
/// # Errors
/// If no part is, and as for any run.
pub(super) fn run(study: &Study) -> Result<(Bounds, Summary), RunError> {
    let pieces = cut(study)?;
    let pieces: Vec<Piece> = pieces.into_iter().filter(|piece| !matches!(piece.found, Found::Nothing)).collect();
    let mut ran: Vec<(Ran, &Piece)> = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        if study.interruption.is_asked() && !ran.is_empty() {
            break;
        }
        let progress = |fraction: f64| (study.progress)((index as f64 + fraction) / pieces.len() as f64);
        match single::run(&study.over(&piece.domain, &progress)) {
            Ok(found) if found.whole > 0 => ran.push((found, piece)),
            Ok(_) | Err(RunError::Simulation(SimulationError::Assembly { .. })) => (),
            Err(error) => return Err(error),
        }
    }
    match ran.is_empty() {
        // There is nothing to report but the result of the whole box' own run.
        true => single::run(study).map(|ran| (ran.bounds, ran.summary)).map_err(|error| explained(study, error)),
        false => Ok(merged(study, &ran)),
    }
}

/// Cuts the box; pieces that reach the end are not cut any more.
fn cut(study: &Study) -> Result<Vec<Piece>, RunError> {
    let piece = |domain: ParameterBox, share: f64| -> Result<Piece, RunError> {
        let found = trial(&study.over(&domain, &|_| ()))?;
        Ok(Piece { domain, share, found })
    };
    let mut pieces = vec![piece(study.domain.clone(), 1.0)?];
    while pieces.len() < TUNING.most_pieces && !study.interruption.is_asked() {
        let gain = |piece: &Piece| match &piece.found {
            Found::Partly { lost, .. } if piece.share > TUNING.smallest_piece => piece.share * lost,
            _ => 0.0,
        };
        let Some(worst) = (0..pieces.len()).max_by(|&a, &b| gain(&pieces[a]).total_cmp(&gain(&pieces[b]))) else {
            break;
        };
        let Found::Partly { failing, .. } = &pieces[worst].found else { break };
        let Some(axis) = axis_to_cut(&study.domain, &pieces[worst].domain, failing) else { break };
        if gain(&pieces[worst]) == 0.0 {
            break;
        }
        let whole = pieces.swap_remove(worst);
        for half in whole.domain.halves(axis) {
            pieces.push(piece(half, 0.5 * whole.share)?);
        }
    }
    Ok(pieces)
}

/// The axis along which samples that fail lie farthest to one side, the wide before the narrow; none if nothing is
/// uncertain.
fn axis_to_cut(whole: &ParameterBox, piece: &ParameterBox, failing: &[Vec<f64>]) -> Option<usize> {
    let score = |axis: usize| {
        let mean = failing.iter().map(|xi| xi[axis]).sum::<f64>() / failing.len().max(1) as f64;
        (0.01 + mean.abs()) * piece.half_width(axis) / whole.half_width(axis)
    };
    let uncertain = (0..whole.dimension()).filter(|&axis| whole.half_width(axis) > 0.0);
    uncertain.reduce(|a, b| if score(b) > score(a) { b } else { a })
}

/// Simulates a piece's held-out samples.
fn trial(study: &Study) -> Result<Found, RunError> {
    let points = validation(study.domain.dimension(), study.request.degree());
    let can = study.simulator.can_assemble(&study.domain.samples(&points));
    if !can.contains(&true) {
        return Ok(Found::Nothing);
    }
    if can.contains(&false) {
        let failing = points.into_iter().zip(can).filter(|(_, can)| !can).map(|(xi, _)| xi).collect();
        return Ok(Found::Partly { lost: 1.0, failing });
    }
    let Tried { reached, stopped, any } = try_samples(study)?;
    let rows = study.rows();
    Ok(match rows.saturating_sub(reached) {
        0 => Found::Whole,
        _ if !any => Found::Ending,
        lost => Found::Partly { lost: lost as f64 / rows as f64, failing: stopped },
    })
}

/// Bounds of all pieces, merged.
fn merged(study: &Study, ran: &[(Ran, &Piece)]) -> (Bounds, Summary) {
    let pieces: Vec<results::Piece> = ran
        .iter()
        .map(|(ran, piece)| results::Piece { bounds: &ran.bounds, rows: ran.whole, share: piece.share })
        .collect();
    let bounds = bounds_of_pieces(&pieces);
    let summary = summary(study, ran, &bounds);
    (bounds, summary)
}

/// Cost of all pieces.
fn summary(study: &Study, ran: &[(Ran, &Piece)], bounds: &Bounds) -> Summary {
    let mut summary = ran[0].0.summary.clone();
    ran[1..].iter().for_each(|(ran, _)| add_methods(&mut summary, &ran.summary.methods));
    let piece = |(ran, piece): &(Ran, &Piece)| PieceSummary {
        lower: piece.domain.lower.clone(),
        upper: piece.domain.upper.clone(),
        until: ran.bounds.times[ran.whole - 1],
    };
    for (ran, _) in &ran[1..] {
        let pairs = summary.reduced.iter_mut().zip(&ran.summary.reduced);
        pairs.for_each(|(own, other)| own.add_piece(other));
        let pairs = summary.requirements.iter_mut().zip(&ran.summary.requirements);
        pairs.for_each(|(own, other)| own.add_piece(other));
    }
    summary.pieces = ran.iter().map(piece).collect();
    summary.errors = ErrorSummary::of(bounds);
    if ran.len() > 1 {
        summary.contributions.clear();
    }
    summary.failure =
        ran.iter().find_map(|(ran, _)| ran.summary.failure.clone().filter(|_| study.interruption.is_asked()));
    summary
}
