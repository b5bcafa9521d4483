//! The arguments of `mbint sweep`.

use std::path::PathBuf;

use clap::Args;

use super::{OneRunArgs, RootArgs};

#[derive(Debug, Args)]
#[command(after_help = SWEEP_HELP)]
pub(in crate::cli) struct SweepArgs {
    /// Model file.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    /// Folder for the results [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Sweep a parameter, such as `l1=0.1..0.2:11`, `l1=100..200:11 mm` or `l1=0.1..0.2:11 ± 1%`, or set one, such as
    /// `l2=0.3`; one or two may be swept.
    #[arg(short, long, value_name = "NAME=FROM..TO:VALUES", required = true)]
    pub set: Vec<String>,

    /// Set the parameters of this YAML file, as written by `mbint allocate`; swept and set values take precedence.
    #[arg(long, value_name = "FILE")]
    pub with: Vec<PathBuf>,

    #[command(flatten)]
    pub files: RootArgs,

    #[command(flatten)]
    pub run: OneRunArgs,

    /// Run even if one value takes more than 20000 simulations or about a minute.
    #[arg(short, long)]
    pub yes: bool,
}

const SWEEP_HELP: &str = "\
Runs the model for each value, and writes sweep.csv (a row for each value: bounds of every reduced
output, margin and verdict of every requirement) and a plot sweep.NAME.svg of each reduced output.";
