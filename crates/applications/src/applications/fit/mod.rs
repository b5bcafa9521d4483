//! Parameters that agree with measured values.
//!
//! `data` reads a table. A run over the model's box gives surrogates of the outputs, with their errors, which
//! `readings` evaluates at measured times and `local` makes polynomials of, along skew axes.
//! `least_squares` estimates on them; the last residuals are those of simulations. `set` paves the set of all
//! consistent parameters, with runs over narrower boxes as it shrinks; `projections` are its shadows on pairs of
//! parameters. Where it is empty, `unexplained` finds the rows that no parameters explain.

mod data;
mod least_squares;
mod local;
mod projections;
mod readings;
mod set;
pub(crate) mod tuning;
mod unexplained;

pub use data::{DataError, Measurements, NoiseBound};

use crate::numerics::Interpolation;
use least_squares::{DEVIATION, Minimum, is_short, linearised, minimum};
use local::{Local, SkewAxes, values};
use readings::{Finer, SurrogateRun};
use set::Set;
use unexplained::unexplained;

use crate::model::Description;
use crate::numerics::{ParameterBox, Sample};
use crate::results::{Fit, FitOutput, FitParameter, FitRow};
use crate::study::{ChosenSamples, Options, RunError, pool, sample, uncertain};
use crate::syntax::{Code, Coded};
use tuning::TUNING;

/// Why there is no fit.
#[derive(Debug, thiserror::Error)]
pub enum FitError {
    /// The model cannot be run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Nothing to determine.
    #[error("no parameter is uncertain: give an interval or a tolerance to those that the data are to determine")]
    NoParameter,
    /// The outputs are not known over the whole box.
    #[error(
        "the outputs have no reliable surrogate over the parameters' box: narrow the intervals, or see `mbint run`"
    )]
    NoSurrogate,
    /// It was asked to stop.
    #[error("interrupted before there was a result")]
    Interrupted,
}

/// Finds the parameters, within the model's intervals, that agree with measured values.
///
/// # Errors
/// If the model cannot be run over its box, and at an interruption.
pub fn fit(description: &Description, measurements: &Measurements, options: &Options) -> Result<Fit, FitError> {
    if description.uncertain().next().is_none() {
        return Err(FitError::NoParameter);
    }
    let mut model = description.clone();
    // Questions other than those of the data.
    model.reduced.clear();
    model.requirements.clear();
    model.statistics.asked = false;
    // Rows at the measured times need no interpolation.
    if let Some(step) = measurements.row_step(&model.simulation) {
        model.simulation.output_step = step;
    }
    let pool = pool(options.threads);
    pool.map_err(RunError::from)?.install(|| fitted(&model, measurements, options))
}

fn fitted(model: &Description, measurements: &Measurements, options: &Options) -> Result<Fit, FitError> {
    let (parameters, prior) = uncertain(model);
    let k = prior.dimension();
    (options.stage)("surrogates");
    let run = SurrogateRun::new(model, &prior, Finer::default(), options)?;
    let mut simulations = run.simulations;
    let (mut set, mut is_empty, mut errors) = (None, false, None);
    if k <= Fit::MOST_PARAMETERS {
        let found = set::found(model, measurements, &prior, &run, options)?;
        simulations += found.simulations;
        (is_empty, errors, set) = (found.set.is_none(), found.errors, found.set);
    }
    (options.stage)("least squares");
    let hull = set.as_ref().map(Set::hull);
    let minimum = minimum(model, measurements, &prior, around(hull.as_deref(), k), options)?;
    simulations += minimum.simulations;
    let estimate = polished(model, measurements, &prior, &minimum, options)?;
    let covariance = linearised(&minimum.local, measurements, &estimate.eta).covariance();
    let xi = minimum.frame.xi(&estimate.eta);
    let contradiction = if is_empty {
        (options.stage)("rows without an explanation");
        let readings = run.readings(measurements)?.strict(true);
        let whole = Local::new(&readings, &SkewAxes::whole(k), &prior, measurements, TUNING.coarse)?;
        Some(unexplained(&whole, &minimum.local, measurements, options.interrupted))
    } else {
        None
    };
    let errors = errors.unwrap_or_else(|| minimum.local.errors.clone());
    let inner = set.as_ref().and_then(Set::inner_hull);
    let middle = set.as_ref().map(Set::middle);
    let names: Vec<String> = parameters.iter().map(|own| own.name.clone()).collect();
    let of = |axis: usize| {
        let own = &parameters[axis];
        let at = |xi: f64| local::value(&prior, axis, xi);
        FitParameter {
            name: own.name.clone(),
            unit: own.unit.clone(),
            display: own.display.clone(),
            prior: [own.lower, own.upper],
            estimate: at(xi[axis]),
            deviation: prior.half_width(axis) * minimum.frame.reach()[axis] * covariance.deviations[axis],
            hull: hull.as_ref().map(|hull| hull[axis].map(at)),
            inner: inner.as_ref().map(|hull| hull[axis].map(at)),
            middle: middle.as_ref().map(|middle| at(middle[axis])),
        }
    };
    let (outputs, rows) = rows(model, measurements, &estimate.fitted, &errors);
    Ok(Fit {
        model: model.name.clone(),
        outputs,
        parameters: (0..k).map(of).collect(),
        residual: estimate.residual,
        rows,
        correlations: covariance.correlations,
        set: set.zip(hull).map(|(set, hull)| set.described(&prior, &names, &hull)),
        unexplained: contradiction,
        simulations,
    })
}

/// Start of least squares: about the hull of the consistent set, which their estimate may lie outside of, or the
/// model's box.
fn around(hull: Option<&[[f64; 2]]>, k: usize) -> SkewAxes {
    let Some(hull) = hull else { return SkewAxes::whole(k) };
    let middle: Vec<f64> = hull.iter().map(|[lower, upper]| 0.5 * (lower + upper)).collect();
    let halves: Vec<f64> = hull.iter().map(|[lower, upper]| 0.5 * TUNING.around * (upper - lower)).collect();
    SkewAxes::around(&middle, &halves)
}

/// Measured outputs and values.
fn rows(
    model: &Description,
    measurements: &Measurements,
    fitted: &[f64],
    errors: &[f64],
) -> (Vec<FitOutput>, Vec<FitRow>) {
    let mut measured: Vec<usize> = measurements.values.iter().map(|row| row.output).collect();
    measured.sort_unstable();
    measured.dedup();
    let output = |&index: &usize| {
        let own = &model.outputs[index];
        let display = model.display.get(&own.name).cloned();
        FitOutput { name: own.name.clone(), unit: own.unit.clone(), display }
    };
    let row = |(index, own): (usize, &data::Measured)| FitRow {
        line: own.line,
        time: own.time,
        output: measured.partition_point(|other| *other < own.output),
        measured: own.value,
        noise: own.noise,
        fitted: fitted[index],
        error: errors[index],
    };
    (measured.iter().map(output).collect(), measurements.values.iter().enumerate().map(row).collect())
}

/// The least-squares estimate.
struct Estimate {
    /// In the frame of the minimum on the surrogate.
    eta: Vec<f64>,
    /// Simulated at measured rows, SI.
    fitted: Vec<f64>,
    /// Root mean square in multiples of the noise bounds.
    residual: f64,
}

/// Gauss and Newton with residuals of simulations, from the minimum on the surrogate.
fn polished(
    model: &Description,
    measurements: &Measurements,
    prior: &ParameterBox,
    minimum: &Minimum,
    options: &Options,
) -> Result<Estimate, FitError> {
    let Minimum { frame, local, eta, .. } = minimum;
    let simulated = |eta: Vec<f64>| -> Result<Estimate, FitError> {
        let fitted = simulated(model, measurements, &values(prior, &frame.xi(&eta)), options)?;
        let residuals = fitted.iter().zip(&measurements.values).map(|(own, row)| (own - row.value) / row.noise);
        let known: Vec<f64> = residuals.filter(|own| own.is_finite()).collect();
        let squares: f64 = known.iter().map(|own| own * own).sum();
        Ok(Estimate { eta, fitted, residual: (squares / known.len().max(1) as f64).sqrt() })
    };
    let mut best = simulated(eta.clone())?;
    for _ in 0..TUNING.polishing_steps {
        let mut here = linearised(local, measurements, &best.eta);
        for (residual, &row) in here.residuals.iter_mut().zip(&local.rows) {
            let measured = &measurements.values[row];
            let own = (best.fitted[row] - measured.value) / (DEVIATION * measured.noise);
            *residual = if own.is_finite() { own } else { 0.0 };
        }
        let next = here.step(&best.eta, 0.0);
        if is_short(&best.eta, &next, &here.covariance().deviations) {
            break;
        }
        let found = simulated(next)?;
        if found.residual >= best.residual {
            break;
        }
        best = found;
    }
    Ok(best)
}

/// Values of measured rows at one point; NaN if the motion ends before, and between rows next to an impact.
fn simulated(
    model: &Description,
    measurements: &Measurements,
    point: &[f64],
    options: &Options,
) -> Result<Vec<f64>, FitError> {
    let point = Sample::from(point.to_vec());
    let chosen = ChosenSamples { count: 1, at: &|_| vec![point.clone()] };
    let options = Options { methods: None, store: None, ..*options };
    sample(model, &options, chosen, |trajectories| {
        let mut values = Vec::new();
        let done = trajectories.each(|found| {
            values.extend_from_slice(found);
            Ok::<(), FitError>(())
        })?;
        done.ok_or(FitError::Interrupted)?;
        let (times, width) = (&trajectories.times, trajectories.outputs.len());
        let has_switches = trajectories.has_switches();
        let of = |row: &data::Measured| {
            let Some(found) = Interpolation::new(times, row.time) else { return f64::NAN };
            let sum = |weights: &[(usize, f64)]| -> f64 {
                weights.iter().map(|(index, weight)| weight * values[index * width + row.output]).sum()
            };
            let value = sum(&found.fine);
            let is_beside_impact = |side: &Vec<(usize, f64)>| (sum(side) - value).abs() > row.noise;
            let is_unknown = has_switches && found.sides(times, row.time).iter().any(is_beside_impact);
            if is_unknown { f64::NAN } else { value }
        };
        Ok(measurements.values.iter().map(of).collect())
    })
}

impl Coded for FitError {
    fn code(&self) -> Option<Code> {
        match self {
            Self::Run(error) => error.code(),
            Self::NoParameter => Some(Code::NoParameter),
            Self::NoSurrogate => Some(Code::Unanswerable),
            Self::Interrupted => None,
        }
    }
}
