//! `mbint run` as JSON, watching its files, and reporting its progress.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use serde_json::Value;

use super::place::Place;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error} in\n{text}"))
}

#[test]
fn a_run_is_one_json_document() {
    let place = Place::new();
    place.model("crank");
    place.model("arm");
    let arm = fs::read_to_string(place.path().join("arm.yaml")).unwrap();
    fs::write(
        place.path().join("arm.yaml"),
        format!("{arm}\nscenes: {{ calm: {{}}, costly: {{ bounds: {{ scan: {{ points: 900 }} }} }} }}\n"),
    )
    .unwrap();
    let (output, errors) = place.run("run --format json crank.yaml arm.yaml", 2);
    assert!(errors.contains("arm/costly: ") && errors.contains("--yes"), "{errors}");
    let records = json(&output);
    let of =
        |key: &str| -> Vec<Value> { records.as_array().unwrap().iter().map(|record| record[key].clone()).collect() };
    assert_eq!(of("model"), ["crank", "arm/calm", "arm/costly"]);
    assert_eq!(of("file"), ["crank.yaml", "arm.yaml", "arm.yaml"]);
    assert_eq!(of("exit_code"), [0, 0, 2]);
    assert_eq!(of("folder"), [Value::from("results/crank"), "results/arm/calm".into(), Value::Null]);
    assert!(records[2]["error"].as_str().unwrap().contains("simulations"), "{output}");
    for record in &records.as_array().unwrap()[..2] {
        let written = place.path().join(record["folder"].as_str().unwrap()).join("summary.json");
        assert_eq!(record["summary"], json(&fs::read_to_string(written).unwrap()));
    }
    // A document also where nothing was run.
    fs::write(place.path().join("wrong.yaml"), "model: wrong\n").unwrap();
    let (output, errors) = place.run("run --format json wrong.yaml", 2);
    assert_eq!((json(&output), errors.contains("error[E0210]: a model needs")), (Value::Array(vec![]), true));
    place.run("run --format json --watch crank.yaml", 2);
}

/// A program that runs until it is ended, and the lines that it prints.
struct Watching {
    child: Child,
    lines: Receiver<String>,
}

impl Watching {
    fn begin(place: &Place, arguments: &str) -> Self {
        let mut child = place.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let (sender, lines) = channel();
        let output = child.stdout.take().unwrap();
        std::thread::spawn(move || {
            for line in BufReader::new(output).lines() {
                // The test may have ended.
                if line.map_or(true, |line| sender.send(line).is_err()) {
                    return;
                }
            }
        });
        Self { child, lines }
    }

    /// All lines up to the one that begins so.
    #[track_caller]
    fn until(&self, beginning: &str) -> String {
        let mut text = String::new();
        loop {
            let line = self.lines.recv_timeout(Duration::from_secs(120));
            let line = line.unwrap_or_else(|error| panic!("{error}: no `{beginning}` in\n{text}"));
            text += &format!("{line}\n");
            if line.starts_with(beginning) {
                return text;
            }
        }
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[cfg(unix)]
#[test]
#[ignore = "2 s"]
fn a_watched_model_is_run_again_when_its_files_change() {
    let place = Place::new();
    let file = |name: &str| place.path().join(name);
    let model = "
model: slide
parameters: { k: 40 N/m ± 5% }
tables: { push: { file: push.csv, columns: [time, force], units: [s, N] } }
bodies: { block: { mass: 2, coordinates: [x] } }
effects:
  spring: { spring_damper: { between: [ground, block], along: x, stiffness: k, damping: 1, free_length: 0.1 } }
  push: { force: { on: block, value: [push(t), 0] } }
initial: { block.x: 0.2 }
outputs: { x: block.x }
simulation: { duration: 0.2, step: 2e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 3 } }
";
    fs::write(file("slide.yaml"), model).unwrap();
    fs::write(file("push.csv"), "time,force\n0,0\n0.1,1\n0.2,0\n1,0\n").unwrap();
    let mut watching = Watching::begin(&place, "run --watch slide.yaml");
    let first = watching.until("watching ");
    assert!(first.contains("slide: ") && first.contains("x.chebyshev"), "{first}");
    assert!(first.ends_with("watching 2 files; Ctrl-C ends\n"), "{first}");

    fs::write(file("slide.yaml"), model.replace("mass: 2,", "mass: 2.5,")).unwrap();
    let again = watching.until("watching ");
    assert!(
        again.contains("slide: run again\n") && again.contains("before") && again.contains("x.chebyshev.upper"),
        "{again}"
    );

    fs::write(file("push.csv"), "time,force\n0,0\n0.1,30\n0.2,0\n1,0\n").unwrap();
    let again = watching.until("watching ");
    assert!(again.contains("x.nominal"), "{again}");

    fs::write(file("slide.yaml"), model.replace("mass: 2,", "mass: 2.5, ")).unwrap();
    let again = watching.until("watching ");
    assert!(again.contains("no bound moved by more than the stated errors"), "{again}");

    // An error is reported, and does not end it.
    fs::write(file("slide.yaml"), model.replace("mass: 2,", "mass: -2,")).unwrap();
    watching.until("watching ");
    fs::write(file("slide.yaml"), model).unwrap();
    watching.until("watching ");

    let id = watching.child.id().to_string();
    std::process::Command::new("kill").args(["-INT", &id]).status().unwrap();
    assert_eq!(watching.child.wait().unwrap().code(), Some(130));
    let mut errors = String::new();
    watching.child.stderr.take().unwrap().read_to_string(&mut errors).unwrap();
    assert!(errors.contains("must be positive"), "{errors}");
    assert!(place.path().join("results/slide/summary.json").exists());
    let (_, refused) = place.run("run --watch -", 2);
    assert!(refused.contains("--watch needs a file"), "{refused}");
}

#[test]
fn tables_have_units() {
    let place = Place::new();
    place.model("crank");
    let (output, _) = place.run("run crank.yaml", 0);
    let heading = output.lines().find(|line| line.contains("largest width")).unwrap();
    assert!(heading.trim_start().starts_with("bounds") && heading.trim_end().ends_with(" unit"), "{output}");
    let columns = json(&fs::read_to_string(place.path().join("results/crank/contributions.columns.json")).unwrap());
    let table = fs::read_to_string(place.path().join("results/crank/contributions.csv")).unwrap();
    let names: Vec<&str> =
        columns.as_array().unwrap().iter().map(|column| column["column"].as_str().unwrap()).collect();
    assert_eq!(table.lines().next().unwrap(), names.join(","));
    let bounds = json(&fs::read_to_string(place.path().join("results/crank/columns.json")).unwrap());
    let unit = |columns: &Value, quantity: &str| {
        let found = columns.as_array().unwrap().iter().find(|column| column["quantity"] == quantity);
        found.unwrap()["unit"].clone()
    };
    assert_eq!(unit(&columns, "width_without"), unit(&bounds, "upper"));
    assert_eq!(unit(&columns, "total"), "1");
}

/// Spans of a profile cover the run one after the other, and the results are the same bytes.
#[test]
fn a_profile_has_the_stages_of_each_subsystem() {
    let place = Place::new();
    let two = "
model: two
parameters: { m: { value: 1, unit: kg, tolerance: 5% } }
bodies:
  a: { mass: m, coordinates: [x] }
  b: { mass: 2*m, coordinates: [x] }
effects:
  pull_a: { force: { on: a, value: [1 N, 0 N] } }
  pull_b: { force: { on: b, value: [1 N, 0 N] } }
outputs: { a: a.x, b: b.x }
simulation: { duration: 0.1, step: 1e-3, output_step: 0.01 }
bounds: { chebyshev: { order: 2 }, scan: { points: 3 } }
";
    fs::write(place.path().join("two.yaml"), two).unwrap();
    place.run("run two.yaml -q -o plain", 0);
    let (_, table) = place.run("run two.yaml -q -o profiled --profile trace.json", 0);
    for row in
        ["reading and checking models", "compiling", "nominal motion", "chebyshev", "scan", "writing files", "in all"]
    {
        assert!(table.contains(row), "{row} in\n{table}");
    }
    let bounds = |folder: &str| fs::read(place.path().join(folder).join("bounds.csv")).unwrap();
    assert_eq!(bounds("plain"), bounds("profiled"));

    let trace = json(&fs::read_to_string(place.path().join("trace.json")).unwrap());
    let events: Vec<&Value> =
        trace["traceEvents"].as_array().unwrap().iter().filter(|event| event["ph"] == "X").collect();
    let scans: Vec<_> = events.iter().filter(|event| event["name"] == "scan").map(|event| &event["tid"]).collect();
    assert_eq!(scans, [1, 2], "a scan of each subsystem in {events:?}");
    let time = |event: &Value, key: &str| event[key].as_u64().unwrap();
    for pair in events.windows(2) {
        let gap = time(pair[1], "ts").abs_diff(time(pair[0], "ts") + time(pair[0], "dur"));
        assert!(gap < 50, "{gap} µs between {} and {}", pair[0], pair[1]);
    }
    let (_, errors) = place.run("run two.yaml -q -o none --profile nowhere/trace.json", 2);
    assert!(errors.contains("nowhere/trace.json") && !place.path().join("none").exists(), "{errors}");
}
