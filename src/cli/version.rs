//! `mbint --version --verbose`: identification of this program, for a report of a fault.

use std::ffi::OsString;

/// Commit from which it was built, if the build gave it.
const COMMIT: Option<&str> = option_env!("MBINT_COMMIT");

/// Whether the arguments ask for it, and for nothing else.
pub(super) fn is_asked(arguments: &[OsString]) -> bool {
    let mut rest: Vec<&str> = arguments.iter().skip(1).map(|argument| argument.to_str().unwrap_or_default()).collect();
    rest.sort_unstable();
    matches!(rest[..], ["--verbose", "--version"] | ["--verbose", "-V"])
}

/// Version, commit, build, instruction set in use, cores, and versions of the written formats.
pub(super) fn verbose() -> String {
    let library = if cfg!(target_env = "gnu") {
        ", glibc"
    } else if cfg!(target_env = "musl") {
        ", musl"
    } else {
        ""
    };
    let build = if cfg!(debug_assertions) { "with debug assertions" } else { "release" };
    let lines = [
        format!("mbint {}", env!("CARGO_PKG_VERSION")),
        format!("commit: {}", COMMIT.unwrap_or("unknown")),
        format!("build: {build}, {} {}{library}", std::env::consts::OS, std::env::consts::ARCH),
        format!("instructions: {}", symdiff::instruction_set()),
        format!("cores: {}", std::thread::available_parallelism().map_or(1, usize::from)),
        format!("schema: {}", crate::model::SCHEMA_VERSION),
        format!("studies: format {}", crate::store::FORMAT),
    ];
    lines.map(|line| line + "\n").concat()
}
