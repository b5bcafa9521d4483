//! Every reduction against its closed form, and its cost for models that reduce nothing.

use mbint::inner::compile::Tapes;
use mbint::inner::export::bounds_csv;
use mbint::inner::study;

use crate::common::{Subject, read, run_methods};

/// x = A cos(ωt), ω² = k/m: no damping, from rest.
const OSCILLATOR: &str = "
parameters: { m: 1.7 kg, A: 0.12 m ± 8%, k: 71 N/m ± 4% }
bodies: { block: { mass: m, coordinates: [x] } }
effects: { spring: { force: { on: block, value: [-k*block.x, 0] } } }
initial: { block.x: A, block.vx: 0 }
outputs:
  x: block.x
  v: block.vx
";

const REDUCED: &str = "
  range: { range: x }
  max: { max: x, from: 0.3 }
  min: { min: x }
  max_abs: { max_abs: v }
  final: { final: x }
  final_earlier: { final: x, to: 0.3137 s }
  value: { value: x, at: 0.2271 s }
  mean: { mean: x, from: 0.1, to: 0.8 }
  rms: { rms: x, from: 0.1, to: 0.8 }
  integral: { integral: x, from: 0.1, to: 0.3 }
  time_of_max: { time_of_max: v }
  time_of_min: { time_of_min: v }
  when: { when: x < -0.031 m }
  last_when: { last_when: x < -0.031 m }
  settling: { settling: x, target: 0.02 m, band: 40 mm, to: 0.4 }
  overshoot: { overshoot: x, target: 0.02 m }
  overshoot_of_end: { overshoot: v, to: 0.62 }
  straight: { straightness: [x, 0.5*block.x + 0.01 m] }
  bent: { straightness: [x, block.x^2/(0.4 m)] }
  off: { straightness: block.x^2/(1 m), line: 0.1*block.x + 0.001 m }
";

const SIMULATION: &str = "
simulation: { duration: 1.1 s, step: 2 ms, output_step: 20 ms }
bounds: { chebyshev: { order: 6 } }
";

/// The closed form of each, of amplitude and frequency.
fn closed(name: &str, a: f64, w: f64) -> f64 {
    use std::f64::consts::PI;
    let x = |t: f64| a * (w * t).cos();
    let integral = |from: f64, to: f64| a / w * ((w * to).sin() - (w * from).sin());
    // When x passes a level on its way down, first.
    let down = |level: f64| (level / a).acos() / w;
    match name {
        "range" => 2.0 * a,
        "max" => a,
        "min" => -a,
        "max_abs" => a * w,
        "final" => x(1.1),
        "final_earlier" => x(0.3137),
        "value" => x(0.2271),
        "mean" => integral(0.1, 0.8) / 0.7,
        "rms" => a * (0.5 + ((1.6 * w).sin() - (0.2 * w).sin()) / (4.0 * w * 0.7)).sqrt(),
        "integral" => integral(0.1, 0.3),
        "time_of_max" => 1.5 * PI / w,
        "time_of_min" => 0.5 * PI / w,
        "when" => down(-0.031),
        "last_when" => 2.0 * PI / w - down(-0.031),
        // Outside of [-0.02, 0.06] until it falls below 0.06, and outside again from -0.02 on: it has not settled at
        // 0.4 s.
        "settling" => f64::NAN,
        "overshoot" => 0.02 + a,
        // From rest to v(0.62) > 0, of which the maximum comes later or earlier.
        "overshoot_of_end" => {
            let end = -a * w * (0.62 * w).sin();
            if 0.62 * w < 1.5 * PI { 0.0 } else { a * w - end }
        }
        "straight" => 0.0,
        "bent" => a * a / 0.4,
        "off" => a * a + 0.1 * a - 0.001,
        _ => unreachable!("{name}"),
    }
}

#[test]
fn every_reduction_matches_its_closed_form() {
    let (_, summary) = run_methods(&read(&[OSCILLATOR, REDUCED, SIMULATION].concat()), None);
    for own in &summary.reduced {
        let band = &own.bands[0];
        if own.name == "settling" {
            assert!(own.occurs.as_ref().is_some_and(|occurs| occurs.samples == 0), "{own:?}");
            continue;
        }
        assert!(!band.unresolved, "{own:?}");
        // Corners and a lattice: all are monotonic, or smooth with extremes that the lattice knows to 1e-9.
        let (mut lower, mut upper) = (f64::INFINITY, f64::NEG_INFINITY);
        for i in 0..=200 {
            for j in 0..=200 {
                let share = |place: i32| f64::from(place) / 100.0 - 1.0;
                let (a, k) = (0.12 * (1.0 + 0.08 * share(i)), 71.0 * (1.0 + 0.04 * share(j)));
                let value = closed(&own.name, a, (k / 1.7).sqrt());
                (lower, upper) = (lower.min(value), upper.max(value));
            }
        }
        let off = (band.lower - lower).abs().max((band.upper - upper).abs());
        println!("{}: [{lower}, {upper}], off by {off:.1e}, stated {:.1e}", own.name, band.error);
        assert!(off <= band.error + 1e-9, "{}: [{lower}, {upper}] {band:?}", own.name);
        assert!(band.error <= 1e-3 * (1e-3 + upper.abs().max(lower.abs())), "{}: {band:?}", own.name);
        // The worst cases are simulated samples: their values are those of their parameters, near the ends of the
        // bounds.
        let [least, greatest] = own.worst.as_ref().unwrap();
        for case in [least, greatest] {
            let [a, k] = case.parameters[..] else { panic!("{case:?}") };
            let value = closed(&own.name, a, (k / 1.7).sqrt());
            assert!((case.value - value).abs() <= band.error + 1e-9, "{}: {case:?} {value}", own.name);
        }
        let width = upper - lower;
        assert!(least.value - lower <= 0.1 * width + band.error, "{}: {least:?}", own.name);
        assert!(upper - greatest.value <= 0.1 * width + band.error, "{}: {greatest:?}", own.name);
    }
}

/// Instructions of every tape.
fn instructions(description: &Subject) -> Vec<usize> {
    let simulator = study::prepare(description.study().description()).unwrap();
    let p = &simulator.program;
    let tapes = [p.sample(), p.step_size(), p.step(), p.factor(), p.correct(), p.advance(), p.observe(), p.matrix()];
    tapes.map(|tape| tape.len()).to_vec()
}

/// Sections that ask for nothing, and requests that were taken out again, leave bytes, instructions and simulations as
/// they were.
#[test]
fn empty_sections_cost_nothing() {
    let plain = [OSCILLATOR, SIMULATION].concat();
    let of = |text: &str| {
        let description = read(text);
        let (bounds, summary) = run_methods(&description, None);
        let simulations: Vec<(String, usize)> =
            summary.methods.iter().map(|method| (method.method.clone(), method.simulations)).collect();
        assert!(summary.reduced.is_empty() && summary.requirements.is_empty() && summary.statistics.is_none());
        (instructions(&description), bounds_csv(&bounds).unwrap(), simulations)
    };
    let known = of(&plain);
    assert!(known.2.iter().all(|(method, _)| method != "reduced outputs"), "{:?}", known.2);
    let named = plain.replace("A: 0.12 m ± 8%", "A: { value: 0.12 m, tolerance: 8%, cost: { reciprocal: 2 } }");
    assert!(named != plain && of(&named) == known);
    assert!(of(&format!("{plain}requirements: {{}}\n")) == known);
    assert!(of(&plain.replace("\nbodies", "\nanalysis: motion\nbodies")) == known);
}
