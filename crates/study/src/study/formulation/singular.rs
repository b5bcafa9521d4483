//! Singular configurations on the way of the nominal motion.

use super::tuning::TUNING;
use crate::assemble::Questions;
use crate::model::Stepping;
use crate::numerics::Sample;
use crate::simulate::{Controller, Simulator, SingularWatch, Stepper};

/// Whether the nominal motion passes a singular configuration, or does not get to its end: there joint coordinates
/// amplify rounding more the shorter the steps are. Steps are as long as their errors allow, and never shorter than the
/// model's; those over switches and narrow forces are not, whose errors say little.
pub fn passes_singular(questions: &Questions, simulator: &Simulator) -> bool {
    let simulation = &questions.description.simulation;
    if simulator.system.analysis.is_without_steps() {
        return false;
    }
    let shortest = match simulation.stepping {
        Stepping::Fixed(step) => step,
        Stepping::Tolerance(_) => TUNING.longest_look.min(simulation.output_step),
    };
    let shortest = shortest.max(simulation.duration / TUNING.looks);
    let is_smooth = SingularWatch::allows_long_steps(simulator);
    let longest = if is_smooth { simulation.duration / TUNING.least_looks } else { shortest };
    let nominal: Sample = simulator.system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let Ok(start) = simulator.assemble(1, shortest, |_| nominal.clone()) else { return true };
    let mut stepper = Stepper::new(&simulator.program, &start);
    if is_smooth {
        stepper.estimate_errors();
    }
    let controller = Controller { tolerance: TUNING.tolerance_of_look, duration: simulation.duration };
    let mut watch = SingularWatch::new(simulator, &stepper);
    let (mut time, mut step) = (0.0, shortest);
    while time < simulation.duration * (1.0 - f64::EPSILON) {
        let h = step.min(simulation.duration - time);
        let ratio =
            |stepper: &Stepper| stepper.local_errors().first().map(|error| controller.error_ratio(error.size, h));
        if h > shortest {
            stepper.set_step_size(h);
            let before = stepper.save();
            let has_converged = stepper.try_step(h, time + h)[0];
            if !has_converged || ratio(&stepper).is_none_or(|ratio| ratio > 1.0) {
                stepper.rewind(&before, h);
                step = (0.5 * h).max(shortest);
                continue;
            }
        } else if !stepper.step(h, time + h).is_empty() {
            return true;
        }
        time += h;
        watch.look(&stepper, time);
        if watch.has_passed() {
            return true;
        }
        let is_near = stepper.pivot_loss(0) > TUNING.pivot_of_long_look;
        let wanted = ratio(&stepper).filter(|_| !is_near).map(|ratio| h * controller.factor(ratio));
        step = wanted.unwrap_or(shortest).min(longest).max(shortest);
    }
    false
}

#[cfg(test)]
mod tests {
    use super::super::candidates::Compiled;
    use super::*;
    use crate::assemble;
    use crate::model::{self, Description};

    /// In absolute coordinates, and in joint ones from the same start.
    fn passes(description: &Description) -> [bool; 2] {
        let questions = Questions::of(description);
        let absolute = assemble::in_absolute_coordinates(&questions).unwrap();
        let absolute = <Simulator as Compiled>::of(absolute, description).unwrap();
        let start = &absolute.nominal[absolute.start.layout.q.clone()];
        let joint = assemble::in_joint_coordinates(&questions, None, Some(start)).unwrap().unwrap();
        let joint = <Simulator as Compiled>::of(joint, description).unwrap();
        [absolute, joint].map(|simulator| passes_singular(&questions, &simulator))
    }

    /// A parallelogram that swings through its flat position, by its weight, or turns through it; before that, and with
    /// a rod that is a little longer, it is regular.
    #[test]
    fn both_formulations_find_the_same_singularities() {
        let linkage = |rod: f64, rate: f64, duration: f64| {
            let text = format!(
                "bodies:
  ground: {{ points: {{ b: [2, 0] }} }}
  one: {{ mass: 1, inertia: 0.1, points: {{ A: [0, 0], B: [1, 0] }} }}
  two: {{ mass: 1, inertia: 0.1, points: {{ A: [0, 0], B: [1, 0] }} }}
  rod: {{ mass: 1, inertia: 0.3, points: {{ A: [0, 0], B: [{rod}, 0] }} }}
joints:
  p: {{ revolute: [ground, one.A] }}
  q: {{ revolute: [ground.b, two.A] }}
  r: {{ revolute: [one.B, rod.A] }}
  s: {{ revolute: [two.B, rod.B] }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ one.angle: 1.2, one.angular_velocity: {rate} }}
outputs: {{ a: one.angle }}
simulation: {{ duration: {duration}, step: 1e-3, output_step: 0.02 }}
"
            );
            model::load_str("linkage.yaml", &text, &[]).unwrap_or_else(|errors| panic!("{errors}"))
        };
        for (rod, rate, duration, expected) in
            [(2.0, -3.0, 0.2, false), (2.0, -3.0, 1.0, true), (2.0, 0.0, 1.5, true), (2.01, -3.0, 1.0, false)]
        {
            assert_eq!(passes(&linkage(rod, rate, duration)), [expected; 2], "{rod} {rate} {duration}");
        }
        for name in ["slider_crank", "four_bar", "quick_return", "spatial_four_bar"] {
            let path = format!("{}/../../models/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
            let description = model::load(std::path::Path::new(&path), &[]).unwrap_or_else(|errors| panic!("{errors}"));
            assert_eq!(passes(&description), [false; 2], "{name}");
        }
    }
}
