//! `mbint check`: errors of models, and their coordinates, constraints and degrees of freedom.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::args::{CheckArgs, Format};
use super::console::{BOLD, Console, coordinates, count, to_json};
use super::load::Given;
use super::tuning::TUNING;
use super::{Failure, Status, load, structure, tree};
use crate::model::{self, Changes, Description};
use crate::results::{AssemblySummary, Structure};
use crate::simulate::Assembled;
use crate::study::{self, Ready, RunError};
use crate::syntax::{Code, Coded, Diagnostics, harmless};

/// Result for a model; an element of the JSON output.
#[derive(Serialize)]
struct Checked {
    file: String,
    ok: bool,
    #[serde(flatten)]
    counts: Option<Counts>,
    /// Errors and warnings with their locations.
    diagnostics: Vec<crate::syntax::Record>,
    /// The error of the mechanism as a whole.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    /// Its code.
    #[serde(skip_serializing_if = "Option::is_none")]
    error_code: Option<Code>,
    /// Results for its scenes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    scenes: Vec<CheckedScene>,
    /// `diagnostics` for people.
    #[serde(skip)]
    found: Diagnostics,
    /// The tree of a robot's links, for people.
    #[serde(skip)]
    tree: String,
    /// Whether `error` is one of this program.
    #[serde(skip)]
    is_internal: bool,
}

impl Checked {
    /// Empty result for a file.
    fn nothing(path: &Path) -> Self {
        Self {
            file: model::shown(path),
            ok: false,
            counts: None,
            diagnostics: Vec::new(),
            error: None,
            error_code: None,
            scenes: Vec::new(),
            found: Diagnostics::default(),
            tree: String::new(),
            is_internal: false,
        }
    }
}

/// Result for a scene.
#[derive(Serialize)]
struct CheckedScene {
    scene: String,
    ok: bool,
    #[serde(flatten)]
    counts: Option<Counts>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error_code: Option<Code>,
}

#[derive(Serialize)]
struct Counts {
    model: String,
    /// Name of the formulation, as in a run's summary.
    formulation: String,
    coordinates: usize,
    constraints: usize,
    degrees_of_freedom: usize,
    /// Counts of the model with all its parts, if a run simulates only some of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    whole: Option<Whole>,
    uncertain_parameters: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    assemblies: Vec<AssemblySummary>,
    redundant_constraints: Vec<String>,
    singular_at_start: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    shared_start: Vec<String>,
    undetermined_outputs: Vec<String>,
    outputs: Vec<String>,
    /// Reason why it is spatial, if the model does not say so.
    #[serde(skip_serializing_if = "Option::is_none")]
    spatial_because: Option<String>,
    /// Analysis, unless it is a motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    analysis: Option<&'static str>,
    /// The program that answers instead of a mechanism; `check` does not start it.
    #[serde(skip_serializing_if = "Option::is_none")]
    black_box: Option<Vec<String>>,
    /// Parts that no output depends on.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    not_simulated: Vec<String>,
    /// Confirmation that a run asks for before it begins.
    #[serde(skip_serializing_if = "Option::is_none")]
    asks: Option<String>,
    /// Structure of the model with all its parts.
    #[serde(flatten)]
    structure: Structure,
}

#[derive(Clone, Copy, Serialize)]
struct Whole {
    coordinates: usize,
    constraints: usize,
    degrees_of_freedom: usize,
}

pub(super) fn check(args: &CheckArgs, console: &mut Console) -> Result<Status, Failure> {
    load::input_once(&args.models)?;
    let given = args.set.given()?;
    let check = |path: &PathBuf| match study::caught("check", || check_one(path, &given)) {
        Ok(checked) => checked,
        Err(error) => Checked { error: Some(error.to_string()), is_internal: true, ..Checked::nothing(path) },
    };
    let checked: Vec<Checked> = args.models.iter().map(check).collect();
    match args.format {
        Format::Text => {
            for model in &checked {
                console.diagnostics(&model.found);
                if let Some(error) = &model.error {
                    console.coded_error(model.error_code, &format!("{}: {error}", model.file));
                }
                if let Some(counts) = &model.counts {
                    console.print(&counts.lines())?;
                }
                for scene in &model.scenes {
                    match (&scene.counts, &scene.error) {
                        (Some(counts), _) => console.print(&counts.lines())?,
                        (None, error) => {
                            let error = error.as_deref().unwrap_or_default();
                            let message = format!("{}: scene {}: {error}", model.file, scene.scene);
                            console.coded_error(scene.error_code, &message);
                        }
                    }
                }
                console.print(&model.tree)?;
            }
        }
        Format::Json => console.print(&to_json(&checked)?)?,
    }
    let status = |model: &Checked| match model.ok {
        true => Status::Done,
        false if model.is_internal => Status::Failed,
        false => Status::Wrong,
    };
    Ok(checked.iter().map(status).max().unwrap_or(Status::Done))
}

fn check_one(path: &Path, given: &Given) -> Checked {
    let reading = model::read_rooted(path, Changes::of(&given.overrides), given.root.as_deref());
    let (diagnostics, found) = (reading.diagnostics.records(), reading.diagnostics.clone());
    let read = Checked { diagnostics, found, ..Checked::nothing(path) };
    let read = Checked { tree: reading.description.as_ref().map(tree::of).unwrap_or_default(), ..read };
    if !reading.scenes.is_empty() {
        // Only the scenes are run.
        let scenes: Vec<CheckedScene> = reading.scenes.iter().map(check_scene).collect();
        return Checked { ok: scenes.iter().all(|scene| scene.ok), scenes, ..read };
    }
    match reading.description.as_ref().map(Counts::of) {
        None => read,
        Some(Err(error)) => Checked { error_code: error.code(), error: Some(error.to_string()), ..read },
        Some(Ok(counts)) => Checked { ok: true, counts: Some(counts), ..read },
    }
}

fn check_scene(scene: &model::Scene) -> CheckedScene {
    let nothing = CheckedScene { scene: scene.name.clone(), ok: false, counts: None, error: None, error_code: None };
    match Counts::of(&scene.description) {
        Ok(counts) => CheckedScene { ok: true, counts: Some(counts), ..nothing },
        Err(error) => CheckedScene { error_code: error.code(), error: Some(error.to_string()), ..nothing },
    }
}

impl Counts {
    /// Sizes of the simulated parts; names of the whole model, including parts that will not be simulated.
    fn of(model: &Description) -> Result<Self, RunError> {
        let Ready { sizes, formulation, is_whole, left_out, price } = study::ready(model)?;
        let (Assembled { system, mobility, undetermined, shared, .. }, structure) = study::structure(model)?;
        let [coordinates, constraints, degrees_of_freedom] = sizes;
        let whole = Whole {
            coordinates: system.coordinates_of_motion().count(),
            constraints: system.constraints.len(),
            degrees_of_freedom: mobility.degrees_of_freedom,
        };
        let is_less = !is_whole && (coordinates != whole.coordinates || constraints != whole.constraints);
        Ok(Self {
            model: model.name.clone(),
            formulation,
            coordinates,
            constraints,
            degrees_of_freedom,
            whole: is_less.then_some(whole),
            uncertain_parameters: system.parameters.iter().map(|parameter| parameter.name.clone()).collect(),
            assemblies: study::assemblies(model),
            redundant_constraints: system.constraint_names(&mobility.redundant),
            singular_at_start: system.constraint_names(&mobility.singular_at_start),
            shared_start: shared,
            undetermined_outputs: system.output_names(&undetermined),
            outputs: system.outputs.iter().map(|output| output.name.clone()).collect(),
            spatial_because: model.space.because().map(str::to_owned),
            analysis: model.analysis.in_words(),
            black_box: model.black_box.as_ref().map(model::BlackBox::words),
            not_simulated: left_out,
            asks: price.map(|price| price.to_string()),
            structure,
        })
    }
}

impl Counts {
    fn lines(&self) -> String {
        if let Some(command) = &self.black_box {
            return format!(
                "ok {BOLD}{}{BOLD:#}: {}, {}, answered by `{}`, which a run starts\n{}",
                self.model,
                count(self.outputs.len(), "output", "outputs"),
                count(self.uncertain_parameters.len(), "uncertain parameter", "uncertain parameters"),
                harmless(&command.join(" ")),
                self.asks.as_ref().map_or_else(String::new, |asks| format!("  a run asks first: {asks}\n")),
            );
        }
        let redundant = match &self.redundant_constraints[..] {
            [] => "no redundant constraints".to_owned(),
            names => {
                format!(
                    "{} ({})",
                    count(names.len(), "redundant constraint", "redundant constraints"),
                    names.join(", ")
                )
            }
        };
        let others = |names: &[String], what: &str| match names {
            [] => String::new(),
            names if names.len() > TUNING.most_named => {
                format!(
                    ", {what} {} and {} more",
                    names[..TUNING.first_named].join(", "),
                    names.len() - TUNING.first_named
                )
            }
            names => format!(", {what} {}", names.join(", ")),
        };
        let singular = others(&self.singular_at_start, "a singular start, at which other constraints imply");
        let shared = others(&self.shared_start, "a start that the model leaves open, nearest to rest in");
        let undetermined = others(&self.undetermined_outputs, "reactions that are not unique:");
        let left_out = others(&self.not_simulated, "not simulated because no output depends on it:");
        let whole = self.whole.map_or_else(String::new, |whole| {
            let constraints = count(whole.constraints, "constraint", "constraints");
            format!("; the whole model has {} and {constraints}", count(whole.coordinates, "coordinate", "coordinates"))
        });
        format!(
            "ok {BOLD}{}{BOLD:#}: {}, {}, {}, {}, {redundant}{singular}{shared}{undetermined}{left_out}{whole}\n{}",
            self.model,
            coordinates(self.coordinates, &self.formulation),
            count(self.constraints, "constraint", "constraints"),
            count(self.degrees_of_freedom, "degree of freedom", "degrees of freedom"),
            count(self.uncertain_parameters.len(), "uncertain parameter", "uncertain parameters"),
            self.spatial_because.as_ref().map_or_else(String::new, |why| format!("  in space: {why}\n"))
                + &self.analysis.map_or_else(String::new, |analysis| format!("  {analysis}\n"))
                + &self.asks.as_ref().map_or_else(String::new, |asks| format!("  a run asks first: {asks}\n"))
                + &crate::overview::assemblies(&self.assemblies)
                + &structure::lines(&self.structure),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{KindCount, MassRange, MobilityCount};

    #[test]
    fn counts_come_first() {
        let mut counts = Counts {
            model: "slider_crank".into(),
            formulation: "absolute".into(),
            coordinates: 7,
            constraints: 6,
            degrees_of_freedom: 1,
            whole: None,
            uncertain_parameters: vec!["l1".into(), "tau".into()],
            assemblies: vec![],
            redundant_constraints: vec![],
            singular_at_start: vec![],
            shared_start: vec![],
            undetermined_outputs: vec![],
            outputs: vec![],
            spatial_because: None,
            analysis: None,
            black_box: None,
            not_simulated: vec![],
            asks: None,
            structure: Structure {
                mobility: MobilityCount {
                    spatial: false,
                    bodies: 4,
                    joints: 4,
                    constraints: 8,
                    held: 0,
                    drives: 0,
                    count: 1,
                    mobility: 1,
                    over_constrained: 0,
                },
                size: [0.5, 0.25, 0.0],
                mass: MassRange { nominal: 2.0, lower: 1.9, upper: 2.1 },
                gravity: None,
                acting: vec![KindCount { kind: "torque", count: 1 }],
                resisting: vec![],
                moves_at_start: false,
            },
        };
        let plain = |counts: &Counts| crate::overview::plain(&counts.lines());
        let first = |counts: &Counts| plain(counts).lines().next().unwrap_or_default().to_owned();
        insta::assert_snapshot!(first(&counts), @"ok slider_crank: 7 absolute coordinates, 6 constraints, 1 degree of freedom, 2 uncertain parameters, no redundant constraints");
        counts.redundant_constraints = vec!["pin.x".into(), "pin.y".into()];
        counts.uncertain_parameters.clear();
        insta::assert_snapshot!(first(&counts), @"ok slider_crank: 7 absolute coordinates, 6 constraints, 1 degree of freedom, no uncertain parameters, 2 redundant constraints (pin.x, pin.y)");
    }
}
