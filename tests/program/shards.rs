//! `mbint plan`, `shard`, `status`, `merge` and `run --store`: whatever is cut, lost or damaged, the results are those
//! of `mbint run`.

use std::fs;
use std::path::Path;

use super::place::Place;

/// A pendulum, alone and in a shorter scene; with a reduced output, an adaptive surrogate and a scan.
const PENDULUM: &str = "
model: pendulum
parameters:
  length: { value: 1, unit: m, tolerance: 5 mm }
  mass: { value: 1, unit: kg, tolerance: 1% }
bodies: { bob: { mass: mass, coordinates: [x, y] } }
joints: { rod: { distance: { between: [ground, bob], length: length } } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { bob.y: 0, bob.vy: 0 }
guess: { bob.x: -1 }
outputs: { x: bob.x, tension: rod.force, pull: { max: rod.force } }
simulation: { duration: 0.6 s, step: 5e-3, output_step: 2e-2 }
bounds: { tolerance: 1e-3, chebyshev: {}, scan: { points: 9 } }
scenes: { whole: {}, short: { simulation: { duration: 0.3 s } } }
";

/// Number of shards in a study's plan.
fn shards(place: &Place, study: &str) -> usize {
    let plan = fs::read_to_string(place.path().join(study).join("plan.json")).unwrap();
    serde_json::from_str::<serde_json::Value>(&plan).unwrap()["shards"].as_array().unwrap().len()
}

/// All files below a folder with their bytes, by path.
fn tree(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            found.extend(tree(&path).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else {
            found.push((name, fs::read(&path).unwrap()));
        }
    }
    found.sort();
    found
}

/// Runs rounds of shards, the last first, until the study is merged, which ends with a status; how many there were.
fn finish(place: &Place, study: &str, status: i32) -> usize {
    for round in 1..100 {
        for index in (0..shards(place, study)).rev() {
            place.run(&format!("shard {study} --index {index}"), 0);
        }
        assert_eq!(place.run(&format!("status {study} --missing"), 0).0, "\n");
        let plan = fs::read_to_string(place.path().join(study).join("plan.json")).unwrap();
        assert!(plan.contains(&format!("\"round\": {round},")), "{plan}");
        let merged = place.command(&format!("merge {study} -o {study}-results -q")).output().unwrap();
        match merged.status.code() {
            Some(found) if found == status => return round,
            Some(75) => assert!(String::from_utf8_lossy(&merged.stdout).starts_with("another round: ")),
            found => panic!("{found:?}: {}", String::from_utf8_lossy(&merged.stderr)),
        }
    }
    panic!("the study never ends");
}

/// Shards have samples only: merging them proves, and writes the same certificate. The tension is unknown at first.
#[test]
#[ignore = "2 s"]
fn merged_shards_have_the_certificate_of_a_run() {
    let place = Place::new();
    fs::write(place.path().join("pendulum.yaml"), PENDULUM).unwrap();
    place.run("run pendulum.yaml -o direct -q --certify", 3);
    place.run("plan pendulum.yaml -o study --at-once 0 --certify", 0);
    finish(&place, "study", 3);
    let direct = tree(&place.path().join("direct"));
    assert!(direct.iter().any(|(name, _)| name.ends_with("certificate.jsonl")));
    assert_eq!(direct, tree(&place.path().join("study-results")));
}

#[test]
fn merged_shards_equal_the_run() {
    let place = Place::new();
    fs::write(place.path().join("pendulum.yaml"), PENDULUM).unwrap();
    place.run("run pendulum.yaml -o direct -q", 0);
    let (output, _) = place.run("plan pendulum.yaml -o study --at-once 0", 0);
    assert!(output.contains("on the disk in study"), "{output}");
    assert!(finish(&place, "study", 0) > 1);
    assert_eq!(tree(&place.path().join("direct")), tree(&place.path().join("study-results")));

    // Short parts are simulated when planning and merging.
    place.run("plan pendulum.yaml -o small", 0);
    assert_eq!(shards(&place, "small"), 0);
    assert_eq!(finish(&place, "small", 0), 1);
    assert_eq!(tree(&place.path().join("direct")), tree(&place.path().join("small-results")));
}

#[test]
fn missing_shards_are_reported() {
    let place = Place::new();
    fs::write(place.path().join("pendulum.yaml"), PENDULUM).unwrap();
    place.run("plan pendulum.yaml -o study --at-once 0", 0);
    let (output, _) = place.run("status study", 75);
    assert!(output.starts_with("round 1: of 2 shards, 0-1 are missing\n"), "{output}");
    let (_, errors) = place.run("merge study", 1);
    assert!(errors.contains("shards 0-1 are missing; run them first"), "{errors}");
    let (_, errors) = place.run("shard study --index 2", 2);
    assert!(errors.contains("there is no shard 2; there are: 0 to 1"), "{errors}");
    let (_, errors) = place.run("status nowhere", 1);
    assert!(errors.contains("there is no folder nowhere, so there is no study in it"), "{errors}");
    fs::create_dir(place.path().join("other")).unwrap();
    let (_, errors) = place.run("merge other", 1);
    assert!(errors.contains("the folder other has no plan.json, so there is no study in it"), "{errors}");
    let (_, errors) = place.run("merge pendulum.yaml", 1);
    assert!(errors.contains("pendulum.yaml is a file, not a folder"), "{errors}");
    let (_, errors) = place.run("report other", 2);
    assert!(errors.contains("the folder other has no summary.json, so there are no results to show"), "{errors}");

    // The model has changed.
    fs::write(place.path().join("pendulum.yaml"), PENDULUM.replace("value: 1,", "value: 1.1,")).unwrap();
    let (_, errors) = place.run("shard study --index 0", 1);
    assert!(errors.contains("the model has changed since the study was planned; plan it again"), "{errors}");
}

#[test]
fn run_continues_from_stored_parts() {
    let place = Place::new();
    fs::write(place.path().join("pendulum.yaml"), PENDULUM).unwrap();
    place.run("run pendulum.yaml -o direct -q", 0);
    place.run("run pendulum.yaml -o first -q --store kept", 0);
    assert_eq!(tree(&place.path().join("direct")), tree(&place.path().join("first")));
    let parts = place.path().join("kept/parts");
    let names = place.files("kept/parts");
    assert!(names.len() > 4, "{names:?}");

    // One part is lost, one is damaged, and of one there is half.
    fs::remove_file(parts.join(&names[0])).unwrap();
    let mut bytes = fs::read(parts.join(&names[1])).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(parts.join(&names[1]), &bytes).unwrap();
    let bytes = fs::read(parts.join(&names[2])).unwrap();
    fs::write(parts.join(&names[2]), &bytes[..bytes.len() / 2]).unwrap();
    let (output, _) = place.run("run pendulum.yaml -o second --store kept --scene whole", 0);
    assert!(output.contains("parts from kept, "), "{output}");
    place.run("run pendulum.yaml -o second -q --store kept", 0);
    assert_eq!(tree(&place.path().join("direct")), tree(&place.path().join("second")));
    assert_eq!(place.files("kept/parts"), names);
}

/// A pendulum whose reduced outputs need simulations of their own: Taylor's method has none of its samples for them.
#[test]
fn simulations_for_reduced_outputs_are_always_counted() {
    let place = Place::new();
    let bounds = "bounds: { tolerance: 1e-3, chebyshev: {}, scan: { points: 9 } }";
    let text = PENDULUM.replace(bounds, "bounds: { taylor: { order: 2 } }");
    assert_ne!(text, PENDULUM);
    fs::create_dir(place.path().join("models")).unwrap();
    fs::write(place.path().join("models/pendulum.yaml"), text).unwrap();
    place.run("run models/pendulum.yaml -o direct -q", 0);
    let direct = tree(&place.path().join("direct"));
    let summary = fs::read_to_string(place.path().join("direct/whole/summary.json")).unwrap();
    assert!(summary.contains("reduced outputs"), "{summary}");
    for folder in ["stored", "resumed"] {
        place.run(&format!("run models/pendulum.yaml -o {folder} -q --store kept"), 0);
        assert_eq!(direct, tree(&place.path().join(folder)), "{folder}");
    }
    place.run("plan models/pendulum.yaml -o study --at-once 0", 0);
    finish(&place, "study", 0);
    assert_eq!(direct, tree(&place.path().join("study-results")));
    // Merged elsewhere.
    fs::create_dir(place.path().join("elsewhere")).unwrap();
    let mut merge = place.command("merge ../study -o ../merged -q");
    let merged = merge.current_dir(place.path().join("elsewhere")).output().unwrap();
    assert_eq!(merged.status.code(), Some(0), "{}", String::from_utf8_lossy(&merged.stderr));
    assert_eq!(direct, tree(&place.path().join("merged")));
}

/// A ball thrown up: reduced outputs, requirements, statistics; its pull comes from a table.
const THROWN: &str = "
model: thrown
parameters:
  v: { value: 2, unit: m/s, tolerance: 60 mm/s, distribution: normal }
  m: { value: 1, unit: kg, tolerance: 2% }
bodies: { ball: { mass: m, coordinates: [y] } }
tables: { pull: { file: pull.csv, units: [s, N] } }
effects: { weight: { force: { on: ball, value: [0, -9.81*pull(t)] } } }
initial: { ball.y: 0, ball.vy: v }
outputs:
  y: ball.y
  peak: { max: y }
  up: { when: y >= 0.1 }
requirements:
  low: { output: peak, max: 0.2 m }
  below: y <= 0.3 m
statistics: { quantiles: [5%, 95%] }
simulation: { duration: 0.4, step: 1e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 3 }, scan: { points: 5 } }
";

const PULL: &str = "t,pull\n0,1\n1,1.1\n";

#[test]
fn merged_verdicts_and_statistics_equal_those_of_the_run() {
    let place = Place::new();
    fs::write(place.path().join("thrown.yaml"), THROWN).unwrap();
    fs::write(place.path().join("pull.csv"), PULL).unwrap();
    let overlay = "parameters: { m: 1.1 kg ± 1% }\n";
    fs::write(place.path().join("overlay.yaml"), overlay).unwrap();
    let asked = "thrown.yaml --with overlay.yaml --set v=2.05±1%";
    place.run(&format!("run {asked} -o direct -q"), 4);
    assert!(place.files("direct").iter().any(|name| name == "statistics.csv"));
    place.run(&format!("plan {asked} -o study --at-once 0"), 0);
    finish(&place, "study", 4);
    assert_eq!(tree(&place.path().join("direct")), tree(&place.path().join("study-results")));
}

/// Two that move on their own, with a question of each.
const APART: &str = "
parameters: { a: 0.1 m ± 5%, b: 0.2 m ± 5%, k: 40 N/m ± 3% }
bodies: { one: { mass: 1 kg, coordinates: [x] }, two: { mass: 2 kg, coordinates: [x] } }
effects:
  spring_one: { force: { on: one, value: [-k*one.x, 0] } }
  spring_two: { force: { on: two, value: [-50*two.x, 0] } }
initial: { one.x: a, one.vx: 0, two.x: b, two.vx: 0 }
outputs: { x: one.x, first: { when: one.x < 0 m }, least: { min: two.x } }
requirements: { early: first <= 0.26 s, above: two.x >= -0.3 m, room: least + 0.25 m >= 0 m }
simulation: { duration: 0.6 s, step: 5e-3, output_step: 2e-2 }
bounds: { chebyshev: { order: 2 } }
statistics: {}
";

#[test]
#[ignore = "2 s"]
fn merged_verdicts_of_parts_equal_those_of_the_run() {
    let place = Place::new();
    fs::write(place.path().join("apart.yaml"), APART).unwrap();
    place.run("run apart.yaml -o direct -q", 0);
    place.run("plan apart.yaml -o study --at-once 0", 0);
    finish(&place, "study", 0);
    assert_eq!(tree(&place.path().join("direct")), tree(&place.path().join("study-results")));
    let summary = fs::read_to_string(place.path().join("direct/summary.json")).unwrap();
    assert!(summary.contains("\"subsystems\""), "{summary}");
}

/// A throw that a part of the box takes to a stiff ceiling: motions are cut at events.
const CEILING: &str = "
model: ceiling
parameters: { v0: { value: 5, unit: m/s, tolerance: 10% }, H: 1.3 m, k: 1e5 N/m }
bodies: { ball: { mass: 1, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  ceiling: { force: { on: ball, value: [0, \"-k*max(ball.y - H, 0)\"] } }
initial: { ball.y: 0, ball.vy: v0 }
outputs: { y: ball.y, v: ball.vy, high: { max: ball.y }, hit: { when: ball.y > H } }
requirements: { low: high <= 1.4 m }
simulation: { duration: 0.6, step: 1e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 5 }, taylor: { order: 2 }, scan: { points: 40 } }
statistics: { samples: 1024 }
";

#[test]
#[ignore = "10 s"]
fn merged_bounds_through_events_equal_those_of_the_run() {
    let place = Place::new();
    fs::write(place.path().join("ceiling.yaml"), CEILING).unwrap();
    place.run("run ceiling.yaml -o direct -q", 0);
    let summary = fs::read_to_string(place.path().join("direct/summary.json")).unwrap();
    assert!(summary.contains("between events") && summary.contains("grazed_at"), "{summary}");
    place.run("plan ceiling.yaml -o study --at-once 0", 0);
    assert!(finish(&place, "study", 0) > 1);
    assert_eq!(tree(&place.path().join("direct")), tree(&place.path().join("study-results")));
}

/// Names of all parts of a plan.
fn parts(place: &Place, study: &str) -> Vec<String> {
    let plan = fs::read_to_string(place.path().join(study).join("plan.json")).unwrap();
    let plan: serde_json::Value = serde_json::from_str(&plan).unwrap();
    let shards = plan["shards"].as_array().unwrap();
    let names = shards.iter().flat_map(|shard| shard["parts"].as_array().unwrap());
    names.map(|name| name.as_str().unwrap().to_owned()).collect()
}

#[test]
fn parts_follow_every_file_of_the_model() {
    let place = Place::new();
    let write = |name: &str, text: &str| fs::write(place.path().join(name), text).unwrap();
    fs::create_dir(place.path().join("parts")).unwrap();
    // The included file has the name of the model, in another folder.
    let main = THROWN
        .replace("bodies: { ball: { mass: m, coordinates: [y] } }", "include: parts/thrown.yaml\ninstances: { far: { of: fall } }\nbodies: { ball: { mass: m, coordinates: [y] } }")
        .replace("  y: ball.y\n", "  y: ball.y\n  far: far.stone.y\n");
    let part = "
assemblies:
  fall:
    parameters: { g: { value: 9.81, unit: N, tolerance: 1% } }
    bodies: { stone: { mass: 1, coordinates: [y] } }
    effects: { weight: { force: { on: stone, value: [0, -g] } } }
    initial: { stone.y: 0, stone.vy: 0 }
";
    let files = [("thrown.yaml", main.as_str()), ("parts/thrown.yaml", part), ("pull.csv", PULL)];
    files.iter().for_each(|(name, text)| write(name, text));
    let mut known = vec![];
    let changes =
        [("", ""), ("thrown.yaml", "step: 1e-3"), ("parts/thrown.yaml", "value: 9.81"), ("pull.csv", "1,1.1")];
    for (number, (name, changed)) in changes.iter().enumerate() {
        for (file, text) in files.iter().filter(|(file, _)| file == name) {
            write(file, &text.replace(changed, &changed.replace('1', "2")));
            let (_, errors) = place.run("shard study0 --index 0", 1);
            assert!(errors.contains("the model has changed since the study was planned"), "{name}: {errors}");
        }
        place.run(&format!("plan thrown.yaml -o study{number} --at-once 0"), 0);
        let own = parts(&place, &format!("study{number}"));
        assert!(!own.is_empty() && own.iter().all(|part| !known.contains(part)), "{name}");
        known.extend(own);
        files.iter().for_each(|(name, text)| write(name, text));
    }
}

#[test]
fn files_of_a_killed_run_are_removed_by_the_next_run() {
    let place = Place::new();
    let long = THROWN.replace("step: 1e-3", "step: 1e-7").replace("requirements", "#").replace("  low", "#");
    let long = long.replace("  below", "#").replace("statistics:", "#");
    fs::write(place.path().join("long.yaml"), long).unwrap();
    fs::write(place.path().join("pull.csv"), PULL).unwrap();
    fs::write(place.path().join("pendulum.yaml"), PENDULUM).unwrap();
    let mut killed = place.command("sample long.yaml --design sobol:1000 --store kept -q").spawn().unwrap();
    let left_over = || {
        let names =
            fs::read_dir(place.path().join("kept/parts")).map(|entries| entries.flatten()).into_iter().flatten();
        names.filter(|entry| entry.file_name().to_string_lossy().starts_with(".part-")).count()
    };
    for _ in 0..6000 {
        if left_over() > 0 || killed.try_wait().unwrap().is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert_eq!(left_over(), 1);
    // A file that is being written stays.
    place.run("run pendulum.yaml --scene short -o first -q --store kept", 0);
    assert_eq!(left_over(), 1);
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert_eq!(left_over(), 1);
    place.run("run pendulum.yaml --scene short -o first -q --store kept", 0);
    assert_eq!(left_over(), 0);
}

#[test]
#[ignore = "2 s"]
fn disk_space_of_a_store_is_reported_beforehand() {
    let place = Place::new();
    fs::write(place.path().join("thrown.yaml"), THROWN).unwrap();
    fs::write(place.path().join("pull.csv"), PULL).unwrap();
    for options in ["", "--certify-time", "--method scan", "--method chebyshev"] {
        let _ = fs::remove_dir_all(place.path().join("kept"));
        let (_, reported) = place.run(&format!("run thrown.yaml -o out --store kept {options}"), 4);
        let reported = reported.lines().next().unwrap();
        let words = reported.strip_prefix("thrown: no parts in kept (0 B); this run's simulations take ").unwrap();
        let (number, unit) = words.strip_suffix(" on the disk at most").unwrap().split_once(' ').unwrap();
        assert_eq!(unit, "KiB", "{reported}");
        // A part has a hundred bytes or two in addition to its values.
        let at_most = 1024.0 * number.parse::<f64>().unwrap();
        let lengths = tree(&place.path().join("kept/parts"));
        let taken: usize = lengths.iter().map(|(_, bytes)| bytes.len().saturating_sub(1000)).sum();
        assert!(taken as f64 <= at_most && at_most < 4.0 * taken.max(4096) as f64, "{reported}: {taken}");
    }
    let (_, reported) = place.run("run thrown.yaml -o out --store kept", 4);
    assert!(reported.starts_with("thrown: 5 parts in kept (1"), "{reported}");
}

/// A rod that is shorter than the height of its crank's end reaches no block.
#[test]
#[ignore = "2 s"]
fn shards_omit_infeasible_samples() {
    let place = Place::new();
    let text = "
model: rod
parameters: { length: 1 m ± 2%, throw: 0.99 m ± 2% }
bodies:
  crank: { mass: 1, inertia: 0.1, points: { A: [0, 0], B: [throw, 0] } }
  rod: { mass: 1, inertia: 0.1, points: { B: [0, 0], C: [length, 0] } }
  block: { mass: 1, coordinates: [x] }
joints: { pin: { revolute: [ground, crank.A] }, knee: { revolute: [crank.B, rod.B] }, end: { revolute: [rod.C, block] } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { crank.angle: 80 deg, crank.angular_velocity: 0 }
guess: { rod.angle: -70 deg }
outputs: { x: block.x }
simulation: { duration: 0.2, step: 2e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 2 }, scan: { points: 5 } }
";
    fs::write(place.path().join("rod.yaml"), text).unwrap();
    let ran = place.command("run rod.yaml --skip-infeasible -o direct -q").output().unwrap();
    assert!(matches!(ran.status.code(), Some(0 | 3)), "{}", String::from_utf8_lossy(&ran.stderr));
    place.run("plan rod.yaml --skip-infeasible -o study --at-once 0", 0);
    finish(&place, "study", ran.status.code().unwrap());
    assert_eq!(tree(&place.path().join("direct")), tree(&place.path().join("study-results")));
}
