//! Studies at points: the figures that are printed.

use super::axes::{Axes, without_tolerances};
use super::goal::{Goal, Merit};
use super::surface::{self, DesignSurface, about, scale};
use super::tuning::TUNING;
use super::{DesignError, Question};
use crate::applications::allocate::run_simulations;
use crate::methods::Keep;
use crate::model::{Description, Requirement};
use crate::results::{
    Allocation, Bounds, DesignKind, DesignPoint, NotMet, RequirementSummary, Summary, Verdict, foremost,
};
use crate::study::{Kept, Options, RunError, reduced, statistics, subsystems};

/// A point with the study of its worst cases.
#[derive(Clone, Debug)]
pub struct StudiedPoint {
    pub point: Vec<f64>,
    pub merit: Merit,
    /// Margins of all requirements less their errors, the objective's last.
    pub margins: Vec<f64>,
    /// The least margin of the model's requirements as a share of its limit, and how far it may be off.
    pub margin: [f64; 2],
    /// The allocation, if tolerances were allocated.
    pub allocation: Option<Allocation>,
    pub found: DesignPoint,
    /// Simulations of the study.
    pub simulations: usize,
    /// Simulations for a surrogate of its own.
    pub of_surrogate: usize,
}

/// A study at a point; `None` if the mechanism cannot be run there.
pub fn studied(
    question: &Question,
    axes: &Axes,
    point: &[f64],
    kind: DesignKind,
    options: &Options,
) -> Result<Option<StudiedPoint>, DesignError> {
    let options = Options { methods: None, store: None, ..*options };
    let at = axes.at(&question.model, point);
    // Only the verdicts of optima are worth more simulations.
    let is_priced = matches!(question.goal, Goal::Cost(_));
    let study = if kind == DesignKind::Optimum || is_priced { reduced::run } else { subsystems::run };
    let [nominal, found] = [without_tolerances(&at), at].map(|model| margins(question, model, study, &options));
    let (Some(nominal), Some(found)) = (nominal?, found?) else { return Ok(None) };
    let Margins { all, mut requirements, simulations } = found;
    let slacks = |all: &[[f64; 2]]| -> Vec<f64> {
        all.iter().zip(&question.model.requirements).map(|([margin, _], own)| margin / scale(own)).collect()
    };
    let merit = |all: &[[f64; 2]]| {
        let merit = question.goal.merit(&question.goal.counted(axes, point, slacks(all)));
        if is_priced { Merit { value: -axes.price(point), ..merit } } else { merit }
    };
    let of_nominal = merit(&nominal.all).value;
    let sign = if question.is_least { -1.0 } else { 1.0 };
    let at_limits = axes.free.iter().zip(point).filter(|(own, value)| **value <= own.lower || **value >= own.upper);
    requirements.truncate(question.required());
    // The verdicts' margins are sharper than the bounds in the rows.
    let known = requirements.iter().zip(&question.model.requirements);
    let known: Vec<[f64; 2]> =
        known.map(|(found, own)| [found.margin, found.error].map(|part| part / scale(own))).collect();
    let least = known.iter().map(|[margin, _]| *margin).fold(f64::INFINITY, f64::min);
    let leaves_enough =
        known.iter().all(|[margin, error]| margin - error >= question.goal.margin() - TUNING.missed_margin);
    let mut studied = StudiedPoint {
        point: point.to_vec(),
        merit: merit(&all),
        margins: all.iter().map(|[margin, error]| margin - error).collect(),
        margin: [least, known.iter().map(|[_, error]| *error).fold(0.0, f64::max)],
        allocation: None,
        simulations: simulations + nominal.simulations,
        of_surrogate: 0,
        found: DesignPoint {
            kind,
            values: point[..axes.free.len()].to_vec(),
            deviations: axes.deviations(point),
            nominal: sign * of_nominal,
            worst: f64::NAN,
            error: if is_priced { 0.0 } else { error(question, &all) },
            requirements: Vec::new(),
            share: None,
            is_feasible: false,
            at_limits: at_limits.map(|(own, _)| own.name.clone()).collect(),
        },
    };
    studied.found.is_feasible = requirements.iter().all(|own| own.verdict == Verdict::Holds)
        && (leaves_enough || question.goal.margin() == 0.0);
    studied.found.requirements = requirements;
    if let Some(share) = question.share
        && !by_share(question, axes, share, &mut studied, &options)?
    {
        return Ok(None);
    }
    studied.found.worst = sign * studied.merit.value;
    Ok(Some(studied))
}

/// A run of a model, which may refine itself.
type Study = fn(&Description, &Options, Keep) -> Result<(Bounds, Summary, Option<Kept>), RunError>;

/// Margins by a study.
struct Margins {
    /// With their errors, the objective's last.
    all: Vec<[f64; 2]>,
    requirements: Vec<RequirementSummary>,
    simulations: usize,
}

/// Margins of a model at a point. Margins of outputs over time are those of the bounds in the rows, as `mbint run`
/// prints them; verdicts are of peaks between the rows, too.
fn margins(
    question: &Question,
    mut model: Description,
    study: Study,
    options: &Options,
) -> Result<Option<Margins>, DesignError> {
    model.requirements.truncate(question.required());
    let objective = &question.model.requirements[question.required()..];
    // One of reduced outputs is a requirement of the study.
    model.requirements.extend(objective.iter().filter(|own| !is_over_time(own)).cloned());
    let Some((bounds, summary, _)) = checked(study(&model, options, Keep::Nothing), options)? else { return Ok(None) };
    let mut known = summary.requirements.iter();
    let margin = |own: &Requirement| {
        let of_study = known.next();
        if is_over_time(own) {
            let rows = own.outputs.iter().flat_map(|&place| of_rows(&bounds, place));
            return rows.min_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or([f64::NAN; 2]);
        }
        of_study.map_or([f64::NAN; 2], |own| [own.margin, own.error])
    };
    let all = question.model.requirements.iter().map(margin).collect();
    Ok(Some(Margins { all, simulations: run_simulations(&summary), requirements: summary.requirements }))
}

/// Whether a requirement is of outputs of the motion over time.
fn is_over_time(own: &Requirement) -> bool {
    own.times.is_some_and(|(from, to)| from < to) && !own.of_results && !own.outputs.is_empty()
}

/// Lower bounds of an output with their errors, in all rows.
fn of_rows(bounds: &Bounds, output: usize) -> impl Iterator<Item = [f64; 2]> + '_ {
    let output = &bounds.outputs[output];
    let band = foremost(&output.bands, |band| band.error.unresolved_from().is_none());
    let of_row = move |row: usize| match band {
        Some(band) => [band.lower[row], band.error.total[row]],
        None => [output.nominal[row], 0.0],
    };
    (0..bounds.times.len()).map(of_row)
}

/// The result of a run; `None` if the mechanism cannot be run.
fn checked<T>(found: Result<T, RunError>, options: &Options) -> Result<Option<T>, DesignError> {
    match found {
        _ if (options.interrupted)() => Err(DesignError::Interrupted),
        Ok(found) => Ok(Some(found)),
        Err(RunError::Infeasible(_) | RunError::Simulation(_)) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// Error of the objective.
fn error(question: &Question, all: &[[f64; 2]]) -> f64 {
    let mut errors = all.iter().zip(&question.model.requirements).map(|([_, error], of)| error / scale(of));
    match question.goal {
        Goal::Last => errors.next_back().unwrap_or(f64::NAN),
        Goal::Margin | Goal::Cost(_) => errors.fold(0.0, f64::max),
    }
}

/// The same for a share of the production: yields by a study of them, the objective's quantile by a surrogate of the
/// tolerances. Whether there is one.
fn by_share(
    question: &Question,
    axes: &Axes,
    share: f64,
    studied: &mut StudiedPoint,
    options: &Options,
) -> Result<bool, DesignError> {
    let point = studied.point.clone();
    let surface =
        DesignSurface::new(question, axes, &about(&point, &axes.ranges(), TUNING.region_of_quantile), &point, options)?;
    let slacks = question.assessed(&surface)?.slacks(&point);
    studied.of_surrogate = surface.simulations;
    studied.margins = slacks.iter().zip(&surface.scales).map(|(slack, scale)| slack * scale).collect();
    // At least the margin that was asked for: the yield with it was confirmed where tolerances were allocated.
    studied.margin = [question.goal.margin(), 0.0];
    let merit = question.goal.merit(&slacks);
    if let Goal::Cost(_) = question.goal {
        studied.merit.violation = merit.violation;
    } else {
        studied.merit = merit;
        studied.found.error = surface::error(&surface, question.goal);
    }
    let mut at = axes.at(&question.model, &point);
    at.statistics.asked = true;
    at.requirements.truncate(question.required());
    if at.requirements.is_empty() {
        studied.found.is_feasible = true;
        return Ok(true);
    }
    let Some((_, summary)) = checked(statistics::run(&at, 0, options), options)? else { return Ok(false) };
    studied.simulations += run_simulations(&summary);
    let known = summary.statistics.as_ref().map(|found| &found.summary);
    let found = known.and_then(|found| found.together.as_ref().or(found.requirements.first()));
    studied.found.share = found.map(|found| found.interval[0]);
    studied.found.is_feasible = studied.found.share.is_some_and(|found| found >= share);
    Ok(true)
}

/// Requirements that a point does not meet.
pub fn not_met(point: &DesignPoint) -> Vec<NotMet> {
    if point.is_feasible {
        return Vec::new();
    }
    let missed = point.requirements.iter().filter(|own| own.verdict != Verdict::Holds);
    let of = |own: &RequirementSummary| NotMet {
        requirement: own.name.clone(),
        unit: own.unit.clone(),
        display: own.display.clone(),
        margin: own.margin,
        error: own.error,
    };
    missed.map(of).collect()
}
