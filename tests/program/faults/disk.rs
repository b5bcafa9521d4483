//! Disks that are full or must not be written, and two runs into one folder.

use std::fs;
use std::process::{Command, Stdio};

use crate::place::Place;

/// Runs a script as the superuser of a name space of its own, in which it may mount.
#[cfg(target_os = "linux")]
fn with_mounts(place: &Place, script: &str) -> (i32, String) {
    fs::create_dir(place.path().join("small")).unwrap();
    let mut command = Command::new("unshare");
    command.args(["-rm", "sh", "-c", &format!("mount -t tmpfs -o size=64k tmpfs small && {script}")]);
    command.env("MBINT", assert_cmd::cargo::cargo_bin!("mbint")).current_dir(place.path());
    let done = command.output().unwrap();
    (done.status.code().unwrap(), String::from_utf8(done.stderr).unwrap())
}

#[cfg(target_os = "linux")]
#[test]
#[ignore = "mounts a file system"]
fn a_full_disk_gives_one_message_and_keeps_older_results() {
    let place = Place::new();
    place.model("crank");
    // The table fits; with all other files the disk is full.
    let script = "mkdir small/out && echo old > small/out/bounds.csv && head -c 45000 /dev/zero > small/rest; \
                  \"$MBINT\" run -q crank.yaml -o small/out; status=$?; ls -A small/out > left; \
                  cat small/out/bounds.csv > kept; exit $status";
    let (status, errors) = with_mounts(&place, script);
    assert_eq!(status, 1, "{errors}");
    assert_eq!((errors.lines().count(), errors.lines().last()), (2, Some("more: mbint explain E1010")), "{errors}");
    let message = "error[E1010]: crank: cannot write small/out/";
    assert!(errors.starts_with(message) && !errors.contains(".mbint-"), "{errors}");
    assert!(errors.to_lowercase().contains("space"), "{errors}");
    let read = |name: &str| fs::read_to_string(place.path().join(name)).unwrap();
    assert_eq!((read("left").as_str(), read("kept").as_str()), ("bounds.csv\n", "old\n"));
}

#[cfg(target_os = "linux")]
#[test]
#[ignore = "mounts a file system"]
fn a_read_only_folder_is_reported_before_the_run() {
    let place = Place::new();
    place.model("crank");
    let script = "mount -o remount,ro small && \"$MBINT\" run -q crank.yaml -o small/out";
    let (status, errors) = with_mounts(&place, script);
    assert_eq!(status, 2, "{errors}");
    assert!(errors.starts_with("error[E1010]: cannot write into the folder small/out: "), "{errors}");
    assert_eq!((errors.lines().count(), errors.lines().last()), (2, Some("more: mbint explain E1010")), "{errors}");
}

/// The results are those of one of the two.
#[test]
fn concurrent_runs_leave_the_files_of_one_run() {
    let place = Place::new();
    place.model("crank");
    let results = |folder: &str| {
        place.files(folder).into_iter().map(|name| fs::read(place.path().join(folder).join(name)).unwrap()).collect()
    };
    place.run("run -q crank.yaml -o long", 0);
    place.run("run -q crank.yaml -o short --set length=0.4±1%", 0);
    let expected: [Vec<Vec<u8>>; 2] = [results("long"), results("short")];
    assert_ne!(expected[0], expected[1]);
    for _ in 0..10 {
        let begin = |arguments: &str| place.command(arguments).stderr(Stdio::inherit()).spawn().unwrap();
        let runs = ["run -q crank.yaml -o both", "run -q crank.yaml -o both --set length=0.4±1%"].map(begin);
        for mut run in runs {
            assert!(run.wait().unwrap().success());
        }
        assert!(expected.contains(&results("both")));
    }
}
