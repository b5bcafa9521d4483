//! Results of the studio: bounds, samples, and the mechanism in a hand.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::{CRANK, Session, session};
use crate::place::Place;

/// The numbers of a list.
fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap_or_else(|| panic!("{list}")).iter().map(|x| x.as_f64().unwrap()).collect()
}

/// Bounds come in, the coarse first; those of the model are the ones of a run, and the report is there.
#[test]
fn coarse_bounds_arrive_first() {
    let (place, mut session) = session(CRANK);
    let model = session.model(0);
    assert_eq!((model["name"].as_str(), model["parameters"][1]["name"].as_str()), (Some("crank"), Some("torque")));
    let bounds = session.until("bounds", |bounds| bounds["stage"] == "asked");
    assert_eq!(bounds["number"], model["number"]);
    let article = bounds["html"].as_str().unwrap();
    place.run("run m.yaml -q -o results", 0);
    let plot = fs::read_to_string(place.path().join("results/x.svg")).unwrap();
    let data = plot.split("<metadata>").nth(1).unwrap().split("</metadata>").next().unwrap();
    assert!(article.contains(data), "the plot of the run");
    let report = session.get("report");
    assert_eq!(report.status, 200, "{}", report.body);
    assert!(report.body.contains("id=\"mbint-data\"") && report.body.contains(data));
}

/// A slider's curve is the simulation at its values, to the last bit.
#[test]
fn slider_shows_the_simulation_at_its_values() {
    let (place, mut session) = session(CRANK);
    let number = session.model(0)["number"].clone();
    let values = [0.2012, 0.29];
    let found = session.post("sample", &json!({ "number": number, "values": values }));
    assert_eq!(found.status, 200, "{}", found.body);
    let found = found.json();
    fs::write(place.path().join("points.csv"), format!("l,torque\n{},{}\n", values[0], values[1])).unwrap();
    place.run("sample m.yaml --points points.csv -o samples.csv -q", 0);
    let table = fs::read_to_string(place.path().join("samples.csv")).unwrap();
    let column = |index: usize| -> Vec<f64> {
        table.lines().skip(1).map(|line| line.split(',').nth(index).unwrap().parse().unwrap()).collect()
    };
    assert_eq!(table.lines().next(), Some("sample,l,torque,t,x,angle"));
    assert_eq!(numbers(&found["times"]), column(3));
    assert_eq!(numbers(&found["outputs"][0]["values"]), column(4));
    assert_eq!(numbers(&found["outputs"][1]["values"]), column(5));
    // The mechanism's motion at the sample ends where the crank's angle does, to the accuracy of 32 bits.
    let motion = session.post("motion", &json!({ "number": number, "values": values })).json();
    assert_eq!(motion["rows"], 21);
    for (values, why) in
        [(json!([0.2]), "one value"), (json!([0.3, 0.29]), "`l` is from"), (json!([0.2, null]), "null")]
    {
        let refused = session.post("sample", &json!({ "number": number, "values": values }));
        assert!(refused.status == 400 && refused.body.contains(why), "{} {}", refused.status, refused.body);
    }
    let other = session.post("sample", &json!({ "number": 99, "values": values }));
    assert_eq!(other.status, 409);
}

/// The largest gap at the joints of a pose (x, y and angle of crank, rod and slider), m.
fn gap(pose: &[f64], l: f64) -> f64 {
    let at = |body: usize, x: f64| {
        let [px, py, angle] = [0, 1, 2].map(|number| pose[3 * body + number]);
        [px + x * angle.cos(), py + x * angle.sin()]
    };
    let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let slider = [pose[6], pose[7]];
    apart(at(0, 0.0), [0.0; 2]).max(apart(at(0, l), at(1, 0.0))).max(apart(at(1, 0.5), slider)).max(slider[1].abs())
}

fn drag(session: &Session, number: &Value, l: f64, place: [f64; 3], from: Option<Vec<f64>>) -> Vec<f64> {
    let question = json!({ "number": number, "values": [l, 0.3], "body": 1, "point": 1, "place": place, "from": from });
    let held = session.post("drag", &question).json();
    assert_eq!(held["freedom"], 1, "{held}");
    assert!(held["residual"].as_f64().unwrap() < 1e-10, "{held}");
    numbers(&held["pose"])
}

/// Dragging keeps all joints closed, of the nominal mechanism and of a sample, and ends as near as it can.
#[test]
fn a_hand_keeps_the_loop_closed() {
    let (_place, mut session) = session(CRANK);
    session.until("mechanism", |_| true);
    let number = session.model(0)["number"].clone();
    for l in [0.2, 0.2015] {
        for angle in [1.2_f64, 1.6, 2.2, 3.1, 4.0] {
            let pose = drag(&session, &number, l, [0.4 * angle.cos(), 0.4 * angle.sin(), 0.0], None);
            assert!(gap(&pose, l) < 1e-10, "{angle}: {}", gap(&pose, l));
            assert!((pose[2] - angle).abs() < 1e-6, "{angle}: {pose:?}");
        }
    }
    // From another pose: the hand begins there.
    let angle = 1.8_f64;
    let rod = (0.2 * angle.sin() / 0.5).asin();
    let [x, y] = [0.2 * angle.cos(), 0.2 * angle.sin()];
    let from = vec![0.0, 0.0, angle, x, y, -rod, x + 0.5 * rod.cos(), 0.0, 0.0];
    let pose = drag(&session, &number, 0.2, [x, y, 0.0], Some(from.clone()));
    assert!(pose.iter().zip(&from).all(|(a, b)| (a - b).abs() < 1e-7), "{pose:?}");
    for (body, point) in [(0, 0), (9, 0), (1, 9)] {
        let question =
            json!({ "number": number, "values": [0.2, 0.3], "body": body, "point": point, "place": [0, 0, 0] });
        assert_eq!(session.post("drag", &question).status, 409, "{body} {point}");
    }
}

/// In space, with redundant constraints, several loops and floating bodies: wherever a point is dragged to, residuals
/// are rounding, and the point comes nearer unless every coordinate is driven.
#[test]
fn loops_in_space_stay_closed() {
    for (model, freedom) in [("bricard", 1), ("flyball_governor", 4), ("humanoid", 11), ("stewart", 0)] {
        let place = Place::new();
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{model}.yaml"));
        let mut session = Session::new(&place, path.to_str().unwrap());
        let bodies = session.until("mechanism", |_| true)["motion"]["drawing"]["bodies"].clone();
        let found = session.model(0);
        let values: Vec<f64> =
            found["parameters"].as_array().unwrap().iter().map(|own| own["nominal"].as_f64().unwrap()).collect();
        // The centre of mass of one in the middle: nothing holds that.
        let body = bodies.as_array().unwrap().len() / 2;
        let point = bodies[body]["points"].as_array().unwrap().len();
        let start = numbers(&bodies[body]["center_of_mass"]);
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let mut at = start.clone();
        for step in 1..=5 {
            let by = 0.01 * f64::from(step);
            let place = [start[0] + by, start[1] + 0.5 * by, start[2] + 0.3 * by];
            let question =
                json!({ "number": found["number"], "values": values, "body": body, "point": point, "place": place });
            let held = session.post("drag", &question).json();
            assert_eq!(held["freedom"], freedom, "{model}: {held}");
            assert!(held["residual"].as_f64().unwrap() < 1e-12, "{model}: {held}");
            let now = numbers(&held["at"]);
            assert!(apart(&now, &place) <= apart(&at, &place) + 1e-12, "{model}: {at:?} {now:?} {place:?}");
            at = now;
        }
        assert_eq!(apart(&at, &start) > 1e-4, freedom > 0, "{model}: {start:?} {at:?}");
    }
}

/// A model that asks a program does not start it when it is opened.
#[cfg(unix)]
#[test]
fn a_program_is_started_when_it_is_allowed() {
    let text = "\
model: asked
parameters: { m: { value: 2, unit: kg, tolerance: 5% } }
black_box: { command: [sh, -c, \"touch started; exit 1\"], outputs: { x: m } }
simulation: { duration: 1, output_step: 0.5 }
";
    let (place, mut session) = session(text);
    let bounds = session.until("bounds", |bounds| bounds["waits"] == true);
    assert!(bounds["error"].as_str().unwrap().contains("when you allow it"), "{bounds}");
    let number = session.model(0)["number"].as_u64().unwrap();
    let sample = session.post("sample", &json!({ "number": number, "values": [2] }));
    assert_eq!(sample.status, 409, "{}", sample.body);
    assert!(!place.path().join("started").exists());
    assert_eq!(session.post("allow", &json!({})).status, 200);
    session.until("bounds", |bounds| bounds["number"].as_u64() > Some(number) && bounds["error"].as_str().is_some());
    assert!(place.path().join("started").exists());
}

/// A study that would take hours ends when the text changes, and the next one begins.
#[test]
fn change_of_the_text_restarts_the_bounds() {
    let slow = CRANK.replace("chebyshev: { order: 2 }", "scan: { points: 3000 }");
    let (place, mut session) = session(&slow.replace("duration: 0.2", "duration: 4"));
    let path = place.path().canonicalize().unwrap().join("m.yaml");
    assert_eq!(session.post("open", &json!({ "path": path })).status, 200);
    // It asks before it takes long; then it is on its way.
    session.until("bounds", |bounds| bounds["waits"] == true);
    assert_eq!(session.post("allow", &json!({})).status, 200);
    session.until("progress", |progress| progress["stage"] == "asked");
    let number = session.model(1)["number"].as_u64().unwrap();
    assert_eq!(session.post("text", &json!({ "path": path, "text": CRANK })).status, 200);
    let bounds =
        session.until("bounds", |bounds| bounds["stage"] == "asked" && bounds["number"].as_u64() > Some(number));
    assert!(bounds["html"].as_str().unwrap().contains("data-output=\"1\""));
}
