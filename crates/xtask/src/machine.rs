//! The machine of a measurement.

use std::path::Path;
use std::process::Command;

/// The output of a program, trimmed; empty if it cannot be run or fails.
pub fn said(root: &Path, program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).current_dir(root).output();
    let output = output.ok().filter(|output| output.status.success());
    output.map_or(String::new(), |output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Hash of the commit, followed by `+` if tracked files differ from it.
pub fn commit(root: &Path) -> String {
    let changed = !said(root, "git", &["status", "--porcelain", "--untracked-files=no"]).is_empty();
    said(root, "git", &["rev-parse", "--short=8", "HEAD"]) + if changed { "+" } else { "" }
}

/// Today, YYYY-MM-DD, UTC.
pub fn date(root: &Path) -> String {
    said(root, "date", &["-u", "+%Y-%m-%d"])
}

/// Name of the processor if the system reports it, otherwise its architecture; and the system.
pub fn processor() -> String {
    let processors = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = processors.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    format!("{}, {}", name.map_or(std::env::consts::ARCH, |(_, name)| name), std::env::consts::OS)
}
