//! A report of results that are in a folder.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::motion::MOTION;
use super::page::{PageFigure, PageScene, content, page};
use super::tables::{list, text};
use crate::export::earlier::scene_folders;
use crate::export::error::ExportError;
use crate::export::files::stem_of_response;
use crate::export::folder::{AtomicFiles, settle};
use crate::export::owned::{PAGE, SCENES, SUMMARY, read};
use crate::export::stack::FIGURES;
use crate::export::stems::unique_stems;

/// Writes `report.html` again from the results in a folder, of a model or of its scenes. Returns its path.
///
/// # Errors
/// If the folder has no results, or cannot be written into.
pub fn write_report(dir: &Path) -> Result<PathBuf, ExportError> {
    settle(dir)?;
    let text = match dir.join(SCENES).is_file() {
        true => {
            let listed = read_json(&dir.join(SCENES))?;
            page_of_folders(dir, text(&listed, "model"), &scene_folders(dir))?
        }
        false => {
            let scene = scene_of_folder(dir)?;
            page(&scene.name.clone(), &[scene])
        }
    };
    let mut files = AtomicFiles::in_folder(dir)?;
    files.add(PAGE, text.as_bytes())?;
    files.join_older()?;
    files.put_in_place()?;
    Ok(dir.join(PAGE))
}

/// The article of the results in a folder, as in a page of reports, for a page that is served.
///
/// # Errors
/// If the folder has no results, or they cannot be read.
pub fn results_article(dir: &Path) -> Result<String, ExportError> {
    Ok(content(0, &scene_of_folder(dir)?, 1))
}

/// The page of scenes whose results are in folders of a folder.
///
/// # Errors
/// If one of them cannot be read.
pub(in crate::export) fn page_of_folders(dir: &Path, model: &str, folders: &[String]) -> Result<String, ExportError> {
    let scenes = folders.iter().map(|folder| scene_of_folder(&dir.join(folder))).collect::<Result<Vec<_>, _>>()?;
    let scenes: Vec<PageScene> = scenes
        .into_iter()
        .map(|scene| PageScene { name: scene.name.rsplit('/').next().unwrap_or_default().to_owned(), ..scene })
        .collect();
    Ok(page(model, &scenes))
}

/// Contents of a page for the results in a folder.
///
/// # Errors
/// If one of the files cannot be read.
pub(in crate::export) fn scene_of_folder(dir: &Path) -> Result<PageScene, ExportError> {
    settle(dir)?;
    if !dir.join(SUMMARY).exists() {
        return Err(ExportError::NoResults { folder: dir.to_owned() });
    }
    let summary = read_json(&dir.join(SUMMARY))?;
    // Without it, its contents are not on the page.
    let motion = read_json(&dir.join(MOTION)).unwrap_or(Value::Null);
    let names = list(&summary, "outputs").iter().map(|output| text(output, "name"));
    let svg = |name: String| String::from_utf8(read(&dir.join(name)).ok()?).ok();
    let files = list(&summary, "files").iter().filter_map(Value::as_str);
    let responses = files.filter_map(|file| Some((stem_of_response(file)?, vec![file.to_owned()])));
    let outputs = names.clone().zip(unique_stems(names));
    let of_output = |stem: String| {
        let suffixes = ["svg", "contributions.svg"].into_iter().chain(FIGURES);
        suffixes.map(|suffix| format!("{stem}.{suffix}")).collect::<Vec<_>>()
    };
    let outputs = outputs.map(|(output, stem)| (output, of_output(stem)));
    let figure = |(output, files): (&str, Vec<String>)| PageFigure {
        output: output.to_owned(),
        plots: files.into_iter().filter_map(svg).collect(),
    };
    // Outputs of one configuration have no plots.
    let figures = responses.chain(outputs).map(figure).filter(|figure| !figure.plots.is_empty()).collect();
    Ok(PageScene { name: text(&summary, "model").to_owned(), figures, motion, summary })
}

fn read_json(path: &Path) -> Result<Value, ExportError> {
    let failed = |source| ExportError::Read { path: path.to_owned(), source };
    let bytes = read(path).map_err(failed)?;
    serde_json::from_slice(&bytes).map_err(|error| failed(std::io::Error::other(error)))
}
