//! By what a motion is integrated: the scheme, and the levels that it is extrapolated over.

use super::description::SchemeChoice;
use super::names::Reader;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;

/// The words of `scheme`.
const SCHEMES: [(&str, SchemeChoice); 3] =
    [("auto", SchemeChoice::Auto), ("hht", SchemeChoice::Hht), ("explicit", SchemeChoice::Explicit)];

/// Levels that can be combined. A fifth gains nothing that rounding leaves.
pub const EXTRAPOLATION_LEVELS: std::ops::RangeInclusive<usize> = 2..=4;

/// Reads `scheme` and `extrapolation`.
pub(super) fn read(reader: &mut Reader, fields: &Fields) -> Option<(SchemeChoice, Option<usize>)> {
    let scheme = match fields.get("scheme") {
        Some(node) => reader.choice(node, &SCHEMES),
        None => Some(SchemeChoice::Auto),
    };
    let levels = match fields.get("extrapolation") {
        None => Some(None),
        Some(node) => match reader.number(node, Dimension::NUMBER)? {
            number if EXTRAPOLATION_LEVELS.clone().any(|levels| levels as f64 == number) => Some(Some(number as usize)),
            number => {
                let message = format!("`extrapolation` combines 2, 3 or 4 step lengths, not {number}");
                let help = "each level halves the steps; 3 levels take 7 times the steps and are of order 4".to_owned();
                reader.diagnostics.push(Diagnostic::error(Code::OutOfRange, node.span.clone(), message).help(help));
                None
            }
        },
    };
    if let (Some(SchemeChoice::Explicit), Some(node)) = (scheme, fields.get("extrapolation")) {
        let message = "`extrapolation` is of HHT-I3, but the `scheme` is `explicit`";
        reader.diagnostics.push(
            Diagnostic::error(Code::ExclusiveKeys, node.span.clone(), message).help("leave one of them out".to_owned()),
        );
    }
    Some((scheme?, levels?))
}
