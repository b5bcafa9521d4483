//! The arguments of `mbint gradient`.

use std::path::PathBuf;

use clap::Args;

use super::{Format, OneRunArgs, SetArgs};

#[derive(Debug, Args)]
#[command(after_help = GRADIENT_HELP)]
pub(in crate::cli) struct GradientArgs {
    /// Model file; `-` is standard input.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    /// Folder for the results [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Print and draw the derivatives in the row nearest to this time, s [default: for each output, the row in which
    /// the parameters move it the most].
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub at: Option<f64>,

    #[command(flatten)]
    pub set: SetArgs,

    #[command(flatten)]
    pub run: OneRunArgs,

    /// Text for people, or JSON with the derivatives in all rows, in SI.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

fn seconds(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|seconds| seconds.is_finite() && *seconds >= 0.0);
    number.ok_or_else(|| "it is a time in seconds, from 0 on".to_owned())
}

const GRADIENT_HELP: &str = "\
Follows the motion backwards: a gradient costs a few simulations, for any number of parameters.
Derivatives are taken with all parameters at their nominal values, and are signed. Writes
gradients.csv (columns: t; NAME, NAME.PARAMETER, … of each output, in SI) and a tornado plot
NAME.gradients.svg of each output: derivatives times half of the parameters' intervals.";
