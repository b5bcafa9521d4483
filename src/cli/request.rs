//! The request to `mbint run`: its arguments, checked, and a job for each model or scene.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::Failure;
use super::args::{AskedArgs, RunArgs};
use super::kept_run::KeptRun;
use super::load::Given;
use super::profile::Profile;
use super::verdicts::Junit;
use crate::methods::Proof;
use crate::model::{Description, Witness, shown};
use crate::results::{Method, ModelFile, RunRequest};
use crate::store::Missing;

/// The arguments of a run, checked.
pub(super) struct Request {
    pub models: Vec<PathBuf>,
    /// Paths of the same models in results.
    pub named: Vec<PathBuf>,
    pub given: Given,
    /// Path in results of the file of functions of the time.
    pub witness: Option<String>,
    /// Empty for all scenes.
    pub scenes: Vec<String>,
    /// Claim of certified bounds, if they are requested.
    pub certify: Option<Proof>,
    pub output: Option<PathBuf>,
    /// Whether no overview is printed.
    pub quiet: bool,
    /// Whether a report is written.
    pub report: bool,
    /// File for verdicts, if requested.
    pub junit: Option<Junit>,
    /// Whether computing times are written.
    pub timings: bool,
    pub overwrite: bool,
    pub settings: Settings,
    /// Store of simulations, if requested.
    pub store: Option<KeptRun>,
}

/// Settings of a model's run.
#[derive(Default)]
pub(super) struct Settings {
    /// `None` for the model's own methods.
    pub methods: Option<Vec<Method>>,
    pub threads: Option<usize>,
    /// Whether long runs are allowed.
    pub yes: bool,
    pub certify_time: bool,
    pub skip_infeasible: bool,
    /// Whether derivatives at the nominal parameters are found, for a report.
    pub derivatives: bool,
    /// Whether no progress is shown.
    pub quiet: bool,
    /// Recorder of the stages' times, if requested.
    pub profile: Option<Profile>,
}

/// A model, or a scene of it, with the folder for its results.
pub(super) struct Job {
    pub model: Description,
    /// The model's file.
    pub path: PathBuf,
    pub folder: PathBuf,
    /// The files that the model was read from.
    pub files: Vec<ModelFile>,
    /// Their names and texts.
    pub texts: Rc<[(String, String)]>,
    /// The folder of the model's file.
    pub beside: PathBuf,
    /// Jobs that share a report.
    pub share: usize,
    /// Whether the report is next to the results, and not that of all scenes.
    pub page: bool,
    /// Index of the model among those of the command.
    pub number: usize,
    /// Name of its scene, if it has scenes.
    pub scene: Option<String>,
}

impl Request {
    pub fn check(args: RunArgs) -> Result<Self, Failure> {
        let AskedArgs { method: methods, certify, set, scene: scenes, skip_infeasible, certify_time } =
            args.asked.in_order();
        let witness = args.witness.as_deref().map(read_witness).transpose()?;
        Ok(Self {
            witness: args.witness.as_deref().map(|path| shown(path).to_string()),
            named: args.models.clone(),
            models: args.models,
            given: Given { witness, ..set.given()? },
            scenes,
            certify,
            output: args.output,
            quiet: args.quiet,
            report: !args.no_report,
            junit: args.junit.map(Junit::new),
            timings: args.timings,
            overwrite: args.overwrite,
            store: args.store.map(|folder| KeptRun::new(folder, Missing::Simulate)),
            settings: Settings {
                methods: if methods.is_empty() { None } else { Some(methods) },
                threads: args.threads.number(),
                yes: args.yes,
                certify_time,
                skip_infeasible,
                derivatives: !args.no_report,
                quiet: args.quiet,
                profile: args.profile.map(Profile::new).transpose()?,
            },
        })
    }

    /// Everything that determines the results.
    pub fn asked(&self) -> RunRequest {
        let methods = self.settings.methods.as_ref();
        RunRequest {
            set: self.given.overrides.iter().map(|setting| setting.text.clone()).collect(),
            methods: methods.map(|methods| methods.iter().map(|method| method.name().to_owned()).collect()),
            witness: self.witness.clone(),
            certify: self.certify.is_some(),
            certify_scheme: self.certify == Some(Proof::Scheme),
            certify_time: self.settings.certify_time,
            skip_infeasible: self.settings.skip_infeasible,
        }
    }
}

/// Reads functions of the time.
///
/// # Errors
/// If the file cannot be read, or is not a witness.
fn read_witness(path: &Path) -> Result<Witness, Failure> {
    let wrong = |why: String| Failure::wrong(format!("{}: {why}", shown(path)));
    let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
    Witness::parse(&text).map_err(|error| wrong(error.to_string()))
}
