//! `mbint snapshot`: records next to a model, and reports of bounds that moved.

use std::fs;

use super::place::Place;

/// A falling body with drag, alone and in a scene.
const FALL: &str = "
model: fall
parameters:
  m: { value: 2, unit: kg, tolerance: 3% }
  c: { value: 0.4, unit: kg/m, tolerance: 5% }
bodies: { ball: { mass: m, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  air: { drag: { on: ball, quadratic: c } }
initial: { ball.y: 0, ball.vy: 0 }
outputs: { height: ball.y, speed: ball.vy }
simulation: { duration: 0.5, step: 5e-3, output_step: 0.05 }
bounds: { chebyshev: { order: 3 }, scan: { points: 3 } }
";

#[test]
fn snapshot_is_next_to_its_model_and_reports_changes() {
    let place = Place::new();
    fs::create_dir(place.path().join("parts")).unwrap();
    let model = |text: &str| fs::write(place.path().join("parts/fall.yaml"), text).unwrap();
    model(FALL);
    let (_, errors) = place.run("snapshot --check parts/fall.yaml", 4);
    assert!(
        errors.contains("there is no snapshot parts/fall.snap; `mbint snapshot parts/fall.yaml` records it"),
        "{errors}"
    );

    let (output, errors) = place.run("snapshot parts/fall.yaml", 0);
    assert_eq!((output.as_str(), errors.as_str()), ("fall: recorded in parts/fall.snap\n", ""));
    assert_eq!(place.files("parts"), ["fall.snap", "fall.yaml"]);
    let text = fs::read_to_string(place.path().join("parts/fall.snap")).unwrap();
    assert!(
        text.starts_with("---\ndescription: \"fall.yaml\"\n---\nheight [m]\n       t      nominal chebyshev.lower"),
        "{text}"
    );
    assert_eq!(text.lines().count(), 3 + 12 + 1 + 12, "{text}");
    let (output, _) = place.run("snapshot --check parts/fall.yaml", 0);
    assert_eq!(output, "ok fall: 10 curves as recorded\n");
    assert_eq!(place.run("snapshot -q parts/fall.yaml", 0).0, "");

    // Within the errors: half a step's.
    model(&FALL.replace("5e-3", "2.5e-3"));
    place.run("snapshot --check -q parts/fall.yaml", 0);

    // Beyond them: 1 % of the drag.
    model(&FALL.replace("value: 0.4", "value: 0.404"));
    let (output, errors) = place.run("snapshot --check parts/fall.yaml", 4);
    let lines: Vec<&str> = output.lines().collect();
    assert_eq!(lines[0], "fall: not as recorded in parts/fall.snap");
    assert_eq!(
        lines[2].split_whitespace().collect::<Vec<_>>(),
        ["output", "time", "before", "after", "allowed", "unit", "times"]
    );
    assert!(lines.iter().any(|line| line.contains("speed.chebyshev.upper") && line.contains("0.5000 s")), "{output}");
    assert!(
        errors.contains(
            "have moved beyond the stated errors; if that is right, `mbint snapshot parts/fall.yaml` records it"
        ),
        "{errors}"
    );
    assert_eq!(fs::read_to_string(place.path().join("parts/fall.snap")).unwrap(), text, "a check writes nothing");

    // A file that is no snapshot is not reported as a bound that moved.
    fs::write(place.path().join("parts/fall.snap"), "<<<<<<< HEAD\n").unwrap();
    let (_, errors) = place.run("snapshot --check parts/fall.yaml", 2);
    assert!(errors.contains("parts/fall.snap: line 2: no headings"), "{errors}");
}

#[test]
fn scenes_have_snapshots_of_their_own() {
    let place = Place::new();
    let scenes = "scenes: { still: { without: [air] }, thin: { parameters: { c: 0.1 } } }\n";
    fs::write(place.path().join("fall.yaml"), format!("{FALL}{scenes}")).unwrap();
    place.run("snapshot fall.yaml -o kept", 0);
    assert_eq!(place.files("kept"), ["fall.still.snap", "fall.thin.snap"]);
    let text = fs::read_to_string(place.path().join("kept/fall.thin.snap")).unwrap();
    assert!(text.starts_with("---\ndescription: \"fall.yaml, scene thin\"\n---\n"), "{text}");
    fs::write(place.path().join("kept/fall.thin.snap"), text.replace("height [m]", "depth [m]")).unwrap();
    let (output, errors) = place.run("snapshot --check fall.yaml --output kept", 4);
    let rows: Vec<String> = output.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    for row in ["ok fall/still: 10 curves as recorded", "height – – new – m –", "depth – recorded gone – m –"]
    {
        assert!(rows.iter().any(|line| line == row), "{row} in\n{output}");
    }
    assert!(errors.contains("`mbint snapshot fall.yaml --output kept`"), "{errors}");
    place.run("snapshot --check fall.yaml --output kept --scene still", 0);
    // Two models of one name have one snapshot.
    fs::copy(place.path().join("fall.yaml"), place.path().join("copy.yaml")).unwrap();
    let (_, errors) = place.run("snapshot fall.yaml copy.yaml", 2);
    assert!(errors.contains("fall.yaml and copy.yaml have the same snapshot, fall.still.snap"), "{errors}");
}

/// Our own snapshots are recorded by the same code: the command can compare with them.
#[test]
fn the_projects_own_snapshots_can_be_checked() {
    let place = Place::new();
    let root = env!("CARGO_MANIFEST_DIR");
    let (output, _) =
        place.run(&format!("snapshot --check {root}/models/quick_return.yaml --output {root}/snapshots"), 0);
    assert!(output.starts_with("ok quick_return: "), "{output}");
}
