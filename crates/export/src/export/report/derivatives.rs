//! Derivatives of outputs by parameters, row by row, which a report shows at its cursor.

use serde::Serialize;

use super::packing::floats;
use crate::export::tornado::derivative_in;
use crate::export::tuning::TUNING;
use crate::grammar::display_unit::ShownUnit;
use crate::results::{Bounds, OutputDerivatives, Summary};

/// Derivatives of a run's outputs.
#[derive(Serialize)]
pub(super) struct PackedDerivatives<'r> {
    /// Times of the rows, s.
    times: String,
    outputs: Vec<OfOutput<'r>>,
}

#[derive(Serialize)]
struct OfOutput<'r> {
    name: &'r str,
    unit: &'r str,
    /// Sorted by influence, the largest first.
    parameters: Vec<OfParameter<'r>>,
}

#[derive(Serialize)]
struct OfParameter<'r> {
    name: &'r str,
    /// Unit of the derivative.
    unit: String,
    /// Half of the parameter's interval; multiplied by the derivative it is the influence of the tolerance.
    half_width: f64,
    /// By row, in the units in which people see both.
    values: String,
}

/// Derivatives of all outputs on which a parameter has an influence; `None` without any.
pub(super) fn packed_derivatives<'r>(bounds: &'r Bounds, summary: &'r Summary) -> Option<PackedDerivatives<'r>> {
    let outputs: Vec<OfOutput> = bounds.derivatives.iter().filter_map(|own| of_output(own, bounds, summary)).collect();
    (!outputs.is_empty()).then(|| PackedDerivatives { times: floats(&bounds.times), outputs })
}

fn of_output<'r>(own: &OutputDerivatives, bounds: &'r Bounds, summary: &'r Summary) -> Option<OfOutput<'r>> {
    let output = bounds.outputs.get(own.output)?;
    let unit = ShownUnit::of(&output.display, &output.unit);
    let count = summary.parameters.len();
    let by = |axis: usize| own.by_parameters.iter().skip(axis).step_by(count).copied();
    let half = |axis: usize| 0.5 * (summary.parameters[axis].upper - summary.parameters[axis].lower);
    // `max` skips rows with NaN.
    let influence = |axis: usize| half(axis) * by(axis).map(f64::abs).fold(0.0, f64::max);
    let mut axes: Vec<(usize, f64)> = (0..count).map(|axis| (axis, influence(axis))).collect();
    axes.retain(|(_, influence)| *influence > 0.0);
    axes.sort_by(|a, b| b.1.total_cmp(&a.1));
    let of_parameter = |(axis, _): (usize, f64)| {
        let parameter = &summary.parameters[axis];
        let below = ShownUnit::of(&parameter.display, &parameter.unit);
        let values: Vec<f64> = by(axis).map(|by| derivative_in(unit, below, by).0).collect();
        let (_, unit) = derivative_in(unit, below, 1.0);
        OfParameter { name: &parameter.name, unit, half_width: half(axis) / below.si, values: floats(&values) }
    };
    let parameters: Vec<OfParameter> = axes.into_iter().take(TUNING.most_derivatives).map(of_parameter).collect();
    (!parameters.is_empty()).then_some(OfOutput { name: &output.name, unit: unit.text, parameters })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{OutputBounds, ParameterSummary};

    #[test]
    fn parameters_without_influence_are_omitted() {
        let parameter = |name: &str, half: f64| ParameterSummary {
            name: name.into(),
            unit: "m".into(),
            display: None,
            nominal: 1.0,
            lower: 1.0 - half,
            upper: 1.0 + half,
        };
        let output =
            OutputBounds { name: "x".into(), unit: "N".into(), display: None, nominal: vec![0.0; 2], bands: vec![] };
        let derivatives =
            vec![OutputDerivatives { output: 0, by_parameters: vec![1.0, 0.0, -5.0, 2.0, 0.0, f64::NAN] }];
        let bounds = Bounds { times: vec![0.0, 1.0], outputs: vec![output], derivatives, ..Bounds::default() };
        let parameters = vec![parameter("a", 0.1), parameter("b", 0.1), parameter("c", 0.1)];
        let summary = Summary { parameters, ..Summary::default() };
        let found = packed_derivatives(&bounds, &summary).unwrap();
        let names: Vec<&str> = found.outputs[0].parameters.iter().map(|own| own.name).collect();
        assert_eq!(names, ["c", "a"]);
        assert_eq!(found.outputs[0].parameters[1].unit, "N/m");
        assert_eq!(found.outputs[0].parameters[1].values, floats(&[1.0, 2.0]));
        assert!(packed_derivatives(&Bounds::default(), &summary).is_none());
    }
}
