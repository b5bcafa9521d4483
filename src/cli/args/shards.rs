//! Arguments of the commands for shards.

use std::path::PathBuf;

use clap::Args;

use super::{AskedArgs, PointArgs, Threads};

#[derive(Debug, Args)]
#[command(after_help = PLAN_HELP)]
pub(in crate::cli) struct PlanArgs {
    /// Model files.
    #[arg(required = true, value_name = "MODEL")]
    pub models: Vec<PathBuf>,

    #[command(flatten)]
    pub asked: AskedArgs,

    #[command(flatten)]
    pub points: PointArgs,

    /// Folder for the study.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,

    /// Leave simulations that take longer than this on one core to shards; `plan` and `merge` do the others.
    #[arg(long, value_name = "SECONDS", value_parser = not_negative, default_value_t = 10.0)]
    pub at_once: f64,

    /// Join parts to shards that take at most this on one core.
    #[arg(long, value_name = "SECONDS", value_parser = not_negative, default_value_t = 60.0)]
    pub shard_seconds: f64,

    #[command(flatten)]
    pub threads: Threads,
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

    #[command(flatten)]
    pub threads: Threads,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct StatusArgs {
    /// Folder of the study.
    #[arg(value_name = "DIR")]
    pub study: PathBuf,

    /// Print only the numbers of missing shards, such as 3,7-9.
    #[arg(short, long)]
    pub missing: bool,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct MergeArgs {
    /// Folder of the study.
    #[arg(value_name = "DIR")]
    pub study: PathBuf,

    /// Folder for the results, as for `mbint run` [default: results/<model's name>]; for samples their file.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    #[command(flatten)]
    pub threads: Threads,

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

    /// Folder for the results, as for `mbint run` [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Options of sbatch, after `--`.
    #[arg(last = true, value_name = "OPTION")]
    pub options: Vec<String>,
}

const SUBMIT_HELP: &str = "\
Writes the scripts of this round into the study's folder and submits them: a job array of the shards that
are missing, and a job that merges and submits the next round where there is one. The folder, the models
and this program must be seen by all nodes. After a failure, submit again: existing parts are skipped.";

fn not_negative(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|error| format!("{error}"))?;
    if number >= 0.0 { Ok(number) } else { Err("it must not be negative".to_owned()) }
}
