//! Runs the program on the shipped models.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde::Deserialize;

use super::record::{Case, Figure, Run};

/// Models of a quick run.
const FEW: [&str; 2] = ["pendulum.yaml", "four_bar.yaml"];

/// Keywords of `mbint verify`'s JSON.
#[derive(Deserialize)]
struct Verification {
    formulations: Vec<Formulation>,
}

#[derive(Deserialize)]
struct Formulation {
    formulation: String,
    derivatives: Vec<Derivatives>,
    balance: Option<Balance>,
    schemes: Vec<Scheme>,
    failure: Option<String>,
}

#[derive(Deserialize)]
struct Derivatives {
    /// `None` for a number that is not finite.
    difference: Option<f64>,
}

#[derive(Deserialize)]
struct Balance {
    defect: f64,
}

#[derive(Deserialize)]
struct Scheme {
    scheme: String,
    convergence: Vec<Convergence>,
    failure: Option<String>,
}

#[derive(Deserialize)]
struct Convergence {
    theory: f64,
    order: Option<f64>,
    is_verified: bool,
}

/// Models and robots of `models/`, in alphabetical order.
pub fn models(root: &Path, quick: bool) -> Result<Vec<PathBuf>, String> {
    let folder = root.join("models");
    let entries = std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    let is_model = |ending: &str| ["yaml", "urdf", "xml"].contains(&ending);
    files.retain(|file| file.extension().is_some_and(|ending| is_model(&ending.to_string_lossy())));
    files.retain(|file| !quick || FEW.contains(&&*name(file)));
    files.sort();
    Ok(files)
}

fn name(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// A case of a claim for every model, by a command applied to it.
fn of_models(
    root: &Path,
    claim: &str,
    quick: bool,
    command: &str,
    mut measured: impl FnMut(&Path) -> Result<Case, String>,
) -> (Run, Vec<Case>) {
    let mut run = Run { command: command.to_owned(), ..Run::default() };
    let files = models(root, quick).unwrap_or_else(|error| {
        run.error = Some(error);
        Vec::new()
    });
    let mut cases = Vec::new();
    for file in files {
        match measured(&file) {
            Ok(case) => {
                cases.push(Case { claim: claim.to_owned(), case: format!("`{}`", name(&file)), ..case });
            }
            Err(error) => run.error = Some(format!("{}: {error}", name(&file))),
        }
    }
    (run, cases)
}

/// `mbint verify` of every model, as cases of a claim.
pub fn verified_models(root: &Path, program: &Path, claim: &str, quick: bool) -> (Run, Vec<Case>) {
    of_models(root, claim, quick, "mbint verify MODEL --format json", |file| {
        let output = Command::new(program).arg("verify").arg(file).args(["--format", "json", "--quiet"]).output();
        output.map_err(|error| error.to_string()).and_then(|output| verified(&output))
    })
}

/// The case of an answer of `mbint verify`; the error gives the reason if there is none.
fn verified(output: &Output) -> Result<Case, String> {
    let said = String::from_utf8_lossy(&output.stderr);
    if said.contains("takes no steps") {
        return Ok(Case { exception: Some(said.trim().to_owned()), ..Case::default() });
    }
    let found: Verification =
        serde_json::from_slice(&output.stdout).map_err(|error| format!("{error}: {}", said.trim()))?;
    let mut case = Case::default();
    let mut schemes: Vec<(&str, Vec<&Convergence>)> = Vec::new();
    for own in found.formulations.iter().flat_map(|own| &own.schemes) {
        match schemes.iter_mut().find(|(name, _)| *name == own.scheme) {
            Some((_, all)) => all.extend(&own.convergence),
            None => schemes.push((&own.scheme, own.convergence.iter().collect())),
        }
    }
    for (name, all) in schemes {
        let name = name.split(", ").next().unwrap_or(name);
        let lowest = all.iter().filter_map(|own| own.order).reduce(f64::min);
        let theory = all.iter().map(|own| own.theory).fold(0.0, f64::max);
        // Rounding dominates errors of the explicit method early; there the program decides.
        let low = if theory > 4.0 { 4.0 } else { 0.95 * theory };
        case.figures.push(match lowest {
            _ if !all.iter().all(|own| own.is_verified) => {
                Figure::number(name, lowest.unwrap_or(f64::NAN), Some(theory), None)
            }
            Some(lowest) => Figure::number(name, lowest, Some(low), None),
            None => Figure::words(name, "exact"),
        });
    }
    let all = found.formulations.iter().flat_map(|own| &own.derivatives);
    if let Some(most) = all.map(|own| own.difference.unwrap_or(f64::NAN)).reduce(worse) {
        case.figures.push(Figure::number("derivatives", most, None, Some(1e-9)));
    }
    let defects = found.formulations.iter().filter_map(|own| own.balance.as_ref()).map(|own| own.defect);
    if let Some(defect) = defects.reduce(f64::max) {
        case.figures.push(Figure::number("power", defect, None, Some(1e-9)));
    }
    let whole = found.formulations.iter().filter_map(|own| Some((&own.formulation, own.failure.as_ref()?)));
    let partly = found
        .formulations
        .iter()
        .flat_map(|own| &own.schemes)
        .filter_map(|own| Some((&own.scheme, own.failure.as_ref()?)));
    let reasons: Vec<String> = whole.chain(partly).map(|(what, why)| format!("{what}: {why}")).collect();
    case.exception = (!reasons.is_empty()).then(|| reasons.join("; "));
    if case.figures.is_empty() && case.exception.is_none() {
        return Err("nothing was verified".to_owned());
    }
    Ok(case)
}

/// The larger; NaN if either is.
fn worse(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

/// Conditions that vary from run to run, but must not change results.
const OTHERWISE: [(&str, &[&str], Option<&str>); 2] = [
    ("one thread", &["--threads", "1"], None),
    ("no fused operations", &[], Some("glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX512F")),
];

/// `mbint run` of every model, under each condition: the number of files that differ.
pub fn same_bytes(root: &Path, program: &Path, claim: &str, quick: bool) -> (Run, Vec<Case>) {
    of_models(root, claim, quick, "mbint run MODEL --quiet --yes --no-report --output FOLDER", |file| {
        Ok(Case { figures: compared(program, file)?, ..Case::default() })
    })
}

fn compared(program: &Path, model: &Path) -> Result<Vec<Figure>, String> {
    let folder = std::env::temp_dir().join(format!("mbint-bytes-{}", std::process::id()));
    let run = |arguments: &[&str], tunables: Option<&str>| -> Result<BTreeMap<PathBuf, Vec<u8>>, String> {
        // Files of the previous run.
        let _ = std::fs::remove_dir_all(&folder);
        let mut command = Command::new(program);
        command
            .arg("run")
            .arg(model)
            .args(["--quiet", "--yes", "--no-report", "--output"])
            .arg(&folder)
            .args(arguments);
        command.envs(tunables.map(|tunables| ("GLIBC_TUNABLES", tunables)));
        let output = command.output().map_err(|error| error.to_string())?;
        // Unresolved rows, and violated requirements, are results too.
        match output.status.code() {
            Some(0 | 3 | 4) => Ok(contents(&folder)),
            _ => Err(format!("{}: {}", output.status, String::from_utf8_lossy(&output.stderr).trim())),
        }
    };
    let first = run(&[], None)?;
    let mut figures = vec![Figure::number("files", first.len() as f64, Some(1.0), None)];
    for (name, arguments, tunables) in OTHERWISE {
        let other = run(arguments, tunables)?;
        let differ = first.keys().chain(other.keys()).filter(|path| first.get(*path) != other.get(*path)).count();
        figures.push(Figure::number(&format!("differ, {name}"), differ as f64, None, Some(0.0)));
    }
    let _ = std::fs::remove_dir_all(&folder);
    Ok(figures)
}

/// All files below a folder, with their contents.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path())) {
            match std::fs::read(&path) {
                _ if path.is_dir() => folders.push(path),
                Ok(bytes) => drop(files.insert(path, bytes)),
                Err(_) => {}
            }
        }
    }
    files
}
