//! Values of names and formulas of a model: nominal, and over the intervals of its parameters.

use symdiff::{Builder, Expr, Formula, Interval, Ranges, Scalar};

use crate::grammar::dimension::KnownDimension;
use crate::grammar::formulas::evaluate;
use crate::grammar::names;
use crate::grammar::{Symbol, SymbolTable};
use crate::model::{Description, ParameterValue};

/// The value of a formula of parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolved {
    /// At the nominal values of all parameters, SI.
    pub nominal: f64,
    /// An interval that encloses it at all values of the parameters, SI; `None` if it is constant or unbounded.
    pub interval: Option<[f64; 2]>,
}

/// The parameters of a model, from which values of formulas are computed.
pub struct Values<'m> {
    model: &'m Description,
    /// Nominal values.
    nominal: Vec<Option<f64>>,
    /// Expressions in the uncertain parameters.
    builder: Builder,
    exprs: Vec<Option<Expr>>,
    /// The uncertain parameters with their intervals.
    symbols: Vec<Expr>,
    bounds: Vec<Interval>,
}

impl<'m> Values<'m> {
    /// Evaluates the parameters of a model.
    pub fn of(model: &'m Description) -> Self {
        let (builder, count) = (Builder::new(), model.parameters.len());
        let (nominal, exprs) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut own = Self { model, nominal, builder, exprs, symbols: Vec::new(), bounds: Vec::new() };
        // Each parameter depends only on those before it.
        for parameter in &model.parameters {
            let (nominal, expr) = match &parameter.value {
                ParameterValue::Interval { nominal, lower, upper } => {
                    let symbol = own.builder.variable(&parameter.name).expr();
                    own.symbols.push(symbol);
                    own.bounds.push(Interval::new(*lower, *upper));
                    (Some(*nominal), Some(symbol))
                }
                ParameterValue::Formula(formula) => (own.nominal(formula), own.expr(formula)),
            };
            own.nominal.push(nominal);
            own.exprs.push(expr);
        }
        own
    }

    /// The value of a formula; `None` if it depends on more than parameters.
    pub fn resolve(&self, formula: &Formula) -> Option<Resolved> {
        Some(Resolved { nominal: self.nominal(formula)?, interval: self.enclosure(formula) })
    }

    /// The value of a parameter with its unit, in words.
    pub fn of_parameter(&self, name: &str) -> Option<String> {
        let value = self.resolve(&Formula::name(name))?;
        Some(in_words(value, &unit_of(self.model, name).unwrap_or_default()))
    }

    fn parameter(&self, name: &str) -> Option<usize> {
        match self.model.symbol(name) {
            Some(Symbol::Parameter(index)) => Some(index),
            _ => None,
        }
    }

    fn nominal(&self, formula: &Formula) -> Option<f64> {
        evaluate(formula, |name| self.nominal.get(self.parameter(name)?).copied().flatten())
    }

    fn expr(&self, formula: &Formula) -> Option<Expr> {
        let of_name = |name: &str| self.exprs.get(self.parameter(name)?).copied().flatten();
        let built = formula.build(&self.builder, |name| of_name(name).map(|expr| self.builder.scalar(expr)).ok_or(()));
        built.ok().map(Scalar::expr)
    }

    /// An enclosure over the box of the uncertain parameters; `None` if the formula is constant or the enclosure
    /// infinite.
    fn enclosure(&self, formula: &Formula) -> Option<[f64; 2]> {
        let root = self.expr(formula)?;
        if self.builder.scalar(root).as_constant().is_some() {
            return None;
        }
        let ranges = Ranges::new(&self.builder.graph(), &self.symbols, &[root]);
        let found = ranges.enclose(&self.bounds, &mut Vec::new()).next()?;
        (found.lower().is_finite() && found.upper().is_finite()).then_some([found.lower(), found.upper()])
    }
}

/// The SI unit of a name's value; empty for a pure number, `None` if it is unknown.
pub fn unit_of(model: &Description, name: &str) -> Option<String> {
    let symbol = model.symbol(name)?;
    let dimension = match symbol {
        Symbol::Parameter(index) => return model.parameters.get(index).map(|own| own.unit.clone()),
        Symbol::Sensor { effect, measure } => {
            let mut measures = model.measures(effect).into_iter();
            measures.find(|(known, _)| *known == measure && measure.has_unit()).map(|(_, dimension)| dimension)?
        }
        Symbol::Trajectory { trajectory, order } => {
            let per_time = |dimension: crate::grammar::quantity::Dimension, _| {
                dimension.per(crate::grammar::quantity::Dimension::TIME)
            };
            (0..order as usize).fold(model.trajectory_dimension(trajectory)?, per_time)
        }
        Symbol::BlackBox { output } => model.black_box_dimension(output),
        symbol => match names::kind(symbol, &[]) {
            KnownDimension::Known { dimension, .. } => dimension,
            KnownDimension::Number(_) | KnownDimension::Any => return None,
        },
    };
    Some(dimension.unit())
}

/// A number as people read it: six significant digits.
pub fn shown(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    let size = rounded.abs();
    if size != 0.0 && !(1e-4..1e7).contains(&size) { format!("{rounded:e}") } else { format!("{rounded}") }
}

/// A value with its interval and unit: `0.15 m, from 0.1485 to 0.1515 m`.
pub fn in_words(value: Resolved, unit: &str) -> String {
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let nominal = format!("{}{unit}", shown(value.nominal));
    match value.interval {
        None => nominal,
        Some([lower, upper]) => format!("{nominal}, from {} to {}{unit}", shown(lower), shown(upper)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: &str = "
parameters: { l: { value: 0.2, unit: m, tolerance: 10% }, half: l/2, k: 3 }
bodies: { arm: { mass: 1, inertia: 1, points: { A: [half, 0] } } }
joints: { pin: { revolute: [ground, arm.A] } }
effects: { spring: { spring_damper: { between: [ground, arm], stiffness: k } } }
outputs: { x: arm.x, f: spring.force }
simulation: { duration: 1, step: 0.01 }
";

    #[test]
    fn values_intervals_and_units() {
        let model = crate::model::load_str("m.yaml", MODEL, &[]).unwrap();
        let values = Values::of(&model);
        let resolved = |text: &str| values.resolve(&Formula::parse(text).unwrap());
        assert_eq!(resolved("2*k").unwrap(), Resolved { nominal: 6.0, interval: None });
        let half = resolved("half + 1").unwrap();
        let [lower, upper] = half.interval.unwrap();
        assert!((half.nominal - 1.1).abs() < 1e-14 && (lower - 1.09).abs() < 1e-12 && (upper - 1.11).abs() < 1e-12);
        assert_eq!(resolved("arm.x + l"), None);
        // A part of a formula needs no names but its own.
        let whole = Formula::parse("arm.x + k*(half - l)").unwrap();
        let product = whole.terms().iter().position(|(_, span)| *span == (8..20)).unwrap();
        let part = values.resolve(&whole.part(product)).unwrap();
        assert!((part.nominal + 0.3).abs() < 1e-14, "{part:?}");
        assert_eq!(whole.part(product).names().map(|(name, _)| name).collect::<Vec<_>>(), ["k", "half", "l"]);
        let unit = |name: &str| unit_of(&model, name).unwrap();
        assert_eq!([unit("l"), unit("arm.vx"), unit("arm.A.ax")], ["m", "m/s", "m/s^2"]);
        assert_eq!([unit("spring.force"), unit("pin.force"), unit("energy"), unit("t")], ["N", "N", "N*m", "s"]);
        assert_eq!(in_words(half, "m"), "1.1 m, from 1.09 to 1.11 m");
        assert_eq!([shown(1e-6), shown(123456.789), shown(0.1 + 0.2)], ["1e-6", "123457", "0.3"]);
    }
}
