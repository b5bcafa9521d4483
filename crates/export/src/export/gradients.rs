//! Derivatives by parameters: `gradients.csv`, and a tornado plot of each output.

use std::path::{Path, PathBuf};

use csv::WriterBuilder;

use super::csv::number;
use super::error::ExportError;
use super::figure::document::shortened;
use super::folder::AtomicFiles;
use super::rounded::rounded;
use super::stems::file_stem;
use super::tornado::{Bar, derivative_in, tornado};
use crate::grammar::display_unit::ShownUnit;
use crate::results::{DerivativesAt, GradientParameter, Gradients, OutputGradients};

/// Writes the tables, and a plot of each number: of outputs at rows, of reduced outputs and of margins.
///
/// # Errors
/// At the first file that cannot be written.
pub fn write_gradients(
    dir: &Path,
    gradients: &Gradients,
    shown: &[DerivativesAt<'_>],
) -> Result<Vec<PathBuf>, ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    files.add("gradients.csv", &gradients_csv(gradients)?)?;
    if !gradients.reduced.is_empty() {
        files.add("reduced_gradients.csv", &reduced_csv(gradients)?)?;
    }
    for own in shown {
        let name = format!("{}.gradients.svg", file_stem(own.name));
        files.add(&name, tornado_svg(gradients, own).as_bytes())?;
    }
    files.put_in_place()
}

/// The table of reduced outputs and margins: name, `output` or `margin`, value, the instant that decides it, and the
/// derivative by each parameter, all in SI.
fn reduced_csv(gradients: &Gradients) -> Result<Vec<u8>, csv::Error> {
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    let parameters = gradients.parameters.iter().map(|parameter| parameter.name.as_str());
    writer.write_record(["name", "kind", "value", "t"].into_iter().chain(parameters))?;
    for own in &gradients.reduced {
        let kind = if own.is_margin { "margin" } else { "output" };
        let numbers = [Some(own.value), own.time].into_iter().chain(own.by_parameters.iter().map(|&by| Some(by)));
        let numbers = numbers.map(|value| value.map_or_else(String::new, number));
        writer.write_record([own.name.clone(), kind.to_owned()].into_iter().chain(numbers))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// The table: `t`, then for each output its value `x3`, and its derivative by each parameter, `x3.l1`, all in SI.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn gradients_csv(gradients: &Gradients) -> Result<Vec<u8>, csv::Error> {
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    let of_output = |output: &OutputGradients| {
        let by = |parameter: &GradientParameter| format!("{}.{}", output.name, parameter.name);
        std::iter::once(output.name.clone()).chain(gradients.parameters.iter().map(by)).collect::<Vec<String>>()
    };
    let header = std::iter::once("t".to_owned()).chain(gradients.outputs.iter().flat_map(of_output));
    writer.write_record(header)?;
    for (row, &time) in gradients.times.iter().enumerate() {
        let of_output = |output: &OutputGradients| {
            std::iter::once(output.values[row]).chain(output.by_parameters[row].iter().copied()).collect::<Vec<f64>>()
        };
        let values = std::iter::once(time).chain(gradients.outputs.iter().flat_map(of_output));
        writer.write_record(values.map(number))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// Parameters by their influence on a number, the largest first: index, derivative (SI), and derivative times half of
/// the interval. Parameters without influence are omitted.
pub fn by_influence(parameters: &[GradientParameter], by_parameters: &[f64]) -> Vec<(usize, f64, f64)> {
    let derivatives = by_parameters.iter().zip(parameters).enumerate();
    let influences = derivatives.map(|(number, (&by, parameter))| (number, by, by * parameter.half_width));
    let mut influences: Vec<(usize, f64, f64)> = influences.filter(|(_, _, influence)| *influence != 0.0).collect();
    influences.sort_by(|a, b| b.2.abs().total_cmp(&a.2.abs()));
    influences
}

/// A derivative in the units in which people see both, and their quotient: `mm/mm`.
pub fn shown_derivative(unit: ShownUnit<'_>, parameter: &GradientParameter, by: f64) -> (f64, String) {
    derivative_in(unit, ShownUnit::of(&parameter.display, &parameter.unit), by)
}

/// Influences of the parameters on a number, over half of their intervals, as an SVG document.
pub fn tornado_svg(gradients: &Gradients, own: &DerivativesAt<'_>) -> String {
    let mut influences = by_influence(&gradients.parameters, own.by_parameters);
    influences.retain(|(_, _, influence)| influence.is_finite());
    let bar = |(number, by, influence): (usize, f64, f64)| {
        let parameter = &gradients.parameters[number];
        let (value, unit) = shown_derivative(own.unit, parameter, by);
        Bar::new(&parameter.name, (value, &unit), influence)
    };
    let at = own.time.map_or_else(String::new, |time| format!(" at t = {} s", rounded(time)));
    let margin = if own.is_margin { "margin of " } else { "" };
    let (model, name) = (shortened(&gradients.model, 50), shortened(own.name, 50));
    let title = format!("{model}: {margin}{name}{at}, by parameters");
    let bars: Vec<Bar> = influences.into_iter().map(bar).collect();
    tornado("gradients", &title, ("derivative times half of the interval", own.unit), &bars)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grammar::display_unit::DisplayUnit;
    use crate::grammar::unit::Unit;

    fn gradients() -> Gradients {
        let parameter = |name: &str, unit: &str, half_width: f64| GradientParameter {
            name: name.into(),
            unit: unit.into(),
            display: None,
            value: 1.0,
            half_width,
        };
        let output = OutputGradients {
            name: "slider.x".into(),
            unit: "m".into(),
            display: None,
            values: vec![0.3],
            by_parameters: vec![vec![-2.0, 0.5, 0.0]],
        };
        let parameters = vec![parameter("l1", "m", 1e-4), parameter("k", "N/m", 1.0), parameter("m", "kg", 1.0)];
        Gradients {
            model: "crank".into(),
            times: vec![0.25],
            parameters,
            outputs: vec![output],
            reduced: Vec::new(),
            unreliable_from: None,
        }
    }

    #[test]
    fn influence_counts_the_interval() {
        let all = gradients();
        let order: Vec<usize> = by_influence(&all.parameters, &all.outputs[0].by_parameters[0])
            .into_iter()
            .map(|(number, ..)| number)
            .collect();
        assert_eq!(order, [1, 0]);
    }

    #[test]
    fn units_are_quotients() {
        let mut all = gradients();
        assert_eq!(shown_derivative("m".into(), &all.parameters[0], -2.0), (-2.0, "m/m".to_owned()));
        assert_eq!(shown_derivative("m".into(), &all.parameters[1], 0.5).1, "m/(N/m)");
        all.parameters[0].display = Some(DisplayUnit::new("mm", Unit::parse("mm").unwrap()));
        assert_eq!(shown_derivative("m".into(), &all.parameters[0], -2.0), (-2e-3, "m/mm".to_owned()));
    }

    #[test]
    fn table_and_plot_have_all_influential_parameters() {
        let all = gradients();
        let table = String::from_utf8(gradients_csv(&all).unwrap()).unwrap();
        assert_eq!(table, "t,slider.x,slider.x.l1,slider.x.k,slider.x.m\n0.25,0.3,-2,0.5,0\n");
        let svg = tornado_svg(&all, &all.outputs[0].at(&all.times, 0));
        for text in ["l1", "-2 m/m", "0.5 m/(N/m)", "crank: slider.x at t = 0.25 s, by parameters"] {
            assert!(svg.contains(&format!("\n{text}\n")), "{text}: {svg}");
        }
        assert!(!svg.contains("kg"));
    }
}
