//! `cargo xtask verification`: measures the claims of the verification report, and writes its pages.
//!
//! - `--quick` omits all that takes longer than seconds;
//! - `--dev` measures a build with debug assertions instead of a release;
//! - `--draws N` of the falsifier (5000);
//! - `--into FOLDER` instead of `docs/verification`;
//! - `--only CLAIM,…` measures some claims, and leaves FOLDER's other measurements unchanged;
//! - `--pages` measures nothing, and writes the pages of FOLDER's `measured.json` again.
//!
//! The exit status is 1 if a claim fails, 2 if nothing could be measured.

mod claims;
mod interval;
mod pages;
mod peers;
mod record;
mod run_program;
mod run_tests;
mod verdict;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use crate::machine;
use claims::{CLAIMS, Claim, FALSIFIER, Source, When};
use record::{Case, Circumstances, Record, Run, Section};
use run_tests::Built;
use verdict::Verdict;

/// File of measurements, in the folder of the pages.
const MEASURED: &str = "measured.json";

/// Draws of the falsifier in a whole run.
const DRAWS: u64 = 5000;

#[derive(Debug, PartialEq)]
struct Options {
    quick: bool,
    release: bool,
    draws: u64,
    into: PathBuf,
    /// Names of claims; all claims if empty.
    only: Vec<String>,
    pages_only: bool,
}

impl Options {
    fn read(mut arguments: impl Iterator<Item = String>) -> Result<Self, String> {
        let into = PathBuf::from("docs/verification");
        let mut options = Self { quick: false, release: true, draws: DRAWS, into, only: Vec::new(), pages_only: false };
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
            match argument.as_str() {
                "--quick" => options.quick = true,
                "--dev" => options.release = false,
                "--draws" => options.draws = value()?.parse().map_err(|error| format!("--draws: {error}"))?,
                "--into" => options.into = PathBuf::from(value()?),
                "--only" => options.only = claims_named(&value()?)?,
                "--pages" => options.pages_only = true,
                _ => {
                    let known = "--quick, --dev, --draws N, --into FOLDER, --only CLAIM,…, --pages";
                    return Err(format!("{argument} is none of {known}"));
                }
            }
        }
        Ok(options)
    }

    /// The command with these options, as far as they affect measurements.
    fn command(&self) -> String {
        let options = [self.quick.then_some(" --quick"), (!self.release).then_some(" --dev")];
        let draws = if self.quick { String::new() } else { format!(" --draws {}", self.draws) };
        let only = if self.only.is_empty() { String::new() } else { format!(" --only {}", self.only.join(",")) };
        format!("cargo xtask verification{}{draws}{only}", options.into_iter().flatten().collect::<String>())
    }

    fn measures(&self, claim: &Claim) -> bool {
        self.only.is_empty() || self.only.iter().any(|name| name == claim.name)
    }
}

/// Names of claims, separated by commas.
fn claims_named(text: &str) -> Result<Vec<String>, String> {
    let known: Vec<&str> = CLAIMS.iter().map(|claim| claim.name).collect();
    let of = |name: &str| match known.contains(&name) {
        true => Ok(name.to_owned()),
        false => Err(format!("--only: {name} is none of {}", known.join(", "))),
    };
    text.split(',').map(of).collect()
}

pub fn run(root: &Path, arguments: impl Iterator<Item = String>) -> ExitCode {
    let written = Options::read(arguments).and_then(|options| {
        let folder = root.join(&options.into);
        let before = || read(&folder.join(MEASURED));
        let record = match () {
            () if options.pages_only => before()?,
            () if options.only.is_empty() => measure(root, &options)?,
            () => before()?.with(measure(root, &options)?),
        };
        write(&folder, &record)?;
        Ok(record)
    });
    match written {
        Ok(record) => conclude(&record),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Prints the verdicts; a claim that fails is the command's failure.
fn conclude(record: &Record) -> ExitCode {
    let mut status = ExitCode::SUCCESS;
    for (index, claim) in CLAIMS.iter().enumerate() {
        let verdict = pages::verdict(record, claim);
        println!("{:3}  {:12} {}", index + 1, verdict.name().trim_matches('*'), claim.title);
        if verdict == Verdict::Fails {
            status = ExitCode::FAILURE;
        }
    }
    status
}

fn read(path: &Path) -> Result<Record, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    serde_json::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))
}

fn write(folder: &Path, record: &Record) -> Result<(), String> {
    let measured = serde_json::to_string_pretty(record).map_err(|error| error.to_string())? + "\n";
    let pages = pages::all(record).into_iter().chain([(MEASURED.to_owned(), measured)]);
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for (name, text) in pages {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}

fn measure(root: &Path, options: &Options) -> Result<Record, String> {
    // The commit before files change.
    let mut record = Record { on: circumstances(root, options), sections: Vec::new() };
    let built = Built::new(root, options.release)?;
    let mut all = Vec::new();
    for claim in CLAIMS.iter().filter(|claim| options.measures(claim)) {
        let begun = Instant::now();
        let (runs, cases) = measure_claim(root, &built, claim, options);
        all.extend(cases);
        println!("{:5.0} s  {}", begun.elapsed().as_secs_f64(), claim.name);
        record.sections.push(Section { claim: claim.name.to_owned(), runs, ..Section::default() });
    }
    if options.measures(&CLAIMS[FALSIFIER]) {
        record.sections.push(Section { claim: pages::MISSES.to_owned(), ..Section::default() });
    }
    for case in all {
        match record.sections.iter_mut().find(|section| section.claim == case.claim) {
            Some(section) => section.cases.push(case),
            None => return Err(format!("{}: the claim {} is not known", case.case, case.claim)),
        }
    }
    Ok(record)
}

fn measure_claim(root: &Path, built: &Built, claim: &Claim, options: &Options) -> (Vec<Run>, Vec<Case>) {
    let (mut runs, mut cases) = (Vec::new(), Vec::new());
    let mut environment = vec![("INSTA_UPDATE", "no".to_owned()), ("PROPTEST_RNG_SEED", "2007".to_owned())];
    environment.push(("MBINT_FALSIFY_PATIENCE", "300".to_owned()));
    if !options.quick {
        environment.push(("MBINT_FALSIFY_DRAWS", options.draws.to_string()));
    }
    let reference = third_party(root);
    environment.extend(reference.iter().map(|folder| ("MBINT_REFERENCE", folder.display().to_string())));
    for source in claim.sources {
        let (run, measured) = match source {
            Source::Tests { when, .. } | Source::Modules { when, .. } if !when.is_of(options.quick) => continue,
            Source::Tests { binary, filter, when: When::WithReference } if reference.is_none() => {
                let left_out = Some("MBINT_REFERENCE names no folder of third-party results".to_owned());
                (
                    Run { command: format!("cargo test --test {binary} -- {filter}"), left_out, ..Run::default() },
                    Vec::new(),
                )
            }
            Source::Tests { binary, filter, .. } => built.run(root, binary, filter, &environment),
            Source::Modules { binary, filter, skipped, .. } => {
                built.run_modules(root, claim.name, binary, filter, skipped)
            }
            Source::VerifiedModels => run_program::verified_models(root, &built.program, claim.name, options.quick),
            Source::SameBytes => run_program::same_bytes(root, &built.program, claim.name, options.quick),
            Source::Peers => peers::peers(root, claim.name, options.quick),
        };
        runs.push(run);
        cases.extend(measured);
    }
    (runs, cases)
}

/// The folder of third-party results, if it exists.
fn third_party(root: &Path) -> Option<PathBuf> {
    let named = std::env::var_os("MBINT_REFERENCE").map(PathBuf::from);
    named.or_else(|| root.join("../shared/reference").canonicalize().ok()).filter(|folder| folder.is_dir())
}

fn circumstances(root: &Path, options: &Options) -> Circumstances {
    let profile = if options.release { "release" } else { "dev (optimised a little, with debug assertions)" };
    Circumstances {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: machine::commit(root),
        date: machine::date(root),
        profile: profile.to_owned(),
        compiler: machine::said(root, "rustc", &["--version"]),
        processor: machine::processor(),
        command: options.command(),
        quick: options.quick,
    }
}

#[cfg(test)]
mod tests;
