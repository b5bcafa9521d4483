//! Parameters set on the command line, models from standard input, numbers that agree between commands, and the
//! provenance that results state.

use std::fs;
use std::io::Write;
use std::process::Stdio;

use super::place::Place;

/// Two slides that do not interact, a welded weight on one, and a third that no output depends on.
const SLIDES: &str = "
model: slides
parameters: { k: { value: 40, unit: N/m, tolerance: 5% }, m: { value: 1, unit: kg, tolerance: 2% } }
bodies:
  a: { mass: m, inertia: 0.1 }
  load: { mass: 0.5, inertia: 0.1 }
  b: { mass: 2, inertia: 0.1 }
  c: { mass: 3, inertia: 0.1 }
joints:
  first: { prismatic: { between: [ground, a], axis: [1, 0] } }
  tray: { fixed: [a, load] }
  second: { prismatic: { between: [ground, b], axis: [0, 1] } }
  third: { prismatic: { between: [ground, c], axis: [0, 1] } }
effects:
  spring: { spring_damper: { between: [ground, a], along: x, stiffness: k, damping: 1, free_length: 0.1 } }
  other: { spring_damper: { between: [ground, b], along: y, stiffness: k, damping: 1, free_length: 0.1 } }
outputs: { x: a.x, y: b.y }
simulation: { duration: 0.1, step: 5e-3, output_step: 0.02 FORMULATION }
bounds: { chebyshev: { order: 2 }, scan: { points: 2 } }
";

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error} in\n{text}"))
}

#[test]
fn check_and_run_name_the_same_numbers() {
    let place = Place::new();
    for (name, formulation, coordinates, constraints) in
        [("absolute", ", formulation: absolute", 6, 4), ("joint", ", formulation: joint", 2, 0)]
    {
        let model = SLIDES.replace("FORMULATION", formulation);
        fs::write(place.path().join(format!("{name}.yaml")), model).unwrap();
        let (told, _) = place.run(&format!("check {name}.yaml"), 0);
        let (ran, _) = place.run(&format!("run {name}.yaml -o {name}"), 0);
        let first = ran.lines().next().unwrap();
        assert!(first.starts_with(&format!("slides: {coordinates} {name} coordinates, ")), "{ran}");
        assert!(told.starts_with(&format!("ok {first}, ")), "{told}\n{ran}");
        assert!(told.contains("; the whole model has ") && told.contains("body c"), "{told}");
        let checked = &json(&place.run(&format!("check {name}.yaml --format json"), 0).0)[0];
        let summary = json(&fs::read_to_string(place.path().join(name).join("summary.json")).unwrap());
        for key in ["formulation", "coordinates", "constraints", "degrees_of_freedom"] {
            assert_eq!(checked[key], summary[key], "{key}");
        }
        assert_eq!((&summary["coordinates"], &summary["constraints"]), (&coordinates.into(), &constraints.into()));
    }
}

#[test]
fn parameters_are_set_for_every_command() {
    let place = Place::new();
    place.model("crank");
    let names = |json: serde_json::Value, key: &str| json[key].as_array().unwrap().len();
    let checked = |set: &str| json(&place.run(&format!("check crank.yaml --format json {set}"), 0).0)[0].clone();
    let all = names(checked(""), "uncertain_parameters");
    let parameter = checked("")["uncertain_parameters"][0].as_str().unwrap().to_owned();
    let set = format!("--set {parameter}=0.4");
    assert_eq!(names(checked(&set), "uncertain_parameters"), all - 1);
    let explained = json(&place.run(&format!("explain crank.yaml --format json {set}"), 0).0);
    assert_eq!(names(explained, "parameters"), all - 1);
    for command in ["check crank.yaml", "explain crank.yaml", "cost crank.yaml"] {
        let (_, errors) = place.run(&format!("{command} --set nothing=1"), 2);
        assert!(errors.contains("nothing"), "{command}: {errors}");
        let (_, errors) = place.run(&format!("{command} {set} {set}"), 2);
        assert!(errors.contains("is set twice"), "{command}: {errors}");
    }
}

#[test]
fn a_model_is_read_from_standard_input() {
    let place = Place::new();
    let given = |arguments: &str, text: &str| {
        let mut command = place.command(arguments);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // A command that is wrong does not read it.
        let _ = child.stdin.take().unwrap().write_all(text.as_bytes());
        let output = child.wait_with_output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
    };
    let model = SLIDES.replace("FORMULATION", "");
    let (status, output, errors) = given("check -", &model);
    assert_eq!((status, errors.as_str()), (0, ""));
    assert!(output.starts_with("ok slides: "), "{output}");
    let nameless = model.replace("model: slides\n", "");
    let (status, output, errors) = given("run - --set m=2 --method scan", &nameless);
    assert_eq!(status, 0, "{output}{errors}");
    let summary = json(&fs::read_to_string(place.path().join("results/stdin/summary.json")).unwrap());
    assert_eq!(summary["model_files"][0]["name"], "stdin");
    let (status, _, errors) = given("check -", &model.replace("mass: 3", "mass: -3"));
    assert!(status == 2 && errors.contains("--> stdin:8:"), "{errors}");
    let (status, _, errors) = given("check - -", &model);
    assert!(status == 2 && errors.contains("`-` is named twice"), "{errors}");
}

#[test]
fn new_makes_the_folders_of_its_model() {
    let place = Place::new();
    place.run("new parts/doors/front", 0);
    assert_eq!(place.files("parts/doors"), ["front.yaml"]);
    place.run("check parts/doors/front.yaml", 0);
    fs::write(place.path().join("taken"), "").unwrap();
    let (_, errors) = place.run("new taken/front", 2);
    assert!(errors.starts_with("error: cannot make the folder taken: "), "{errors}");
}

#[test]
fn results_of_removed_scenes_are_deleted() {
    let place = Place::new();
    let model =
        |text: &str| fs::write(place.path().join("slides.yaml"), SLIDES.replace("FORMULATION", "") + text).unwrap();
    let run = || place.run("run slides.yaml --method scan -q", 0);
    model("scenes: { one: {}, two: {}, three: { without: [x] } }\n");
    run();
    let all = ["one", "report.html", "scenes.csv", "scenes.json", "three", "two", "x.svg", "y.svg"];
    assert_eq!(place.files("results/slides"), all);
    fs::write(place.path().join("results/slides/two/mine.txt"), "").unwrap();
    // Only one of them has x now, and two are gone: files that their runs did not write stay.
    model("scenes: { one: {}, other: { without: [x] } }\n");
    run();
    assert_eq!(
        place.files("results/slides"),
        ["one", "other", "report.html", "scenes.csv", "scenes.json", "two", "y.svg"]
    );
    assert_eq!(place.files("results/slides/two"), ["mine.txt"]);
    // Scenes that were not requested stay.
    model("scenes: { one: {}, other: {}, more: {}, last: {} }\n");
    place.run("run slides.yaml --method scan -q --scene more --scene last", 0);
    assert!(place.path().join("results/slides/other/summary.json").exists());
    // Without scenes the model is run itself.
    model("");
    run();
    let files = place.files("results/slides");
    assert!(files.contains(&"bounds.csv".to_owned()) && !files.contains(&"scenes.csv".to_owned()), "{files:?}");
}

/// `printf abc | sha256sum`, of the standard's own example, is `ba7816bf…`: a model's hash is that of its bytes.
#[test]
fn results_state_their_provenance() {
    let place = Place::new();
    fs::write(place.path().join("slides.yaml"), SLIDES.replace("FORMULATION", "")).unwrap();
    place.run("run slides.yaml --set m=1.5 --method scan -o one", 0);
    let summary = json(&fs::read_to_string(place.path().join("one/summary.json")).unwrap());
    assert_eq!((&summary["schema"], &summary["mbint"]), (&1.into(), &env!("CARGO_PKG_VERSION").into()));
    let request = &summary["request"];
    assert_eq!((&request["set"][0], &request["methods"][0]), (&"m=1.5".into(), &"scan".into()));
    assert_eq!((&summary["outputs"][1]["name"], &summary["outputs"][1]["unit"]), (&"y".into(), &"m".into()));
    assert_eq!((&summary["errors"][0]["output"], &summary["errors"][0]["unit"]), (&"x".into(), &"m".into()));
    let file = &summary["model_files"][0];
    let peak = &summary["peaks"][0];
    assert_eq!((&peak["output"], &peak["unit"], &peak["method"]), (&"x".into(), &"m".into(), &"scan".into()));
    assert!(peak["greatest"]["error"].as_f64().unwrap() > 0.0 && peak["least"]["time"].is_number(), "{peak}");
    assert_eq!(file["name"], "slides.yaml");
    let hash = file["sha256"].as_str().unwrap();
    assert!(hash.len() == 64 && hash.bytes().all(|digit| digit.is_ascii_hexdigit()), "{hash}");
    if let Ok(output) = std::process::Command::new("sha256sum").arg(place.path().join("slides.yaml")).output() {
        assert!(output.stdout.starts_with(hash.as_bytes()), "{hash}");
    }
    // A column of the table, an object of the list.
    let columns = json(&fs::read_to_string(place.path().join("one/columns.json")).unwrap());
    let named: Vec<&str> =
        columns.as_array().unwrap().iter().map(|column| column["column"].as_str().unwrap()).collect();
    let table = fs::read_to_string(place.path().join("one/bounds.csv")).unwrap();
    assert_eq!(table.lines().next(), Some(named.join(",").as_str()));
    assert_eq!(
        (&columns[0]["unit"], &columns[2]["unit"], &columns[2]["method"]),
        (&"s".into(), &"m".into(), &"scan".into())
    );
}

#[test]
fn refused_scene_does_not_stop_later_scenes() {
    let place = Place::new();
    let scenes =
        "scenes: { one: {}, large: { bounds: { scan: { points: 200 } } }, last: { effects: { other: null } } }\n"
            .replace("{ effects: { other: null } }", "{ without: [other] }");
    fs::write(place.path().join("slides.yaml"), SLIDES.replace("FORMULATION", "") + &scenes).unwrap();
    let (output, errors) = place.run("run slides.yaml", 2);
    assert!(errors.contains("slides/large: ") && errors.contains("simulations are asked for"), "{errors}");
    assert!(output.contains("one/, last/") && output.contains("not run, or failed"), "{output}");
    assert!(place.path().join("results/slides/last/bounds.csv").exists());
}

#[test]
fn check_reports_why_a_model_is_spatial() {
    let place = Place::new();
    let text = "bodies: { bar: { mass: 1, inertia: 0.1, points: { A: [-0.5, 0] } } }
joints: { pivot: { revolute: [ground, bar.A] } }
effects: { weight: { gravity: { acceleration: [0, 0, -9.81] } } }
outputs: { x: bar.x }
simulation: { duration: 1, step: 1e-3 }
";
    let check = |text: &str| {
        fs::write(place.path().join("bar.yaml"), text).unwrap();
        (place.run("check bar.yaml", 0).0, json(&place.run("check bar.yaml --format json", 0).0)[0].clone())
    };
    let why = "`acceleration` of effect `weight` leaves the plane";
    let (told, data) = check(text);
    assert!(told.contains(&format!("  in space: {why}\n")), "{told}");
    assert_eq!(data["spatial_because"], why);
    for other in [text.replace("0, 0, -9.81", "0, -9.81"), format!("space: spatial\n{text}")] {
        let (told, data) = check(&other);
        assert!(!told.contains("in space") && data["spatial_because"].is_null(), "{told}");
    }
}

#[test]
fn unused_parts_are_listed_in_one_line() {
    let place = Place::new();
    let mut text = "bodies:\n  a: { mass: 1, coordinates: [x] }\n".to_owned();
    (0..30).for_each(|i| text += &format!("  b{i}: {{ mass: 1, inertia: 1 }}\n"));
    text += "parameters: { p: 1, q: 2, r: 3, s: 4 }\noutputs: { x: a.x }\nsimulation: { duration: 1, step: 1e-3 }\n";
    fs::write(place.path().join("many.yaml"), text).unwrap();
    let (told, warned) = place.run("check many.yaml", 0);
    assert!(told.contains("body b0, body b1, body b2, body b3, body b4 and 25 more"), "{told}");
    assert!(!told.contains("b29"), "{told}");
    assert_eq!(warned.matches("warning[W0701]: ").count(), 1, "{warned}");
    assert!(warned.contains("the same in 3 more places (also of `q`, `r`, `s`)"), "{warned}");
    let data = json(&place.run("check many.yaml --format json", 0).0);
    assert_eq!(data[0]["not_simulated"].as_array().unwrap().len(), 30);
}

/// Seconds are known where the steps are chosen, too.
#[test]
fn refused_run_reports_its_duration() {
    let place = Place::new();
    let text = SLIDES.replace("FORMULATION", "").replace("scan: { points: 2 }", "scan: { points: 300 }");
    for (steps, written) in [("fixed", text.clone()), ("chosen", text.replace("step: 5e-3,", "tolerance: 1e-6,"))] {
        fs::write(place.path().join("slides.yaml"), written).unwrap();
        let (_, errors) = place.run("run slides.yaml", 2);
        assert!(
            errors.contains(" simulations are asked for, which take ") && errors.contains(" or more on "),
            "{errors}"
        );
        assert!(!errors.contains("take 0 "), "{steps}: {errors}");
    }
}
