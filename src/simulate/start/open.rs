//! What of the start the given values and the constraints leave open.

use rustc_hash::FxHashMap;
use symdiff::Expr;

use super::mobility::{DEPENDENT, jacobian_rows};
use super::rank::dependent_rows;
use crate::assemble::{Distance, System};
use crate::compile::{Layout, OpenStart, StartProgram, time_derivative};

/// Distances from rest below this, in their scales, are round-off.
const AT_REST: f64 = 1e-12;

/// Distances from rest above this, in their scales, show that several of them share what is left open.
const APART: f64 = 1e-6;

/// For which samples a start is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Samples {
    /// The nominal one only.
    Nominal,
    /// All.
    All,
}

/// What is open and is not at rest in every one of the samples, of a start that was assembled without looking for rest.
pub fn open_start(system: &System, start: &StartProgram, nominal: &[f64], samples: Samples) -> OpenStart {
    if system.start.nearest.is_none() {
        return OpenStart::default();
    }
    let is_apart = |kind: Kind| {
        distances(system, &start.layout, nominal, kind)
            .iter()
            .any(|(distance, value)| !(value / distance.scale).abs().le(&AT_REST))
    };
    // With constraints, other parameters move what is at rest in the nominal start.
    let follows = samples == Samples::All && !system.parameters.is_empty() && !system.lambda.is_empty();
    let mut rows = None;
    let mut is_free = |given: &[Option<Expr>], conditions: usize| {
        let rows = rows.get_or_insert_with(|| jacobian_rows(system, start, nominal));
        let open = |row: &Vec<(usize, f64)>| row.iter().copied().filter(|(place, _)| given[*place].is_none()).collect();
        let rows: Vec<Vec<(usize, f64)>> = rows.iter().map(open).collect();
        let rank = rows.len() - dependent_rows(&rows, DEPENDENT).len();
        given.iter().filter(|given| given.is_none()).count() > rank + conditions
    };
    let conditions = &system.start.conditions;
    let of_position = conditions.iter().filter(|condition| condition.position).count();
    let of_velocity = conditions.iter().filter(|condition| condition.velocity).count();
    OpenStart {
        positions: (follows || is_apart(Kind::Position)) && is_free(&system.start.position, of_position),
        velocities: is_driven(system)
            && (follows || is_apart(Kind::Velocity))
            && is_free(&system.start.velocity, of_velocity),
    }
}

/// Names of coordinates that share what is left open, so that the start is a choice among many.
pub fn shared_coordinates(system: &System, start: &StartProgram, nominal: &[f64]) -> Vec<String> {
    let mut shared = Vec::new();
    for (kind, is_open) in [(Kind::Position, start.open.positions), (Kind::Velocity, start.open.velocities)] {
        let distances = if is_open { distances(system, &start.layout, nominal, kind) } else { Vec::new() };
        let far = distances.into_iter().filter(|(distance, value)| (value / distance.scale).abs() > APART);
        shared.extend(far.map(|(distance, _)| match kind {
            Kind::Position => distance.name.clone(),
            Kind::Velocity => format!("the rate of {}", distance.name),
        }));
    }
    shared
}

/// Whether a velocity is given that may not be zero, or a constraint depends on t: else all velocities are zero.
fn is_driven(system: &System) -> bool {
    let given = system.start.velocity.iter().flatten().any(|&value| !system.graph.is_zero(value));
    let conditioned = system.start.conditions.iter().any(|condition| condition.rate.is_some());
    given || conditioned || system.graph.symbols_of(&system.constraint).binary_search(&system.time).is_ok()
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
    let mut values: FxHashMap<Expr, f64> = FxHashMap::default();
    let mut set = |symbols: &[Expr], registers: std::ops::Range<usize>| {
        values.extend(symbols.iter().copied().zip(registers.map(|register| state[register])));
    };
    let parameters: Vec<Expr> = system.parameters.iter().map(|parameter| parameter.symbol).collect();
    set(&parameters, layout.parameters.clone());
    set(&system.q, layout.q.clone());
    set(&system.v, layout.v.clone());
    let exprs: Vec<Expr> = open.iter().map(|distance| distance.value).collect();
    let at = |symbol| values.get(&symbol).copied().unwrap_or(0.0);
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
