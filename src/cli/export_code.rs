//! `mbint export`: a model as source code.

use std::fs;

use super::args::ExportArgs;
use super::console::{BOLD, Console, file_names};
use super::run::results_of;
use super::{Failure, Status, interrupt, load};
use crate::export::prepare_folder;
use crate::study::{self, CodeError};

pub(super) fn export(args: &ExportArgs, console: &mut Console) -> Result<Status, Failure> {
    let Some(model) = load::load(&args.model, &args.set.given()?, args.scene.as_ref(), console)? else {
        return Ok(Status::Wrong);
    };
    let code = study::code(&model).map_err(|error| {
        let message = format!("{}: {error}", model.name);
        match error {
            CodeError::None(_) | CodeError::Run(study::RunError::Refused(_)) => Failure::Wrong(message),
            CodeError::Run(_) => Failure::Failed(message),
        }
    })?;
    let folder = args.output.clone().unwrap_or_else(|| results_of(&model.name));
    prepare_folder(&folder).map_err(|error| Failure::Wrong(error.to_string()))?;
    interrupt::wait_for(&folder)?;
    let mut files = Vec::new();
    for (name, text) in &code.files {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|error| Failure::Failed(format!("{}: {error}", path.display())))?;
        files.push(path);
    }
    console.print(&format!("{BOLD}{}{BOLD:#}: {}\n  {}\n", model.name, folder.display(), file_names(files.iter())))?;
    Ok(Status::Done)
}
