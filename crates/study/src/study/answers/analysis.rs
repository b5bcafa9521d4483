//! Results of analyses other than a motion, added to those of a run.

use crate::model::{Analysis, Description};
use crate::results::{AnalysisSummary, Band, Bounds, OutputBounds, ResponsePoint, Summary, ValueSummary};
use crate::study::problem::Study;

/// Analysis and its result for the nominal equilibrium; none for a motion from a given start.
pub fn analysis_summary(study: &Study) -> Option<AnalysisSummary> {
    let system = &study.simulator.system;
    let mut summary = AnalysisSummary { kind: system.analysis.name().to_owned(), ..AnalysisSummary::default() };
    let Some(equilibrium) = &study.simulator.equilibrium else {
        return (system.analysis != Analysis::Motion).then_some(summary);
    };
    if system.has_states() {
        return (system.analysis != Analysis::Motion).then_some(summary);
    }
    let parameters: Vec<f64> = system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let found = equilibrium.stability(&study.simulator.nominal, &parameters);
    summary.stability = Some(found.smallest);
    summary.indifferent = found.indifferent.into_iter().map(|coordinate| system[coordinate].name.clone()).collect();
    Some(summary)
}

/// Takes the frequency responses out of the outputs, and stores the results of an analysis of one configuration.
pub fn arrange(description: &Description, bounds: &mut Bounds, summary: &mut Summary) {
    let frequencies = || {
        let of = |response: &crate::model::ResponseRequest| {
            let name = response.name.clone();
            response.frequencies.iter().map(move |&frequency| (name.clone(), frequency)).collect::<Vec<_>>()
        };
        description.modes.responses.iter().flat_map(of)
    };
    let first = bounds.outputs.len().saturating_sub(2 * frequencies().count());
    let mut lines = bounds.outputs.split_off(first).into_iter();
    let mut contributions = bounds.contributions.split_off(first.min(bounds.contributions.len())).into_iter();
    let names: Vec<String> = lines.as_slice().iter().map(|line| line.name.clone()).collect();
    for (name, frequency) in frequencies() {
        let (Some(amplitude), Some(phase)) = (lines.next(), lines.next()) else { break };
        let contributions = [(); 2].map(|()| contributions.next().unwrap_or_default());
        bounds.responses.push(ResponsePoint { name, frequency, amplitude, phase, contributions });
    }
    // Eigenvalues have no Taylor bounds.
    for output in bounds.outputs.iter_mut().skip(description.outputs.len()) {
        let is_known = |band: &Band| band.lower.iter().any(|end| !end.is_nan());
        output.bands.retain(is_known);
        let bands: Vec<&str> = output.bands.iter().map(|band| band.method.name()).collect();
        summary.errors.retain(|error| error.output != output.name || bands.contains(&error.method.as_str()));
    }
    bounds.analysis = description.analysis;
    summary.errors.retain(|error| !names.contains(&error.output));
    summary.contributions.retain(|contribution| !names.contains(&contribution.output));
    if let Some(analysis) = &mut summary.analysis
        && bounds.is_of_one_configuration()
    {
        analysis.values = bounds.outputs.iter().map(|output: &OutputBounds| ValueSummary::of(output)).collect();
        let has_growth = matches!(description.analysis, Analysis::Modes(_)) && !description.states.is_empty();
        // It is the first result after the model's outputs.
        if let Some(growth) = analysis.values.get(description.outputs.len()).filter(|_| has_growth) {
            analysis.growth = Some(growth.nominal);
            analysis.largest_growth = growth.bounds.iter().map(|(_, _, upper, _)| *upper).reduce(f64::max);
        }
    }
}
