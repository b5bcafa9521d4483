//! `mbint report`, and the parts that `mbint run` adds for a report.

use super::args::ReportArgs;
use super::console::Console;
use super::interrupt;
use super::request::Job;
use super::{Failure, Status};
use crate::export::{MOST_TRIANGLES, ReportParts, read_meshes, write_report};
use crate::results::{FunctionWitness, Summary};
use crate::simulate::Interruption;
use crate::study::{self, MotionOptions};

pub(super) fn report(args: &ReportArgs, console: &mut Console) -> Result<Status, Failure> {
    interrupt::wait_for(&args.folder)?;
    let file = write_report(&args.folder).map_err(|error| Failure::wrong(&error).of(&error))?;
    console.print(&format!("{}\n", file.display()))?;
    Ok(Status::Done)
}

/// Parts of a job's report in addition to its results. The page reports that a motion cannot be simulated.
pub(super) fn parts(job: &Job, worst: &[FunctionWitness], summary: &Summary, threads: Option<usize>) -> ReportParts {
    let options = MotionOptions {
        threads,
        size: study::REPORT_SIZE / job.share.max(1),
        ..MotionOptions::of_run(summary, Interruption::new(&interrupt::asked))
    };
    let motion = study::report_motion(&job.model, worst, options);
    let motion = motion.map(|mut found| {
        read_meshes(&mut found.drawing, &job.beside, MOST_TRIANGLES / job.share.max(1));
        found
    });
    ReportParts { description: job.model.description.clone(), texts: job.texts.to_vec(), motion, page: job.page }
}
