//! The arguments of `mbint verify`.

use std::path::PathBuf;

use clap::Args;

use super::{Format, OneRunArgs, SetArgs};

#[derive(Debug, Args)]
#[command(after_help = VERIFY_HELP)]
pub(in crate::cli) struct VerifyArgs {
    /// Model file; `-` is standard input.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    #[command(flatten)]
    pub set: SetArgs,

    #[command(flatten)]
    pub run: OneRunArgs,

    /// Text for people, or JSON with all errors.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,

    /// Also write each order and balance into this file, as JUnit XML for CI.
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
}

const VERIFY_HELP: &str = "\
Makes a smooth motion of this mechanism on its constraints, adds the loads with which that fulfils
the equations of motion, and integrates: the errors against the known motion have to fall with the
steps at the order of theory, for positions, velocities, accelerations, states and reactions, by
HHT-I3, extrapolated and explicitly, in all coordinates that the model has. The exit status is 4
where something does not.";
