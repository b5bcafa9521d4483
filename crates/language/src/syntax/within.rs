//! Files that a model may name: those in its folder or below, and those in a folder that the user names or below.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use super::codes::Code;
use super::diagnostic::Diagnostic;
use super::harmless;
use super::suggest::clip;
use super::text_file::read_text;

/// Folders whose files a model may name.
#[derive(Clone, Debug)]
pub struct AllowedFolders {
    /// The model's folder, to which names are relative.
    folder: PathBuf,
    /// The folder of `--root`.
    root: Option<PathBuf>,
    /// Texts that replace files on the disk.
    open: OpenTexts,
}

/// Texts of files that are being edited, by their full paths.
#[derive(Clone, Debug, Default)]
pub struct OpenTexts(Arc<BTreeMap<PathBuf, String>>);

impl OpenTexts {
    /// The texts of these files.
    pub fn new(texts: impl IntoIterator<Item = (PathBuf, String)>) -> Self {
        Self(Arc::new(texts.into_iter().map(|(path, text)| (real(&path), text)).collect()))
    }

    /// The same with another text.
    #[must_use]
    pub fn with(&self, path: PathBuf, text: String) -> Self {
        let mut texts = (*self.0).clone();
        texts.insert(real(&path), text);
        Self(Arc::new(texts))
    }

    /// The text of a file, if it is open.
    pub fn get(&self, path: &Path) -> Option<&str> {
        if self.0.is_empty() { None } else { self.0.get(&real(path)).map(String::as_str) }
    }
}

impl AllowedFolders {
    /// The folders for the model of a path.
    pub fn of(model: &Path, root: Option<&Path>) -> Self {
        Self {
            folder: model.parent().unwrap_or(Path::new("")).to_owned(),
            root: root.map(Path::to_owned),
            open: OpenTexts::default(),
        }
    }

    /// The same, with texts that replace files.
    #[must_use]
    pub fn with_open(self, open: &OpenTexts) -> Self {
        Self { open: open.clone(), ..self }
    }

    /// Reads a file that the model may name: the text that is being edited, else the stored one, of at most `most`
    /// bytes.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn read(&self, path: &Path, most: u64) -> Result<String, Box<Diagnostic>> {
        self.open.get(path).map_or_else(|| read_text(path, most), |text| Ok(text.to_owned()))
    }

    /// The path, relative to the model's folder, of a file with a name relative to the folder `from`, which is relative
    /// to the model's folder, too. A file that the model may not name is not examined.
    ///
    /// # Errors
    /// If the model may not name it.
    pub fn find(&self, from: &Path, name: &str) -> Result<PathBuf, Box<Diagnostic>> {
        let path = normal(&from.join(name));
        let folders: Vec<PathBuf> =
            [Some(&self.folder), self.root.as_ref()].into_iter().flatten().map(|folder| real(folder)).collect();
        let below = |path: &Path| folders.iter().any(|folder| path.starts_with(folder));
        let named = below(&normal(&real(&self.folder).join(&path)));
        // A link may lead out of the folder, or into it.
        let is_below = self.full(&path).canonicalize().map_or(named, |found| below(&found));
        if is_below {
            return Ok(path);
        }
        let verb = if named { "leads out of" } else { "is not within" };
        let (folder, help) = match &self.root {
            None => ("the model's folder".to_owned(), "in that folder or below, or in that of `--root DIR` or below"),
            Some(root) => {
                let root = harmless(&root.display().to_string());
                (format!("the model's folder, nor within `{}`", clip(&root)), "in one of these folders or below")
            }
        };
        let message = format!("`{}` {verb} {folder}", clip(name));
        Err(Box::new(
            Diagnostic::of_file(Code::OutsideFolder, message).help(format!("a file that a model names lies {help}")),
        ))
    }

    /// The full path of one that is relative to the model's folder.
    pub fn full(&self, path: &Path) -> PathBuf {
        self.folder.join(path)
    }
}

/// The path of a folder without links in it; with them if the folder does not exist.
fn real(folder: &Path) -> PathBuf {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    folder
        .canonicalize()
        .or_else(|_| std::path::absolute(folder))
        .map_or_else(|_| folder.to_owned(), |path| normal(&path))
}

/// A path without `.` and, if possible, without `..`.
fn normal(path: &Path) -> PathBuf {
    let mut found = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(found.components().next_back(), Some(Component::Normal(_))) => {
                found.pop();
            }
            part => found.push(part),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_stay_below_the_model_folder_or_the_root() {
        let place = tempfile::tempdir().unwrap();
        let folder = |name: &str| {
            let path = place.path().join(name);
            std::fs::create_dir_all(&path).unwrap();
            path
        };
        let (all, robots, outside) = (folder("all"), folder("all/robots"), folder("outside"));
        for path in [robots.join("a"), all.join("shared"), outside.join("secret")] {
            std::fs::write(path, "").unwrap();
        }
        let model = robots.join("model.yaml");
        let found = |root: Option<&Path>, name: &str| {
            let within = AllowedFolders::of(&model, root);
            within.find(Path::new("parts"), name).map(|path| path.display().to_string()).map_err(|error| error.message)
        };
        let alone = |name: &str| found(None, name);
        assert_eq!(alone("x").as_deref(), Ok("parts/x"), "files that are not there are looked for");
        assert_eq!(alone("./y/../../a").as_deref(), Ok("a"));
        let absolute = robots.join("a").display().to_string();
        assert!(found(None, &absolute).is_ok(), "an absolute path within");
        assert_eq!(alone("../../shared").unwrap_err(), "`../../shared` is not within the model's folder");
        assert_eq!(alone("../../none").unwrap_err(), "`../../none` is not within the model's folder");
        let rooted = |name: &str| found(Some(&all), name);
        assert_eq!(rooted("../../shared").as_deref(), Ok("../shared"));
        assert_eq!(rooted("../a").as_deref(), Ok("a"), "the model's folder stays");
        let message = rooted("../../../outside/secret").unwrap_err();
        assert!(message.starts_with("`../../../outside/secret` is not within the model's folder, nor within `"));
        assert!(found(Some(&outside), "../../../outside/secret").is_ok());
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(outside.join("secret"), robots.join("link")).unwrap();
            assert_eq!(alone("../link").unwrap_err(), "`../link` leads out of the model's folder");
            assert!(found(Some(&outside), "../link").is_ok());
        }
    }
}
