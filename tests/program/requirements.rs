//! Requirements and sweeps as commands: exit statuses, JUnit XML, tables, against free fall.

use std::fs;
use std::process::Command;

use super::place::Place;

/// A falling ball: y = −g t²/2, with g ± 1 %.
fn fall(place: &Place, limit: &str) {
    let text = format!(
        "
model: fall
parameters: {{ g: {{ value: 9.81, unit: m/s^2, tolerance: 1% }} }}
bodies: {{ ball: {{ mass: 1, coordinates: [y] }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -g] }} }} }}
initial: {{ ball.y: 0, ball.vy: 0 }}
outputs:
  y: ball.y
  deepest: {{ min: y, unit: mm }}
  late: {{ when: y <= -1 m }}
requirements:
  stays: y >= {limit}
  early: {{ output: late, max: 0.46 s }}
simulation: {{ duration: 0.5 s, step: 1e-3, output_step: 0.01 }}
bounds: {{ chebyshev: {{ order: 3 }} }}
"
    );
    fs::write(place.path().join("fall.yaml"), text).unwrap();
}

/// The numbers of a line of a CSV file that begins with these cells.
fn numbers(table: &str, beginning: &str) -> Vec<f64> {
    let line =
        table.lines().find(|line| line.starts_with(beginning)).unwrap_or_else(|| panic!("{beginning} in\n{table}"));
    line.split(',').filter_map(|cell| cell.parse().ok()).collect()
}

#[test]
fn margins_and_reduced_outputs_match_closed_forms() {
    let place = Place::new();
    fall(&place, "-1.3 m");
    let (output, errors) = place.run("run fall.yaml --junit verdicts.xml", 0);
    assert_eq!(errors, "");
    for text in ["stays", "holds", "deepest", "-1226", "mm"] {
        assert!(output.contains(text), "{text} in\n{output}");
    }
    let table = fs::read_to_string(place.path().join("results/fall/reduced.csv")).unwrap();
    let [nominal, lower, upper, error] = numbers(&table, "deepest,")[..] else { panic!("{table}") };
    // The table is in SI units.
    for (found, g) in [(nominal, 9.81), (lower, 9.81 * 1.01), (upper, 9.81 * 0.99)] {
        assert!((found + g / 8.0).abs() <= error + 1e-12, "{found} ± {error}");
    }
    let [nominal, lower, upper, error] = numbers(&table, "late,")[..] else { panic!("{table}") };
    for (found, g) in [(nominal, 9.81_f64), (lower, 9.81 * 1.01), (upper, 9.81 * 0.99)] {
        assert!((found - (2.0 / g).sqrt()).abs() <= error + 1e-6, "{found} ± {error}");
    }
    assert!(error < 1e-4, "{error}");
    let xml = fs::read_to_string(place.path().join("verdicts.xml")).unwrap();
    assert!(xml.contains("tests=\"2\"") && !xml.contains("<failure"), "{xml}");
}

#[test]
fn violation_ends_with_status_4_and_a_replay_command() {
    let place = Place::new();
    fall(&place, "-1.23 m");
    let (output, _) = place.run("run fall.yaml --junit verdicts.xml", 4);
    assert!(output.contains("violated"), "{output}");
    let xml = fs::read_to_string(place.path().join("verdicts.xml")).unwrap();
    assert_eq!((xml.matches("<testcase").count(), xml.matches("<failure").count()), (2, 1), "{xml}");
    // The command's parameters fail by themselves.
    let command = output.lines().find_map(|line| line.split_once("mbint run ")).expect("a command").1;
    let command = command.trim().trim_end_matches('`');
    let program = assert_cmd::cargo::cargo_bin!("mbint").display().to_string();
    let shell = format!("'{program}' run {command} -q -o shown");
    let ended = Command::new("sh").args(["-c", &shell]).current_dir(place.path()).status().unwrap();
    assert_eq!(ended.code(), Some(4), "{shell}");
}

#[test]
fn a_sweep_has_a_row_for_each_value() {
    let place = Place::new();
    fall(&place, "-1.3 m");
    place.run("sweep fall.yaml -o swept --set g=9.6..10:3", 0);
    let table = fs::read_to_string(place.path().join("swept/sweep.csv")).unwrap();
    assert_eq!(table.lines().count(), 4, "{table}");
    let heading: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let column = heading.iter().position(|cell| cell.starts_with("deepest")).unwrap();
    for (line, g) in table.lines().skip(1).zip([9.6, 9.8, 10.0]) {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells[0].parse::<f64>().unwrap(), g);
        assert!((cells[column].parse::<f64>().unwrap() + g / 8.0).abs() < 1e-9, "{line}");
    }
}

#[test]
fn undecided_requirement_ends_with_status_3_and_a_remedy() {
    let place = Place::new();
    // 0.25 m at least; the line through two nodes says 0.125 m.
    let text = "
model: square
parameters: { k: { value: 1, tolerance: 0.5 } }
bodies: { block: { mass: 1, coordinates: [x] } }
initial: { block.x: k^2*(1 m), block.vx: 0 }
outputs: { x: block.x }
requirements: { far: x >= 0.2 m }
simulation: { duration: 0.02, step: 0.01, output_step: 0.01 }
bounds: { chebyshev: { order: 1, expand: output }, budget: { solves: 40 } }
";
    fs::write(place.path().join("square.yaml"), text).unwrap();
    let (output, _) = place.run("run square.yaml -o out --junit verdicts.xml", 3);
    assert!(output.contains("far is undecided; it takes"), "{output}");
    let xml = fs::read_to_string(place.path().join("verdicts.xml")).unwrap();
    assert!(xml.contains("errors=\"1\"") && xml.contains("failures=\"0\""), "{xml}");
    // With the budget left as it is, the order is raised until it is decided.
    fs::write(place.path().join("square.yaml"), text.replace(", budget: { solves: 40 }", "")).unwrap();
    let (output, _) = place.run("run square.yaml -o out", 0);
    assert!(output.contains("holds") && output.contains("earlier round"), "{output}");
}

/// A mass on a spring, thrown from rest at v, is at most v/√k away: proven of the true motion, at rows and between;
/// of the scheme's, where certified bounds see every step, or the row that is asked for.
#[test]
fn certified_bounds_prove_requirements() {
    let place = Place::new();
    let rows = |step: &str, certify: &str| {
        let text = format!(
            "
model: thrown
parameters: {{ v: 2 m/s ± 10%, k: 100 N/m ± 5% }}
bodies: {{ ball: {{ mass: 1 kg, coordinates: [x] }} }}
effects: {{ spring: {{ spring_damper: {{ between: [ground, ball], along: x, stiffness: k, free_length: 0 }} }} }}
initial: {{ ball.x: 0, ball.vx: v }}
outputs: {{ x: ball.x, top: {{ max: ball.x }} }}
requirements:
  near: x <= 0.24 m
  there: {{ output: x, at: 0.1, min: 0.1 m, max: 0.2 m }}
  nearer: x <= 0.22 m
  peak: top <= 0.24 m
simulation: {{ duration: 0.2, step: 5e-3, output_step: {step} }}
bounds: {{ chebyshev: {{ order: 5 }} }}
"
        );
        fs::write(place.path().join("thrown.yaml"), text).unwrap();
        let (output, _) = place.run(&format!("run thrown.yaml {certify} -o out"), 4);
        let line = |name: &str| output.lines().find(|line| line.trim_start().starts_with(name)).unwrap().to_owned();
        let verdict = |name: &str| {
            let line = line(&format!("{name} "));
            ["holds, certified", "holds", "violated"].into_iter().find(|verdict| line.contains(verdict)).unwrap()
        };
        let verdicts = ["near", "there", "nearer", "peak"].map(verdict);
        let margin = 0.24 - 2.2 / 95.0_f64.sqrt();
        let cells: Vec<f64> = line("near ").split_whitespace().filter_map(|cell| cell.parse().ok()).collect();
        let &[.., found, error, _] = &cells[..] else { panic!("{output}") };
        assert!((found - margin).abs() <= error, "{found} ± {error} instead of {margin}");
        verdicts
    };
    let proven = ["holds, certified", "holds, certified", "violated", "holds"];
    assert_eq!(rows("5e-3", "--certify"), proven);
    assert_eq!(rows("0.01", "--certify"), proven);
    assert_eq!(rows("5e-3", "--certify=scheme"), proven);
    assert_eq!(rows("0.01", "--certify=scheme"), ["holds", "holds, certified", "violated", "holds"]);
}
