//! Models and formulas as no one would write them: whatever stands in a file, the answer is a result or an error.
//!
//! `cargo test --test fuzz` changes the models of `models/` and `tests/bad_models/` at random;
//! `MBINT_FUZZ_INPUTS=1000000` tries a million inputs, and `cargo test --test fuzz -- --ignored` as many as the gate
//! does. Guided by coverage, and with limits of time and memory, the same targets run with cargo-fuzz:
//!
//! ```sh
//! cargo +nightly fuzz run model corpus models tests/bad_models -- -rss_limit_mb=1024 -timeout=10 -max_len=20000
//! ```

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

#[path = "../common/measured.rs"]
#[allow(dead_code, reason = "shared with the tests of models")]
mod measured;
mod mutate;
mod targets;

use peak_alloc::PeakAlloc;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

use measured::Case;
use mutate::{Corpus, edits, formula};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// More than any input may take.
const MOST_MEGABYTES: f32 = 1024.0;

/// Tries the number of inputs that was asked for, or `few`.
fn fuzz(name: &str, few: u32, inputs: impl Strategy<Value = String>, target: fn(&str)) {
    let asked = std::env::var("MBINT_FUZZ_INPUTS").ok().map(|number| number.parse().unwrap());
    let config = Config { cases: asked.unwrap_or(few), failure_persistence: None, ..Config::default() };
    let tried = TestRunner::new(config).run(&inputs, |text| {
        target(&text);
        Ok(())
    });
    if let Err(found) = tried {
        panic!("{found}");
    }
    let case = Case::new("robustness", &format!("fuzzing of {name}")).figure("inputs", f64::from(asked.unwrap_or(few)));
    case.at_most("memory of all targets at most, MB", f64::from(MEMORY.peak_usage_as_mb()), f64::from(MOST_MEGABYTES))
        .note();
}

fn models(few: u32) {
    let corpus = Corpus::of(&["models", "tests/bad_models"], "yaml");
    fuzz("models", few, edits().prop_map(move |edits| corpus.apply(&edits)), targets::model);
}

fn robots(few: u32) {
    let corpus = Corpus::of(&["models", "tests/bad_models"], "urdf");
    fuzz("URDF", few, edits().prop_map(move |edits| corpus.apply(&edits)), targets::robot);
}

fn mjcf(few: u32) {
    let corpus = Corpus::of(&["models", "tests/bad_models", "tests/reference/mjcf"], "xml");
    fuzz("MJCF", few, edits().prop_map(move |edits| corpus.apply(&edits)), targets::mjcf);
}

fn formulas(few: u32) {
    fuzz("formulas", few, formula(), targets::formula);
}

fn short_runs(few: u32) {
    let corpus = Corpus::of(&["models"], "yaml");
    fuzz("short runs", few, edits().prop_map(move |edits| corpus.apply(&edits)), targets::short_run);
}

mod few {
    #[test]
    fn models() {
        super::models(4000);
    }

    #[test]
    fn robots() {
        super::robots(1000);
    }

    #[test]
    fn mjcf() {
        super::mjcf(300);
    }

    #[test]
    fn formulas() {
        super::formulas(20_000);
    }

    #[test]
    fn short_runs() {
        super::short_runs(200);
    }
}

mod many {
    #[test]
    #[ignore = "a minute: as many inputs as the gate tries"]
    fn models() {
        super::models(20_000);
    }

    #[test]
    #[ignore = "10 s: as many inputs as the gate tries"]
    fn robots() {
        super::robots(5000);
    }

    #[test]
    #[ignore = "two minutes: as many inputs as the gate tries"]
    fn mjcf() {
        super::mjcf(2000);
    }

    #[test]
    #[ignore = "10 s: as many inputs as the gate tries"]
    fn formulas() {
        super::formulas(100_000);
    }

    #[test]
    #[ignore = "10 s: as many inputs as the gate tries"]
    fn short_runs() {
        super::short_runs(1000);
    }
}
