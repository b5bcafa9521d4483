//! Arguments of `mbint studio`.

use std::path::PathBuf;

use clap::Args;

use super::RootArgs;

#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(in crate::cli) struct StudioArgs {
    /// Model file.
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    /// Port on this machine to listen at; 0 for any free one.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub port: u16,

    /// Print the address, without opening a browser.
    #[arg(long)]
    pub no_open: bool,

    #[command(flatten)]
    pub root: RootArgs,
}

const HELP: &str = "\
The address holds a token of this session, without which nothing is answered. The page changes no
file before it is asked to save.";
