//! `bounds:`.

use std::collections::HashMap;

use super::file;
use crate::grammar::quantity::Dimension;
use crate::grammar::reader::Fields;
use crate::methods::{BoundsRequest, Budget, Chebyshev, Degree, Expand, MOST_SIMULATIONS, Scan, Taylor};
use crate::model::names::Reader;
use crate::numerics::RangeKind;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Node, Value};

/// Coefficients of a Taylor polynomial.
const MOST_COEFFICIENTS: f64 = 1e5;

/// Errors below this share of an output's range drown in rounding.
const LEAST_TOLERANCE: f64 = 1e-8;

const MOST_ORDER: usize = 200;
const MOST_NODES: usize = 1000;
const MOST_POINTS: usize = 1_000_000;

const RANGES: [(&str, RangeKind); 2] = [("tight", RangeKind::Tight), ("interval", RangeKind::Interval)];

const EXPAND: [(&str, Expand); 2] = [("coordinates", Expand::Coordinates), ("output", Expand::Output)];

/// Reads the section; without one, Chebyshev bounds of order 5.
pub fn read(reader: &mut Reader, section: Option<(&Node, Span)>) -> Option<BoundsRequest> {
    let uncertain: Vec<String> = reader
        .model
        .uncertain()
        .map(|(_, parameter)| parameter.name.clone())
        .filter(|name| !reader.idle.contains(name))
        .collect();
    let Some((node, at)) = section else {
        let chebyshev = Chebyshev::unspecified(uncertain.len(), None);
        return Some(BoundsRequest { chebyshev: Some(chebyshev), ..BoundsRequest::default() });
    };
    let fields = reader.fields::<file::Bounds>(node, at.clone())?;
    if uncertain.is_empty() && !reader.diagnostics.has_errors() {
        let warning = Diagnostic::warning(at, "no parameter is uncertain: the bounds will all be the nominal motion");
        let help = "give a parameter a `tolerance` or an `interval`".to_owned();
        reader.diagnostics.push(warning.help(help));
    }
    let mut request = BoundsRequest { tolerance: tolerance(reader, &fields), ..BoundsRequest::default() };
    if let Some(node) = fields.get("budget")
        && let Some(fields) = reader.fields::<file::Budget>(node, fields.key_span("budget"))
    {
        request.budget = budget(reader, &fields);
    }
    let methods = ["chebyshev", "taylor", "scan"];
    if fields.get("tolerance").is_some() && methods.iter().all(|method| fields.get(method).is_none()) {
        request.chebyshev = Some(Chebyshev::ADAPTIVE);
    }
    if let Some(node) = fields.get("chebyshev")
        && let Some(fields) = reader.fields::<file::Chebyshev>(node, fields.key_span("chebyshev"))
    {
        request.chebyshev = chebyshev(reader, &fields, &uncertain, request.tolerance);
    }
    if let Some(node) = fields.get("taylor")
        && let Some(fields) = reader.fields::<file::Taylor>(node, fields.key_span("taylor"))
    {
        request.taylor = taylor(reader, &fields, uncertain.len());
    }
    if let Some(node) = fields.get("scan")
        && let Some(fields) = reader.fields::<file::Scan>(node, fields.key_span("scan"))
    {
        request.scan = scan(reader, &fields, &uncertain);
    }
    Some(request)
}

fn tolerance(reader: &mut Reader, fields: &Fields) -> Option<f64> {
    let node = fields.get("tolerance")?;
    let tolerance = reader.number(node, Dimension::NUMBER)?;
    if !(LEAST_TOLERANCE..1.0).contains(&tolerance) {
        let message = format!("a tolerance of {tolerance} is not from {LEAST_TOLERANCE:e} to below 1");
        let help = "it is relative to how far an output ranges: 1e-3 is a thousandth of that".to_owned();
        reader.error(node.span.clone(), message, help);
        return None;
    }
    Some(tolerance)
}

fn budget(reader: &mut Reader, fields: &Fields) -> Budget {
    let mut budget = Budget::default();
    if let Some(solves) = fields.get("solves").and_then(|node| reader.count(node, 1, MOST_SIMULATIONS as usize)) {
        budget.solves = solves;
    }
    if let Some(node) = fields.get("seconds")
        && let Some(seconds) = reader.number(node, Dimension::TIME)
    {
        if seconds <= 0.0 {
            reader.error(node.span.clone(), format!("`seconds` must be positive, but is {seconds}"), None);
        }
        budget.seconds = Some(seconds);
    }
    budget
}

fn chebyshev(reader: &mut Reader, fields: &Fields, uncertain: &[String], tolerance: Option<f64>) -> Option<Chebyshev> {
    let order = per_parameter(reader, fields, "order", uncertain, 1..=MOST_ORDER, Chebyshev::ORDER);
    let nodes = match fields.get("nodes") {
        Some(_) => per_parameter(reader, fields, "nodes", uncertain, 2..=MOST_NODES, Chebyshev::ORDER + 1),
        None => order.as_ref().map(|order| order.iter().map(|order| order + 1).collect()),
    };
    let expand = match fields.get("expand") {
        Some(node) => reader.choice(node, &EXPAND),
        // A range is asked for of outputs only.
        None if fields.get("range").is_some() => Some(Expand::Output),
        None => Some(Expand::Coordinates),
    };
    let unspecified = Chebyshev::unspecified(uncertain.len(), tolerance);
    if fields.get("order").is_none() && fields.get("nodes").is_none() && unspecified.degree == Degree::Adaptive {
        let of_output =
            if expand == Some(Expand::Output) { fields.get("range").or(fields.get("expand")) } else { None };
        if let Some(node) = of_output {
            let message = "an output is expanded to an order that is given, not to a tolerance".to_owned();
            reader.error(node.span.clone(), message, "give an `order`, or leave this out".to_owned());
        }
        return Some(unspecified);
    }
    if let (Some(Expand::Coordinates), Some(node)) = (expand, fields.get("range")) {
        let help = "leave it out, or expand the output".to_owned();
        reader.error(node.span.clone(), "`range` is about an expanded output".to_owned(), help);
    }
    let range = range(reader, fields);
    let (order, nodes) = (order?, nodes?);
    let few = order.iter().zip(&nodes).position(|(order, nodes)| nodes <= order);
    if let (Some(few), Some(node)) = (few, fields.get("nodes")) {
        let message = format!("{} nodes are too few for order {}", nodes[few], order[few]);
        reader.error(node.span.clone(), message, format!("at least {} are needed", order[few] + 1));
    }
    let key = if fields.get("nodes").is_some() { "nodes" } else { "order" };
    check_solves(reader, fields, key, &nodes);
    Some(Chebyshev { degree: Degree::Fixed { order, nodes }, expand: expand?, range: range? })
}

fn taylor(reader: &mut Reader, fields: &Fields, uncertain: usize) -> Option<Taylor> {
    let range = range(reader, fields);
    let order = fields.get("order").map_or(Some(Taylor::ORDER), |node| reader.count(node, 1, 50))?;
    // Monomials of degree up to n in k variables: (n + k)! / (n! k!).
    let coefficients = (1..=uncertain).fold(1.0, |count, k| count * (order + k) as f64 / k as f64);
    if coefficients > MOST_COEFFICIENTS {
        let message = format!("order {order} in {uncertain} parameters has {coefficients:.2e} coefficients");
        reader.error(fields.key_span("order"), message, format!("at most {MOST_COEFFICIENTS:e} can be computed"));
    }
    Some(Taylor { order, range: range? })
}

fn scan(reader: &mut Reader, fields: &Fields, uncertain: &[String]) -> Option<Scan> {
    let points = per_parameter(reader, fields, "points", uncertain, 2..=MOST_POINTS, Scan::POINTS)?;
    check_solves(reader, fields, "points", &points);
    Some(Scan { points })
}

fn range(reader: &mut Reader, fields: &Fields) -> Option<RangeKind> {
    fields.get("range").map_or(Some(RangeKind::Tight), |node| reader.choice(node, &RANGES))
}

/// One whole number for all, or one for each by name.
fn per_parameter(
    reader: &mut Reader,
    fields: &Fields,
    key: &str,
    uncertain: &[String],
    allowed: std::ops::RangeInclusive<usize>,
    default: usize,
) -> Option<Vec<usize>> {
    let Some(node) = fields.get(key) else { return Some(vec![default; uncertain.len()]) };
    let (least, most) = allowed.into_inner();
    let Value::Mapping(entries) = &node.value else {
        return reader.count(node, least, most).map(|count| vec![count; uncertain.len()]);
    };
    let mut counts: HashMap<&str, usize> = HashMap::new();
    let mut complete = true;
    for entry in entries.iter().filter(|entry| !reader.idle.contains(&entry.key)).collect::<Vec<_>>() {
        let count = reader.count(&entry.value, least, most);
        if uncertain.contains(&entry.key) {
            complete &= count.is_some();
            counts.insert(&entry.key, count.unwrap_or(default));
        } else {
            complete = false;
            let known = reader.model.parameters.iter().any(|parameter| parameter.name == entry.key);
            let message = if known {
                format!("parameter `{}` is not uncertain", clip(&entry.key))
            } else {
                format!("unknown parameter `{}`", clip(&entry.key))
            };
            let help = suggest::help(&entry.key, "uncertain parameters", uncertain.iter().map(String::as_str));
            reader.error(entry.key_span.clone(), message, help);
        }
    }
    for missing in uncertain.iter().filter(|name| !counts.contains_key(name.as_str())) {
        complete = false;
        reader.error(fields.key_span(key), format!("`{key}` is missing for parameter `{}`", clip(missing)), None);
    }
    complete.then(|| uncertain.iter().filter_map(|name| counts.get(name.as_str()).copied()).collect())
}

fn check_solves(reader: &mut Reader, fields: &Fields, key: &str, counts: &[usize]) {
    let solves: f64 = counts.iter().map(|count| *count as f64).product();
    if solves > MOST_SIMULATIONS {
        let message = format!("{} parameters make {solves:.2e} simulations", counts.len());
        let help = "lower the number, or make fewer parameters uncertain";
        reader.error(fields.key_span(key), message, format!("at most {MOST_SIMULATIONS:e} can be run: {help}"));
    }
}
