//! The arguments of `mbint export`.

use std::path::PathBuf;

use clap::Args;

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

    /// As a unit of FMI 3.0 for co-simulation: sources, and a library for this platform where there is a C compiler.
    #[arg(long)]
    pub fmu: bool,
}

const EXPORT_HELP: &str = "\
Writes the compiled programs of the model's steps, the nominal start, and Newton's iteration, which repeat
the nominal motion of `mbint run`. Steps are fixed ones of HHT-I3: give `step`, and no `tolerance`.
Compile with: cc -std=c99 -O2 NAME.c NAME_main.c -lm";
