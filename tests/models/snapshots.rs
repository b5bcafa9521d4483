//! The bounds of every file of `models/`, as they were when they were last looked at: `snapshots/`.
//!
//! `cargo insta review` (or `INSTA_UPDATE=always cargo test --test models snapshots`) takes changes over. In CI a model
//! without a snapshot fails.

use std::fmt::Write as _;

use mbint::inner::results::{Bounds, OutputBounds};

use crate::common::{load_all, model_files, run_methods};
use crate::run_all::assert_complete;

/// Times that are shown of a run.
const TIMES: usize = 10;

/// Digits that are shown of an output's span.
const DIGITS: i32 = 5;

/// Decimals that show [`DIGITS`] digits of everything the output does.
fn decimals(output: &OutputBounds) -> usize {
    let bands = output.bands.iter().flat_map(|band| band.lower.iter().chain(&band.upper));
    let (least, greatest) =
        output.nominal.iter().chain(bands).fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), &value| {
            (least.min(value), greatest.max(value))
        });
    (DIGITS - 1 - (greatest - least).log10().floor() as i32).max(0) as usize
}

/// Two digits, however small. Results are the same to the bit on every machine, so that rounding does not turn them.
fn error(value: f64) -> String {
    format!("{value:.1e}")
}

fn table(bounds: &Bounds) -> String {
    let rows = bounds.times.len() - 1;
    let mut text = String::new();
    for output in &bounds.outputs {
        let decimals = decimals(output);
        let number = |value: f64| {
            let number = format!("{value:.decimals$}");
            // A rounded zero has no sign.
            let zero = number.trim_start_matches('-').bytes().all(|digit| matches!(digit, b'0' | b'.'));
            if zero { number.trim_start_matches('-').to_owned() } else { number }
        };
        let unit = if output.unit.is_empty() { String::new() } else { format!(" [{}]", output.unit) };
        writeln!(text, "{}{unit}", output.name).unwrap();
        write!(text, "{:>8} {:>12}", "t", "nominal").unwrap();
        for band in &output.bands {
            let method = band.method.name();
            for column in ["lower", "upper", "error"] {
                write!(text, " {:>15}", format!("{method}.{column}")).unwrap();
            }
        }
        text += "\n";
        for row in (0..TIMES).map(|place| (place + 1) * rows / TIMES) {
            write!(text, "{:>8} {:>12}", format!("{:.4}", bounds.times[row]), number(output.nominal[row])).unwrap();
            for band in &output.bands {
                for value in [number(band.lower[row]), number(band.upper[row]), error(band.error.total[row])] {
                    write!(text, " {value:>15}").unwrap();
                }
            }
            text += "\n";
        }
        text += "\n";
    }
    text
}

#[test]
fn bounds_are_those_of_the_snapshots() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    for path in model_files() {
        let file = path.file_stem().unwrap().to_string_lossy().into_owned();
        for description in load_all(&path) {
            // A scene's is called `door.windy`.
            let name = description.name.replace('/', ".");
            settings.set_description(format!(
                "models/{file}.yaml{}",
                description.name.replacen(&file, "", 1).replace('/', ", scene ")
            ));
            let (bounds, summary) = run_methods(&description, None);
            assert_complete(&description, &bounds, &summary);
            settings.bind(|| insta::assert_snapshot!(name, table(&bounds)));
        }
    }
}

#[test]
fn snapshots_belong_to_models() {
    let models: Vec<String> = model_files()
        .iter()
        .flat_map(|path| load_all(path))
        .map(|description| description.name.replace('/', "."))
        .collect();
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("snapshots");
    for entry in std::fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().file_name().to_string_lossy().into_owned();
        let Some(name) = file.strip_suffix(".snap") else { continue };
        assert!(models.iter().any(|model| model == name), "snapshots/{file} belongs to no model");
    }
}
