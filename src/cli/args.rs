//! What may stand on the command line.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

use crate::model::Override;
use crate::results::Method;

/// What a mechanism can do when its parameters are only known up to tolerances.
#[derive(Debug, Parser)]
#[command(name = "mbint", version, arg_required_else_help = true, after_help = EXIT_STATUS)]
pub(super) struct Cli {
    #[command(subcommand)]
    pub command: Command,

    /// When to use colours.
    #[arg(long, global = true, value_name = "WHEN", value_enum, default_value_t = Color::Auto)]
    pub color: Color,
}

const EXIT_STATUS: &str = "\
Exit status:
  0  done
  1  a run failed; what was finished is kept
  2  the command or a model is wrong; nothing was run
  3  done, but at some time no method resolves an output: the errors are too large
  130  interrupted by Ctrl-C; what was finished is kept, and a second Ctrl-C does not wait for it

Begin with `mbint new NAME`, which writes a small model to change.";

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Compute bounds of every output over time.
    Run(RunArgs),
    /// Read and assemble models, and count: coordinates, constraints, degrees of freedom.
    Check(CheckArgs),
    /// Tell what accuracy costs in time: error against seconds for methods, orders and steps.
    Cost(CostArgs),
    /// Tell what a model is compiled to, and what is left out.
    Explain(ExplainArgs),
    /// Print the JSON Schema of model files, for editors.
    Schema,
    /// Write a small, commented model to begin with.
    New(NewArgs),
    /// Print a completion script for a shell.
    Completions(CompletionsArgs),
}

#[derive(Debug, Args)]
#[command(after_help = RUN_HELP)]
pub(super) struct RunArgs {
    /// Model files.
    #[arg(required = true, value_name = "MODEL")]
    pub models: Vec<PathBuf>,

    /// Folder for the results; with several models, a folder for each in it [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// These methods instead of the model's: chebyshev, taylor, scan, certified [default: all that the model asks for].
    #[arg(short, long, value_name = "METHOD", value_delimiter = ',')]
    #[arg(value_parser = methods(), hide_possible_values = true)]
    pub method: Vec<Method>,

    /// Add certified bounds: proven for every parameter of the box, of the motion as the scheme's steps define it.
    #[arg(long)]
    pub certify: bool,

    /// Set a parameter, as `l1=0.16`, `l1=0.16±2%` or `l1=[0.15, 0.17]`; may be given several times.
    #[arg(short, long, value_name = "NAME=VALUE", value_parser = parse_override)]
    pub set: Vec<Override>,

    /// Only this scene of the models; may be given several times [default: all scenes].
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub scene: Vec<String>,

    /// Threads; results do not depend on it [default: one a core].
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    pub threads: Option<u16>,

    /// Leave out the part of the parameters' box in which the mechanism cannot be assembled, or does not move to the end,
    /// and say in each row how much is left.
    #[arg(long)]
    pub skip_infeasible: bool,

    /// Print nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,

    /// Simulate every sample with halved steps too, to know the time steps' error of every bound [default: a few].
    #[arg(long)]
    pub certify_time: bool,

    /// Write seconds into summary.json, which is then no longer the same from run to run.
    #[arg(long)]
    pub timings: bool,
}

/// More than any machine that mbint is run on has; beyond it, a slip of the keyboard.
const MOST_THREADS: i64 = 1024;

const RUN_HELP: &str = "\
Writes bounds.csv (a column t, then NAME.nominal, NAME.chebyshev.lower, .upper, .error, … of each
output, and which are unresolved),
summary.json, and a plot NAME.svg of each output. A model's scenes have a folder each; beside
them are scenes.csv and a plot of each output with all scenes in it.";

#[derive(Debug, Args)]
#[command(after_help = COST_HELP)]
pub(super) struct CostArgs {
    /// Model file.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    /// Folder for the results [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Error that is wanted, as a share of the widest that an output's bounds get [default: 1e-3].
    #[arg(short, long, value_name = "SHARE", value_parser = positive)]
    pub tolerance: Option<f64>,

    /// Seconds to spend, about; settings that take longer are left out.
    #[arg(short, long, value_name = "SECONDS", value_parser = positive, default_value_t = 60.0)]
    pub budget: f64,

    /// Set a parameter, as `l1=0.16`, `l1=0.16±2%` or `l1=[0.15, 0.17]`; may be given several times.
    #[arg(short, long, value_name = "NAME=VALUE", value_parser = parse_override)]
    pub set: Vec<Override>,

    /// A scene of the model, instead of the model itself.
    #[arg(long, value_name = "NAME")]
    pub scene: Option<String>,

    /// Threads [default: one a core].
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    pub threads: Option<u16>,

    /// Print nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
}

const COST_HELP: &str = "\
Runs the model with many methods, orders and steps, and compares their bounds with those of a
reference that it computes itself. Writes cost.csv (a row a setting) and cost.svg; both hold
seconds, and so differ from run to run.";

#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    /// Model files.
    #[arg(required = true, value_name = "MODEL")]
    pub models: Vec<PathBuf>,

    /// Text for people, or a JSON array with an object a model.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

#[derive(Debug, Args)]
pub(super) struct ExplainArgs {
    /// Model file.
    #[arg(value_name = "MODEL", required_unless_present_any = ["effects", "joints", "methods"])]
    pub model: Option<PathBuf>,

    /// A scene of the model, instead of the model itself.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["effects", "joints", "methods"])]
    pub scene: Option<String>,

    /// Instead of a model: every effect that there is, with its keys, units, formula and source.
    #[arg(long, conflicts_with = "model")]
    pub effects: bool,

    /// Instead of a model: every joint that there is, with its keys, units, equations and the signs of its reaction.
    #[arg(long, conflicts_with_all = ["model", "effects"])]
    pub joints: bool,

    /// Instead of a model: every bounding method that there is, with its keys and source.
    #[arg(long, conflicts_with_all = ["model", "effects", "joints"])]
    pub methods: bool,

    /// Text for people, or a JSON object.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

#[derive(Debug, Args)]
pub(super) struct NewArgs {
    /// The model's name, perhaps with a folder before it; NAME.yaml is written, never over another file.
    #[arg(value_name = "NAME")]
    pub name: PathBuf,
}

#[derive(Debug, Args)]
pub(super) struct CompletionsArgs {
    /// Which shell.
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

/// Methods by the names that they have everywhere.
fn methods() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(Method::ALL.map(Method::name))
        .try_map(|name| Method::ALL.into_iter().find(|method| method.name() == name).ok_or("no such method"))
}

fn positive(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|error| format!("{error}"))?;
    if number > 0.0 && number.is_finite() { Ok(number) } else { Err("it must be positive".to_owned()) }
}

fn parse_override(text: &str) -> Result<Override, String> {
    Override::parse(text).map_err(|wrong| {
        let told = wrong.records().into_iter().map(|record| match record.help {
            Some(help) => format!("{}; {help}", record.message),
            None => record.message,
        });
        told.collect::<Vec<_>>().join("; ")
    })
}
