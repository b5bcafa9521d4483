//! The arguments of `mbint export`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::SetArgs;

#[derive(Debug, Args)]
#[command(after_help = EXPORT_HELP)]
pub(in crate::cli) struct ExportArgs {
    /// Model file; `-` is standard input.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    #[command(flatten)]
    pub formats: Formats,

    /// Export this scene of the model.
    #[arg(long, value_name = "NAME")]
    pub scene: Option<String>,

    /// Folder for the files [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// An uncertain parameter of forces that may change during the motion; repeatable.
    #[arg(long = "input", value_name = "NAME")]
    pub inputs: Vec<String>,

    #[command(flatten)]
    pub set: SetArgs,
}

/// Forms of the export.
#[derive(Debug, Args)]
#[group(required = true, multiple = true)]
pub(in crate::cli) struct Formats {
    /// As C99 without dependencies: a header, the model, and an example that writes its outputs as a table.
    #[arg(long)]
    pub c: bool,

    /// As a unit of FMI for co-simulation: sources, and a library for this platform if there is a C compiler.
    #[arg(long, value_name = "VERSION", value_enum, num_args = 0..=1, require_equals = true, default_missing_value = "3.0")]
    pub fmu: Option<UnitVersion>,
}

/// Versions of FMI.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum UnitVersion {
    #[value(name = "2.0")]
    Two,
    #[value(name = "3.0")]
    Three,
}

const EXPORT_HELP: &str = "\
Writes the compiled programs of the model's steps, the nominal start, and what integrates them, which repeat
the nominal motion of `mbint sample`: with fixed steps, steps by a tolerance, extrapolated or explicit ones.
Compile with: cc -std=c99 -O2 NAME.c NAME_main.c -lm";
