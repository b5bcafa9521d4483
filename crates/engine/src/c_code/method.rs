//! How a model is integrated, and the parts of the runtime that this takes.

use super::NoCode;
use super::tuning::TUNING;
use crate::compile::{Program, StartProgram, SwitchProgram};
use crate::simulate::{Controller, Equilibrium, Integration, Needs, Simulator, Steps};

/// The way in which a model is integrated.
pub(super) struct Method<'c> {
    /// Whether steps are those of the explicit method; else they are those of HHT-I3 on some levels.
    pub is_explicit: bool,
    pub levels: usize,
    /// Controller of the steps, if a tolerance decides them.
    pub controller: Option<Controller>,
    /// Switches of the equations, if a tolerance decides the steps.
    pub switches: Option<&'c SwitchProgram>,
    /// Closes rows that are no step's own.
    pub closure: Option<&'c StartProgram>,
    pub needs: Needs,
    /// Whether steps in singular configurations have a solve of their own.
    pub is_singular: bool,
    /// Equilibrium at the start, if other parameters move it.
    pub equilibrium: Option<&'c Equilibrium>,
    /// Whether states change at instants.
    pub is_sampled: bool,
    /// Whether rows of the steps solve for accelerations and multipliers, and make velocities consistent.
    pub solves: bool,
    pub projects: bool,
    /// Whether it has the programs of the start.
    pub has_solver: bool,
    /// Whether its start may have other values of parameters.
    has_parameters: bool,
}

/// Whether a pivot can vanish, in equations that are few and have no values of links among them.
fn may_be_singular(program: &Program) -> bool {
    let size = program.residual.len();
    program.size == size && size <= TUNING.most_singular && program.watched.iter().any(|own| !own.pivots.is_empty())
}

impl<'c> Method<'c> {
    /// Method of the steps of a run, with `parameters` parameters.
    ///
    /// # Errors
    /// Where equations of rows have no factors.
    pub fn of(simulator: &'c Simulator, steps: Steps, parameters: usize) -> Result<Self, NoCode> {
        let is_explicit = steps.schedule.integration == Integration::Explicit;
        let levels = match steps.schedule.integration {
            Integration::Extrapolated { levels } => levels,
            _ => 1,
        };
        let has_closure = is_explicit || levels > 1;
        let controller = steps.controller.filter(|_| !is_explicit);
        let solves = !has_closure && simulator.solves_row_accelerations();
        let projects = !has_closure && controller.is_some() && simulator.projects_row_velocities();
        let is_sampled = !simulator.start.sampled.is_empty();
        let has_parameters = parameters > 0;
        let of_levels = !is_explicit && (is_sampled || levels > 1);
        Ok(Self {
            is_explicit,
            levels,
            controller,
            switches: controller.and_then(|_| simulator.switches()),
            closure: if has_closure { Some(simulator.free_closure()?) } else { None },
            needs: Needs::of(simulator),
            is_singular: !is_explicit && may_be_singular(&simulator.program),
            equilibrium: simulator.equilibrium.as_deref().filter(|_| has_parameters),
            is_sampled,
            solves,
            projects,
            has_solver: solves || projects || has_parameters || of_levels,
            has_parameters,
        })
    }

    /// Whether accelerations of a state are solved for by the programs of the start.
    pub fn accelerates(&self) -> bool {
        self.solves || self.has_parameters || (!self.is_explicit && (self.is_sampled || self.levels > 1))
    }

    /// Whether the explicit method's accelerations follow from one correction.
    pub fn is_linear(&self) -> bool {
        self.is_explicit && self.needs.linear
    }

    /// Whether values are corrected until they settle.
    pub fn settles(&self) -> bool {
        let of_closure = self.needs.closure || self.needs.accelerations || self.is_sampled || !self.needs.linear;
        self.accelerates() || self.projects || (self.closure.is_some() && of_closure)
    }

    /// The parts of the runtime that are called, in the order in which they refer to one another; with names of the
    /// model's parts as macros.
    pub fn runtime(&self) -> String {
        let explicit = self.is_explicit;
        let controlled = self.controller.is_some();
        let parts = [
            (true, include_str!("runtime/memory.c")),
            (self.settles() || self.is_sampled, include_str!("runtime/solve.c")),
            (!explicit, include_str!("runtime/newton.c")),
            (self.is_singular, include_str!("runtime/singular.c")),
            (!explicit, include_str!("runtime/step.c")),
            (!explicit && !controlled, include_str!("runtime/substeps.c")),
            (!explicit && controlled, include_str!("runtime/controlled.c")),
            (self.closure.is_some(), include_str!("runtime/closure.c")),
            (explicit, include_str!("runtime/explicit.c")),
            (self.equilibrium.is_some(), include_str!("runtime/balance.c")),
            (true, include_str!("runtime/start.c")),
            (!explicit, include_str!("runtime/rows.c")),
        ];
        parts.into_iter().filter_map(|(is_called, text)| is_called.then_some(text)).collect()
    }
}
