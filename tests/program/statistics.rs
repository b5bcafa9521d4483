//! The example of the guide to statistics is run, and its statistics are checked.

use std::fs;
use std::path::Path;

use crate::place::Place;

#[test]
fn example_of_the_guide_has_statistics_and_bounds() {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guides/statistics.md")).unwrap();
    let example = page.split("```yaml\n").nth(1).unwrap().split("```").next().unwrap();
    let place = Place::new();
    fs::write(place.path().join("stack.yaml"), example).unwrap();
    let (printed, _) = place.run("run stack.yaml -o out", 0);
    for word in
        ["worst case", "RSS", "a normal (deviation 3.333e-5, of which the tolerance is three)", "d.deviation uniform"]
    {
        assert!(printed.contains(word), "{word}: {printed}");
    }
    let table = fs::read_to_string(place.path().join("out/statistics.csv")).unwrap();
    let heading = "t,gap.mean,gap.mean.error,gap.deviation,gap.deviation.error,gap.q0.05,gap.q0.05.error,gap.q0.5,gap.q0.5.error,\
        gap.q0.95,gap.q0.95.error,gap.linear,gap.rss,unresolved";
    assert_eq!(table.lines().next().unwrap(), heading);
    assert_eq!(table.lines().count(), 4);
    // ± 0.1, 0.2, 0.1 and 0.01 mm.
    let last: Vec<f64> = table.lines().last().unwrap().split(',').take(13).map(|cell| cell.parse().unwrap()).collect();
    assert!((last[1] - 1e-3).abs() < 1e-7 && (last[11] - 0.41e-3).abs() < 1e-9, "{last:?}");
}

/// Φ(−z) by its continued fraction (Abramowitz & Stegun 26.2.14).
fn tail(z: f64) -> f64 {
    let fraction = (1..200).rev().fold(z, |below, k| z + f64::from(k) / below);
    (-0.5 * z * z).exp() / (std::f64::consts::TAU.sqrt() * fraction)
}

#[test]
fn yields_of_peaks_and_rare_failures_match_closed_forms() {
    let place = Place::new();
    // Thrown up at v: the peak v²/2g lies between rows; at the end y = v/2 − g/8.
    let text = "
model: thrown
parameters: { v: { value: 2, unit: m/s, tolerance: 60 mm/s, distribution: normal } }
bodies: { ball: { mass: 1, coordinates: [y] } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { ball.y: 0, ball.vy: v }
outputs:
  y: ball.y
  peak: { max: y }
requirements:
  low: { output: peak, max: 0.212110092 m }
  below: y <= 0.212110092 m
  rare: { output: y, at: 0.5, max: -0.17625 m }
simulation: { duration: 0.5, step: 1e-3, output_step: 0.25 }
bounds: { chebyshev: { order: 3 } }
";
    fs::write(place.path().join("thrown.yaml"), text).unwrap();
    // Worst case: 2.06²/19.62 is 0.2163.
    let (printed, _) = place.run("run thrown.yaml -o out", 4);
    assert!(printed.contains("by importance sampling") && printed.contains("all requirements"), "{printed}");
    let summary = fs::read_to_string(place.path().join("out/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    // v > 2.04 is two deviations; v > 2.1 are five.
    for (number, fails, most) in [(0, tail(2.0), 0.02), (1, tail(2.0), 0.02), (2, tail(5.0), 0.05)] {
        let found = &summary["statistics"]["requirements"][number];
        let ppm = |key: &str| found[key].as_f64().unwrap();
        assert!((1e-6 * ppm("ppm") / fails - 1.0).abs() < most, "{found} {fails}");
        let ends = [0, 1].map(|end| 1e-6 * found["ppm_interval"][end].as_f64().unwrap());
        assert!(ends[0] <= fails && fails <= ends[1], "{found} {fails}");
        assert_eq!(found["method"].is_string(), number == 2, "{found}");
    }
    let together = 1e-6 * summary["statistics"]["together"]["ppm"].as_f64().unwrap();
    assert!((together / tail(2.0) - 1.0).abs() < 0.02, "{together}");
    // The plot has the quantiles next to the bounds, and so has the report.
    for file in ["y.svg", "report.html"] {
        let text = fs::read_to_string(place.path().join("out").join(file)).unwrap();
        assert!(text.contains("quantiles, 0.135 % to 99.865 %"), "{file}");
    }
}

/// The yields of a reduced output by the surrogate and by direct simulation of random samples, in lockstep.
#[test]
#[ignore = "2 s"]
fn yields_of_a_stroke_match_direct_simulations() {
    const COUNT: usize = 3000;
    let place = Place::new();
    let text = "
model: rod
parameters:
  m: 1.3 kg
  l: 0.4 m ± 3%
  start: { value: 0.25 rad, tolerance: 0.04 rad, distribution: triangular }
bodies: { rod: { mass: m, inertia: m*l^2/12, points: { A: [-l/2, 0], B: [l/2, 0] } } }
joints: { hinge: { revolute: [ground, rod.A] } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { rod.angle: start - 1.5707963267948966 rad }
outputs:
  x: rod.B.x
  stroke: { range: x }
requirements:
  most: stroke <= 0.21 m
  few: stroke <= 0.18 m
simulation: { duration: 0.6 s, step: 1 ms, output_step: 2 ms }
";
    fs::write(place.path().join("rod.yaml"), text).unwrap();
    place.run("run rod.yaml -o out --no-report", 4);
    let summary = fs::read_to_string(place.path().join("out/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    // Random samples of a linear congruential generator; a triangular law is the mean of two uniform ones.
    let mut state = 2007_u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut points = String::from("l,start\n");
    for _ in 0..COUNT {
        let (l, start) = (0.4 * (0.97 + 0.06 * uniform()), 0.21 + 0.08 * 0.5 * (uniform() + uniform()));
        points += &format!("{l:?},{start:?}\n");
    }
    fs::write(place.path().join("points.csv"), points).unwrap();
    place.run("sample rod.yaml --points points.csv -o samples.csv", 0);
    let table = fs::read_to_string(place.path().join("samples.csv")).unwrap();
    let names: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|own| *own == name).unwrap();
    let (sample, x) = (column("sample"), column("x"));
    let mut ends = vec![(f64::INFINITY, f64::NEG_INFINITY); COUNT];
    for line in table.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let (own, value): (usize, f64) = (cells[sample].parse().unwrap(), cells[x].parse().unwrap());
        ends[own] = (ends[own].0.min(value), ends[own].1.max(value));
    }
    for (number, limit) in [(0, 0.21), (1, 0.18)] {
        let share = ends.iter().filter(|(least, most)| most - least <= limit).count() as f64 / COUNT as f64;
        let found = summary["statistics"]["requirements"][number]["share"].as_f64().unwrap();
        // Three standard errors of the direct count.
        let most = 3.0 * (share * (1.0 - share) / COUNT as f64).sqrt();
        println!("{found} {share} ± {most}");
        assert!((found - share).abs() < most, "{found} {share} ± {most}");
    }
}

/// A stack of five parts: H − a − b − c − d, 0.3 mm.
const STACK: &str = "
model: stack
parameters:
  H: { value: 50.3 mm, tolerance: 0.12 mm, distribution: normal }
  a: { value: 12 mm, tolerance: 0.05 mm, distribution: normal }
  b: { value: 15 mm, tolerance: 0.08 mm, distribution: uniform }
  c: { value: 13 mm, tolerance: 0.06 mm, distribution: triangular }
  d: { value: 10 mm, tolerance: 0.03 mm, distribution: normal }
bodies: { block: { mass: 1, coordinates: [x] } }
initial: { block.x: H - a - b - c - d, block.vx: 0 }
outputs: { gap: { formula: block.x, unit: mm } }
requirements: { fits: { output: gap, min: 0.05 mm, max: 0.7 mm } }
simulation: { duration: 0.02, step: 0.01, output_step: 0.01 }
bounds: { chebyshev: { order: 1 } }
";

#[test]
fn stack_has_worst_case_rss_and_statistics() {
    let place = Place::new();
    fs::write(place.path().join("stack.yaml"), STACK).unwrap();
    // One box may be too small, and is.
    let (printed, _) = place.run("run stack.yaml -o out", 4);
    // By hand: Σ t = 0.34 mm, √Σ t² = 0.166733 mm; variances t²/9 (normal), t²/3 (uniform), t²/6 (triangular):
    // 0.0686375 mm.
    for word in ["[-0.04000, 0.64000]", "± 0.34000", "± 0.16673", "0.30000 ±", "0.06864 ±", "  mm\n"] {
        assert!(printed.contains(word), "{word}: {printed}");
    }
    let summary = fs::read_to_string(place.path().join("out/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let found = &summary["statistics"]["outputs"][0];
    let near = |value: &serde_json::Value, wanted: f64, most: f64| {
        let value = value.as_f64().unwrap();
        assert!((value - wanted).abs() < most, "{value} {wanted}");
    };
    near(&found["worst_case"][0], -0.04e-3, 1e-12);
    near(&found["worst_case"][1], 0.64e-3, 1e-12);
    near(&found["linear"], 0.34e-3, 1e-12);
    near(&found["rss"], 0.166_733_32e-3, 1e-11);
    near(&found["deviation"]["value"], 0.068_637_53e-3, 1e-8);
    // Cpk = (0.3 − 0.05)/(3 σ), and Cp = (0.7 − 0.05)/(6 σ).
    let fits = &summary["statistics"]["requirements"][0];
    near(&fits["cpk"], 0.25 / (3.0 * 0.068_637_53), 1e-3);
    near(&fits["cp"], 0.65 / (6.0 * 0.068_637_53), 1e-3);
    let report = fs::read_to_string(place.path().join("out/report.html")).unwrap();
    for word in ["Worst case, root sum square and distribution", ">RSS<", "Parts that fail", ">Cpk<"] {
        assert!(report.contains(word), "{word}");
    }
}

/// The peak v²/2g of a ball that is thrown up, v normal: its quantiles are those of v, squared, and the mean is (v² +
/// σ²)/2g.
#[test]
fn reduced_outputs_have_quantiles() {
    let place = Place::new();
    let text = "
model: thrown
parameters: { v: { value: 2, unit: m/s, tolerance: 60 mm/s, distribution: normal } }
bodies: { ball: { mass: 1, coordinates: [y] } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { ball.y: 0, ball.vy: v }
outputs: { y: ball.y, peak: { max: y, unit: mm } }
statistics: { quantiles: [50%, 99.9%] }
simulation: { duration: 0.5, step: 1e-3, output_step: 0.25 }
bounds: { chebyshev: { order: 3 } }
";
    fs::write(place.path().join("thrown.yaml"), text).unwrap();
    let (printed, _) = place.run("run thrown.yaml -o out", 0);
    assert!(printed.contains("99.9 %: 216.6"), "{printed}");
    let table = fs::read_to_string(place.path().join("out/reduced_statistics.csv")).unwrap();
    let (heading, line) = table.split_once('\n').unwrap();
    assert_eq!(heading, "name,unit,mean,mean.error,deviation,deviation.error,q0.5,q0.5.error,q0.999,q0.999.error");
    let cells: Vec<f64> = line.trim().split(',').skip(2).map(|cell| cell.parse().unwrap()).collect();
    let of = |v: f64| v * v / 19.62;
    let wanted = [of(2.0) + 0.02 * 0.02 / 19.62, of(2.0), of(2.0 + 0.02 * 3.090_232_306)];
    for (found, wanted) in [(&cells[0..2], wanted[0]), (&cells[4..6], wanted[1]), (&cells[6..8], wanted[2])] {
        assert!((found[0] - wanted).abs() < 1.5 * found[1] + 1e-9 && found[1] < 1e-3 * wanted, "{found:?} {wanted}");
    }
}
