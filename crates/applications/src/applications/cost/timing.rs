//! Runs against the clock: short ones a few times, the best of them counting.

use super::CostOptions;
use super::grid::Setting;
use super::tuning::TUNING;
use crate::methods::Method;
use crate::model::Description;
use crate::numerics::clock::Instant;
use crate::results::Bounds;
use crate::results::{MethodSummary, Summary};
use crate::study::{Options, RunError, run};

/// Something done at least once: its last result, and the shortest time, s, that `seconds` makes of a result and of the
/// time it took.
///
/// # Errors
/// The first that occurs.
pub(super) fn best_of<T, E>(
    mut work: impl FnMut() -> Result<T, E>,
    seconds: impl Fn(&T, f64) -> f64,
) -> Result<(T, f64), E> {
    let begun = Instant::now();
    let (mut best, mut repetitions) = (f64::INFINITY, 0);
    loop {
        let this = Instant::now();
        let result = work()?;
        best = best.min(seconds(&result, this.elapsed().as_secs_f64()));
        repetitions += 1;
        if repetitions == TUNING.often_enough || begun.elapsed().as_secs_f64() > TUNING.long_enough {
            return Ok((result, best));
        }
    }
}

/// Runs a setting of a model.
///
/// # Errors
/// If nothing could be run at all.
pub(super) fn bounds(
    model: &Description,
    setting: &Setting,
    options: &CostOptions,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<(Bounds, Summary), RunError> {
    // A single simulation has no bounds.
    let methods = setting.method.curve().is_none().then(Vec::new);
    let interrupted = options.interrupted;
    run(
        &setting.applied(model),
        Options { methods, threads: options.threads, progress, interrupted, ..Options::default() },
    )
}

/// The same with time: seconds are those of the method alone, since compiling the model is the same for all.
///
/// # Errors
/// As [`bounds`].
pub(super) fn timed(
    model: &Description,
    setting: &Setting,
    options: &CostOptions,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<((Bounds, Summary), f64), RunError> {
    let seconds = |(_, summary): &(Bounds, Summary), all| method(summary, setting).seconds.unwrap_or(all);
    best_of(|| bounds(model, setting, options, progress), seconds)
}

/// Time of a run, s, and its work: simulations times steps of all that it simulates; `beside` is the part outside the
/// method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spent {
    pub(super) seconds: f64,
    pub(super) work: f64,
    pub(super) beside: f64,
}

/// Runs a setting once.
///
/// # Errors
/// As [`bounds`].
pub(super) fn spent(model: &Description, setting: &Setting, options: &CostOptions) -> Result<Spent, RunError> {
    let begun = Instant::now();
    let (_, summary) = bounds(model, setting, options, &|_| {})?;
    let seconds = begun.elapsed().as_secs_f64();
    let work = |line: &MethodSummary| line.simulations as f64 * line.steps as f64;
    let all: f64 = summary.methods.iter().map(work).sum();
    Ok(Spent { seconds, work: all, beside: all - work(method(&summary, setting)) })
}

/// The setting's method in a summary; the nominal run, the first line, if the setting has none.
pub(super) fn method<'s>(summary: &'s Summary, setting: &Setting) -> &'s MethodSummary {
    let of = |method: Method| summary.methods.iter().find(|line| line.method == method.name());
    setting.reported().and_then(of).unwrap_or(&summary.methods[0])
}
