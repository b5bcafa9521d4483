//! Cost of each effect: a model is compiled without it, and the difference is counted.

use crate::study::formulation::{as_chosen, compiled};
use crate::study::{RunError, prepare_whole};
use rayon::prelude::*;

use super::tuning::TUNING;
use crate::assemble::Questions;
use crate::compile::Program;
use crate::model::{Description, EffectKind, Output, load_str};
use crate::results::{EffectCost, StepInstructions};
use crate::simulate::Simulator;

/// The mechanism in which effects are compared. Every number is deterministic, so the counts depend on the motion.
const MECHANISM: &str = "
bodies:
  arm: { mass: 2, inertia: 0.04, points: { pin: [-0.2, 0], tip: [0.2, 0], socket: [0.3, 2] } }
  cart: { mass: 3, inertia: 0.1, points: { hook: [0.1, 0.1] } }
  ball: { mass: 0.5, inertia: 0.002 }
  pinion: { inertia: 0.01, coordinates: [angle] }
  wheel: { inertia: 0.02, coordinates: [angle] }
  spur: { inertia: 0.01, coordinates: [angle] }
  rim: { inertia: 0.02, coordinates: [angle] }
joints:
  hinge: { revolute: [ground, arm.pin] }
  rail: { prismatic: { between: [ground, cart], axis: x } }
  mesh: { gear: { between: [spur, rim], ratio: -0.5 } }
initial: { arm.angle: 0, cart.x: 1, ball.x: 0.5, ball.y: 2, ball.angle: 0, pinion.angle: 0, wheel.angle: 0, spur.angle: 0 }
outputs: { x: cart.x }
simulation: { duration: 0.1, step: 1e-3, formulation: absolute }
";

/// Cost that every effect of the language adds to a small mechanism of the plane, in the order of `mbint explain
/// --effects`.
///
/// # Errors
/// Never, but for a defect of the examples.
pub fn language_costs() -> Result<Vec<(&'static str, EffectCost)>, RunError> {
    let bare = prepare_whole(&example(None))?;
    let docs = EffectKind::docs();
    let costs = docs.par_iter().map(|docs| {
        let with = prepare_whole(&example(Some((docs.keyword, docs.example))))?;
        Ok((docs.keyword, difference(&with, &bare)))
    });
    costs.collect()
}

fn example(effect: Option<(&str, &str)>) -> Description {
    let effects =
        effect.map_or(String::new(), |(keyword, keys)| format!("effects: {{ it: {{ {keyword}: {keys} }} }}\n"));
    load_str("effect_costs.yaml", &format!("{MECHANISM}{effects}"), &[])
        .unwrap_or_else(|wrong| panic!("a test loads every example: {}", wrong.render(false)))
}

/// Cost added by each effect of a model, in file order. `None` if others need it (they use its sensors, or
/// only it holds something), and for models with too many effects for their size.
pub fn effect_costs(questions: &Questions, simulator: &Simulator) -> Vec<Option<EffectCost>> {
    let description = questions.description;
    let all = step_instructions(&simulator.program, true);
    let instructions = (all.step + all.factor + all.iteration).unsigned_abs() as usize;
    let effects = 0..description.effects.len();
    if instructions * effects.len() > TUNING.most_instructions {
        return vec![None; effects.len()];
    }
    let cost = |effect: usize| {
        let mut rest = description.clone();
        rest.mechanism_mut().effects.remove(effect);
        let is_known = |output: &&Output| output.formula.names().all(|(name, _)| rest.symbol(name).is_some());
        let outputs = questions.outputs.iter().filter(is_known).cloned().collect();
        let of_rest = Questions { description: &rest, outputs, ..as_chosen(questions, simulator) };
        Some(difference(simulator, &compiled(&of_rest).ok()?))
    };
    effects.into_par_iter().map(cost).collect()
}

/// A step's instructions, with every conditional effect active, or none.
fn step_instructions(program: &Program, active: bool) -> StepInstructions {
    let count = |tape: &symdiff::Tape| tape.len_where(active) as i64;
    StepInstructions {
        step: count(program.step()) + count(program.advance()),
        factor: count(program.factor()),
        iteration: count(program.correct()),
    }
}

fn difference(with: &Simulator, without: &Simulator) -> EffectCost {
    let [active, inactive] = [true, false]
        .map(|active| step_instructions(&with.program, active).beyond(step_instructions(&without.program, active)));
    EffectCost { active, inactive: (active != inactive).then_some(inactive) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::Tapes;

    #[test]
    fn every_effect_has_its_cost() {
        let costs = language_costs().unwrap();
        assert_eq!(costs.iter().map(|&(keyword, _)| keyword).collect::<Vec<_>>(), EffectKind::KEYWORDS);
        let mut conditional = Vec::new();
        for (keyword, EffectCost { active, inactive }) in costs {
            println!("{keyword}: {active:?}, {inactive:?}");
            // The torque of a formula of t is one addition; a constant force is part of another constant or one more.
            assert!(active.step + active.factor + active.iteration > 0, "{keyword}: {active:?}");
            conditional.extend(inactive.is_some().then_some(keyword));
            if let Some(inactive) = inactive {
                assert!(
                    inactive.iteration <= active.iteration / 3 && inactive.factor <= active.factor / 3,
                    "{keyword}: {inactive:?}"
                );
            }
        }
        for keyword in ["stop", "contact", "clearance_joint", "cable", "backlash", "belt"] {
            assert!(conditional.contains(&keyword), "{keyword} acts only sometimes");
        }
    }

    /// An omitted effect leaves nothing: no coordinate, no register, no instruction.
    #[test]
    fn omitted_effect_leaves_no_instructions() {
        let bare = prepare_whole(&example(None)).unwrap();
        let counts = |simulator: &Simulator| {
            let p = &simulator.program;
            let tapes =
                [p.sample(), p.step_size(), p.step(), p.factor(), p.correct(), p.advance(), p.observe(), p.matrix()];
            (tapes.map(symdiff::Tape::len), p.registers(), p.nonzeros)
        };
        for docs in EffectKind::docs() {
            let (keyword, keys) = (docs.keyword, docs.example);
            let with = example(Some((keyword, keys)));
            let mut without = with.clone();
            without.mechanism_mut().effects.clear();
            let without = prepare_whole(&without).unwrap();
            assert_eq!(counts(&without), counts(&bare), "{keyword}");
            let with_it = prepare_whole(&with).unwrap();
            assert_ne!(counts(&with_it), counts(&bare), "{keyword}");
            assert_eq!(effect_costs(&Questions::of(&with), &with_it), [Some(difference(&with_it, &bare))], "{keyword}");
        }
    }
}
