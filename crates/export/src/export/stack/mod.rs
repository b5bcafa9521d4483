//! Figures of a stack of dimensions: the chain drawn to scale, sensitivities as a tornado, and a histogram.

mod chain;
mod histogram;

use super::figure::document::shortened;
use super::tornado::{Bar, derivative_in, tornado};
use crate::grammar::display_unit::ShownUnit;
use crate::results::{OutputStatisticsSummary, ParameterSummary, Sensitivity, Summary};

/// Suffixes of the output's name in the names of the files, in the order of a page.
pub(super) const FIGURES: [&str; 3] = ["chain.svg", "tornado.svg", "histogram.svg"];

/// The figures of an output, each with the last part of its file's name; empty if it is not a stack.
pub(super) fn figures(summary: &Summary, output: &str) -> Vec<(&'static str, String)> {
    let [of_chain, of_tornado, of_histogram] = FIGURES;
    let statistics = summary.statistics.as_ref();
    let own = statistics.and_then(|found| found.summary.outputs.iter().find(|own| own.output == output));
    let unit_of = |name: &str| summary.errors.iter().find(|error| error.output == name);
    let chain = summary.chains.iter().find(|chain| chain.output == output).map(|chain| {
        let unit = unit_of(output).map_or_else(|| ShownUnit::from("m"), |own| ShownUnit::of(&own.display, &own.unit));
        (of_chain, chain::chain_svg(&summary.model, chain, unit))
    });
    let bars = own.filter(|own| !own.sensitivities.is_empty()).map(|own| (of_tornado, bars(summary, own)));
    let histogram = own.and_then(|own| Some((own, own.histogram.as_ref()?)));
    let histogram = histogram.map(|(own, found)| (of_histogram, histogram::histogram_svg(summary, own, found)));
    chain.into_iter().chain(bars).chain(histogram).collect()
}

/// A sensitivity in shown units, with its unit.
pub fn shown_sensitivity(
    output: &OutputStatisticsSummary,
    parameters: &[ParameterSummary],
    own: &Sensitivity,
) -> (f64, String) {
    let parameter = parameters.iter().find(|known| known.name == own.parameter);
    let below = parameter.map_or_else(|| ShownUnit::from(""), |known| ShownUnit::of(&known.display, &known.unit));
    derivative_in(ShownUnit::of(&output.display, &output.unit), below, own.derivative)
}

fn bars(summary: &Summary, output: &OutputStatisticsSummary) -> String {
    let bar = |own: &Sensitivity| {
        let (value, unit) = shown_sensitivity(output, &summary.parameters, own);
        Bar::new(&own.parameter, (value, &unit), own.deviation)
    };
    let bars: Vec<Bar> = output.sensitivities.iter().filter(|own| own.deviation != 0.0).map(bar).collect();
    let title = format!("{}: {} by dimensions", shortened(&summary.model, 50), shortened(&output.output, 50));
    tornado("stack", &title, ("sensitivity times tolerance", ShownUnit::of(&output.display, &output.unit)), &bars)
}
