//! The arguments of `mbint design`.

use std::path::PathBuf;

use clap::Args;

use super::allocate::share;
use super::{Format, OneRunArgs, SetArgs};

#[derive(Debug, Args)]
#[command(after_help = DESIGN_HELP)]
pub(in crate::cli) struct DesignArgs {
    /// Model file with `design` and `objective`.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    /// Folder for the results [default: results/<model's name>].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Count this share of the production, such as `99.73%`, instead of every case.
    #[arg(long = "yield", value_name = "SHARE", value_parser = share)]
    pub share: Option<f64>,

    #[command(flatten)]
    pub set: SetArgs,

    #[command(flatten)]
    pub run: OneRunArgs,

    /// Text for people, or JSON, in SI.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,

    /// Run even if this takes more than 20000 simulations or about a minute.
    #[arg(short, long)]
    pub yes: bool,
}

const DESIGN_HELP: &str = "\
The model names free parameters with ranges of their nominal values, as `design: { rod: 0.2 to
0.3 m }`, and an `objective`: `{ least: OUTPUT }`, `{ most: OUTPUT }`, `margin` or `cost`. All
requirements are to hold, with the tolerances about each value; with `cost` these are chosen, too.
Writes design.csv (the optima, the model's own values, and the optimum without tolerances),
front.csv (cost against margin), design.json, design.yaml (the best values, for --with or a scene),
figures and design.html. The exit status is 4 where no values meet the requirements:
then the nearest ones are printed.";
