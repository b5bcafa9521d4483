//! Models and formulas as no one would write them: whatever stands in a file, the answer is a result or an error.
//!
//! `cargo test --test fuzz` changes the models of `models/` and `tests/bad_models/` at random;
//! `MBINT_FUZZ_INPUTS=1000000` tries so many inputs. Guided by coverage, and with limits of time and memory, the same targets
//! run with cargo-fuzz:
//!
//! ```sh
//! cargo +nightly fuzz run model corpus models tests/bad_models -- -rss_limit_mb=1024 -timeout=10 -max_len=20000
//! ```

mod mutate;
mod targets;

use peak_alloc::PeakAlloc;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

use mutate::{Corpus, edits, formula};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// More than any input may take.
const MOST_MEGABYTES: f32 = 1024.0;

/// Tries many inputs; `share` of the number that was asked for, or `few`.
fn fuzz(few: u32, inputs: impl Strategy<Value = String>, target: fn(&str)) {
    let asked = std::env::var("MBINT_FUZZ_INPUTS").ok().map(|number| number.parse().unwrap());
    let config = Config { cases: asked.unwrap_or(few), failure_persistence: None, ..Config::default() };
    let tried = TestRunner::new(config).run(&inputs, |text| {
        target(&text);
        Ok(())
    });
    if let Err(found) = tried {
        panic!("{found}");
    }
    assert!(MEMORY.peak_usage_as_mb() < MOST_MEGABYTES, "{} MB", MEMORY.peak_usage_as_mb());
}

#[test]
fn models() {
    let corpus = Corpus::of(&["models", "tests/bad_models"], "yaml");
    fuzz(20_000, edits().prop_map(move |edits| corpus.apply(&edits)), targets::model);
}

#[test]
fn robots() {
    let corpus = Corpus::of(&["models", "tests/bad_models"], "urdf");
    fuzz(5000, edits().prop_map(move |edits| corpus.apply(&edits)), targets::robot);
}

#[test]
fn formulas() {
    fuzz(100_000, formula(), targets::formula);
}

#[test]
fn short_runs() {
    let corpus = Corpus::of(&["models"], "yaml");
    fuzz(1000, edits().prop_map(move |edits| corpus.apply(&edits)), targets::short_run);
}
