//! Units that a model declares hold in all that people read: tables, messages, reports and legends. Files for programs
//! stay in SI.

use std::fs;

use serde_json::Value;

use super::place::Place;

const INCH: f64 = 0.0254;

/// A falling ball, y = −g t²/2 with g ± 1 %, which meets none of its limits.
const FALL: &str = "
model: fall
parameters: { g: 9.81 m/s^2 ± 1%, m: 500 g ± 2% }
bodies: { ball: { mass: m, coordinates: [y] } }
effects: { weight: { gravity: { acceleration: [0, -g] } } }
initial: { ball.y: 0, ball.vy: 0 }
outputs:
  y: { formula: ball.y, unit: in }
  deepest: { min: y, unit: in }
requirements: { stays: y >= -1 m, shallow: deepest >= -1 m }
simulation: { duration: 0.5 s, step: 1e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 3 } }
";

/// Words of the first line that begins with `beginning`.
#[track_caller]
fn words<'t>(text: &'t str, beginning: &str) -> Vec<&'t str> {
    let line = text.lines().map(str::trim).find(|line| line.starts_with(beginning));
    line.unwrap_or_else(|| panic!("{beginning} in\n{text}")).split_whitespace().collect()
}

/// The number before a word.
#[track_caller]
fn before(words: &[&str], word: &str) -> f64 {
    let index = words.iter().position(|own| *own == word).unwrap_or_else(|| panic!("{word} in {words:?}"));
    words[index - 1].parse().unwrap_or_else(|_| panic!("a number before {word} in {words:?}"))
}

#[track_caller]
fn is_near(found: f64, wanted: f64) {
    assert!((found - wanted).abs() <= 1e-4 * wanted.abs(), "{found}, not {wanted}");
}

/// The margin of a motion that reaches −1.01 g/8, in inches.
fn margin() -> f64 {
    (1.0 - 1.01 * 9.81 / 8.0) / INCH
}

#[test]
fn margins_and_violations_have_the_unit_of_the_output() {
    let place = Place::new();
    fs::write(place.path().join("fall.yaml"), FALL).unwrap();
    let (output, _) = place.run("run fall.yaml --junit verdicts.xml", 4);
    for requirement in ["stays", "shallow"] {
        let line = words(&output, &format!("{requirement} "));
        let place = line.iter().position(|word| *word == "violated").unwrap();
        is_near(line[place + 1].parse().unwrap(), margin());
        assert_eq!(line[place + 3], "in", "{line:?}");
        let line = words(&output, &format!("{requirement} is violated"));
        is_near(before(&line, "in:"), -margin());
    }
    let summary = fs::read_to_string(place.path().join("results/fall/summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    let own = &summary["requirements"][0];
    is_near(own["margin"].as_f64().unwrap(), INCH * margin());
    assert_eq!((own["unit"].as_str(), own["display"]["unit"].as_str()), (Some("m"), Some("in")));
    let parameter = &summary["parameters"][1];
    assert_eq!((parameter["nominal"].as_f64(), parameter["display"]["unit"].as_str()), (Some(0.5), Some("g")));
    let xml = fs::read_to_string(place.path().join("verdicts.xml")).unwrap();
    let text = words(&xml, "margin: ");
    is_near(before(&text, "in,"), margin());
}

#[test]
fn the_reports_tables_are_in_declared_units() {
    let place = Place::new();
    fs::write(place.path().join("fall.yaml"), FALL).unwrap();
    place.run("run fall.yaml", 4);
    let page = fs::read_to_string(place.path().join("results/fall/report.html")).unwrap();
    // Numbers of a section's cells, with their unit.
    let cells = |class: &str, unit: &str| -> Vec<f64> {
        let start = page.find(&format!("<section class=\"{class}\">")).unwrap();
        let section = &page[start..start + page[start..].find("</section>").unwrap()];
        let unit = format!("&#8239;{unit}");
        let ends = section.match_indices(&unit).map(|(end, _)| end);
        ends.map(|end| section[..end].rsplit(['>', ' ', '(']).next().unwrap().parse().unwrap_or(f64::NAN)).collect()
    };
    is_near(cells("requirements", "in")[0], margin());
    is_near(cells("reduced", "in")[0], -9.81 / 8.0 / INCH);
    is_near(cells("bounds", "in")[0], -1.01 * 9.81 / 8.0 / INCH);
    assert_eq!(cells("parameters", "g"), [500.0, 490.0, 510.0]);
}

#[test]
fn sweeps_are_in_declared_units() {
    let place = Place::new();
    fs::write(place.path().join("fall.yaml"), FALL).unwrap();
    let output = place.command("sweep fall.yaml --set").arg("g=9..10:2 m/s^2 ± 1%").output().unwrap();
    let table = String::from_utf8(output.stdout).unwrap();
    let line = words(&table, "g=9 m/s^2");
    is_near(line[3].parse().unwrap(), -1.01 * 9.0 / 8.0 / INCH);
    assert_eq!(line[5], "in", "{line:?}");
    let line = words(&table, "margin of shallow");
    is_near(before(&line, "in"), (1.0 - 1.01 * 9.0 / 8.0) / INCH);
    let csv = fs::read_to_string(place.path().join("results/fall/sweep.csv")).unwrap();
    let second: Vec<&str> = csv.lines().nth(1).unwrap().split(',').collect();
    is_near(second[2].parse().unwrap(), -1.01 * 9.0 / 8.0);
}

#[test]
fn tables_of_one_configuration_are_in_declared_units() {
    let place = Place::new();
    let model = "
model: hang
analysis: statics
parameters: { k: { value: 2, unit: kN/m, tolerance: 5% } }
bodies: { load: { mass: 1, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  s: { spring_damper: { between: [ground, load], along: y, stiffness: k, free_length: 0 } }
outputs: { sag: { formula: load.y, unit: in } }
bounds: { chebyshev: { order: 5 } }
";
    fs::write(place.path().join("hang.yaml"), model).unwrap();
    let (output, _) = place.run("run hang.yaml", 0);
    let line = words(&output, "sag ");
    assert_eq!(line[1], "in", "{line:?}");
    is_near(line[2].parse().unwrap(), -9.81 / 2000.0 / INCH);
    is_near(line[3].parse().unwrap(), -9.81 / 1900.0 / INCH);
    let csv = fs::read_to_string(place.path().join("results/hang/statics.csv")).unwrap();
    assert!(csv.lines().nth(1).unwrap().starts_with("sag,m,-0.0049"), "{csv}");
}

#[test]
fn responses_are_over_hertz_and_in_the_unit_of_their_output() {
    let place = Place::new();
    // Nearly undamped: an order of 2 does not follow the resonance through the tolerance.
    let model = "
model: ring
analysis: modes
modes: { at: equilibrium, number: 1, responses: { shake: { load: x, output: x, from: 1, to: 10, points: 19 } } }
parameters: { k: 1000 N/m ± 10% }
bodies: { a: { mass: 1, coordinates: [x] } }
effects: { s: { spring_damper: { between: [ground, a], along: x, stiffness: k, damping: 0.1, free_length: 0 } } }
outputs: { x: { formula: a.x, unit: mm } }
bounds: { chebyshev: { order: 2 } }
";
    fs::write(place.path().join("ring.yaml"), model).unwrap();
    let output = place.command("run ring.yaml").output().unwrap();
    assert!(output.status.code().is_some_and(|code| code == 0 || code == 3), "{output:?}");
    let plot = fs::read_to_string(place.path().join("results/ring/response.shake.svg")).unwrap();
    let note = plot.split("unreliable from ").nth(1).unwrap_or_else(|| panic!("nothing is unreliable:\n{plot}"));
    let note = note.split(')').next().unwrap();
    let (frequency, unit) = note.split_once(' ').unwrap();
    assert!(unit == "Hz" && (1.0..10.0).contains(&frequency.parse::<f64>().unwrap()), "{note}");
    assert!(plot.contains("mm/N"), "{plot}");
}
