//! The files of a run's results.

use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::certificate::{self, Certificate};
use crate::export::analysis::{configuration_csv, response_contributions_csv, response_csv, response_svgs};
use crate::export::error::ExportError;
use crate::export::figure::Caption;
use crate::export::folder::AtomicFiles;
use crate::export::function_witness::function_witness_csv;
use crate::export::owned::{CERTIFICATE, PAGE, SCHEMA, SUMMARY};
use crate::export::report::{MOTION, PageFigure, PageScene, ReportParts, motion_json, page};
use crate::export::stack;
use crate::export::statistics::{reduced_statistics_csv, statistics_csv};
use crate::export::stems::unique_stems;
use crate::export::witnesses::{POINTS, points_csv, witnesses_csv};
use crate::export::{
    Beside, bounds_csv, columns_json, contribution_columns_json, contributions_csv, contributions_svg, noise, plot_svg,
    reduced_csv,
};
use crate::grammar::display_unit::DisplayUnit;
use crate::results::{Bounds, ModelFile, OutputBounds, PeakSummary, Provenance, Summary};

/// Writes `bounds.csv`, its `columns.json`, an SVG for each output, the parameters' contributions if they are known,
/// the data of a report if there is to be one, and `summary.json` into `dir`, which is created if it does not exist.
///
/// The files appear when all are written, `summary.json` last: if it exists, so do the others. It lists them, and files
/// that an older run wrote and this run does not write are removed. Returns the files written, in that order.
///
/// # Errors
/// At the first file that cannot be written; older results then stay unchanged.
pub fn write_results(
    dir: &Path,
    bounds: &Bounds,
    summary: &Summary,
    provenance: &Provenance,
    interrupted: bool,
    report: Option<&ReportParts>,
) -> Result<Vec<PathBuf>, ExportError> {
    let mut written = AtomicFiles::in_folder(dir)?;
    add_results(&mut |name, text| written.add(name, text), bounds, summary, provenance, interrupted, report)?;
    written.replace_older(Vec::new())?;
    written.put_in_place()
}

/// The same files in memory, each with its name.
///
/// # Errors
/// As for [`write_results`], except those of the folder.
pub fn result_files(
    bounds: &Bounds,
    summary: &Summary,
    provenance: &Provenance,
    report: Option<&ReportParts>,
) -> Result<Vec<(String, Vec<u8>)>, ExportError> {
    let mut files = Vec::new();
    let mut add = |name: &str, text: &[u8]| {
        files.push((name.to_owned(), text.to_vec()));
        Ok(())
    };
    add_results(&mut add, bounds, summary, provenance, false, report)?;
    Ok(files)
}

/// Takes a file, with its name and contents.
type Add<'a> = dyn FnMut(&str, &[u8]) -> Result<(), ExportError> + 'a;

/// Files passed to a destination, with their names.
struct Added<'a> {
    names: Vec<String>,
    add: &'a mut Add<'a>,
}

impl Added<'_> {
    fn add(&mut self, name: &str, text: &[u8]) -> Result<(), ExportError> {
        self.names.push(name.to_owned());
        (self.add)(name, text)
    }
}

/// Adds all files of a run's results, `summary.json` last.
fn add_results<'a>(
    add: &'a mut Add<'a>,
    bounds: &Bounds,
    summary: &Summary,
    provenance: &Provenance,
    interrupted: bool,
    report: Option<&ReportParts>,
) -> Result<(), ExportError> {
    let mut files = Added { names: Vec::new(), add };
    files.add("bounds.csv", &bounds_csv(bounds)?)?;
    files.add("columns.json", &columns_json(bounds)?)?;
    if !bounds.contributions.is_empty() {
        files.add("contributions.csv", &contributions_csv(bounds)?)?;
        files.add("contributions.columns.json", &contribution_columns_json(bounds)?)?;
    }
    if let Some(statistics) = summary.statistics.as_ref().filter(|statistics| !statistics.outputs.is_empty()) {
        files.add("statistics.csv", &statistics_csv(statistics)?)?;
        if !statistics.summary.reduced.is_empty() {
            files.add("reduced_statistics.csv", &reduced_statistics_csv(statistics)?)?;
        }
    }
    if !summary.reduced.is_empty() {
        files.add("reduced.csv", &reduced_csv(&summary.reduced)?)?;
    }
    if !bounds.certified.is_empty() {
        let of_file =
            |file: &ModelFile| certificate::ModelFile { name: file.name.clone(), sha256: file.sha256.clone() };
        let certificate = Certificate {
            model: summary.model.clone(),
            files: provenance.model_files.iter().map(of_file).collect(),
            systems: bounds.certified.clone(),
        };
        files.add(CERTIFICATE, certificate::write(&certificate).as_bytes())?;
    }
    if !bounds.witnesses.is_empty() {
        files.add("witnesses.csv", &witnesses_csv(bounds, &summary.parameters)?)?;
        files.add(POINTS, &points_csv(bounds, &summary.parameters)?)?;
    }
    let names = bounds.functions.iter().map(|own| own.name.as_str());
    for (stem, own) in unique_stems(names).into_iter().zip(&bounds.functions) {
        let text = function_witness_csv(own, &summary.parameters);
        files.add(&format!("witness.{stem}.csv"), text.as_bytes())?;
    }
    let is_alone = bounds.is_of_one_configuration();
    if is_alone {
        let name = format!("{}.csv", bounds.analysis.name());
        files.add(&name, &configuration_csv(&bounds.outputs)?)?;
    }
    let mut figures = Vec::with_capacity(bounds.outputs.len());
    if !bounds.responses.is_empty() {
        files.add("response.csv", &response_csv(&bounds.times, &bounds.responses)?)?;
        if bounds.responses.iter().any(|point| point.contributions.iter().any(|own| !own.is_empty())) {
            files.add("response_contributions.csv", &response_contributions_csv(&bounds.times, &bounds.responses)?)?;
        }
        let plots =
            response_svgs(Caption { model: &summary.model, prefix: "figure" }, &bounds.times, &bounds.responses)?;
        let stems = unique_stems(plots.iter().map(|(name, _)| name.as_str()));
        for (stem, (_, svg)) in stems.into_iter().zip(plots) {
            files.add(&response_svg(&stem), svg.as_bytes())?;
            figures.push(PageFigure { output: stem, plots: vec![svg] });
        }
    }
    let plotted = if is_alone { &[][..] } else { &bounds.outputs };
    let names = unique_stems(plotted.iter().map(|output| output.name.as_str()));
    let contributions = bounds.contributions.iter().map(Some).chain(std::iter::repeat(None));
    for ((output, name), contributions) in plotted.iter().zip(names).zip(contributions) {
        let caption = Caption { model: &summary.model, prefix: "figure" };
        let noise = noise(bounds, output);
        let statistics = summary.statistics.as_deref();
        let beside = Beside { noise, requirements: &summary.requirements, statistics };
        let svg = plot_svg(caption, &bounds.times, output, beside)?;
        files.add(&format!("{name}.svg"), svg.as_bytes())?;
        let mut plots = vec![svg];
        if let Some(contributions) = contributions {
            let svg = contributions_svg(caption, &bounds.times, &output.name, contributions)?;
            files.add(&format!("{name}.contributions.svg"), svg.as_bytes())?;
            plots.push(svg);
        }
        figures.push(PageFigure { output: output.name.clone(), plots });
    }
    let names = unique_stems(bounds.outputs.iter().map(|output| output.name.as_str()));
    for (output, name) in bounds.outputs.iter().zip(names) {
        let mut plots = Vec::new();
        for (suffix, svg) in stack::figures(summary, &output.name) {
            files.add(&format!("{name}.{suffix}"), svg.as_bytes())?;
            plots.push(svg);
        }
        match figures.iter_mut().find(|figure| figure.output == output.name) {
            Some(figure) => figure.plots.extend(plots),
            None if plots.is_empty() => {}
            None => figures.push(PageFigure { output: output.name.clone(), plots }),
        }
    }
    let motion = report.map(|report| motion_json(report, Some((bounds, summary)))).transpose()?;
    motion.iter().try_for_each(|motion| files.add(MOTION, motion))?;
    let has_page = report.is_some_and(|report| report.page);
    let names =
        files.names.iter().cloned().chain(has_page.then(|| PAGE.to_owned())).chain([SUMMARY.to_owned()]).collect();
    let named = |output: &'_ OutputBounds| Named {
        name: output.name.clone(),
        unit: output.unit.clone(),
        display: output.display.clone(),
    };
    let outputs = bounds.outputs.iter().map(named).collect();
    let peaks = PeakSummary::of(bounds);
    let written = Written { schema: SCHEMA, summary, provenance, outputs, peaks, interrupted, files: names };
    let mut json = serde_json::to_vec_pretty(&written)?;
    json.push(b'\n');
    if let Some(motion) = motion.filter(|_| has_page) {
        // Read in the same way as `mbint report` does, so that it writes the same page.
        let (summary, motion) = (serde_json::from_slice(&json)?, serde_json::from_slice(&motion)?);
        let name = written.summary.model.clone();
        let text = page(&name.clone(), &[PageScene { name, summary, motion, figures }]);
        files.add(PAGE, text.as_bytes())?;
    }
    files.add(SUMMARY, &json)
}

/// File of a response's plot.
pub(super) fn response_svg(stem: &str) -> String {
    format!("response.{stem}.svg")
}

/// Stem of a file's name, if it is that of a response's plot.
pub(super) fn stem_of_response(file: &str) -> Option<&str> {
    file.strip_prefix("response.")?.strip_suffix(".svg")
}

/// The summary in its file.
#[derive(Serialize)]
struct Written<'s> {
    schema: u32,
    #[serde(flatten)]
    summary: &'s Summary,
    #[serde(flatten)]
    provenance: &'s Provenance,
    /// Outputs in the model's order, with SI units.
    outputs: Vec<Named>,
    /// Peaks of every band, in the output's unit.
    peaks: Vec<PeakSummary>,
    /// Whether the run was interrupted before it was done.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    interrupted: bool,
    /// All files of this run, which the next one replaces.
    files: Vec<String>,
}

/// An output's name and SI unit; empty where dimensionless or unknown.
#[derive(Serialize)]
struct Named {
    name: String,
    unit: String,
    /// The unit in which people see it, if the model names one.
    #[serde(skip_serializing_if = "Option::is_none")]
    display: Option<DisplayUnit>,
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::export::owned::OWNED;

    fn results() -> (Bounds, Summary) {
        let output = |name: &str| OutputBounds {
            name: name.into(),
            unit: "m".into(),
            display: None,
            nominal: vec![1.0, 2.0],
            bands: vec![],
        };
        let bounds = Bounds {
            times: vec![0.0, 1.0],
            outputs: vec![output("x3"), output("a/b"), output("A b")],
            ..Bounds::default()
        };
        let summary = Summary {
            model: "crank".into(),
            mbint: "0.1.0".into(),
            formulation: "absolute".into(),
            coordinates: 7,
            constraints: 6,
            degrees_of_freedom: 1,
            alpha: -0.1,
            duration: 1.0,
            is_cut: false,
            chosen_formulation: None,
            ..Summary::default()
        };
        (bounds, summary)
    }

    fn names(dir: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.retain(|name| name != OWNED);
        names.sort();
        names
    }

    #[test]
    fn results_replace_older_results_without_remains() {
        let dir = tempfile::tempdir().unwrap();
        let place = dir.path().join("results/crank");
        let (bounds, summary) = results();
        for _ in 0..2 {
            let written = write_results(&place, &bounds, &summary, &Provenance::default(), false, None).unwrap();
            let written: Vec<_> = written.iter().map(|path| path.strip_prefix(&place).unwrap()).collect();
            assert_eq!(
                written,
                ["bounds.csv", "columns.json", "x3.svg", "a_b.svg", "A_b-2.svg", "summary.json"].map(Path::new)
            );
        }
        assert_eq!(names(&place), ["A_b-2.svg", "a_b.svg", "bounds.csv", "columns.json", "summary.json", "x3.svg"]);
        let json = fs::read_to_string(place.join("summary.json")).unwrap();
        assert!(json.ends_with("}\n") && json.contains("\"model\": \"crank\""), "{json}");
    }

    #[test]
    fn a_file_in_the_way_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let place = dir.path().join("taken");
        fs::write(&place, "mine").unwrap();
        let (bounds, summary) = results();
        let error = write_results(&place, &bounds, &summary, &Provenance::default(), false, None).unwrap_err();
        assert!(matches!(&error, ExportError::Folder { path, .. } if *path == place), "{error}");
        assert!(
            error.to_string().starts_with(&format!("cannot write into the folder {}: ", place.display())),
            "{error}"
        );
        assert_eq!(fs::read_to_string(&place).unwrap(), "mine");
    }

    #[test]
    fn irreplaceable_file_is_named_and_no_partial_file_remains() {
        let dir = tempfile::tempdir().unwrap();
        // A folder has the name of a file.
        fs::create_dir(dir.path().join("x3.svg")).unwrap();
        let (bounds, summary) = results();
        let error = write_results(dir.path(), &bounds, &summary, &Provenance::default(), false, None).unwrap_err();
        let path = dir.path().join("x3.svg");
        assert!(error.to_string().starts_with(&format!("cannot write {}: ", path.display())), "{error}");
        assert!(!error.to_string().contains(".mbint-"), "{error}");
        assert_eq!(names(dir.path()), ["x3.svg"], "the folder");
    }

    #[cfg(unix)]
    #[test]
    fn a_read_only_folder_is_named() {
        use std::os::unix::fs::PermissionsExt;
        let dir = tempfile::tempdir().unwrap();
        let (bounds, summary) = results();
        fs::set_permissions(dir.path(), fs::Permissions::from_mode(0o555)).unwrap();
        // The superuser may write anywhere: no error then.
        if fs::write(dir.path().join("probe"), "").is_err() {
            let error = write_results(dir.path(), &bounds, &summary, &Provenance::default(), false, None).unwrap_err();
            let path = dir.path().display().to_string();
            assert!(error.to_string().starts_with(&format!("cannot write into the folder {path}: perm")), "{error}");
        }
        fs::set_permissions(dir.path(), fs::Permissions::from_mode(0o755)).unwrap();
    }
}
