//! The `mbint` command; everything is in the library's room `cli`.

use std::process::ExitCode;

fn main() -> ExitCode {
    mbint::inner::cli::main()
}
