//! The arguments of `mbint fit`.

use std::path::PathBuf;

use clap::Args;

use super::{Format, OneRunArgs, SetArgs};
use crate::applications::NoiseBound;

#[derive(Debug, Args)]
#[command(after_help = FIT_HELP)]
pub(in crate::cli) struct FitArgs {
    /// Model file.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    /// Table of measured values; `-` is standard input.
    #[arg(value_name = "DATA")]
    pub data: PathBuf,

    /// Folder for the results [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Noise bound of an output, such as `x3=0.1 mm`, if the table has no column for it; may be given several times.
    #[arg(long, value_name = "NAME=VALUE", value_parser = noise)]
    pub noise: Vec<NoiseBound>,

    #[command(flatten)]
    pub set: SetArgs,

    #[command(flatten)]
    pub run: OneRunArgs,

    /// Text for people, or JSON with all rows, in SI.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,

    /// Run even if this takes more than 20000 simulations or about a minute.
    #[arg(short, long)]
    pub yes: bool,
}

fn noise(text: &str) -> Result<NoiseBound, String> {
    let (output, value) = text.split_once('=').ok_or("it is `NAME=VALUE`, as `x3=0.1 mm`")?;
    Ok(NoiseBound { output: output.trim().to_owned(), value: value.trim().to_owned() })
}

const FIT_HELP: &str = "\
The table has a heading: `time`, names of outputs, perhaps with units as `x3 [mm]`, and perhaps
columns `x3_noise` with bounds of the noise. Finds the least-squares estimate, and all parameters
within the model's intervals with which every value is within its noise. Writes fit.csv (a row for
each value), fit.json, fit.yaml (the consistent intervals, for --with or a scene), figures and
fit.html. The exit status is 4 where no parameters agree with all rows.";
