//! The `mbint` command; everything is in the library's room `cli`.

#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    mbint::inner::cli::main()
}
