//! Models as an editor has them: texts that are not stored yet, and names with their locations.

use std::path::Path;

use super::load::{Changes, ModelOrigin, read_from, read_rooted, robot_alone, shown};
use super::reading::Reading;
use crate::grammar::mentions::{Mentions, Notes};
use crate::syntax::within::{AllowedFolders, OpenTexts};

/// A model that is open in an editor.
#[derive(Clone, Debug)]
pub struct Opened {
    /// As it was read.
    pub reading: Reading,
    /// Its names and formulas, as far as it could be read.
    pub mentions: Mentions,
}

/// Reads a model, some of whose files are open in an editor. Other files are read as [`read_rooted`] reads them.
pub fn read_open(path: &Path, open: &OpenTexts, root: Option<&Path>) -> Opened {
    let Some(text) = open.get(path) else {
        return Opened { reading: read_rooted(path, Changes::of(&[]), root), mentions: Mentions::default() };
    };
    let (name, notes) = (shown(path), Notes::default());
    let files = AllowedFolders::of(path, root).with_open(open);
    // The model of a robot alone has no text of its own: names have no locations in it.
    let reading = match robot_alone(path) {
        Some(model) => read_from(ModelOrigin::of(&name, files, None), &model, Changes::of(&[])),
        None => read_from(ModelOrigin::of(&name, files, Some(&notes)), text, Changes::of(&[])),
    };
    Opened { reading, mentions: notes.into_inner() }
}
