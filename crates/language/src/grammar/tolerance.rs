//! A number with its deviation, written in one piece: only this module reads this notation.
//!
//! ```text
//! 0.5 m ± 1%          ± may be written +/- or +-; without a unit, the deviation has the value's
//! (150 ± 2) mm        a unit for both
//! 0.5 m +0.01 -0.02   upwards and downwards; no space between sign and number
//! [0.49, 0.51] m      the smallest and the largest value; [490 mm, 0.51 m]
//! 12 mm H7            a tolerance class: H7, g6, IT8, ISO 2768-m
//! ± 1%, 1%, H7        the deviation alone, of a value that is given elsewhere
//! ```

use super::fits::ToleranceClass;
use super::unit::{Unit, number_and_unit};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Node, Scalar, Value};

/// Signs between a value and its deviation.
const SIGNS: [&str; 3] = ["±", "+/-", "+-"];

/// Separator of the ends of a range.
const TO: &str = " to ";

/// A number in parts, each with its location.
#[derive(Clone, Debug)]
pub struct Toleranced {
    /// The value, a number or a formula; absent if only the deviation is written.
    pub value: Option<Node>,
    /// Its deviation.
    pub deviation: Option<Deviation>,
}

/// Permitted deviation of a number.
#[derive(Clone, Debug)]
pub enum Deviation {
    /// The same upwards and downwards.
    Either(Node),
    /// Upwards and downwards.
    Sides {
        /// Upwards.
        plus: Node,
        /// Downwards.
        minus: Node,
    },
    /// A list of the smallest and the largest value.
    Between(Node),
    /// That of a tolerance class, by the size.
    Class(Node),
}

/// Splits a number. A text of none of the forms is a value without a deviation.
///
/// # Errors
/// A form that is begun but not finished.
pub fn read(node: &Node) -> Result<Toleranced, Box<Diagnostic>> {
    let scalar = match &node.value {
        Value::Scalar(scalar) => scalar,
        Value::Sequence(_) => return Ok(Toleranced::of(None, Deviation::Between(node.clone()))),
        Value::Mapping(_) => return Ok(Toleranced { value: Some(node.clone()), deviation: None }),
    };
    let whole = Text { node, scalar };
    let all = whole.trimmed(0..scalar.text.len());
    let text = &scalar.text[all.clone()];
    if text.starts_with('[') {
        return whole.interval(all).map(|between| Toleranced::of(None, between));
    }
    if let Some(inner) = whole.bracketed(all.clone()) {
        return Ok(inner);
    }
    if let Some((at, length)) = sign(text) {
        let (left, right) = (all.start..all.start + at, all.start + at + length..all.end);
        let (left, right) = (whole.trimmed(left), whole.trimmed(right));
        let sign_text = &text[at..at + length];
        let problem = if right.is_empty() {
            Some(format!("a number belongs behind the `{sign_text}`"))
        } else {
            sign(&scalar.text[right.clone()]).map(|_| format!("a tolerance has one `{sign_text}`"))
        };
        if let Some(problem) = problem {
            let diagnostic = Diagnostic::error(Code::BadTolerance, scalar.place(&node.span, all), problem);
            return Err(Box::new(diagnostic.help("e.g. `0.5 m ± 1%`".to_owned())));
        }
        let unit = own_unit(&scalar.text[left.clone()]);
        let value = (!left.is_empty()).then(|| whole.part(left));
        return Ok(Toleranced::of(value, Deviation::Either(whole.with_unit(right, unit))));
    }
    if let Some((value, plus, minus)) = sides(text) {
        let shifted = |part: Span| whole.trimmed(all.start + part.start..all.start + part.end);
        let unit = own_unit(&text[value.clone()]);
        let deviation = Deviation::Sides {
            plus: whole.with_unit(shifted(plus), unit),
            minus: whole.with_unit(shifted(minus), unit),
        };
        let value = shifted(value);
        let value = (!value.is_empty()).then(|| whole.part(value));
        return Ok(Toleranced::of(value, deviation));
    }
    if let Some(class) = class(text) {
        let at = all.end - class.len();
        let value = whole.trimmed(all.start..at);
        let value = (!value.is_empty()).then(|| whole.part(value));
        return Ok(Toleranced::of(value, Deviation::Class(whole.part(at..all.end))));
    }
    let percentage = number_and_unit(text).is_some_and(|(_, unit, _)| unit == "%");
    if percentage {
        return Ok(Toleranced::of(None, Deviation::Either(node.clone())));
    }
    Ok(Toleranced { value: Some(node.clone()), deviation: None })
}

/// The ends of `0.2 to 0.3 m`, `[0.2, 0.3] m` or a list; `None` for any other form.
///
/// # Errors
/// An interval that is begun but not finished.
pub fn range(node: &Node) -> Result<Option<[Node; 2]>, Box<Diagnostic>> {
    let ends = match &node.value {
        Value::Scalar(scalar) if !scalar.text.trim_start().starts_with('[') => {
            let whole = Text { node, scalar };
            let Some(at) = scalar.text.find(TO) else { return Ok(None) };
            let [left, right] = [0..at, at + TO.len()..scalar.text.len()].map(|part| whole.trimmed(part));
            let unit = own_unit(&scalar.text[right.clone()]);
            return Ok(Some([whole.with_unit(left, unit), whole.part(right)]));
        }
        _ => read(node)?.deviation,
    };
    let Some(Deviation::Between(Node { value: Value::Sequence(ends), .. })) = ends else { return Ok(None) };
    Ok(<[Node; 2]>::try_from(ends).ok())
}

/// Whether a text is a number with a tolerance, and not a formula. In a formula `+-` is a sum with a negative number.
pub fn is_toleranced(text: &str) -> bool {
    text.contains('±') || text.contains("+/-") || text.trim_start().starts_with('[')
}

impl Toleranced {
    fn of(value: Option<Node>, deviation: Deviation) -> Self {
        Self { value, deviation: Some(deviation) }
    }
}

/// A scalar whose parts become nodes.
struct Text<'n> {
    node: &'n Node,
    scalar: &'n Scalar,
}

impl Text<'_> {
    /// A range without the space around it.
    fn trimmed(&self, range: Span) -> Span {
        let text = &self.scalar.text[range.clone()];
        let start = range.start + text.len() - text.trim_start().len();
        start..start + text.trim().len()
    }

    fn part(&self, range: Span) -> Node {
        let start = self.scalar.start.map(|start| start + range.start);
        let scalar =
            Scalar { scope: self.scalar.scope.clone(), ..Scalar::plain(&self.scalar.text[range.clone()], start) };
        Node { span: self.scalar.place(&self.node.span, range), value: Value::Scalar(scalar) }
    }

    /// A part with a unit, unless it has its own.
    fn with_unit(&self, range: Span, unit: Option<&str>) -> Node {
        let text = &self.scalar.text[range.clone()];
        let part = self.part(range.clone());
        match unit {
            Some(unit) if !unit.is_empty() && text.parse::<f64>().is_ok() => {
                let scalar =
                    Scalar { scope: self.scalar.scope.clone(), ..Scalar::plain(format!("{text} {unit}"), None) };
                Node { value: Value::Scalar(scalar), ..part }
            }
            _ => part,
        }
    }

    /// `[lower, upper] unit`
    fn interval(&self, all: Span) -> Result<Deviation, Box<Diagnostic>> {
        let text = &self.scalar.text[all.clone()];
        let wrong = |message: &str| {
            let place = self.scalar.place(&self.node.span, all.clone());
            Err(Box::new(
                Diagnostic::error(Code::BadTolerance, place, message).help("e.g. `[0.49, 0.51] m`".to_owned()),
            ))
        };
        let Some(close) = text.rfind(']') else { return wrong("the interval's `]` is missing") };
        let &[first, _] = text[1..close].split(',').collect::<Vec<_>>().as_slice() else {
            return wrong("an interval has two ends");
        };
        let comma = first.len();
        let unit = text[close + 1..].trim();
        let end = |from: usize, to: usize| {
            let range = self.trimmed(all.start + from..all.start + to);
            self.with_unit(range, Some(unit))
        };
        let ends = vec![end(1, 1 + comma), end(2 + comma, close)];
        let span = self.scalar.place(&self.node.span, all.clone());
        Ok(Deviation::Between(Node { span, value: Value::Sequence(ends) }))
    }

    /// `(value ± deviation) unit`
    fn bracketed(&self, all: Span) -> Option<Toleranced> {
        let text = &self.scalar.text[all.clone()];
        let close = text.strip_prefix('(')?.find(')')? + 1;
        let (inner, unit) = (&text[1..close], text[close + 1..].trim());
        let (at, length) = sign(inner)?;
        let range = |from: usize, to: usize| self.trimmed(all.start + 1 + from..all.start + 1 + to);
        let parts = [range(0, at), range(at + length, inner.len())];
        let numbers =
            parts.iter().all(|part| self.scalar.text[part.clone()].trim_end_matches('%').parse::<f64>().is_ok());
        let [value, deviation] = parts.map(|part| self.with_unit(part, Some(unit)));
        numbers.then(|| Toleranced::of(Some(value), Deviation::Either(deviation)))
    }
}

/// The tolerance class at the end of a text, after a number or alone.
fn class(text: &str) -> Option<&str> {
    let is_behind_size = |at: usize| {
        let size = &text[..at];
        let is_number = || number_and_unit(size).is_some() || size.trim().parse::<f64>().is_ok();
        size.is_empty() || size.ends_with(char::is_whitespace) && is_number()
    };
    let last_word = text.char_indices().rev().find(|(_, letter)| letter.is_whitespace());
    let starts = text.rfind("ISO").into_iter().chain(last_word.map(|(at, space)| at + space.len_utf8())).chain([0]);
    starts.filter(|&at| is_behind_size(at)).map(|at| &text[at..]).find(|class| ToleranceClass::parse(class).is_some())
}

/// The unit of a number with a unit.
fn own_unit(text: &str) -> Option<&str> {
    let (_, unit, _) = number_and_unit(text)?;
    Unit::parse(unit).is_ok().then_some(unit)
}

/// The first `±` outside of parentheses: its offset and its length.
fn sign(text: &str) -> Option<(usize, usize)> {
    let mut depth = 0_usize;
    for (at, letter) in text.char_indices() {
        match letter {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            '±' | '+' if depth == 0 => {
                if let Some(sign) = SIGNS.iter().find(|sign| text[at..].starts_with(**sign)) {
                    return Some((at, sign.len()));
                }
            }
            _ => {}
        }
    }
    None
}

/// `value +plus -minus`, in either order, perhaps with a `/` between: the spans of the three, the deviations without
/// their signs. The value is a number or nothing, so that no formula is taken for it.
fn sides(text: &str) -> Option<(Span, Span, Span)> {
    let mut found: Vec<(char, Span)> = Vec::new();
    let mut end = text.len();
    for _ in 0..2 {
        let (at, sign) = text[..end]
            .char_indices()
            .rev()
            .find(|&(at, letter)| matches!(letter, '+' | '-') && !text[..at].ends_with(['e', 'E']))?;
        let number = text[at + 1..end].trim_end().trim_end_matches('/').trim_end();
        let is_digit = |letter: char| letter.is_ascii_digit() || letter == '.';
        let is_free = at == 0 || text[..at].ends_with([' ', '/']);
        if !(is_free && number.starts_with(is_digit) && is_number(number)) {
            return None;
        }
        found.push((sign, at + 1..at + 1 + number.len()));
        end = at;
    }
    let value = 0..text[..end].trim_end().len();
    if !(value.is_empty() || is_number(&text[value.clone()])) {
        return None;
    }
    match found.as_slice() {
        [('-', minus), ('+', plus)] | [('+', plus), ('-', minus)] => Some((value, plus.clone(), minus.clone())),
        _ => None,
    }
}

/// Whether a text is a number, perhaps with a unit or a percent sign.
fn is_number(text: &str) -> bool {
    text.trim().parse::<f64>().is_ok_and(f64::is_finite)
        || number_and_unit(text).is_some_and(|(_, unit, _)| !unit.contains(['+', '(']))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(node: &Node) -> String {
        match &node.value {
            Value::Scalar(scalar) => scalar.text.clone(),
            Value::Sequence(items) => format!("[{}]", items.iter().map(text).collect::<Vec<_>>().join(", ")),
            Value::Mapping(_) => "{}".to_owned(),
        }
    }

    fn node(written: &str) -> Node {
        let scalar = Scalar::plain(written, Some(0));
        Node { span: 0..written.len(), value: Value::Scalar(scalar) }
    }

    fn parts(written: &str) -> String {
        let Toleranced { value, deviation } = match read(&node(written)) {
            Ok(found) => found,
            Err(error) => return format!("! {}", error.message),
        };
        let value = value.map_or("-".to_owned(), |value| text(&value));
        match deviation {
            None => value,
            Some(Deviation::Either(either)) => format!("{value} | {}", text(&either)),
            Some(Deviation::Sides { plus, minus }) => format!("{value} | +{} | -{}", text(&plus), text(&minus)),
            Some(Deviation::Between(between)) => format!("{value} | {}", text(&between)),
            Some(Deviation::Class(class)) => format!("{value} | class {}", text(&class)),
        }
    }

    #[test]
    fn every_notation_is_parsed() {
        for (written, wanted) in [
            ("0.5 m ± 1%", "0.5 m | 1%"),
            ("0.5 m±1%", "0.5 m | 1%"),
            ("0.5 m +/- 5 mm", "0.5 m | 5 mm"),
            ("0.5 m +- 0.01", "0.5 m | 0.01 m"),
            ("±1%", "- | 1%"),
            ("+/- 0.5 mm", "- | 0.5 mm"),
            ("1 %", "- | 1 %"),
            ("(150 ± 2) mm", "150 mm | 2 mm"),
            ("(150 ± 2%) mm", "150 mm | 2%"),
            ("2*(a + b) ± 1%", "2*(a + b) | 1%"),
            ("0.5 m +0.01 -0.02", "0.5 m | +0.01 m | -0.02 m"),
            ("0.5 m -2% +1%", "0.5 m | +1% | -2%"),
            ("0.5 m +1 mm / -2e-3", "0.5 m | +1 mm | -2e-3 m"),
            ("-0.5 +0.01/-0", "-0.5 | +0.01 | -0"),
            ("+0.01 -0.02", "- | +0.01 | -0.02"),
            ("[0.49, 0.51] m", "- | [0.49 m, 0.51 m]"),
            ("[490 mm, .51] m", "- | [490 mm, .51 m]"),
            ("[1, 2]", "- | [1, 2]"),
            ("12 mm H7", "12 mm | class H7"),
            ("0.5 in  js9", "0.5 in | class js9"),
            ("120 mm ISO 2768-m", "120 mm | class ISO 2768-m"),
            ("IT8", "- | class IT8"),
            ("25 mm q7", "25 mm | class q7"),
            ("12 H7", "12 | class H7"),
        ] {
            assert_eq!(parts(written), wanted, "{written}");
        }
    }

    #[test]
    fn formulas_stay_formulas() {
        for formula in [
            "1 + 2 - 3",
            "l +1 -2",
            "-1",
            "1e+3 -2",
            "2*l",
            "(1 + 2)*l",
            "0.5 m",
            "",
            "a - +2 -3",
            "3 +2 +1",
            "l h7",
            "2*H7",
            "12 mm*H7",
            "h7 + 1",
        ] {
            assert_eq!(parts(formula), formula, "{formula}");
        }
    }

    #[test]
    fn incomplete_notations_are_refused() {
        assert_eq!(parts("0.5 ±"), "! a number belongs behind the `±`");
        assert_eq!(parts("1 ± 2 +/- 3"), "! a tolerance has one `±`");
        assert_eq!(parts("[1, 2"), "! the interval's `]` is missing");
        assert_eq!(parts("[1]"), "! an interval has two ends");
        assert_eq!(parts("[1, 2, 3] m"), "! an interval has two ends");
    }

    #[test]
    fn parts_have_spans() {
        let Toleranced { value, deviation: Some(Deviation::Sides { plus, minus }) } =
            read(&node("0.5 m +0.01 -1%")).unwrap()
        else {
            panic!("two sides")
        };
        assert_eq!((value.unwrap().span, plus.span, minus.span), (0..5, 7..11, 13..15));
    }
}
