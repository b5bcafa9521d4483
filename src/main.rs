//! The `mbint` command; everything is in [`mbint::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    mbint::cli::main()
}
