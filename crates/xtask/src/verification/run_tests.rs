//! Runs tests, and reads their measurements.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use super::record::{Case, Figure, Run, cases};

/// Test binaries named by sources.
const BINARIES: [&str; 5] = ["elements", "models", "program", "falsify", "fuzz"];

/// Built tests, and the program that they test.
pub struct Built {
    tests: BTreeMap<String, PathBuf>,
    pub program: PathBuf,
}

impl Built {
    /// Builds tests and program, whose paths cargo reports. An error names the missing part.
    pub fn new(root: &Path, release: bool) -> Result<Self, String> {
        let mut cargo = Command::new("cargo");
        cargo.args(["test", "--locked", "--no-run", "--message-format=json-render-diagnostics"]);
        cargo.args(BINARIES.iter().flat_map(|name| ["--test", *name]));
        if release {
            cargo.arg("--release");
        }
        let output = cargo.current_dir(root).stderr(Stdio::inherit()).output();
        let output = output.map_err(|error| format!("cargo cannot be run: {error}"))?;
        if !output.status.success() {
            return Err("the tests cannot be built".to_owned());
        }
        let mut built = executables(&String::from_utf8_lossy(&output.stdout));
        let program = built.remove("mbint").ok_or("cargo names no program mbint")?;
        match BINARIES.iter().find(|name| !built.contains_key(**name)) {
            None => Ok(Self { tests: built, program }),
            Some(missing) => Err(format!("cargo names no test binary {missing}")),
        }
    }

    /// Runs the tests whose names contain `filter`, including those that take long. Their cases may be of any claim.
    pub fn run(&self, root: &Path, binary: &str, filter: &str, environment: &[(&str, String)]) -> (Run, Vec<Case>) {
        let (run, cases, _) = self.measured(root, binary, &[filter, "--include-ignored"], environment);
        (run, cases)
    }

    /// Runs the same but for the tests whose names contain one of `skipped`; every module is a case of a claim.
    pub fn run_modules(
        &self,
        root: &Path,
        claim: &str,
        binary: &str,
        filter: &str,
        skipped: &[&str],
    ) -> (Run, Vec<Case>) {
        let skipped = skipped.iter().flat_map(|name| ["--skip", name]);
        let arguments: Vec<&str> = [filter, "--include-ignored"].into_iter().chain(skipped).collect();
        let (run, mut cases, outcomes) = self.measured(root, binary, &arguments, &[]);
        let mut modules: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
        for (test, passed) in &outcomes {
            let counts = modules.entry(test.rsplit_once("::").map_or("", |(module, _)| module)).or_default();
            counts[usize::from(!passed)] += 1;
        }
        cases.extend(modules.into_iter().map(|(module, [passed, failed])| Case {
            claim: claim.to_owned(),
            case: format!("tests of `{module}`"),
            figures: vec![
                Figure::number("tests", (passed + failed) as f64, None, None),
                Figure::number("failed", failed as f64, None, Some(0.0)),
            ],
            ..Case::default()
        }));
        (run, cases)
    }

    fn measured(
        &self,
        root: &Path,
        binary: &str,
        arguments: &[&str],
        environment: &[(&str, String)],
    ) -> (Run, Vec<Case>, Vec<(String, bool)>) {
        let command = format!("cargo test --test {binary} -- {}", arguments.join(" "));
        let mut run = Run { command, ..Run::default() };
        let lines = std::env::temp_dir().join(format!("mbint-measured-{}.jsonl", std::process::id()));
        // Lines of a run that ended early.
        let _ = std::fs::remove_file(&lines);
        let mut tests = Command::new(&self.tests[binary]);
        tests.args(arguments).current_dir(root).env("MBINT_MEASURED", &lines);
        // Without the draws of other runs.
        tests.env_remove("MBINT_FALSIFY_RECORD").envs(environment.iter().map(|(name, value)| (name, value)));
        let output = match tests.output() {
            Ok(output) => output,
            Err(error) => {
                run.error = Some(format!("cannot be run: {error}"));
                return (run, Vec::new(), Vec::new());
            }
        };
        let printed = String::from_utf8_lossy(&output.stdout);
        let outcomes = outcomes(&printed);
        run.passed = outcomes.iter().filter(|(_, passed)| *passed).count();
        run.failed = outcomes.len() - run.passed;
        if outcomes.is_empty() {
            run.error = Some("no test has this name".to_owned());
        } else if !output.status.success() {
            eprintln!("{printed}");
            run.error = Some(format!("ended with {}", output.status));
        }
        let measured = cases(&std::fs::read_to_string(&lines).unwrap_or_default());
        let _ = std::fs::remove_file(&lines);
        let cases = measured.unwrap_or_else(|error| {
            run.error = Some(error);
            Vec::new()
        });
        (run, cases, outcomes)
    }
}

/// Executables by the names of their targets, from cargo's messages.
fn executables(messages: &str) -> BTreeMap<String, PathBuf> {
    let read = |line: &str| {
        let message: Value = serde_json::from_str(line).ok()?;
        let path = message["executable"].as_str()?;
        Some((message["target"]["name"].as_str()?.to_owned(), PathBuf::from(path)))
    };
    messages.lines().filter_map(read).collect()
}

/// Tests and their success, from libtest's lines; ignored ones do not count.
fn outcomes(printed: &str) -> Vec<(String, bool)> {
    let read = |line: &str| {
        let (name, outcome) = line.strip_prefix("test ")?.rsplit_once(" ... ")?;
        match outcome.trim() {
            "ok" => Some((name.to_owned(), true)),
            "FAILED" => Some((name.to_owned(), false)),
            _ => None,
        }
    };
    printed.lines().filter_map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_libtest_and_of_cargo_are_read() {
        let printed = "running 4 tests\ntest a::b ... ok\ntest a::c ... FAILED\ntest d ... ignored, minutes\n\
                       test e has been running for over 60 seconds\ntest e ... ok\ntest result: FAILED. 2 passed; 1 failed;\n";
        let expected = [("a::b", true), ("a::c", false), ("e", true)];
        assert_eq!(outcomes(printed), expected.map(|(name, passed)| (name.to_owned(), passed)));
        let messages = "{\"reason\":\"compiler-artifact\",\"target\":{\"name\":\"fuzz\"},\"executable\":\"/t/fuzz-1\"}\n\
                        {\"reason\":\"compiler-artifact\",\"target\":{\"name\":\"symdiff\"},\"executable\":null}\n\
                        {\"reason\":\"build-finished\",\"success\":true}\n";
        assert_eq!(executables(messages), BTreeMap::from([("fuzz".to_owned(), PathBuf::from("/t/fuzz-1"))]));
    }
}
