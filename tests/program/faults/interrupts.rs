//! Ctrl-C, and worse.

#![cfg(unix)]

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::place::Place;

/// A model whose methods take long enough to be interrupted.
fn long(place: &Place) {
    place.model("crank");
    let path = place.path().join("crank.yaml");
    let text = fs::read_to_string(&path).unwrap();
    let slow = text.replace("duration: 0.1, step: 1e-3", "duration: 4, step: 1e-4").replace("points: 3", "points: 200");
    assert_ne!(text, slow);
    fs::write(path, slow).unwrap();
}

fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

fn begin(place: &Place, arguments: &str) -> Child {
    place.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Sends a signal when standard error reports this stage, and awaits the end, which would come minutes later. Returns
/// the status, and the text of standard error.
pub(super) fn interrupted(place: &Place, arguments: &str, stage: &str, name: &str) -> (Option<i32>, String) {
    let mut run = begin(place, arguments);
    let mut told = String::new();
    let mut errors = BufReader::new(run.stderr.take().unwrap());
    while !told.contains(stage) {
        assert!(errors.read_line(&mut told).unwrap() > 0, "{told}");
    }
    signal(&run, name);
    let asked = Instant::now();
    let status = run.wait().unwrap().code();
    assert!(asked.elapsed() < Duration::from_secs(10), "{:?}", asked.elapsed());
    errors.read_to_string(&mut told).unwrap();
    (status, told)
}

#[test]
#[ignore = "5 s"]
fn ctrl_c_writes_finished_results() {
    let place = Place::new();
    long(&place);
    let (status, errors) = interrupted(&place, "run --yes crank.yaml -o out", "crank: scan", "-INT");
    assert_eq!(status, Some(130), "{errors}");
    assert!(errors.contains("error: crank: interrupted"), "{errors}");
    let table = fs::read_to_string(place.path().join("out/bounds.csv")).unwrap();
    // The scan of 40 000 samples was not done: its columns, if any, are marked as unknown.
    let (heading, last) = (table.lines().next().unwrap(), table.lines().last().unwrap());
    assert!(heading.starts_with("t,angle.nominal"), "{heading}");
    assert!(last.starts_with("4,"), "{last}");
    assert!(!heading.contains("scan") || (last.contains("NaN") && last.contains("angle.scan")), "{last}");
    assert!(fs::read_to_string(place.path().join("out/summary.json")).unwrap().contains("interrupted"));
}

/// The reference of a study of costs takes seconds, and without it nothing is measured.
#[test]
fn a_study_of_costs_ends_at_a_ctrl_c() {
    let place = Place::new();
    long(&place);
    let run = begin(&place, "cost -q crank.yaml -o out");
    std::thread::sleep(Duration::from_millis(700));
    signal(&run, "-INT");
    let ended = run.wait_with_output().unwrap();
    let errors = String::from_utf8(ended.stderr).unwrap();
    assert_eq!(
        (ended.status.code(), errors.as_str()),
        (Some(130), "error: crank: interrupted before any setting was finished\n")
    );
    assert_eq!(place.files("out"), Vec::<String>::new());
}

/// Compiling a long chain takes many seconds, and ends when it is asked to.
#[test]
#[ignore = "2 s"]
fn compiling_ends_at_a_ctrl_c() {
    let place = Place::new();
    let mut text = "bodies:\n".to_owned();
    for link in 0..12_000 {
        text += &format!("  b{link}: {{ mass: 0.2, inertia: 1e-3, points: {{ a: [-0.1, 0], b: [0.1, 0] }} }}\n");
    }
    text += "joints:\n  j0: { revolute: [ground, b0.a] }\n";
    for link in 1..12_000 {
        text += &format!("  j{link}: {{ revolute: [b{}.b, b{link}.a] }}\n", link - 1);
    }
    text += "outputs: { x: b11999.x }\nsimulation: { duration: 0.1, step: 1e-3 }\n";
    fs::write(place.path().join("chain.yaml"), text).unwrap();
    let check = begin(&place, "check chain.yaml");
    std::thread::sleep(Duration::from_millis(1500));
    signal(&check, "-INT");
    let ended = check.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(130), "{ended:?}");
    assert!(ended.stdout.is_empty());
}

/// A spring with 199 quantiles of 10 000 rows, which take a minute: a stage is reported after ten seconds.
fn quantiles(place: &Place) {
    let shares: Vec<String> = (1..200).map(|share| format!("{}", f64::from(share) / 200.0)).collect();
    let text = format!(
        "model: spring\n\
         parameters: {{ k: {{ interval: [9, 11], unit: N/m, distribution: normal }} }}\n\
         bodies: {{ block: {{ mass: 1, coordinates: [x] }} }}\n\
         effects: {{ spring: {{ spring_damper: {{ between: [ground, block], along: x, stiffness: k, free_length: 0 }} }} }}\n\
         initial: {{ block.x: 1 }}\n\
         outputs: {{ x: block.x, v: block.vx }}\n\
         simulation: {{ duration: 10, step: 1e-3, output_step: 1e-3 }}\n\
         statistics: {{ quantiles: [{}] }}\n\
         bounds: {{ chebyshev: {{ order: 3 }} }}\n",
        shares.join(", ")
    );
    fs::write(place.path().join("spring.yaml"), text).unwrap();
}

/// Statistics are a stage of their own after the bounds, which are written.
#[test]
#[ignore = "5 s"]
fn statistics_end_at_a_sigterm() {
    let place = Place::new();
    quantiles(&place);
    let arguments = "run --yes --no-report spring.yaml -o out";
    let (status, told) = interrupted(&place, arguments, "spring: statistics of outputs", "-TERM");
    assert_eq!(status, Some(130), "{told}");
    assert!(told.contains("error: spring: interrupted before statistics were done"), "{told}");
    let table = fs::read_to_string(place.path().join("out/bounds.csv")).unwrap();
    assert!(!table.contains("NaN"), "bounds are done");
}

/// While another run writes into the folder, this is reported; after an interruption results are written into a folder
/// next to it.
#[test]
fn waiting_for_a_folder_ends_at_a_ctrl_c() {
    let place = Place::new();
    place.model("crank");
    let out = place.path().join("out");
    fs::create_dir(&out).unwrap();
    for is_interrupted in [false, true] {
        let folder = fs::File::open(&out).unwrap();
        folder.lock().unwrap();
        let mut run = begin(&place, "run -q --yes crank.yaml -o out");
        let mut errors = BufReader::new(run.stderr.take().unwrap());
        let mut told = String::new();
        errors.read_line(&mut told).unwrap();
        assert_eq!(told, "waiting for another run that writes into out\n");
        if is_interrupted {
            fs::remove_file(out.join("bounds.csv")).unwrap();
            signal(&run, "-INT");
            assert_eq!(run.wait().unwrap().code(), Some(130));
            assert!(!out.join("bounds.csv").exists());
            assert!(place.path().join("out.interrupted/bounds.csv").exists());
        } else {
            drop(folder);
            assert_eq!(run.wait().unwrap().code(), Some(0));
            assert!(out.join("bounds.csv").exists());
        }
    }
}

#[test]
fn a_second_ctrl_c_does_not_wait() {
    let place = Place::new();
    long(&place);
    let run = begin(&place, "run -q --yes crank.yaml -o out");
    std::thread::sleep(Duration::from_millis(700));
    for _ in 0..20 {
        signal(&run, "-INT");
    }
    assert_eq!(run.wait_with_output().unwrap().status.code(), Some(130));
}

/// Killed at any moment, a run leaves whole files or none; the next one works.
#[test]
#[ignore = "2 s"]
fn killed_run_leaves_no_partial_files() {
    let place = Place::new();
    place.model("crank");
    place.run("run -q crank.yaml -o whole", 0);
    let whole = fs::read(place.path().join("whole/bounds.csv")).unwrap();
    let mut written = 0;
    for trial in 0..40_u64 {
        let mut run = begin(&place, "run -q --yes crank.yaml -o out");
        std::thread::sleep(Duration::from_millis(3 * trial));
        // It may be over.
        let _ = run.kill();
        run.wait().unwrap();
        let out = place.path().join("out");
        if let Ok(table) = fs::read(out.join("bounds.csv")) {
            assert!(table == whole, "after {} ms", 3 * trial);
            written += 1;
        }
        if out.join("summary.json").exists() {
            assert!(["bounds.csv", "angle.svg", "force.svg"].iter().all(|name| out.join(name).exists()));
        }
        let _ = fs::remove_dir_all(out);
    }
    println!("{written} of 40 had written");
    place.run("run -q --yes crank.yaml -o out", 0);
}

#[test]
fn run_never_prompts_on_a_terminal() {
    let place = Place::new();
    place.model("crank");
    let mut command = place.command("run crank.yaml");
    command.stdin(Stdio::null()).env_clear().env("LC_ALL", "nonsense.KOI8-R").env("TERM", "dumb");
    let done = command.output().unwrap();
    assert_eq!((done.status.code(), String::from_utf8(done.stderr).unwrap().as_str()), (Some(0), ""));
    let all_closed = "exec \"$0\" run crank.yaml -o closed <&- >&- 2>&-";
    let mut command = Command::new("sh");
    command.args(["-c", all_closed]).arg(assert_cmd::cargo::cargo_bin!("mbint")).current_dir(place.path());
    assert_eq!(command.status().unwrap().code(), Some(0));
    let [with, without] = ["results/crank", "closed"].map(|dir| fs::read(place.path().join(dir).join("bounds.csv")));
    assert_eq!(with.unwrap(), without.unwrap());
}

/// Nobody has to wait ten minutes to learn that a request was too large.
#[test]
fn costly_run_is_refused_before_it_begins() {
    let place = Place::new();
    long(&place);
    let begun = Instant::now();
    let (_, errors) = place.run("run -q crank.yaml -o out", 2);
    assert!(
        errors.contains(" simulations are asked for") && errors.contains("--yes") && errors.contains("tolerance"),
        "{errors}"
    );
    assert!(begun.elapsed().as_secs() < 30 && place.files("out").is_empty());
    let path = place.path().join("crank.yaml");
    let text = fs::read_to_string(&path).unwrap();
    let allowed = text
        .replace("bounds:", "bounds:\n  budget: { solves: 50000 }")
        .replace("duration: 4, step: 1e-4", "duration: 0.02, step: 1e-3");
    fs::write(&path, allowed).unwrap();
    place.run("run -q crank.yaml -o out", 0);
}
