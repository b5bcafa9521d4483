//! Studies at points: the figures that are printed.

use super::axes::{Axes, without_tolerances};
use super::goal::{Goal, Merit};
use super::surface::{self, Surface, about, scale};
use super::{DesignError, Question};
use crate::model::{Description, Requirement};
use crate::results::{Bounds, DesignKind, DesignPoint, NotMet, RequirementSummary, Summary, Verdict, foremost};
use crate::study::allocate::run_simulations;
use crate::study::{Kept, Options, RunError, reduced, statistics, subsystems};

/// Half of the region, as a share of the ranges, of the surrogate of which a quantile is told.
const QUANTILE: f64 = 1e-3;

/// A point with the study of its worst cases.
#[derive(Clone, Debug)]
pub struct Studied {
    pub point: Vec<f64>,
    pub merit: Merit,
    /// Margins of all requirements less their errors, the objective's last.
    pub margins: Vec<f64>,
    pub found: DesignPoint,
    /// Simulations of the study.
    pub simulations: usize,
    /// Simulations for a surrogate of its own.
    pub of_surrogate: usize,
}

/// A study at a point; `None` where the mechanism cannot be run there.
pub fn studied(
    question: &Question,
    axes: &Axes,
    point: &[f64],
    kind: DesignKind,
    options: &Options,
) -> Result<Option<Studied>, DesignError> {
    let options = Options { methods: None, store: None, ..*options };
    let at = axes.at(&question.model, point);
    // Only the verdicts of optima are worth more simulations.
    let study = if kind == DesignKind::Optimum { reduced::run } else { subsystems::run };
    let [nominal, found] = [without_tolerances(&at), at].map(|model| margins(question, model, study, &options));
    let (Some(nominal), Some(found)) = (nominal?, found?) else { return Ok(None) };
    let Margins { all, mut requirements, simulations } = found;
    let slacks = |all: &[[f64; 2]]| -> Vec<f64> {
        all.iter().zip(&question.model.requirements).map(|([margin, _], own)| margin / scale(own)).collect()
    };
    let of_nominal = question.goal.merit(&slacks(&nominal.all)).value;
    let sign = if question.is_least { -1.0 } else { 1.0 };
    let at_limits = axes.free.iter().zip(point).filter(|(own, value)| **value <= own.lower || **value >= own.upper);
    let mut studied = Studied {
        point: point.to_vec(),
        merit: question.goal.merit(&slacks(&all)),
        margins: all.iter().map(|[margin, error]| margin - error).collect(),
        simulations: simulations + nominal.simulations,
        of_surrogate: 0,
        found: DesignPoint {
            kind,
            values: point.to_vec(),
            deviations: axes.deviations(point),
            nominal: sign * of_nominal,
            worst: f64::NAN,
            error: error(question, &all),
            requirements: Vec::new(),
            share: None,
            is_feasible: false,
            at_limits: at_limits.map(|(own, _)| own.name.clone()).collect(),
        },
    };
    requirements.truncate(question.required());
    studied.found.is_feasible = requirements.iter().all(|own| own.verdict == Verdict::Holds);
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
type Study = fn(&Description, &Options, bool) -> Result<(Bounds, Summary, Option<Kept>), RunError>;

/// Margins by a study.
struct Margins {
    /// With their errors, the objective's last.
    all: Vec<[f64; 2]>,
    requirements: Vec<RequirementSummary>,
    simulations: usize,
}

/// Those of a model at a point. Margins of outputs over time are those of the bounds in the rows, as `mbint run` prints
/// them; verdicts are of peaks between the rows, too.
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
    let Some((bounds, summary, _)) = checked(study(&model, options, false), options)? else { return Ok(None) };
    let mut known = summary.requirements.iter();
    let margin = |own: &Requirement| {
        let of_study = known.next();
        if is_over_time(own) {
            let rows = own.places.iter().flat_map(|&place| of_rows(&bounds, place));
            return rows.min_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or([f64::NAN; 2]);
        }
        of_study.map_or([f64::NAN; 2], |own| [own.margin, own.error])
    };
    let all = question.model.requirements.iter().map(margin).collect();
    Ok(Some(Margins { all, simulations: run_simulations(&summary), requirements: summary.requirements }))
}

/// Whether a requirement is of outputs of the motion over time.
fn is_over_time(own: &Requirement) -> bool {
    own.times.is_some_and(|(from, to)| from < to) && !own.of_results && !own.places.is_empty()
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

/// The result of a run; `None` where the mechanism cannot be run.
fn checked<T>(found: Result<T, RunError>, options: &Options) -> Result<Option<T>, DesignError> {
    match found {
        _ if (options.interrupted)() => Err(DesignError::Interrupted),
        Ok(found) => Ok(Some(found)),
        Err(RunError::Infeasible(_) | RunError::Simulation(_)) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// How far the objective may be off.
fn error(question: &Question, all: &[[f64; 2]]) -> f64 {
    let mut errors = all.iter().zip(&question.model.requirements).map(|([_, error], of)| error / scale(of));
    match question.goal {
        Goal::Last => errors.next_back().unwrap_or(f64::NAN),
        Goal::Margin => errors.fold(0.0, f64::max),
    }
}

/// The same for a share of the production: yields by a study of them, the objective's quantile by a surrogate of the
/// tolerances. Whether there is one.
fn by_share(
    question: &Question,
    axes: &Axes,
    share: f64,
    studied: &mut Studied,
    options: &Options,
) -> Result<bool, DesignError> {
    let point = studied.point.clone();
    let surface = Surface::new(question, axes, &about(&point, &axes.ranges(), QUANTILE), &point, options)?;
    let slacks = question.assessed(&surface)?.slacks(&point);
    studied.of_surrogate = surface.simulations;
    studied.merit = question.goal.merit(&slacks);
    studied.margins = slacks.iter().zip(&surface.scales).map(|(slack, scale)| slack * scale).collect();
    studied.found.error = surface::error(&surface, question.goal);
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
