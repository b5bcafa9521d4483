//! `<asset>`: meshes by their names, properties of those that were read, and the folders of the assets' files.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use super::document::{Attribute, Item};
use crate::robots::meshes::SolidMeasures;
use crate::syntax::source::Span;
use crate::syntax::within::AllowedFolders;

/// Meshes of the file.
pub struct Meshes<'i> {
    pub files: &'i AllowedFolders,
    /// Folder of the file, and of its meshes in it.
    pub folder: PathBuf,
    pub meshdir: PathBuf,
    /// Whether only the last part of a file's name counts.
    pub strips: bool,
    pub by_name: BTreeMap<String, &'i Item>,
    /// Those read; `None` for one that cannot be read.
    pub known: HashMap<String, Option<SolidMeasures>>,
    /// Meshes with an open surface, and those that enclose less than their tetrahedra: location and description of
    /// each.
    pub open: Vec<(Span, String)>,
    pub folded: Vec<(Span, String)>,
}

impl<'i> Meshes<'i> {
    /// Meshes of a document in a folder, none of them read.
    pub fn new(root: &'i Item, files: &'i AllowedFolders, folder: &Path) -> Self {
        let items = root.of("asset").flat_map(|asset| asset.of("mesh"));
        let by_name = items.filter_map(|item| Some((name_of(item)?, item))).collect();
        Self {
            files,
            folder: folder.to_owned(),
            meshdir: PathBuf::new(),
            strips: false,
            by_name,
            known: HashMap::new(),
            open: Vec::new(),
            folded: Vec::new(),
        }
    }
}

/// Its own name, or that of its file.
pub fn name_of(item: &Item) -> Option<String> {
    let of_file = |file: &Attribute| Some(Path::new(&file.value).file_stem()?.to_string_lossy().into_owned());
    item.get("name").map(|name| name.value.clone()).or_else(|| item.get("file").and_then(of_file))
}
