//! Classes of functions within limits: `rate`, `held`, `mean`, `energy`, `band`.

use symdiff::{Binary, Formula, Unary};

use super::limits::{Limits, is_of_time, limits};
use crate::elements::Class;
use crate::grammar::Context;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::model::names::Reader;
use crate::model::random::band_of;
use crate::syntax::codes::Code;
use crate::syntax::yaml::{Entry, Node};

/// Keys of which an excitation has one at most.
const CLASSES: [&str; 5] = ["rate", "held", "mean", "energy", "band"];

/// Example of limits, and of their alternatives.
const EXAMPLE: &str =
    "give limits of its value, `within: ± 5 N`, or of its `rate` or `energy`, or a spectrum, `random`";

/// Middle, reach and class of an excitation.
pub fn read(
    reader: &mut Reader,
    entry: &Entry,
    fields: &Fields,
    dimension: &mut Option<Dimension>,
) -> Option<(Limits, Class)> {
    let within = match fields.get("within") {
        Some(node) => Some((limits(reader, node, dimension, false)?, node)),
        None => None,
    };
    let mut given = CLASSES.into_iter().filter_map(|key| Some((key, fields.get(key)?)));
    let class = given.next();
    if let (Some((first, _)), Some((second, _))) = (class, given.next()) {
        let help = format!("leave out `{first}`, or `{second}`");
        reader.error(
            Code::ExclusiveKeys,
            fields.key_span(second),
            format!("`{first}` and `{second}` are of different classes"),
            help,
        );
        return None;
    }
    let whole = |reach: Formula| Limits { middle: Formula::number(0.0), reach };
    Some(match (within, class) {
        (Some((limits, _)), None) => (limits, Class::Bounded),
        (Some((limits, _)), Some(("held", node))) => (limits, Class::Held(period(reader, node)?)),
        (Some((limits, within)), Some(("rate", node))) => {
            let rate = rate(reader, node, dimension)?;
            if [&limits.middle, &limits.reach].into_iter().any(|formula| is_of_time(reader, formula)) {
                (limits, Class::MovingRate(rate))
            } else {
                reader.require(within, &limits.reach, |reach| reach != 0.0, "must be apart, with a `rate`");
                let ratio = rate.combined(Binary::Div, &limits.reach);
                (limits, Class::BoundedRate(ratio))
            }
        }
        (Some((own, within)), Some(("mean", node))) => {
            refuse_time(reader, within, [&own.middle, &own.reach], "mean")?;
            let mean = limits(reader, node, dimension, true)?;
            refuse_time(reader, node, [&mean.middle, &mean.reach], "mean")?;
            let of_u = |operation| {
                let end = mean.middle.combined(operation, &mean.reach);
                end.combined(Binary::Sub, &own.middle).combined(Binary::Div, &own.reach)
            };
            let mean = [of_u(Binary::Sub), of_u(Binary::Add)];
            (own, Class::Mean(mean))
        }
        (Some((limits, within)), Some(("energy", node))) => {
            refuse_time(reader, within, [&limits.middle, &limits.reach], "energy")?;
            let energy = energy(reader, node, dimension)?;
            let square = limits.reach.combined(Binary::Mul, &limits.reach);
            let energy = energy.combined(Binary::Div, &square);
            (limits, Class::Energy { energy, is_bounded: true, constant: Formula::number(f64::NAN) })
        }
        (Some((limits, _)), Some((_, node))) => (limits, Class::Band(band_of(reader, node)?)),
        (None, Some(("rate", node))) => (whole(rate(reader, node, dimension)?), Class::Rate),
        (None, Some(("energy", node))) => {
            let energy = energy(reader, node, dimension)?;
            let class = Class::Energy { energy, is_bounded: false, constant: Formula::number(f64::NAN) };
            (whole(Formula::number(1.0)), class)
        }
        (None, _) => {
            if fields.lacks_all(&["within", "rate", "energy"]) {
                reader.error(
                    Code::BadExcitation,
                    entry.key_span.clone(),
                    "an excitation needs limits",
                    EXAMPLE.to_owned(),
                );
            }
            return None;
        }
    })
}

/// The limit of the rate: a formula of parameters.
fn rate(reader: &mut Reader, node: &Node, dimension: &mut Option<Dimension>) -> Option<Formula> {
    let mut of_rate = dimension.map(|dimension| dimension.per(Dimension::TIME));
    let (formula, own) = reader.any_unit(node, Context::Constant)?;
    if let (Some(own), Some(known)) = (own, of_rate) {
        reader.check_fits(&node.span, own, known).then_some(())?;
    }
    of_rate = of_rate.or(own);
    *dimension = dimension.or(of_rate.map(|rate| rate.times(Dimension::TIME)));
    reader.require(node, &formula, |rate| rate > 0.0, "must be positive");
    Some(formula)
}

/// A period, s.
fn period(reader: &mut Reader, node: &Node) -> Option<f64> {
    let formula =
        reader.formula_that(node, Context::Constant, Dimension::TIME, |held| held > 0.0, "must be positive")?;
    if reader.is_uncertain(&formula) {
        reader.error(Code::MustBeCertain, node.span.clone(), "a period is the same for all samples", None);
        return None;
    }
    reader.evaluate(&formula, 0).filter(|period| period.is_finite() && *period > 0.0)
}

/// The largest integral of a square over the time: a formula of parameters.
fn energy(reader: &mut Reader, node: &Node, dimension: &mut Option<Dimension>) -> Option<Formula> {
    let (formula, own) = reader.any_unit(node, Context::Constant)?;
    let of_energy = dimension.map(|dimension| dimension.times(dimension).times(Dimension::TIME));
    if let (Some(own), Some(known)) = (own, of_energy) {
        reader.check_fits(&node.span, own, known).then_some(())?;
    }
    *dimension = dimension.or(own.and_then(|own| own.per(Dimension::TIME).to_the(0.5)));
    reader.require(node, &formula, |energy| energy > 0.0, "must be positive");
    Some(formula)
}

/// Functions with a mean or an energy have limits that do not move.
fn refuse_time(reader: &mut Reader, node: &Node, formulas: [&Formula; 2], key: &str) -> Option<()> {
    if !formulas.into_iter().any(|formula| is_of_time(reader, formula)) {
        return Some(());
    }
    let message = format!("with `{key}`, limits do not change in time");
    reader.error(
        Code::BadExcitation,
        node.span.clone(),
        message,
        "add the change to the formulas that use it".to_owned(),
    );
    None
}

/// The largest constant of a class with an energy: √(E/T), and at most 1 of limits.
pub fn set_constant(class: &mut Class, duration: f64) {
    if let Class::Energy { energy, is_bounded, constant } = class {
        let most = energy.combined(Binary::Div, &Formula::number(duration)).applied(Unary::Sqrt);
        *constant = if *is_bounded { most.combined(Binary::Min, &Formula::number(1.0)) } else { most };
    }
}
