//! Numbers and formulas of keys: parses them, resolves their names, checks their dimensions and values.

use std::cell::RefCell;

use symdiff::formula::{Names, Vocabulary};
use symdiff::{Builder, Formula, Spline, Unary};

use super::dimension::{self, KnownDimension};
use super::names::{self, Context, NameError};
use super::own_names::OwnNames;
use super::quantity::Dimension;
use super::reader::Reader;
use super::requirement::{Quantity, Requirement};
use super::symbols::{ReactionComponent, Symbol, SymbolTable};
use super::tolerance::is_toleranced;
use super::unit::{Unit, number_and_unit, per_minute};
use super::{unit_names, unknown};
use crate::grammar::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::{Node, Scalar};

/// Content of a field: a number with its unit, or a formula.
pub enum Written {
    /// A number with its unit.
    Quantity {
        /// The number, in the unit.
        value: f64,
        /// The unit.
        unit: Unit,
    },
    /// A formula.
    Formula(Formula),
}

impl<S: SymbolTable> Reader<'_, S> {
    /// Reads the content of a field, without resolving its names.
    pub fn written(&mut self, node: &Node) -> Option<Written> {
        let written = self.unsigned(node)?;
        let is_negated = node.scalar().and_then(|scalar| scalar.scope.as_ref()).is_some_and(|scope| scope.is_negated());
        Some(match written {
            Written::Quantity { value, unit } if is_negated => Written::Quantity { value: -value, unit },
            Written::Formula(formula) if is_negated => Written::Formula(formula.applied(Unary::Neg)),
            written => written,
        })
    }

    /// The same without the sign of a mirror.
    fn unsigned(&mut self, node: &Node) -> Option<Written> {
        let scalar = self.scalar(node, "a number or a formula")?;
        if is_toleranced(&scalar.text) {
            let help = "name it under `parameters`, and write its name here".to_owned();
            self.error(Code::MisplacedTolerance, node.span.clone(), "only a parameter can have a tolerance", help);
            return None;
        }
        if self.is_meant_as_interval(node, &scalar.text) {
            return None;
        }
        if let Some(number) = per_minute(&scalar.text) {
            let help = format!("write `{number} rpm` for revolutions, `{number} rad/min` for radians a minute");
            self.error(
                Code::AmbiguousUnit,
                node.span.clone(),
                format!("`{}` may be revolutions or radians", clip(scalar.text.trim())),
                help,
            );
            return None;
        }
        let own_names = OwnNames::of(scalar, self.variable);
        if let Some((value, unit, start)) = number_and_unit(&scalar.text) {
            if unit.starts_with('%') {
                let help = "write the number itself: 1% is 0.01".to_owned();
                self.error(Code::MisplacedTolerance, node.span.clone(), "`%` can stand only in a tolerance", help);
                return None;
            }
            // More text after the unit makes it a formula.
            match Unit::leading(unit, |name| self.is_name(name, own_names.as_ref())) {
                Ok((found, length)) if length == unit.len() => {
                    self.like_names = self.like_names(value, unit, own_names.as_ref());
                    return Some(Written::Quantity { value, unit: found });
                }
                Ok(_) => {}
                Err(error) => {
                    let part = start + error.span.start..start + error.span.end;
                    self.error(Code::UnknownUnit, scalar.place(&node.span, part), error.message, error.help);
                    return None;
                }
            }
        }
        self.parse(node, scalar, 0..scalar.text.len()).map(Written::Formula)
    }

    /// Parses the formula in a part of a scalar.
    pub fn parse(&mut self, node: &Node, scalar: &Scalar, part: Span) -> Option<Formula> {
        let text = &scalar.text[part.clone()];
        let infinite = text.trim().trim_start_matches(['+', '-']).to_lowercase();
        if matches!(infinite.as_str(), ".inf" | ".nan") {
            self.error(Code::NotANumber, node.span.clone(), format!("`{}` is not a finite number", text.trim()), None);
            return None;
        }
        let tables: Vec<_> = self.tables.iter().map(|table| (table.name.as_str(), table.spline)).collect();
        let own_names = OwnNames::of(scalar, self.variable);
        let like_names = RefCell::new(Vec::new());
        let unit = |value: f64, text: &str| {
            let found = Unit::behind(value, text, |name| self.is_name(name, own_names.as_ref()))?;
            like_names.borrow_mut().extend(self.like_names(value, &text[..found.length], own_names.as_ref()));
            Ok(found)
        };
        let names = own_names.as_ref().map(|names| names as &dyn Names);
        let parsed = Formula::parse_with(text, &Vocabulary { tables: &tables, unit: Some(&unit), names });
        self.like_names = like_names.into_inner();
        match parsed {
            Ok(formula) if formula.terms().len() > TUNING.formula_terms => {
                let message = format!(
                    "the formula has more than {formula_terms} operations",
                    formula_terms = TUNING.formula_terms
                );
                self.error(Code::TooLarge, node.span.clone(), message, "split it into parameters".to_owned());
                None
            }
            Ok(formula) => {
                self.mentions_names(node, scalar, &formula, part.start);
                self.mentions_tables(node, scalar, &formula, part.start);
                Some(match own_names {
                    Some(names) => self.in_model(formula, names.scope),
                    None => formula,
                })
            }
            Err(error) => {
                let span = part.start + error.span.start..part.start + error.span.end;
                let fraction = text.trim_start().starts_with('(').then(|| unit_names::of_fraction(text)).flatten();
                let help = fraction.map(|fraction| fraction.help_in_parentheses()).or(error.help);
                self.error(Code::BadFormula, scalar.place(&node.span, span), error.message, help);
                None
            }
        }
    }

    /// Whether a word is a name that formulas may use, and so no unit if it could be both.
    pub(super) fn is_name(&self, word: &str, own: Option<&OwnNames>) -> bool {
        if let Some(own) = own {
            return own.index(word).is_some() || self.is_name(&own.full(word), None);
        }
        names::is_reserved(word)
            || self.variable.is_some_and(|(own, _)| own == word)
            || self.tables.iter().any(|table| table.name == word)
            || self.symbol(word).is_some()
    }

    /// Whether the context allows every name of the formula; `offset` is the formula's first byte in the scalar.
    pub fn check_names(&mut self, node: &Node, formula: &Formula, offset: usize, context: Context) -> bool {
        let mut all_known = true;
        let own = self.variable.map(|(name, _)| name);
        for (name, span) in formula.names().filter(|(name, _)| Some(*name) != own) {
            match self.resolve(name, context) {
                Ok(Symbol::Parameter(index)) => {
                    if let Some(used) = self.used.get_mut(index) {
                        *used = true;
                    }
                }
                Ok(Symbol::Trajectory { trajectory, order }) => {
                    self.used_trajectories.insert(trajectory);
                    if self.model.derivatives(trajectory).is_some_and(|most| order > most) {
                        all_known = false;
                        let part = offset + span.start..offset + span.end;
                        let place =
                            node.scalar().map_or_else(|| node.span.clone(), |scalar| scalar.place(&node.span, part));
                        let message = format!("`{}` is not known: only limits of the function are", clip(name));
                        let help = "an excitation has a rate where its `rate` is limited, and no acceleration";
                        self.error(Code::NotHere, place, message, help.to_owned());
                    }
                }
                Ok(symbol) if self.is_of_model(node, symbol) => {
                    all_known = false;
                    let part = offset + span.start..offset + span.end;
                    let place =
                        node.scalar().map_or_else(|| node.span.clone(), |scalar| scalar.place(&node.span, part));
                    let message = format!("`{}` is in the model's frame, not in that of the instance", clip(name));
                    let help =
                        "in an assembly that is turned or mirrored, use coordinates of joints, or points of the body";
                    self.error(Code::NotHere, place, message, help.to_owned());
                }
                Ok(_) => {}
                Err(_) if self.is_of_unread_joint(name) || self.is_unread_output(name) => all_known = false,
                Err(error) => {
                    all_known = false;
                    let part = part_of_name(name, &span, error.part);
                    let part = offset + part.start..offset + part.end;
                    let place =
                        node.scalar().map_or_else(|| node.span.clone(), |scalar| scalar.place(&node.span, part));
                    self.diagnostics.push(Diagnostic::error(Code::UnknownName, place, error.message).help(error.help));
                }
            }
        }
        all_known
    }

    /// Symbol of a name; effects that are not in the model are numbered after those that are.
    pub fn symbol(&self, name: &str) -> Option<Symbol> {
        names::symbol(&self.model, name).or_else(|| self.unread_measure(name)?.ok())
    }

    /// Symbol of a name, or an error if it is unknown or the context does not allow it.
    pub fn resolve(&self, name: &str, context: Context) -> Result<Symbol, NameError> {
        match names::symbol(&self.model, name) {
            Some(symbol) => names::allowed(name, symbol, context),
            None => match self.unread_measure(name) {
                Some(own) => own.and_then(|symbol| names::allowed(name, symbol, context)),
                None => Err(unknown::unknown(&self.model, name, context)),
            },
        }
    }

    /// The formula's dimension; inconsistent dimensions are reported.
    pub fn kind(&mut self, node: &Node, formula: &Formula, offset: usize) -> KnownDimension {
        let mut mismatches = Vec::new();
        let name = |name: &str| match self.variable {
            Some((own, dimension)) if own == name => KnownDimension::motion(dimension),
            _ => self.symbol(name).map_or(KnownDimension::Any, |symbol| self.kind_of(symbol)),
        };
        let kinds = dimension::of_terms(formula, name, |spline| self.table(spline), &mut mismatches);
        self.mentions_formula(node, offset, formula, &kinds);
        for mismatch in mismatches {
            let part = offset + mismatch.span.start..offset + mismatch.span.end;
            let index = node.scalar().map_or_else(|| node.span.clone(), |scalar| scalar.place(&node.span, part));
            self.error(Code::WrongDimension, index, mismatch.message, None);
        }
        kinds.last().copied().unwrap_or(KnownDimension::Any)
    }

    /// Dimensions of a table's argument and value.
    pub(super) fn table(&self, spline: Spline) -> [Option<Dimension>; 2] {
        let found = self.tables.iter().find(|table| table.spline == spline);
        found.map_or([None; 2], |table| table.dimensions)
    }

    /// Dimension of a name's value. An equation's multiplier is the force conjugate to the equated quantity.
    pub(super) fn kind_of(&self, symbol: Symbol) -> KnownDimension {
        if let Symbol::Reaction { joint, component: ReactionComponent::Force } = symbol
            && let Some(left) = self.model.equated(joint)
        {
            let name =
                |name: &str| self.symbol(name).map_or(KnownDimension::Any, |symbol| names::kind(symbol, &self.kinds));
            let equated = dimension::analyse(left, name, |spline| self.table(spline), &mut Vec::new()).dimension();
            return equated.map_or(KnownDimension::Any, |dimension| KnownDimension::motion(dimension.conjugate()));
        }
        if let Symbol::Sensor { effect, measure } = symbol {
            let measures = match effect.checked_sub(self.model.effects()) {
                None => self.model.measures(effect),
                Some(index) => match self.unread.get(index) {
                    Some((_, measures)) => measures.clone(),
                    None => self.declared.measures_of(index - self.unread.len()).to_vec(),
                },
            };
            let found = measures.into_iter().find(|(known, _)| *known == measure && measure.has_unit());
            let dimension = found.map(|(_, dimension)| dimension);
            return dimension.map_or(KnownDimension::Any, KnownDimension::motion);
        }
        if let Symbol::Trajectory { trajectory, order } = symbol {
            let dimension = self.model.trajectory_dimension(trajectory);
            let per_time = |dimension: Dimension, _| dimension.per(Dimension::TIME);
            return dimension.map_or(KnownDimension::Any, |value| {
                KnownDimension::motion((0..order as usize).fold(value, per_time))
            });
        }
        if let Symbol::BlackBox { output } = symbol {
            return KnownDimension::motion(self.model.black_box_dimension(output));
        }
        names::kind(symbol, &self.kinds)
    }

    /// Reads a formula or a number with its unit, of a dimension.
    pub fn formula(&mut self, node: &Node, context: Context, wanted: Dimension) -> Option<Formula> {
        let formula = match self.written(node)? {
            Written::Quantity { value, unit } => {
                if !unit.dimension.fits(wanted) {
                    let message = format!("{} stands where {wanted} belongs", unit.dimension);
                    let help = self.other_reading(node);
                    self.error(Code::WrongDimension, node.span.clone(), message, help);
                    return None;
                }
                self.refuse_ambiguous(node);
                self.suspect_quantity(unit.to_si(value), wanted);
                let formula = Formula::number(unit.to_si(value));
                self.mentions_formula(node, 0, &formula, &[KnownDimension::parameter(wanted)]);
                formula
            }
            Written::Formula(formula) => {
                if !self.check_names(node, &formula, 0, context) {
                    return None;
                }
                let found = self.kind(node, &formula, 0).dimension();
                if let Some(found) = found.filter(|found| !found.fits(wanted)) {
                    let help = self.other_reading(node);
                    self.error(
                        Code::WrongDimension,
                        node.span.clone(),
                        format!("{found} stands where {wanted} belongs"),
                        help,
                    );
                } else {
                    self.refuse_ambiguous(node);
                }
                self.suspect_formula(node, &formula, wanted);
                formula
            }
        };
        self.require(node, &formula, |_| true, "");
        Some(formula)
    }

    /// Reads a formula or a number with its unit that meets the requirements of a key.
    pub fn quantity(&mut self, node: &Node, quantity: &Quantity) -> Option<Formula> {
        let formula = self.formula(node, quantity.context, quantity.dimension())?;
        if let Some(Requirement { holds, message }) = quantity.requirement {
            self.require(node, &formula, holds, message);
        }
        Some(formula)
    }

    /// Like [`Self::formula`], with a requirement on its values: `must be positive`.
    pub fn formula_that(
        &mut self,
        node: &Node,
        context: Context,
        wanted: Dimension,
        holds: impl Fn(f64) -> bool,
        requirement: &str,
    ) -> Option<Formula> {
        let formula = self.formula(node, context, wanted)?;
        self.require(node, &formula, holds, requirement);
        Some(formula)
    }

    /// Reads a number that is the same for every sample.
    pub fn number(&mut self, node: &Node, wanted: Dimension) -> Option<f64> {
        let formula = self.formula(node, Context::Constant, wanted)?;
        if self.is_uncertain(&formula) {
            let message = "this number is one for all samples, so it cannot depend on an uncertain parameter";
            self.error(Code::MustBeCertain, node.span.clone(), message, None);
            return None;
        }
        self.evaluate(&formula, 0).filter(|value| value.is_finite())
    }
}

/// The location of a part of a name whose written text may be shorter.
fn part_of_name(name: &str, written: &Span, part: Span) -> Span {
    let before = name.len().saturating_sub(written.len());
    if part.start < before || name.len() < written.len() {
        return written.clone();
    }
    written.start + part.start - before..(written.start + part.end - before).min(written.end)
}

/// The formula's value; `name` gives the value of each name.
pub fn evaluate(formula: &Formula, name: impl Fn(&str) -> Option<f64>) -> Option<f64> {
    let builder = Builder::new();
    let built = formula.build(&builder, |text| name(text).map(|value| builder.number(value)).ok_or(()));
    built.ok()?.as_constant()
}
