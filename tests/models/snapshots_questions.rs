//! Answers of the book's examples, as they were last reviewed: `snapshots/answers/`. Reduced outputs, verdicts,
//! statistics and analyses of one configuration, in six digits, without errors.
//!
//! `INSTA_UPDATE=always cargo test --test models snapshots -- --include-ignored` takes changes over.

use std::fmt::Write;
use std::path::Path;

use mbint::results::Summary;

use crate::common::{load_all, run_methods};

/// Smaller values are rounding.
const ROUNDING: f64 = 1e-9;

/// Six digits.
fn shown(value: f64) -> String {
    if value.abs() < ROUNDING { "0".to_owned() } else { format!("{value:.5e}") }
}

fn table(summary: &Summary) -> String {
    let mut table = String::new();
    let mut line = |kind: &str, name: &str, values: &[f64], more: &str| {
        let values: Vec<String> = values.iter().copied().map(shown).collect();
        writeln!(table, "{}", format!("{kind} {name}: {} {more}", values.join(" ")).trim_end()).unwrap();
    };
    for own in summary.analysis.iter().flat_map(|analysis| &analysis.values) {
        line("nominal", &own.output, &[own.nominal], "");
        for (method, lower, upper, _) in &own.bounds {
            line(method, &own.output, &[*lower, *upper], "");
        }
    }
    for own in &summary.reduced {
        line("reduced, nominal", &own.name, &[own.nominal], "");
        for band in &own.bands {
            line(&format!("reduced, {}", band.method), &own.name, &[band.lower, band.upper], "");
        }
    }
    for own in &summary.requirements {
        line("margin", &own.name, &[own.margin], own.verdict.name());
    }
    if let Some(statistics) = &summary.statistics {
        for own in &statistics.summary.outputs {
            let ends = [own.worst_case[0], own.worst_case[1], own.linear, own.rss, own.mean.value, own.deviation.value];
            line("worst case, linear, RSS, mean, deviation", &own.output, &ends, "");
        }
        for own in statistics.summary.requirements.iter().chain(&statistics.summary.together) {
            line("yield, Cpk", &own.requirement, &[own.share, own.cpk.unwrap_or(f64::NAN)], "");
        }
    }
    table
}

#[test]
fn answers_match_the_snapshots() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../../snapshots/answers");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/examples");
    for file in ["kinematics", "statics", "modes", "tolerance_stack", "four_bar_drawing"] {
        for description in load_all(&examples.join(file).with_extension("yaml")) {
            settings.set_description(format!("docs/examples/{file}.yaml"));
            let (_, summary) = run_methods(&description, None);
            settings.bind(|| insta::assert_snapshot!(file, table(&summary)));
        }
    }
}
