//! Arguments of `mbint explain`.

use std::path::PathBuf;

use clap::Args;

use super::{Format, SetArgs};
use crate::cli::listing::Listing;

#[derive(Debug, Args)]
pub(in crate::cli) struct ExplainArgs {
    /// Model file; `-` is standard input. Or the code of a message, such as `E0401`, to print its page.
    #[arg(value_name = "MODEL", required_unless_present = "list")]
    pub model: Option<PathBuf>,

    #[command(flatten)]
    pub set: SetArgs,

    /// Use this scene of the model.
    #[arg(long, value_name = "NAME", conflicts_with = "list")]
    pub scene: Option<String>,

    #[command(flatten)]
    pub list: ListArgs,

    /// Text for people, or JSON.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,

    /// Print a list as a page of the book.
    #[arg(long, hide = true, requires = "list", conflicts_with_all = ["format", "effects", "joints", "methods"])]
    pub page: bool,
}

/// Lists, instead of the explanation of a model.
#[derive(Debug, Args)]
#[group(id = "list", multiple = false, conflicts_with = "model")]
pub(in crate::cli) struct ListArgs {
    /// List every effect with its keys, units, equation and source.
    #[arg(long)]
    pub effects: bool,

    /// List every joint with its keys, units, equations and the signs of its reaction.
    #[arg(long)]
    pub joints: bool,

    /// List every bounding method with its keys and source.
    #[arg(long)]
    pub methods: bool,

    /// List every unit with its value in SI units.
    #[arg(long)]
    units: bool,

    /// List every function of formulas with its domain.
    #[arg(long)]
    functions: bool,

    /// List every output of bodies, joints and effects with unit, sign and frame.
    #[arg(long)]
    outputs: bool,

    /// List the limits, defaults and thresholds of the program with their reasons.
    #[arg(long)]
    tuning: bool,

    /// List the exit codes.
    #[arg(long)]
    exit_codes: bool,

    /// List the codes of messages.
    #[arg(long)]
    codes: bool,
}

impl ListArgs {
    /// The requested list, other than that of effects.
    pub fn listing(&self) -> Option<Listing> {
        let listings = [
            (self.units, Listing::Units),
            (self.functions, Listing::Functions),
            (self.outputs, Listing::Outputs),
            (self.tuning, Listing::Tuning),
            (self.exit_codes, Listing::ExitCodes),
            (self.codes, Listing::Codes),
        ];
        listings.into_iter().find(|(asked, _)| *asked).map(|(_, listing)| listing)
    }
}
