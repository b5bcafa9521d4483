//! `black_box: { fmu: FILE }`: the unit's description, and parameters that are written as deviations from its start
//! values, `k: ± 5%`, with these values written out.

use std::path::{Path, PathBuf};

use mbint_fmu::{BaseUnit, NotRead, Unit, Variable};

use crate::grammar::display_unit::DisplayUnit;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Report;
use crate::grammar::tolerance::{Deviation, Toleranced, is_toleranced, read};
use crate::grammar::unit;
use crate::syntax::codes::Code;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// The unit's file and its description; errors stand at the node that names it.
pub fn unit_of(report: &mut Report, node: &Node) -> Option<(PathBuf, Unit)> {
    let name = report.scalar(node, "the path of an FMU")?.text.clone();
    let path = match report.files.find(Path::new(""), &name) {
        Ok(path) => report.files.full(&path),
        Err(error) => {
            report.error(error.code, node.span.clone(), error.message, error.help);
            return None;
        }
    };
    match Unit::read(&path) {
        Ok(unit) => Some((path, unit)),
        Err(error) => {
            let what = if matches!(error, NotRead::File(_)) { "cannot be read" } else { "is no FMU" };
            report.error(Code::BadFmu, node.span.clone(), format!("`{}` {what}: {error}", clip(&name)), None);
            None
        }
    }
}

/// The variable of a name in the model, which may be another one in the unit by `variables`.
pub fn named<'n>(variables: Option<&'n Node>, name: &'n str) -> &'n str {
    let Some(Value::Mapping(entries)) = variables.map(|node| &node.value) else { return name };
    let own = entries.iter().find(|entry| entry.key == name).and_then(|entry| entry.value.scalar());
    own.map_or(name, |scalar| scalar.text.as_str())
}

/// How numbers of a variable become those of SI: `SI = factor · number + offset`.
pub struct Conversion {
    /// SI value of one of the variable's unit, without the offset.
    pub factor: f64,
    /// SI value of the number 0.
    pub offset: f64,
    /// The unit in which people see it; `None` if the variable has none.
    pub shown: Option<DisplayUnit>,
}

impl Conversion {
    /// Conversion of a variable. Units of currents, temperatures, amounts and light, which models do not have, are
    /// numbers.
    pub fn of(unit: &Unit, variable: &Variable) -> Self {
        let number = |shown: Option<DisplayUnit>| Self { factor: 1.0, offset: 0.0, shown };
        let Some(name) = &variable.unit else { return number(None) };
        let own = unit::Unit::parse(name).ok().map(|own| DisplayUnit::new(name, own));
        let Some(base) = unit.units.get(name).and_then(Option::as_ref) else {
            return match own {
                Some(own) => Self { factor: own.si(), offset: 0.0, shown: Some(own) },
                None => number(Some(DisplayUnit::number())),
            };
        };
        let Some(si) = base_unit(base) else { return number(Some(DisplayUnit::number())) };
        let is_same = |own: &DisplayUnit| {
            own.dimension().fits(si.dimension())
                && base.offset == 0.0
                && (own.si() - base.factor).abs() <= 1e-9 * base.factor.abs()
        };
        Self { factor: base.factor, offset: base.offset, shown: Some(own.filter(is_same).unwrap_or(si)) }
    }

    /// Dimension, where the variable has a unit.
    pub fn dimension(&self) -> Option<Dimension> {
        self.shown.as_ref().map(DisplayUnit::dimension)
    }
}

fn base_unit(base: &BaseUnit) -> Option<DisplayUnit> {
    let text = base.text();
    unit::Unit::parse(&text).ok().map(|si| DisplayUnit::new(&text, si))
}

/// Help for a name that the unit does not have: near ones among those that pass.
pub fn help(unit: &Unit, name: &str, passes: impl Fn(&Variable) -> bool) -> Option<String> {
    let known = unit.variables.iter().filter(|variable| passes(variable)).map(|variable| variable.name.as_str());
    suggest::help(name, "variables of that kind in the unit", known)
}

/// The model's tree with start values of the unit in parameters that deviate from them; `None` if the unit cannot be
/// read.
pub fn write_out(report: &mut Report, root: &Node) -> Option<Node> {
    let section = root.get("black_box");
    let Some(file) = section.and_then(|section| section.get("fmu")) else { return Some(root.clone()) };
    let (_, unit) = unit_of(report, file)?;
    let variables = section.and_then(|section| section.get("variables"));
    let mut root = root.clone();
    let Value::Mapping(sections) = &mut root.value else { return Some(root) };
    for parameters in sections.iter_mut().filter(|section| section.key == "parameters") {
        let Value::Mapping(entries) = &mut parameters.value.value else { continue };
        for entry in entries {
            let name = named(variables, &entry.key).to_owned();
            let variable = unit.variable(&name);
            let start = variable.and_then(|own| Some(value_text(&unit, own, own.start?)));
            let deviates = with_start(entry, start.as_deref().unwrap_or("1"));
            if deviates && start.is_none() {
                let help = help(&unit, &name, |own| own.is_settable && own.start.is_some());
                let message = match variable {
                    Some(_) => format!("`{}` has no start value in the unit, from which this deviates", clip(&name)),
                    None => format!("the unit has no variable `{}`, from whose start value this deviates", clip(&name)),
                };
                report.error(Code::BadFmu, entry.key_span.clone(), message, help);
            }
        }
    }
    Some(root)
}

/// A start value with its unit.
fn value_text(unit: &Unit, variable: &Variable, start: f64) -> String {
    let Conversion { factor, offset, shown } = Conversion::of(unit, variable);
    match shown {
        // `factor` is exact where the unit's name is known: the number stays as it is written.
        Some(shown) if offset == 0.0 && shown.si() != 1.0 => format!("{start:?} {}", shown.text),
        Some(shown) if shown.text != "1" => format!("{:?} {}", start * factor + offset, shown.text),
        _ => format!("{start:?}"),
    }
}

/// Puts a value before a deviation that stands alone; returns whether one does.
fn with_start(entry: &mut Entry, value: &str) -> bool {
    let node = &mut entry.value;
    match &mut node.value {
        Value::Scalar(scalar) if is_toleranced(&scalar.text) => {
            let found = read(&Node { span: node.span.clone(), value: Value::Scalar(scalar.clone()) });
            if let Ok(Toleranced { value: None, deviation: Some(Deviation::Either(_)) }) = found {
                *scalar = Scalar::plain(format!("{value} {}", scalar.text.trim()), None);
                return true;
            }
            false
        }
        Value::Mapping(keys) if !keys.iter().any(|own| ["value", "interval"].contains(&own.key.as_str())) => {
            let text = Node { span: node.span.clone(), value: Value::Scalar(Scalar::plain(value, None)) };
            keys.push(Entry { key: "value".to_owned(), key_span: node.span.clone(), value: text });
            true
        }
        _ => false,
    }
}
