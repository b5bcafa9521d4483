//! Statistics in addition to the bounds, from the surrogate that a run stores: quantiles over time, mean, standard
//! deviation, and the linearised tolerance stack. Under random excitations they are of simulated motions.

mod beside_bounds;
mod causes;
mod control_variates;
mod laws;
mod motions;
mod numbers;
mod products;
mod realisations;
mod requirements;
mod rows;
mod stack;
pub mod tuning;
mod zones;

use super::answers::Kept;
use super::stepping::is_random;
use super::{Options, RunError, reduced, subsystems};
use crate::methods::{Keep, Method};
use crate::model::{Description, ParameterValue};
use crate::numerics::BandError;
use crate::results::{
    Bounds, LawSummary, OutputStatistics, OutputStatisticsSummary, StatisticsResult, StatisticsSummary, Summary,
};
pub use laws::Laws;
use products::Products;
use rows::Rows;

/// Why there are none.
const INTERRUPTED: &str = "interrupted before statistics were done";

/// Runs every method asked for, and statistics of the first `shown` outputs.
///
/// # Errors
/// As for any run. Where statistics alone fail, the summary says why.
pub fn run(description: &Description, shown: usize, options: &Options) -> Result<(Bounds, Summary), RunError> {
    // Without a stored surrogate, linear sums use the derivatives.
    let derivatives = options.derivatives || shown > 0;
    let asked = Options { methods: options.methods.clone(), derivatives, ..*options };
    // Random motions meet more events than polynomials between them follow: they are not cut.
    let keep = if is_random(description) { Keep::WholeBox } else { Keep::Statistics };
    let (mut bounds, mut summary, kept) = reduced::run(description, &asked, keep)?;
    let found = match &kept {
        _ if (options.interrupted)() => Err(INTERRUPTED.to_owned()),
        _ if is_random(description) => motions::of_motions(description, shown, options),
        Some(kept) if has_numbers(description, kept) => of_run(description, shown, options, &bounds, kept),
        _ if options.skip_infeasible => Err("there is no surrogate over the whole box".to_owned()),
        _ => beside_bounds::of_motions(description, shown, options, &bounds),
    };
    let found = found.unwrap_or_else(|failure| StatisticsResult {
        times: Vec::new(),
        outputs: Vec::new(),
        summary: StatisticsSummary { failure: Some(failure), ..StatisticsSummary::default() },
    });
    if (options.interrupted)() {
        summary.failure.get_or_insert_with(|| INTERRUPTED.to_owned());
    }
    summary.statistics = Some(Box::new(found));
    if !options.derivatives {
        bounds.derivatives.clear();
    }
    Ok((bounds, summary))
}

/// Whether reduced outputs and margins need no simulated motions: motions are not cut at events, or a run stored
/// surrogates of all of them.
fn has_numbers(description: &Description, kept: &Kept) -> bool {
    let reduced = description.reduced.is_empty() || kept.reduced(description.reduced.len()).is_some();
    let margins = description.requirements.is_empty() || kept.margins().is_some();
    !kept.is_cut() || (reduced && margins)
}

/// Statistics of the surrogates that a run stored; if a law reaches beyond the box, of a surrogate over a wider one.
fn of_run(
    description: &Description,
    shown: usize,
    options: &Options,
    bounds: &Bounds,
    kept: &Kept,
) -> Result<StatisticsResult, String> {
    let mut laws = Laws::of(description)?;
    let mut simulations = 0;
    let mut wide = None;
    let mut note = None;
    if laws.reach_beyond() {
        laws.widen();
        let wider = description.over(laws.drawn());
        let methods = Some(vec![Method::Chebyshev]);
        let options = Options { methods, threads: options.threads, ..quiet(options) };
        match subsystems::run(&wider, &options, Keep::Statistics) {
            Ok((_, summary, Some(found))) if follows(description, kept, &found) => {
                simulations = summary.methods.iter().map(|method| method.simulations).sum();
                wide = Some(found);
            }
            found => {
                let why = match found {
                    Err(error) => error.to_string(),
                    Ok((_, summary, _)) => {
                        summary.failure.unwrap_or_else(|| "the surrogate does not follow the outputs".to_owned())
                    }
                };
                note = Some(format!("laws are cut off at the ends of their intervals, since beyond them: {why}"));
            }
        }
        if wide.is_none() {
            laws.cut_off();
        }
    }
    let kept = wide.as_ref().unwrap_or(kept);
    let rows = Rows::new(description, options, &laws, kept)?.with_products(shown)?;
    let outputs = rows.outputs(shown)?;
    let (requirements, together) = requirements::all(&rows)?;
    let reduced = numbers::all(&rows)?;
    let summary = StatisticsSummary {
        samples: rows.samples(),
        parameters: laws.summaries(),
        quantiles: description.statistics.quantiles.clone(),
        left_out: laws.left_out(),
        outside: laws.outside(),
        simulations,
        products: rows.products.as_ref().map(Products::count),
        outputs: outputs.iter().filter_map(|(index, output)| side_by_side(&rows, bounds, *index, output)).collect(),
        reduced,
        requirements,
        together,
        random: None,
        failure: note,
    };
    let outputs = outputs.into_iter().map(|(_, output)| output).collect();
    Ok(StatisticsResult { times: kept.times().to_vec(), outputs, summary })
}

/// Whether a surrogate over a wider box is known and resolved wherever that of the box is.
fn follows(description: &Description, kept: &Kept, wider: &Kept) -> bool {
    let good = |error: &BandError, row: usize| !error.unresolved[row] && error.total[row].is_finite();
    let of_output = |output: usize| {
        (0..kept.times().len()).all(|row| good(wider.error(output), row) || !good(kept.error(output), row))
    };
    wider.times().len() >= kept.times().len() && (0..description.outputs.len()).all(of_output)
}

/// Options of a second run: the interruption alone.
fn quiet<'a>(options: &Options<'a>) -> Options<'a> {
    Options { interrupted: options.interrupted, ..Options::default() }
}

/// Worst case, root sum square and statistics at the time at which the standard deviation is largest.
fn side_by_side(
    rows: &Rows,
    bounds: &Bounds,
    index: usize,
    output: &OutputStatistics,
) -> Option<OutputStatisticsSummary> {
    let known = (0..output.deviation.len()).filter(|&row| output.deviation[row].value.is_finite());
    let row = known.max_by(|&a, &b| output.deviation[a].value.total_cmp(&output.deviation[b].value).then(b.cmp(&a)))?;
    let of_bounds = &bounds.outputs[index];
    let band = of_bounds.bands.iter().find(|band| band.method == Method::Chebyshev)?;
    let is_stack = stack::is_stack(rows.description, &output.name);
    Some(OutputStatisticsSummary {
        output: output.name.clone(),
        unit: output.unit.clone(),
        display: None,
        time: *bounds.times.get(row)?,
        worst_case: [band.lower[row], band.upper[row]],
        worst_case_error: band.error.total[row],
        nominal: of_bounds.nominal[row],
        linear: output.linear[row],
        rss: output.rss[row],
        mean: output.mean[row],
        deviation: output.deviation[row],
        quantiles: output.quantiles.iter().map(|values| values[row]).collect(),
        sensitivities: if is_stack { stack::sensitivities(rows, row, index) } else { Vec::new() },
        histogram: if is_stack { stack::histogram(rows, row, index) } else { None },
    })
}

/// A model's laws, as far as they reach.
///
/// # Errors
/// If nothing is uncertain.
pub fn laws(description: &Description) -> Result<Laws, String> {
    let mut laws = Laws::of(description)?;
    laws.widen();
    Ok(laws)
}

/// Largest deviation by the law of a parameter, in multiples of its tolerance.
pub fn reach(description: &Description, name: &str) -> f64 {
    let Some((_, [nominal, lower, upper])) = intervals(description).find(|(known, _)| *known == name) else {
        return 1.0;
    };
    let law = description.statistics.law(name, lower, upper);
    let ends = laws::ends(&law, (lower, upper));
    ((ends.1 - nominal) / (upper - nominal)).max((nominal - ends.0) / (nominal - lower)).max(1.0)
}

/// The uncertain parameters: name, and nominal, least and largest value.
fn intervals(description: &Description) -> impl Iterator<Item = (&str, [f64; 3])> {
    description.parameters.iter().filter_map(|parameter| match parameter.value {
        ParameterValue::Interval { nominal, lower, upper } => Some((parameter.name.as_str(), [nominal, lower, upper])),
        ParameterValue::Formula(_) => None,
    })
}

/// A law as it is printed.
fn law_summary(name: &str, law: &crate::model::Law, (lower, upper): (f64, f64)) -> LawSummary {
    LawSummary {
        parameter: name.to_owned(),
        distribution: law.distribution.name().to_owned(),
        mean: law.distribution.mean(),
        deviation: law.distribution.deviation(),
        tolerance_is_three_sigma: law.by_tolerance,
        outside: law.distribution.outside(lower, upper),
    }
}
