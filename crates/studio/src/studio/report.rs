//! The report of the latest finished study, as `mbint run` writes it.

use std::fs;
use std::path::Path;

use super::answer::Answer;
use super::desk::{Desk, Finished};
use crate::export::{ExportError, MOST_TRIANGLES, ReportParts, read_meshes, write_results};
use crate::results::Provenance;
use crate::simulate::Interruption;
use crate::study::{self, MotionOptions};

/// The report, or an error if there is none yet.
pub fn answer(desk: &Desk) -> Answer {
    let Some(finished) = desk.finished() else {
        return Answer::error(404, "there is a report when the bounds are done");
    };
    match page(desk, &finished) {
        Ok(page) => Answer::report(page),
        Err(error) => Answer::error(500, &error.to_string()),
    }
}

fn page(desk: &Desk, finished: &Finished) -> Result<Vec<u8>, ExportError> {
    let Finished { current, bounds, summary } = finished;
    let is_ended = || desk.is_old(current.number) && desk.is_replaced(current.number);
    let options = MotionOptions::of_run(summary, Interruption::new(&is_ended));
    let motion = study::report_motion(&current.description, &bounds.functions, options);
    let (beside, texts) = desk.texts(|texts| {
        let name = |path: &Path| path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let files = texts.files().into_iter();
        let texts_of: Vec<(String, String)> =
            files.filter_map(|path| Some((name(&path), texts.open(&path).ok()?.to_owned()))).collect();
        (texts.model().parent().map(Path::to_owned).unwrap_or_default(), texts_of)
    });
    let motion = motion.map(|mut found| {
        read_meshes(&mut found.drawing, &beside, MOST_TRIANGLES);
        found
    });
    let parts = ReportParts { description: current.description.description.clone(), texts, motion, page: true };
    let folder = desk.folder.join("report");
    write_results(&folder, bounds, &summary.without_seconds(), &Provenance::default(), false, Some(&parts))?;
    let path = folder.join("report.html");
    fs::read(&path).map_err(|source| ExportError::Read { path, source })
}
