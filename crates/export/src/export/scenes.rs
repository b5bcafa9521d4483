//! Comparison of a model's scenes: `scenes.csv`, and an overlay plot of each output that several scenes have.

use std::path::{Path, PathBuf};

use csv::WriterBuilder;
use serde::Serialize;

use super::csv::number;
use super::error::ExportError;
use super::figure::Caption;
use super::folder::AtomicFiles;
use super::overlay::{SceneBounds, overlay_svg};
use super::owned::{Owned, PAGE, SCENES, SCHEMA};
use super::report::page_of_folders;
use super::stems::{file_stem, unique_stems};
use crate::results::OutputBounds;

/// All scenes' bounds in one table as CSV, in long form: a row for each scene, output, method and time.
///
/// Columns: `scene`, `output`, `unit`, `method`, `t`, `nominal`, `lower`, `upper`, `error`, `unresolved` (`true` if the
/// row is unreliable) and, if some scene covers a part of its box only, `covered`, the share of the box that the row
/// covers. An output without bands has one row for each time, without a method. Numbers are as in `bounds.csv`.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn scenes_csv(scenes: &[SceneBounds]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    let covered = scenes.iter().any(|scene| !scene.bounds.covered.is_empty());
    let headings = ["scene", "output", "unit", "method", "t", "nominal", "lower", "upper", "error", "unresolved"];
    writer.write_record(headings.into_iter().chain(covered.then_some("covered")))?;
    for scene in scenes {
        for output in &scene.bounds.outputs {
            for band in output.bands.iter().map(Some).chain(output.bands.is_empty().then_some(None)) {
                for (row, time) in scene.bounds.times.iter().enumerate() {
                    let of_band = band.map_or_else(<[String; 4]>::default, |band| {
                        let numbers = [band.lower[row], band.upper[row], band.error.total[row]].map(number);
                        let [lower, upper, error] = numbers;
                        [lower, upper, error, band.error.unresolved[row].to_string()]
                    });
                    let method = band.map_or("", |band| band.method.name()).to_owned();
                    let named = [scene.name.to_owned(), output.name.clone(), output.unit.clone(), method];
                    let share = scene.bounds.covered.get(row).copied().unwrap_or(1.0);
                    let record = named.into_iter().chain([number(*time), number(output.nominal[row])]).chain(of_band);
                    writer.write_record(record.chain(covered.then(|| number(share))))?;
                }
            }
        }
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// Writes an SVG of each output that more than one of the scenes has, `scenes.csv`, and `scenes.json`, which lists
/// them, into `dir`. Files of an older run that this one does not write are removed, and so are results of scenes that
/// are not among `all` that the model has. With `report`, one page shows all scenes whose results are there. Returns
/// the files written.
///
/// # Errors
/// As [`write_results`](super::write_results).
pub fn write_scenes(
    dir: &Path,
    model: &str,
    all: &[String],
    scenes: &[SceneBounds],
    report: bool,
) -> Result<Vec<PathBuf>, ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    let shared = shared(scenes);
    for (name, stem) in shared.iter().zip(unique_stems(shared.iter().copied())) {
        let svg = overlay_svg(Caption { model, prefix: "figure" }, name, scenes)?;
        files.add(&format!("{stem}.svg"), svg.as_bytes())?;
    }
    files.add("scenes.csv", &scenes_csv(scenes)?)?;
    let all: Vec<String> = all.iter().map(|name| file_stem(name)).collect();
    let written: Vec<String> = scenes.iter().map(|scene| file_stem(scene.name)).collect();
    let kept = Owned::of(dir).scenes;
    let listed = Listed {
        schema: SCHEMA,
        model,
        scenes: all.into_iter().filter(|folder| written.contains(folder) || kept.contains(folder)).collect(),
        files: files.names().into_iter().chain(report.then(|| PAGE.to_owned())).chain([SCENES.to_owned()]).collect(),
    };
    if report {
        files.add(PAGE, page_of_folders(dir, model, &listed.scenes)?.as_bytes())?;
    }
    let mut json = serde_json::to_vec_pretty(&listed)?;
    json.push(b'\n');
    files.add(SCENES, &json)?;
    files.replace_older(listed.scenes)?;
    files.put_in_place()
}

/// Removes the comparison of scenes, since one of them is about to be replaced.
///
/// # Errors
/// As [`write_results`](super::write_results).
pub fn remove_comparison(dir: &Path) -> Result<(), ExportError> {
    let mut files = AtomicFiles::in_folder(dir)?;
    files.replace_older(Owned::of(dir).scenes)?;
    files.put_in_place().map(drop)
}

/// Results of the scenes' runs together.
#[derive(Serialize)]
struct Listed<'s> {
    schema: u32,
    model: &'s str,
    /// Folders of the scenes that have results, in the model's order.
    scenes: Vec<String>,
    /// All files next to the scenes' folders, which the next run replaces.
    files: Vec<String>,
}

/// Outputs that more than one scene has, in the order of their first occurrence.
fn shared<'a>(scenes: &[SceneBounds<'a>]) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    let outputs = |scene: &SceneBounds<'a>| -> &'a [OutputBounds] { &scene.bounds.outputs };
    for output in scenes.iter().flat_map(outputs) {
        if !names.contains(&output.name.as_str()) {
            names.push(&output.name);
        }
    }
    let has = |scene: &&SceneBounds, name: &str| scene.bounds.outputs.iter().any(|output| output.name == name);
    names.retain(|name| scenes.iter().filter(|scene| has(scene, name)).count() > 1);
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::BandError;
    use crate::results::{Band, Bounds, Method};

    fn output(name: &str, nominal: &[f64], bands: Vec<Band>) -> OutputBounds {
        OutputBounds { name: name.into(), unit: "m".into(), display: None, nominal: nominal.to_vec(), bands }
    }

    fn scan(rows: usize) -> Band {
        let mut unresolved = vec![false; rows];
        unresolved[rows - 1] = true;
        let error = BandError { total: vec![1e-3; rows], unresolved, ..BandError::default() };
        Band { method: Method::Scan, lower: vec![-1.0; rows], upper: vec![0.5; rows], error }
    }

    #[test]
    fn table_has_long_format() {
        let first = Bounds {
            times: vec![0.0, 0.1],
            outputs: vec![output("x", &[0.0, f64::NAN], vec![scan(2)])],
            ..Bounds::default()
        };
        let second = Bounds {
            times: vec![0.5],
            outputs: vec![output("a,b", &[2.0], vec![])],
            covered: vec![0.25],
            ..Bounds::default()
        };
        let scenes = [SceneBounds { name: "one", bounds: &first }, SceneBounds { name: "two", bounds: &second }];
        assert_eq!(
            String::from_utf8(scenes_csv(&scenes).unwrap()).unwrap(),
            "scene,output,unit,method,t,nominal,lower,upper,error,unresolved,covered\n\
             one,x,m,scan,0,0,-1,0.5,0.001,false,1\n\
             one,x,m,scan,0.1,NaN,-1,0.5,0.001,true,1\n\
             two,\"a,b\",m,,0.5,2,,,,,0.25\n"
        );
        let whole = String::from_utf8(scenes_csv(&scenes[..1]).unwrap()).unwrap();
        assert!(whole.starts_with("scene,output,unit,method,t,nominal,lower,upper,error,unresolved\n"), "{whole}");
    }

    #[test]
    fn shared_outputs_are_plotted() {
        let bounds = |names: &[&str]| Bounds {
            times: vec![0.0, 1.0],
            outputs: names.iter().map(|name| output(name, &[0.0, 1.0], vec![scan(2)])).collect(),
            ..Bounds::default()
        };
        let (first, second) = (bounds(&["x", "own"]), bounds(&["load", "x"]));
        let scenes = [SceneBounds { name: "one", bounds: &first }, SceneBounds { name: "two", bounds: &second }];
        let dir = tempfile::tempdir().unwrap();
        let place = dir.path().join("door");
        let all = ["one", "two"].map(str::to_owned);
        let written = write_scenes(&place, "door", &all, &scenes, false).unwrap();
        assert_eq!(written, ["x.svg", "scenes.csv", "scenes.json"].map(|name| place.join(name)));
    }
}
