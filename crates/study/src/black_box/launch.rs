//! Start of processes of a program.

use std::path::PathBuf;
use std::process::Command;
use std::sync::OnceLock;

use mbint_fmu::Unpacked;

use crate::model::Program;

/// The command of mbint that answers for a unit of FMI.
const ANSWER: &str = "answer-fmu";

/// Starts processes of a program.
#[derive(Debug)]
pub(super) struct Launch {
    program: Program,
    /// The unit's files: unpacked once, for all processes, and gone with this.
    unpacked: OnceLock<Result<Unpacked, String>>,
}

impl Launch {
    /// A launch of `program`. Nothing is unpacked before the first process.
    pub fn new(program: Program) -> Self {
        Self { program, unpacked: OnceLock::new() }
    }

    /// A process that may be started: without a shell, in the user's environment.
    ///
    /// # Errors
    /// If a unit cannot be unpacked.
    pub fn command(&self) -> Result<Command, String> {
        match &self.program {
            Program::Command { words, directory } => {
                let mut command = Command::new(&words[0]);
                command.args(&words[1..]);
                directory.iter().for_each(|folder| {
                    command.current_dir(folder);
                });
                Ok(command)
            }
            Program::Fmu(own) => {
                let unpacked = self
                    .unpacked
                    .get_or_init(|| Unpacked::new(&own.file, &own.task).map_err(|error| error.to_string()));
                let folder = unpacked.as_ref().map_err(Clone::clone)?.path();
                let mut command = Command::new(mbint());
                command.arg(ANSWER).arg(folder);
                Ok(command)
            }
        }
    }

    /// Its name in messages.
    pub fn name(&self) -> String {
        match &self.program {
            Program::Command { words, .. } => words[0].clone(),
            Program::Fmu(own) => own.file.display().to_string(),
        }
    }
}

/// The program mbint: this one, or the one on the path where this is another program that uses the library.
fn mbint() -> PathBuf {
    let own = std::env::current_exe().ok();
    own.filter(|own| own.file_stem().is_some_and(|stem| stem == "mbint")).unwrap_or_else(|| PathBuf::from("mbint"))
}
