//! `mbint run`: once for people, once as JSON, or again and again.

use std::path::Path;

use super::args::{Format, RunArgs};
use super::console::{Console, to_json};
use super::job::Done;
use super::record::Record;
use super::request::{Job, Request};
use super::run::run_all;
use super::watch::watch;
use super::{Failure, Status};

pub(super) fn run(args: RunArgs, console: &mut Console) -> Result<Status, Failure> {
    let (format, is_watched) = (args.format, args.watch);
    let mut request = Request::check(args)?;
    if is_watched {
        return watch(request, console);
    }
    let status = run_once(&mut request, format, console);
    if let Some(profile) = &request.settings.profile {
        console.note(&profile.finish()?);
    }
    status
}

fn run_once(request: &mut Request, format: Format, console: &mut Console) -> Result<Status, Failure> {
    match format {
        Format::Text => run_all(request, console, &mut |_, _, _| ()),
        Format::Json => {
            request.quiet = true;
            let mut records = Vec::new();
            let mut record = |path: &Path, job: &Job, done: Result<&Done, &Failure>| {
                records.push(Record::of(path, job, done));
            };
            let status = run_all(request, console, &mut record);
            // The document is complete in any case.
            console.print(&to_json(&records)?)?;
            status
        }
    }
}
