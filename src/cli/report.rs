//! `mbint report`, and what `mbint run` adds for a report.

use std::path::Path;

use super::args::ReportArgs;
use super::console::Console;
use super::request::Job;
use super::{Failure, Status};
use crate::export::{ReportParts, write_report};
use crate::model::stl_corners;
use crate::study::{self, MotionOptions};
use crate::syntax::regular;

/// Numbers of two bytes that the motions of a report come to, about: with base64 it keeps below 2 MB beside its plots.
const SIZE: usize = 300_000;

/// Triangles of all meshes of a report; those of files beyond are left out.
const MOST_TRIANGLES: usize = 12_000;

pub(super) fn report(args: &ReportArgs, console: &mut Console) -> Result<Status, Failure> {
    let file = write_report(&args.folder).map_err(|error| Failure::Wrong(error.to_string()))?;
    console.print(&format!("{}\n", file.display()))?;
    Ok(Status::Done)
}

/// What a report shows of a job beside its results. The page says so where a motion cannot be simulated.
pub(super) fn parts(job: &Job, threads: Option<usize>) -> ReportParts {
    let options = MotionOptions { threads, size: SIZE / job.share.max(1) };
    let motion = study::caught("the report's motion", || study::motion(&job.model, options));
    let motion = match motion {
        Ok(found) => found.map_err(|error| error.to_string()),
        Err(error) => Err(error.to_string()),
    };
    let visuals = motion.iter().flat_map(|motion| &motion.visuals);
    let mut left = MOST_TRIANGLES / job.share.max(1);
    let meshes = visuals.map(|visual| mesh(job, visual.file.as_deref()?, &mut left)).collect();
    ReportParts {
        meshes,
        description: job.model.description.clone(),
        texts: job.texts.to_vec(),
        motion,
        page: job.page,
    }
}

/// Largest file of a mesh that is read, bytes.
const MOST_BYTES: u64 = 100_000_000;

/// The triangles of a mesh whose file lies beside the model, or in a folder there; others are left out.
fn mesh(job: &Job, file: &str, left: &mut usize) -> Option<Vec<f32>> {
    let plain = file.strip_prefix("file://").unwrap_or(file);
    // Of `package://NAME/…` the package may be the model's folder.
    let within = plain.strip_prefix("package://").map(|path| path.split_once('/').map_or(path, |(_, rest)| rest));
    let name = Path::new(plain).file_name()?;
    let candidates = [Path::new(within.unwrap_or(plain)), Path::new(name)];
    let beside = if job.beside.as_os_str().is_empty() { Path::new(".") } else { &job.beside };
    let folder = beside.canonicalize().ok()?;
    // A link may lead out of the folder.
    let within = |path: &Path| beside.join(path).canonicalize().ok().filter(|full| full.starts_with(&folder));
    let found = candidates.into_iter().find_map(|path| regular(&within(path)?, MOST_BYTES).ok())?;
    let corners = stl_corners(&found).filter(|corners| corners.len() / 9 <= *left)?;
    *left -= corners.len() / 9;
    Some(corners)
}
