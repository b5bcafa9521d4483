//! Values of names and formulas of a model: nominal, and over the intervals of its parameters.

use symdiff::{Builder, Formula, Interval, Ranges, Scalar};

use crate::grammar::dimension::Kind;
use crate::grammar::formulas::evaluate;
use crate::grammar::names;
use crate::grammar::{Symbol, SymbolTable};
use crate::model::{Description, ParameterValue};

/// The value of a formula of parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolved {
    /// At the nominal values of all parameters, SI.
    pub nominal: f64,
    /// An interval that encloses it at all values of the parameters, SI; none where no parameter is uncertain.
    pub interval: Option<[f64; 2]>,
}

/// The value of a formula; `None` where it is made of more than parameters.
pub fn resolve(model: &Description, formula: &Formula) -> Option<Resolved> {
    let of_parameters = |name: &str| matches!(model.symbol(name), Some(Symbol::Parameter(_)));
    if !formula.names().all(|(name, _)| of_parameters(name)) {
        return None;
    }
    let nominal = nominal_values(model);
    let value = |name: &str| match model.symbol(name) {
        Some(Symbol::Parameter(index)) => nominal.get(index).copied().flatten(),
        _ => None,
    };
    let nominal = evaluate(formula, value)?;
    Some(Resolved { nominal, interval: enclosure(model, formula) })
}

/// Nominal values of all parameters.
fn nominal_values(model: &Description) -> Vec<Option<f64>> {
    let mut values: Vec<Option<f64>> = Vec::with_capacity(model.parameters.len());
    for parameter in &model.parameters {
        let value = match &parameter.value {
            ParameterValue::Interval { nominal, .. } => Some(*nominal),
            ParameterValue::Formula(formula) => evaluate(formula, |name| match model.symbol(name) {
                Some(Symbol::Parameter(index)) => values.get(index).copied().flatten(),
                _ => None,
            }),
        };
        values.push(value);
    }
    values
}

/// An enclosure over the box of the uncertain parameters; `None` where the formula depends on none of them.
fn enclosure(model: &Description, formula: &Formula) -> Option<[f64; 2]> {
    let builder = Builder::new();
    let (mut symbols, mut bounds) = (Vec::new(), Vec::new());
    let mut values: Vec<Option<Scalar>> = Vec::with_capacity(model.parameters.len());
    let known = |values: &[Option<Scalar>], name: &str| match model.symbol(name) {
        Some(Symbol::Parameter(index)) => values.get(index).copied().flatten().map(Scalar::expr),
        _ => None,
    };
    for parameter in &model.parameters {
        let value = match &parameter.value {
            ParameterValue::Interval { lower, upper, .. } => {
                let symbol = builder.variable(&parameter.name);
                symbols.push(symbol.expr());
                bounds.push(Interval::new(*lower, *upper));
                Some(symbol)
            }
            ParameterValue::Formula(own) => {
                own.build(&builder, |name| known(&values, name).map(|expr| builder.scalar(expr)).ok_or(())).ok()
            }
        };
        values.push(value);
    }
    let root = formula.build(&builder, |name| known(&values, name).map(|expr| builder.scalar(expr)).ok_or(())).ok()?;
    if root.as_constant().is_some() {
        return None;
    }
    let graph = builder.graph();
    let ranges = Ranges::new(&graph, &symbols, &[root.expr()]);
    let found = ranges.enclose(&bounds, &mut Vec::new()).next()?;
    (found.lower().is_finite() && found.upper().is_finite()).then_some([found.lower(), found.upper()])
}

/// The SI unit of what a name stands for; empty for a pure number, `None` where it is unknown.
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
            Kind::Known { dimension, .. } => dimension,
            Kind::Number(_) | Kind::Any => return None,
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
        let resolved = |text: &str| resolve(&model, &Formula::parse(text).unwrap());
        assert_eq!(resolved("2*k").unwrap(), Resolved { nominal: 6.0, interval: None });
        let half = resolved("half + 1").unwrap();
        let [lower, upper] = half.interval.unwrap();
        assert!((half.nominal - 1.1).abs() < 1e-14 && (lower - 1.09).abs() < 1e-12 && (upper - 1.11).abs() < 1e-12);
        assert_eq!(resolved("arm.x + l"), None);
        let unit = |name: &str| unit_of(&model, name).unwrap();
        assert_eq!([unit("l"), unit("arm.vx"), unit("arm.A.ax")], ["m", "m/s", "m/s^2"]);
        assert_eq!([unit("spring.force"), unit("pin.force"), unit("energy"), unit("t")], ["N", "N", "N*m", "s"]);
        assert_eq!(in_words(half, "m"), "1.1 m, from 1.09 to 1.11 m");
        assert_eq!([shown(1e-6), shown(123456.789), shown(0.1 + 0.2)], ["1e-6", "123457", "0.3"]);
    }
}
