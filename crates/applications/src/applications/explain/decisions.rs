//! Omitted or less frequent computations: the saving of each decision is counted by compiling without it.

use crate::study::formulation::{as_chosen, compiled, instructions};
use crate::study::integration_decision;
use crate::study::prepared::{Prepared, prepare, questions};
use symdiff::{Formula, Input, lower};

use super::tuning::TUNING;
use crate::assemble::Questions;
use crate::compile::Tapes;
use crate::model::{Description, Output, ParameterValue};
use crate::reduce::{Choices, Reduction};
use crate::results::{Decision, Each, Saving};

/// Names of the uncertain parameters.
pub fn uncertain(description: &Description) -> Vec<String> {
    description.uncertain().map(|(_, parameter)| parameter.name.clone()).collect()
}

/// All decisions about a model.
pub fn decisions(description: &Description, reduction: &Reduction, prepared: &[Prepared]) -> Vec<Decision> {
    let step: usize = prepared.iter().map(|one| instructions(&one.simulator)).sum();
    let affordable = step <= TUNING.counted;
    let default = Choices::default();
    let mut found = Vec::new();
    if !reduction.left_out.is_empty() {
        let count = reduction.left_out.len();
        found.push(Decision {
            what: format!("{} not simulated: {}", parts(count), named(&reduction.left_out)),
            why: format!("no output depends on {}", if count == 1 { "it" } else { "them" }),
            saves: without(description, Choices { prune: false, part: false, ..default }, step, affordable),
        });
    }
    let merged: Vec<String> =
        reduction.welds.iter().filter(|(_, obstacle)| obstacle.is_none()).map(|(name, _)| name.clone()).collect();
    if !merged.is_empty() {
        found.push(Decision {
            what: format!("bodies welded together are one: {}", named(&merged)),
            why: "nothing asks for a reaction there".to_owned(),
            saves: without(description, Choices { merge: false, ..default }, step, affordable),
        });
    }
    for (name, obstacle) in &reduction.welds {
        let what = format!("bodies of joint {name} stay two");
        found.extend(obstacle.as_ref().map(|why| Decision { what, why: why.clone(), saves: None }));
    }
    found.extend(subsystems(description, prepared));
    found.extend(constants(prepared));
    found.extend(prepared.iter().filter_map(|one| integration_decision(&one.subsystem.description, &one.simulator)));
    if affordable {
        found.extend(numbers(prepared, step));
        found.extend(unasked(prepared));
    }
    found
}

fn parts(count: usize) -> String {
    if count == 1 { "1 part".to_owned() } else { format!("{count} parts") }
}

fn named(names: &[String]) -> String {
    let more =
        if names.len() > TUNING.named { format!(" and {} more", names.len() - TUNING.named) } else { String::new() };
    format!("{}{more}", names[..names.len().min(TUNING.named)].join(", "))
}

/// Additional instructions of a step with other choices.
fn without(description: &Description, choices: Choices, step: usize, affordable: bool) -> Option<Saving> {
    let (_, prepared) = affordable.then(|| prepare(description, choices).ok())??;
    let other: usize = prepared.iter().map(|one| instructions(&one.simulator)).sum();
    Some(saving(other, step, Each::Step))
}

fn saving(without: usize, with: usize, each: Each) -> Saving {
    Saving { instructions: without as i64 - with as i64, each }
}

/// Number of samples of the methods and the nominal one; `None` if it depends on the response.
fn samples(description: &Description) -> Option<usize> {
    let methods = description.bounds.methods();
    let counts = methods.iter().map(|(_, method)| method.samples()).collect::<Option<Vec<f64>>>()?;
    let deterministic = uncertain(description).is_empty();
    Some(1 + if deterministic { 0 } else { counts.into_iter().sum::<f64>() as usize })
}

/// Parts that move on their own, with the parameters that reach them.
fn subsystems(description: &Description, prepared: &[Prepared]) -> Vec<Decision> {
    let uncertain = uncertain(description);
    let whole = samples(description);
    let mut found = Vec::new();
    for Prepared { subsystem, simulator } in prepared {
        let fewer = subsystem.parameters.len() < uncertain.len();
        if prepared.len() == 1 && !fewer {
            continue;
        }
        let own = samples(&subsystem.description);
        let saved = |(whole, own): (usize, usize)| {
            let each = instructions(simulator);
            saving(whole * each, own * each, Each::StepOfAllSamples)
        };
        let names: Vec<String> = subsystem.parameters.iter().map(|&number| uncertain[number].clone()).collect();
        let bodies: Vec<String> = subsystem.description.bodies.iter().skip(1).map(|body| body.name.clone()).collect();
        let reached = match (names.as_slice(), own) {
            ([], _) => "no uncertain parameter reaches it".to_owned(),
            (_, Some(own)) => format!("of the uncertain parameters only {} reach it: {own} samples", named(&names)),
            (_, None) => format!("of the uncertain parameters only {} reach it", named(&names)),
        };
        let alone = if prepared.len() > 1 { "nothing but the ground connects it to the rest; " } else { "" };
        let how = match (prepared.len() > 1, names.is_empty()) {
            (true, true) => "moves on its own, simulated once",
            (true, false) => "moves on its own",
            (false, true) => "is simulated once",
            (false, false) => "is simulated for fewer samples",
        };
        found.push(Decision {
            what: format!("{} {how}", named(&bodies)),
            why: format!("{alone}{reached}"),
            saves: whole.zip(own).map(saved),
        });
    }
    found
}

/// Values computed before the iteration, and the parts of M.
fn constants(prepared: &[Prepared]) -> Vec<Decision> {
    let (mut entries, mut numbers, mut of_parameters, mut operations) = (0, 0, 0, 0);
    let (mut sample, mut step_size) = (0, 0);
    for Prepared { simulator, .. } in prepared {
        let system = &simulator.system;
        let mut steady = Vec::new();
        for &(_, _, value) in &system.mass {
            entries += 1;
            let symbols = system.graph.symbols_of(&[value]);
            if symbols.is_empty() {
                numbers += 1;
            } else if symbols.iter().all(|symbol| system.parameters.iter().any(|known| known.symbol == *symbol)) {
                of_parameters += 1;
                steady.push(value);
            }
        }
        let inputs: Vec<Input> = system
            .parameters
            .iter()
            .zip(0..)
            .map(|(parameter, register)| Input { symbol: parameter.symbol, stage: 0, register })
            .collect();
        let kernel = steady.into_iter().map(|value| (value, None)).collect();
        let lowered = lower(&system.graph, &inputs, 0, inputs.len() as u32, &[kernel]);
        operations += lowered.kernels[0].len();
        sample += simulator.program.sample().len();
        step_size += simulator.program.step_size().len();
    }
    let mut found = Vec::new();
    if numbers + of_parameters > 0 {
        let all = numbers + of_parameters == entries;
        let what = if all {
            "the mass matrix is constant, and eliminated as such"
        } else {
            "part of the mass matrix is constant"
        };
        found.push(Decision {
            what: what.to_owned(),
            why: format!(
                "of its {entries} entries {numbers} are numbers and {of_parameters} depend on parameters only"
            ),
            saves: Some(Saving { instructions: operations as i64, each: Each::Step }),
        });
    }
    let stages = [
        (sample, "evaluated once a sample", "it depends on parameters only, the elimination of constants included"),
        (step_size, "evaluated when the step changes", "it depends on parameters and the step only"),
    ];
    found.extend(stages.into_iter().filter(|(count, ..)| *count > 0).map(|(count, what, why)| Decision {
        what: what.to_owned(),
        why: why.to_owned(),
        saves: Some(Saving { instructions: count as i64, each: Each::Step }),
    }));
    found
}

/// Parameters that are deterministic are folded into the instructions.
fn numbers(prepared: &[Prepared], step: usize) -> Option<Decision> {
    let (mut other, mut count) = (0, 0);
    for one in prepared {
        let chosen = as_chosen(&questions(&one.subsystem), &one.simulator);
        let mut description = chosen.description.clone();
        for parameter in &mut description.parameters {
            let ParameterValue::Formula(formula) = &parameter.value else { continue };
            if let Some(value) = formula.as_number() {
                parameter.value = ParameterValue::Interval { nominal: value, lower: value, upper: value };
                count += 1;
            }
        }
        other += instructions(&compiled(&Questions { description: &description, ..chosen }).ok()?);
    }
    (count > 0).then(|| Decision {
        what: format!(
            "{} folded into the instructions",
            if count == 1 { "1 number".to_owned() } else { format!("{count} numbers") }
        ),
        why: "parameters that are deterministic".to_owned(),
        saves: Some(saving(other, step, Each::Step)),
    })
}

/// Reactions, energies and measures of effects that no output names.
fn unasked(prepared: &[Prepared]) -> Option<Decision> {
    let (mut other, mut own) = (0, 0);
    for one in prepared {
        let chosen = as_chosen(&questions(&one.subsystem), &one.simulator);
        let description = chosen.description;
        let reactions = description
            .joints
            .iter()
            .enumerate()
            .filter(|(index, joint)| joint.kind.between().is_some() && !chosen.is_merged(*index))
            .flat_map(|(_, joint)| [format!("{}.force", joint.name), format!("{}.torque", joint.name)]);
        let measures = description.effects.iter().flat_map(|effect| {
            effect.kind.measures().into_iter().map(|(measure, _)| format!("{}.{}", effect.name, measure.name()))
        });
        let all: Vec<String> = reactions.chain(measures).chain(["energy".to_owned()]).collect();
        let known = |text: &String| description.symbol(text).is_some();
        let outputs = all.iter().filter(|text| known(text)).filter_map(|text| {
            let formula = Formula::parse(text).ok()?;
            Some(Output { name: text.clone(), formula, unit: String::new(), dimension: None, of_results: false })
        });
        let outputs = chosen.outputs.iter().cloned().chain(outputs).collect();
        other += compiled(&Questions { outputs, ..chosen.clone() }).ok()?.program.observe().len();
        own += one.simulator.program.observe().len();
    }
    Some(Decision {
        what: "reactions, energies and sensors of effects that no output uses are not computed".to_owned(),
        why: "nothing else needs them".to_owned(),
        saves: Some(saving(other, own, Each::Row)),
    })
}
