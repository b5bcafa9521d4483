//! The files of a run's results.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::export::error::ExportError;
use crate::export::figure::Caption;
use crate::export::folder::AtomicFiles;
use crate::export::owned::{SCHEMA, SUMMARY, owned};
use crate::export::{bounds_csv, columns_json, contributions_csv, contributions_svg, noise, plot_svg};
use crate::results::{Bounds, PeakSummary, Provenance, Summary};

/// Writes `bounds.csv`, its `columns.json`, an SVG for each output, the parameters' contributions where they are known, and `summary.json` into
/// `dir`, which is created if it does not exist.
///
/// The files appear when all are written, `summary.json` last: where it exists, the others do. It lists them, and files that the summary
/// of an older run lists and this run does not write are removed. Returns the files written, in that order.
///
/// # Errors
/// At the first file that cannot be written; older results then stay unchanged.
pub fn write_results(
    dir: &Path,
    bounds: &Bounds,
    summary: &Summary,
    provenance: &Provenance,
    interrupted: bool,
) -> Result<Vec<PathBuf>, ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    files.add("bounds.csv", &bounds_csv(bounds)?)?;
    files.add("columns.json", &columns_json(bounds)?)?;
    if !bounds.contributions.is_empty() {
        files.add("contributions.csv", &contributions_csv(bounds)?)?;
    }
    let names = unique_stems(bounds.outputs.iter().map(|output| output.name.as_str()));
    let contributions = bounds.contributions.iter().map(Some).chain(std::iter::repeat(None));
    for ((output, name), contributions) in bounds.outputs.iter().zip(names).zip(contributions) {
        let caption = Caption { model: &summary.model, prefix: "figure" };
        let svg = plot_svg(caption, &bounds.times, output, noise(bounds, output))?;
        files.add(&format!("{name}.svg"), svg.as_bytes())?;
        if let Some(contributions) = contributions {
            let svg = contributions_svg(caption, &bounds.times, &output.name, contributions)?;
            files.add(&format!("{name}.contributions.svg"), svg.as_bytes())?;
        }
    }
    let names = files.names().into_iter().chain([SUMMARY.to_owned()]).collect();
    let outputs = bounds.outputs.iter().map(|output| Named { name: &output.name, unit: &output.unit }).collect();
    let peaks = PeakSummary::of(bounds);
    let written = Written { schema: SCHEMA, summary, provenance, outputs, peaks, interrupted, files: names };
    let mut json = serde_json::to_vec_pretty(&written)?;
    json.push(b'\n');
    files.add(SUMMARY, &json)?;
    files.without(owned(dir));
    files.put_in_place()
}

/// The summary as it is written.
#[derive(Serialize)]
struct Written<'s> {
    schema: u32,
    #[serde(flatten)]
    summary: &'s Summary,
    #[serde(flatten)]
    provenance: &'s Provenance,
    /// In the model's order, with SI units.
    outputs: Vec<Named<'s>>,
    /// Of every band, in the output's unit.
    peaks: Vec<PeakSummary>,
    /// Whether the run was interrupted before it was done.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    interrupted: bool,
    /// All files of this run, which the next one replaces.
    files: Vec<String>,
}

/// An output's name and SI unit; empty where dimensionless or unknown.
#[derive(Serialize)]
struct Named<'s> {
    name: &'s str,
    unit: &'s str,
}

/// `name` as a file name without extension that is valid on every system: letters, digits, `_`, `-` and `.` stay, the rest
/// becomes `_`.
pub fn file_stem(name: &str) -> String {
    /// Names of devices on Windows, whatever their extension.
    const RESERVED: [&str; 6] = ["con", "prn", "aux", "nul", "com", "lpt"];
    /// Bytes; file systems take 255, with the extension and a number.
    const LONGEST: usize = 120;

    let keep = |c: char| if c.is_alphanumeric() || "_-.".contains(c) { c } else { '_' };
    let mut stem: String = name.chars().map(keep).collect();
    while stem.len() > LONGEST {
        stem.pop();
    }
    // No hidden files, no `..`, and no trailing dot, which Windows drops.
    let trimmed = stem.trim_end_matches('.').len();
    stem.truncate(trimmed);
    let device = stem.split('.').next().unwrap_or("").trim_end_matches(|c: char| c.is_ascii_digit());
    if stem.is_empty() || stem.starts_with('.') || RESERVED.iter().any(|name| device.eq_ignore_ascii_case(name)) {
        stem.insert(0, '_');
    }
    stem
}

/// [`file_stem`]s, made unique (also where upper and lower case are one) by `-2`, `-3`, … on the later ones.
pub(super) fn unique_stems<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut unique = |name: &str| {
        let stem = file_stem(name);
        let mut candidate = stem.clone();
        let mut number = 1;
        while !taken.insert(candidate.to_lowercase()) {
            number += 1;
            candidate = format!("{stem}-{number}");
        }
        candidate
    };
    names.map(&mut unique).collect()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::results::OutputBounds;

    fn results() -> (Bounds, Summary) {
        let output =
            |name: &str| OutputBounds { name: name.into(), unit: "m".into(), nominal: vec![1.0, 2.0], bands: vec![] };
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
            redundant_constraints: vec![],
            undetermined_outputs: vec![],
            singular_at_start: vec![],
            shared_start: vec![],
            singular_configurations: vec![],
            damped_mode: None,
            integration: None,
            alpha: -0.1,
            duration: 1.0,
            parameters: vec![],
            methods: vec![],
            errors: vec![],
            contributions: vec![],
            pieces: vec![],
            reduced: vec![],
            requirements: vec![],
            not_simulated: vec![],
            subsystems: vec![],
            failure: None,
        };
        (bounds, summary)
    }

    fn names(dir: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn results_are_written_over_older_ones_and_nothing_else_is_left() {
        let dir = tempfile::tempdir().unwrap();
        let place = dir.path().join("results/crank");
        let (bounds, summary) = results();
        for _ in 0..2 {
            let written = write_results(&place, &bounds, &summary, &Provenance::default(), false).unwrap();
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
        let error = write_results(&place, &bounds, &summary, &Provenance::default(), false).unwrap_err();
        assert!(matches!(&error, ExportError::Folder { path, .. } if *path == place), "{error}");
        assert!(
            error.to_string().starts_with(&format!("cannot write into the folder {}: ", place.display())),
            "{error}"
        );
        assert_eq!(fs::read_to_string(&place).unwrap(), "mine");
    }

    #[test]
    fn a_file_that_cannot_be_replaced_is_named_and_nothing_half_is_left() {
        let dir = tempfile::tempdir().unwrap();
        // A folder stands where a file should.
        fs::create_dir(dir.path().join("x3.svg")).unwrap();
        let (bounds, summary) = results();
        let error = write_results(dir.path(), &bounds, &summary, &Provenance::default(), false).unwrap_err();
        let path = dir.path().join("x3.svg");
        assert!(error.to_string().starts_with(&format!("cannot write {}: ", path.display())), "{error}");
        assert!(!error.to_string().contains(".mbint-"), "{error}");
        assert_eq!(names(dir.path()), ["bounds.csv", "columns.json", "x3.svg"], "of which one is the folder");
    }

    #[cfg(unix)]
    #[test]
    fn a_read_only_folder_is_named() {
        use std::os::unix::fs::PermissionsExt;
        let dir = tempfile::tempdir().unwrap();
        let (bounds, summary) = results();
        fs::set_permissions(dir.path(), fs::Permissions::from_mode(0o555)).unwrap();
        // The superuser may write anywhere: nothing to see then.
        if fs::write(dir.path().join("probe"), "").is_err() {
            let error = write_results(dir.path(), &bounds, &summary, &Provenance::default(), false).unwrap_err();
            let path = dir.path().display().to_string();
            assert!(error.to_string().starts_with(&format!("cannot write into the folder {path}: perm")), "{error}");
        }
        fs::set_permissions(dir.path(), fs::Permissions::from_mode(0o755)).unwrap();
    }

    #[test]
    fn names_become_safe_and_unique_file_names() {
        for (name, stem) in [
            ("x3", "x3"),
            ("crank.angle", "crank.angle"),
            ("../../etc/passwd", "_.._.._etc_passwd"),
            ("..", "_"),
            ("", "_"),
            (".hidden", "_.hidden"),
            ("a b\n<c>:\"d\"|?*\\", "a_b__c___d_____"),
            ("NUL", "_NUL"),
            ("com1.x", "_com1.x"),
            ("command", "command"),
            ("θ₁", "θ₁"),
        ] {
            assert_eq!(file_stem(name), stem, "{name:?}");
        }
        assert!(file_stem(&"ä".repeat(500)).len() <= 121);
        let unique = unique_stems(["a b", "a/b", "A_B", "a_b-2", "c"].into_iter());
        assert_eq!(unique, ["a_b", "a_b-2", "A_B-3", "a_b-2-2", "c"]);
    }
}
