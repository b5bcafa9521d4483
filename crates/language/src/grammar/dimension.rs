//! Dimensions of formulas, and mismatches of their parts.
//!
//! A bare number is a pure factor in a product with a parameter, and takes the other side's dimension in a sum. In a
//! product with `t` or a motion (`-5*slider.vx`, `sin(2*t)`) it may be a coefficient of any unit, so such a product
//! fits anywhere. A parameter without unit fits anywhere, and so do formulas of it.

use symdiff::formula::Term;
use symdiff::{Binary, Formula, Spline, Unary};

use super::quantity::Dimension;
use crate::syntax::source::Span;

/// Known dimension of a part of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KnownDimension {
    /// Made of bare numbers; its value if that is known.
    Number(Option<f64>),
    /// Nothing is known.
    Any,
    /// This dimension.
    Known {
        /// The dimension.
        dimension: Dimension,
        /// Whether it is made of `t` and motions only, without parameters.
        motion: bool,
    },
}

impl KnownDimension {
    /// A parameter of this dimension.
    pub fn parameter(dimension: Dimension) -> Self {
        Self::Known { dimension, motion: false }
    }

    /// Time or a part of the motion.
    pub fn motion(dimension: Dimension) -> Self {
        Self::Known { dimension, motion: true }
    }

    /// The dimension, if one is known.
    pub fn dimension(self) -> Option<Dimension> {
        match self {
            Self::Known { dimension, .. } => Some(dimension),
            Self::Number(_) | Self::Any => None,
        }
    }
}

/// Two parts whose dimensions do not agree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// Description of the error.
    pub message: String,
    /// Bytes of the formula's text.
    pub span: Span,
}

/// Dimension of a formula. `name` gives that of each name, `table` those of a table's argument and value; mismatches
/// are added to `mismatches`.
pub fn analyse(
    formula: &Formula,
    name: impl FnMut(&str) -> KnownDimension,
    table: impl Fn(Spline) -> [Option<Dimension>; 2],
    mismatches: &mut Vec<Mismatch>,
) -> KnownDimension {
    of_terms(formula, name, table, mismatches).pop().unwrap_or(KnownDimension::Any)
}

/// Dimensions of all terms of a formula, that of the formula last; otherwise as [`analyse`].
pub fn of_terms(
    formula: &Formula,
    mut name: impl FnMut(&str) -> KnownDimension,
    table: impl Fn(Spline) -> [Option<Dimension>; 2],
    mismatches: &mut Vec<Mismatch>,
) -> Vec<KnownDimension> {
    let mut kinds: Vec<KnownDimension> = Vec::with_capacity(formula.terms().len());
    let is_half =
        |term: usize| matches!(formula.terms()[term].0, Term::Binary(Binary::Select | Binary::SelectElse, ..));
    for (term, span) in formula.terms() {
        let kind = match term {
            Term::Number(value) => Ok(KnownDimension::Number(Some(*value))),
            Term::Quantity(_, mark) => Ok(KnownDimension::parameter(Dimension::of_mark(*mark))),
            Term::Compared(a, b) => {
                // In the order of the text.
                let [first, second] =
                    if formula.terms()[*a].1.start < formula.terms()[*b].1.start { [a, b] } else { [b, a] };
                sum(kinds[*first], kinds[*second], "compared")
            }
            Term::Degrees(a) => unary(Unary::Cos, kinds[*a]),
            Term::Unary(Unary::Sin | Unary::Cos | Unary::Tan, a)
                if matches!(formula.terms()[*a].0, Term::Degrees(_)) =>
            {
                Err("degrees stand where an angle (rad) belongs".to_owned())
            }
            Term::Binary(Binary::Add, a, b) if is_half(*a) && is_half(*b) => {
                sum(kinds[*a], kinds[*b], "the two values of `if`")
            }
            Term::Name(text) => Ok(name(text)),
            Term::Unary(Unary::Spline(spline, _), a) => looked_up(table(*spline), kinds[*a]),
            Term::Unary(function, a) => unary(*function, kinds[*a]),
            Term::Binary(function, a, b) => binary(*function, kinds[*a], kinds[*b]),
        };
        kinds.push(kind.unwrap_or_else(|message| {
            mismatches.push(Mismatch { message, span: span.clone() });
            KnownDimension::Any
        }));
    }
    kinds
}

/// Dimension of a table's value.
fn looked_up([argument, value]: [Option<Dimension>; 2], a: KnownDimension) -> Result<KnownDimension, String> {
    if let (Some(wanted), KnownDimension::Known { dimension, .. }) = (argument, a)
        && !dimension.fits(wanted)
    {
        return Err(format!("{dimension} stands where {wanted} belongs"));
    }
    Ok(value.map_or(KnownDimension::Any, KnownDimension::parameter))
}

fn unary(function: Unary, a: KnownDimension) -> Result<KnownDimension, String> {
    match function {
        Unary::Neg => Ok(match a {
            KnownDimension::Number(value) => KnownDimension::Number(value.map(|value| -value)),
            other => other,
        }),
        Unary::Abs => Ok(match a {
            KnownDimension::Number(value) => KnownDimension::Number(value.map(f64::abs)),
            other => other,
        }),
        Unary::Sqrt => power(a, Some(0.5)),
        Unary::Sign => Ok(KnownDimension::Number(None)),
        _ => match a {
            KnownDimension::Known { dimension, .. } if !dimension.fits(Dimension::NUMBER) => {
                let wanted = match function {
                    Unary::Sin | Unary::Cos | Unary::Tan => "an angle (rad)",
                    _ => "a pure number",
                };
                Err(format!("{dimension} stands where {wanted} belongs"))
            }
            _ => Ok(KnownDimension::Number(None)),
        },
    }
}

fn binary(function: Binary, a: KnownDimension, b: KnownDimension) -> Result<KnownDimension, String> {
    match function {
        Binary::Add | Binary::Sub => sum(a, b, if function == Binary::Add { "added" } else { "subtracted" }),
        Binary::Min | Binary::Max => sum(a, b, "compared"),
        Binary::Select | Binary::SelectElse => Ok(match b {
            KnownDimension::Number(_) => KnownDimension::Number(None),
            other => other,
        }),
        Binary::Atan2 => sum(a, b, "compared").map(|_| KnownDimension::Number(None)),
        Binary::Mul => Ok(product(a, b, Dimension::times, |x, y| x * y)),
        Binary::Div => Ok(product(a, b, Dimension::per, |x, y| x / y)),
        Binary::Pow => match b {
            KnownDimension::Number(exponent) => power(a, exponent),
            KnownDimension::Any => power(a, None),
            KnownDimension::Known { dimension, .. } if dimension.fits(Dimension::NUMBER) => power(a, None),
            KnownDimension::Known { dimension, .. } => Err(format!("{dimension} cannot be an exponent")),
        },
    }
}

fn sum(a: KnownDimension, b: KnownDimension, verb: &str) -> Result<KnownDimension, String> {
    match (a, b) {
        (KnownDimension::Number(_), KnownDimension::Number(_)) => Ok(KnownDimension::Number(None)),
        (KnownDimension::Known { dimension: x, motion: m }, KnownDimension::Known { dimension: y, motion: n }) => {
            if x.fits(y) {
                Ok(KnownDimension::Known { dimension: x.of_sum(y), motion: m && n })
            } else {
                Err(format!("{x} and {y} cannot be {verb}"))
            }
        }
        (known @ KnownDimension::Known { .. }, _) | (_, known @ KnownDimension::Known { .. }) => Ok(known),
        _ => Ok(KnownDimension::Any),
    }
}

fn product(
    a: KnownDimension,
    b: KnownDimension,
    dimensions: impl Fn(Dimension, Dimension) -> Dimension,
    numbers: impl Fn(f64, f64) -> f64,
) -> KnownDimension {
    match (a, b) {
        (KnownDimension::Number(x), KnownDimension::Number(y)) => {
            KnownDimension::Number(x.zip(y).map(|(x, y)| numbers(x, y)))
        }
        (KnownDimension::Any, _) | (_, KnownDimension::Any) => KnownDimension::Any,
        (KnownDimension::Number(_), KnownDimension::Known { motion: true, .. })
        | (KnownDimension::Known { motion: true, .. }, KnownDimension::Number(_)) => KnownDimension::Any,
        (KnownDimension::Number(_), KnownDimension::Known { dimension, .. }) => {
            KnownDimension::parameter(dimensions(Dimension::NUMBER, dimension))
        }
        (known @ KnownDimension::Known { .. }, KnownDimension::Number(_)) => known,
        (KnownDimension::Known { dimension: x, motion: m }, KnownDimension::Known { dimension: y, motion: n }) => {
            KnownDimension::Known { dimension: dimensions(x, y), motion: m && n }
        }
    }
}

fn power(base: KnownDimension, exponent: Option<f64>) -> Result<KnownDimension, String> {
    match base {
        KnownDimension::Number(value) => {
            Ok(KnownDimension::Number(value.zip(exponent).map(|(value, exponent)| symdiff::math::pow(value, exponent))))
        }
        KnownDimension::Any => Ok(KnownDimension::Any),
        KnownDimension::Known { dimension, .. } if dimension.fits(Dimension::NUMBER) => {
            Ok(KnownDimension::Number(None))
        }
        KnownDimension::Known { dimension, motion } => {
            let Some(exponent) = exponent else {
                return Err(format!("{dimension} needs a number as its exponent"));
            };
            match dimension.to_the(exponent) {
                Some(dimension) => Ok(KnownDimension::Known { dimension, motion }),
                None => Err(format!("{dimension} to the power {exponent} has no unit")),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use symdiff::formula::Vocabulary;

    use super::*;
    use crate::grammar::unit::Unit;

    fn name(name: &str) -> KnownDimension {
        match name {
            "l" => KnownDimension::parameter(Dimension::LENGTH),
            "m" => KnownDimension::parameter(Dimension::MASS),
            "omega" => KnownDimension::parameter(Dimension::ANGULAR_VELOCITY),
            "F" => KnownDimension::parameter(Dimension::FORCE),
            "t" => KnownDimension::motion(Dimension::TIME),
            "v" => KnownDimension::motion(Dimension::VELOCITY),
            "angle" => KnownDimension::motion(Dimension::ANGLE),
            _ => KnownDimension::Any,
        }
    }

    fn unit(text: &str) -> Result<String, String> {
        let mut mismatches = Vec::new();
        let read_unit = |value: f64, text: &str| Ok(Unit::behind(value, text, |word| word == "l").unwrap());
        let vocabulary = Vocabulary { unit: Some(&read_unit), ..Vocabulary::default() };
        let formula = Formula::parse_with(text, &vocabulary).unwrap();
        let kind = analyse(&formula, name, |_| [None; 2], &mut mismatches);
        match mismatches.into_iter().next() {
            Some(mismatch) => Err(format!("{:?} {}", mismatch.span, mismatch.message)),
            None => Ok(match kind {
                KnownDimension::Number(_) => "number".to_owned(),
                KnownDimension::Any => "any".to_owned(),
                KnownDimension::Known { dimension, .. } => dimension.unit(),
            }),
        }
    }

    #[test]
    fn dimensions_follow_the_formula() {
        for (text, wanted) in [
            ("m*l^2/12", "kg*m^2"),
            ("-l/2", "m"),
            ("1 + l", "m"),
            ("sqrt(l^2 + l^2)", "m"),
            ("l^(1/3)*l^(2/3)", "m"),
            ("0.5*m*v^2", "N*m"),
            ("omega*t", "rad"),
            ("l*omega", "m/s"),
            ("F*sin(omega*t)", "N"),
            ("10*sin(2*t)", "number"),
            ("-5*v", "any"),
            ("k*l", "any"),
            ("k + l", "m"),
            ("2*9.81", "number"),
            ("angle - angle", "rad"),
            ("max(l, 0)", "m"),
            ("F*(l/l)^2.5", "N"),
            ("250 kg/m * l", "kg"),
            ("l + 3 mm", "m"),
            ("cos(10 deg)", "number"),
            ("F*sin(2 rad/s*t)", "N"),
            ("mod(t, 0.5)", "s"),
            ("mod(t, 500 ms)", "s"),
            ("floor(t/1 s)", "number"),
            ("if(t > 1 s, F, 0)", "N"),
            ("if(l < 3, 2, 4)", "number"),
            ("clamp(l, 1 mm, 2 m)", "m"),
            ("smoothstep(1, 2 s, t)*F", "N"),
            ("(t < 1 and v > 2 m/s)*F", "N"),
            ("deg(angle)", "number"),
        ] {
            assert_eq!(unit(text).as_deref(), Ok(wanted), "{text}");
        }
    }

    #[test]
    fn mismatched_dimensions_are_located() {
        for (text, wanted) in [
            ("1 + (l + m)", "5..10 a length (m) and a mass (kg) cannot be added"),
            ("sin(l)", "0..6 a length (m) stands where an angle (rad) belongs"),
            ("sin(t)", "0..6 a time (s) stands where an angle (rad) belongs"),
            ("2^l", "0..3 a length (m) cannot be an exponent"),
            ("l^k", "0..3 a length (m) needs a number as its exponent"),
            ("max(l, m)", "0..9 a length (m) and a mass (kg) cannot be compared"),
            ("1 + (l < m)", "5..10 a length (m) and a mass (kg) cannot be compared"),
            ("l + 3 kg", "0..8 a length (m) and a mass (kg) cannot be added"),
            ("if(t > 1, l, m)", "0..15 a length (m) and a mass (kg) cannot be the two values of `if`"),
            ("floor(l)", "0..8 a length (m) stands where a pure number belongs"),
            ("deg(l)", "0..6 a length (m) stands where an angle (rad) belongs"),
            ("sin(deg(angle))", "0..15 degrees stand where an angle (rad) belongs"),
            ("mod(l, m)", "0..9 a quantity in m/kg stands where a pure number belongs"),
        ] {
            assert_eq!(unit(text).unwrap_err(), wanted, "{text}");
        }
    }
}
