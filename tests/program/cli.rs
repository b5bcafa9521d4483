//! The command as a user meets it: its output, its files, and its exit status.

use std::fs;
use std::process::Stdio;

use super::place::Place;

#[test]
fn help_lists_every_command_and_exit_status() {
    let place = Place::new();
    let (help, errors) = place.run("--help", 0);
    for text in [
        "run",
        "check",
        "cost",
        "explain",
        "schema",
        "new",
        "snapshot",
        "man",
        "completions",
        "--color",
        "Exit codes:",
        "mbint new NAME",
    ] {
        assert!(help.contains(text), "{text} in\n{help}");
    }
    assert_eq!(errors, "");
    let (help, _) = place.run("run --help", 0);
    for text in ["--output", "--method", "--set", "--threads", "--quiet", "--timings", "bounds.csv", "summary.json"] {
        assert!(help.contains(text), "{text} in\n{help}");
    }
    let (version, _) = place.run("--version", 0);
    assert_eq!(version, format!("mbint {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn lists_of_the_language_are_text_and_json() {
    let place = Place::new();
    for (list, what) in
        [("units", "rpm"), ("functions", "atan2(y, x)"), ("outputs", "JOINT.force"), ("exit-codes", "130")]
    {
        let (text, _) = place.run(&format!("explain --{list}"), 0);
        assert!(text.contains(what), "{list}: {text}");
        let (json, _) = place.run(&format!("explain --{list} --format json"), 0);
        let rows: Vec<serde_json::Value> = serde_json::from_str(&json).unwrap();
        assert!(rows.len() > 4 && json.contains(what), "{list}: {json}");
    }
    place.run("explain --units --functions", 2);
    place.run("explain --units model.yaml", 2);
    place.run("explain", 2);
}

#[test]
fn wrong_arguments_are_distinguished_and_end_with_2() {
    let place = Place::new();
    for (arguments, message) in [
        ("", "Usage: mbint"),
        ("rnu", "unrecognized subcommand 'rnu'"),
        ("run", "<MODEL>..."),
        ("run a.yaml --method chebychev", "chebyshev"),
        ("run a.yaml --threads 0", "0 is not in 1..=1024"),
        ("run a.yaml --threads 70000", "70000 is not in 1..=1024"),
        ("run a.yaml --threads=-1", "-1 is not in 1..=1024"),
        ("run a.yaml --threads two", "invalid digit"),
        ("run a.yaml --set l1", "write `name=value`"),
        ("run a.yaml --set =1", "write `name=value`"),
        ("run a.yaml --set l1=", "write `name=value`"),
        ("run a.yaml --set l1=1 --set l1=2", "`l1` is set twice"),
        ("check a.yaml --format xml", "possible values: text, json"),
        ("check a.yaml --color sometimes", "possible values: auto, always, never"),
        ("completions tcsh", "possible values"),
        ("new 2d", "cannot name a model"),
        ("new a/", "cannot name a model"),
    ] {
        let (output, errors) = place.run(arguments, 2);
        assert!(errors.contains(message), "{arguments}: {errors}");
        assert_eq!(output, "", "{arguments}");
    }
    assert!(place.files("").is_empty());
}

#[test]
fn a_missing_model_ends_with_2_and_nothing_is_run() {
    let place = Place::new();
    place.model("crank");
    for command in ["run crank.yaml missing.yaml", "check crank.yaml missing.yaml", "explain missing.yaml"] {
        let (_, errors) = place.run(command, 2);
        assert!(errors.contains("missing.yaml"), "{command}: {errors}");
        assert!(errors.contains("error"), "{command}: {errors}");
    }
    assert_eq!(place.files(""), ["crank.yaml"]);
}

#[test]
fn new_model_is_valid_and_never_overwrites_a_file() {
    let place = Place::new();
    let (output, _) = place.run("new pendulum", 0);
    assert!(output.starts_with("pendulum.yaml\nnext: mbint run pendulum.yaml\n"), "{output}");
    let path = place.path().join("pendulum.yaml");
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains("\nmodel: pendulum\n"));
    let (output, errors) = place.run("check pendulum.yaml", 0);
    assert!(output.starts_with("ok pendulum: "), "{output}");
    assert_eq!(errors, "");

    fs::write(&path, "mine").unwrap();
    let (_, errors) = place.run("new pendulum.yaml", 2);
    assert_eq!(errors, "error: pendulum.yaml exists; it was left as it is\n");
    assert_eq!(fs::read_to_string(&path).unwrap(), "mine");
}

#[test]
fn run_writes_its_files_and_prints_their_folder() {
    let place = Place::new();
    place.model("crank");
    let (output, errors) = place.run("run crank.yaml --timings", 0);
    for text in ["crank: ", "method", "Newton iterations", "seconds", "chebyshev", "taylor", "scan", "bounds.csv"] {
        assert!(output.contains(text), "{text} in\n{output}");
    }
    assert_eq!(errors, "");
    let files = place.files("results/crank");
    for file in ["angle.svg", "bounds.csv", "summary.json"] {
        assert!(files.iter().any(|name| name == file), "{file} in {files:?}");
    }
    assert!(files.iter().all(|name| !name.ends_with(".tmp")), "{files:?}");
    let summary = || fs::read_to_string(place.path().join("results/crank/summary.json")).unwrap();
    assert!(summary().contains("\"seconds\""));

    let (output, errors) = place.run("run crank.yaml --quiet --method scan,chebyshev", 0);
    assert_eq!((output, errors), (String::new(), String::new()));
    assert!(!summary().contains("\"seconds\""), "only when asked for");
    assert!(!summary().contains("taylor"), "{}", summary());
    let table = fs::read_to_string(place.path().join("results/crank/bounds.csv")).unwrap();
    let heading = table.lines().next().unwrap();
    let expected = "t,angle.nominal,angle.chebyshev.lower,angle.chebyshev.upper,angle.chebyshev.error,angle.scan.lower";
    assert!(heading.starts_with(expected), "{heading}");
}

#[test]
fn unmet_tolerance_has_a_separate_exit_status() {
    let place = Place::new();
    place.model("crank");
    let path = place.path().join("crank.yaml");
    let text = fs::read_to_string(&path).unwrap();
    let bounds = text.find("bounds:").unwrap();
    fs::write(&path, format!("{}bounds: {{ tolerance: 1e-7, budget: {{ solves: 12 }} }}\n", &text[..bounds])).unwrap();
    let (_, errors) = place.run("run crank.yaml", 3);
    assert!(errors.contains("warning: crank: bounds of `angle.chebyshev` are unreliable from "), "{errors}");
    let table = fs::read_to_string(place.path().join("results/crank/bounds.csv")).unwrap();
    let (heading, last) = (table.lines().next().unwrap(), table.lines().last().unwrap());
    assert!(heading.ends_with(",unresolved") && last.contains(".chebyshev"), "{last}");
    assert!(place.files("results/crank").iter().any(|name| name == "contributions.csv"));
    // A parameter that the model does not have is reported.
    let (_, errors) = place.run("run crank.yaml --method chebyshev --set nothing=1", 2);
    assert!(errors.contains("nothing"), "{errors}");
}

#[test]
fn several_models_have_a_folder_each() {
    let place = Place::new();
    place.model("crank");
    place.model("arm");
    let (output, _) = place.run("run crank.yaml arm.yaml -o out", 0);
    assert!(output.find("crank: ") < output.find("\narm: "), "{output}");
    assert_eq!(place.files("out"), ["arm", "crank"]);
    place.run("run arm.yaml -o single -q", 0);
    assert!(place.path().join("single/bounds.csv").exists());

    fs::copy(place.path().join("arm.yaml"), place.path().join("other.yaml")).unwrap();
    let (_, errors) = place.run("run arm.yaml crank.yaml other.yaml -o both", 2);
    assert!(errors.starts_with("error: arm.yaml and other.yaml would both write the results of `arm`"), "{errors}");
    assert!(!place.path().join("both").exists(), "nothing was run");
}

#[test]
fn file_in_place_of_the_folder_is_reported_before_the_run() {
    let place = Place::new();
    place.model("crank");
    fs::write(place.path().join("taken"), "mine").unwrap();
    let (_, errors) = place.run("run crank.yaml -o taken", 2);
    assert_eq!(
        errors,
        "error[E1010]: cannot write into the folder taken: not a directory\nmore: mbint explain E1010\n"
    );
    assert_eq!(fs::read_to_string(place.path().join("taken")).unwrap(), "mine");
}

#[test]
fn json_has_one_object_per_model() {
    let place = Place::new();
    place.model("crank");
    let (output, errors) = place.run("check --format json crank.yaml missing.yaml", 2);
    assert_eq!(errors, "", "what is wrong stands in the JSON");
    let json: serde_json::Value = serde_json::from_str(&output).unwrap();
    assert_eq!(json[0]["file"], "crank.yaml");
    assert_eq!(json[0]["ok"], true);
    assert_eq!(json[0]["model"], "crank");
    assert_eq!(json[1]["ok"], false);
    assert!(json[1]["diagnostics"][0]["message"].is_string(), "{output}");

    let (output, _) = place.run("explain --format json crank.yaml", 0);
    let json: serde_json::Value = serde_json::from_str(&output).unwrap();
    assert_eq!(json["model"], "crank");
    assert!(json["instructions"]["factor"].is_u64() && json["newton"]["nonzeros"].is_u64());
    let (output, _) = place.run("explain crank.yaml", 0);
    assert!(output.starts_with("crank\n") && output.contains("Newton matrix"), "{output}");
}

#[test]
fn colors_are_shown_when_asked_for() {
    let place = Place::new();
    place.model("crank");
    let colored = |text: &str| text.contains('\u{1b}');
    assert!(!colored(&place.run("check crank.yaml", 0).0), "not into a pipe");
    assert!(colored(&place.run("check crank.yaml --color always", 0).0));
    assert!(colored(&place.run("--color=always rnu", 2).1));
    assert!(!colored(&place.run("--color never rnu", 2).1));
    let forced = place.command("--color never check crank.yaml").env("CLICOLOR_FORCE", "1").output().unwrap();
    assert!(!colored(&String::from_utf8(forced.stdout).unwrap()));
}

#[test]
fn completions_are_written_for_every_shell() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let (script, errors) = place.run(&format!("completions {shell}"), 0);
        assert!(script.contains("mbint") && script.contains("explain"), "{shell}");
        assert_eq!(errors, "", "{shell}");
    }
}

#[test]
fn the_schema_is_json() {
    let (schema, _) = Place::new().run("schema", 0);
    assert!(serde_json::from_str::<serde_json::Value>(&schema).unwrap().is_object());
}

/// A reader that has read enough is no failure, and does not keep a run from finishing.
#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_failure() {
    let place = Place::new();
    place.model("crank");
    place.model("arm");
    for arguments in
        ["--help", "completions bash", "schema", "check crank.yaml", "explain crank.yaml", "run crank.yaml arm.yaml"]
    {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let child = place.command(arguments).stdout(writer).stderr(Stdio::piped()).spawn().unwrap();
        let output = child.wait_with_output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!((output.status.code(), errors.as_str()), (Some(0), ""), "{arguments}");
    }
    assert!(place.path().join("results/arm/summary.json").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_a_failure() {
    let place = Place::new();
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = place.command("completions bash").stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(errors.starts_with("error: cannot write to standard output: "), "{errors}");
}

/// One sample of the scan is stopped by a brake that no other sample feels: at rest its force jumps in every step, and
/// the tolerance takes more steps than a sample may have.
#[test]
fn a_sample_beyond_the_tolerance_ends_with_3() {
    let place = Place::new();
    fs::write(place.path().join("brake.yaml"), include_str!("../common/brake.yaml")).unwrap();
    let (_, errors) = place.run("run brake.yaml -o out", 3);
    assert!(errors.contains("times the tolerance"), "{errors}");
    let csv = fs::read_to_string(place.path().join("out/bounds.csv")).unwrap();
    let flagged: Vec<bool> = csv.lines().skip(1).map(|row| row.ends_with("v.scan")).collect();
    // It comes to rest after 0.25 s.
    assert!(flagged[3..].iter().all(|&flagged| flagged), "{csv}");
}
