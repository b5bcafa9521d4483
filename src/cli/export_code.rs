//! `mbint export`: a model as source code, or as a unit of FMI.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::args::{ExportArgs, UnitVersion};
use super::console::{BOLD, Console, file_names};
use super::run::results_of;
use super::{Failure, Status, interrupt, load};
use crate::c_code::{CModel, FmiVersion};
use crate::export::{prepare_folder, write_archive};
use crate::study::{self, CodeError, RunError};

pub(super) fn export(args: &ExportArgs, console: &mut Console) -> Result<Status, Failure> {
    let Some(model) = load::load(&args.model, &args.set.given()?, args.scene.as_ref(), console)? else {
        return Ok(Status::Wrong);
    };
    let version = match args.formats.fmu {
        Some(UnitVersion::Two) => FmiVersion::Two,
        Some(UnitVersion::Three) | None => FmiVersion::Three,
    };
    let code = study::code(&model, &args.inputs, version).map_err(|error| {
        let message = format!("{}: {error}", model.name);
        match &error {
            CodeError::None(_) | CodeError::Run(RunError::Refused(_)) => Failure::wrong(message),
            CodeError::Run(_) => Failure::failed(message),
        }
        .of(&error)
    })?;
    if code.singular_steps > 0 {
        console.warning(&format!(
            "{}: the nominal motion passes singular configurations (steps there: {}), and the C has no rank-revealing \
             solve: such a step is divided, and may fail. A shorter `duration`, or other values by --set, avoid them",
            model.name, code.singular_steps,
        ));
    }
    let folder = args.output.clone().unwrap_or_else(|| results_of(&model.name));
    prepare_folder(&folder).map_err(|error| Failure::wrong(&error).of(&error))?;
    interrupt::wait_for(&folder)?;
    let mut files = Vec::new();
    if args.formats.c {
        files.extend(written(&folder, &code.files)?);
    }
    if args.formats.fmu.is_some() {
        files.push(unit(&folder, &code, version, console)?);
    }
    console.print(&format!("{BOLD}{}{BOLD:#}: {}\n  {}\n", model.name, folder.display(), file_names(files.iter())))?;
    Ok(Status::Done)
}

fn written(folder: &Path, files: &[(String, String)]) -> Result<Vec<PathBuf>, Failure> {
    let write = |(name, text): &(String, String)| {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|error| Failure::failed(format!("{}: {error}", path.display())))?;
        Ok(path)
    };
    files.iter().map(write).collect()
}

/// Writes the unit, with a library for this platform if there is a C compiler.
fn unit(folder: &Path, code: &CModel, version: FmiVersion, console: &Console) -> Result<PathBuf, Failure> {
    let mut files: Vec<(String, Vec<u8>)> =
        code.unit.iter().map(|(name, text)| (name.clone(), text.clone().into_bytes())).collect();
    match library(code, version) {
        Ok(library) => files.push(library),
        Err(why) => console.warning(&format!("the unit has sources and no library: {why}")),
    }
    let path = folder.join(format!("{}.fmu", code.identifier));
    write_archive(&path, &files).map_err(|error| Failure::failed(&error).of(&error))?;
    Ok(path)
}

/// The shared library of a unit, compiled by `CC`, or `cc`, and its path in the unit.
fn library(code: &CModel, version: FmiVersion) -> Result<(String, Vec<u8>), String> {
    let place = tempfile::tempdir().map_err(|error| error.to_string())?;
    let mut sources = Vec::new();
    for (name, text) in code.unit.iter().filter_map(|(name, text)| Some((name.strip_prefix("sources/")?, text))) {
        fs::write(place.path().join(name), text).map_err(|error| error.to_string())?;
        sources.extend(name.ends_with(".c").then_some(name));
    }
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let file = format!("{}.{}", code.identifier, std::env::consts::DLL_EXTENSION);
    let options = ["-std=c99", "-O2", "-fPIC", "-shared", "-fvisibility=hidden", "-o", &file];
    let mut command = Command::new(&compiler);
    let made = command.args(options).args(sources).arg("-lm").current_dir(place.path()).output();
    let made = made.map_err(|error| format!("`{compiler}` cannot be started: {error}"))?;
    if !made.status.success() {
        return Err(format!("`{compiler}` failed: {}", String::from_utf8_lossy(&made.stderr).trim()));
    }
    let bytes = fs::read(place.path().join(&file)).map_err(|error| error.to_string())?;
    let system = if cfg!(target_os = "macos") { "darwin" } else { std::env::consts::OS };
    let platform = match version {
        FmiVersion::Two => format!("{}64", if cfg!(windows) { "win" } else { system }),
        FmiVersion::Three => format!("{}-{system}", std::env::consts::ARCH),
    };
    Ok((format!("binaries/{platform}/{file}"), bytes))
}
