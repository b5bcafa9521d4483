//! Results are replaced as one: by runs that are killed, by files that cannot be replaced, and only those that are
//! ours.

#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

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

/// Two runs that write over each other's results, and the results of each.
struct Variants {
    place: Place,
    commands: [&'static str; 2],
    whole: [BTreeMap<String, Vec<u8>>; 2],
}

impl Variants {
    /// The folder `out` has the results of the first.
    fn new(outputs: usize) -> Self {
        let place = Place::new();
        pushed(&place, outputs);
        let commands = ["run -q --no-report pushed.yaml", "run -q --no-report pushed.yaml --set m=3±1%"];
        let whole = ["a", "b"].map(|name| place.path().join(name));
        for (command, folder) in commands.iter().zip(["a", "b"]) {
            place.run(&format!("{command} -o {folder}"), 0);
        }
        let whole = whole.map(|folder| seen(&folder));
        assert!(whole[0].keys().eq(whole[1].keys()) && whole[0]["bounds.csv"] != whole[1]["bounds.csv"]);
        place.run(&format!("{} -o out", commands[0]), 0);
        Self { place, commands, whole }
    }

    /// The command that writes the results of a variant into `out`.
    fn command(&self, variant: usize) -> Command {
        let mut command = self.place.command(self.commands[variant]);
        command.args(["-o", "out"]).stderr(Stdio::null());
        command
    }

    /// The variant whose results are in the folder, if they are whole.
    ///
    /// # Panics
    /// If files of both are there, or a summary without all others.
    fn check(&self, kill: usize) -> Option<usize> {
        let found = seen(&self.place.path().join("out"));
        let of = |whole: &BTreeMap<String, Vec<u8>>| found.iter().all(|(name, text)| whole.get(name) == Some(text));
        assert!(self.whole.iter().any(of), "{kill}: {:?}", found.keys());
        let variant = self.whole.iter().position(|whole| *whole == found);
        assert!(variant.is_some() || !found.contains_key("summary.json"), "{kill}: {:?}", found.keys());
        variant
    }

    /// Readers of the results find them whole.
    fn read(&self) {
        self.place.run("report out", 0);
        fs::remove_file(self.place.path().join("out/report.html")).unwrap();
    }

    /// A run that is not killed leaves nothing but its results.
    fn finish(&self, variant: usize) {
        self.place.run(&format!("{} -o out", self.commands[variant]), 0);
        let out = self.place.path().join("out");
        assert!(seen(&out) == self.whole[variant]);
        assert!(fs::read_dir(&out).unwrap().flatten().all(|entry| entry.path().is_file()), "nothing is left over");
    }
}

/// Kills at times of the clock, each a little later after the run began to write.
#[test]
#[ignore = "2 s"]
fn a_killed_run_leaves_no_mixture() {
    let variants = Variants::new(120);
    let out = variants.place.path().join("out");
    let is_written = || {
        let mut names = fs::read_dir(&out).unwrap().flatten().map(|entry| entry.file_name());
        names.any(|own| own.to_str().is_some_and(|own| own.starts_with(".mbint-") && own.ends_with(".tmp")))
    };
    for kill in 0..24 {
        let mut run = variants.command((kill + 1) % 2).spawn().unwrap();
        while run.try_wait().unwrap().is_none() && !is_written() {}
        std::thread::sleep(Duration::from_micros(kill as u64 * 200));
        run.kill().unwrap();
        run.wait().unwrap();
        variants.check(kill);
    }
    variants.finish(0);
}

/// A kill before each change of the file system that a run makes: independent of the speed of disk and processor.
#[test]
#[ignore = "300 runs"]
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn a_run_killed_at_any_change_of_its_folder_leaves_no_mixture() {
    let variants = Variants::new(12);
    let library = variants.place.path().join("killed.so");
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/program/faults/killed.c");
    let compiled = Command::new("gcc").args(["-shared", "-fPIC", "-O1", "-o"]).arg(&library).arg(source).status();
    assert!(compiled.unwrap().success());
    // Folders with the older results, with parts of either, and with the newer ones.
    let (mut older, mut partial, mut newer) = (0, 0, 0);
    for kill in 1.. {
        variants.finish(0);
        let mut command = variants.command(1);
        let ended = command.env("LD_PRELOAD", &library).env("KILLED_AT", kill.to_string()).status().unwrap();
        let found = variants.check(kill);
        if ended.success() {
            assert_eq!(found, Some(1));
            break;
        }
        assert_eq!(ended.signal(), Some(9), "{kill}");
        match found {
            Some(0) => older += 1,
            Some(_) => newer += 1,
            None => partial += 1,
        }
        if found.is_some() {
            continue;
        }
        // Whoever finds a part completes it: a reader, or a run, which may be killed as well.
        if kill % 4 == 0 {
            variants.read();
            assert_eq!(variants.check(kill), Some(1), "{kill}");
        } else {
            let mut command = variants.command(0);
            let _ = command.env("LD_PRELOAD", &library).env("KILLED_AT", (kill / 2).to_string()).status().unwrap();
            variants.check(kill);
        }
    }
    // All files of 12 outputs are set aside and replaced, and their journal is removed file by file.
    let files = variants.whole[0].len();
    assert!(older > files && partial >= 2 * files - 2 && newer > files, "{files} files: {older}, {partial}, {newer}");
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
