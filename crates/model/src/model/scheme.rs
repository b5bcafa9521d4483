//! Integration of a motion: the scheme, and the levels that it is extrapolated over.

use super::description::SchemeChoice;
use super::names::Reader;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;

/// The words of `scheme`.
const SCHEMES: [(&str, SchemeChoice); 3] =
    [("auto", SchemeChoice::Auto), ("hht", SchemeChoice::Hht), ("explicit", SchemeChoice::Explicit)];

/// Why an explicit scheme is not extrapolated.
pub const NOT_OF_EXPLICIT: &str = "`extrapolation` is of HHT-I3, but the `scheme` is `explicit`";

/// Why this number of levels is refused, if it is. A fifth level gains nothing above rounding.
pub fn refused_levels(levels: f64) -> Option<String> {
    let is_allowed = [2.0, 3.0, 4.0].contains(&levels);
    (!is_allowed).then(|| format!("`extrapolation` combines 2, 3 or 4 step lengths, not {levels}"))
}

/// Why the scheme has no such α, if it has not. The end of the range is a third, which no decimal is exactly.
pub fn refused_alpha(alpha: f64) -> Option<String> {
    (!(-1.0 / 3.0 - 1e-9..0.0).contains(&alpha)).then(|| format!("α = {alpha} is outside [-1/3, 0)"))
}

/// Reads `scheme` and `extrapolation`.
pub(super) fn read(reader: &mut Reader, fields: &Fields) -> Option<(SchemeChoice, Option<usize>)> {
    let scheme = match fields.get("scheme") {
        Some(node) => reader.choice(node, &SCHEMES),
        None => Some(SchemeChoice::Auto),
    };
    let levels = match fields.get("extrapolation") {
        None => Some(None),
        Some(node) => match reader.number(node, Dimension::NUMBER).map(|levels| (levels, refused_levels(levels)))? {
            (levels, None) => Some(Some(levels as usize)),
            (_, Some(message)) => {
                let help = "each level halves the steps; 3 levels take 7 times the steps and are of order 4".to_owned();
                reader.diagnostics.push(Diagnostic::error(Code::OutOfRange, node.span.clone(), message).help(help));
                None
            }
        },
    };
    if let (Some(SchemeChoice::Explicit), Some(node)) = (scheme, fields.get("extrapolation")) {
        let wrong = Diagnostic::error(Code::ExclusiveKeys, node.span.clone(), NOT_OF_EXPLICIT);
        reader.diagnostics.push(wrong.help("leave one of them out".to_owned()));
    }
    Some((scheme?, levels?))
}
