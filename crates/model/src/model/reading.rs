//! The result of reading a model: the model, its scenes, and everything that is wrong.

use super::description::Description;
use crate::syntax::diagnostic::Diagnostics;
use crate::syntax::suggest::{self, clip};
use crate::syntax::{Code, Coded};

/// Result of reading a model: both may be there if there are only warnings.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The model itself, unless it or a scene of it has errors.
    pub description: Option<Description>,
    /// Its scenes, each a model of its own; none if there are errors.
    pub scenes: Vec<Scene>,
    /// Errors and warnings.
    pub diagnostics: Diagnostics,
}

/// A scene of a model.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Its name, which is also that of its folder.
    pub name: String,
    /// The model as it is in this scene; its name is `MODEL/SCENE`.
    pub description: Description,
}

/// A scene that a model does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no scene `{name}`: {help}")]
pub struct UnknownScene {
    /// As it was asked for.
    name: String,
    /// Suggested correction.
    help: String,
}

impl Reading {
    /// Scenes by their names, in the file's order, each with its name; all where none is named. A model without scenes
    /// is chosen itself, under no name.
    ///
    /// # Errors
    /// For a name that no scene has.
    pub fn chosen(self, names: &[String]) -> Result<Vec<(Option<String>, Description)>, UnknownScene> {
        let known = || self.scenes.iter().map(|scene| scene.name.as_str());
        if let Some(name) = names.iter().find(|name| !known().any(|known| known == **name)) {
            let help = match self.scenes.len() {
                0 => "the model has no `scenes`".to_owned(),
                _ => suggest::help(name, "scenes", known()).unwrap_or_else(|| "`mbint check` lists them".to_owned()),
            };
            return Err(UnknownScene { name: clip(name), help });
        }
        if self.scenes.is_empty() {
            return Ok(self.description.map(|description| (None, description)).into_iter().collect());
        }
        let chosen = self.scenes.into_iter().filter(|scene| names.is_empty() || names.contains(&scene.name));
        Ok(chosen.map(|scene| (Some(scene.name), scene.description)).collect())
    }
}

impl Coded for UnknownScene {
    fn code(&self) -> Option<Code> {
        Some(Code::UnknownName)
    }
}
