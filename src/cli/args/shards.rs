//! Arguments of the commands for shards.

use std::path::PathBuf;

use clap::Args;

use super::{MOST_THREADS, SetArgs, methods};
use crate::results::Method;

#[derive(Debug, Args)]
#[command(after_help = PLAN_HELP)]
pub(in crate::cli) struct PlanArgs {
    /// Model files.
    #[arg(required = true, value_name = "MODEL")]
    pub models: Vec<PathBuf>,

    /// Folder for the study.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,

    /// Methods to run: chebyshev, taylor, scan, certified [default: the model's].
    #[arg(short, long, value_name = "METHOD", value_delimiter = ',')]
    #[arg(value_parser = methods(), hide_possible_values = true)]
    pub method: Vec<Method>,

    /// Add certified bounds.
    #[arg(long)]
    pub certify: bool,

    #[command(flatten)]
    pub set: SetArgs,

    /// Run this scene only; may be given several times [default: all scenes].
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub scene: Vec<String>,

    /// Exclude parameter values with which the mechanism cannot be assembled or does not reach the end.
    #[arg(long)]
    pub skip_infeasible: bool,

    /// Also simulate every sample with halved steps.
    #[arg(long)]
    pub certify_time: bool,

    /// Leave simulations to shards that take longer than this on one core; what takes less is done by `plan` and `merge`.
    #[arg(long, value_name = "SECONDS", value_parser = not_negative, default_value_t = 10.0)]
    pub at_once: f64,

    /// Number of threads [default: one per core].
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    pub threads: Option<u16>,
}

const PLAN_HELP: &str = "\
Writes plan.json and tasks into the study's folder. Then, on any machine that sees the folder and the
models, for every number K of a shard:

  mbint shard DIR --index K

and when all are done: mbint merge DIR -o results. It may ask for another round (exit code 75).";

#[derive(Debug, Args)]
pub(in crate::cli) struct ShardArgs {
    /// Folder of the study.
    #[arg(value_name = "DIR")]
    pub study: PathBuf,

    /// Number of the shard, from 0.
    #[arg(short, long, value_name = "K")]
    pub index: usize,

    /// Number of threads; results do not depend on it [default: one per core].
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    pub threads: Option<u16>,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct StatusArgs {
    /// Folder of the study.
    #[arg(value_name = "DIR")]
    pub study: PathBuf,

    /// Print nothing but the numbers of missing shards, as 3,7-9.
    #[arg(short, long)]
    pub missing: bool,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct MergeArgs {
    /// Folder of the study.
    #[arg(value_name = "DIR")]
    pub study: PathBuf,

    /// Folder for the results, as of `mbint run` [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Number of threads; results do not depend on it [default: one per core].
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    pub threads: Option<u16>,

    /// Print nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
}

#[derive(Debug, Args)]
#[command(after_help = SUBMIT_HELP)]
pub(in crate::cli) struct SubmitArgs {
    /// Folder of the study.
    #[arg(value_name = "DIR")]
    pub study: PathBuf,

    /// As a job array of Slurm.
    #[arg(long, required = true)]
    pub slurm: bool,

    /// Folder for the results, as of `mbint run` [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Options of sbatch, after `--`.
    #[arg(last = true, value_name = "OPTION")]
    pub options: Vec<String>,
}

const SUBMIT_HELP: &str = "\
Writes the scripts of this round into the study's folder and submits them: a job array of the shards that
are missing, and a job that merges and submits the next round where there is one. The folder, the models
and this program must be seen by all nodes. After a failure, submit again: what is there is skipped.";

fn not_negative(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|error| format!("{error}"))?;
    if number >= 0.0 { Ok(number) } else { Err("it must not be negative".to_owned()) }
}
