//! Constraints that others imply at the start and contradict later: two motors that begin alike and then part. The motion follows
//! the others, and the redundant constraint stays open.

use rustc_hash::FxHashMap;
use symdiff::Expr;

use crate::assemble::{ConstraintId, ResidualUnit, System};
use crate::compile::Layout;
use crate::simulate::error::SimulationError;
use crate::simulate::residual_text::residual_text;
use crate::simulate::simulator::Simulator;
use crate::simulate::step::Stepper;

/// A residual beyond this is open, for an angle of 1 rad or the length of the model. Schemes that fulfil velocities drift by less.
const OPEN: f64 = 1e-4;

/// Times in s at which constraints are compared, to find whether they depend on the time.
const TIMES: [f64; 3] = [0.0, 0.317, 1.93];

/// A constraint that has opened.
#[derive(Clone, Debug)]
pub struct Parted {
    constraint: ConstraintId,
    time: f64,
    residual: f64,
}

/// Search for constraints that open, over the steps of the first lane of a tile.
#[derive(Clone, Debug)]
pub struct PartingWatch<'s> {
    simulator: &'s Simulator,
    redundant: Vec<(ConstraintId, Expr)>,
    /// Register of each symbol.
    registers: FxHashMap<Expr, usize>,
    state: Vec<f64>,
    found: Option<Parted>,
}

impl<'s> PartingWatch<'s> {
    /// Nothing where no constraint is redundant, or none depends on the time: those that agree then stay in agreement.
    pub fn new(simulator: &'s Simulator, stepper: &Stepper) -> Option<Self> {
        let system = &simulator.system;
        let constraint = |id: &ConstraintId| Some((*id, *system.constraint.get(id.number())?));
        let redundant: Vec<_> = simulator.mobility.redundant.iter().filter_map(constraint).collect();
        if redundant.is_empty() {
            return None;
        }
        let (registers, state) = (registers(system, &simulator.program.layout), stepper.lane(0));
        let at = |time: f64| {
            let value = |symbol| if symbol == system.time { time } else { number(&registers, &state, symbol) };
            system.graph.evaluate(&system.constraint, value)
        };
        let [first, others @ ..] = TIMES.map(at);
        let changes = others.iter().any(|values| values != &first);
        changes.then_some(Self { simulator, redundant, registers, state, found: None })
    }

    /// Examines the step that has just ended.
    pub fn look(&mut self, stepper: &Stepper, time: f64) {
        if self.found.is_some() {
            return;
        }
        stepper.copy_lane(0, &mut self.state);
        let system = &self.simulator.system;
        let exprs: Vec<Expr> = self.redundant.iter().map(|(_, expr)| *expr).collect();
        let value = |symbol| if symbol == system.time { time } else { number(&self.registers, &self.state, symbol) };
        let residuals = system.graph.evaluate(&exprs, value);
        self.found = self.redundant.iter().zip(residuals).find_map(|(&(constraint, _), residual)| {
            let size = if system[constraint].unit == ResidualUnit::Length { system.length } else { 1.0 };
            (residual.abs() > OPEN * size).then_some(Parted { constraint, time, residual })
        });
    }

    /// The error of a constraint that has opened.
    pub fn error(&self) -> Option<SimulationError> {
        let Parted { constraint, time, residual } = self.found.as_ref()?;
        let constraint = &self.simulator.system[*constraint];
        let remain = residual_text(*residual, constraint, false);
        Some(SimulationError::Parted { joint: constraint.joint.clone(), time: *time, remain })
    }
}

/// Registers of the positions, velocities and parameters.
fn registers(system: &System, layout: &Layout) -> FxHashMap<Expr, usize> {
    let parameters = system.parameters.iter().map(|parameter| parameter.symbol).zip(layout.parameters.clone());
    let positions = system.q.iter().copied().zip(layout.q.clone());
    parameters.chain(positions).chain(system.v.iter().copied().zip(layout.v.clone())).collect()
}

fn number(registers: &FxHashMap<Expr, usize>, state: &[f64], symbol: Expr) -> f64 {
    registers.get(&symbol).map_or(0.0, |&register| state[register])
}
