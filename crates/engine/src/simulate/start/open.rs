//! Parts of the start that the given values and the constraints leave open.

use rustc_hash::FxHashMap;
use symdiff::Expr;

use super::mobility::jacobian_rows;
use super::rank::dependent_rows;
use super::tuning::TUNING;
use crate::assemble::{Distance, System};
use crate::compile::{Layout, OpenStart, StartProgram, time_derivative};

/// Samples for which a start is searched for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Samples {
    /// The nominal one only.
    Nominal,
    /// All.
    All,
}

/// Open coordinates that are not at rest in every sample, of a start assembled without a search for rest.
pub fn open_start(system: &System, start: &StartProgram, nominal: &[f64], samples: Samples) -> OpenStart {
    if system.start.nearest.is_none() {
        return OpenStart::default();
    }
    let is_apart = |kind: Kind| {
        distances(system, &start.layout, nominal, kind)
            .iter()
            .any(|(distance, value)| !(value / distance.scale).abs().le(&TUNING.at_rest))
    };
    // With constraints, other parameters move coordinates that are at rest in the nominal start.
    let follows = samples == Samples::All && !system.parameters.is_empty() && !system.lambda.is_empty();
    let mut rows = None;
    let mut is_free = |given: &[Option<Expr>], constraints: usize, conditions: usize| {
        let rows = &rows.get_or_insert_with(|| jacobian_rows(system, start, nominal))[..constraints];
        let open = |row: &Vec<(usize, f64)>| row.iter().copied().filter(|(index, _)| given[*index].is_none()).collect();
        let rows: Vec<Vec<(usize, f64)>> = rows.iter().map(open).collect();
        let rank = rows.len() - dependent_rows(&rows, TUNING.dependent_row).len();
        given.iter().filter(|given| given.is_none()).count() > rank + conditions
    };
    let conditions = &system.start.conditions;
    let of_position = conditions.iter().filter(|condition| condition.position).count();
    let of_velocity = conditions.iter().filter(|condition| condition.velocity).count();
    OpenStart {
        positions: (follows || is_apart(Kind::Position))
            && is_free(&system.start.position, system.constraint.len(), of_position),
        velocities: is_driven(system)
            && (follows || is_apart(Kind::Velocity))
            && is_free(&system.start.velocity, system.lambda.len(), of_velocity),
    }
}

/// Names of coordinates that share the open part, so that the start is a choice among many.
pub fn shared_coordinates(system: &System, start: &StartProgram, nominal: &[f64]) -> Vec<String> {
    let mut shared = Vec::new();
    for (kind, is_open) in [(Kind::Position, start.open.positions), (Kind::Velocity, start.open.velocities)] {
        let distances = if is_open { distances(system, &start.layout, nominal, kind) } else { Vec::new() };
        let is_far = |(distance, value): &(&Distance, f64)| (value / distance.scale).abs() > TUNING.several_open;
        let far: Vec<&Distance> = distances.iter().filter(|distance| is_far(distance)).map(|(far, _)| *far).collect();
        shared.extend(open_of(system, start, nominal, kind, far).map(|distance| known_as(&distance.name, kind)));
    }
    shared.dedup();
    shared
}

/// Name of a coordinate, or of its rate, for users: Euler parameters are no names of `initial`.
fn known_as(name: &str, kind: Kind) -> String {
    let of_rotation = name.rsplit_once('.').filter(|(_, coordinate)| ["p0", "p1", "p2", "p3"].contains(coordinate));
    match (kind, of_rotation) {
        (Kind::Position, Some((body, _))) => format!("{body}.orientation"),
        (Kind::Velocity, Some((body, _))) => format!("{body}.omega"),
        (Kind::Position, None) => name.to_owned(),
        (Kind::Velocity, None) => format!("the rate of {name}"),
    }
}

/// Distances that the known values at the start do not determine.
fn open_of<'s>(
    system: &'s System,
    start: &StartProgram,
    nominal: &[f64],
    kind: Kind,
    distances: Vec<&'s Distance>,
) -> impl Iterator<Item = &'s Distance> {
    let mut rows = Vec::new();
    if !distances.is_empty() {
        rows = jacobian_rows(system, start, nominal);
        let (given, constraints) = match kind {
            Kind::Position => (&system.start.position, system.constraint.len()),
            Kind::Velocity => (&system.start.velocity, system.lambda.len()),
        };
        rows.truncate(constraints);
        let conditions = system.start.conditions.iter().filter(|condition| match kind {
            Kind::Position => condition.position,
            Kind::Velocity => condition.velocity,
        });
        let graph = system.start.nearest.as_ref().and_then(|nearest| nearest.graph.as_ref()).unwrap_or(&system.graph);
        let mut graph = graph.clone();
        let mut add = |value: Expr, by: &[Expr]| {
            let (places, slopes): (Vec<usize>, Vec<Expr>) =
                graph.jacobian(&[value], by).entries().map(|(_, index, slope)| (index, slope)).unzip();
            let slopes = graph.evaluate(&slopes, values_at(system, &start.layout, nominal));
            let scaled = places.into_iter().zip(slopes);
            rows.push(scaled.map(|(index, slope)| (index, slope * system.coordinates[index].scale)).collect());
        };
        for condition in conditions {
            match condition.rate {
                Some(rate) if matches!(kind, Kind::Velocity) => add(rate, &system.v),
                _ => add(condition.value, &system.q),
            }
        }
        distances.iter().for_each(|distance| add(distance.value, &system.q));
        rows.iter_mut().for_each(|row| row.retain(|&(index, _)| given[index].is_none()));
    }
    let known = rows.len() - distances.len();
    let is_determined = move |index: usize| {
        let with_known: Vec<Vec<(usize, f64)>> = rows[..known].iter().chain([&rows[known + index]]).cloned().collect();
        dependent_rows(&with_known, TUNING.dependent_row).contains(&known)
    };
    distances.into_iter().enumerate().filter(move |&(index, _)| !is_determined(index)).map(|(_, distance)| distance)
}

/// Whether a velocity is given that may not be zero, or a constraint depends on t: else all velocities are zero.
fn is_driven(system: &System) -> bool {
    let given = system.start.velocity.iter().flatten().any(|&value| !system.graph.is_zero(value));
    let conditioned = system.start.conditions.iter().any(|condition| condition.rate.is_some());
    let constraints: Vec<Expr> = system.named_constraints().map(|(value, _)| value).collect();
    given || conditioned || system.graph.symbols_of(&constraints).binary_search(&system.time).is_ok()
}

/// Distances, or their rates.
#[derive(Clone, Copy)]
enum Kind {
    Position,
    Velocity,
}

/// The open distances of a kind, each with its value at a state.
fn distances<'s>(system: &'s System, layout: &Layout, state: &[f64], kind: Kind) -> Vec<(&'s Distance, f64)> {
    let Some(nearest) = &system.start.nearest else { return Vec::new() };
    let is_open = |distance: &&Distance| match kind {
        Kind::Position => distance.position,
        Kind::Velocity => distance.velocity,
    };
    let open: Vec<&Distance> = nearest.distances.iter().filter(is_open).collect();
    let exprs: Vec<Expr> = open.iter().map(|distance| distance.value).collect();
    let at = values_at(system, layout, state);
    let graph = nearest.graph.as_ref().unwrap_or(&system.graph);
    let numbers = match kind {
        Kind::Position => graph.evaluate(&exprs, at),
        Kind::Velocity => {
            let mut graph = graph.clone();
            let rates = time_derivative(system, &mut graph, &exprs);
            graph.evaluate(&rates, at)
        }
    };
    open.into_iter().zip(numbers).collect()
}

/// Values of symbols at a state; unknown ones are zero.
fn values_at(system: &System, layout: &Layout, state: &[f64]) -> impl Fn(Expr) -> f64 + use<> {
    let mut values: FxHashMap<Expr, f64> = FxHashMap::default();
    let mut set = |symbols: &[Expr], registers: std::ops::Range<usize>| {
        values.extend(symbols.iter().copied().zip(registers.map(|register| state[register])));
    };
    let parameters: Vec<Expr> = system.parameters.iter().map(|parameter| parameter.symbol).collect();
    set(&parameters, layout.parameters.clone());
    set(&system.q, layout.q.clone());
    set(&system.v, layout.v.clone());
    move |symbol| values.get(&symbol).copied().unwrap_or(0.0)
}
