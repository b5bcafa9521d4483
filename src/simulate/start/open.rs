//! What of the start the given values and the constraints leave open.

use rustc_hash::FxHashMap;
use symdiff::Expr;

use super::mobility::{DEPENDENT, jacobian_rows};
use super::rank::dependent_rows;
use crate::assemble::{Distance, System};
use crate::compile::{Layout, OpenStart, StartProgram};

/// Distances from rest below this, in their scales, are round-off.
const AT_REST: f64 = 1e-12;

/// Distances from rest above this, in their scales, show that several of them share what is left open.
const APART: f64 = 1e-6;

/// What is open, and is not at rest in the start that has been found without looking for rest.
pub fn open_start(system: &System, start: &StartProgram, nominal: &[f64]) -> OpenStart {
    if system.start.nearest.is_none() {
        return OpenStart::default();
    }
    // Constraints and parameters move what is at rest in the nominal start alone.
    let follows = !system.parameters.is_empty() && !system.lambda.is_empty();
    let [apart, moving] = rates_and_positions(system, &start.layout, nominal).map(|(distances, is_open)| {
        let far =
            |(distance, value): &(&Distance, f64)| !(value / distance.scale).abs().le(&AT_REST) && is_open(distance);
        distances.iter().any(far)
    });
    let mut rows = None;
    let mut is_free = |given: &[Option<Expr>], conditions: usize| {
        let rows = rows.get_or_insert_with(|| jacobian_rows(system, start, nominal));
        let of_open =
            |row: &Vec<(usize, f64)>| row.iter().copied().filter(|(place, _)| given[*place].is_none()).collect();
        let rows: Vec<Vec<(usize, f64)>> = rows.iter().map(of_open).collect();
        let rank = rows.len() - dependent_rows(&rows, DEPENDENT).len();
        given.iter().filter(|given| given.is_none()).count() > rank + conditions
    };
    let conditions = &system.start.conditions;
    let of_position = conditions.iter().filter(|condition| condition.position).count();
    let of_velocity = conditions.iter().filter(|condition| condition.velocity).count();
    OpenStart {
        positions: (apart || follows) && is_free(&system.start.position, of_position),
        velocities: (moving || follows && is_driven(system)) && is_free(&system.start.velocity, of_velocity),
    }
}

/// Names of coordinates that share what is left open, so that the start is a choice among many.
pub fn shared_coordinates(system: &System, start: &StartProgram, nominal: &[f64]) -> Vec<String> {
    let open = [start.open.positions, start.open.velocities];
    let kinds = rates_and_positions(system, &start.layout, nominal).into_iter().zip(open).zip(["", " (its rate)"]);
    let shared = kinds.filter(|((_, open), _)| *open).flat_map(|(((distances, is_open), _), what)| {
        let far = distances
            .into_iter()
            .filter(move |(distance, value)| (value / distance.scale).abs() > APART && is_open(distance));
        far.map(move |(distance, _)| format!("{}{what}", distance.name))
    });
    shared.collect()
}

/// Whether a velocity is given that may not be zero, or a constraint depends on t.
fn is_driven(system: &System) -> bool {
    let given = system.start.velocity.iter().flatten().any(|&value| !system.graph.is_zero(value));
    given || system.graph.symbols_of(&system.constraint).binary_search(&system.time).is_ok()
}

/// Distances with their values at a state, and whether each is open.
type Distances<'s> = (Vec<(&'s Distance, f64)>, fn(&Distance) -> bool);

/// Of positions, and of velocities by their rates.
fn rates_and_positions<'s>(system: &'s System, layout: &Layout, state: &[f64]) -> [Distances<'s>; 2] {
    let Some(nearest) = &system.start.nearest else { return [(Vec::new(), |_| false), (Vec::new(), |_| false)] };
    let mut graph = nearest.graph.clone();
    let positions: Vec<Expr> = nearest.distances.iter().map(|distance| distance.value).collect();
    let rates = crate::compile::time_derivative(system, &mut graph, &positions);
    let mut values: FxHashMap<Expr, f64> = FxHashMap::default();
    let symbols = system.parameters.iter().map(|parameter| parameter.symbol);
    values.extend(symbols.zip(layout.parameters.clone().map(|register| state[register])));
    for (symbols, registers) in [(&system.q, &layout.q), (&system.v, &layout.v)] {
        values.extend(symbols.iter().copied().zip(registers.clone().map(|register| state[register])));
    }
    let at = |exprs: &[Expr]| graph.evaluate(exprs, |symbol| values.get(&symbol).copied().unwrap_or(0.0));
    let with = |numbers: Vec<f64>| nearest.distances.iter().zip(numbers).collect();
    [(with(at(&positions)), |distance| distance.position), (with(at(&rates)), |distance| distance.velocity)]
}
