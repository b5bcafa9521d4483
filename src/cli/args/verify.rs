//! The arguments of `mbint verify` and `mbint verify-certificate`.

use std::path::PathBuf;

use clap::Args;

use super::{Format, OneRunArgs, SetArgs, Threads};

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

    /// Also write each order, derivative and balance into this file, as JUnit XML for CI.
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,

    /// Also write all results into this file, as a page for people.
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
}

const VERIFY_HELP: &str = "\
Makes a smooth motion of this mechanism on its constraints, adds the loads with which that fulfils
the equations of motion, and integrates: the errors against the known motion have to fall with the
steps at the order of theory, for positions, velocities, accelerations, states and reactions, by
HHT-I3, extrapolated and explicitly, in all coordinates that the model has. Derivatives of all its
programs are compared with differences of 32 digits, and powers balanced. Where equations switch, a
part of the run before and one behind are verified. The exit status is 4 where something is wrong.";

#[derive(Debug, Args)]
#[command(after_help = CERTIFICATE_HELP)]
pub(in crate::cli) struct VerifyCertificateArgs {
    /// certificate.jsonl of a run.
    #[arg(value_name = "FILE")]
    pub certificate: PathBuf,

    /// The model: its files and its equations are compared with those of the certificate.
    #[arg(value_name = "MODEL")]
    pub model: Option<PathBuf>,

    /// The scene of the model [default: that of the certificate].
    #[arg(long, value_name = "NAME")]
    pub scene: Option<String>,

    #[command(flatten)]
    pub set: SetArgs,

    #[command(flatten)]
    pub threads: Threads,

    /// Print nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,

    /// Text for people, or JSON.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

const CERTIFICATE_HELP: &str = "\
Trusts nothing of the file but its equations: a start is proven, the accelerations that are given
are integrated, and no motion can leave the tube about them; the bounds of all rows follow, and the
pieces cover the box. Settings of parameters are those of the run. The exit status is 4 where
something does not follow.";
