//! `cargo xtask bench`: adds a row to the performance record, `docs/performance/record.csv`, and writes its page and
//! drawing.
//!
//! - `--at COMMIT` adds a row of an older commit: instructions only, from the page of that commit;
//! - `--pages` measures nothing, and writes page and drawing again.

mod history;
mod page;

use std::path::Path;
use std::process::{Command, ExitCode};

use serde_json::Value;

use crate::machine;
use history::{EXUDYN, History, INSTRUCTIONS, Row, TIME, instructions};

/// Folder of table, page and drawing.
const FOLDER: &str = "docs/performance";
const TABLE: &str = "record.csv";
const PAGE_OF_INSTRUCTIONS: &str = "docs/reference/instructions.md";

pub fn run(root: &Path, arguments: &[String]) -> ExitCode {
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let row = match arguments.as_slice() {
        [] => row_of_now(root).map(Some),
        ["--at", commit] => row_of(root, commit).map(Some),
        ["--pages"] => Ok(None),
        _ => Err(format!("`{}` is neither `--at COMMIT` nor `--pages`", arguments.join(" "))),
    };
    match row.and_then(|row| write(root, row)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn history(root: &Path) -> Result<History, String> {
    match std::fs::read_to_string(root.join(FOLDER).join(TABLE)) {
        Ok(text) => History::read(&text).map_err(|error| format!("{FOLDER}/{TABLE}: {error}")),
        // There is no table before the first row.
        Err(_) => Ok(History::default()),
    }
}

fn write(root: &Path, row: Option<Row>) -> Result<(), String> {
    let mut history = history(root)?;
    row.into_iter().for_each(|row| history.add(row));
    let files = page::all(&history).into_iter().chain([(TABLE, history.text())]);
    let folder = root.join(FOLDER);
    std::fs::create_dir_all(&folder).map_err(|error| format!("{FOLDER}: {error}"))?;
    for (name, text) in files {
        std::fs::write(folder.join(name), text).map_err(|error| format!("{FOLDER}/{name}: {error}"))?;
    }
    Ok(())
}

/// A row with the instructions of a page.
fn row_with(cells: [(&str, String); 3], page: &str) -> Result<Row, String> {
    let counts = instructions(page)?.into_iter();
    let counts = counts.map(|(model, count)| (format!("{INSTRUCTIONS}{model}"), count.to_string()));
    // No cell has a comma.
    let cells = cells.map(|(column, cell)| (column.to_owned(), cell.replace(',', ";")));
    Ok(cells.into_iter().chain(counts).collect())
}

fn row_of(root: &Path, commit: &str) -> Result<Row, String> {
    let hash = machine::said(root, "git", &["rev-parse", "--short=8", commit]);
    let page = machine::said(root, "git", &["show", &format!("{commit}:{PAGE_OF_INSTRUCTIONS}")]);
    if hash.is_empty() || page.is_empty() {
        return Err(format!("{commit} is no commit with {PAGE_OF_INSTRUCTIONS}"));
    }
    let date = machine::said(root, "git", &["show", "--no-patch", "--format=%cs", commit]);
    row_with(
        [("version", format!("before {}-{hash}", env!("CARGO_PKG_VERSION"))), ("date", date), ("commit", hash)],
        &page,
    )
}

fn row_of_now(root: &Path) -> Result<Row, String> {
    let page = std::fs::read_to_string(root.join(PAGE_OF_INSTRUCTIONS));
    let page = page.map_err(|error| format!("{PAGE_OF_INSTRUCTIONS}: {error}"))?;
    let version = env!("CARGO_PKG_VERSION").to_owned();
    let of_row = [("version", version), ("date", machine::date(root)), ("commit", machine::commit(root))];
    let mut row = row_with(of_row, &page)?;
    row.insert("processor".to_owned(), machine::processor().replace(',', ";"));
    row.insert("compiler".to_owned(), machine::said(root, "rustc", &["--version"]));
    let mut command = Command::new("cargo");
    command.args(["bench", "--locked", "--package", "mbint-benches", "--bench", "record"]);
    let output = command.current_dir(root).stderr(std::process::Stdio::inherit()).output();
    let output = output.map_err(|error| format!("cargo cannot be run: {error}"))?;
    if !output.status.success() {
        return Err("`cargo bench -p mbint-benches --bench record` failed".to_owned());
    }
    let peers = exudyn(root)?.map(|line| line + "\n").unwrap_or_default();
    let times = times(&(peers + &String::from_utf8_lossy(&output.stdout)))?;
    row.extend(times.into_iter().map(|(name, turns)| (format!("{TIME}{name}"), turns)));
    Ok(row)
}

/// A line like those of `benches/record.rs`, of a step of the slider crank by Exudyn, if `benches/peers/run` has
/// installed it: 2000 steps of generalised alpha.
fn exudyn(root: &Path) -> Result<Option<String>, String> {
    let python = root.join("target/exudyn/bin/python");
    if !python.exists() {
        return Ok(None);
    }
    let printed =
        machine::said(root, &python.display().to_string(), &["-W", "ignore", "benches/peers/exudyn_peer.py", "[2.0]"]);
    let report: Value =
        serde_json::from_str(&printed).map_err(|error| format!("benches/peers/exudyn_peer.py: {error}"))?;
    let read = || Some((report["version"].as_str()?, report["slider"]["seconds"].as_f64()?));
    let (version, seconds) = read().ok_or("benches/peers/exudyn_peer.py tells no time of the slider crank")?;
    let case = format!("{EXUDYN}{version}: slider_crank.yaml");
    Ok(Some(serde_json::json!({ "case": case, "nanoseconds": 1e9 * seconds / 2000.0 }).to_string()))
}

/// Times in turns of the reference loop, from the lines of `benches/record.rs`.
fn times(lines: &str) -> Result<Vec<(String, String)>, String> {
    let read = |line: &str| -> Option<(String, f64)> {
        let line: Value = serde_json::from_str(line).ok()?;
        Some((line["case"].as_str()?.replace(',', ""), line["nanoseconds"].as_f64()?))
    };
    let lines = lines.lines().filter(|line| !line.is_empty());
    let mut cases = lines
        .map(|line| read(line).ok_or(format!("`{line}` is no measurement")))
        .collect::<Result<Vec<(String, f64)>, String>>()?;
    let index = cases.iter().position(|(name, _)| name == "reference loop").ok_or("the reference loop is missing")?;
    let (_, reference) = cases.swap_remove(index);
    Ok(cases.into_iter().map(|(name, time)| (name, format!("{:.0}", time / reference))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_turns_of_the_reference_loop() {
        let lines = "{\"case\":\"door.yaml, ideal\",\"nanoseconds\":310.0}\n\n{\"case\":\"reference loop\",\"nanoseconds\":2.5}\n";
        assert_eq!(times(lines).unwrap(), [("door.yaml ideal".to_owned(), "124".to_owned())]);
        let (missing, _) = lines.split_once("\n\n").unwrap();
        assert_eq!(times(missing).unwrap_err(), "the reference loop is missing");
        assert_eq!(times("running 0 tests\n").unwrap_err(), "`running 0 tests` is no measurement");
    }

    /// Nobody writes a figure by hand: page and drawing are those of the committed table.
    #[test]
    fn committed_page_matches_the_table() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let history = history(&root).unwrap();
        assert!(!history.rows.is_empty());
        for (name, text) in page::all(&history) {
            let written = std::fs::read_to_string(root.join(FOLDER).join(name)).unwrap();
            assert!(written == text, "{FOLDER}/{name}: `cargo xtask bench --pages` writes it again");
        }
    }
}
