//! Numbers with units: all units, and `120 mm` → 0.12 m.

use std::f64::consts::PI;

use symdiff::SyntaxError;
use symdiff::formula::Quantity;

use super::quantity::Dimension;
use crate::syntax::source::Span;
use crate::syntax::suggest;

/// A unit: a value of 1 in it is `times / over` in SI. Two factors, so that `150 mm` is exactly 0.15 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    times: f64,
    over: f64,
    /// Dimension.
    pub dimension: Dimension,
}

impl Unit {
    /// The unit of a pure number.
    pub const ONE: Self = Self { times: 1.0, over: 1.0, dimension: Dimension::NUMBER };

    /// Converts a value in this unit to SI.
    pub fn to_si(self, value: f64) -> f64 {
        value * self.times / self.over
    }

    /// Whether values need no conversion.
    pub fn is_si(self) -> bool {
        self.times == self.over
    }

    /// Parses `N*s/m`, `kg m^2`, `N·m`, `1/s`, `N/(m/s)`, …
    ///
    /// # Errors
    /// The error and its span in the text.
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        let mut parser = UnitParser { text, position: 0, depth: 0, minutes: false, is_name: None };
        let unit = parser.product()?;
        match parser.peek() {
            None => parser.checked(unit),
            Some(_) => Err(parser.unexpected()),
        }
    }

    /// The unit with which a text in a formula begins, and its length. After an operator between spaces, a name of the
    /// model is not part of the unit (`250 kg/m * L`); after any operator, neither are functions and words of formulas.
    ///
    /// # Errors
    /// The error and its span in the text.
    pub fn leading(text: &str, is_name: impl Fn(&str) -> bool) -> Result<(Self, usize), UnitError> {
        let mut parser = UnitParser { text, position: 0, depth: 0, minutes: false, is_name: Some(&is_name) };
        let unit = parser.product()?;
        let length = text[..parser.position].trim_end().len();
        Ok((parser.checked(unit)?, length))
    }

    /// A number with the unit after it, in a formula.
    ///
    /// # Errors
    /// As of [`Self::leading`].
    pub fn behind(value: f64, text: &str, is_name: impl Fn(&str) -> bool) -> Result<Quantity, SyntaxError> {
        let UnitError { message, span, help } = match Self::leading(text, is_name) {
            Ok((unit, length)) => {
                return Ok(Quantity { value: unit.to_si(value), mark: unit.dimension.mark(), length });
            }
            Err(error) => error,
        };
        Err(SyntaxError { message, span, help })
    }

    fn combine(self, other: Self, divide: bool) -> Self {
        if divide {
            let dimension = self.dimension.per(other.dimension);
            Self { times: self.times * other.over, over: self.over * other.times, dimension }
        } else {
            let dimension = self.dimension.times(other.dimension);
            Self { times: self.times * other.times, over: self.over * other.over, dimension }
        }
    }
}

/// An error in a unit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct UnitError {
    /// Description of the error.
    pub message: String,
    /// Bytes of the text.
    pub span: Span,
    /// Suggested correction.
    pub help: Option<String>,
}

/// Names of units that are written out, and their symbols.
const WORDS: [(&str, &str); 19] = [
    ("meter", "m"),
    ("metre", "m"),
    ("millimeter", "mm"),
    ("millimetre", "mm"),
    ("inch", "in"),
    ("inches", "in"),
    ("foot", "ft"),
    ("feet", "ft"),
    ("gram", "g"),
    ("kilogram", "kg"),
    ("second", "s"),
    ("sec", "s"),
    ("minute", "min"),
    ("hour", "h"),
    ("newton", "N"),
    ("joule", "J"),
    ("degree", "deg"),
    ("radian", "rad"),
    ("percent", "%"),
];

/// Name, value of one in SI as a factor and a divisor, and dimension.
const UNITS: [(&str, f64, f64, Dimension); 63] = [
    ("m", 1.0, 1.0, Dimension::LENGTH),
    ("km", 1e3, 1.0, Dimension::LENGTH),
    ("dm", 1.0, 10.0, Dimension::LENGTH),
    ("cm", 1.0, 100.0, Dimension::LENGTH),
    ("mm", 1.0, 1e3, Dimension::LENGTH),
    ("um", 1.0, 1e6, Dimension::LENGTH),
    ("µm", 1.0, 1e6, Dimension::LENGTH),
    ("μm", 1.0, 1e6, Dimension::LENGTH),
    ("nm", 1.0, 1e9, Dimension::LENGTH),
    ("in", 0.0254, 1.0, Dimension::LENGTH),
    ("ft", 0.3048, 1.0, Dimension::LENGTH),
    ("mil", 0.0254, 1e3, Dimension::LENGTH),
    ("thou", 0.0254, 1e3, Dimension::LENGTH),
    ("l", 1.0, 1e3, Dimension::VOLUME),
    ("L", 1.0, 1e3, Dimension::VOLUME),
    ("kg", 1.0, 1.0, Dimension::MASS),
    ("g", 1.0, 1e3, Dimension::MASS),
    ("mg", 1.0, 1e6, Dimension::MASS),
    ("t", 1e3, 1.0, Dimension::MASS),
    ("lb", 0.453_592_37, 1.0, Dimension::MASS),
    ("s", 1.0, 1.0, Dimension::TIME),
    ("ms", 1.0, 1e3, Dimension::TIME),
    ("us", 1.0, 1e6, Dimension::TIME),
    ("µs", 1.0, 1e6, Dimension::TIME),
    ("min", 60.0, 1.0, Dimension::TIME),
    ("h", 3600.0, 1.0, Dimension::TIME),
    ("rad", 1.0, 1.0, Dimension::ANGLE),
    ("mrad", 1.0, 1e3, Dimension::ANGLE),
    ("deg", PI, 180.0, Dimension::ANGLE),
    ("°", PI, 180.0, Dimension::ANGLE),
    ("rev", 2.0 * PI, 1.0, Dimension::ANGLE),
    ("arcmin", PI, 10_800.0, Dimension::ANGLE),
    ("arcsec", PI, 648_000.0, Dimension::ANGLE),
    ("rpm", 2.0 * PI, 60.0, Dimension::ANGULAR_VELOCITY),
    ("N", 1.0, 1.0, Dimension::FORCE),
    ("mN", 1.0, 1e3, Dimension::FORCE),
    ("daN", 10.0, 1.0, Dimension::FORCE),
    ("kN", 1e3, 1.0, Dimension::FORCE),
    ("MN", 1e6, 1.0, Dimension::FORCE),
    ("lbf", 4.448_221_615_260_5, 1.0, Dimension::FORCE),
    ("kgf", 9.806_65, 1.0, Dimension::FORCE),
    ("Nm", 1.0, 1.0, Dimension::TORQUE),
    ("Nmm", 1.0, 1e3, Dimension::TORQUE),
    ("kNm", 1e3, 1.0, Dimension::TORQUE),
    ("J", 1.0, 1.0, Dimension::TORQUE),
    ("mJ", 1.0, 1e3, Dimension::TORQUE),
    ("kJ", 1e3, 1.0, Dimension::TORQUE),
    ("MJ", 1e6, 1.0, Dimension::TORQUE),
    ("W", 1.0, 1.0, Dimension::POWER),
    ("mW", 1.0, 1e3, Dimension::POWER),
    ("kW", 1e3, 1.0, Dimension::POWER),
    ("MW", 1e6, 1.0, Dimension::POWER),
    // 550 ft·lbf/s.
    ("hp", 550.0 * 0.3048 * 4.448_221_615_260_5, 1.0, Dimension::POWER),
    ("Pa", 1.0, 1.0, Dimension::PRESSURE),
    ("hPa", 100.0, 1.0, Dimension::PRESSURE),
    ("kPa", 1e3, 1.0, Dimension::PRESSURE),
    ("MPa", 1e6, 1.0, Dimension::PRESSURE),
    ("GPa", 1e9, 1.0, Dimension::PRESSURE),
    ("bar", 1e5, 1.0, Dimension::PRESSURE),
    ("mbar", 100.0, 1.0, Dimension::PRESSURE),
    // lbf/in².
    ("psi", 4.448_221_615_260_5, 0.000_645_16, Dimension::PRESSURE),
    ("ppm", 1.0, 1e6, Dimension::NUMBER),
    ("1", 1.0, 1.0, Dimension::NUMBER),
];

/// Every unit that has a name, in the table's order.
pub fn named_units() -> impl Iterator<Item = (&'static str, Unit)> {
    UNITS.iter().map(|&(name, times, over, dimension)| (name, Unit { times, over, dimension }))
}

struct UnitParser<'t> {
    text: &'t str,
    position: usize,
    depth: usize,
    /// Whether minutes or hours are part of the unit.
    minutes: bool,
    /// Names of the formula that continues after the unit; `None` if the text is a unit alone.
    is_name: Option<&'t dyn Fn(&str) -> bool>,
}

impl UnitParser<'_> {
    /// Refuses a frequency that may be in revolutions or radians.
    fn checked(&self, unit: Unit) -> Result<Unit, UnitError> {
        if !(unit.dimension == Dimension::NUMBER.per(Dimension::TIME) && self.minutes) {
            return Ok(unit);
        }
        let text = self.text[..self.position].trim();
        Err(UnitError {
            message: format!("`{}` may be revolutions or radians", suggest::clip(text)),
            span: 0..self.position,
            help: Some("write `rpm` for revolutions, `rad/min` for radians a minute".to_owned()),
        })
    }

    /// Whether the formula continues at an index of the text, before an operator or a word.
    fn ends_before(&self, index: usize) -> bool {
        let Some(is_name) = self.is_name else { return false };
        let rest = &self.text[index..];
        let Some(first) = rest.chars().next() else { return true };
        let operator = matches!(first, '*' | '·' | '⋅' | '/');
        if !(operator || first.is_alphabetic() || first == '°' || first == '(') {
            return true;
        }
        let behind = if operator { rest[first.len_utf8()..].trim_start() } else { rest };
        let word = behind.split(|c: char| !is_part_of_name(c)).next().unwrap_or("");
        let after = behind[word.len()..].trim_start();
        if word.is_empty() {
            // A group of units, or a formula in parentheses; either is allowed only after an operator.
            let group =
                UnitParser { text: behind, position: 0, depth: self.depth, minutes: false, is_name: None }.power();
            return !(operator && behind.starts_with('(') && group.is_ok());
        }
        let spaced = operator && self.text[..index].ends_with(' ');
        let is_unit = UNITS.iter().any(|(known, ..)| *known == word);
        let is_word = matches!(word, "and" | "or" | "not") || operator && word == "t";
        is_word
            || operator && (after.starts_with('(') || after.starts_with('.') || is_name(word) && (spaced || !is_unit))
            || word.starts_with(|c: char| c.is_ascii_digit()) && word != "1"
    }

    fn peek(&mut self) -> Option<char> {
        self.position = self.text.len() - self.text[self.position..].trim_start().len();
        self.text[self.position..].chars().next()
    }

    fn unexpected(&mut self) -> UnitError {
        let span = match self.peek() {
            Some(found) => self.position..self.position + found.len_utf8(),
            None => self.text.len()..self.text.len(),
        };
        let message = match self.peek() {
            Some(found) => format!("unexpected `{found}` in a unit"),
            None => "the unit ends too early".to_owned(),
        };
        UnitError { message, span, help: Some("units are written like `N*s/m` or `kg*m^2`".to_owned()) }
    }

    fn product(&mut self) -> Result<Unit, UnitError> {
        let mut unit = self.power()?;
        while let Some(next) = self.peek() {
            if self.depth == 0 && self.ends_before(self.position) {
                break;
            }
            let divide = next == '/';
            match next {
                '*' | '·' | '⋅' | '/' => self.position += next.len_utf8(),
                ')' => break,
                _ => {}
            }
            unit = unit.combine(self.power()?, divide);
        }
        Ok(unit)
    }

    fn power(&mut self) -> Result<Unit, UnitError> {
        let unit = if self.peek() == Some('(') {
            if self.depth == 10 {
                return Err(self.unexpected());
            }
            self.depth += 1;
            self.position += 1;
            let inner = self.product()?;
            if self.peek() != Some(')') {
                return Err(self.unexpected());
            }
            self.position += 1;
            self.depth -= 1;
            inner
        } else {
            self.name()?
        };
        let exponent = self.exponent()?;
        let part = if exponent < 0 { Unit::ONE.combine(unit, true) } else { unit };
        Ok((0..exponent.abs()).fold(Unit::ONE, |product, _| product.combine(part, false)))
    }

    fn exponent(&mut self) -> Result<i32, UnitError> {
        match self.peek() {
            Some('²') => {
                self.position += '²'.len_utf8();
                Ok(2)
            }
            Some('³') => {
                self.position += '³'.len_utf8();
                Ok(3)
            }
            Some('^') => {
                self.position += 1;
                self.peek();
                let rest = &self.text[self.position..];
                let sign = usize::from(rest.starts_with('-'));
                let digits = rest[sign..].bytes().take_while(u8::is_ascii_digit).count();
                let exponent = rest[..sign + digits].parse::<i32>().ok().filter(|exponent| exponent.abs() <= 9);
                let exponent = exponent.ok_or_else(|| self.unexpected())?;
                self.position += sign + digits;
                Ok(exponent)
            }
            _ => Ok(1),
        }
    }

    fn name(&mut self) -> Result<Unit, UnitError> {
        let rest = &self.text[self.position..];
        let length = rest.find(|c: char| !is_part_of_name(c)).unwrap_or(rest.len());
        if length == 0 {
            return Err(self.unexpected());
        }
        let name = &rest[..length];
        let span = self.position..self.position + length;
        self.position += length;
        self.minutes |= matches!(name, "min" | "h");
        if let Some((_, times, over, dimension)) = UNITS.iter().find(|(known, ..)| *known == name) {
            return Ok(Unit { times: *times, over: *over, dimension: *dimension });
        }
        let help = match name {
            "Hz" | "kHz" => Some("write `rev/s` or `rad/s`, whichever is meant; or `1/s`".to_owned()),
            _ => match in_words(name).or_else(|| suggest::nearest(name, UNITS.iter().map(|(known, ..)| *known))) {
                Some(near) => Some(format!("did you mean `{near}`?")),
                None => {
                    Some("units are written like `N*s/m` or `kg*m^2`; a product of numbers needs its `*`".to_owned())
                }
            },
        };
        Err(UnitError { message: format!("unknown unit `{}`", suggest::clip(name)), span, help })
    }
}

/// The symbol of a unit whose name is written out, in the plural or not.
fn in_words(name: &str) -> Option<&'static str> {
    let name = name.to_lowercase();
    let known = |word: &str| WORDS.iter().find(|(known, _)| *known == word).map(|(_, sign)| *sign);
    known(&name).or_else(|| known(name.strip_suffix('s')?))
}

pub(super) fn is_part_of_name(c: char) -> bool {
    c.is_alphanumeric() && c != '²' && c != '³' || c == '_' || c == '°'
}

/// Splits `120 mm` into the number, the unit's text and its offset; `None` if the text is not of that form (then it is
/// a formula: no formula has a letter directly after its first number).
pub fn number_and_unit(text: &str) -> Option<(f64, &str, usize)> {
    let start = text.len() - text.trim_start().len();
    let bytes = text.as_bytes();
    let digits = |from: usize| from + bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let sign = usize::from(matches!(bytes.get(start), Some(b'+' | b'-')));
    let mut end = digits(start + sign);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let after = digits(end + 1 + sign);
        if after > end + 1 + sign {
            end = after;
        }
    }
    let number: f64 = text[start..end].parse().ok()?;
    let unit = text[end..].trim();
    let first = unit.chars().next()?;
    let unit_start = end + text[end..].find(first)?;
    (first.is_alphabetic() || first == '°' || first == '%').then_some((number, unit, unit_start))
}

/// The number of `30/min` or `30 1/min`, which may be in revolutions or radians.
pub fn per_minute(text: &str) -> Option<&str> {
    let before = text.trim().strip_suffix("min")?.trim_end().strip_suffix('/')?.trim_end();
    let number = before.strip_suffix('1').map(|rest| rest.trim_end()).filter(|rest| rest.len() + 1 < before.len());
    [number, Some(before)].into_iter().flatten().find(|number| number.parse::<f64>().is_ok())
}

#[cfg(test)]
mod tests;
