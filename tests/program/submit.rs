//! `mbint submit --slurm`, with a program in place of `sbatch` that runs its last argument. Under a real Slurm:
//! `tests/cluster/slurm.sh`.

#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;

use super::place::Place;

/// Writes down its arguments, one a line, and runs its last one as a task of an array.
const SBATCH: &str = r#"#!/bin/bash
printf '%s\n' "$@" >>"$SUBMITTED"
for script; do :; done
SLURM_ARRAY_TASK_ID=0 bash "$script" >&2 || exit 1
echo 7
"#;

/// Plans a study in a folder of this name, and submits it; gives the exit status and the messages.
fn submitted(place: &Place, study: &str, results: &str) -> (Option<i32>, String) {
    let bin = place.path().join("bin");
    fs::create_dir_all(&bin).unwrap();
    fs::write(bin.join("sbatch"), SBATCH).unwrap();
    fs::set_permissions(bin.join("sbatch"), fs::Permissions::from_mode(0o755)).unwrap();
    place.model("crank");
    let planned = place.command("plan crank.yaml --at-once 0 -o").arg(study).output().unwrap();
    assert_eq!(planned.status.code(), Some(0), "{}", String::from_utf8_lossy(&planned.stderr));
    let mut command = place.command("submit --slurm -o");
    command.arg(results).arg(study).env("SUBMITTED", place.path().join("submitted"));
    command.env("PATH", format!("{}:{}", bin.display(), std::env::var("PATH").unwrap()));
    let done = command.output().unwrap();
    (done.status.code(), String::from_utf8_lossy(&done.stderr).into_owned())
}

#[test]
fn folders_may_have_names_with_shell_syntax() {
    for name in ["my study", "it's", "p%j 100%", "a\"b`date`", "$(touch made);&"] {
        let place = Place::new();
        let (status, errors) = submitted(&place, name, &format!("results of {name}"));
        assert_eq!(status, Some(0), "{name}: {errors}");
        assert!(place.path().join(format!("results of {name}/summary.json")).exists(), "{name}: {errors}");
        let asked = fs::read_to_string(place.path().join("submitted")).unwrap();
        let study = place.path().join(name).display().to_string();
        let log = format!("--output={}/logs/round-1-merge-%j.log", study.replace('%', "%%"));
        assert!(asked.lines().any(|line| line == log), "{log}: {asked}");
        assert!(!place.path().join("made").exists());
        // The directives for Slurm in a script have no path.
        for script in ["round-1-array.sh", "round-1-merge.sh"] {
            let text = fs::read_to_string(place.path().join(name).join(script)).unwrap();
            let directives: Vec<&str> = text.lines().filter(|line| line.starts_with("#SBATCH")).collect();
            assert!(directives.iter().all(|line| !line.contains('/')), "{directives:?}");
        }
    }
}

#[test]
fn names_unusable_by_slurm_are_refused_before_submission() {
    for (study, results) in
        [("a\ntouch made\n", "out"), ("study", "b\n#SBATCH"), ("c\\d", "out"), ("e\u{1b}[31m", "out")]
    {
        let place = Place::new();
        let (status, errors) = submitted(&place, study, results);
        assert_eq!(status, Some(2), "{study:?}: {errors}");
        assert!(errors.contains("Slurm does not take a path with"), "{errors}");
        assert!(!place.path().join("submitted").exists() && !place.path().join("made").exists());
    }
}
