//! The table of analyses and questions: every question is asked in every analysis, and the results are those of the
//! table.

use std::fs;
use std::path::Path;

use crate::place::Place;

const PAGE: &str = include_str!("../../docs/reference/analyses.md");

/// Rows of the table, without its headings: a question and its cells.
fn table() -> Vec<Vec<String>> {
    let cells = |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().replace('`', "")).collect();
    let table = PAGE.split("| question |").nth(1).unwrap().split("\n\n").next().unwrap();
    table.lines().skip(2).map(cells).collect()
}

/// An oscillator of k/m = 400 1/s² on a driven carriage: further keys and the body of the model, the name of an output,
/// and a limit.
struct Analysis {
    keys: &'static str,
    body: &'static str,
    output: &'static str,
    limited: &'static str,
}

const PLAIN: &str = "bodies: { block: { mass: m, coordinates: [x] } }
effects: { spring: { spring_damper: { between: [ground, block], along: x, stiffness: k, damping: 0.4, free_length: 0.1 } } }";

/// In the order of the columns.
const ANALYSES: [Analysis; 7] = [
    Analysis {
        keys: "simulation: { duration: 0.2, step: 2e-3, output_step: 0.02 }\ninitial: { block.x: 0.2, block.vx: 0 }",
        body: PLAIN,
        output: "x",
        limited: "x <= 0.3 m",
    },
    Analysis {
        keys: "analysis: kinematics\nsimulation: { duration: 0.2, output_step: 0.02 }",
        body: "bodies: { block: { coordinates: [x] } }\njoints: { rail: { prismatic: { between: [ground, block], axis: x } }, drive: { motor: { on: rail, position: t*(0.4 m/s)*k/(400 N/m)*m/(1 kg) } } }",
        output: "x",
        limited: "x <= 0.3 m",
    },
    Analysis { keys: "analysis: statics", body: PLAIN, output: "stability", limited: "stability >= 300" },
    Analysis {
        keys: "analysis: modes\nmodes: { at: equilibrium, number: 1 }",
        body: PLAIN,
        output: "mode1.frequency",
        limited: "mode1.frequency <= 4",
    },
    Analysis {
        keys: "analysis: modes\nmodes: { at: motion, number: 1 }\nsimulation: { duration: 0.2, step: 2e-3, output_step: 0.02 }\ninitial: { block.x: 0.2, block.vx: 0 }",
        body: PLAIN,
        output: "mode1.frequency",
        limited: "mode1.frequency <= 4",
    },
    Analysis {
        keys: "analysis: modes\nmodes: { at: equilibrium, number: 1, responses: { drive: { load: x, output: x, from: 1, to: 20, points: 4 } } }",
        body: PLAIN,
        output: "mode1.frequency",
        limited: "drive.amplitude <= 1",
    },
    Analysis { keys: "analysis: dimensions", body: "", output: "x", limited: "x <= 0.3 m" },
];

/// Text of an analysis's model with a question.
fn asked(question: &str, analysis: &Analysis) -> String {
    let reduced = format!(", most: {{ max: {} }}", analysis.output);
    let statistics = "statistics: { samples: 16384, quantiles: [5%, 99.9%] }";
    let (outputs, further) = match question {
        question if question.starts_with("bounds") || question.contains("tolerances that matter") => {
            (String::new(), String::new())
        }
        question if question.contains("quantiles") && question.contains("reduced") => (reduced, statistics.to_owned()),
        question if question.contains("reduced") => (reduced, String::new()),
        question if question.contains("quantiles") => (String::new(), statistics.to_owned()),
        question if question.contains("share") => {
            (String::new(), format!("{statistics}\nrequirements: {{ holds: {} }}", analysis.limited))
        }
        _ => (String::new(), format!("requirements: {{ holds: {} }}", analysis.limited)),
    };
    let (keys, body) = (analysis.keys, analysis.body);
    // Without bodies there is nothing but the parameters.
    let observed = if body.is_empty() { "80 N / k" } else { "block.x" };
    format!(
        "model: asked
{keys}
parameters: {{ k: {{ value: 400, unit: N/m, tolerance: 5% }}, m: {{ value: 1, unit: kg, tolerance: 2% }} }}
{body}
outputs: {{ x: {observed}{outputs} }}
{further}
bounds: {{ chebyshev: {{ order: 3 }} }}
"
    )
}

fn read(place: &Place, file: &str) -> String {
    fs::read_to_string(place.path().join("out").join(file)).unwrap_or_default()
}

/// Asserts that a run yields the results of a cell of the table.
fn check(question: &str, cell: &str, analysis: &Analysis, column: usize) {
    let place = Place::new();
    let text = asked(question, analysis);
    fs::write(place.path().join("asked.yaml"), &text).unwrap();
    let case = format!("{question}, column {column}: {cell}\n{text}");
    if cell == "(1)" {
        let (_, error) = place.run("run asked.yaml -o out", 2);
        let reason = "a reduced output is one number a motion";
        assert!(PAGE.contains(reason) && error.contains(reason), "{case}\n{error}");
        return;
    }
    let (printed, _) = place.run("run asked.yaml -o out", 0);
    let summary: serde_json::Value = serde_json::from_str(&read(&place, "summary.json")).unwrap();
    match cell {
        "(2)" => {
            let heading = read(&place, "statistics.csv");
            assert!(!heading.is_empty() && !heading.contains("drive"), "{case}");
            assert!(PAGE.contains("2. A response is a curve of its own"));
        }
        "verdict" => {
            assert_eq!(summary["requirements"][0]["verdict"], "holds", "{case}\n{printed}");
        }
        "summary.json" => {
            let share = &summary["statistics"]["requirements"][0];
            assert_eq!(share["requirement"], "holds", "{case}");
            assert!(share["share"].as_f64().unwrap() > 0.99, "{case}");
        }
        file => {
            let lines = read(&place, file);
            assert!(lines.lines().count() > 1, "{case}\n{:?}", place.files("out"));
            let needed = match file {
                "response.csv" => "drive",
                "response_contributions.csv" => ",k,",
                "contributions.csv" => ".k.main",
                "reduced.csv" | "reduced_statistics.csv" => "most",
                _ => analysis.output,
            };
            assert!(lines.contains(needed) || file.starts_with("bounds"), "{case}\n{lines}");
            let quantile = !file.contains("statistics") || lines.contains("q0.999");
            assert!(quantile, "{case}\n{lines}");
        }
    }
}

#[test]
#[ignore = "4 s"]
fn answers_to_all_questions_match_the_table() {
    let table = table();
    assert_eq!(table.len(), 7);
    for row in &table {
        assert_eq!(row.len(), 1 + ANALYSES.len(), "{row:?}");
        for (column, (cell, analysis)) in row[1..].iter().zip(&ANALYSES).enumerate() {
            assert!(!cell.is_empty(), "a cell without a reason: {row:?}");
            check(&row[0], cell, analysis, column);
        }
    }
    assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reference/analyses.md").exists());
}

/// Two lags of a filter have time constants and no frequency: the message names the existing results.
#[test]
fn refusal_of_a_missing_result_names_existing_results() {
    let place = Place::new();
    let analysis = Analysis {
        limited: "mode3.frequency >= 1",
        keys: "analysis: modes\nmodes: { at: equilibrium }",
        ..ANALYSES[3]
    };
    fs::write(place.path().join("asked.yaml"), asked("requirements", &analysis)).unwrap();
    for command in ["check asked.yaml", "run asked.yaml -o out"] {
        let (_, error) = place.run(command, 2);
        assert!(
            error.contains("this analysis has no result `mode3.frequency`") && error.contains("`mode1.frequency`"),
            "{error}"
        );
    }
}
