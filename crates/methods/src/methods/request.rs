//! Common parts of the methods' requests: their tolerance and budget, and keys that several of them have.

use std::collections::HashMap;

use super::tuning::TUNING;
use super::{BoundsRequest, Method};
use crate::grammar::mapping::Grammar;
use crate::grammar::mentions::NameKind;
use crate::grammar::quantity::Dimension;
use crate::grammar::{Fields, Reader, SymbolTable};
use crate::numerics::RangeKind;
use crate::syntax::codes::Code;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Value};

const RANGES: [(&str, RangeKind); 2] = [("tight", RangeKind::Tight), ("interval", RangeKind::Interval)];

/// Simulations that one method may ask for.
pub const MOST_SIMULATIONS: f64 = TUNING.most_simulations;

/// Limits at which the search for bounds within a tolerance ends at the latest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Simulations.
    pub simulations: usize,
    /// s
    pub seconds: Option<f64>,
}

impl Default for Budget {
    fn default() -> Self {
        Self { simulations: 3000, seconds: None }
    }
}

/// Which surrogate is stored after the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Keep {
    /// None.
    #[default]
    Nothing,
    /// One of the whole box, as exact as the bounds, which are of the same polynomials row by row, also of motions that
    /// are cut at events; beyond [`MOST_ON_GRIDS`](super::MOST_ON_GRIDS) parameters one as for statistics.
    WholeBox,
    /// The same for reduced outputs and margins alone, whose motions may be cut at events.
    Margins,
    /// One whose error is estimated from simulated products: polynomials through values and gradients, if ends were
    /// followed.
    Statistics,
}

impl Keep {
    /// Whether one is stored.
    pub fn is_any(self) -> bool {
        self != Self::Nothing
    }
}

/// The problem that a method is to bound, before anything is simulated.
#[derive(Clone, Copy, Debug)]
pub struct Problem {
    /// Number of uncertain parameters.
    pub parameters: usize,
    /// Whether outputs can follow from expanded coordinates.
    pub composes: bool,
    /// Whether all steps have a given length.
    pub has_fixed_steps: bool,
    /// Whether there are equations of motion; a black box has none.
    pub has_equations: bool,
    /// Error allowed of the bounds.
    pub tolerance: Option<f64>,
}

impl BoundsRequest {
    /// Error relative to the output's range that is aimed at where a degree is to be chosen and no tolerance is given.
    pub const TOLERANCE: f64 = TUNING.tolerance;
}

/// Keeps the entries of some parameters.
pub(super) fn pick(list: &mut Vec<usize>, kept: &[usize]) {
    *list = kept.iter().filter_map(|&number| list.get(number)).copied().collect();
}

impl BoundsRequest {
    /// The request of a model without the section.
    pub fn default_for(parameters: usize) -> Self {
        let mut request = Self::default();
        request.ask(Method::ALL[0], &unspecified(parameters, None));
        request
    }

    /// Reads the keys of `bounds:` in a model with these uncertain parameters.
    pub fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields, uncertain: &[String]) -> Self {
        let mut request = Self { tolerance: tolerance(reader, fields), ..Self::default() };
        if let Some(node) = fields.get("budget")
            && let Some(fields) = reader.fields::<keys::Budget>(node, fields.key_span("budget"))
        {
            request.budget = budget(reader, &fields);
        }
        let has_keys = |method: &Method| keys_of_bounds().contains(&method.name());
        let named = Method::ALL.into_iter().filter(has_keys).any(|method| fields.get(method.name()).is_some());
        if fields.get("tolerance").is_some() && !named {
            request.ask(Method::ALL[0], &unspecified(uncertain.len(), Some(Self::TOLERANCE)));
        }
        request.read_methods(reader, fields, uncertain);
        request
    }
}

/// Keys of `bounds:`, without `certified`.
fn keys_of_bounds() -> &'static [&'static str] {
    <super::keys::Bounds as Grammar>::KEYS
}

/// A problem of which only the request is known.
fn unspecified(parameters: usize, tolerance: Option<f64>) -> Problem {
    Problem { parameters, composes: true, has_fixed_steps: true, has_equations: true, tolerance }
}

fn tolerance<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields) -> Option<f64> {
    let node = fields.get("tolerance")?;
    let tolerance = reader.number(node, Dimension::NUMBER)?;
    if !(TUNING.least_tolerance..1.0).contains(&tolerance) {
        let message = format!("a tolerance of {tolerance} is not from {:e} to below 1", TUNING.least_tolerance);
        let help = "it is relative to how far an output ranges: 1e-3 is a thousandth of that".to_owned();
        reader.error(Code::OutOfRange, node.span.clone(), message, help);
        return None;
    }
    Some(tolerance)
}

fn budget<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields) -> Budget {
    let mut budget = Budget::default();
    if let Some(simulations) = fields.get("solves").and_then(|node| reader.count(node, 1, MOST_SIMULATIONS as usize)) {
        budget.simulations = simulations;
    }
    if let Some(node) = fields.get("seconds")
        && let Some(seconds) = reader.number(node, Dimension::TIME)
    {
        if seconds <= 0.0 {
            reader.error(
                Code::OutOfRange,
                node.span.clone(),
                format!("`seconds` must be positive, but is {seconds}"),
                None,
            );
        }
        budget.seconds = Some(seconds);
    }
    budget
}

/// Reads `range`; tight by default.
pub(super) fn range<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields) -> Option<RangeKind> {
    fields.get("range").map_or(Some(RangeKind::Tight), |node| reader.choice(node, &RANGES))
}

/// One whole number for all, or one for each by name.
pub(super) fn per_parameter<S: SymbolTable>(
    reader: &mut Reader<'_, S>,
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
    let varies = |entry: &&Entry| !reader.idle.contains(&entry.key) && !reader.certain.contains(&entry.key);
    for entry in entries.iter().filter(varies).collect::<Vec<_>>() {
        let count = reader.count(&entry.value, least, most);
        reader.mentions(Some(NameKind::Parameter), &entry.key, &entry.key_span);
        if uncertain.contains(&entry.key) {
            complete &= count.is_some();
            counts.insert(&entry.key, count.unwrap_or(default));
        } else {
            complete = false;
            let known = reader.model.parameter(&entry.key).is_some();
            let message = if known {
                format!("parameter `{}` is not uncertain", clip(&entry.key))
            } else {
                format!("unknown parameter `{}`", clip(&entry.key))
            };
            let help = suggest::help(&entry.key, "uncertain parameters", uncertain.iter().map(String::as_str));
            reader.error(Code::UnknownName, entry.key_span.clone(), message, help);
        }
    }
    for missing in uncertain.iter().filter(|name| !counts.contains_key(name.as_str())) {
        complete = false;
        reader.error(
            Code::MissingKey,
            fields.key_span(key),
            format!("`{key}` is missing for parameter `{}`", clip(missing)),
            None,
        );
    }
    complete.then(|| uncertain.iter().filter_map(|name| counts.get(name.as_str()).copied()).collect())
}

/// Reports a grid of too many samples.
pub(super) fn check_simulations<S: SymbolTable>(
    reader: &mut Reader<'_, S>,
    fields: &Fields,
    key: &str,
    parameters: usize,
    simulations: f64,
) {
    if simulations > MOST_SIMULATIONS {
        let message = format!("{parameters} parameters make {simulations:.2e} simulations");
        let help = "lower the number, or make fewer parameters uncertain";
        reader.error(
            Code::TooLarge,
            fields.key_span(key),
            message,
            format!("at most {MOST_SIMULATIONS:e} can be run: {help}"),
        );
    }
}

/// Keys of the file.
pub mod keys {
    use indexmap::IndexMap;
    use schemars::JsonSchema;

    use crate::grammar::mapping::{grammar, schema_only};
    use crate::grammar::values::Number;

    schema_only! {
        /// A whole number for all parameters, or one for each uncertain parameter.
        #[schemars(untagged, inline)]
        pub enum PerParameter {
            All(u32),
            Each(IndexMap<String, u32>),
        }

        #[schemars(rename_all = "lowercase", inline)]
        pub enum Range {
            /// The polynomial's own range.
            Tight,
            /// Interval arithmetic term by term, as in the paper: wider.
            Interval,
        }
    }

    grammar! {
        /// Limits at which the search for bounds within the tolerance ends at the latest, with its result by then.
        Budget is "`budget`" {
            /// Simulations; by default 3000.
            solves: Option<u32>,
            /// Seconds; by default as long as it takes. Results then depend on the machine.
            seconds: Option<Number>,
        }
    }
}
