//! What every part of the reader needs: mappings with known keys, formulas in their context, values that are checked.
//!
//! Reading goes on after an error, so that one run reports as many as can be found. A reader gives `None` only when it
//! has reported why.

use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

use symdiff::{Builder, Formula, Spline};

use super::dimension::{self, Kind};
use super::element::{Quantity, Requirement};
use super::mapping::Grammar;
use super::names::{self, Context, NameError};
use super::quantity::{Dimension, Unit, number_and_unit};
use super::symbols::{ReactionComponent, Sensor, Symbol, SymbolTable};
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// Operations in one formula.
const MAX_TERMS: usize = 10_000;

/// What is read so far of a model of symbols `S`, and what is known of its names.
pub struct Reader<'d, S> {
    /// Errors and warnings so far.
    pub diagnostics: &'d mut Diagnostics,
    /// Names first, then what they stand for.
    pub model: S,
    /// Effects that are not in the model, with what they measure: the last is being read, and its own formulas may refer to that;
    /// the others had errors.
    pub unread: Vec<(String, Vec<(Sensor, Dimension)>)>,
    /// A name of its own that the formula being read may use, and its dimension.
    pub variable: Option<(&'static str, Dimension)>,
    /// Dimension of each parameter.
    pub kinds: Vec<Kind>,
    /// Parameter values at which requirements are checked.
    pub corners: Vec<Corner>,
    /// Whether the parameter's value is uncertain.
    pub varies: Vec<bool>,
    /// Whether a parameter has no value because of an error that was reported.
    pub broken: bool,
    /// Parameters that something speaks of, other parameters aside.
    pub used: Vec<bool>,
    /// Parameters that others speak of.
    pub used_by_parameters: Vec<bool>,
    /// Parameters that vary, but in what is left out only.
    pub idle: HashSet<String>,
    /// Functions that the file gives by their values.
    pub tables: Vec<Table>,
    /// Where files are that the model names.
    pub folder: PathBuf,
}

/// A function that is given by its values.
#[derive(Clone, Debug)]
pub struct Table {
    pub name: String,
    pub spline: Spline,
    /// Of argument and value, where the file says so.
    pub dimensions: [Option<Dimension>; 2],
}

/// Values of all parameters at once.
#[derive(Clone, Debug)]
pub struct Corner {
    pub values: Vec<f64>,
    /// ` at l1 = 0.1`; empty for the nominal values.
    pub label: String,
}

/// What stands in a field: a number with its unit, or a formula.
pub enum Written {
    Quantity { value: f64, unit: Unit },
    Formula(Formula),
}

/// A mapping whose keys are known.
pub struct Fields<'n> {
    /// Where to say that something is missing.
    pub at: Span,
    what: &'static str,
    keys: Vec<&'static str>,
    entries: HashMap<&'n str, (Span, &'n Node)>,
}

impl<'n> Fields<'n> {
    /// A mapping of one key, whose value stands for all of it.
    pub fn single(what: &'static str, keys: Vec<&'static str>, key: &'n str, node: &'n Node, at: Span) -> Self {
        Self { at, what, keys, entries: HashMap::from([(key, (node.span.clone(), node))]) }
    }

    /// The value of a key, if it is there.
    pub fn get(&self, key: &str) -> Option<&'n Node> {
        debug_assert!(self.keys.contains(&key), "`{key}` is not in the grammar of {}", self.what);
        self.entries.get(key).map(|(_, node)| *node)
    }

    /// The place of a key.
    pub fn key_span(&self, key: &str) -> Span {
        self.entries.get(key).map_or_else(|| self.at.clone(), |(span, _)| span.clone())
    }
}

impl<S: SymbolTable> Reader<'_, S> {
    /// Reports an error.
    pub fn error(&mut self, span: Span, message: impl Into<String>, help: impl Into<Option<String>>) {
        self.diagnostics.push(Diagnostic::error(span, message).help(help));
    }

    /// The entries of a mapping with free keys; nothing written is an empty mapping.
    pub fn entries<'n>(&mut self, node: &'n Node, what: &str) -> &'n [Entry] {
        match &node.value {
            Value::Mapping(entries) => entries,
            Value::Scalar(scalar) if scalar.is_null() => &[],
            _ => {
                let message = format!("{what} are a mapping, but here is {}", node.kind());
                self.error(node.span.clone(), message, "write `name: …` for each".to_owned());
                &[]
            }
        }
    }

    /// A mapping with the keys of `G`; `at` is where to say that one is missing.
    pub fn fields<'n, G: Grammar>(&mut self, node: &'n Node, at: Span) -> Option<Fields<'n>> {
        self.mapping(G::WHAT, G::KEYS.to_vec(), node, at)
    }

    /// A mapping with these keys; `at` is where to say that one is missing.
    pub fn mapping<'n>(
        &mut self,
        what: &'static str,
        keys: Vec<&'static str>,
        node: &'n Node,
        at: Span,
    ) -> Option<Fields<'n>> {
        let entries: &[Entry] = match &node.value {
            Value::Mapping(entries) => entries,
            Value::Scalar(scalar) if scalar.is_null() => &[],
            _ => {
                let message = format!("{what} is a mapping, but here is {}", node.kind());
                let help = format!("its keys are {}", suggest::list(&keys));
                self.error(node.span.clone(), message, help);
                return None;
            }
        };
        for entry in entries.iter().filter(|entry| !keys.contains(&entry.key.as_str())) {
            let message = format!("{what} has no `{}`", clip(&entry.key));
            let help = if entry.key.contains(':') {
                Some("a space belongs behind the `:`".to_owned())
            } else {
                suggest::help(&entry.key, "keys", keys.iter().copied())
            };
            self.error(entry.key_span.clone(), message, help);
        }
        let entries =
            entries.iter().map(|entry| (entry.key.as_str(), (entry.key_span.clone(), &entry.value))).collect();
        Some(Fields { at, what, keys, entries })
    }

    /// The value of a key that must be there.
    pub fn required<'n>(&mut self, fields: &Fields<'n>, key: &str) -> Option<&'n Node> {
        let found = fields.get(key);
        if found.is_none() {
            self.error(fields.at.clone(), format!("{} needs `{key}`", fields.what), None);
        }
        found
    }

    /// The only entry of a mapping that chooses a kind: `{ torque: … }`.
    pub fn only<'n, G: Grammar>(&mut self, node: &'n Node, at: Span) -> Option<&'n Entry> {
        self.kind_of_entry(G::WHAT, G::KEYS, node, at)
    }

    /// The only entry of a mapping that chooses one of these kinds.
    pub fn kind_of_entry<'n>(&mut self, what: &str, known: &[&str], node: &'n Node, at: Span) -> Option<&'n Entry> {
        let kinds = || suggest::list(known);
        match &node.value {
            Value::Mapping(entries) => match entries.as_slice() {
                [entry] if known.contains(&entry.key.as_str()) => Some(entry),
                [entry] => {
                    let message = format!("`{}` is not a kind of {}", clip(&entry.key), bare(what));
                    let help = suggest::help(&entry.key, "kinds", known.iter().copied());
                    self.error(entry.key_span.clone(), message, help);
                    None
                }
                [] => {
                    self.error(at, format!("{} needs a kind", what), format!("the kinds are {}", kinds()));
                    None
                }
                [_, second, ..] => {
                    let message = format!("{} has one kind, but `{}` is a second key", what, clip(&second.key));
                    let help = format!("write `name: {{ kind: … }}`, with one of {}", kinds());
                    self.error(second.key_span.clone(), message, help);
                    None
                }
            },
            _ => {
                let message = format!("{} is a mapping of its kind, but here is {}", what, node.kind());
                let help = format!("write `{{ kind: … }}`; the kinds are {}", kinds());
                self.error(if node.is_null() { at } else { node.span.clone() }, message, help);
                None
            }
        }
    }

    /// Whether the key can be a name; says so where it cannot.
    pub fn name(&mut self, entry: &Entry, what: &str) -> bool {
        let name = entry.key.as_str();
        let mut letters = name.chars();
        let well_formed = letters.next().is_some_and(|c| c.is_alphabetic() || c == '_')
            && letters.all(|c| c.is_alphanumeric() || c == '_');
        if !well_formed {
            let message = format!("`{}` cannot be the name of {what}", clip(name));
            self.error(
                entry.key_span.clone(),
                message,
                "a name is made of letters, digits and `_`, a letter first".to_owned(),
            );
        } else if names::is_reserved(name) {
            let message = format!("`{name}` cannot be the name of {what}: it has a meaning of its own in formulas");
            self.error(entry.key_span.clone(), message, None);
            return false;
        }
        well_formed
    }

    /// A piece of text that is there.
    pub fn scalar<'n>(&mut self, node: &'n Node, wanted: &str) -> Option<&'n Scalar> {
        match node.scalar() {
            Some(scalar) if !scalar.is_null() => Some(scalar),
            _ => {
                self.error(node.span.clone(), format!("{wanted} belongs here, but here is {}", node.kind()), None);
                None
            }
        }
    }

    /// A list of two.
    pub fn two<'n>(&mut self, node: &'n Node, wanted: &str) -> Option<[&'n Node; 2]> {
        let found = match &node.value {
            Value::Sequence(items) => match items.as_slice() {
                [first, second] => return Some([first, second]),
                items => format!("a list of {}", items.len()),
            },
            _ => node.kind().to_owned(),
        };
        self.error(node.span.clone(), format!("{wanted} belongs here, but here is {found}"), None);
        None
    }

    /// One of a few words.
    pub fn choice<T: Copy>(&mut self, node: &Node, choices: &[(&str, T)]) -> Option<T> {
        let words: Vec<&str> = choices.iter().map(|(word, _)| *word).collect();
        let scalar = self.scalar(node, &format!("one of {}", suggest::list(&words)))?;
        let found = choices.iter().find(|(word, _)| *word == scalar.text);
        if found.is_none() {
            let message = format!("`{}` is not one of {}", clip(&scalar.text), suggest::list(&words));
            let help = suggest::nearest(&scalar.text, words).map(|near| format!("did you mean `{near}`?"));
            self.error(node.span.clone(), message, help);
        }
        found.map(|(_, value)| *value)
    }

    /// A whole number in a range.
    pub fn count(&mut self, node: &Node, least: usize, most: usize) -> Option<usize> {
        let wanted = format!("a whole number from {least} to {most}");
        let scalar = self.scalar(node, &wanted)?;
        let number = scalar.text.parse::<usize>().ok().filter(|number| (least..=most).contains(number));
        if number.is_none() {
            self.error(node.span.clone(), format!("`{}` is not {wanted}", clip(&scalar.text)), None);
        }
        number
    }

    /// What stands in a field, its names not yet looked at.
    pub fn written(&mut self, node: &Node) -> Option<Written> {
        let scalar = self.scalar(node, "a number or a formula")?;
        if let Some((value, unit, start)) = number_and_unit(&scalar.text) {
            if unit == "%" {
                let help = "write the number itself: 1% is 0.01".to_owned();
                self.error(node.span.clone(), "`%` can stand only in a tolerance", help);
                return None;
            }
            return match Unit::parse(unit) {
                Ok(unit) => Some(Written::Quantity { value, unit }),
                Err(error) => {
                    let part = start + error.span.start..start + error.span.end;
                    self.error(scalar.place(&node.span, part), error.message, error.help);
                    None
                }
            };
        }
        self.parse(node, scalar, 0..scalar.text.len()).map(Written::Formula)
    }

    /// The formula in a part of a scalar.
    pub fn parse(&mut self, node: &Node, scalar: &Scalar, part: Span) -> Option<Formula> {
        let text = &scalar.text[part.clone()];
        let infinite = text.trim().trim_start_matches(['+', '-']).to_lowercase();
        if matches!(infinite.as_str(), ".inf" | ".nan") {
            self.error(node.span.clone(), format!("`{}` is not a finite number", text.trim()), None);
            return None;
        }
        let tables: Vec<_> = self.tables.iter().map(|table| (table.name.as_str(), table.spline)).collect();
        match Formula::parse_with(text, &tables) {
            Ok(formula) if formula.terms().len() > MAX_TERMS => {
                let message = format!("the formula has more than {MAX_TERMS} operations");
                self.error(node.span.clone(), message, "split it into parameters".to_owned());
                None
            }
            Ok(formula) => Some(formula),
            Err(error) => {
                let span = part.start + error.span.start..part.start + error.span.end;
                self.error(scalar.place(&node.span, span), error.message, error.help);
                None
            }
        }
    }

    /// Whether every name of the formula may stand in the context; `offset` is where the formula begins in the scalar.
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
                Ok(_) => {}
                Err(error) => {
                    all_known = false;
                    let start = offset + span.start;
                    let part = start + error.part.start..start + error.part.end;
                    let place =
                        node.scalar().map_or_else(|| node.span.clone(), |scalar| scalar.place(&node.span, part));
                    self.diagnostics.push(Diagnostic::error(place, error.message).help(error.help));
                }
            }
        }
        all_known
    }

    /// What a name stands for; effects that are not in the model are numbered after those that are.
    pub fn symbol(&self, name: &str) -> Option<Symbol> {
        names::symbol(&self.model, name).or_else(|| self.unread_measure(name)?.ok())
    }

    /// What a name stands for where it may stand for that.
    fn resolve(&self, name: &str, context: Context) -> Result<Symbol, NameError> {
        match names::symbol(&self.model, name) {
            Some(symbol) => names::allowed(name, symbol, context),
            None => match self.unread_measure(name) {
                Some(own) => own.and_then(|symbol| names::allowed(name, symbol, context)),
                None => Err(names::unknown(&self.model, name, context)),
            },
        }
    }

    /// What an effect measures that is not in the model; nothing where the name is of something else.
    fn unread_measure(&self, name: &str) -> Option<Result<Symbol, NameError>> {
        let (owner, member) = name.split_once('.')?;
        if self.model.body(owner).is_some() || self.model.joint(owner).is_some() {
            return None;
        }
        let unread = self.unread.iter().position(|(known, _)| known == owner)?;
        let measures = &self.unread[unread].1;
        let found = measures.iter().find(|(measure, _)| measure.name() == member);
        Some(match found {
            Some(&(measure, _)) => Ok(Symbol::Sensor { effect: self.model.effects() + unread, measure }),
            None => Err(names::no_measure(owner, member, measures)),
        })
    }

    /// The formula's dimension; what does not go together in it is reported.
    pub fn kind(&mut self, node: &Node, formula: &Formula, offset: usize) -> Kind {
        let mut mismatches = Vec::new();
        let name = |name: &str| match self.variable {
            Some((own, dimension)) if own == name => Kind::motion(dimension),
            _ => self.symbol(name).map_or(Kind::Any, |symbol| self.kind_of(symbol)),
        };
        let kind = dimension::analyse(formula, name, |spline| self.table(spline), &mut mismatches);
        for mismatch in mismatches {
            let part = offset + mismatch.span.start..offset + mismatch.span.end;
            let place = node.scalar().map_or_else(|| node.span.clone(), |scalar| scalar.place(&node.span, part));
            self.error(place, mismatch.message, None);
        }
        kind
    }

    /// Dimensions of a table's argument and value.
    fn table(&self, spline: Spline) -> [Option<Dimension>; 2] {
        let found = self.tables.iter().find(|table| table.spline == spline);
        found.map_or([None; 2], |table| table.dimensions)
    }

    /// The dimension of what a name stands for. An equation's multiplier is the force that goes with what it equates.
    fn kind_of(&self, symbol: Symbol) -> Kind {
        if let Symbol::Reaction { joint, component: ReactionComponent::Force } = symbol
            && let Some(left) = self.model.equated(joint)
        {
            let name = |name: &str| self.symbol(name).map_or(Kind::Any, |symbol| names::kind(symbol, &self.kinds));
            let equated = dimension::analyse(left, name, |spline| self.table(spline), &mut Vec::new()).dimension();
            return equated.map_or(Kind::Any, |dimension| Kind::motion(dimension.conjugate()));
        }
        if let Symbol::Sensor { effect, measure } = symbol {
            let unread = effect.checked_sub(self.model.effects()).and_then(|unread| self.unread.get(unread));
            let measures = unread.map_or_else(|| self.model.measures(effect), |(_, measures)| measures.clone());
            let dimension = measures.into_iter().find(|(known, _)| *known == measure).map(|(_, dimension)| dimension);
            return dimension.map_or(Kind::Any, Kind::motion);
        }
        names::kind(symbol, &self.kinds)
    }

    /// Reports where something stands that does not belong there.
    pub fn check_fits(&mut self, span: &Span, found: Dimension, wanted: Dimension) -> bool {
        let fits = found.fits(wanted);
        if !fits {
            self.error(span.clone(), format!("{found} stands where {wanted} belongs"), None);
        }
        fits
    }

    /// A formula or a number with its unit, of a dimension.
    pub fn formula(&mut self, node: &Node, context: Context, wanted: Dimension) -> Option<Formula> {
        let formula = match self.written(node)? {
            Written::Quantity { value, unit } => {
                self.check_fits(&node.span, unit.dimension, wanted).then(|| Formula::number(unit.to_si(value)))?
            }
            Written::Formula(formula) => {
                if !self.check_names(node, &formula, 0, context) {
                    return None;
                }
                if let Some(found) = self.kind(node, &formula, 0).dimension() {
                    self.check_fits(&node.span, found, wanted);
                }
                formula
            }
        };
        self.require(node, &formula, |_| true, "");
        Some(formula)
    }

    /// A formula or a number with its unit that is what it must be.
    pub fn quantity(&mut self, node: &Node, quantity: &Quantity) -> Option<Formula> {
        let formula = self.formula(node, quantity.context, quantity.dimension())?;
        if let Some(Requirement { holds, message }) = quantity.requirement {
            self.require(node, &formula, holds, message);
        }
        Some(formula)
    }

    /// Reports where the second of two keys is not larger than the first.
    pub fn ordered(&mut self, fields: &Fields, (low, first): (&str, &Formula), (high, second): (&str, &Formula)) {
        for corner in 0..self.corners.len() {
            let values = self.evaluate(first, corner).zip(self.evaluate(second, corner));
            if let Some((first, second)) = values.filter(|(first, second)| first >= second) {
                let label = &self.corners[corner].label;
                let message = format!("`{high}` ({second}) must be larger than `{low}` ({first}){label}");
                self.error(fields.key_span(high), message, None);
                return;
            }
        }
    }

    /// Reports two keys of which only one may be there, at the first.
    pub fn exclude(&mut self, fields: &Fields, [first, second]: [&str; 2]) {
        if fields.get(first).is_some() && fields.get(second).is_some() {
            self.error(fields.key_span(first), format!("`{first}` and `{second}` exclude each other"), None);
        }
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

    /// Checks a formula of parameters at all their corners; a formula with other names is not checked.
    pub fn require(&mut self, node: &Node, formula: &Formula, holds: impl Fn(f64) -> bool, requirement: &str) {
        let varies = self.is_uncertain(formula);
        let corners = if varies { self.corners.len() } else { self.corners.len().min(1) };
        for corner in 0..corners {
            let Some(value) = self.evaluate(formula, corner) else { return };
            if self.broken && !value.is_finite() {
                return;
            }
            let problem = if !value.is_finite() {
                // Reported where every formula is checked to be finite.
                if !requirement.is_empty() {
                    return;
                }
                "is not a finite number"
            } else if !holds(value) {
                requirement
            } else {
                continue;
            };
            let text = node.scalar().map_or("", |scalar| scalar.text.as_str());
            let label = &self.corners[corner].label;
            let message = if formula.as_number().is_some() || !value.is_finite() {
                format!("`{}` {problem}{label}", clip(text))
            } else {
                format!("`{}` {problem}, but is {value}{label}", clip(text))
            };
            self.error(node.span.clone(), message, None);
            return;
        }
    }

    /// The formula's value at a corner; `None` where it is made of more than parameters.
    pub fn evaluate(&self, formula: &Formula, corner: usize) -> Option<f64> {
        let corner = self.corners.get(corner)?;
        evaluate(formula, |name| match self.symbol(name) {
            Some(Symbol::Parameter(index)) => corner.values.get(index).copied(),
            _ => None,
        })
    }

    /// Whether an uncertain parameter stands behind a name of the formula.
    pub fn is_uncertain(&self, formula: &Formula) -> bool {
        formula.names().any(|(name, _)| match self.symbol(name) {
            Some(Symbol::Parameter(index)) => self.varies.get(index).copied().unwrap_or(false),
            _ => false,
        })
    }

    /// A number that is the same for every sample.
    pub fn number(&mut self, node: &Node, wanted: Dimension) -> Option<f64> {
        let formula = self.formula(node, Context::Constant, wanted)?;
        if self.is_uncertain(&formula) {
            let message = "this number is one for all samples, so it cannot depend on an uncertain parameter";
            self.error(node.span.clone(), message, None);
            return None;
        }
        self.evaluate(&formula, 0).filter(|value| value.is_finite())
    }
}

/// The formula's value, each name's given by `name`.
pub fn evaluate(formula: &Formula, name: impl Fn(&str) -> Option<f64>) -> Option<f64> {
    let builder = Builder::new();
    let built = formula.build(&builder, |text| name(text).map(|value| builder.number(value)).ok_or(()));
    built.ok()?.as_constant()
}

/// `a joint` → `joint`.
fn bare(what: &str) -> &str {
    what.strip_prefix("a ").or_else(|| what.strip_prefix("an ")).unwrap_or(what)
}
