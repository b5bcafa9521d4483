//! Samples of a study on many machines, instead of bounds.

use std::path::PathBuf;

use super::{absolute, given};
use crate::cli::args::{PointArgs, Threads};
use crate::cli::console::Console;
use crate::cli::kept_run::KeptRun;
use crate::cli::sample::{Points, Sampling};
use crate::cli::{Failure, Status};
use crate::results::SampleFormat;
use crate::store::{AskedPoints, StudyRequest};

/// The points for a plan; `None` if bounds are requested.
pub(super) fn asked(args: &PointArgs) -> Result<Option<AskedPoints>, Failure> {
    // Errors are reported before anything is written.
    Points::asked(args)?;
    if let Some(path) = &args.points {
        return Ok(Some(AskedPoints::Table(absolute(path)?)));
    }
    Ok(args.design.clone().map(|design| AskedPoints::Design { design, seed: args.seed }))
}

/// Simulates or defers the missing samples of a study, and writes them if a file is given.
pub(super) fn simulate(
    asked: &StudyRequest,
    kept: &KeptRun,
    output: Option<(PathBuf, SampleFormat)>,
    threads: Threads,
    quiet: bool,
    console: &mut Console,
) -> Result<Status, Failure> {
    let ([model], Some(points)) = (&asked.models[..], &asked.points) else {
        return Err(Failure::wrong("samples are of one model"));
    };
    let sampling = Sampling {
        model,
        given: &given(asked)?,
        scenes: &asked.scenes,
        points: &Points::planned(points)?,
        output: output.as_ref().map(|(path, format)| (path.as_path(), *format)),
        threads,
        quiet,
        store: Some(kept),
    };
    sampling.run(console)
}
