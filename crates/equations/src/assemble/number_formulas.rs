//! Formulas of numbers known by their names, and of parameters: evaluated when a sample is over, no part of the
//! equations.

use symdiff::{Builder, Expr, Formula, Graph, Scalar};

use crate::model::{Parameter, ParameterValue};

/// Formulas of numbers and of parameters.
#[derive(Clone, Debug)]
pub struct NumberFormulas {
    graph: Graph,
    roots: Vec<Expr>,
    numbers: Vec<Expr>,
    parameters: Vec<Expr>,
}

impl NumberFormulas {
    /// Builds formulas of numbers with these names and the parameters of a model.
    pub fn of(parameters: &[Parameter], names: &[&str], formulas: &[Formula]) -> Self {
        let builder = Builder::new();
        let numbers: Vec<_> = names.iter().map(|name| builder.variable(name)).collect();
        let (mut known, mut uncertain) = (Vec::new(), Vec::new());
        for parameter in parameters {
            let value = match &parameter.value {
                ParameterValue::Interval { .. } => {
                    let symbol = builder.variable(&parameter.name);
                    uncertain.push(symbol.expr());
                    symbol
                }
                ParameterValue::Formula(formula) => build(&builder, formula, &known, &[]),
            };
            known.push((parameter.name.as_str(), value));
        }
        let named: Vec<_> = names.iter().copied().zip(numbers.iter().copied()).collect();
        let roots = formulas.iter().map(|formula| build(&builder, formula, &known, &named).expr()).collect();
        let numbers = numbers.iter().map(|number| number.expr()).collect();
        Self { roots, numbers, parameters: uncertain, graph: builder.finish() }
    }

    /// Their values, given those of the uncertain parameters and of the numbers.
    pub fn values(&self, parameters: &[f64], numbers: &[f64]) -> Vec<f64> {
        self.evaluate(&self.graph, &self.roots, parameters, numbers)
    }

    /// The derivatives of each: by the numbers, then by the uncertain parameters.
    pub fn derivatives(&self, parameters: &[f64], numbers: &[f64]) -> Vec<Vec<f64>> {
        let mut graph = self.graph.clone();
        let symbols: Vec<Expr> = self.numbers.iter().chain(&self.parameters).copied().collect();
        let of_root =
            |&root: &Expr| -> Vec<Expr> { symbols.iter().map(|&symbol| graph.derivative(root, symbol)).collect() };
        let derivatives: Vec<Vec<Expr>> = self.roots.iter().map(of_root).collect();
        derivatives.iter().map(|own| self.evaluate(&graph, own, parameters, numbers)).collect()
    }

    fn evaluate(&self, graph: &Graph, roots: &[Expr], parameters: &[f64], numbers: &[f64]) -> Vec<f64> {
        graph.evaluate(roots, |symbol| {
            let of = |symbols: &[Expr], values: &[f64]| {
                symbols.iter().position(|own| *own == symbol).and_then(|index| values.get(index).copied())
            };
            of(&self.numbers, numbers).or_else(|| of(&self.parameters, parameters)).unwrap_or(f64::NAN)
        })
    }
}

/// A formula of names that are known; NaN for others, of which the reader leaves none.
fn build<'g>(
    builder: &'g Builder,
    formula: &Formula,
    known: &[(&str, Scalar<'g>)],
    numbers: &[(&str, Scalar<'g>)],
) -> Scalar<'g> {
    let find = |name: &str| {
        let found = numbers.iter().chain(known).find(|(own, _)| *own == name).map(|(_, value)| *value);
        Ok::<_, std::convert::Infallible>(found.unwrap_or_else(|| builder.number(f64::NAN)))
    };
    let Ok(built) = formula.build(builder, find);
    built
}
