//! `mbint check`: errors of models, and their coordinates, constraints and degrees of freedom.

use std::path::Path;

use serde::Serialize;

use super::args::{CheckArgs, Format};
use super::console::{BOLD, Console, count, to_json};
use super::{Failure, Status, tree};
use crate::model::{self, Description};
use crate::reduce::{Choices, Reduction};
use crate::study::{self, RunError};

/// Result for a model; an element of the JSON output.
#[derive(Serialize)]
struct Checked {
    file: String,
    ok: bool,
    #[serde(flatten)]
    counts: Option<Counts>,
    /// Errors and warnings with their places.
    diagnostics: Vec<crate::syntax::Record>,
    /// The error of the mechanism as a whole.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    /// Results for its scenes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    scenes: Vec<CheckedScene>,
    /// `diagnostics` for people.
    #[serde(skip)]
    rendered: String,
    /// The tree of a robot's links, for people.
    #[serde(skip)]
    tree: String,
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
}

#[derive(Serialize)]
struct Counts {
    model: String,
    coordinates: usize,
    constraints: usize,
    degrees_of_freedom: usize,
    uncertain_parameters: Vec<String>,
    redundant_constraints: Vec<String>,
    singular_at_start: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    shared_start: Vec<String>,
    undetermined_outputs: Vec<String>,
    outputs: Vec<String>,
    /// Parts that no output depends on.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    not_simulated: Vec<String>,
}

pub(super) fn check(args: &CheckArgs, console: &mut Console) -> Result<Status, Failure> {
    let checked: Vec<Checked> = args.models.iter().map(|path| check_one(path, console.color())).collect();
    match args.format {
        Format::Text => {
            for model in &checked {
                console.report(&model.rendered);
                if let Some(error) = &model.error {
                    console.error(&format!("{}: {error}", model.file));
                }
                if let Some(counts) = &model.counts {
                    console.print(&counts.line())?;
                }
                for scene in &model.scenes {
                    match (&scene.counts, &scene.error) {
                        (Some(counts), _) => console.print(&counts.line())?,
                        (None, error) => {
                            let error = error.as_deref().unwrap_or_default();
                            console.error(&format!("{}: scene {}: {error}", model.file, scene.scene));
                        }
                    }
                }
                console.print(&model.tree)?;
            }
        }
        Format::Json => console.print(&to_json(&checked)?)?,
    }
    let all = checked.iter().all(|model| model.ok);
    Ok(if all { Status::Done } else { Status::Wrong })
}

fn check_one(path: &Path, color: bool) -> Checked {
    let file = model::shown(path);
    let nothing = Checked {
        file,
        ok: false,
        counts: None,
        diagnostics: Vec::new(),
        error: None,
        scenes: Vec::new(),
        rendered: String::new(),
        tree: String::new(),
    };
    let reading = model::read(path, &[]);
    let diagnostics = &reading.diagnostics;
    let rendered = if diagnostics.is_empty() { String::new() } else { diagnostics.render(color) };
    let read = Checked { diagnostics: diagnostics.records(), rendered, ..nothing };
    let read = Checked { tree: reading.description.as_ref().map(tree::of).unwrap_or_default(), ..read };
    if !reading.scenes.is_empty() {
        // Only the scenes are run.
        let scenes: Vec<CheckedScene> = reading.scenes.iter().map(check_scene).collect();
        return Checked { ok: scenes.iter().all(|scene| scene.ok), scenes, ..read };
    }
    match reading.description.as_ref().map(Counts::of) {
        None => read,
        Some(Err(error)) => Checked { error: Some(error.to_string()), ..read },
        Some(Ok(counts)) => Checked { ok: true, counts: Some(counts), ..read },
    }
}

fn check_scene(scene: &model::Scene) -> CheckedScene {
    let (counts, error) = match Counts::of(&scene.description) {
        Ok(counts) => (Some(counts), None),
        Err(error) => (None, Some(error.to_string())),
    };
    CheckedScene { scene: scene.name.clone(), ok: counts.is_some(), counts, error }
}

impl Counts {
    /// Of the whole model, parts that will not be simulated included.
    fn of(model: &Description) -> Result<Self, RunError> {
        let explanation = study::explain_whole(model)?;
        Ok(Self {
            model: explanation.model,
            coordinates: explanation.coordinates.len(),
            constraints: explanation.constraints.len(),
            degrees_of_freedom: explanation.degrees_of_freedom,
            uncertain_parameters: explanation.parameters,
            redundant_constraints: explanation.redundant_constraints,
            singular_at_start: explanation.singular_at_start,
            shared_start: explanation.shared_start,
            undetermined_outputs: explanation.undetermined_outputs,
            outputs: explanation.outputs,
            not_simulated: Reduction::of(model, Choices::default()).left_out,
        })
    }
}

impl Counts {
    fn line(&self) -> String {
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
            names => format!(", {what} {}", names.join(", ")),
        };
        let singular = others(&self.singular_at_start, "a singular start, at which other constraints imply");
        let shared = others(&self.shared_start, "a start that the model leaves open, nearest to rest in");
        let undetermined = others(&self.undetermined_outputs, "reactions that are not unique:");
        let left_out = others(&self.not_simulated, "not simulated because no output depends on it:");
        format!(
            "ok {BOLD}{}{BOLD:#}: {}, {}, {}, {}, {redundant}{singular}{shared}{undetermined}{left_out}\n",
            self.model,
            count(self.coordinates, "coordinate", "coordinates"),
            count(self.constraints, "constraint", "constraints"),
            count(self.degrees_of_freedom, "degree of freedom", "degrees of freedom"),
            count(self.uncertain_parameters.len(), "uncertain parameter", "uncertain parameters"),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_on_one_line() {
        let mut counts = Counts {
            model: "slider_crank".into(),
            coordinates: 7,
            constraints: 6,
            degrees_of_freedom: 1,
            uncertain_parameters: vec!["l1".into(), "tau".into()],
            redundant_constraints: vec![],
            singular_at_start: vec![],
            shared_start: vec![],
            undetermined_outputs: vec![],
            outputs: vec![],
            not_simulated: vec![],
        };
        let plain = |counts: &Counts| anstream::adapter::strip_str(&counts.line()).to_string();
        insta::assert_snapshot!(plain(&counts), @"ok slider_crank: 7 coordinates, 6 constraints, 1 degree of freedom, 2 uncertain parameters, no redundant constraints");
        counts.redundant_constraints = vec!["pin.x".into(), "pin.y".into()];
        counts.uncertain_parameters.clear();
        insta::assert_snapshot!(plain(&counts), @"ok slider_crank: 7 coordinates, 6 constraints, 1 degree of freedom, no uncertain parameters, 2 redundant constraints (pin.x, pin.y)");
    }
}
