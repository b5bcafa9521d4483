//! `black_box`: programs that answer instead of a mechanism. Expected values are closed forms, or the bounds of the
//! mechanism that the program simulates.

use std::fs;

use serde_json::Value;

use super::place::Place;

/// A mass on a spring, x = cos(√(k/m) t), in JSON lines; `MODE` misbehaves where k is above 205.
const SPRING: &str = r#"
import json, math, sys, time
mode = sys.argv[1]
for line in sys.stdin:
    asked = json.loads(line)
    k, m = asked["parameters"]["k"], asked["parameters"]["m"]
    x = [1000 * math.cos(math.sqrt(k / m) * t) for t in asked["times"]]
    answer = {"point": asked["point"], "outputs": {"x": x}}
    if k > 205:
        if mode == "crash": sys.exit("diverged at k = %r" % k)
        if mode == "hang": time.sleep(60)
        if mode == "flood":
            while True: print("x" * 10000)
        if mode == "nan": x[3] = float("nan")
        if mode == "short": x.pop()
        if mode == "error": answer = {"point": asked["point"], "error": "no convergence"}
        if mode == "times": answer["times"] = [1.01 * t for t in asked["times"]]
        if mode == "name": answer["outputs"] = {"y": x}
        if mode == "silent": continue
    print(json.dumps(answer), flush=True)
"#;

fn model(mode: &str, more: &str) -> String {
    format!(
        "model: spring
parameters: {{ k: 200 N/m ± 5%, m: 2 kg }}
black_box:
  command: [python3, spring.py, {mode}]
  outputs: {{ x: mm }}
  time_limit: 2 s
simulation: {{ duration: 0.3, output_step: 0.03 }}
{more}
"
    )
}

fn place(mode: &str, more: &str) -> Place {
    let place = Place::new();
    fs::write(place.path().join("spring.py"), SPRING).unwrap();
    fs::write(place.path().join("spring.yaml"), model(mode, more)).unwrap();
    place
}

fn summary(place: &Place, folder: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(place.path().join(folder).join("summary.json")).unwrap()).unwrap()
}

/// Columns of a table by name.
fn column(text: &str, name: &str) -> Vec<f64> {
    let mut lines = text.lines();
    let index = lines.next().unwrap().split(',').position(|own| own == name).unwrap_or_else(|| panic!("{name}"));
    lines.map(|line| line.split(',').nth(index).unwrap().parse().unwrap()).collect()
}

#[test]
fn bounds_match_the_closed_form() {
    let more = "outputs: { x: x, stretch: k * x, at_end: { value: x, at: 0.3 } }
requirements: { near: x <= 1001 mm }
bounds: { chebyshev: { order: 5 }, scan: { points: 5 } }";
    let place = place("right", more);
    let (output, _) = place.run("run spring.yaml -o out", 0);
    assert!(output.contains("near") && output.contains("holds"), "{output}");
    let bounds = fs::read_to_string(place.path().join("out/bounds.csv")).unwrap();
    let (times, lower, upper, error) = (
        column(&bounds, "t"),
        column(&bounds, "x.chebyshev.lower"),
        column(&bounds, "x.chebyshev.upper"),
        column(&bounds, "x.chebyshev.error"),
    );
    for (row, t) in times.iter().enumerate() {
        // √(k/m) t is below π: x falls with k.
        let [least, most] = [210.0, 190.0].map(|k: f64| ((k / 2.0).sqrt() * t).cos());
        assert!((lower[row] - least).abs() <= error[row] + 1e-12, "{t}: {} {least}", lower[row]);
        assert!((upper[row] - most).abs() <= error[row] + 1e-12, "{t}: {} {most}", upper[row]);
    }
    let at_end = &summary(&place, "out")["reduced"][0];
    let expected = (10.0_f64 * 0.3).cos();
    assert!((at_end["nominal"].as_f64().unwrap() - expected).abs() < 1e-9, "{at_end}");
    let found = &summary(&place, "out")["black_box"];
    assert_eq!(found["noise"].as_array().unwrap().len(), 0);
    assert!(found["repeated"].as_u64().unwrap() >= 3 && found["refined_by"].is_null());
}

#[test]
#[ignore = "30 s"]
fn failed_sample_affects_no_other_sample() {
    for (mode, expected) in [
        ("crash", "the program ended (exit status: 1) without an answer; its last words: diverged at k = 210.0"),
        ("hang", "the program did not answer within 2 s, and was ended"),
        ("flood", "the program wrote more than"),
        ("nan", "`x` is not a finite number at t = 0.09 s"),
        ("short", "the answer has 10 rows of `x` where 11 were asked for"),
        ("error", "the program says: no convergence"),
        ("times", "row 1 of the answer is at t = 0.0303 s, but 0.03 s was asked for"),
        ("name", "the answer has no output `x`; it has `y`"),
        ("silent", "the program did not answer within 2 s, and was ended"),
    ] {
        let place = place(mode, "bounds: { scan: { points: 5 } }");
        let (_, messages) = place.run("run spring.yaml -o out --threads 2", 1);
        assert!(messages.contains(expected), "{mode}: {messages}");
        assert!(messages.contains("spring.yaml:3: the black box has no answer with k = 210"), "{mode}: {messages}");
        // The scan is of the other four: 190, 195, 200 and 205 N/m.
        let bounds = fs::read_to_string(place.path().join("out/bounds.csv")).unwrap();
        let lower = column(&bounds, "x.scan.lower");
        let least = |t: f64| ((205.0_f64 / 2.0).sqrt() * t).cos();
        assert!((lower[10] - least(0.3)).abs() < 1e-12, "{mode}: {}", lower[10]);
    }
}

/// A program with a mistake in it fails for every point: only the nominal one is requested, and tried again once.
#[test]
fn failing_program_is_called_for_one_point_only() {
    let place = place("right", "requirements: { near: x <= 1001 mm }\nbounds: { tolerance: 1e-3 }");
    let wrong = "import sys\nopen('asked', 'a').write('x')\nsys.stdin.readline()\nprint(math.pi)\n";
    fs::write(place.path().join("spring.py"), wrong).unwrap();
    let (_, message) = place.run("run spring.yaml -o out", 2);
    let said = "spring.yaml:3: the black box has no answer with k = 200";
    assert!(message.contains(said) && message.contains("name 'math' is not defined"), "{message}");
    assert_eq!(fs::read_to_string(place.path().join("asked")).unwrap().len(), 2);
    assert!(!place.path().join("out/bounds.csv").exists());
}

#[test]
fn samples_without_an_answer_are_not_numbers() {
    let place = place("crash", "");
    fs::write(place.path().join("points.csv"), "k\n200\n208\n190\n").unwrap();
    let (_, messages) = place.run("sample spring.yaml --points points.csv -o samples.csv", 0);
    assert!(messages.contains("1 stopped"), "{messages}");
    let samples = fs::read_to_string(place.path().join("samples.csv")).unwrap();
    let (numbers, x) = (column(&samples, "sample"), column(&samples, "x"));
    assert!(numbers.iter().zip(&x).all(|(number, x)| (*number == 1.0) == x.is_nan()), "{samples}");
}

#[test]
fn missing_program_is_reported_at_once() {
    let place = place("right", "");
    fs::write(place.path().join("spring.yaml"), model("right", "").replace("python3", "no-such-program")).unwrap();
    let (_, messages) = place.run("run spring.yaml -o out", 2);
    assert!(
        messages.contains("spring.yaml:3: black box: the program `no-such-program` cannot be started"),
        "{messages}"
    );
}

#[test]
fn commands_that_need_a_mechanism_are_refused() {
    let place = place("right", "");
    for command in ["show", "explain", "gradient", "cost"] {
        let (_, messages) = place.run(&format!("{command} spring.yaml"), 2);
        assert!(messages.contains("spring.yaml:3:") && messages.contains("needs a mechanism"), "{command}: {messages}");
    }
    for option in ["--method taylor", "--certify"] {
        let (_, messages) = place.run(&format!("run spring.yaml {option}"), 2);
        assert!(messages.contains("needs the equations of motion"), "{option}: {messages}");
    }
    let (output, _) = place.run("check spring.yaml", 0);
    assert!(
        output.contains("ok spring: 1 output, 1 uncertain parameter, answered by `python3 spring.py right`"),
        "{output}"
    );
}

/// The shipped slider crank, and the same behind a black box that is mbint itself.
#[test]
fn mbint_as_program_gives_the_bounds_of_its_model() {
    let place = Place::new();
    let own = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/models/slider_crank.yaml")).unwrap();
    let inner = own.split("bounds:").next().unwrap().replace("# yaml-language-server", "#");
    let asked = "bounds: { chebyshev: { order: 3 }, scan: { points: 4 } }\n";
    fs::write(place.path().join("own.yaml"), format!("{inner}{asked}")).unwrap();
    fs::write(place.path().join("inner.yaml"), inner).unwrap();
    let mbint = assert_cmd::cargo::cargo_bin!("mbint").display().to_string();
    let outer = format!(
        "model: outer
parameters: {{ l1: 0.15 m ± 1%, tau: -0.5 N*m ± 1% }}
black_box:
  command: ['{mbint}', sample, inner.yaml, --points, '-', -o, '-', --quiet]
  protocol: csv
  outputs: {{ x3: m }}
simulation: {{ duration: 2, output_step: 0.01 }}
{asked}"
    );
    fs::write(place.path().join("outer.yaml"), outer).unwrap();
    place.run("run own.yaml -o own", 0);
    place.run("run outer.yaml -o outer", 0);
    let [own, outer] =
        ["own", "outer"].map(|folder| fs::read_to_string(place.path().join(folder).join("bounds.csv")).unwrap());
    for name in ["x3.nominal", "x3.scan.lower", "x3.scan.upper"] {
        let differ =
            column(&own, name).iter().zip(&column(&outer, name)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(differ < 1e-12, "{name}: {differ}");
    }
    // The mechanism's outputs follow from its expanded coordinates, the program's are expanded themselves.
    for end in ["lower", "upper"] {
        let [a, b] = [&own, &outer].map(|text| column(text, &format!("x3.chebyshev.{end}")));
        let error = [&own, &outer].map(|text| column(text, "x3.chebyshev.error"));
        for row in 0..a.len() {
            assert!((a[row] - b[row]).abs() <= error[0][row] + error[1][row] + 1e-12, "{end}, row {row}");
        }
    }
}

/// Steps of the explicit midpoint rule are of second order: with `refine`, their error is in that of the bounds.
#[test]
fn the_error_of_steps_is_found_by_refining_them() {
    let place = Place::new();
    let script = r#"
import json, sys
for line in sys.stdin:
    asked = json.loads(line)
    k, dt = asked["parameters"]["k"], asked["parameters"]["dt"]
    x, v, now, rows = 1.0, 0.0, 0.0, []
    for t in asked["times"]:
        count = round((t - now) / dt)
        for _ in range(count):
            h = (t - now) / count
            x, v = x + h * (v - h / 2 * k * x), v - h * k * (x + h / 2 * v)
        now = t
        rows.append(x)
    print(json.dumps({"point": asked["point"], "outputs": {"x": rows}}), flush=True)
"#;
    fs::write(place.path().join("steps.py"), script).unwrap();
    let text = "parameters: { k: 100 ± 5%, dt: 6 ms }
black_box: { command: [python3, steps.py], outputs: { x: 1 }, refine: { parameter: dt, by: 0.5 } }
simulation: { duration: 0.6, output_step: 0.06 }
bounds: { chebyshev: { order: 6 } }
";
    fs::write(place.path().join("steps.yaml"), text).unwrap();
    let (output, _) = place.run("run steps.yaml -o out", 0);
    assert!(output.contains("the error of its own steps was found by finer `dt`"), "{output}");
    let bounds = fs::read_to_string(place.path().join("out/bounds.csv")).unwrap();
    let [times, nominal, error] = ["t", "x.nominal", "x.chebyshev.error"].map(|name| column(&bounds, name));
    let off: Vec<f64> = times.iter().zip(&nominal).map(|(t, x)| (x - (10.0 * t).cos()).abs()).collect();
    let (largest, stated) = (off.iter().copied().fold(0.0, f64::max), error.iter().copied().fold(0.0, f64::max));
    assert!(largest > 1e-3, "the steps err visibly: {largest}");
    assert!(stated >= 0.9 * largest && stated < 3.0 * largest, "stated {stated}, and off by {largest}");
}

#[test]
fn noise_is_found_and_stated() {
    let place = place("right", "bounds: { chebyshev: { order: 2 } }");
    let noisy = SPRING
        .replace("    answer =", "    import random\n    x = [v + 0.5 * random.random() for v in x]\n    answer =");
    fs::write(place.path().join("spring.py"), noisy).unwrap();
    let (output, _) = place.run("run spring.yaml -o out", 0);
    assert!(output.contains("asked twice: noise of x"), "{output}");
    let noise = summary(&place, "out")["black_box"]["noise"][0]["noise"].as_f64().unwrap();
    // In m; the answers are in mm.
    assert!(noise > 1e-4 && noise <= 0.5e-3, "{noise}");
    // Held-out samples have it, too.
    let bounds = fs::read_to_string(place.path().join("out/bounds.csv")).unwrap();
    let error = column(&bounds, "x.chebyshev.error").into_iter().fold(0.0, f64::max);
    assert!(error > 0.3 * noise, "{error} beside {noise}");
}

/// A response that jumps over the parameters has no polynomial: this is reported, and the error covers the jump.
#[test]
fn jumps_are_flagged() {
    let place = place("right", "bounds: { chebyshev: { order: 4 } }");
    fs::write(place.path().join("spring.py"), SPRING.replace("for t in", "+ 500 * (k > 203) for t in")).unwrap();
    let (output, _) = place.run("run spring.yaml -o out", 0);
    assert!(output.contains("x.chebyshev: held-out answers are off by"), "{output}");
    let bounds = fs::read_to_string(place.path().join("out/bounds.csv")).unwrap();
    let [lower, upper, error] =
        ["lower", "upper", "error"].map(|end| column(&bounds, &format!("x.chebyshev.{end}"))[0]);
    // At the start x is 1 m, and 0.5 m more beyond the jump.
    assert!((lower - 1.0).abs() <= error && (upper - 1.5).abs() <= error, "{lower} to {upper}, {error}");
}

/// Answers without a time are numbers, one an output; points are asked in calls of several.
#[test]
fn numbers_need_no_time() {
    let place = Place::new();
    let script = "
import json, sys
asked = []
for line in sys.stdin:
    asked.append(json.loads(line))
    if asked[-1]['left'] == 0:
        for one in reversed(asked):
            assert one['times'] == [0.0] and len(asked) <= 4
            print(json.dumps({'point': one['point'], 'outputs': {'area': one['parameters']['a'] * one['parameters']['b']}}))
        sys.stdout.flush()
        asked = []
";
    fs::write(place.path().join("area.py"), script).unwrap();
    let text = "parameters: { a: 2 m ± 10%, b: 3 m ± 10% }
black_box: { command: [python3, area.py], outputs: { area: m^2 }, points: 4, processes: 1 }
bounds: { chebyshev: { order: 2 } }
";
    fs::write(place.path().join("area.yaml"), text).unwrap();
    let (output, _) = place.run("run area.yaml -o out", 0);
    let values = summary(&place, "out")["analysis"]["values"][0].clone();
    let close = |value: &Value, expected: f64| (value.as_f64().unwrap() - expected).abs() < 1e-9;
    assert!(close(&values["nominal"], 6.0), "{output}");
    let bounds = &values["bounds"][0];
    let error = bounds[3].as_f64().unwrap();
    let within = |value: &Value, expected: f64| (value.as_f64().unwrap() - expected).abs() <= error;
    assert!(error < 1e-3 && within(&bounds[1], 0.81 * 6.0) && within(&bounds[2], 1.21 * 6.0), "{values}");
}

/// The answers of a script are stored with `--store`, and asked anew if the script has changed.
#[test]
fn stored_answers_follow_changes_of_the_script() {
    let place = place("right", "bounds: { chebyshev: { order: 3 } }");
    let run = |folder: &str| {
        place.run(&format!("run spring.yaml -o {folder} --store kept"), 0);
        fs::read_to_string(place.path().join(folder).join("bounds.csv")).unwrap()
    };
    let first = run("first");
    assert_eq!(first, run("again"));
    fs::write(place.path().join("spring.py"), SPRING.replace("1000 *", "2000 *")).unwrap();
    let [before, after] = [&first, &run("changed")].map(|text| column(text, "x.nominal"));
    assert!(before.iter().zip(&after).all(|(a, b)| (2.0 * a - b).abs() < 1e-12));
}

#[test]
fn studies_by_shards_match_a_run() {
    let place = place("right", "bounds: { chebyshev: { order: 3 } }");
    place.run("run spring.yaml -o alone", 0);
    place.run("plan spring.yaml -o study --at-once 0", 0);
    let mut simulated = 0;
    for _ in 0..8 {
        let shards = fs::read_to_string(place.path().join("study/plan.json")).unwrap();
        let plan: Value = serde_json::from_str(&shards).unwrap();
        let count = plan["shards"].as_array().unwrap().len();
        simulated += count;
        for index in 0..count {
            place.run(&format!("shard study --index {index}"), 0);
        }
        if place.command("merge study -o merged").output().unwrap().status.code() != Some(75) {
            break;
        }
    }
    let [alone, merged] =
        ["alone", "merged"].map(|folder| fs::read_to_string(place.path().join(folder).join("bounds.csv")).unwrap());
    assert_eq!(alone, merged);
    assert!(simulated > 0, "the program was asked by shards");
}
