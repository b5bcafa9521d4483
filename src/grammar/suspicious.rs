//! Bare numbers that are probably in another unit than SI: an angle of 30 rad, a length of 150 m beside others of millimetres.

use std::f64::consts::TAU;

use symdiff::Formula;

use super::quantity::Dimension;
use super::reader::Reader;
use super::symbols::SymbolTable;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest::clip;
use crate::syntax::yaml::Node;

/// An angle beyond this is more than a turn; a turn itself may be written with few digits.
const TURN: f64 = 1.001 * TAU;

/// A length beyond this does not go with those below the other, m.
const LARGE: f64 = 100.0;
const SMALL: f64 = 0.1;

impl<S: SymbolTable> Reader<'_, S> {
    /// Looks at a formula where a quantity of a dimension belongs.
    pub(super) fn suspect_formula(&mut self, node: &Node, formula: &Formula, wanted: Dimension) {
        let Some(number) = formula.as_number() else { return };
        let text = || node.scalar().map_or_else(String::new, |scalar| scalar.text.trim().to_owned());
        if wanted == Dimension::ANGLE && number.abs() > TURN {
            let help =
                format!("a bare angle is in rad: write `{0} deg`, or `{0} rad` where that is meant", clip(&text()));
            let message = "an angle of more than a turn has no unit";
            self.diagnostics.push(Diagnostic::warning(node.span.clone(), message).help(help));
        }
        if wanted == Dimension::LENGTH && number.abs() > LARGE {
            self.lengths.large.push((node.span.clone(), text()));
        }
        self.suspect_quantity(number, wanted);
    }

    /// Looks at a number in SI.
    pub(super) fn suspect_quantity(&mut self, number: f64, wanted: Dimension) {
        self.lengths.small |= wanted == Dimension::LENGTH && number != 0.0 && number.abs() <= SMALL;
    }

    /// Warns of large lengths beside small ones, once all are read.
    pub fn warn_of_lengths(&mut self) {
        if !self.lengths.small {
            return;
        }
        for (span, text) in std::mem::take(&mut self.lengths.large) {
            let help = format!("a bare length is in m: write `{0} mm`, or `{0} m` where that is meant", clip(&text));
            let message = "a length above 100 m has no unit, beside others of millimetres";
            self.diagnostics.push(Diagnostic::warning(span, message).help(help));
        }
    }
}
