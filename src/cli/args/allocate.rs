//! The arguments of `mbint allocate`.

use std::path::PathBuf;

use clap::Args;

use super::{OneRunArgs, SetArgs};
use crate::cli::tuning::TUNING;

#[derive(Debug, Args)]
#[command(after_help = ALLOCATE_HELP)]
pub(in crate::cli) struct AllocateArgs {
    /// Model file.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    /// Folder for the results [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Meet all requirements for this share of the production, such as `99.73%`, instead of in every case.
    #[arg(long = "yield", value_name = "SHARE", value_parser = share)]
    pub share: Option<f64>,

    /// Loosen no tolerance to more than this multiple of the model's; grades have their own widths.
    #[arg(long, value_name = "TIMES", value_parser = at_least_one, default_value_t = 3.0)]
    pub widest: f64,

    #[command(flatten)]
    pub set: SetArgs,

    #[command(flatten)]
    pub run: OneRunArgs,

    /// Run even if this takes more than 20000 simulations or about a minute.
    #[arg(short, long)]
    pub yes: bool,
}

pub(super) fn share(text: &str) -> Result<f64, String> {
    let number = match text.trim().strip_suffix('%') {
        Some(percent) => percent.trim().parse::<f64>().map(|percent| percent / 100.0),
        None => text.trim().parse::<f64>(),
    };
    let wrong = "a yield is a share from 50% to 99.99999%, as `99.73%`; beyond, ask for every case";
    number.ok().filter(|share| (0.5..=TUNING.highest_yield + 1e-15).contains(share)).ok_or_else(|| wrong.to_owned())
}

fn at_least_one(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| (1.0..=1000.0).contains(number));
    number.ok_or_else(|| "it is a number from 1 to 1000".to_owned())
}

const ALLOCATE_HELP: &str = "\
Finds the cheapest tolerances that meet all requirements (`cost` of parameters), or the loosest by
one factor where no costs are given. Writes allocation.csv (tolerance, cost and share before and
after), allocation.yaml (the new tolerances, for --with or a scene) and allocation.svg (cost
against margin). The exit status is 4 where no tolerances meet the requirements.";
