//! `cargo xtask TASK`: checks for people who change mbint.
//!
//! - `tidy`: the text of the source (seconds, no build);
//! - `fast`: format, tidy, lints and one test of each kind (about a minute after a build);
//! - `gate`: all of `.ci/run`;
//! - `verification`: the verification report (`docs/verification/`), for a release;
//! - `bench`: a row of the performance record (`docs/performance/`), for a release.

#![forbid(unsafe_code)]
#![allow(clippy::disallowed_methods, reason = "figures of pages have few digits")]

mod bench;
mod machine;
mod tidy;
mod verification;

use std::path::Path;
use std::process::{Command, ExitCode};

/// Commands of `fast`, in order: the cheapest first.
const FAST: [&str; 7] = [
    "bash .ci/format.sh",
    "cargo xtask tidy",
    "cargo clippy --locked --lib --bins -- -D warnings",
    "cargo test --locked --test program rooms",
    "cargo test --locked --test elements examples",
    "cargo test --locked --test models slider_crank",
    "cargo test --locked -p mbint-symdiff",
];

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let task = std::env::args().nth(1).unwrap_or_default();
    match task.as_str() {
        "tidy" => tidy::run(&root),
        "fast" => {
            if FAST.iter().all(|command| succeeds(&root, command)) {
                ExitCode::SUCCESS
            } else {
                ExitCode::FAILURE
            }
        }
        "verification" => verification::run(&root, std::env::args().skip(2)),
        "bench" => bench::run(&root, &std::env::args().skip(2).collect::<Vec<_>>()),
        "gate" => {
            if succeeds(&root, "bash .ci/run") {
                ExitCode::SUCCESS
            } else {
                ExitCode::FAILURE
            }
        }
        _ => {
            eprintln!("usage: cargo xtask tidy | fast | gate | verification [OPTION …] | bench [OPTION …]");
            ExitCode::from(2)
        }
    }
}

/// Runs a command (words separated by spaces) in the root of the repository; prints it first.
fn succeeds(root: &Path, command: &str) -> bool {
    println!("== {command}");
    let mut words = command.split(' ');
    let status = Command::new(words.next().unwrap_or_default()).args(words).current_dir(root).status();
    match status {
        Ok(status) => status.success(),
        Err(error) => {
            eprintln!("error: `{command}` cannot be run: {error}");
            false
        }
    }
}
