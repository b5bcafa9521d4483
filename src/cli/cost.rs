//! `mbint cost`: error against computing time.

use std::path::{Path, PathBuf};

use super::args::CostArgs;
use super::console::{BOLD, Console, count, file_names};
use super::progress::Progress;
use super::run::with_folder;
use super::{Failure, Status, interrupt, load};
use crate::applications::{self, CostError, CostOptions};
use crate::export::write_cost;
use crate::methods::BoundsRequest;
use crate::model::{Description, Stepping};
use crate::overview::{Align, Table};
use crate::results::{CostPoint, CostStudy, Deviation, cost_curves, pareto};
use crate::study::RunError;

pub(super) fn cost(args: CostArgs, console: &mut Console) -> Result<Status, Failure> {
    let model = load::load(&args.model, &args.set.given()?, args.run.scene.as_ref(), console)?;
    let Some((model, folder)) = with_folder(model, args.output.as_ref())? else { return Ok(Status::Wrong) };
    let failed = |error: &dyn std::fmt::Display| Failure::failed(format!("{}: {error}", model.name));
    let progress = Progress::new(&model.name, !args.run.quiet);
    let options = CostOptions {
        tolerance: wanted(&args, &model),
        budget: args.budget,
        threads: args.run.threads.number(),
        progress: &|fraction| progress.set(fraction),
        interrupted: &interrupt::asked,
    };
    // The study itself decides about results to keep.
    interrupt::keep_results(true);
    let study = match applications::cost(&model, &options) {
        Ok(study) => study,
        Err(_) if interrupt::asked() => {
            drop(progress);
            console.error(&format!("{}: interrupted before any setting was finished", model.name));
            return Ok(Status::Interrupted);
        }
        Err(error @ CostError::Run(RunError::Refused(_))) => {
            return Err(Failure::wrong(format!("{}: {error}", model.name)).of(&error));
        }
        Err(error) => return Err(failed(&error).of(&error)),
    };
    drop(progress);
    interrupt::wait_for(&folder)?;
    let files = write_cost(&folder, &study).map_err(|error| failed(&error).of(&error))?;
    if !args.run.quiet {
        console.print(&overview(&study, &folder, &files))?;
    }
    Ok(if interrupt::asked() { Status::Interrupted } else { Status::Done })
}

/// The wanted error: the command's, otherwise the model's, otherwise the default.
fn wanted(args: &CostArgs, model: &Description) -> f64 {
    args.tolerance.or(model.bounds.tolerance).unwrap_or(BoundsRequest::TOLERANCE)
}

/// Each method's front in a table, the reference of the errors, the omitted settings, and the choice.
fn overview(study: &CostStudy, folder: &Path, files: &[PathBuf]) -> String {
    let mut text = format!("{BOLD}{}{BOLD:#}: error against computing time\n\n", study.model);
    if !study.bounds.is_empty() {
        text += &format!("{}\n", bounds(study).render(2));
    }
    if !study.trajectories.is_empty() {
        text += &format!("{}\n", trajectories(study).render(2));
    }
    text += "  Settings on each method's front; * on the front of all methods; ≤ below the reference's own error.\n";
    text += match study.is_deterministic() {
        false => {
            "  Errors are relative to the largest width of an output's bounds; too narrow: the missing part of the range.\n"
        }
        true => "  Errors are relative to the range of an output's course.\n",
    };
    text += &reference(study);
    for left_out in &study.left_out {
        text += &format!("  omitted: {left_out}\n");
    }
    if study.has_reference() {
        text += &format!(
            "  took {:.1} s of {} s, {:.1} s of it for the reference\n",
            study.seconds, study.budget, study.reference_seconds
        );
    }
    text += &format!("\n{BOLD}{}{BOLD:#}\n", choice(study));
    text += &format!("  {}: {}\n", folder.display(), file_names(files.iter()));
    text
}

/// The settings on each method's front, method by method, from the cheapest.
fn fronts(points: &[CostPoint], own: f64) -> Vec<&CostPoint> {
    let front = |method| {
        let of: Vec<&CostPoint> = points.iter().filter(|point| point.method == method).collect();
        let places: Vec<(f64, f64)> = of.iter().map(|point| point.place(own)).collect();
        pareto(&places).into_iter().rev().map(move |index| of[index]).collect::<Vec<_>>()
    };
    cost_curves(points).into_iter().flat_map(front).collect()
}

fn bounds(study: &CostStudy) -> Table<8> {
    let mut table = Table::new([
        ("bounds", Align::Left),
        ("order", Align::Right),
        ("points", Align::Right),
        ("step", Align::Right),
        ("simulations", Align::Right),
        ("seconds", Align::Right),
        ("too wide", Align::Right),
        ("too narrow", Align::Right),
    ]);
    let own = study.reference.bounds_error;
    for point in fronts(&study.bounds, own) {
        let Deviation::Bounds { over_width, under_coverage } = point.deviation else { continue };
        let whole = |count: Option<usize>| count.map_or_else(String::new, |count| count.to_string());
        table.row([
            format!("{}{}", if point.front { "* " } else { "  " }, point.method.label()),
            whole(point.order),
            whole(point.points),
            step(point.step),
            point.simulations.to_string(),
            format!("{:.1e}", point.seconds),
            error(over_width, own),
            error(under_coverage, own),
        ]);
    }
    table
}

fn trajectories(study: &CostStudy) -> Table<5> {
    let mut table = Table::new([
        ("nominal trajectory", Align::Left),
        ("step", Align::Right),
        ("steps", Align::Right),
        ("seconds", Align::Right),
        ("error", Align::Right),
    ]);
    let own = study.reference.trajectory_error;
    for point in fronts(&study.trajectories, own) {
        table.row([
            format!("{}{}", if point.front { "* " } else { "  " }, point.method.label()),
            step(point.step),
            point.steps.to_string(),
            format!("{:.1e}", point.seconds),
            error(point.deviation.largest(), own),
        ]);
    }
    table
}

/// An error, or the reference's own error if that is larger; 0 is exact.
fn error(error: f64, own: f64) -> String {
    match error {
        0.0 => "0".to_owned(),
        error if error < own => format!("≤ {own:.1e}"),
        error => format!("{error:.1e}"),
    }
}

fn seconds(seconds: f64) -> String {
    if seconds < 0.1 { format!("{:.1} ms", 1e3 * seconds) } else { format!("{seconds:.2} s") }
}

/// A step size, or the tolerance that controls it.
fn step(stepping: Stepping) -> String {
    match stepping {
        Stepping::Fixed(step) => {
            let digits = format!("{step:.3e}");
            let (mantissa, exponent) = digits.split_once('e').unwrap_or((&digits, "0"));
            format!("{}e{exponent} s", mantissa.trim_end_matches('0').trim_end_matches('.'))
        }
        Stepping::Tolerance(tolerance) => format!("tolerance {tolerance:.1e}"),
    }
}

/// The reference of the errors, and its own error.
fn reference(study: &CostStudy) -> String {
    let reference = &study.reference;
    if !study.has_reference() {
        return String::new();
    }
    let [finest, middle, _] = reference.steps.map(step);
    let mut text = format!("  reference: {}", reference.method.label());
    if reference.order > 0 {
        text += &format!(" of order {}", reference.order);
    }
    text += &format!(", steps of {finest} and {middle}; its own error {:.1e}", study.own_error());
    if !reference.parts.is_empty() {
        let parts = reference.parts.iter().map(|(source, size)| format!("{source} {size:.1e}"));
        let parts = parts.collect::<Vec<_>>().join(", ");
        text += &format!(" ({parts}), of the trajectory {:.1e}", reference.trajectory_error);
    }
    text + "\n"
}

/// The cheapest setting that meets the tolerance, in a sentence.
fn choice(study: &CostStudy) -> String {
    let (wanted, own) = (study.tolerance, study.own_error());
    let described = |point: &CostPoint| {
        let count_of = match (point.order, point.points) {
            (Some(order), _) => format!(" of order {order}"),
            (_, Some(points)) => format!(" with {points} points per parameter"),
            _ => String::new(),
        };
        let off = match point.deviation {
            Deviation::Bounds { over_width, under_coverage } => {
                format!("too wide by {}, too narrow by {}", error(over_width, own), error(under_coverage, own))
            }
            Deviation::Trajectory(off) => format!("off by {}", error(off, own)),
        };
        let steps = match point.step {
            Stepping::Fixed(_) => format!("steps of {}", step(point.step)),
            Stepping::Tolerance(tolerance) => format!("steps to a tolerance of {tolerance:e}"),
        };
        let simulations = count(point.simulations, "simulation", "simulations");
        format!("{}{count_of}, {steps}: {simulations} in {}, {off}", point.method.label(), seconds(point.seconds))
    };
    let more = format!("--budget {:.0}", 4.0 * study.budget.max(study.reference_seconds).max(1.0));
    if !study.has_reference() {
        return format!(
            "No setting was finished within {} s: a reference to compare with takes {} or more. {more} allows it; a shorter `duration`, fewer \
             rows or fewer uncertain parameters (--set) make it cheaper.",
            study.budget,
            seconds(study.reference_seconds)
        );
    }
    match (study.cheapest(), study.nearest()) {
        (_, nearest) if own >= wanted => {
            let nearest = nearest.map_or_else(String::new, |point| format!(" The nearest is {}.", described(point)));
            format!(
                "No setting can be compared at {wanted:e}: the reference's own error is {own:.1e}. {more} allows a finer one, and {} can be \
                 asked for now.{nearest}",
                asked(2.0 * own)
            )
        }
        (Some(point), _) => format!("The cheapest setting within {wanted:e} is {}.", described(point)),
        (None, Some(point)) => {
            let nearest = format!("No setting meets {wanted:e}; the nearest is {}.", described(point));
            // Among the settings that were not run, costlier ones are nearer.
            match study.left_out.iter().any(|left_out| left_out.contains("budget")) {
                true => format!("{nearest} Others were omitted: {more} allows them."),
                false => format!(
                    "{nearest} `bounds: {{ tolerance: {wanted:e} }}` in the model divides boxes and steps until it is met."
                ),
            }
        }
        (None, None) => format!(
            "No setting was finished within {} s, of which the reference took {:.1} s: {more} allows some, a shorter `duration` or fewer \
             uncertain parameters (--set) make them cheaper.",
            study.budget, study.reference_seconds
        ),
    }
}

/// A tolerance to ask for, rounded up to one digit.
fn asked(tolerance: f64) -> String {
    let text = format!("{tolerance:.0e}");
    let at_least = text.parse::<f64>().is_ok_and(|rounded| rounded >= tolerance);
    let text = if at_least { text } else { format!("{:.0e}", 1.5 * tolerance) };
    format!("--tolerance {text}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::Scheme;
    use crate::results::cost_example::{COMPOSED, SCAN};
    use crate::results::{CostMethod, CostReference};

    fn study() -> CostStudy {
        let point = |method, order, points, seconds, over_width, under_coverage| CostPoint {
            order,
            points,
            simulations: 36,
            steps: 2000,
            seconds,
            deviation: Deviation::Bounds { over_width, under_coverage },
            ..CostPoint::without_result(method, Stepping::Fixed(1e-3))
        };
        let hht = CostMethod::Scheme(Scheme::Hht { alpha: -0.1 });
        let trajectory = CostPoint {
            steps: 6000,
            seconds: 2e-3,
            deviation: Deviation::Trajectory(2e-5),
            ..CostPoint::without_result(hht, Stepping::Fixed(0.01 / 30.0))
        };
        let reference = CostReference {
            method: COMPOSED,
            order: 16,
            steps: [1e-4, 2e-4, 4e-4].map(Stepping::Fixed),
            bounds_error: 1e-5,
            trajectory_error: 1e-6,
            parts: vec![("steps".into(), 1e-6), ("order 16 for 14".into(), 9e-6)],
        };
        let composed = point(COMPOSED, Some(5), None, 0.025, 4e-4, 1e-6);
        CostStudy {
            model: "crank".into(),
            tolerance: 1e-3,
            budget: 60.0,
            reference_seconds: 10.0,
            seconds: 40.0,
            reference,
            bounds: vec![
                CostPoint { front: true, ..composed.clone() },
                CostPoint { order: Some(8), seconds: 0.1, ..composed },
                point(SCAN, None, Some(5), 0.01, 0.0, 2e-3),
            ],
            trajectories: vec![trajectory],
            left_out: vec!["Scan: 3 of its settings, which the budget of 60 s does not allow".into()],
        }
    }

    fn plain(text: &str) -> String {
        crate::overview::plain(text)
    }

    #[test]
    fn the_overview_is_aligned_and_ends_with_the_choice() {
        let files = ["cost.csv", "cost.svg"].map(|name| Path::new("results/crank").join(name));
        let text = overview(&study(), Path::new("results/crank"), &files);
        insta::assert_snapshot!(plain(&text), @r"
        crank: error against computing time

          bounds                 order  points    step  simulations  seconds  too wide  too narrow
          * Chebyshev, composed      5          1e-3 s           36   2.5e-2    4.0e-4    ≤ 1.0e-5
            Scan                             5  1e-3 s           36   1.0e-2         0      2.0e-3

          nominal trajectory        step  steps  seconds   error
            HHT-I3, α = −0.1  3.333e-4 s   6000   2.0e-3  2.0e-5

          Settings on each method's front; * on the front of all methods; ≤ below the reference's own error.
          Errors are relative to the largest width of an output's bounds; too narrow: the missing part of the range.
          reference: Chebyshev, composed of order 16, steps of 1e-4 s and 2e-4 s; its own error 1.0e-5 (steps 1.0e-6, order 16 for 14 9.0e-6), of the trajectory 1.0e-6
          omitted: Scan: 3 of its settings, which the budget of 60 s does not allow
          took 40.0 s of 60 s, 10.0 s of it for the reference

        The cheapest setting within 1e-3 is Chebyshev, composed of order 5, steps of 1e-3 s: 36 simulations in 25.0 ms, too wide by 4.0e-4, too narrow by ≤ 1.0e-5.
          results/crank: cost.csv, cost.svg
        ");
    }

    #[test]
    fn sentence_gives_reasons_if_no_setting_is_chosen() {
        let at = |tolerance| choice(&CostStudy { tolerance, ..study() });
        insta::assert_snapshot!([at(3e-3), at(1e-4), at(1e-5)].join("\n"), @r"
        The cheapest setting within 3e-3 is Scan with 5 points per parameter, steps of 1e-3 s: 36 simulations in 10.0 ms, too wide by 0, too narrow by 2.0e-3.
        No setting meets 1e-4; the nearest is Chebyshev, composed of order 5, steps of 1e-3 s: 36 simulations in 25.0 ms, too wide by 4.0e-4, too narrow by ≤ 1.0e-5. Others were omitted: --budget 240 allows them.
        No setting can be compared at 1e-5: the reference's own error is 1.0e-5. --budget 240 allows a finer one, and --tolerance 2e-5 can be asked for now. The nearest is Chebyshev, composed of order 5, steps of 1e-3 s: 36 simulations in 25.0 ms, too wide by 4.0e-4, too narrow by ≤ 1.0e-5.
        ");
    }
}
