//! Tries to prove stated errors wrong: mechanisms, boxes, steps, orders and outputs are drawn at random from families
//! whose motion is known without mbint, and every band is compared with the true range, row by row.
//!
//! ```sh
//! cargo test --test falsify -- --ignored --nocapture           # the gate's draws
//! MBINT_FALSIFY_DRAWS=5000 MBINT_FALSIFY_SEED=1 cargo test --test falsify -- --ignored --nocapture
//! ```
//!
//! `MBINT_FALSIFY_FAMILY=pulse` draws from families whose names begin so, `MBINT_FALSIFY_ONLY=17` the draw of that
//! number, whose model it prints, `MBINT_FALSIFY_FIRST=300` begins with that number; `MBINT_FALSIFY_SECONDS=600`
//! begins no draw after ten minutes, `MBINT_FALSIFY_THREADS=1` makes them one after the other,
//! `MBINT_FALSIFY_PATIENCE=300` waits five minutes for one (60 s), as a busy machine needs.
//! `MBINT_FALSIFY_RECORD=FILE` notes every draw in a file; those that it has are not repeated, and count in the table.
//! `MBINT_FALSIFY_SHOWN=2` makes two misses of each family and method simple and prints them as models;
//! `MBINT_FALSIFY_MISSES=FOLDER` writes them there as well.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

#[path = "../common/dop853.rs"]
mod dop853;
#[path = "../common/measured.rs"]
#[allow(dead_code, reason = "shared with the tests of models")]
mod measured;

mod certified;
mod draw;
mod excited;
mod families;
mod known;
mod questions;
mod random;
mod record;
mod ridge;
mod rows;
mod search;
mod shrink;
mod table;
mod truth;
mod verdict;
mod wide;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::num::NonZero;
use std::ops::Range;
use std::path::Path;
use std::str::FromStr;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use draw::Draw;
use measured::Case;
use record::Record;
use table::{Scored, Table};
use verdict::{Outcome, Verdict, examine};

/// A number from the environment.
fn asked<T: FromStr>(name: &str) -> Option<T> {
    let value = std::env::var(name).ok()?;
    Some(value.parse().unwrap_or_else(|_| panic!("{name} is `{value}`")))
}

/// A miss in words, and as a model with it.
fn describe(draw: &Draw, verdict: &Verdict, number: u64) -> String {
    let mut text = String::new();
    let open = verdict.rows - verdict.flagged;
    let method = verdict.method.name();
    let (misses, family) = (verdict.misses.len(), draw.family);
    writeln!(text, "# draw {number}, {family}: {method} misses {misses} of {open} rows that are not flagged").unwrap();
    if let Some(worst) = verdict.worst() {
        let side = if worst.inside { "too narrow" } else { "too wide" };
        let verdict::Miss { time, truth, found, stated, off, .. } = worst;
        writeln!(text, "# at {time} s the truth is [{:.9e}, {:.9e}],", truth.lower, truth.upper).unwrap();
        writeln!(
            text,
            "# the band [{:.9e}, {:.9e}], {side} by {off:.2e}; stated: {stated:.2e}",
            found.lower, found.upper
        )
        .unwrap();
        writeln!(text, "# largest width {:.3e}", verdict.width).unwrap();
    }
    text + &draw.yaml()
}

/// Findings of a run of many draws so far.
#[derive(Default)]
struct Findings {
    table: Table,
    record: Option<Record>,
    /// Number of misses so far of a family by a method.
    shown: BTreeMap<(&'static str, &'static str), usize>,
}

/// Runs the draws of a seed with these numbers; simplifies and shows at most `shown` misses of each family and method.
fn falsify(seed: u64, numbers: Range<u64>, shown: usize) -> Table {
    let family: Option<String> = asked("MBINT_FALSIFY_FAMILY");
    let (begun, patience) = (Instant::now(), asked("MBINT_FALSIFY_SECONDS").unwrap_or(u64::MAX));
    let mut findings = Findings::default();
    findings.record =
        asked::<String>("MBINT_FALSIFY_RECORD").map(|path| Record::open(Path::new(&path), &mut findings.table));
    let findings = Mutex::new(findings);
    let next = AtomicU64::new(numbers.start);
    // Not by rayon, whose threads would begin another draw while one waits for its study.
    std::thread::scope(|scope| {
        let threads = asked("MBINT_FALSIFY_THREADS").or_else(|| std::thread::available_parallelism().ok());
        for _ in 0..threads.map_or(1, NonZero::get) {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= numbers.end || begun.elapsed().as_secs() >= patience {
                        break;
                    }
                    let draw = families::draw(seed, number, family.as_deref());
                    attack(&draw, number, &findings, shown);
                }
            });
        }
    });
    findings.into_inner().expect("no draw panics with the findings").table
}

/// Examines one draw: notes its outcome and, if something is wrong, shows it.
fn attack(draw: &Draw, number: u64, findings: &Mutex<Findings>, shown: usize) {
    let lock = || findings.lock().expect("no draw panics with the findings");
    if lock().record.as_ref().is_some_and(|record| record.has(number)) {
        return;
    }
    if asked::<u64>("MBINT_FALSIFY_ONLY").is_some() {
        println!("{}", draw.yaml());
    }
    let outcome = examine(draw);
    let scored = Scored::new(draw.family, &outcome);
    {
        let mut findings = lock();
        findings.table.add(&scored);
        findings.record.iter_mut().for_each(|record| record.add(number, &scored));
    }
    let verdicts = match outcome {
        Outcome::Judged(verdicts, _) => verdicts,
        Outcome::Failed(failure) => {
            println!("# draw {number}, {}: {failure}\n{}", draw.family, draw.yaml());
            return;
        }
    };
    for missed in verdicts.iter().filter(|verdict| verdict.is_missed()) {
        note_miss(number, draw.family, missed);
        let enough = {
            let mut findings = lock();
            let so_far = findings.shown.entry((draw.family, missed.label)).or_default();
            *so_far += 1;
            *so_far > shown
        };
        if enough {
            let first = describe(draw, missed, number);
            let head = first.lines().take_while(|line| line.starts_with('#')).collect::<Vec<_>>().join("\n");
            println!("{}", if asked::<u64>("MBINT_FALSIFY_ONLY").is_some() { &first } else { &head });
        } else {
            let (small, missed) = shrink::shrink(draw, missed);
            show(&small, &missed, number);
        }
    }
}

/// Notes a missed band for the verification report.
fn note_miss(number: u64, family: &str, missed: &Verdict) {
    let case = Case::new("misses", &format!("draw {number}, {family}: {}", missed.label));
    let open = missed.rows - missed.flagged;
    let worst = missed.worst().map_or(f64::NAN, |worst| worst.off / worst.stated);
    case.figure("rows missed", missed.misses.len() as f64)
        .figure("of rows", open as f64)
        .figure("off / stated error", worst)
        .note();
}

/// Prints a miss, and writes it where the environment asks for that.
fn show(draw: &Draw, missed: &Verdict, number: u64) {
    let text = describe(draw, missed, number);
    println!("{text}");
    if let Some(folder) = asked::<String>("MBINT_FALSIFY_MISSES") {
        let name = format!("{}_{number}_{}.yaml", draw.family.replace([' ', '-'], "_"), missed.method.name());
        std::fs::write(Path::new(&folder).join(name), text).unwrap();
    }
}

/// A few draws of every family, so that `cargo test` knows that the falsifier works.
#[test]
fn errors_of_a_few_draws_are_honest() {
    let table = falsify(7, 0..families::FAMILIES.len() as u64, 0);
    println!("{table}");
    table.note(7);
    assert_eq!(table.failures(), 0);
}

/// The gate's draws, or the number that the environment asks for: no family is missed more often than known.
#[test]
#[ignore = "minutes"]
fn errors_are_honest() {
    let [seed, draws, only, first]: [Option<u64>; 4] =
        ["MBINT_FALSIFY_SEED", "MBINT_FALSIFY_DRAWS", "MBINT_FALSIFY_ONLY", "MBINT_FALSIFY_FIRST"].map(asked);
    let by_hand =
        [seed, draws, only, first].iter().any(Option::is_some) || std::env::var_os("MBINT_FALSIFY_FAMILY").is_some();
    let draws = draws.unwrap_or(known::DRAWS);
    let numbers = only.map_or(first.unwrap_or(0)..draws, |only| only..only + 1);
    // Simplifying takes longer than all the gate's draws.
    let shown = asked("MBINT_FALSIFY_SHOWN").unwrap_or(if only.is_some() { usize::MAX } else { 0 });
    let seed = seed.unwrap_or(known::SEED);
    let table = falsify(seed, numbers, shown);
    println!("{table}");
    table.note(seed);
    if by_hand {
        return;
    }
    let mut worse = String::new();
    for family in families::FAMILIES {
        let (missed, known) = (table.missed(family.name), known::missed(family.name));
        if missed > known {
            writeln!(worse, "{}: {missed} bands are missed, {known} are known", family.name).unwrap();
        } else if missed < known {
            println!("{}: only {missed} bands are missed: lower its {known} in tests/falsify/known.rs", family.name);
        }
    }
    let (contradicted, known) = (table.contradicted(), known::CONTRADICTED);
    if contradicted > known {
        writeln!(worse, "{contradicted} bands contradict their own runs, {known} are known").unwrap();
    }
    assert!(worse.is_empty(), "\n{worse}");
    assert_eq!(table.failures(), 0, "draws have no bands");
}

/// Notes the draws of a question and its wrong answers, of which at most `most` may occur.
fn note(question: &str, draws: usize, wrong: &str, count: usize, most: usize) {
    let case = Case::new("questions", question).figure("draws", draws as f64).text("counted", wrong);
    case.at_most("wrong", count as f64, most as f64).note();
}

/// Draws of a question, in the number that the environment asks for.
fn questioned(draws: u64, ask: fn(u64, u64) -> questions::Tally) -> questions::Tally {
    let tally =
        ask(asked("MBINT_FALSIFY_SEED").unwrap_or(known::SEED), asked("MBINT_FALSIFY_QUESTIONS").unwrap_or(draws));
    println!("{tally}");
    tally
}

/// Intervals of 95 % miss one in twenty: here at most the number that chance exceeds in one of a thousand runs, or the
/// known number.
#[test]
#[ignore = "half a minute"]
fn shares_that_fail_are_honest() {
    let tally = questioned(known::SHARES.0, questions::shares);
    let n = tally.draws as f64;
    let chance = 0.05 * n + 3.1 * (0.05 * 0.95 * n).sqrt();
    let most = chance.max(known::SHARES.1 as f64).floor();
    note("shares that fail", tally.draws, "outside their interval of 95 %", tally.missed, most as usize);
}

#[test]
#[ignore = "half a minute"]
fn allocations_are_honest() {
    let tally = questioned(known::ALLOCATIONS.0, questions::allocations);
    note("allocations", tally.draws, "refuted", tally.missed, known::ALLOCATIONS.1);
}

/// Bounds of 6 to 40 parameters, which follow gradients.
fn wide(draws: u64) {
    let seed = asked("MBINT_FALSIFY_SEED").unwrap_or(known::SEED);
    let tally = wide::compare(seed, asked("MBINT_FALSIFY_QUESTIONS").unwrap_or(draws));
    println!("{tally}");
    note("6 to 40 parameters", tally.draws, "rows missed", tally.missed, known::WIDE);
    assert!(4 * tally.flagged <= tally.rows, "{tally}");
}

#[test]
fn ends_of_a_few_draws_of_many_parameters_are_honest() {
    wide(4);
}

#[test]
#[ignore = "half a minute"]
fn ends_of_many_parameters_are_honest() {
    wide(60);
}

/// Excitations within limits, and random ones.
fn excited(name: &str, draws: u64, compare: fn(u64, u64) -> rows::Tally) {
    let seed = asked("MBINT_FALSIFY_SEED").unwrap_or(known::SEED);
    let tally = compare(seed, asked("MBINT_FALSIFY_QUESTIONS").unwrap_or(draws));
    println!("{tally}");
    note(name, tally.draws, "rows missed", tally.missed, known::EXCITED);
    assert!(4 * tally.flagged <= tally.rows, "{tally}");
}

#[test]
fn ends_of_a_few_draws_over_functions_are_honest() {
    excited("bounded excitations", 6, excited::functions);
}

#[test]
#[ignore = "half a minute"]
fn ends_over_functions_are_honest() {
    excited("bounded excitations", 80, excited::functions);
}

#[test]
fn ends_of_a_few_draws_over_classes_of_functions_are_honest() {
    excited("excitations with a mean, an energy or a band", 4, excited::classes);
}

#[test]
#[ignore = "a minute"]
fn ends_over_classes_of_functions_are_honest() {
    excited("excitations with a mean, an energy or a band", 80, excited::classes);
}

#[test]
fn root_mean_squares_are_honest() {
    excited("random excitations", 60, excited::squares);
}

/// Certified bands contain every motion; some draws have such bands.
fn proven(draws: u64) {
    let seed = asked("MBINT_FALSIFY_SEED").unwrap_or(known::SEED);
    let tally = certified::compare(seed, asked("MBINT_FALSIFY_QUESTIONS").unwrap_or(draws));
    println!("{tally}");
    let case = Case::new("certified", "drawn mechanisms").source("closed forms, Runge–Kutta of order 8");
    let case = case.figure("draws proven", tally.proven as f64).figure("rows proven", tally.known as f64);
    case.at_most("rows missed", tally.missed as f64, 0.0).note();
    assert!(tally.proven > 0 && tally.missed == 0, "{tally}");
}

#[test]
#[ignore = "a minute"]
fn certified_bands_hold_the_truth() {
    proven(60);
}
