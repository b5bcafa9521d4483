//! Constraints that others imply at the start and contradict later: two motors that begin alike and then part. The
//! motion follows the others, and the redundant constraint stays open.

use symdiff::Expr;

use super::tuning::TUNING;
use crate::assemble::{ConstraintId, ResidualUnit};
use crate::compile::Layout;
use crate::simulate::error::SimulationError;
use crate::simulate::motion_values::motion_values;
use crate::simulate::residual_text::residual_text;
use crate::simulate::simulator::Simulator;

/// A constraint that has opened.
#[derive(Clone, Debug)]
pub struct Parted {
    constraint: ConstraintId,
    time: f64,
    residual: f64,
}

/// Search for constraints that open, along the motion of one sample.
#[derive(Clone, Debug)]
pub struct PartingWatch<'s> {
    simulator: &'s Simulator,
    layout: &'s Layout,
    /// The redundant constraints, and their residuals.
    constraints: Vec<ConstraintId>,
    residuals: Vec<Expr>,
    /// The layout's registers.
    state: Vec<f64>,
    found: Option<Parted>,
}

impl<'s> PartingWatch<'s> {
    /// `None` if no constraint is redundant, or none depends on the time: those that agree then stay in agreement.
    /// `state` is that of the sample (the layout's registers).
    pub fn new(simulator: &'s Simulator, layout: &'s Layout, state: Vec<f64>) -> Option<Self> {
        let all = &simulator.system.constraint;
        let of_positions = |id: &ConstraintId| Some((*id, *all.get(id.number())?));
        let (constraints, residuals): (Vec<_>, Vec<_>) =
            simulator.mobility.redundant.iter().filter_map(of_positions).unzip();
        if constraints.is_empty() {
            return None;
        }
        let [first, others @ ..] = TUNING.tried_times.map(|time| values(simulator, layout, all, &state, time));
        let changes = others.iter().any(|values| values != &first);
        changes.then_some(Self { simulator, layout, constraints, residuals, state, found: None })
    }

    /// Examines the motion at a time: positions and velocities.
    pub fn look<'v>(&mut self, time: f64, motion: impl Iterator<Item = &'v f64>) {
        if self.found.is_some() {
            return;
        }
        let registers = self.layout.q.start..self.layout.v.end;
        self.state[registers].iter_mut().zip(motion).for_each(|(own, value)| *own = *value);
        let system = &self.simulator.system;
        let residuals = values(self.simulator, self.layout, &self.residuals, &self.state, time);
        self.found = self.constraints.iter().zip(residuals).find_map(|(&constraint, residual)| {
            let size = if system[constraint].unit == ResidualUnit::Length { system.length } else { 1.0 };
            (residual.abs() > TUNING.open_residual * size).then_some(Parted { constraint, time, residual })
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

/// Values of expressions of positions, velocities and the time.
fn values(simulator: &Simulator, layout: &Layout, exprs: &[Expr], state: &[f64], time: f64) -> Vec<f64> {
    let values = motion_values(&simulator.system, layout, state, time);
    simulator.system.graph.evaluate(exprs, |symbol| values.get(&symbol).copied().unwrap_or(0.0))
}
