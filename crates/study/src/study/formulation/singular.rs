//! Singular configurations on the way of the nominal motion.

use super::tuning::TUNING;
use crate::assemble::Questions;
use crate::model::Stepping;
use crate::numerics::Sample;
use crate::simulate::{Schedule, Simulator, SingularWatch, Stepper};

/// Whether the nominal motion passes a singular configuration, or does not get to its end: there joint coordinates
/// amplify rounding more the shorter the steps are.
pub fn passes_singular(questions: &Questions, simulator: &Simulator) -> bool {
    let simulation = &questions.description.simulation;
    if simulator.system.analysis.is_without_steps() {
        return false;
    }
    let step = match simulation.stepping {
        Stepping::Fixed(step) => step,
        Stepping::Tolerance(_) => TUNING.longest_look.min(simulation.output_step),
    };
    let step = step.max(simulation.duration / TUNING.looks);
    let steps = (simulation.output_step / step).round().max(1.0);
    let schedule = Schedule::fixed(simulation.duration, simulation.output_step / steps, simulation.output_step);
    let nominal: Sample = simulator.system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let Ok(start) = simulator.assemble(1, schedule.first_step(), |_| nominal.clone()) else { return true };
    let mut stepper = Stepper::new(&simulator.program, &start);
    let mut watch = SingularWatch::new(simulator, &stepper);
    for (h, end) in (0..schedule.rows).flat_map(|row| schedule.steps_to(row)) {
        if !stepper.step(h, end).is_empty() {
            return true;
        }
        watch.look(&stepper, end);
        if watch.has_passed() {
            return true;
        }
    }
    false
}
