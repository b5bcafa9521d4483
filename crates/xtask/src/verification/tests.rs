//! The whole way from measurements to pages and the exit status.

use super::record::Figure;
use super::*;

/// A record in which every claim has a case that holds.
fn holding() -> Record {
    let section = |claim: &Claim| Section {
        claim: claim.name.to_owned(),
        runs: vec![Run { command: "measure".to_owned(), passed: 1, ..Run::default() }],
        cases: vec![Case {
            claim: claim.name.to_owned(),
            case: "a | b".to_owned(),
            figures: vec![Figure::number("error, m", 2.5e-7, None, Some(1e-6))],
            ..Case::default()
        }],
        apart: None,
    };
    Record { sections: CLAIMS.iter().map(section).collect(), ..Record::default() }
}

fn page(record: &Record, name: &str) -> String {
    let pages = pages::all(record);
    pages.into_iter().find(|(own, _)| own == name).unwrap().1
}

fn is_success(record: &Record) -> bool {
    format!("{:?}", conclude(record)) == format!("{:?}", ExitCode::SUCCESS)
}

#[test]
fn a_claim_that_holds_shows_its_figures_and_limits() {
    let record = holding();
    assert!(is_success(&record));
    let page = page(&record, "textbook.md");
    assert!(
        page.contains("| case | error, m | verdict |\n|---|--:|---|\n| a \\| b | 2.5e-7 (≤ 1e-6) | holds |\n"),
        "{page}"
    );
    assert!(page.contains("- `measure` (1 of 1 passed)"), "{page}");
}

#[test]
fn failed_claim_is_in_the_summary_and_the_exit_status() {
    let mut record = holding();
    record.sections[3].cases[0].figures[0].value = Some(2e-6);
    assert!(!is_success(&record));
    let summary = page(&record, "index.md");
    assert_eq!(summary.matches("**fails**").count(), 1, "{summary}");
    assert!(summary.contains("](textbook.md) | code verification | 1 | 0 | **fails** |"), "{summary}");
    // A command that did not end well fails its claim too, with the reason.
    let mut record = holding();
    record.sections[0].runs[0].error = Some("ended with\nsignal 9".to_owned());
    assert!(!is_success(&record));
    assert!(page(&record, "elements.md").contains("`measure`: **failed**: ended with signal 9"));
}

#[test]
fn missing_resources_are_reported_without_failure() {
    let mut record = holding();
    let adams = record.sections.iter_mut().find(|section| section.claim == "adams").unwrap();
    adams.cases.clear();
    adams.runs[0].left_out = Some("no folder".to_owned());
    assert!(is_success(&record));
    assert!(page(&record, "index.md").contains("| 0 | 0 | not measured |"));
    assert!(page(&record, "adams.md").contains("`measure`: not measured here: no folder"));
}

#[test]
fn exceptions_have_reasons_and_shares_intervals() {
    let mut record = holding();
    let mut excepted = record.sections[1].cases[0].clone();
    excepted.exception = Some("not smooth".to_owned());
    record.sections[1].cases.push(excepted);
    let share = Figure { name: "missed".to_owned(), count: Some(1), of: Some(29), ..Figure::default() };
    record.sections[FALSIFIER].cases[0].figures.push(share);
    let misses = page(&record, "misses.md");
    assert!(misses.contains("(models.md) | a \\| b | not smooth |"), "{misses}");
    assert!(page(&record, "index.md").contains("](models.md) | code verification | 1 | 1 | holds |"));
    // Newcombe's table has 0.0009 to 0.1776.
    let falsifier = page(&record, "falsifier.md");
    assert!(falsifier.contains("| 1 of 29: 0.09 to 17.76 % |") && falsifier.contains("95 % confidence"), "{falsifier}");
}

/// No figure is written by hand: the committed pages are those of the committed measurements.
#[test]
fn committed_pages_match_the_measurements() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/verification");
    let record = read(&folder.join(MEASURED)).unwrap();
    assert!(!record.on.quick);
    for (name, text) in pages::all(&record) {
        let written = std::fs::read_to_string(folder.join(&name)).unwrap();
        assert!(written == text, "docs/verification/{name}: `cargo xtask verification --pages` writes it again");
    }
}

#[test]
fn options_are_read_or_named() {
    let read = |text: &str| Options::read(text.split_whitespace().map(str::to_owned));
    let options = read("--quick --dev --draws 12 --into there --only peers,validation").unwrap();
    let expected = Options {
        quick: true,
        release: false,
        draws: 12,
        into: PathBuf::from("there"),
        only: vec!["peers".to_owned(), "validation".to_owned()],
        pages_only: false,
    };
    assert_eq!(options, expected);
    assert_eq!(options.command(), "cargo xtask verification --quick --dev --only peers,validation");
    assert_eq!(read("").unwrap().command(), "cargo xtask verification --draws 5000");
    assert_eq!(read("--draws many").unwrap_err(), "--draws: invalid digit found in string");
    assert_eq!(read("--into").unwrap_err(), "--into needs a value");
    assert!(read("--only peer").unwrap_err().starts_with("--only: peer is none of elements, models"));
    assert!(read("--qick").unwrap_err().starts_with("--qick is none of --quick"));
}
