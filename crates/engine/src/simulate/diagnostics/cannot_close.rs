//! Whether a mechanism locks: then a constraint cannot be closed wherever positions are sought.

use crate::assemble::ConstraintId;
use crate::compile::{ClosureRow, compile_start};
use crate::simulate::error::{NamedValues, SimulationError};
use crate::simulate::residual_text::residual_text;
use crate::simulate::simulator::Simulator;
use crate::simulate::start::Assembly;

/// A constraint that cannot be closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenConstraint {
    /// The constraint.
    pub constraint: ConstraintId,
    /// The size of the smallest residual found, in the constraint's unit.
    pub residual: f64,
}

impl Simulator {
    /// The constraint that cannot be closed at a time wherever positions are sought from `state` (the layout's
    /// registers), and its residual. `None` where all constraints can be closed.
    pub(in crate::simulate) fn open_constraint(&self, state: &[f64], time: f64) -> Option<OpenConstraint> {
        // The constraints remain, without the other conditions of the start.
        let mut free = self.system.clone();
        free.start.position.fill(None);
        free.start.conditions.clear();
        let start = compile_start(&free, &self.mobility.redundant, state).ok()?;
        let layout = &start.layout;
        let parameters = layout.parameters.clone();
        let mut assembly = Assembly::new(&start, &free, 1, |parameter, _| state[parameters.start + parameter]);
        for register in layout.q.clone() {
            assembly.tile_mut().lane_mut(register)[0] = state[register];
        }
        assembly.tile_mut().lane_mut(layout.time)[0] = time;
        let worst = assembly.descend().err()?;
        // The start's conditions, which a beam has, do not hold later.
        match worst.row {
            ClosureRow::Constraint(constraint) => Some(OpenConstraint { constraint, residual: worst.residual.abs() }),
            ClosureRow::Condition(_) => None,
        }
    }

    /// The error of a mechanism that locks at a time.
    pub fn locked(&self, open: OpenConstraint, time: f64, parameters: NamedValues) -> SimulationError {
        let constraint = &self.system[open.constraint];
        let residual = residual_text(open.residual, constraint, false);
        SimulationError::Locked { time, constraint: constraint.name.clone(), residual, parameters }
    }
}
