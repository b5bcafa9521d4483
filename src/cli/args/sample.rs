//! The arguments of `mbint sample`, and of other commands with samples.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{OneRunArgs, SetArgs};

#[derive(Debug, Args)]
#[command(after_help = SAMPLE_HELP)]
pub(in crate::cli) struct SampleArgs {
    /// Model file.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    #[command(flatten)]
    pub points: PointArgs,

    /// File of the samples, `-` for standard output [default: samples.npz, or samples.csv].
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,

    /// Arrays of NumPy, or a table [default: by the file's name].
    #[arg(long, value_enum)]
    pub format: Option<FileFormat>,

    #[command(flatten)]
    pub set: SetArgs,

    #[command(flatten)]
    pub run: OneRunArgs,

    /// Store all simulations in this folder, and reuse those that are there.
    #[arg(long, value_name = "DIR")]
    pub store: Option<PathBuf>,
}

/// Points of the parameters at which samples are simulated.
#[derive(Clone, Debug, Default, Args)]
pub(in crate::cli) struct PointArgs {
    /// Simulate at the points of this table: a column for each parameter, in SI units, with its name as heading;
    /// parameters without a column are nominal. `-` is standard input.
    #[arg(long, value_name = "FILE", conflicts_with = "design")]
    pub points: Option<PathBuf>,

    /// Simulate at points spread evenly over the tolerances: `sobol:1000` or `lhs:1000` (a Latin hypercube).
    #[arg(long, value_name = "DESIGN:COUNT")]
    pub design: Option<String>,

    /// Seed of the Latin hypercube; each gives another one.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum FileFormat {
    Npz,
    Csv,
}

const SAMPLE_HELP: &str = "\
Writes the outputs over time at every point: of samples.npz the arrays values (sample, time, output),
parameters (sample, parameter), times, output_names, output_units, parameter_names, parameter_units;
of samples.csv a row for each time of each sample. Where a sample cannot be assembled, or stops, there
is NaN. On many machines: mbint plan MODEL --design … -o study/, mbint shard, mbint merge -o samples.npz.";
