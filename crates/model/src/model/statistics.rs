//! `statistics:`, and the laws of parameters that have none of their own.

use super::description::{Analysis, Correlation, ParameterValue};
use super::parameters::law::{LawInterval, named};
use super::tuning::TUNING;
use crate::grammar::mentions::NameKind;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::grammar::unit::number_and_unit;
use crate::keys;
use crate::model::names::Reader;
use crate::numerics::statistics::Copula;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Node, Value};

/// Shares below the quantiles where none are named: the ends of ±3σ of a normal law, and the median.
const QUANTILES: [f64; 3] = [0.00135, 0.5, 0.99865];

/// Samples that can be asked for.
const SAMPLES: std::ops::RangeInclusive<usize> = 1 << 10..=1 << 24;

/// Reads the section, and completes the laws that parameters give.
pub fn read(reader: &mut Reader, section: Option<(&Node, Span)>) {
    (reader.model.statistics.quantiles, reader.model.statistics.seed) = (QUANTILES.to_vec(), TUNING.seed);
    // A stack is asked for its distribution, too.
    let is_stack = reader.model.analysis == Analysis::Dimensions || !reader.model.chains.is_empty();
    let is_uncertain = reader.model.uncertain().next().is_some() && reader.model.bounds.chebyshev.is_some();
    reader.model.statistics.asked |= is_stack && is_uncertain;
    let Some((node, at)) = section else { return };
    let Some(fields) = reader.fields::<keys::Statistics>(node, at) else { return };
    reader.model.statistics.asked = true;
    if let Some(node) = fields.get("samples") {
        reader.model.statistics.samples = reader.count(node, *SAMPLES.start(), *SAMPLES.end());
    }
    if let Some(node) = fields.get("seed") {
        reader.model.statistics.seed = reader.count(node, 0, TUNING.most_seeds).unwrap_or(TUNING.seed);
    }
    if let Some(node) = fields.get("exposure") {
        exposure(reader, node);
    }
    if let Some(node) = fields.get("quantiles") {
        quantiles(reader, node);
    }
    if let Some(node) = fields.get("distribution") {
        default_law(reader, node);
    }
    if let Some(node) = fields.get("correlation") {
        correlations(reader, node);
    }
}

/// A time of which motions are parts.
fn exposure(reader: &mut Reader, node: &Node) {
    let Some(time) = reader.number(node, Dimension::TIME) else { return };
    if reader.model.trajectories.iter().all(|own| own.random().is_none()) {
        reader.error(
            Code::BadStatistics,
            node.span.clone(),
            "without random excitations, motions do not fail one by one",
            None,
        );
    } else if time <= 0.0 {
        reader.error(Code::OutOfRange, node.span.clone(), format!("a time of {time} s is not positive"), None);
    } else {
        reader.model.statistics.exposure = Some(time);
    }
}

fn quantiles(reader: &mut Reader, node: &Node) {
    let Value::Sequence(items) = &node.value else {
        reader.error(
            Code::BadStatistics,
            node.span.clone(),
            "quantiles are a list of shares",
            "e.g. `[5%, 50%, 95%]`".to_owned(),
        );
        return;
    };
    let mut shares = Vec::new();
    for item in items {
        let Some(scalar) = reader.scalar(item, "a share") else { return };
        // 99.9 % is 0.999, and not 0.9990000000000001.
        let percent = number_and_unit(&scalar.text)
            .filter(|(_, unit, _)| *unit == "%")
            .map(|(value, ..)| (value * 1e13).round() / 1e15);
        let share = percent.or_else(|| scalar.text.parse().ok()).filter(|share| *share > 0.0 && *share < 1.0);
        let Some(share) = share else {
            let message = format!("`{}` is not a share above 0 and below 1", clip(&scalar.text));
            reader.error(Code::OutOfRange, item.span.clone(), message, "e.g. `95%` or `0.95`".to_owned());
            return;
        };
        shares.push(share);
    }
    shares.sort_by(f64::total_cmp);
    shares.dedup();
    reader.model.statistics.quantiles = shares;
}

/// The law of every uncertain parameter that has none of its own.
fn default_law(reader: &mut Reader, node: &Node) {
    let Some(scalar) = reader.scalar(node, "the name of a distribution") else { return };
    let known = reader.model.statistics.laws.clone();
    let uncertain: Vec<(String, LawInterval)> = reader
        .model
        .uncertain()
        .filter_map(|(_, parameter)| match parameter.value {
            ParameterValue::Interval { nominal, lower, upper } => {
                Some((parameter.name.clone(), LawInterval { nominal, lower, upper, written: None }))
            }
            ParameterValue::Formula(_) => None,
        })
        .filter(|(name, _)| !known.iter().any(|(known, _)| known == name))
        // A zone has a joint law of its own.
        .filter(|(name, _)| !reader.model.zones.iter().any(|zone| zone.members.contains(name)))
        .collect();
    let anywhere = LawInterval { nominal: 0.0, lower: -1.0, upper: 1.0, written: None };
    if named(&scalar.text, anywhere).is_none() {
        let names = ["uniform", "normal", "truncated_normal", "triangular"];
        let message = format!("`{}` is no distribution that needs no numbers", clip(&scalar.text));
        reader.error(Code::UnknownWord, node.span.clone(), message, format!("those are {}", suggest::list(&names)));
        return;
    }
    let laws = uncertain.into_iter().filter_map(|(name, place)| Some((name, named(&scalar.text, place)?)));
    reader.model.statistics.laws.extend(laws.collect::<Vec<_>>());
}

fn correlations(reader: &mut Reader, node: &Node) {
    let Value::Sequence(items) = &node.value else {
        let help = "e.g. `[{ of: [a, b], coefficient: 0.8 }]`".to_owned();
        reader.error(Code::BadCorrelation, node.span.clone(), "correlations are a list of groups", help);
        return;
    };
    for item in items {
        let Some(fields) = reader.fields::<keys::CorrelationFile>(item, item.span.clone()) else { continue };
        if let Some(correlation) = correlation(reader, &fields) {
            reader.model.statistics.correlations.push(correlation);
        }
    }
}

fn correlation(reader: &mut Reader, fields: &Fields) -> Option<Correlation> {
    let of = reader.required(fields, "of")?;
    let names = names(reader, of)?;
    let k = names.len();
    let matrix = match (fields.get("coefficient"), fields.get("matrix")) {
        (Some(node), None) => {
            let coefficient = coefficient(reader, node)?;
            (0..k).map(|i| (0..k).map(|j| if i == j { 1.0 } else { coefficient }).collect()).collect()
        }
        (None, Some(node)) => matrix(reader, node, k)?,
        _ if !fields.lacks_all(&["coefficient", "matrix"]) => return None,
        _ => {
            reader.error(
                Code::BadCorrelation,
                fields.at.clone(),
                "a correlation needs `coefficient` or `matrix`",
                None,
            );
            return None;
        }
    };
    if Copula::new(&matrix).is_err() {
        let help = "the matrix is not positive definite: if a goes with b and b with c, a goes with c".to_owned();
        reader.error(Code::BadCorrelation, of.span.clone(), "no random numbers are correlated like this", help);
        return None;
    }
    Some(Correlation { names, matrix })
}

fn names(reader: &mut Reader, node: &Node) -> Option<Vec<String>> {
    let Value::Sequence(items) = &node.value else {
        reader.error(
            Code::BadCorrelation,
            node.span.clone(),
            "a list of parameters belongs here",
            "e.g. `[a, b]`".to_owned(),
        );
        return None;
    };
    let uncertain: Vec<String> = reader.model.uncertain().map(|(_, parameter)| parameter.name.clone()).collect();
    let taken: Vec<String> =
        reader.model.statistics.correlations.iter().flat_map(|group| group.names.iter().cloned()).collect();
    let mut names: Vec<String> = Vec::new();
    for item in items {
        let name = reader.scalar(item, "the name of a parameter")?.text.clone();
        reader.mentions_node(Some(NameKind::Parameter), item);
        if !uncertain.contains(&name) {
            let message = format!("`{}` is no uncertain parameter", clip(&name));
            let help = suggest::help(&name, "uncertain parameters", uncertain.iter().map(String::as_str));
            reader.error(Code::BadCorrelation, item.span.clone(), message, help);
            return None;
        }
        if names.contains(&name) || taken.contains(&name) {
            let help = "give one matrix for all that depend on each other".to_owned();
            reader.error(
                Code::BadCorrelation,
                item.span.clone(),
                format!("`{name}` stands in a correlation already"),
                help,
            );
            return None;
        }
        names.push(name);
    }
    if names.len() < 2 {
        reader.error(Code::BadCorrelation, node.span.clone(), "a correlation is one of two parameters at least", None);
        return None;
    }
    Some(names)
}

fn coefficient(reader: &mut Reader, node: &Node) -> Option<f64> {
    let scalar = reader.scalar(node, "a correlation coefficient")?;
    let number = scalar.text.parse::<f64>().ok().filter(|number| (-1.0..=1.0).contains(number));
    if number.is_none() {
        let message = format!("`{}` is no number from -1 to 1", clip(&scalar.text));
        reader.error(Code::BadCorrelation, node.span.clone(), message, None);
    }
    number
}

fn matrix(reader: &mut Reader, node: &Node, k: usize) -> Option<Vec<Vec<f64>>> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    if let Value::Sequence(items) = &node.value {
        for item in items {
            let Value::Sequence(numbers) = &item.value else { break };
            rows.push(numbers.iter().map(|number| coefficient(reader, number)).collect::<Option<_>>()?);
        }
    }
    if rows.len() != k || rows.iter().any(|row| row.len() != k) {
        reader.error(
            Code::BadCorrelation,
            node.span.clone(),
            format!("a matrix of {k} rows of {k} numbers belongs here"),
            None,
        );
        return None;
    }
    let symmetric = (0..k).all(|i| rows[i][i] == 1.0 && (0..i).all(|j| rows[i][j] == rows[j][i]));
    if !symmetric {
        reader.error(
            Code::BadCorrelation,
            node.span.clone(),
            "a matrix of correlations is symmetric, with ones on its diagonal",
            None,
        );
        return None;
    }
    Some(rows)
}
