//! The files that a model was read from.

use std::path::Path;

use sha2::{Digest, Sha256};

use crate::model::Reading;
use crate::results::ModelFile;

/// The files that were read, the model first, with hashes of their bytes; and their names and texts.
pub fn sources(reading: &Reading) -> (Vec<ModelFile>, Vec<(String, String)>) {
    let mut paths: Vec<&str> = Vec::new();
    let mut files: Vec<ModelFile> = Vec::new();
    let mut texts: Vec<(String, String)> = Vec::new();
    for source in reading.diagnostics.sources.all().filter(|source| source.name != "--set") {
        let name = Path::new(&source.name).file_name().map_or_else(String::new, |name| name.to_string_lossy().into());
        let sha256 = Sha256::digest(&source.text).iter().map(|byte| format!("{byte:02x}")).collect();
        let file = ModelFile { name: name.clone(), sha256 };
        // A robot alone stands behind the text of the model that is made of it. Files of two folders may have one name.
        if let Some(index) = paths.iter().position(|path| *path == source.name) {
            files[index] = file;
            texts[index].1.clone_from(&source.text);
        } else {
            paths.push(&source.name);
            files.push(file);
            texts.push((name, source.text.clone()));
        }
    }
    (files, texts)
}
