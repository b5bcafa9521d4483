//! The texts of a model's files: those on the disk, and those of the page.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::syntax::regular;
use crate::syntax::text_file::read_text;
use crate::syntax::tuning::TUNING;
use crate::syntax::within::OpenTexts;

/// Reasons why a text cannot be read, changed or saved.
#[derive(Debug, thiserror::Error)]
pub enum TextError {
    /// It does not belong to the model.
    #[error("`{0}` is no file of this model")]
    Foreign(String),
    /// Another program has written it.
    #[error(
        "{0} has changed on the disk since it was read: it is not overwritten. Load it again, or save a copy of your text elsewhere"
    )]
    Changed(String),
    /// It cannot be read.
    #[error("{0} cannot be read: {1}")]
    Unreadable(String, String),
    /// It cannot be written.
    #[error("{0} cannot be written: {1}")]
    Unwritten(String, io::Error),
}

/// Outcome of a change of a text's file.
#[derive(Debug, PartialEq, Eq)]
pub enum Followed {
    /// The file has the same text as before.
    Same,
    /// It is not an open text, but the model may depend on it.
    Other,
    /// The text has been replaced by this one.
    Loaded(String),
    /// The page has changed it: its text stays.
    Kept,
}

/// A file that is open.
struct Open {
    /// Text on the disk when it was last read or written.
    stored: String,
    /// Text of the page, with `
    /// ` at ends of lines.
    text: String,
}

impl Open {
    /// The text for the disk, with the line ends of the file.
    fn written(&self) -> String {
        if self.stored.contains("\r\n") { self.text.replace('\n', "\r\n") } else { self.text.clone() }
    }
}

/// The model's files.
pub struct Texts {
    /// The model, by its full path.
    model: PathBuf,
    /// Files of the model when it was last read.
    named: BTreeSet<PathBuf>,
    open: BTreeMap<PathBuf, Open>,
}

impl Texts {
    /// The texts of a model, given by its full path.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn new(model: PathBuf) -> Result<Self, TextError> {
        let mut texts = Self { named: BTreeSet::from([model.clone()]), model, open: BTreeMap::new() };
        let model = texts.model.clone();
        texts.open(&model)?;
        Ok(texts)
    }

    /// The model's path.
    pub fn model(&self) -> &Path {
        &self.model
    }

    /// Sets the files of which the model consists. Open files stay in the list.
    pub fn consists_of(&mut self, files: impl IntoIterator<Item = PathBuf>) {
        self.named = files.into_iter().chain([self.model.clone()]).chain(self.open.keys().cloned()).collect();
    }

    /// The model's files, itself first.
    pub fn files(&self) -> Vec<PathBuf> {
        let others = self.named.iter().filter(|path| **path != self.model);
        std::iter::once(&self.model).chain(others).cloned().collect()
    }

    /// Whether a file belongs to the model.
    pub fn has(&self, path: &Path) -> bool {
        self.named.contains(path)
    }

    /// Whether a file is open.
    pub fn is_open(&self, path: &Path) -> bool {
        self.open.contains_key(path)
    }

    /// The text of a file of the model, from the disk if it is not open.
    ///
    /// # Errors
    /// If it does not belong to the model, or cannot be read.
    pub fn open(&mut self, path: &Path) -> Result<&str, TextError> {
        if !self.is_open(path) {
            self.load(path)?;
        }
        self.open.get(path).map(|own| own.text.as_str()).ok_or_else(|| TextError::Foreign(name(path)))
    }

    /// Reads a file of the model again, and drops the page's text.
    ///
    /// # Errors
    /// As for [`open`](Self::open).
    pub fn load(&mut self, path: &Path) -> Result<(), TextError> {
        if !self.has(path) {
            return Err(TextError::Foreign(name(path)));
        }
        let stored = read_text(path, TUNING.file_bytes);
        let stored = stored.map_err(|error| TextError::Unreadable(name(path), error.message.clone()))?;
        let text = stored.replace("\r\n", "\n");
        self.open.insert(path.to_owned(), Open { stored, text });
        Ok(())
    }

    /// Takes over the text of a changed file, if the page has not changed it.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn follow(&mut self, path: &Path) -> Result<Followed, TextError> {
        let Some(own) = self.open.get(path) else { return Ok(Followed::Other) };
        let there = read_text(path, TUNING.file_bytes);
        let there = there.map_err(|error| TextError::Unreadable(name(path), error.message.clone()))?;
        if there == own.stored {
            return Ok(Followed::Same);
        }
        if self.is_unsaved(path) {
            return Ok(Followed::Kept);
        }
        self.load(path)?;
        Ok(Followed::Loaded(self.open(path)?.to_owned()))
    }

    /// Changes a text.
    ///
    /// # Errors
    /// If it is not open.
    pub fn change(&mut self, path: &Path, text: String) -> Result<(), TextError> {
        let own = self.open.get_mut(path).ok_or_else(|| TextError::Foreign(name(path)))?;
        own.text = text;
        Ok(())
    }

    /// Writes a text to its file, completely or not at all.
    ///
    /// # Errors
    /// If it is not open, cannot be written, or another program has changed the file.
    pub fn save(&mut self, path: &Path) -> Result<(), TextError> {
        let own = self.open.get_mut(path).ok_or_else(|| TextError::Foreign(name(path)))?;
        let failed = |error| TextError::Unwritten(name(path), error);
        let text = own.written();
        let there = regular(path, TUNING.file_bytes).map_err(failed)?;
        if there != own.stored.as_bytes() && there != text.as_bytes() {
            return Err(TextError::Changed(name(path)));
        }
        // A link stays a link.
        let full = path.canonicalize().map_err(failed)?;
        let mut file = NamedTempFile::new_in(full.parent().unwrap_or(Path::new("."))).map_err(failed)?;
        file.write_all(text.as_bytes()).map_err(failed)?;
        let permissions = fs::metadata(&full).map_err(failed)?.permissions();
        file.as_file().set_permissions(permissions).map_err(failed)?;
        file.persist(&full).map_err(|error| failed(error.error))?;
        own.stored = text;
        Ok(())
    }

    /// Whether a text differs from that on the disk.
    pub fn is_unsaved(&self, path: &Path) -> bool {
        self.open.get(path).is_some_and(|own| own.written() != own.stored)
    }

    /// The open texts, for a reader of models.
    pub fn overlay(&self) -> OpenTexts {
        OpenTexts::new(self.open.iter().map(|(path, own)| (path.clone(), own.text.clone())))
    }
}

/// A file's name, for people.
fn name(path: &Path) -> String {
    crate::model::shown(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn saving_keeps_line_ends_and_foreign_changes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.yaml");
        fs::write(&path, "a: 1\r\nb: 2\r\n").unwrap();
        let mut texts = Texts::new(path.clone()).unwrap();
        assert_eq!(texts.open(&path).unwrap(), "a: 1\nb: 2\n");
        assert!(!texts.is_unsaved(&path));
        texts.change(&path, "a: 1\nb: 3\n".to_owned()).unwrap();
        assert!(texts.is_unsaved(&path));
        texts.save(&path).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "a: 1\r\nb: 3\r\n");
        fs::write(&path, "other").unwrap();
        assert!(matches!(texts.save(&path), Err(TextError::Changed(_))));
        assert_eq!(fs::read_to_string(&path).unwrap(), "other");
        texts.load(&path).unwrap();
        assert_eq!(texts.open(&path).unwrap(), "other");
        assert_eq!(texts.follow(&path).unwrap(), Followed::Same);
        fs::write(&path, "new\r\n").unwrap();
        assert_eq!(texts.follow(&path).unwrap(), Followed::Loaded("new\n".to_owned()));
        texts.change(&path, "mine\n".to_owned()).unwrap();
        fs::write(&path, "newer").unwrap();
        assert_eq!(texts.follow(&path).unwrap(), Followed::Kept);
        assert_eq!(texts.open(&path).unwrap(), "mine\n");
        let beside = folder.path().join("beside.yaml");
        fs::write(&beside, "x").unwrap();
        assert!(matches!(texts.open(&beside), Err(TextError::Foreign(_))));
        assert_eq!(texts.follow(&beside).unwrap(), Followed::Other);
        assert!(matches!(texts.save(&beside), Err(TextError::Foreign(_))));
        texts.consists_of([beside.clone()]);
        assert_eq!(texts.open(&beside).unwrap(), "x");
        assert_eq!(texts.files(), [path, beside]);
    }
}
