//! Runs of a model.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use crate::export::{MOST_TRIANGLES, ReportParts, read_meshes, result_files};
use crate::model::Reading;
use crate::overview::{overview, plain, warnings};
use crate::results::{Provenance, RunRequest};
use crate::simulate::Interruption;
use crate::study::{self, MotionOptions, Options, RunError};

/// Receiver of progress reports.
pub trait Host: Sync {
    /// Reports the activity, and its finished fraction.
    fn progress(&self, stage: &str, fraction: f64);
}

/// Results for a page.
pub(super) struct Run {
    pub summary: String,
    pub warnings: Vec<String>,
    pub files: BTreeMap<String, String>,
    pub failure: Option<String>,
}

/// Reason why there are no results.
pub(super) struct Unrun {
    pub why: String,
    /// Whether the reason is that the run would take long.
    pub waits: bool,
}

/// Runs a model that was read without errors: its scene named `scene`, or itself.
pub(super) fn run(reading: Reading, scene: Option<&str>, costly: bool, host: &dyn Host) -> Result<Run, Unrun> {
    let (model_files, texts) = study::sources(&reading);
    let names: Vec<String> = scene.iter().map(|name| (*name).to_owned()).collect();
    let chosen = reading.chosen(&names).map_err(|error| refused(&error))?;
    let Some((_, model)) = chosen.into_iter().next() else { return Err(refused(&"there is no model")) };
    if model.black_box.is_some() {
        return Err(refused(&"the model asks another program, which a page cannot run: use `mbint run`"));
    }
    let stage = Mutex::new(study::COMPILING.to_owned());
    let tell = |fraction: f64| host.progress(&stage.lock().unwrap_or_else(PoisonError::into_inner), fraction);
    let begin = |name: &str| {
        *stage.lock().unwrap_or_else(PoisonError::into_inner) = name.to_owned();
        tell(0.0);
    };
    begin(study::COMPILING);
    let options = Options { costly, derivatives: true, progress: &tell, stage: &begin, ..Options::default() };
    let (bounds, summary) = study::run(&model, options)
        .map_err(|error| Unrun { waits: matches!(error, RunError::Costly(_)), why: error.to_string() })?;
    begin("motion for the report");
    let options = MotionOptions::of_run(&summary, Interruption::new(&|| false));
    let motion = study::report_motion(&model, &bounds.functions, options).map(|mut found| {
        read_meshes(&mut found.drawing, Path::new(""), MOST_TRIANGLES);
        found
    });
    let parts = ReportParts { description: model.description.clone(), texts, motion, page: true };
    begin("report");
    let provenance = Provenance { model_files, request: Some(RunRequest::default()) };
    let files = result_files(&bounds, &summary.without_seconds(), &provenance, Some(&parts));
    let files = files.map_err(|error| refused(&error))?;
    // All files of results are texts.
    let text = |(name, bytes): (String, Vec<u8>)| (name, String::from_utf8_lossy(&bytes).into_owned());
    Ok(Run {
        summary: plain(&overview(&summary)),
        warnings: warnings(&bounds, &summary).into_iter().map(|warning| warning.text).collect(),
        failure: summary.failure.clone(),
        files: files.into_iter().map(text).collect(),
    })
}

fn refused(why: &dyn Display) -> Unrun {
    Unrun { why: why.to_string(), waits: false }
}
