//! States in general position: near a given state, but on none of its symmetries or singularities.

use symdiff::Tile;

use super::tuning::TUNING;
use crate::assemble::System;
use crate::compile::tuning::TUNING as COMPILE;
use crate::compile::{Layout, PivotSample, Tapes, compile_start};

/// Evenly spread numbers in [−1, 1) by an additive recurrence, the same on every machine.
pub fn spread(series: usize, index: usize) -> f64 {
    2.0 * ((index + 1) as f64 * 0.618_033_988_749_895 + series as f64 * 0.414_213_562_373_095).fract() - 1.0
}

/// A state in general position near the model's guess: values of the layout's registers.
pub fn guess_state(system: &System, layout: &Layout, parameters: &[f64]) -> Vec<f64> {
    let mut values = vec![0.0; layout.registers()];
    values[layout.parameters.clone()].copy_from_slice(parameters);
    let value_of = |symbol| system.parameters.iter().position(|parameter| parameter.symbol == symbol);
    let guess =
        system.graph.evaluate(&system.start.guess, |symbol| value_of(symbol).map_or(f64::NAN, |k| parameters[k]));
    for (index, register) in layout.q.clone().enumerate() {
        values[register] = guess[index] + 0.1 * system.coordinates[index].scale * spread(0, index);
    }
    for (index, register) in (layout.v.start..layout.correction.end).enumerate() {
        values[register] = spread(1, index);
    }
    values
}

/// States that guide the choice of pivots: the nominal start, and states in general position around it, for steps of
/// `h`.
pub fn pivot_samples(
    system: &System,
    layout: &Layout,
    nominal: &[f64],
    h: f64,
) -> [PivotSample; COMPILE.pivot_samples] {
    std::array::from_fn(|series| {
        let mut values = nominal.to_vec();
        values[layout.step] = h;
        for (index, (w, x)) in layout.w.clone().zip(layout.iterate.clone()).enumerate() {
            values[x] = values[w];
            if series > 0 {
                let scale = system.coordinates[index].scale;
                values[layout.q.start + index] += TUNING.pivot_sample_spread * scale * spread(series, index);
                values[layout.v.start + index] +=
                    TUNING.pivot_sample_spread * scale * spread(series + COMPILE.pivot_samples, index);
            }
        }
        PivotSample { values }
    })
}

/// An assembled state in general position near another one; the start's own conditions are dropped. `None` where the
/// corrections do not reach one.
pub fn move_apart(system: &System, state: &[f64]) -> Option<Vec<f64>> {
    let mut free = system.clone();
    free.start.position.fill(None);
    free.start.conditions.clear();
    let start = compile_start(&free, &[], state).ok()?;
    let mut tile = Tile::new(1, start.registers(), start.constants());
    tile.values_mut()[..state.len()].copy_from_slice(state);
    tile.run(start.sample());
    for (index, register) in start.layout.q.clone().enumerate() {
        tile.lane_mut(register)[0] += TUNING.apart_from_start * system.coordinates[index].scale * spread(7, index);
    }
    for _ in 0..TUNING.corrections_of_position {
        tile.run(start.position());
        for (register, correction) in start.layout.q.clone().zip(start.layout.correction.clone()) {
            tile.lane_mut(register)[0] += tile.lane(correction)[0];
        }
    }
    tile.run(start.position());
    let assembled = start.constraint.iter().all(|residual| tile.lane(residual.register)[0].abs() < 1e-9);
    assembled.then(|| tile.values()[..state.len()].to_vec())
}
