//! States: velocities of coordinates of their own, with mass 1 and their rate for a force.

use symdiff::{Expr, Scalar};

use super::at_guess::AtGuess;
use super::mechanism::{Mechanism, Owner};
use super::system::{CoordinateInfo, SampledState, Start};
use crate::grammar::Sensor;
use crate::model::{Description, Effect, TimeOrder};
use crate::multibody::{BuildError, Context};

impl<'g> Mechanism<'g, '_> {
    /// Coordinates of all states, with their names in formulas.
    pub fn add_states(&mut self, effects: &[Effect]) {
        for (effect, Effect { name, kind }) in effects.iter().enumerate() {
            for (place, state) in kind.states().into_iter().enumerate() {
                let name = match state.sensor.name() {
                    value if value == Sensor::VALUE.name() => name.clone(),
                    other => format!("{name}.{other}"),
                };
                let index = self.add_coordinate(Owner::State, &name);
                self.states.insert((effect, place), index);
                self.sensors.insert((effect, state.sensor), self.v[index]);
            }
        }
    }

    /// Values of the states at the start, and zero for the coordinates themselves.
    pub fn states_at_start(
        &self,
        description: &Description,
        wanted: TimeOrder,
        found: &mut [Option<Scalar<'g>>],
    ) -> Result<(), BuildError> {
        for (&(effect, place), &index) in &self.states {
            found[index] = Some(match wanted {
                TimeOrder::Velocity => {
                    let states = description.effects[effect].kind.states();
                    self.formula(states[place].initial, Context::Parameters)?
                }
                _ => self.g.number(0.0),
            });
        }
        Ok(())
    }

    /// States that change at instants, each with its new value.
    pub fn sampled_states(
        &self,
        description: &Description,
        sampled: Vec<((usize, usize), Scalar<'g>)>,
    ) -> Vec<SampledState> {
        let state = |((effect, index), value): ((usize, usize), Scalar)| {
            let period = description.effects[effect].kind.states()[index].period?;
            Some(SampledState { coordinate: self.states[&(effect, index)], value: value.expr(), period })
        };
        sampled.into_iter().filter_map(state).collect()
    }

    /// Typical sizes of the states, over a second: by their values and rates at the nominal start, at least 1.
    pub fn scale_states(&self, rates: &[Scalar<'g>], start: &Start, duration: f64, coordinates: &mut [CoordinateInfo]) {
        if self.states.is_empty() {
            return;
        }
        let zero = self.g.number(0.0).expr();
        let graph = self.g.graph();
        let mut at_start = AtGuess::of(self, &graph, &start.guess);
        let velocities: Vec<Expr> = start.velocity.iter().map(|v| v.unwrap_or(zero)).collect();
        let speeds = at_start.values(&graph, &velocities);
        at_start.set(&self.v, speeds.clone());
        let indices: Vec<usize> = self.states.values().copied().collect();
        let changes: Vec<Expr> = indices.iter().map(|&index| rates[index].expr()).collect();
        let changes = at_start.values(&graph, &changes);
        for (index, change) in indices.into_iter().zip(changes) {
            let sizes = [speeds[index].abs(), (change * duration).abs()];
            coordinates[index].scale = sizes.into_iter().filter(|size| size.is_finite()).fold(1.0, f64::max);
        }
    }
}
