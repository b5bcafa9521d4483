//! The command runs, checks and explains scenes: all or those that are named, each in a folder of its own.

use std::collections::BTreeSet;
use std::fs;

use super::place::Place;
use super::scenes::explained;

/// A short model of two outputs, in three scenes.
fn door(place: &Place) {
    let text = "
model: door
parameters:
  mass: { value: 20, unit: kg, tolerance: 5% }
  rub: { value: 2, unit: N*m*s/rad, tolerance: 10% }
bodies: { leaf: { mass: mass, inertia: 1.4, points: { hinge: [-0.45, 0] } } }
joints: { hinge: { revolute: [ground, leaf.hinge] } }
effects:
  closer: { torsional_spring_damper: { on: hinge, stiffness: 9, damping: 9 } }
  friction: { joint_friction: { on: hinge, viscous: rub } }
initial: { hinge.angle: 1, hinge.angular_velocity: 0 }
outputs: { angle: hinge.angle }
simulation: { duration: 0.2, step: 2e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 2 }, scan: { points: 3 } }
scenes:
  ideal: { without: [friction] }
  friction: { outputs: { lost: friction.torque } }
  long: { extends: ideal, simulation: { duration: 0.4 }, bounds: { scan: { points: 4 } } }
";
    fs::write(place.path().join("door.yaml"), text).unwrap();
}

#[test]
fn scenes_are_run_separately_and_compared() {
    let place = Place::new();
    door(&place);
    let (output, errors) = place.run("run door.yaml", 0);
    assert_eq!(errors, "");
    let all = ["angle.svg", "friction", "ideal", "long", "report.html", "scenes.csv", "scenes.json"];
    assert_eq!(place.files("results/door"), all);
    for text in ["door: 3 scenes", "angle.chebyshev", "lost.chebyshev", "angle.scan", "seconds", "largest width"] {
        assert!(output.contains(text), "{text} in\n{output}");
    }
    assert!(
        output.ends_with("  results/door: angle.svg, scenes.csv, report.html, scenes.json; ideal/, friction/, long/\n"),
        "{output}"
    );
    let summary = fs::read_to_string(place.path().join("results/door/ideal/summary.json")).unwrap();
    assert!(summary.contains("\"model\": \"door/ideal\"") && !summary.contains("seconds"), "{summary}");

    // The long table agrees with the wide ones.
    let long = fs::read_to_string(place.path().join("results/door/scenes.csv")).unwrap();
    assert_eq!(long.lines().next(), Some("scene,output,unit,method,t,nominal,lower,upper,error,unresolved"));
    let rows: Vec<Vec<&str>> = long.lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 2 * 11 + 2 * 2 * 11 + 21);
    let mut seen = BTreeSet::new();
    for scene in ["ideal", "friction", "long"] {
        let wide = fs::read_to_string(place.path().join(format!("results/door/{scene}/bounds.csv"))).unwrap();
        let headings: Vec<&str> = wide.lines().next().unwrap().split(',').collect();
        let wide: Vec<Vec<&str>> = wide.lines().skip(1).map(|line| line.split(',').collect()).collect();
        for (place, row) in rows.iter().filter(|row| row[0] == scene).enumerate() {
            let of = &wide[place % wide.len()];
            let cell = |name: String| of[headings.iter().position(|heading| *heading == name).unwrap()];
            assert_eq!(row[4], of[0]);
            assert_eq!(row[5], cell(format!("{}.nominal", row[1])));
            for (column, end) in [(6, "lower"), (7, "upper"), (8, "error")] {
                assert_eq!(row[column], cell(format!("{}.{}.{end}", row[1], row[3])));
            }
            assert_eq!(row[9], "false");
            seen.insert(format!("{}.{}.{} {}", row[0], row[1], row[3], row[2]));
        }
    }
    let expected = [
        "friction.angle.chebyshev rad",
        "friction.angle.scan rad",
        "friction.lost.chebyshev N*m",
        "friction.lost.scan N*m",
        "ideal.angle.chebyshev rad",
        "ideal.angle.scan rad",
        "long.angle.scan rad",
    ];
    assert_eq!(seen.iter().map(String::as_str).collect::<Vec<_>>(), expected);
    // Only outputs of several scenes are overlaid; where methods differ, they are named.
    let svg = fs::read_to_string(place.path().join("results/door/angle.svg")).unwrap();
    assert!(["ideal (chebyshev)", "friction (chebyshev)", "long (scan)"].iter().all(|label| svg.contains(label)));

    let again = Place::new();
    door(&again);
    assert_eq!(again.run("run door.yaml -q -j 1", 0), (String::new(), String::new()));
    for file in ["scenes.csv", "angle.svg", "friction/summary.json", "friction/lost.svg"] {
        let read = |place: &Place| fs::read(place.path().join("results/door").join(file)).unwrap();
        assert!(read(&place) == read(&again), "{file}: the same bytes on any number of threads");
    }
}

#[test]
fn scenes_are_chosen_by_name() {
    let place = Place::new();
    door(&place);
    // One by itself is run as a model is.
    let (output, _) = place.run("run door.yaml --scene friction -o one --timings", 0);
    assert!(output.starts_with("door/friction: 1 joint coordinate,"), "{output}");
    assert_eq!(place.files("one"), ["friction"]);
    assert!(fs::read_to_string(place.path().join("one/friction/summary.json")).unwrap().contains("\"seconds\""));
    let (output, _) = place.run("run door.yaml --scene long --scene ideal -o two", 0);
    assert!(output.starts_with("door: 2 scenes"), "{output}");
    assert_eq!(place.files("two"), ["angle.svg", "ideal", "long", "report.html", "scenes.csv", "scenes.json"]);
    place.run("run door.yaml --scene long,ideal -o three -q", 0);
    assert_eq!(place.files("three"), place.files("two"));
    // Scenes of several models have the models' folders.
    place.model("crank");
    place.run("run door.yaml crank.yaml -o all -q", 0);
    assert_eq!(place.files("all"), ["crank", "door"]);
    assert!(
        place.path().join("all/crank/bounds.csv").exists() && place.path().join("all/door/long/bounds.csv").exists()
    );

    for (arguments, message) in [
        ("run door.yaml --scene frction", "door.yaml: there is no scene `frction`: did you mean `friction`?"),
        (
            "run door.yaml --scene windy",
            "door.yaml: there is no scene `windy`: the scenes are `ideal`, `friction` and `long`",
        ),
        ("run crank.yaml --scene ideal", "crank.yaml: there is no scene `ideal`: the model has no `scenes`"),
        ("explain door.yaml --scene idael", "door.yaml: there is no scene `idael`: did you mean `ideal`?"),
        ("cost door.yaml --scene idael", "door.yaml: there is no scene `idael`: did you mean `ideal`?"),
        ("run door.yaml --set mas=2", "did you mean `mass`?"),
    ] {
        let output = if arguments.starts_with("explain") { "" } else { " -o nowhere" };
        let (_, errors) = place.run(&format!("{arguments}{output}"), 2);
        assert!(errors.contains(message), "{arguments}: {errors}");
        assert_eq!(errors.matches("error[").count(), 1, "said once: {errors}");
    }
    assert!(!place.path().join("nowhere").exists());
}

#[test]
fn check_and_explain_accept_scenes() {
    let place = Place::new();
    door(&place);
    let (output, _) = place.run("check door.yaml", 0);
    let lines: Vec<&str> = output.lines().filter(|line| line.starts_with("ok ")).collect();
    assert_eq!(lines.len(), 3, "{output}");
    assert!(
        lines[0].starts_with("ok door/ideal: 1 joint coordinate,") && lines[0].contains("1 uncertain parameter,"),
        "{output}"
    );
    assert!(lines[1].starts_with("ok door/friction: ") && lines[1].contains("2 uncertain parameters"), "{output}");
    let (output, _) = place.run("check --format json door.yaml", 0);
    let json: serde_json::Value = serde_json::from_str(&output).unwrap();
    assert_eq!(json[0]["ok"], true);
    assert_eq!(json[0]["scenes"][1]["scene"], "friction");
    assert_eq!(json[0]["scenes"][1]["uncertain_parameters"], serde_json::json!(["mass", "rub"]));
    let effects = |arguments: &str| explained(&place, arguments)["effects"].as_array().unwrap().len();
    assert_eq!((effects("door.yaml"), effects("door.yaml --scene ideal")), (2, 1));
    let (output, _) = place.run("explain door.yaml --scene ideal", 0);
    assert!(output.starts_with("door/ideal\n"), "{output}");
}

/// A four-bar whose rocker does not reach in one scene.
#[test]
fn failed_scene_does_not_stop_the_others() {
    let place = Place::new();
    let text = "
model: rocker
parameters: { rod: { value: 1.2, tolerance: 1% }, torque: 1 }
bodies:
  ground: { points: { post: [1, 0] } }
  crank: { mass: 1, inertia: 0.1, points: { A: [0, 0], B: [0.3, 0] } }
  rocker: { mass: 1, inertia: 0.1, points: { A: [0, 0], B: [0.8, 0] } }
joints:
  pivot: { revolute: [ground, crank.A] }
  post: { revolute: [ground.post, rocker.A] }
  coupler: { distance: { between: [crank.B, rocker.B], length: rod } }
effects: { drive: { torque: { on: crank, value: torque } } }
initial: { crank.angle: 0, crank.angular_velocity: 0 }
guess: { rocker.x: 1, rocker.angle: 90 deg }
outputs: { angle: crank.angle }
simulation: { duration: 0.1, step: 1e-3, output_step: 0.01 }
bounds: { scan: { points: 3 } }
";
    let scenes = "scenes:\n  fine: {}\n  short: { parameters: { rod: { value: 0.01, tolerance: 1% } } }\n  also_fine: { parameters: { torque: 2 } }\n";
    fs::write(place.path().join("rocker.yaml"), format!("{text}{scenes}")).unwrap();
    // `check` refuses it, too.
    let (output, errors) = place.run("run rocker.yaml", 2);
    assert!(errors.starts_with("error[E0901]: rocker/short: "), "{errors}");
    assert_eq!(errors.matches("error").count(), 1, "{errors}");
    let failed = output.lines().find(|line| line.trim_start().starts_with("short")).unwrap();
    assert!(failed.ends_with("failed"), "{output}");
    assert!(output.ends_with("angle.svg, scenes.csv, report.html, scenes.json; fine/, also_fine/\n"), "{output}");
    let table = fs::read_to_string(place.path().join("results/rocker/scenes.csv")).unwrap();
    let named: BTreeSet<&str> = table.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(named.into_iter().collect::<Vec<_>>(), ["also_fine", "fine"]);
    // `check` reports, scene by scene, whether they can be assembled.
    let (output, errors) = place.run("check rocker.yaml", 2);
    assert_eq!(output.lines().filter(|line| line.starts_with("ok ")).count(), 2, "{output}");
    assert!(errors.starts_with("error[E0901]: rocker.yaml: scene short: "), "{errors}");
}

#[cfg(unix)]
#[test]
#[ignore = "2 s"]
fn ctrl_c_keeps_finished_scenes() {
    use std::process::{Command, Stdio};
    let place = Place::new();
    door(&place);
    let path = place.path().join("door.yaml");
    let text = fs::read_to_string(&path).unwrap();
    let slow = "  slow: { simulation: { duration: 8, step: 1e-4 }, bounds: { scan: { points: 150 } } }\n  never: {}\n";
    fs::write(path, format!("{text}{slow}")).unwrap();
    let run =
        place.command("run --yes door.yaml -o out").stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let summary = place.path().join("out/long/summary.json");
    // The scene before the slow one is done: now it is the slow one's turn.
    for _ in 0..600 {
        if summary.exists() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(100));
    }
    std::thread::sleep(std::time::Duration::from_millis(2000));
    assert!(Command::new("kill").args(["-INT", &run.id().to_string()]).status().unwrap().success());
    let ended = run.wait_with_output().unwrap();
    let (output, errors) = (String::from_utf8(ended.stdout).unwrap(), String::from_utf8(ended.stderr).unwrap());
    assert_eq!(ended.status.code(), Some(130), "{errors}");
    assert!(errors.contains("error: door/slow: interrupted"), "{errors}");
    assert!(output.starts_with("door: 5 scenes, 1 of them was not run"), "{output}");
    assert!(!place.path().join("out/never/bounds.csv").exists());
    let table = fs::read_to_string(place.path().join("out/scenes.csv")).unwrap();
    for scene in ["ideal,", "friction,", "long,", "slow,"] {
        assert!(table.lines().any(|line| line.starts_with(scene)), "{scene}");
    }
}

#[test]
fn partial_coverage_of_a_box_is_reported() {
    let place = Place::new();
    let text = "
model: arm
parameters: { reach: { value: 1.0, tolerance: 0.2 } }
bodies:
  ground: { points: { post: [1.1, 0] } }
  crank: { mass: 1, inertia: 0.1, points: { A: [0, 0], B: [0.3, 0] } }
joints:
  pivot: { revolute: [ground, crank.A] }
  rod: { distance: { between: [ground.post, crank.B], length: reach } }
outputs: { angle: crank.angle }
guess: { crank.angle: 1 }
initial: {}
simulation: { duration: 0.02, step: 1e-3, output_step: 0.01 }
bounds: { scan: { points: 3 } }
scenes: { part: { parameters: { reach: { interval: [0.7, 1.2] } } }, whole: { parameters: { reach: { interval: [0.9, 1.2] } } } }
";
    fs::write(place.path().join("arm.yaml"), text).unwrap();
    place.run("run arm.yaml -q --skip-infeasible", 0);
    let table = fs::read_to_string(place.path().join("results/arm/scenes.csv")).unwrap();
    assert!(table.lines().next().unwrap().ends_with(",covered"), "{table}");
    let covered = |scene: &str| {
        let row = table.lines().find(|line| line.starts_with(scene)).unwrap();
        row.rsplit(',').next().unwrap().parse::<f64>().unwrap()
    };
    assert!(covered("part,") < 0.9 && covered("whole,") == 1.0, "{table}");
}
