//! Invariance of bounds, by any method: under a shift of the origin, the order of the parameters, the units, and the
//! way round in which the mechanism is built.

use mbint::results::{Bounds, Method};

use crate::common::{Subject, band, output, read, run};
use crate::honesty_search::{assert_honest, oscillators, sum};

/// Every method, and a degree that follows from a tolerance.
const METHODS: &str = "chebyshev: { order: 8 }, taylor: { order: 4 }, scan: { points: 9 }";

/// Largest distance of two bands of any method: over the width of the first, and over the errors that both state. `map`
/// takes the ends of the second to those of the first.
fn apart(a: (&Bounds, &str), b: (&Bounds, &str), map: impl Fn(f64, f64) -> (f64, f64)) -> [f64; 2] {
    let (a, b) = (output(a.0, a.1), output(b.0, b.1));
    let methods: Vec<Method> = a.bands.iter().map(|band| band.method).collect();
    assert_eq!(methods, b.bands.iter().map(|band| band.method).collect::<Vec<_>>());
    let of_method = |method: Method| {
        let (a, b) = (band(a, method), band(b, method));
        let rows = 0..a.lower.len();
        let width = rows.clone().map(|row| a.upper[row] - a.lower[row]).fold(0.0, f64::max);
        let of_row = |row: usize| {
            let (lower, upper) = map(b.lower[row], b.upper[row]);
            let distance = (a.lower[row] - lower).abs().max((a.upper[row] - upper).abs());
            [distance / width, distance / (a.error.total[row] + b.error.total[row] + 1e-9 * width)]
        };
        larger(rows.map(of_row))
    };
    larger(methods.into_iter().map(of_method))
}

fn larger(found: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    found.fold([0.0; 2], |most, found| [f64::max(most[0], found[0]), f64::max(most[1], found[1])])
}

/// Samples between nodes are elsewhere in a box that is turned or mirrored. With a degree and steps that follow from a
/// tolerance they decide on these, and bounds agree within their errors; others hold their values, and agree within a
/// small part of them. Where samples are the same, so are bounds.
fn assert_same(bounds: &str, what: &str, [of_width, of_errors]: [f64; 2], least: f64) {
    println!("{bounds}, {what}: {of_width:.1e} of the width, {of_errors:.1e} of the errors");
    let same = match (bounds.contains("tolerance"), what) {
        (true, _) => of_errors < 1.0,
        (false, "order" | "sides") => of_errors < 0.1,
        (false, _) => of_width < least,
    };
    assert!(same, "{bounds}, {what}: {of_width:e} of the width, {of_errors:e} of the errors");
}

#[test]
fn bounds_of_oscillators_are_invariant() {
    let parts = [(0.11, 1.2, 15.0), (0.07, 0.9, 12.0)];
    let with =
        |bounds: &str| format!("simulation: {{ duration: 40, step: 0.02, output_step: 0.5 }}\nbounds: {bounds}\n");
    let outputs = "{ x: b0.x + b1.x, w: \"sin(30*b0.x)*cos(20*b1.x)\" }";
    for bounds in [
        "{ chebyshev: { order: 10 } }".to_owned(),
        format!("{{ {METHODS} }}"),
        "{ chebyshev: { order: 10, expand: output } }".to_owned(),
        "{ tolerance: 1e-2 }".to_owned(),
    ] {
        let settings = with(&bounds);
        let known = run(&oscillators(&parts, outputs, 0.0, &settings));
        if bounds.contains("order: 10 }") {
            assert!(assert_honest(&known, "x", Method::Chebyshev, |t| sum(&parts, t)) == 81);
        }

        let far = "{ x: b0.x + b1.x, w: \"sin(30*(b0.x - 1000))*cos(20*(b1.x - 1000))\" }";
        let far = run(&oscillators(&parts, far, 1000.0, &settings));
        let back = |lower: f64, upper: f64| (lower - 2000.0, upper - 2000.0);
        let moved =
            [apart((&known, "x"), (&far, "x"), back), apart((&known, "w"), (&far, "w"), |lower, upper| (lower, upper))];
        // (The rounding errors at 1 km, and thirty times these.)
        assert!(moved[0][0] < 1e-8 && moved[1][0] < 1e-8, "{bounds}, 1 km away: {moved:?}");

        let swapped = [parts[1], parts[0]];
        let permuted = "{ x: b1.x + b0.x, w: \"sin(30*b1.x)*cos(20*b0.x)\" }";
        let permuted = run(&oscillators(&swapped, permuted, 0.0, &settings));
        let mirrored = [(-parts[0].0, parts[0].1, parts[0].2), (-parts[1].0, parts[1].1, parts[1].2)];
        let mirrored = run(&oscillators(&mirrored, outputs, 0.0, &settings));
        let small = parts.map(|(a, k, share)| (1e-3 * a, k, share));
        let scaled = "{ x: b0.x + b1.x, w: \"sin(3e4*b0.x)*cos(2e4*b1.x)\" }";
        let scaled = run(&oscillators(&small, scaled, 0.0, &settings));
        for name in ["x", "w"] {
            let order = apart((&known, name), (&permuted, name), |lower, upper| (lower, upper));
            let sides = apart((&known, name), (&mirrored, name), |lower, upper| (-upper, -lower));
            let units = if name == "x" { 1e3 } else { 1.0 };
            let units = apart((&known, name), (&scaled, name), |lower, upper| (units * lower, units * upper));
            assert_same(&bounds, "order", order, 1e-9);
            assert_same(&bounds, "sides", sides, 1e-9);
            assert!(units[0] < 1e-9, "{bounds}, units: {units:?}");
        }
    }
}

/// A slider crank on a spring, whose bearing is at `origin`: lengths times `scale`, parameters in this order, seen from
/// behind where `side` is −1.
fn slider_crank(origin: (f64, f64), scale: f64, side: f64, parameters: [usize; 2], bounds: &str) -> Subject {
    let uncertain = [
        format!("  l1: {{ value: {}, unit: m, tolerance: 2% }}\n", 0.17 * scale),
        format!("  tau: {{ value: {}, unit: N*m, tolerance: 4% }}\n", 0.6 * side * scale * scale),
    ];
    let uncertain: String = parameters.iter().map(|&index| uncertain[index].as_str()).collect();
    let (x, y) = origin;
    let angle = 0.7 * side;
    read(&format!(
        "parameters:\n{uncertain}  l2: {{ value: {}, unit: m }}\nbodies:
  ground: {{ points: {{ O: [{x}, {y}] }} }}
  crank: {{ mass: 0.4 kg, inertia: \"0.4 kg * l1^2/12\", points: {{ A: [-l1/2, 0], B: [l1/2, 0] }} }}
  rod: {{ mass: 0.8 kg, inertia: \"0.8 kg * l2^2/12\", points: {{ B: [-l2/2, 0], C: [l2/2, 0] }} }}
  slider: {{ mass: 0.5 kg, coordinates: [x, y] }}
joints:
  pivot: {{ revolute: [ground.O, crank.A] }}
  pin: {{ revolute: [crank.B, rod.B] }}
  wrist: {{ revolute: [rod.C, slider] }}
  guide: {{ point_on_line: {{ between: [ground.O, slider], axis: [1, 0] }} }}
effects:
  drive: {{ torque: {{ on: crank, value: tau }} }}
  spring: {{ force: {{ on: slider, value: [\"-6 N/m * (slider.x - {x} - {} m)\", 0] }} }}
initial: {{ crank.angle: {angle}, crank.angular_velocity: 0 }}
outputs: {{ x: slider.x, angle: rod.angle, pin: pin.force, squared: \"(slider.x - {x})^2\" }}
simulation: {{ duration: 1, step: 1e-3, output_step: 0.02 }}
bounds: {{ {bounds} }}
",
        0.5 * scale,
        0.7 * scale,
    ))
}

#[test]
fn bounds_of_a_slider_crank_are_invariant() {
    for bounds in [METHODS, "chebyshev: { order: 5, expand: output }", "tolerance: 1e-2"] {
        let known = run(&slider_crank((0.0, 0.0), 1.0, 1.0, [0, 1], bounds));
        let ordered = run(&slider_crank((0.0, 0.0), 1.0, 1.0, [1, 0], bounds));
        let behind = run(&slider_crank((0.0, 0.0), 1.0, -1.0, [0, 1], bounds));
        let moved = run(&slider_crank((1000.0, -400.0), 1.0, 1.0, [0, 1], bounds));
        let larger = run(&slider_crank((0.0, 0.0), 100.0, 1.0, [0, 1], bounds));
        for (name, length) in [("x", 1.0), ("angle", 0.0), ("pin", 1.0), ("squared", 2.0)] {
            let factor = f64::powf(100.0, length);
            let turned = |lower: f64, upper: f64| if name == "angle" { (-upper, -lower) } else { (lower, upper) };
            let back = if name == "x" { 1000.0 } else { 0.0 };
            let same = |lower: f64, upper: f64| (lower, upper);
            assert_same(bounds, "order", apart((&known, name), (&ordered, name), same), 1e-9);
            assert_same(bounds, "sides", apart((&known, name), (&behind, name), turned), 1e-9);
            let size = |lower: f64, upper: f64| (lower / factor, upper / factor);
            let size = apart((&known, name), (&larger, name), size);
            assert!(size[0] < 1e-9, "{bounds}, size: {size:?}");
            // Newton's tolerance is relative to the largest length.
            let far = |lower: f64, upper: f64| (lower - back, upper - back);
            assert_same(bounds, "1 km", apart((&known, name), (&moved, name), far), 1e-7);
        }
    }
}
