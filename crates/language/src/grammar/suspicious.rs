//! Values that are probably not meant as written: an angle of 30 rad, a length of 150 m next to others of millimetres,
//! an interval that is read as a difference.

use symdiff::Formula;
use symdiff::formula::Term;

use super::quantity::Dimension;
use super::range::{Range, range};
use super::reader::Reader;
use super::symbols::{Symbol, SymbolTable};
use crate::grammar::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::Node;

impl<S: SymbolTable> Reader<'_, S> {
    /// Examines a formula for a quantity of a dimension.
    pub(super) fn suspect_formula(&mut self, node: &Node, formula: &Formula, wanted: Dimension) {
        let (number, bare) = match (formula.as_number(), self.only_parameter(formula)) {
            (Some(number), _) => {
                let text = node.scalar().map_or_else(String::new, |scalar| scalar.text.trim().to_owned());
                (number, Some((None, text)))
            }
            (None, Some((index, name))) => {
                let Some(number) = self.evaluate(formula, 0) else { return };
                let has_unit = self.kinds.get(index).is_some_and(|kind| kind.dimension().is_some());
                (number, (!has_unit).then(|| (Some(name), format!("{number}"))))
            }
            (None, None) => return,
        };
        self.suspect_quantity(number, wanted);
        let Some((name, text)) = bare else { return };
        let of = name.as_ref().map_or_else(String::new, |name| format!(", for `{name}` in `parameters`"));
        // A parameter is examined at its first use.
        let mut is_new = || name.as_ref().is_none_or(|name| self.lengths.said.insert(name.clone()));
        if wanted == Dimension::ANGLE && number.abs() > TUNING.turn && is_new() {
            let help =
                format!("a bare angle is in rad: write `{0} deg`, or `{0} rad` where that is meant{of}", clip(&text));
            let message = "an angle of more than a turn has no unit";
            self.diagnostics.push(Diagnostic::warning(Code::AngleWithoutUnit, node.span.clone(), message).help(help));
        } else if wanted == Dimension::LENGTH && number.abs() > TUNING.large_length && is_new() {
            let help =
                format!("a bare length is in m: write `{0} mm`, or `{0} m` where that is meant{of}", clip(&text));
            self.lengths.large.push((node.span.clone(), help));
        }
    }

    /// Index and name of the parameter of a formula that is just that parameter.
    fn only_parameter(&self, formula: &Formula) -> Option<(usize, String)> {
        let [(Term::Name(name), _)] = formula.terms() else { return None };
        match self.symbol(name) {
            Some(Symbol::Parameter(index)) => Some((index, name.clone())),
            _ => None,
        }
    }

    /// Whether a text is an interval in another notation, which is an error; warns of a difference that may be meant as
    /// one.
    pub(super) fn is_meant_as_interval(&mut self, node: &Node, text: &str) -> bool {
        let Some(Range { interval, is_difference }) = range(text) else { return false };
        let help = format!("an interval is written `{interval}`, in `parameters`");
        if is_difference {
            let message = "a difference of two numbers, the smaller first, may be meant as an interval";
            self.diagnostics
                .push(Diagnostic::warning(Code::DifferenceOfNumbers, node.span.clone(), message).help(help));
        } else {
            self.error(
                Code::MisplacedTolerance,
                node.span.clone(),
                format!("`{}` looks like an interval", clip(text.trim())),
                help,
            );
        }
        !is_difference
    }

    /// Examines a number in SI.
    pub(super) fn suspect_quantity(&mut self, number: f64, wanted: Dimension) {
        self.lengths.small |= wanted == Dimension::LENGTH && number != 0.0 && number.abs() <= TUNING.small_length;
    }

    /// Warns of large lengths next to small ones, after all are read.
    pub fn warn_of_lengths(&mut self) {
        if !self.lengths.small {
            return;
        }
        for (span, help) in std::mem::take(&mut self.lengths.large) {
            let message = "a length above 100 m has no unit, while others are in millimetres";
            self.diagnostics.push(Diagnostic::warning(Code::LengthWithoutUnit, span, message).help(help));
        }
    }
}
