//! Observed orders: the errors of a manufactured motion with steps of half the length, again and again.

use super::motion::Manufactured;
use super::tuning::TUNING;
use crate::assemble::System;
use crate::numerics::{ChebyshevSeries, Sample, larger};
use crate::results::{Convergence, Quantity};
use crate::simulate::{Integration, Observed, Schedule, SimulationError, Simulator, Steps, integrator};

/// The values of a group of outputs, and how large their errors may count.
struct Group<'m> {
    quantity: Quantity,
    /// Index of its first output.
    first: usize,
    exact: Vec<&'m ChebyshevSeries>,
    /// Index of each among the system's.
    of: Vec<usize>,
    scales: Vec<f64>,
    rounding: f64,
}

/// Largest error in all rows, as a share of the group's size.
fn error(group: &Group, rows: &[Vec<f64>], schedule: &Schedule, begin: f64) -> f64 {
    let mut most = 0.0_f64;
    for (row, values) in rows.iter().enumerate().skip(1) {
        let time = begin + schedule.time(row);
        for ((exact, &of), scale) in group.exact.iter().zip(&group.of).zip(&group.scales) {
            most = larger(most, (values[group.first + of] - exact.at(time)).abs() / scale);
        }
    }
    most
}

/// Largest value of the series over the rows.
fn size<'m>(series: impl IntoIterator<Item = &'m ChebyshevSeries>) -> f64 {
    series.into_iter().map(ChebyshevSeries::size).fold(0.0, f64::max)
}

/// Positions, velocities, accelerations, states and reactions, as far as there are some.
fn groups<'m>(system: &System, motion: &'m Manufactured) -> Vec<Group<'m>> {
    let n = system.q.len();
    let of_motion: Vec<usize> = (0..n).filter(|&index| !system.coordinates[index].is_state).collect();
    let states: Vec<usize> = (0..n).filter(|&index| system.coordinates[index].is_state).collect();
    let multipliers: Vec<usize> = (0..motion.multipliers.len()).collect();
    let group =
        |quantity: Quantity, first: usize, series: &'m [ChebyshevSeries], of: Vec<usize>, per: f64, rounding| {
            let exact: Vec<&ChebyshevSeries> = of.iter().map(|&index| &series[index]).collect();
            let scales = of.iter().map(|&index| match quantity {
                Quantity::States => size(exact.iter().copied()).max(f64::MIN_POSITIVE),
                // Reactions may vanish where loads do not.
                Quantity::Reactions => size(exact.iter().copied().chain(&motion.loads)).max(f64::MIN_POSITIVE),
                _ => system.coordinates[index].scale * per,
            });
            let scales = scales.collect();
            Group { quantity, first, exact, of, scales, rounding }
        };
    let rate = 1.0 / motion.length();
    let [position, velocity, acceleration, reaction] = TUNING.rounding_of_errors;
    let all = [
        group(Quantity::Positions, 0, &motion.positions, of_motion.clone(), 1.0, position),
        group(Quantity::Velocities, n, &motion.velocities, of_motion.clone(), rate, velocity),
        group(Quantity::Accelerations, 2 * n, &motion.accelerations, of_motion, rate * rate, acceleration),
        group(Quantity::States, n, &motion.velocities, states, 1.0, velocity),
        group(Quantity::Reactions, 3 * n, &motion.multipliers, multipliers, 1.0, reaction),
    ];
    all.into_iter().filter(|group| !group.of.is_empty()).collect()
}

/// Errors and orders of all quantities by a way to integrate, with steps that are halved until orders settle, errors
/// are those of rounding, or a row has the most steps.
///
/// # Errors
/// If the system cannot be started, or a step does not converge however short it is.
pub fn convergence(
    simulator: &Simulator,
    motion: &Manufactured,
    integration: Integration,
    most: usize,
    interrupted: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<Convergence>, SimulationError> {
    let groups = groups(&simulator.system, motion);
    let nominal: Sample = simulator.system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let theory = integration.order() as f64;
    let mut found: Vec<Convergence> =
        groups.iter().map(|group| Convergence::new(group.quantity, theory, group.rounding)).collect();
    let mut per_row = 1;
    while per_row <= most {
        if interrupted() {
            return Err(SimulationError::Interrupted);
        }
        let step = motion.length() / (TUNING.rows_of_errors * per_row) as f64;
        let schedule =
            Schedule::fixed(motion.length(), step, motion.length() / TUNING.rows_of_errors as f64).taken(integration);
        let rows = simulated(simulator, &nominal, &schedule)?;
        per_row *= 2;
        let Some(rows) = rows else {
            found.iter_mut().for_each(Convergence::restart);
            continue;
        };
        for (own, group) in found.iter_mut().zip(&groups) {
            own.add(step, error(group, &rows, &schedule, motion.begin));
        }
        if found.iter().all(Convergence::is_settled) {
            break;
        }
    }
    Ok(found)
}

/// All outputs row by row; `None` if a step does not converge.
fn simulated(
    simulator: &Simulator,
    nominal: &Sample,
    schedule: &Schedule,
) -> Result<Option<Vec<Vec<f64>>>, SimulationError> {
    let samples = std::slice::from_ref(nominal);
    let mut run = integrator(simulator, samples, schedule)?;
    let mut values = Vec::new();
    let stops = run.advance(Steps { schedule, controller: None }, 0..schedule.rows, Observed::Outputs, &mut values);
    let count = simulator.system.outputs.len();
    Ok(stops.is_empty().then(|| values.chunks_exact(count).map(<[f64]>::to_vec).collect()))
}
