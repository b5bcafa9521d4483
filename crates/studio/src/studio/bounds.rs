//! Reads the model while it is typed, and bounds it, coarsely first.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use serde_json::{Value, json};

use super::desk::{Current, Desk, Finished, Reading};
use super::language::uri;
use super::tuning::TUNING;
use crate::export::{results_article, write_results};
use crate::methods::{BoundsRequest, Chebyshev, Taylor};
use crate::model::{Description, Opened, read_open};
use crate::results::{Bounds, Provenance, Summary};
use crate::study::{self, Options, RunError};

/// A study of a series: each takes longer than the one before, and yields more.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    Nominal,
    Coarse,
    Asked,
}

impl Stage {
    fn name(self) -> &'static str {
        match self {
            Self::Nominal => "nominal",
            Self::Coarse => "coarse",
            Self::Asked => "asked",
        }
    }

    /// The model with the bounds of this stage; `None` if the stage does not apply to it.
    fn of(self, description: &Description) -> Option<Description> {
        let mut model = description.clone();
        let k = description.uncertain().count();
        if self == Self::Asked {
            return Some(model);
        }
        // Random excitations are bounded differently if no statistics are requested.
        if k == 0 || self == Self::Coarse && model.statistics.asked {
            return None;
        }
        model.statistics.asked = false;
        model.bounds = BoundsRequest { budget: description.bounds.budget, ..BoundsRequest::default() };
        match self {
            Self::Coarse if k <= TUNING.few_parameters => model.bounds.chebyshev = Some(Chebyshev::of_order(1, k)),
            Self::Coarse => model.bounds.taylor = Some(Taylor { order: 1, ..Taylor::default() }),
            // There are no verdicts without bounds.
            _ => model.requirements.clear(),
        }
        Some(model)
    }
}

/// Reads and bounds the model, anew with each change, until the end.
pub fn work(desk: &Desk) {
    let mut seen = 0;
    while let Some(reading) = desk.next_change(seen) {
        seen = reading.change;
        let opened = study::caught("reading", || read_open(&reading.path, &reading.overlay, desk.root.as_deref()));
        match opened {
            Err(error) => desk.board.put("model", json!({ "state": "wrong", "error": error.to_string() })),
            Ok(opened) => study_of(desk, &reading, opened),
        }
    }
}

fn study_of(desk: &Desk, reading: &Reading, opened: Opened) {
    let sources = opened.reading.diagnostics.sources.all();
    let sources: Vec<PathBuf> =
        sources.map(|source| PathBuf::from(&source.name)).filter(|path| path.is_file()).collect();
    // Tables and robots are not texts of the language.
    let is_text = |path: &&PathBuf| path.extension().is_some_and(|own| own == "yaml" || own == "yml");
    let texts = sources.iter().filter(is_text).cloned().collect();
    desk.was_read_from(sources, texts);
    let files = desk.texts(|texts| texts.files());
    let files: Vec<Value> = files.iter().map(|path| file(path)).collect();
    let names: Vec<&str> = opened.reading.scenes.iter().map(|scene| scene.name.as_str()).collect();
    let scene = reading.scene.as_deref().filter(|name| names.contains(name)).or(names.first().copied());
    let scenes = opened.reading.scenes.iter();
    let chosen = scenes.filter(|own| Some(own.name.as_str()) == scene).map(|own| &own.description).next();
    let Some(description) = chosen.or(opened.reading.description.as_ref()) else {
        desk.board.put("progress", Value::Null);
        return desk.board.put("model", json!({ "state": "wrong", "files": files }));
    };
    let (parameters, _) = study::uncertain(description);
    let model = json!({
        "state": "valid",
        "number": reading.change,
        "name": description.name,
        "files": files,
        "scenes": names,
        "scene": scene,
        "parameters": parameters,
        "duration": description.simulation.duration,
    });
    let starts_a_program = description.black_box.is_some() && !reading.is_allowed;
    if starts_a_program {
        desk.board.put("model", model);
        let why = "The model asks a program, which is started when you allow it.";
        desk.board.put("mechanism", json!({ "number": reading.change, "absent": why }));
        desk.board.put("progress", Value::Null);
        let note = json!({ "number": reading.change, "stage": "asked", "error": why, "waits": true });
        return desk.board.put("bounds", note);
    }
    let current = desk.publish(reading.change, description.clone(), model);
    let done = study::caught("the bounds", || stages(desk, &current, reading));
    if let Err(error) = done {
        desk.board.put("bounds", json!({ "number": current.number, "stage": "asked", "error": error.to_string() }));
    }
    if !desk.is_old(reading.change) {
        desk.board.put("progress", Value::Null);
    }
}

fn file(path: &Path) -> Value {
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    json!({ "path": path, "name": name, "uri": uri(path) })
}

/// Bounds a model, stage by stage, until its text changes.
fn stages(desk: &Desk, current: &Arc<Current>, reading: &Reading) {
    let number = current.number;
    for stage in [Stage::Nominal, Stage::Coarse, Stage::Asked] {
        let Some(model) = stage.of(&current.description) else { continue };
        let found = run(desk, &model, reading, stage);
        if desk.is_old(reading.change) {
            return;
        }
        let (bounds, summary) = match found {
            // Some models cannot be expanded, or have no such bounds; the next stage reports the errors of a model.
            Ok((_, summary)) if stage == Stage::Coarse && summary.is_cut => continue,
            Err(_) if stage == Stage::Coarse => continue,
            Ok(found) => found,
            Err(error) => {
                let waits = matches!(error, RunError::Costly(_));
                let note =
                    json!({ "number": number, "stage": stage.name(), "error": error.to_string(), "waits": waits });
                return desk.board.put("bounds", note);
            }
        };
        let folder = desk.folder.join(stage.name());
        let provenance = Provenance::default();
        let article = write_results(&folder, &bounds, &summary.without_seconds(), &provenance, false, None)
            .and_then(|_| results_article(&folder));
        let note = match article {
            Ok(html) => json!({ "number": number, "stage": stage.name(), "html": html }),
            Err(error) => json!({ "number": number, "stage": stage.name(), "error": error.to_string() }),
        };
        if stage == Stage::Asked {
            desk.finish(Finished { current: Arc::clone(current), bounds, summary });
        }
        desk.board.put("bounds", note);
    }
}

fn run(desk: &Desk, model: &Description, reading: &Reading, stage: Stage) -> Result<(Bounds, Summary), RunError> {
    let tell = |fraction: f64| {
        let fraction = (fraction / TUNING.share_of_progress).floor() * TUNING.share_of_progress;
        let note = json!({ "number": reading.change, "stage": stage.name(), "fraction": fraction });
        desk.board.put("progress", note);
    };
    tell(0.0);
    let begun = Instant::now();
    let is_late = || stage == Stage::Coarse && begun.elapsed() > TUNING.time_of_coarse;
    let interrupted = || desk.is_old(reading.change) || is_late();
    let options = Options {
        costly: reading.is_allowed,
        derivatives: stage != Stage::Coarse,
        progress: &tell,
        interrupted: &interrupted,
        ..Options::default()
    };
    study::run(model, options)
}
