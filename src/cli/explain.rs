//! `mbint explain`: the compiled form of a model, the contents of the language, or the page of a message.

use super::args::{ExplainArgs, Format};
use super::console::{BOLD, Console, count, to_json};
use super::effects::adds;
use super::tuning::TUNING;
use super::{Failure, Status, effects, joints, load, methods};
use crate::applications;
use crate::elements::JointKind;
use crate::overview::{Align, Table};
use crate::results::{Decision, Explanation};
use crate::syntax::Code;
use serde::Serialize;

pub(super) fn explain(args: &ExplainArgs, console: &mut Console) -> Result<Status, Failure> {
    let Some(path) = &args.model else {
        return console.print(&listed(args)?).map(|()| Status::Done);
    };
    if let Some(code) = path.to_str().filter(|text| Code::is_like(text) && !path.exists()) {
        return console.print(&page(code, args.format)?).map(|()| Status::Done);
    }
    let Some(model) = load::load(path, &args.set.given()?, args.scene.as_ref(), console)? else {
        return Ok(Status::Wrong);
    };
    let explanation = applications::explain(&model)
        .map_err(|error| Failure::wrong(format!("{}: {error}", path.display())).of(&error))?;
    console.print(&match args.format {
        Format::Text => text(&explanation),
        Format::Json => to_json(&explanation)?,
    })?;
    Ok(Status::Done)
}

/// The page of a code.
fn page(code: &str, format: Format) -> Result<String, Failure> {
    let code = Code::find(code).map_err(Failure::wrong)?;
    match format {
        Format::Text => Ok(code.page()),
        Format::Json => to_json(&CodePage { code, title: code.title(), page: code.page(), href: code.href() }),
    }
}

/// A code with its page, in Markdown, and the page's address.
#[derive(Serialize)]
struct CodePage {
    code: Code,
    title: &'static str,
    page: String,
    href: String,
}

/// The requested list.
fn listed(args: &ExplainArgs) -> Result<String, Failure> {
    if let Some(listing) = args.list.listing() {
        return match args.format {
            _ if args.page => Ok(listing.page()),
            Format::Text => Ok(listing.text()),
            Format::Json => listing.json(),
        };
    }
    match args.format {
        Format::Text if args.list.methods => Ok(methods::text()),
        Format::Json if args.list.methods => to_json(&methods::all()),
        Format::Text if args.list.joints => Ok(joints::text()),
        Format::Json if args.list.joints => to_json(&JointKind::docs()),
        Format::Text => effects::text(),
        Format::Json => to_json(&effects::all()?),
    }
}

/// The explanation for people, one paragraph for each subject of the model.
fn text(explanation: &Explanation) -> String {
    let e = explanation;
    let mut text = format!("{BOLD}{}{BOLD:#}\n{}\n{}\n", e.model, e.space, e.formulation);
    e.analysis.iter().for_each(|analysis| text += &format!("{analysis}\n"));
    let mut section = |heading: String, body: String| text += &format!("\n{BOLD}{heading}{BOLD:#}\n{body}");

    section(count(e.coordinates.len(), "coordinate", "coordinates"), list(&e.coordinates));
    let mut constraints = count(e.constraints.len(), "constraint", "constraints");
    constraints += &format!(", {}", count(e.degrees_of_freedom, "degree of freedom", "degrees of freedom"));
    section(constraints, list(&e.constraints));
    if !e.redundant_constraints.is_empty() {
        let n = e.redundant_constraints.len();
        let heading = format!("{}, implied by others", count(n, "redundant constraint", "redundant constraints"));
        section(heading, list(&e.redundant_constraints));
    }
    if !e.undetermined_outputs.is_empty() {
        section("outputs of reactions that are not unique".into(), list(&e.undetermined_outputs));
    }
    if !e.shared_start.is_empty() {
        section("coordinates that share the start's undetermined part".into(), list(&e.shared_start));
    }
    if !e.singular_at_start.is_empty() {
        section("constraints that lose their independence at the start only".into(), list(&e.singular_at_start));
    }
    section(count(e.parameters.len(), "uncertain parameter", "uncertain parameters"), list(&e.parameters));
    section(count(e.outputs.len(), "output", "outputs"), list(&e.outputs));

    let mut effects = Table::new([("", Align::Left); 5]);
    for effect in &e.effects {
        let expressions = count(effect.expressions, "expression", "expressions");
        let forces = format!("on {}", count(effect.forces, "coordinate", "coordinates"));
        let adds = effect.adds.as_ref().map_or(String::new(), adds);
        effects.row([effect.name.clone(), effect.kind.clone(), forces, expressions, adds]);
    }
    section(count(e.effects.len(), "effect", "effects"), effects.render(2));

    let total: usize = e.instructions.stages().iter().map(|stage| stage.2).sum();
    section(count(total, "instruction", "instructions"), stages(e));

    section(format!("Newton matrix, {0} × {0}", e.newton.size), newton(e));

    let mut left_out = Table::new([("", Align::Left), ("", Align::Left)]);
    for item in &e.left_out {
        left_out.row([item.what.clone(), item.why.clone()]);
    }
    let heading = if e.left_out.is_empty() { "nothing omitted" } else { "omitted" };
    section(heading.to_owned(), left_out.render(2));
    if !e.decisions.is_empty() {
        section("saved".to_owned(), decisions(&e.decisions));
    }
    text
}

/// The stages of a step, with their numbers of instructions and the times at which they run.
fn stages(e: &Explanation) -> String {
    let mut stages = Table::new([("", Align::Left), ("", Align::Right), ("", Align::Left)]);
    for (stage, when, instructions) in e.instructions.stages() {
        let inactive =
            e.inactive.as_ref().and_then(|inactive| inactive.stages().into_iter().find(|other| other.0 == stage));
        let inactive = inactive.filter(|inactive| inactive.2 != instructions);
        let inactive =
            inactive.map_or(String::new(), |(_, _, fewer)| format!(", {fewer} while conditional effects are inactive"));
        stages.row([stage.to_owned(), instructions.to_string(), format!("{when}{inactive}")]);
    }
    stages.render(2)
}

/// Nonzeros and pivots of the Newton matrix.
fn newton(e: &Explanation) -> String {
    let n = &e.newton;
    let mut newton = Table::new([("", Align::Left), ("", Align::Right), ("", Align::Left)]);
    let part = |k: usize| format!("{:.0} % of the square", 100.0 * k as f64 / (n.size * n.size).max(1) as f64);
    newton.row(["nonzeros".into(), n.nonzeros.to_string(), part(n.nonzeros)]);
    let fill = format!("{}, {} of fill", part(n.factor_nonzeros), n.fill);
    newton.row(["nonzeros of L and U".into(), n.factor_nonzeros.to_string(), fill]);
    let mut body = newton.render(2);
    if !n.pivots.is_empty() {
        let pivots = n.pivots.iter().map(|(row, column)| format!("({row}, {column})"));
        body += &format!("  pivots (row, column)\n{}", indented(&list(&pivots.collect::<Vec<_>>())));
    }
    body
}

/// A line each, with its saving below.
fn decisions(decisions: &[Decision]) -> String {
    let line = |decision: &Decision| {
        let saves = decision.saves.map_or(String::new(), |saving| format!("\n    {}", saving.text()));
        format!("  {}: {}{saves}\n", decision.what, decision.why)
    };
    decisions.iter().map(line).collect()
}

/// Names, indented, in lines of a readable length.
fn list(names: &[String]) -> String {
    let mut text = String::new();
    let mut line = String::new();
    for (i, name) in names.iter().enumerate() {
        let comma = if i + 1 < names.len() { "," } else { "" };
        if !line.is_empty() && line.chars().count() + name.chars().count() + 2 > TUNING.width_of_names {
            text += &format!("{line}\n");
            line.clear();
        }
        line += if line.is_empty() { "  " } else { " " };
        line += &format!("{name}{comma}");
    }
    if line.is_empty() { text } else { text + &line + "\n" }
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("  {line}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{
        Each, EffectCost, EffectExplanation, InstructionCounts, LeftOut, NewtonMatrix, Saving, StepInstructions,
    };

    #[test]
    fn an_explanation_reads_well() {
        let added = |step, factor, iteration| StepInstructions { step, factor, iteration };
        let effect =
            |name: &str, kind: &str, expressions, adds: Option<(StepInstructions, Option<StepInstructions>)>| {
                let adds = adds.map(|(active, inactive)| EffectCost { active, inactive });
                EffectExplanation { name: name.into(), kind: kind.into(), forces: 1, expressions, adds }
            };
        let names = |names: &str| names.split(' ').map(str::to_owned).collect::<Vec<_>>();
        let explanation = Explanation {
            model: "slider_crank".into(),
            space: "planar: nothing leaves the plane".into(),
            analysis: None,
            formulation: "absolute coordinates: no joint can give a body its position".into(),
            coordinates: names("crank.x crank.y crank.angle rod.x rod.y rod.angle slider.x"),
            constraints: names("pivot.x pivot.y pin.x pin.y wrist.x wrist.y"),
            degrees_of_freedom: 1,
            redundant_constraints: vec![],
            singular_at_start: vec![],
            shared_start: vec![],
            undetermined_outputs: vec![],
            parameters: names("l1 tau"),
            effects: vec![
                effect("drive", "torque", 1, None),
                effect("spring", "spring_damper", 9, Some((added(2, 0, 4), None))),
                effect("floor", "contact", 40, Some((added(0, -3, 30), Some(added(0, -5, 2))))),
            ],
            outputs: names("x3"),
            instructions: InstructionCounts {
                sample: 21,
                step_size: 4,
                step: 30,
                factor: 94,
                first_correction: 80,
                correct: 122,
                advance: 40,
                observe: 2,
            },
            inactive: Some(InstructionCounts {
                sample: 21,
                step_size: 4,
                step: 30,
                factor: 90,
                first_correction: 60,
                correct: 94,
                advance: 40,
                observe: 2,
            }),
            newton: NewtonMatrix { size: 13, nonzeros: 43, factor_nonzeros: 51, fill: 8, pivots: vec![(0, 7), (7, 0)] },
            left_out: vec![LeftOut { what: "parameter m4".into(), why: "nothing depends on it".into() }],
            decisions: vec![Decision {
                what: "bodies welded together are one: grip".into(),
                why: "nothing asks for a reaction there".into(),
                saves: Some(Saving { instructions: 120, each: Each::Step }),
            }],
        };
        let plain = crate::overview::plain(&text(&explanation));
        insta::assert_snapshot!(plain, @r"
        slider_crank
        planar: nothing leaves the plane
        absolute coordinates: no joint can give a body its position

        7 coordinates
          crank.x, crank.y, crank.angle, rod.x, rod.y, rod.angle, slider.x

        6 constraints, 1 degree of freedom
          pivot.x, pivot.y, pin.x, pin.y, wrist.x, wrist.y

        2 uncertain parameters
          l1, tau

        1 output
          x3

        3 effects
          drive   torque         on 1 coordinate  1 expression
          spring  spring_damper  on 1 coordinate  9 expressions   adds 4 an iteration, 0 a factorisation, 2 a step
          floor   contact        on 1 coordinate  40 expressions  adds 30 an iteration, -3 a factorisation, 0 a step; inactive 2, -5, 0

        393 instructions
          sample             21  once a sample
          step size           4  once a step size
          step               30  once a step
          factor             94  when the Newton matrix is factored, 90 while conditional effects are inactive
          first correction   80  right after a factorisation, 60 while conditional effects are inactive
          correct           122  every further Newton iteration, 94 while conditional effects are inactive
          advance            40  once a step, at its end
          observe             2  once a row of output

        Newton matrix, 13 × 13
          nonzeros             43  25 % of the square
          nonzeros of L and U  51  30 % of the square, 8 of fill
          pivots (row, column)
            (0, 7), (7, 0)

        omitted
          parameter m4  nothing depends on it

        saved
          bodies welded together are one: grip: nothing asks for a reaction there
            saves 120 instructions a step
        ");
    }

    #[test]
    fn long_lists_are_broken_between_names() {
        let names: Vec<String> = (0..60).map(|i| format!("body{i}.angle")).collect();
        let text = list(&names);
        assert!(text.lines().all(|line| line.chars().count() <= 100 && line.starts_with("  ")));
        assert_eq!(text.split_whitespace().count(), 60);
        assert_eq!(list(&[]), "");
    }
}
