//! `mbint explain`: the program to which a model is compiled.

mod decisions;
mod effect_costs;
pub(crate) mod tuning;

use crate::compile::{Program, Tapes};
use crate::model::Description;
use crate::reduce::Choices;
use crate::results::{
    EffectExplanation, Explanation, InstructionCounts, LeftOut, NewtonMatrix, explanation_of_subsystems,
};
use crate::simulate::Simulator;
use crate::study::black_box::needs_mechanism;
use crate::study::prepared::{Prepared, prepare, questions};
use crate::study::{RunError, reduced};

use decisions::{decisions, uncertain};
use effect_costs::effect_costs;
pub use effect_costs::language_costs;
use tuning::TUNING;

/// The program to which a model is compiled, with the reasons for omissions.
///
/// # Errors
/// If it cannot be built or assembled.
pub fn explain(description: &Description) -> Result<Explanation, RunError> {
    needs_mechanism(description, "a list of what a step takes")?;
    let model = reduced::expanded(description);
    let (reduction, prepared) = prepare(&model, Choices::default())?;
    let of_subsystem = |Prepared { subsystem, simulator }: &Prepared| {
        let mut explanation = of_simulator(&description.name, &subsystem.description, simulator);
        for (effect, adds) in explanation.effects.iter_mut().zip(effect_costs(&questions(subsystem), simulator)) {
            effect.adds = adds;
        }
        explanation
    };
    let mut explanation = explanation_of_subsystems(prepared.iter().map(of_subsystem).collect());
    let index = |name: &String| description.outputs.iter().position(|output| output.name == *name);
    explanation.outputs.retain(|name| index(name).is_some());
    explanation.outputs.sort_by_key(index);
    explanation.analysis = description.analysis.in_words().map(str::to_owned);
    let uncertain = uncertain(description);
    let index = |name: &String| uncertain.iter().position(|known| known == name);
    explanation.parameters.sort_by_key(index);
    for number in idle(&uncertain, &prepared) {
        let what = format!("parameter {}", uncertain[number]);
        explanation.left_out.push(LeftOut { what, why: "nothing depends on it".to_owned() });
    }
    for what in &reduction.left_out {
        explanation.left_out.push(LeftOut { what: what.clone(), why: "no output depends on it".to_owned() });
    }
    explanation.decisions = decisions(&model, &reduction, &prepared);
    Ok(explanation)
}

/// Uncertain parameters on which no subsystem depends.
fn idle(uncertain: &[String], prepared: &[Prepared]) -> Vec<usize> {
    let reached = |number: &usize| prepared.iter().any(|one| one.subsystem.parameters.contains(number));
    (0..uncertain.len()).filter(|number| !reached(number)).collect()
}

/// The formulation, the reason for it, and the joints at which loops are cut.
fn formulation(description: &Description, simulator: &Simulator) -> String {
    let info = &simulator.system.formulation;
    let cut: Vec<String> = info.cut.iter().map(|&joint| format!("`{}`", description.joints[joint].name)).collect();
    let cut = match cut.len() {
        0 => String::new(),
        count if count <= TUNING.most_named => format!("; loops are cut at {}", cut.join(", ")),
        count => format!("; loops are cut at {count} joints"),
    };
    format!("{} coordinates: {}{cut}", info.name(), info.why)
}

/// The program of one subsystem.
fn of_simulator(model: &str, description: &Description, simulator: &Simulator) -> Explanation {
    let (system, program) = (&simulator.system, &simulator.program);
    let (nonzeros, factor_nonzeros) = program.nonzeros;
    Explanation {
        model: model.to_owned(),
        space: format!("{}: {}", if system.space.spatial { "spatial" } else { "planar" }, system.space.why),
        analysis: None,
        formulation: formulation(description, simulator),
        coordinates: system.coordinates_of_motion().map(|coordinate| coordinate.name.clone()).collect(),
        constraints: system.constraints.iter().map(|constraint| constraint.name.clone()).collect(),
        degrees_of_freedom: simulator.mobility.degrees_of_freedom,
        redundant_constraints: system.constraint_names(&simulator.mobility.redundant),
        shared_start: simulator.shared.clone(),
        singular_at_start: system.constraint_names(&simulator.mobility.singular_at_start),
        undetermined_outputs: system.output_names(&simulator.undetermined),
        parameters: system.parameters.iter().map(|parameter| parameter.name.clone()).collect(),
        effects: system
            .effects
            .iter()
            .map(|effect| EffectExplanation {
                name: effect.name.clone(),
                kind: effect.kind.to_owned(),
                forces: effect.forces,
                expressions: effect.expressions,
                adds: None,
            })
            .collect(),
        outputs: system.outputs.iter().map(|output| output.name.clone()).collect(),
        instructions: instruction_counts(program, true),
        inactive: Some(instruction_counts(program, false))
            .filter(|inactive| *inactive != instruction_counts(program, true)),
        newton: NewtonMatrix {
            size: program.size,
            nonzeros,
            factor_nonzeros,
            fill: factor_nonzeros.saturating_sub(nonzeros),
            pivots: program.pivots.clone(),
        },
        left_out: system
            .left_out
            .iter()
            .map(|left_out| LeftOut { what: left_out.what.clone(), why: left_out.why.clone() })
            .collect(),
        decisions: Vec::new(),
    }
}

/// A program's instructions, with every conditional effect active, or none.
fn instruction_counts(program: &Program, active: bool) -> InstructionCounts {
    let count = |tape: &symdiff::Tape| tape.len_where(active);
    InstructionCounts {
        sample: count(program.sample()),
        step_size: count(program.step_size()),
        step: count(program.step()),
        factor: count(program.factor()),
        first_correction: count(program.first_correction()),
        correct: count(program.correct()),
        advance: count(program.advance()),
        observe: count(program.observe()),
    }
}
