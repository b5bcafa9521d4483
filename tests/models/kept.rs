//! Surrogates stored after a run: their values anywhere in the box, against simulations there.

use mbint::inner::numerics::PointSet;
use mbint::inner::study::{self, Kept, Options};

use crate::common::{Subject, read, run};

/// Three outputs, of which one is a reaction; a second mechanism that does not interact.
const TWO: &str = "
parameters:
  r: { value: 0.12, unit: m, tolerance: 2% }
  tau: { value: -0.6, unit: N*m, tolerance: 3% }
  f: { value: 0.015, unit: N, tolerance: 40% }
  m1: 0.4
  m2: 0.7
bodies:
  crank: { mass: m1, inertia: m1*r^2/12, points: { A: [-r/2, 0], B: [r/2, 0] } }
  rod: { mass: m2, inertia: 0.0146, points: { B: [-0.25, 0], C: [0.25, 0] } }
  slider: { mass: 0.5, coordinates: [x] }
  ball: { mass: 1.5, coordinates: [y] }
joints:
  pivot: { revolute: [ground, crank.A] }
  pin: { revolute: [crank.B, rod.B] }
  wrist: { revolute: [rod.C, slider] }
effects:
  drive: { torque: { on: crank, value: tau } }
  lift: { force: { on: ball, value: [0, f] } }
initial: { crank.angle: 0.4, crank.angular_velocity: 0, ball.y: 0, ball.vy: 0 }
outputs: { x: slider.x, angle: crank.angle, force: pin.force, height: ball.y }
simulation: { duration: 0.4, step: 1e-3, output_step: 0.05 }
";

fn kept(description: &Subject, threads: usize) -> Kept {
    let options = Options { threads: Some(threads), ..Options::default() };
    study::run_keeping(description.study().description(), options).unwrap().2.expect("a surrogate")
}

const SAMPLES: [[f64; 3]; 4] =
    [[0.12, -0.6, 0.015], [0.1224, -0.618, 0.021], [0.1181, -0.594, 0.01], [0.1213, -0.585, 0.0175]];

/// Values are those of simulations with the same steps, or where a tolerance chose them with much shorter ones, within
/// the stated error and the tolerance.
fn agrees(text: &str, tolerance: f64) {
    let description = read(text);
    let kept = kept(&description, 2);
    let evaluator = kept.evaluator().unwrap();
    let step = if tolerance > 0.0 { 1e-4 } else { 1e-3 };
    let truths = description.study().step(step).sample(&SAMPLES.map(Vec::from)).unwrap();
    let every = [0, 1, 2, 3];
    let courses = every.map(|output| {
        let name = truths.outputs().nth(output).unwrap().0;
        [0, 1, 2, 3].map(|sample| truths.course(sample, name).unwrap())
    });
    let span = |output: usize| {
        let nominal = &courses[output][0];
        nominal.iter().fold(0.0_f64, |most, value| most.max((value - nominal[0]).abs()))
    };
    for (row, time) in kept.times().iter().enumerate() {
        let values = evaluator.values(row, &every, PointSet::of(&SAMPLES).points());
        for output in every {
            for (index, truth) in courses[output].iter().enumerate() {
                let (found, truth) = (values[output * SAMPLES.len() + index], truth[row]);
                let error = kept.error(output).total[row];
                let allowed = error + tolerance * span(output) + 1e-12;
                assert!((found - truth).abs() <= allowed, "{time}, {output}, {index}: {found} {truth} {error}");
            }
        }
    }
    assert_eq!(kept.times().len(), 9);
}

#[test]
fn surrogate_values_match_simulations_within_errors() {
    // Coordinates expanded, to an order and to a tolerance, and outputs expanded.
    agrees(&format!("{TWO}bounds: {{ chebyshev: {{ order: 3 }} }}"), 0.0);
    agrees(&format!("{TWO}bounds: {{ tolerance: 1e-4 }}"), 1e-4);
    agrees(&format!("{TWO}bounds: {{ chebyshev: {{ order: 3, expand: output }} }}"), 0.0);
    // A model that asks for no surrogate has one nevertheless.
    agrees(&format!("{TWO}bounds: {{ taylor: {{ order: 1 }} }}"), 0.0);
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let description = read(&format!("{TWO}bounds: {{ chebyshev: {{ order: 3 }} }}"));
    let bits = |threads: usize| -> Vec<u64> {
        let kept = kept(&description, threads);
        let samples: Vec<[f64; 3]> =
            (0..3000).map(|i| [0.1176 + 1.6e-6 * f64::from(i), -0.6, 0.01 + 1e-6 * f64::from(i)]).collect();
        kept.evaluator()
            .unwrap()
            .values(5, &[2, 3], PointSet::of(&samples).points())
            .into_iter()
            .map(f64::to_bits)
            .collect()
    };
    assert_eq!(bits(1), bits(2));
}

#[test]
fn keeping_changes_no_bound() {
    let description = read(&format!("{TWO}bounds: {{ chebyshev: {{ order: 2 }} }}"));
    let (kept, ..) = study::run_keeping(description.study().description(), Options::default()).unwrap();
    assert_eq!(kept, run(&description));
}
