//! A folder of its own for a test, in which commands run.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use mbint::{Diagnostics, Error, Model};
use tempfile::TempDir;

/// A folder of its own for each test, in which commands run.
pub struct Place(TempDir);

impl Place {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("mbint"));
        command.args(arguments.split_whitespace()).current_dir(self.path());
        for variable in ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE"] {
            command.env_remove(variable);
        }
        command
    }

    /// Runs `mbint` and checks its exit status.
    #[track_caller]
    pub fn run(&self, arguments: &str, status: i32) -> (String, String) {
        let Output { status: ended, stdout, stderr } = self.command(arguments).output().unwrap();
        let (stdout, stderr) = (String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap());
        assert_eq!(ended.code(), Some(status), "mbint {arguments}\n{stdout}\n{stderr}");
        (stdout, stderr)
    }

    /// A short model of this name; the template, with less to compute.
    pub fn model(&self, name: &str) {
        self.run(&format!("new {name}"), 0);
        let path = self.path().join(format!("{name}.yaml"));
        let text = fs::read_to_string(&path).unwrap();
        let short = text.replace("duration: 2,", "duration: 0.1,").replace("points: 9", "points: 3");
        assert_ne!(text, short);
        fs::write(path, short).unwrap();
    }

    /// Names of the entries of a folder, but for mbint's list of its own files.
    pub fn files(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path().join(folder)).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.retain(|name| name != ".mbint.json");
        names.sort();
        names
    }
}

/// All diagnostics of a model: its errors or its warnings.
pub fn diagnostics_of(model: Result<Model, Error>) -> Diagnostics {
    match model {
        Ok(model) => model.warnings().clone(),
        Err(Error::Model(diagnostics)) => diagnostics,
        Err(error) => panic!("{error}"),
    }
}
