//! Stacks of dimensions at the command line: tables, figures, the report, and JSON.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::place::Place;

/// A place with an example of the documents.
fn with_example(name: &str) -> Place {
    let place = Place::new();
    let file = format!("{name}.yaml");
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/examples").join(&file);
    fs::copy(from, place.path().join(file)).unwrap();
    place
}

#[test]
fn a_run_shows_worst_case_sensitivities_and_capability() {
    let place = with_example("bearing_gap");
    let (printed, _) = place.run("run bearing_gap.yaml -o out", 4);
    let lines = [
        "bearing_gap: 4 uncertain dimensions",
        "gap     mm    5.00000e-1  2.48500e-1  7.51500e-1",
        "housing             +1  mm/mm              +0.1  mm          51.6 %  ########################",
        "sleeve              -1  mm/mm             -0.08  mm          33.1 %  ####################",
        "Cp 1.64, Cpk 0.94\n",
    ];
    for line in lines {
        assert!(printed.contains(line), "{line}\n{printed}");
    }
    let figures: Vec<String> = place.files("out").into_iter().filter(|name| name.ends_with(".svg")).collect();
    assert_eq!(figures, ["gap.chain.svg", "gap.histogram.svg", "gap.tornado.svg"]);
}

#[test]
fn the_report_has_the_chain_and_can_be_made_again() {
    let place = with_example("bearing_gap");
    place.run("run bearing_gap.yaml -o out", 4);
    let page = fs::read_to_string(place.path().join("out/report.html")).unwrap();
    for text in ["chain of gap, to scale", "gap by dimensions", "worst case and limits", "Parts that fail"] {
        assert!(page.contains(text), "{text}");
    }
    fs::remove_file(place.path().join("out/report.html")).unwrap();
    place.run("report out", 0);
    assert_eq!(fs::read_to_string(place.path().join("out/report.html")).unwrap(), page);
}

#[test]
fn summary_has_chains_and_statistics() {
    let place = with_example("bearing_gap");
    let (json, _) = place.run("run bearing_gap.yaml -o out --format json", 4);
    let summary: Value = serde_json::from_str(&json).unwrap();
    let written: Value =
        serde_json::from_str(&fs::read_to_string(place.path().join("out/summary.json")).unwrap()).unwrap();
    assert_eq!(written["analysis"]["kind"], "dimensions");
    assert_eq!(written["chains"][0]["output"], "gap");
    assert_eq!(written["statistics"]["outputs"][0]["sensitivities"][0]["parameter"], "housing");
    assert!(summary.to_string().contains("\"chains\""), "{summary}");
}

#[test]
fn mechanism_questions_are_refused_and_gradients_answered() {
    let place = with_example("overrunning_clutch");
    let (printed, _) = place.run("gradient overrunning_clutch.yaml -o out", 0);
    // 1/((e - c) sin φ) is 11.9105 deg/mm.
    assert!(printed.contains("-11.910"), "{printed}");
    for question in ["show", "explain", "cost"] {
        let (_, error) = place.run(&format!("{question} overrunning_clutch.yaml"), 2);
        assert!(error.contains("needs a mechanism, and here are formulas of dimensions alone"), "{error}");
    }
}

#[test]
fn a_dimension_is_set_and_swept_as_a_parameter() {
    let place = with_example("bearing_gap");
    let (printed, _) = place.run("run bearing_gap.yaml -o out --set housing=60.1mm±0.1mm", 0);
    assert!(printed.contains("gap     mm    6.00000e-1"), "{printed}");
}
