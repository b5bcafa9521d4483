//! The arguments of the command line.

mod allocate;
mod design;
mod explain;
mod export;
mod fit;
mod gradient;
mod sample;
mod shards;
mod shared;
mod studio;
mod sweep;
mod verify;

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

use super::status;
use crate::model::Override;
use crate::results::Method;
pub(super) use allocate::AllocateArgs;
pub(super) use design::DesignArgs;
pub(super) use explain::ExplainArgs;
pub(super) use export::{ExportArgs, UnitVersion};
pub(super) use fit::FitArgs;
pub(super) use gradient::GradientArgs;
pub(super) use sample::{FileFormat, PointArgs, SampleArgs};
pub(super) use shards::{MergeArgs, PlanArgs, ShardArgs, StatusArgs, SubmitArgs};
pub(super) use shared::{AskedArgs, OneRunArgs, RootArgs, SetArgs, Threads, overlaid};
pub(super) use studio::StudioArgs;
pub(super) use sweep::SweepArgs;
pub(super) use verify::{VerifyArgs, VerifyCertificateArgs};

/// Bounds of a mechanism's motion over time when its parameters are uncertain.
#[derive(Debug, Parser)]
#[command(name = "mbint", version, arg_required_else_help = true, after_help = status::help())]
pub(super) struct Cli {
    #[command(subcommand)]
    pub command: Command,

    /// When to use colours.
    #[arg(long, global = true, value_name = "WHEN", value_enum, default_value_t = Color::Auto)]
    color: Color,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Compute bounds of every output over time.
    Run(RunArgs),
    /// Bound reduced outputs for values of one or two parameters.
    Sweep(SweepArgs),
    /// Find the loosest, or cheapest, tolerances that meet all requirements.
    Allocate(AllocateArgs),
    /// Find the nominal values that are best with the tolerances about them.
    Design(DesignArgs),
    /// Differentiate every output by every uncertain parameter, over time.
    Gradient(GradientArgs),
    /// Find the parameters that agree with measured values.
    Fit(FitArgs),
    /// Verify that a model integrates with the order that theory predicts, against its own manufactured motions.
    Verify(VerifyArgs),
    /// Check again the proof of `mbint run --certify`, from its file.
    VerifyCertificate(VerifyCertificateArgs),
    /// Check models: errors with their locations, coordinates, constraints, degrees of freedom.
    Check(CheckArgs),
    /// Make report.html again from a folder of results.
    Report(ReportArgs),
    /// Draw the assembled mechanism at its start, and print the positions of its bodies and points.
    Show(ShowArgs),
    /// Compare error and computing time of methods, orders and step sizes.
    Cost(CostArgs),
    /// Record bounds as small text files next to the models, or compare with the record.
    Snapshot(SnapshotArgs),
    /// Explain the compiled and omitted parts of a model, or list what the language offers.
    Explain(ExplainArgs),
    /// Simulate at chosen points: outputs over time, for other programs.
    Sample(SampleArgs),
    /// Write a model's nominal motion as source code.
    Export(ExportArgs),
    /// Divide the work that models need into shards, for many machines.
    Plan(PlanArgs),
    /// Simulate a shard of a plan; existing parts are skipped.
    Shard(ShardArgs),
    /// Print the missing shards of a plan.
    Status(StatusArgs),
    /// Make the results of a plan from its shards: the same files that `mbint run` writes.
    Merge(MergeArgs),
    /// Submit the shards of a plan, and its merging, to a cluster.
    Submit(SubmitArgs),
    /// Print the JSON Schema of model files, for editors.
    Schema,
    /// Serve an editor: a language server of model files on standard input and output.
    Lsp(LspArgs),
    /// Serve a local page: the model's text, its mechanism, and its bounds as they are computed.
    Studio(StudioArgs),
    /// Write a small, commented model as a starting point.
    New(NewArgs),
    /// Print a completion script for a shell.
    Completions(CompletionsArgs),
    /// Print a manual page, or write all of them.
    Man(ManArgs),
    /// Answer points by a unit of FMI in an unpacked folder: a process that a run starts.
    #[command(hide = true)]
    AnswerFmu(AnswerFmuArgs),
}

#[derive(Debug, Args)]
pub(super) struct LspArgs {
    #[command(flatten)]
    pub root: RootArgs,

    /// Option passed by editors that know several ways to talk to a server; this is the only one here.
    #[arg(long, hide = true)]
    pub stdio: bool,
}

#[derive(Debug, Args)]
pub(super) struct AnswerFmuArgs {
    /// Folder of the unit.
    pub folder: PathBuf,
}

#[derive(Debug, Args)]
#[command(after_help = RUN_HELP)]
pub(super) struct RunArgs {
    /// Model files; `-` is standard input.
    #[arg(required = true, value_name = "MODEL")]
    pub models: Vec<PathBuf>,

    #[command(flatten)]
    pub asked: AskedArgs,

    /// Folder for the results; with several models, a folder for each in it [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    #[command(flatten)]
    pub threads: Threads,

    /// Replace excitations by the functions in this file, and parameters by its values: a witness.NAME.csv of a run.
    #[arg(long, value_name = "FILE")]
    pub witness: Option<PathBuf>,

    /// Print nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,

    /// Write computing times into summary.json, which then differs from run to run.
    #[arg(long)]
    pub timings: bool,

    /// Print the duration of each stage, by model and subsystem, and write it into this file as a trace for Perfetto or
    /// chrome://tracing.
    #[arg(long, value_name = "FILE", conflicts_with = "watch")]
    pub profile: Option<PathBuf>,

    /// Run even if this takes more than 20000 simulations or about a minute.
    #[arg(short, long)]
    pub yes: bool,

    /// Write no report.html and no motion.json.
    #[arg(long)]
    pub no_report: bool,

    /// Also write the verdicts of all requirements into this file, as JUnit XML for CI.
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,

    /// Let an interrupted run replace the results of a complete one [default: it writes into a folder next to them].
    #[arg(long)]
    pub overwrite: bool,

    /// Text for people, or one JSON array with an object, including its summary, for each model and scene; all other
    /// output goes to standard error.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,

    /// Run again whenever a model, its URDF or its tables change, and print which bounds moved; Ctrl-C ends it.
    #[arg(short, long, conflicts_with = "format")]
    pub watch: bool,

    /// Store all simulations in this folder, and reuse those that are there: an interrupted run continues.
    #[arg(long, value_name = "DIR")]
    pub store: Option<PathBuf>,
}

const RUN_HELP: &str = "\
Writes bounds.csv (columns: t; NAME.nominal, NAME.chebyshev.lower, .upper, .error, … of each
output; the unreliable bounds of the row), summary.json, and a plot NAME.svg of each output.
Each scene of a model has a folder of its own; next to them are scenes.csv and a plot of each
output with all scenes. report.html shows all of it, and the mechanism moving.";

#[derive(Debug, Args)]
pub(super) struct ReportArgs {
    /// Folder of a model's results, or of its scenes'.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

#[derive(Debug, Args)]
#[command(after_help = COST_HELP)]
pub(super) struct CostArgs {
    /// Model file; `-` is standard input.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    /// Folder for the results [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Wanted error, relative to the largest width of an output's bounds [default: 1e-3].
    #[arg(short, long, value_name = "SHARE", value_parser = positive)]
    pub tolerance: Option<f64>,

    /// Approximate computing time in seconds; settings that take longer are omitted.
    #[arg(short, long, value_name = "SECONDS", value_parser = positive, default_value_t = 60.0)]
    pub budget: f64,

    #[command(flatten)]
    pub set: SetArgs,

    #[command(flatten)]
    pub run: OneRunArgs,
}

const COST_HELP: &str = "\
Runs the model with many methods, orders and step sizes, and compares their bounds with a
reference that it computes first. Writes cost.csv (one row per setting) and cost.svg; both
contain computing times, and so differ from run to run.";

#[derive(Debug, Args)]
#[command(after_help = SNAPSHOT_HELP)]
pub(super) struct SnapshotArgs {
    /// Model files.
    #[arg(required = true, value_name = "MODEL")]
    pub models: Vec<PathBuf>,

    /// Compare with the record, and write nothing; the exit status is 4 if a bound has moved.
    #[arg(long)]
    pub check: bool,

    /// Folder of the snapshots [default: that of each model].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// This scene only; may be given several times [default: all scenes].
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub scene: Vec<String>,

    #[command(flatten)]
    pub set: SetArgs,

    #[command(flatten)]
    pub threads: Threads,

    /// Print nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,

    /// Run even if this takes more than 20000 simulations or about a minute.
    #[arg(short, long)]
    pub yes: bool,
}

const SNAPSHOT_HELP: &str = "\
Writes NAME.snap for each model, and NAME.SCENE.snap for each scene: the bounds of every output
at ten times, with their errors. A bound has moved if it is further from the record than
both stated errors together, or if its error has more than doubled.";

#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    /// Model files; `-` is standard input.
    #[arg(required = true, value_name = "MODEL")]
    pub models: Vec<PathBuf>,

    #[command(flatten)]
    pub set: SetArgs,

    /// Text for people, or a JSON array with one object per model.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

#[derive(Debug, Args)]
#[command(after_help = SHOW_HELP)]
pub(super) struct ShowArgs {
    /// Model file.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    /// Folder for the picture [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    #[command(flatten)]
    pub set: SetArgs,

    /// Show this scene of the model.
    #[arg(long, value_name = "NAME")]
    pub scene: Option<String>,

    /// A table for people, or JSON.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

const SHOW_HELP: &str = "\
Writes mechanism.svg: a mechanism of the plane in its true shape, one of space from three
quarters and along the three axes. Uncertain lengths of bodies have their tolerances beside them.";

#[derive(Debug, Args)]
pub(super) struct NewArgs {
    /// The model's name, optionally with folders before it, which are created; writes NAME.yaml and never overwrites a
    /// file.
    #[arg(value_name = "NAME")]
    pub name: PathBuf,
}

#[derive(Debug, Args)]
pub(super) struct ManArgs {
    /// The page of this command, for example `mbint man run | man -l -` [default: that of mbint].
    #[arg(value_name = "COMMAND", conflicts_with = "output")]
    pub command: Option<String>,

    /// Write the pages of all commands into this folder: mbint.1, mbint-run.1, …
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(super) struct CompletionsArgs {
    /// The shell.
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    Text,
    Json,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Color {
    Auto,
    Always,
    Never,
}

impl Color {
    /// The same choice for clap.
    pub fn clap(self) -> clap::ColorChoice {
        match self {
            Self::Auto => clap::ColorChoice::Auto,
            Self::Always => clap::ColorChoice::Always,
            Self::Never => clap::ColorChoice::Never,
        }
    }

    /// The same choice for streams.
    pub fn stream(self) -> anstream::ColorChoice {
        match self {
            Self::Auto => anstream::ColorChoice::Auto,
            Self::Always => anstream::ColorChoice::Always,
            Self::Never => anstream::ColorChoice::Never,
        }
    }
}

/// Parser of methods, given by their names.
pub(super) fn methods() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(Method::ALL.map(Method::name))
        .try_map(|name| Method::ALL.into_iter().find(|method| method.name() == name).ok_or("no such method"))
}

fn positive(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|error| format!("{error}"))?;
    if number > 0.0 && number.is_finite() { Ok(number) } else { Err("it must be positive".to_owned()) }
}

fn parse_override(text: &str) -> Result<Override, String> {
    Override::parse(text).map_err(|wrong| {
        let messages = wrong.records().into_iter().map(|record| match record.help {
            Some(help) => format!("{}; {help}", record.message),
            None => record.message,
        });
        messages.collect::<Vec<_>>().join("; ")
    })
}
