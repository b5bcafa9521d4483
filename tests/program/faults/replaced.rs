//! Results are replaced as one: by runs that are killed, by files that cannot be replaced, and only those that are
//! ours.

#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::place::Place;

/// A mass that is pushed, with `outputs` outputs.
fn pushed(place: &Place, outputs: usize) {
    let outputs: Vec<String> = (0..outputs).map(|number| format!("o{number}: \"{}*b.x\"", number + 1)).collect();
    let text = format!(
        "model: pushed\n\
         parameters: {{ m: 1 kg ± 1% }}\n\
         bodies: {{ b: {{ mass: m, inertia: 1, coordinates: [x] }} }}\n\
         effects: {{ f: {{ force: {{ on: b, value: [1, 0] }} }} }}\n\
         outputs: {{ {} }}\n\
         simulation: {{ duration: 0.01, step: 1e-3 }}\n\
         bounds: {{ chebyshev: {{ order: 1 }} }}\n",
        outputs.join(", ")
    );
    fs::write(place.path().join("pushed.yaml"), text).unwrap();
}

/// Visible files of a folder, by name.
fn seen(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let files = entries.filter(|path| path.is_file()).map(|path| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        (name, fs::read(path).unwrap())
    });
    files.filter(|(name, _)| !name.starts_with('.')).collect()
}

/// Kills runs of two variants in turn while they write over each other's results, each a little later after it began to
/// write. How many folders were whole, and how many had less than that.
fn killed(times: u32) -> (u32, u32) {
    let place = Place::new();
    pushed(&place, 120);
    let commands = ["run -q --no-report pushed.yaml", "run -q --no-report pushed.yaml --set m=3±1%"];
    let whole = ["a", "b"].map(|name| place.path().join(name));
    for (command, folder) in commands.iter().zip(["a", "b"]) {
        place.run(&format!("{command} -o {folder}"), 0);
    }
    let whole = whole.map(|folder| seen(&folder));
    assert!(whole[0].keys().eq(whole[1].keys()) && whole[0]["bounds.csv"] != whole[1]["bounds.csv"]);
    let out = place.path().join("out");
    place.run(&format!("{} -o out", commands[0]), 0);
    let is_written = || {
        let mut names = fs::read_dir(&out).unwrap().flatten().map(|entry| entry.file_name());
        names.any(|own| own.to_str().is_some_and(|own| own.starts_with(".mbint-") && own.ends_with(".tmp")))
    };
    let is_replaced = || out.join(".mbint-replacing").exists();
    let (mut complete, mut partial) = (0, 0);
    for kill in 0..times {
        let mut command = place.command(commands[(kill as usize + 1) % 2]);
        let mut run = command.args(["-o", "out"]).stderr(Stdio::null()).spawn().unwrap();
        // Two of three kills are aimed at the replacement itself, the others at the files that are written before.
        let (has_begun, wait): (&dyn Fn() -> bool, u32) =
            if kill % 3 == 0 { (&is_written, kill * 50) } else { (&is_replaced, kill * 37 % 100 * 40) };
        while run.try_wait().unwrap().is_none() && !has_begun() {}
        let begun = Instant::now();
        while begun.elapsed() < Duration::from_micros(wait.into()) {}
        run.kill().unwrap();
        run.wait().unwrap();
        let found = seen(&out);
        let of = |whole: &BTreeMap<String, Vec<u8>>| found.iter().all(|(name, text)| whole.get(name) == Some(text));
        assert!(of(&whole[0]) || of(&whole[1]), "{kill}: {:?}", found.keys());
        let is_whole = whole.contains(&found);
        assert!(is_whole || !found.contains_key("summary.json"), "{kill}: {:?}", found.keys());
        if is_whole {
            complete += 1
        } else {
            partial += 1
        }
        if !is_whole && kill % 4 == 0 {
            // Readers of the results find them whole.
            place.run("report out", 0);
            fs::remove_file(out.join("report.html")).unwrap();
            let found = seen(&out);
            assert!(whole.contains(&found), "{kill}: {:?}", found.keys());
        }
    }
    place.run(&format!("{} -o out", commands[0]), 0);
    assert_eq!(seen(&out), whole[0]);
    assert!(fs::read_dir(&out).unwrap().flatten().all(|entry| entry.path().is_file()), "nothing is left over");
    (complete, partial)
}

#[test]
#[ignore = "2 s"]
fn a_killed_run_leaves_no_mixture() {
    let (complete, partial) = killed(12);
    assert_eq!(complete + partial, 12);
}

#[test]
#[ignore = "300 runs"]
fn three_hundred_killed_runs_leave_no_mixture() {
    let (complete, partial) = killed(300);
    assert!(complete > 0 && partial > 0, "{complete}, {partial}: some while files changed their names, some not");
}

#[test]
fn a_folder_in_the_way_of_a_plot_keeps_all_older_results() {
    let place = Place::new();
    pushed(&place, 3);
    place.run("run -q pushed.yaml -o out", 0);
    let path = place.path().join("out/o1.svg");
    fs::remove_file(&path).unwrap();
    fs::create_dir(&path).unwrap();
    let before = seen(&place.path().join("out"));
    let (_, errors) = place.run("run -q pushed.yaml -o out --set m=3±1%", 1);
    assert!(errors.starts_with("error[E1010]: pushed: cannot write out/o1.svg: "), "{errors}");
    assert_eq!(seen(&place.path().join("out")), before);
}

/// The comparison of scenes is of one run: it goes before the first scene that it compares is replaced.
#[test]
fn comparison_never_mixes_results_of_runs() {
    let place = Place::new();
    pushed(&place, 2);
    let path = place.path().join("pushed.yaml");
    let text = fs::read_to_string(&path).unwrap();
    let scenes = "scenes: { one: {}, two: {} }\n";
    fs::write(&path, format!("{text}{scenes}")).unwrap();
    place.run("run -q pushed.yaml -o out", 0);
    assert!(place.files("out").contains(&"scenes.csv".to_owned()));
    // The second scene's results cannot be replaced.
    let plot = place.path().join("out/two/o1.svg");
    fs::remove_file(&plot).unwrap();
    fs::create_dir(&plot).unwrap();
    place.run("run -q pushed.yaml -o out --set m=3±1% --no-report", 1);
    let compared = fs::read_to_string(place.path().join("out/scenes.csv")).unwrap();
    assert!(!compared.contains("two,"), "{compared}");
}

/// Summaries and lists of scenes by others, and files of ours that were changed.
#[test]
fn only_files_that_a_run_has_written_are_removed() {
    let place = Place::new();
    pushed(&place, 3);
    let out = place.path().join("out");
    fs::create_dir_all(out.join("scene")).unwrap();
    let mine = ["notes.txt", "o7.svg", "scene/notes.txt", "scene/summary.json"];
    mine.iter().for_each(|name| fs::write(out.join(name), r#"{"model": "m", "files": ["notes.txt"]}"#).unwrap());
    let list = r#"{"schema": 1, "model": "pushed", "mbint": "0.1.0", "files": ["notes.txt", "o7.svg", "scenes.json"], "scenes": ["scene"]}"#;
    ["summary.json", "scenes.json"].iter().for_each(|name| fs::write(out.join(name), list).unwrap());
    place.run("run -q pushed.yaml -o out", 0);
    assert!(mine.iter().all(|name| out.join(name).exists()), "{:?}", place.files("out"));
    assert_eq!(fs::read_to_string(out.join("scenes.json")).unwrap(), list);
    // The next run does not write two plots, one of which was changed by hand.
    fs::write(out.join("o1.svg"), "mine").unwrap();
    pushed(&place, 1);
    place.run("run -q pushed.yaml -o out", 0);
    let files = place.files("out");
    assert!(files.contains(&"o1.svg".to_owned()) && !files.contains(&"o2.svg".to_owned()), "{files:?}");
    assert!(mine.iter().all(|name| out.join(name).exists()), "{files:?}");
}

/// A pipe in place of a summary has no end.
#[test]
fn a_pipe_in_the_way_of_results_is_not_read() {
    let place = Place::new();
    pushed(&place, 1);
    let out = place.path().join("out");
    fs::create_dir(&out).unwrap();
    for name in ["summary.json", ".mbint.json"] {
        assert!(Command::new("mkfifo").arg(out.join(name)).status().unwrap().success());
    }
    place.run("run -q pushed.yaml -o out", 0);
    assert!(out.join("summary.json").is_file());
}

#[test]
#[ignore = "2 s"]
fn more_files_than_may_be_open_are_written() {
    let place = Place::new();
    pushed(&place, 90);
    let run = "ulimit -n 48 && exec \"$MBINT\" run -q pushed.yaml -o out";
    let mut command = Command::new("sh");
    command.args(["-c", run]).env("MBINT", assert_cmd::cargo::cargo_bin!("mbint")).current_dir(place.path());
    let done = command.output().unwrap();
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(place.files("out").len() > 90);
    // If not even one can be opened, the system's own reason is named.
    for most in 3..16 {
        let run = format!("ulimit -n {most} && exec \"$MBINT\" run -q --threads 1 pushed.yaml -o few");
        let mut command = Command::new("sh");
        command.args(["-c", &run]).env("MBINT", assert_cmd::cargo::cargo_bin!("mbint")).current_dir(place.path());
        let errors = String::from_utf8_lossy(&command.output().unwrap().stderr).into_owned();
        assert!(!errors.contains("uncategorized"), "{most}: {errors}");
    }
}
