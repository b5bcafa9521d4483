//! Small vibrations, against closed forms and against equations written by hand.

use mbint::results::{Bounds, Method, Verdict};

use crate::common::{nominal, ran, read, run, study_of};
use crate::statics::{close, ends, example, value};

const TAU: f64 = std::f64::consts::TAU;

fn frequency(bounds: &Bounds, mode: usize) -> f64 {
    TAU * value(bounds, &format!("mode{mode}.frequency"))
}

#[test]
fn modes_of_two_masses_match_the_closed_form() {
    let bounds = run(&example("modes.yaml"));
    let (k, m, c) = (100.0, 2.0, 0.2);
    for (mode, sign) in [(1, -1.0), (2, 1.0)] {
        let factor = (3.0 + sign * 5.0_f64.sqrt()) / 2.0;
        let omega = |k: f64, m: f64| (k / m * factor).sqrt();
        close(frequency(&bounds, mode), omega(k, m), 1e-11);
        // Damping in proportion to stiffness.
        close(value(&bounds, &format!("mode{mode}.damping")), c / k * omega(k, m) / 2.0, 1e-9);
        // x2/x1 = 2 − ω² m/k.
        let [x1, x2] = [1, 2].map(|x| value(&bounds, &format!("mode{mode}.shape.x{x}")));
        close(x2 / x1, 2.0 - factor, 1e-9);
        for method in [Method::Chebyshev, Method::Scan] {
            let [lower, upper, error] = ends(&bounds, &format!("mode{mode}.frequency"), method);
            assert!((TAU * lower - omega(95.0, 2.04)).abs() <= TAU * error + 1e-10, "{mode} {method:?}");
            assert!((TAU * upper - omega(105.0, 1.96)).abs() <= TAU * error + 1e-10, "{mode} {method:?}");
            assert!(error < 1e-3 * (upper - lower), "{mode} {method:?}: {error}");
        }
    }
    assert_eq!(bounds.responses.len(), 25);
    for point in &bounds.responses {
        // (K + iωC − ω²M) x = (0, 1) by Cramer's rule; x1 = −K12/det.
        let omega = TAU * point.frequency;
        let complex = |k: f64| (k, k * omega * c / 100.0);
        let (a, b, d) = (complex(200.0), complex(-100.0), complex(100.0));
        let (a, d) = ((a.0 - omega * omega * m, a.1), (d.0 - omega * omega * m, d.1));
        let times = |x: (f64, f64), y: (f64, f64)| (x.0 * y.0 - x.1 * y.1, x.0 * y.1 + x.1 * y.0);
        let (ad, bb) = (times(a, d), times(b, b));
        let det = (ad.0 - bb.0, ad.1 - bb.1);
        let amplitude = b.0.hypot(b.1) / det.0.hypot(det.1);
        close(point.amplitude.nominal[0], amplitude, 1e-9);
        let phase = (-b.1).atan2(-b.0) - det.1.atan2(det.0);
        let turns = (point.phase.nominal[0] - phase) / TAU;
        assert!((turns - turns.round()).abs() < 1e-9, "{turns}");
    }
    let page = include_str!("../../docs/guides/modes.md");
    assert!(page.contains(include_str!("../../docs/examples/modes.yaml")), "the page shows the example");
}

#[test]
fn a_double_pendulum_vibrates_about_rest_in_every_formulation() {
    for formulation in ["absolute", "joint"] {
        let text = format!(
            "
analysis: modes
modes: {{ at: equilibrium }}
parameters: {{ l: {{ value: 0.5, tolerance: 4% }} }}
bodies:
  upper: {{ mass: 1, inertia: 1e-9, points: {{ O: [0, l] }} }}
  lower: {{ mass: 1, inertia: 1e-9, points: {{ A: [0, l] }} }}
joints: {{ top: {{ revolute: [ground, upper.O] }}, middle: {{ revolute: [upper, lower.A] }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
guess: {{ upper.angle: 0.3, lower.angle: -0.2 }}
outputs: {{ a: upper.angle, b: lower.angle }}
simulation: {{ duration: 1, formulation: {formulation} }}
bounds: {{ chebyshev: {{ order: 4 }} }}
"
        );
        let bounds = run(&read(&text));
        assert!(value(&bounds, "a").abs() < 1e-10);
        for (mode, sign) in [(1, -1.0), (2, 1.0)] {
            let omega = |l: f64| (9.81 / l * (2.0 + sign * 2.0_f64.sqrt())).sqrt();
            // The inertias are not quite nothing.
            close(frequency(&bounds, mode), omega(0.5), 1e-7);
            let [lower, upper, error] = ends(&bounds, &format!("mode{mode}.frequency"), Method::Chebyshev);
            assert!((TAU * lower - omega(0.52)).abs() <= TAU * error + 1e-6, "{formulation} {mode}");
            assert!((TAU * upper - omega(0.48)).abs() <= TAU * error + 1e-6, "{formulation} {mode}");
            let [a, b] = ["a", "b"].map(|x| value(&bounds, &format!("mode{mode}.shape.{x}")));
            close(b / a, -sign * 2.0_f64.sqrt(), 1e-6);
        }
    }
}

/// m ẍ + c ẋ + k x = 0 with m = 2, k = 50 (ω = 5).
fn oscillator(damping: &str) -> String {
    format!(
        "
analysis: modes
parameters: {{ c: {damping} }}
bodies: {{ mass: {{ mass: 2, coordinates: [x] }} }}
effects: {{ spring: {{ spring_damper: {{ between: [ground, mass], along: x, stiffness: 50, damping: c, free_length: 0 }} }} }}
outputs: {{ x: mass.x }}
bounds: {{ chebyshev: {{ order: 4 }} }}
"
    )
}

#[test]
fn damping_is_smooth_through_the_critical_value() {
    for damping in [0.4, 8.0, 19.0, 30.0] {
        let bounds = nominal(&read(&oscillator(&damping.to_string())));
        close(frequency(&bounds, 1), 5.0, 1e-9);
        close(value(&bounds, "mode1.damping"), damping / (2.0 * 2.0 * 5.0), 1e-9);
    }
    // Critical damping, 20, lies within.
    let bounds = run(&read(&oscillator("{ value: 20, tolerance: 4.9 }")));
    let [lower, upper, error] = ends(&bounds, "mode1.damping", Method::Chebyshev);
    assert!(
        (lower - 15.1 / 20.0).abs() < error + 1e-6 && (upper - 24.9 / 20.0).abs() < error + 1e-6,
        "{lower} {upper} {error}"
    );
    assert!(error < 1e-3, "{error}");
}

#[test]
fn modes_that_cross_are_followed_by_their_shapes() {
    let text = "
analysis: modes
parameters: { k: { value: 45, interval: [30, 70] } }
bodies: { a: { mass: 2, coordinates: [x] }, b: { mass: 2, coordinates: [x] } }
effects:
  of_a: { spring_damper: { between: [ground, a], along: x, stiffness: k, damping: 0, free_length: 0 } }
  of_b: { spring_damper: { between: [ground, b], along: x, stiffness: 50, damping: 0, free_length: 0 } }
outputs: { a: a.x, b: b.x }
bounds: { chebyshev: { order: 9 }, scan: { points: 31 } }
";
    let bounds = run(&read(text));
    for method in [Method::Chebyshev, Method::Scan] {
        let [lower, upper, error] = ends(&bounds, "mode1.frequency", method);
        assert!((TAU * lower - 15.0_f64.sqrt()).abs() < TAU * error + 1e-6, "{method:?} {lower}");
        assert!((TAU * upper - 35.0_f64.sqrt()).abs() < TAU * error + 1e-6, "{method:?} {upper}");
        let [lower, upper, error] = ends(&bounds, "mode2.frequency", method);
        assert!(upper - lower < 1e-9 + error && (TAU * lower - 5.0).abs() < TAU * error + 1e-9, "{method:?}");
    }
}

#[test]
fn modes_of_a_pendulum_on_a_cart_match_its_equations() {
    // A cart on a spring with a compound pendulum: M = [m + M, m l; m l, J + m l²], K = [k, 0; 0, m g l] at rest.
    let text = |formulation: &str| {
        format!(
            "
analysis: modes
modes: {{ at: equilibrium }}
bodies:
  cart: {{ mass: 3, coordinates: [x] }}
  bar: {{ mass: 2, inertia: 0.1, points: {{ pin: [0, 0.6] }} }}
joints: {{ pin: {{ revolute: [cart, bar.pin] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  spring: {{ spring_damper: {{ between: [ground, cart], along: x, stiffness: 80, damping: 0, free_length: 0 }} }}
outputs: {{ x: cart.x, angle: bar.angle }}
simulation: {{ duration: 1, formulation: {formulation} }}
"
        )
    };
    let (m11, m12, m22) = (5.0, 2.0 * 0.6, 0.1 + 2.0 * 0.36);
    let (k11, k22) = (80.0, 2.0 * 9.81 * 0.6);
    let det = m11 * m22 - m12 * m12;
    for formulation in ["absolute", "joint"] {
        let bounds = nominal(&read(&text(formulation)));
        let squares = [1, 2].map(|mode| frequency(&bounds, mode).powi(2));
        close(squares[0] * squares[1], k11 * k22 / det, 1e-9);
        close(squares[0] + squares[1], (m22 * k11 + m11 * k22) / det, 1e-9);
    }
}

#[test]
fn modes_of_a_motion_are_given_in_every_row() {
    // A pendulum that swings: its stiffness is m g l cos θ, that of its own row.
    let text = "
analysis: modes
modes: { at: motion, number: 1 }
bodies: { bar: { mass: 2, inertia: 0.1, points: { pin: [0, 0.6] } } }
joints: { pin: { revolute: [ground, bar.pin] } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { bar.angle: 0.8 }
outputs: { angle: bar.angle }
simulation: { duration: 0.2, step: 1e-3, output_step: 0.1 }
";
    let bounds = nominal(&read(text));
    let frequencies = &bounds.outputs.iter().find(|output| output.name == "mode1.frequency").unwrap().nominal;
    assert_eq!(frequencies.len(), 3);
    for (frequency, angle) in frequencies.iter().zip(&bounds.outputs[0].nominal) {
        close((TAU * frequency).powi(2), 2.0 * 9.81 * 0.6 * angle.cos() / (0.1 + 2.0 * 0.36), 1e-8);
    }
}

#[test]
fn a_cantilever_of_beam_elements_vibrates_as_a_continuum() {
    let text = "
analysis: modes
modes: { number: 3 }
bodies:
  blade:
    beam: { length: 1.2, mass_per_length: 0.8, axial_stiffness: 2e6, bending_stiffness: 30, damping: 0 s, elements: 8 }
joints: { root: { fixed: [ground, blade.start] } }
outputs: { tip: blade.end.y }
";
    let bounds = nominal(&read(text));
    // cos a cosh a = −1.
    for (mode, (root, tolerance)) in
        [(1.875_104_069, 1e-3), (4.694_091_133, 2e-3), (7.854_757_438, 1e-2)].into_iter().enumerate()
    {
        let omega = (root / 1.2_f64).powi(2) * (30.0 / 0.8_f64).sqrt();
        close(frequency(&bounds, mode + 1), omega, tolerance);
    }
}

#[test]
fn damped_modes_of_a_chain_match_another_solver() {
    let text = "
analysis: modes
modes: { responses: { end: { load: x3, output: x1, from: 1.5, to: 6, points: 3 } } }
bodies:
  a: { mass: 2, coordinates: [x] }
  b: { mass: 3, coordinates: [x] }
  c: { mass: 1.5, coordinates: [x] }
effects:
  s1: { spring_damper: { between: [ground, a], along: x, stiffness: 400, damping: 4, free_length: 0 } }
  s2: { spring_damper: { between: [a, b], along: x, stiffness: 250, damping: 2, free_length: 0 } }
  s3: { spring_damper: { between: [b, c], along: x, stiffness: 300, damping: 0, free_length: 0 } }
  s4: { spring_damper: { between: [ground, c], along: x, stiffness: 150, damping: 1, free_length: 0 } }
outputs: { x1: a.x, x2: b.x, x3: c.x }
";
    let bounds = nominal(&read(text));
    // scipy.linalg.eigvals of [0 I; −M⁻¹K −M⁻¹C], and scipy.linalg.solve at 3 Hz.
    let modes = [
        (1.237_608_876_995_198_7, 0.030_727_455_612_764_23),
        (2.850_661_354_825_539_7, 0.056_503_081_317_016_96),
        (3.282_149_244_380_440_3, 0.044_402_608_476_486_645),
    ];
    for (mode, (frequency, damping)) in modes.into_iter().enumerate() {
        close(value(&bounds, &format!("mode{}.frequency", mode + 1)), frequency, 1e-11);
        close(value(&bounds, &format!("mode{}.damping", mode + 1)), damping, 1e-9);
    }
    let middle = &bounds.responses[1];
    close(middle.frequency, 3.0, 1e-12);
    close(middle.amplitude.nominal[0], 0.007_119_005_606_388_189, 1e-10);
    close(middle.phase.nominal[0], 0.557_649_985_064_347_9, 1e-9);
}

#[test]
fn damped_modes_of_a_plate_in_space_match_another_solver() {
    // Six springs and dampers that are not stretched: K = Σ k a aᵀ and C = Σ c a aᵀ with a = (n, r × n), M = diag(m, m,
    // m, J).
    let text = "
analysis: modes
bodies:
  ground: { points: { e1: [-0.1, 0.2, 0.1], e2: [0.3, -0.6, 0.1], e3: [-0.3, 0.2, -0.5], e4: [-0.54, -0.52, 0.1], e5: [0.2, -0.14, -0.42], e6: [-0.42, 0.2, 0.39] } }
  plate:
    mass: 3 kg
    inertia: [0.04, 0.07, 0.09]
    points: { c1: [0.3, 0.2, 0.1], c2: [0.3, -0.2, 0.1], c3: [-0.3, 0.2, -0.1], c4: [-0.3, -0.2, 0.1], c5: [0.2, 0.1, -0.1], c6: [-0.1, 0.2, 0.15] }
effects:
  s1: { spring_damper: { between: [ground.e1, plate.c1], stiffness: 900, damping: 4, free_length: 0.4 } }
  s2: { spring_damper: { between: [ground.e2, plate.c2], stiffness: 1100, damping: 2, free_length: 0.4 } }
  s3: { spring_damper: { between: [ground.e3, plate.c3], stiffness: 1300, damping: 9, free_length: 0.4 } }
  s4: { spring_damper: { between: [ground.e4, plate.c4], stiffness: 700, damping: 3, free_length: 0.4 } }
  s5: { spring_damper: { between: [ground.e5, plate.c5], stiffness: 1500, damping: 1, free_length: 0.4 } }
  s6: { spring_damper: { between: [ground.e6, plate.c6], stiffness: 800, damping: 6, free_length: 0.4 } }
initial: { plate.x: 0, plate.y: 0, plate.z: 0 }
outputs: { z: plate.z }
";
    let bounds = nominal(&read(text));
    // scipy.linalg.eigvals of [0 I; −M⁻¹K −M⁻¹C], assembled by hand from the directions and the positions of the
    // springs.
    let modes = [
        (0.116_832_375_287, 0.002_263_414_410_92),
        (1.189_384_085_99, 0.016_671_339_379_4),
        (4.258_541_661_09, 0.043_244_113_677_4),
        (5.890_156_534_22, 0.045_945_623_761_7),
        (9.153_651_496_19, 0.086_443_297_536_7),
        (9.862_597_950_21, 0.194_843_356_865),
    ];
    for (mode, (frequency, damping)) in modes.into_iter().enumerate() {
        close(value(&bounds, &format!("mode{}.frequency", mode + 1)), frequency, 1e-10);
        close(value(&bounds, &format!("mode{}.damping", mode + 1)), damping, 1e-9);
    }
}

#[test]
fn modes_that_veer_stay_on_their_branches() {
    // Two oscillators with a weak spring between them: equal at k = 50, where their frequencies come near and part
    // again.
    let text = "
analysis: modes
parameters: { k: { value: 50, interval: [30, 70] } }
bodies: { a: { mass: 2, coordinates: [x] }, b: { mass: 2, coordinates: [x] } }
effects:
  of_a: { spring_damper: { between: [ground, a], along: x, stiffness: k, damping: 0, free_length: 0 } }
  of_b: { spring_damper: { between: [ground, b], along: x, stiffness: 50, damping: 0, free_length: 0 } }
  weak: { spring_damper: { between: [a, b], along: x, stiffness: 6, damping: 0, free_length: 0 } }
outputs: { a: a.x, b: b.x }
bounds: { chebyshev: { order: 12 }, scan: { points: 41 } }
";
    let bounds = run(&read(text));
    // Eigenvalues of [k + 6, −6; −6, 56] / 2.
    let omega = |k: f64, sign: f64| {
        let (middle, half) = (0.5 * (k + 50.0) + 6.0, 0.5 * (k - 50.0));
        (0.5 * (middle + sign * half.hypot(6.0))).sqrt()
    };
    for (mode, sign) in [(1, -1.0), (2, 1.0)] {
        close(frequency(&bounds, mode), omega(50.0, sign), 1e-11);
        for method in [Method::Chebyshev, Method::Scan] {
            let [lower, upper, error] = ends(&bounds, &format!("mode{mode}.frequency"), method);
            assert!((TAU * lower - omega(30.0, sign)).abs() <= TAU * error + 1e-9, "{mode} {method:?} {lower} {error}");
            assert!((TAU * upper - omega(70.0, sign)).abs() <= TAU * error + 1e-9, "{mode} {method:?} {upper} {error}");
            assert!(error < 0.02 * (upper - lower), "{mode} {method:?} {error}");
        }
    }
}

#[test]
fn bounds_of_a_response_match_closed_forms() {
    let text = "
analysis: modes
modes: { responses: { push: { load: x, output: x, from: 0.4, to: 1.6, points: 9 } } }
parameters: { k: { value: 50, unit: N/m, tolerance: 10% } }
bodies: { mass: { mass: 2, coordinates: [x] } }
effects: { spring: { spring_damper: { between: [ground, mass], along: x, stiffness: k, damping: 8, free_length: 0 } } }
outputs: { x: mass.x }
bounds: { chebyshev: { order: 8 }, scan: { points: 101 } }
";
    let bounds = run(&read(text));
    assert_eq!(bounds.responses.len(), 9);
    for point in &bounds.responses {
        let omega = TAU * point.frequency;
        // The dynamic stiffness k − m ω² + i c ω is least where k is nearest to m ω².
        let amplitude = |k: f64| 1.0 / (k - 2.0 * omega * omega).hypot(8.0 * omega);
        let most = amplitude((2.0 * omega * omega).clamp(45.0, 55.0));
        let least = amplitude(45.0).min(amplitude(55.0));
        let phase = |k: f64| -(8.0 * omega).atan2(k - 2.0 * omega * omega);
        for (output, lower, upper) in [(&point.amplitude, least, most), (&point.phase, phase(45.0), phase(55.0))] {
            for band in &output.bands {
                let error = band.error.total[0] + 1e-9;
                let place = (band.method, point.frequency, band.lower[0], band.upper[0], error);
                assert!((band.lower[0] - lower).abs() <= error, "{} {place:?} {lower}", output.name);
                assert!((band.upper[0] - upper).abs() <= error, "{} {place:?} {upper}", output.name);
                assert!(error < 0.05 * (upper - lower), "{} {place:?}", output.name);
            }
        }
    }
}

/// f = √(k/m)/2π and ζ = c/(2 √(k m)) of one mass over the box: margins of requirements on them, and on the response
/// k⁻¹ of slow loads, and which tolerance matters: of ln f, k and m have ½ each.
#[test]
fn margins_of_frequency_requirements_match_closed_forms() {
    let text = |limits: &str| {
        format!(
            "
analysis: modes
modes: {{ at: equilibrium, number: 1, responses: {{ slow: {{ load: x, output: x, from: 1e-4, to: 1e-3, points: 2 }} }} }}
parameters: {{ k: {{ value: 400, unit: N/m, tolerance: 5% }}, m: {{ value: 1, unit: kg, tolerance: 2% }}, drive: 3 }}
bodies: {{ block: {{ mass: m, coordinates: [x] }} }}
effects: {{ s: {{ spring_damper: {{ between: [ground, block], along: x, stiffness: k, damping: 4, free_length: 0 }} }} }}
outputs: {{ x: block.x }}
requirements: {{ {limits} }}
bounds: {{ chebyshev: {{ order: 6 }}, scan: {{ points: 5 }} }}
"
        )
    };
    let limits = "above: mode1.frequency >= drive*0.9, damped: { output: mode1.damping, min: 0.09, max: 0.105 }, \
                  soft: slow.amplitude <= 2.6e-3, low: mode1.frequency <= 3.2";
    let (bounds, summary) = ran(study_of(&text(limits)));
    let frequency = |k: f64, m: f64| (k / m).sqrt() / std::f64::consts::TAU;
    let damping = |k: f64, m: f64| 4.0 / (2.0 * (k * m).sqrt());
    let wanted = [
        (frequency(380.0, 1.02) - 2.7, Verdict::Holds),
        ((damping(420.0, 1.02) - 0.09).min(0.105 - damping(380.0, 0.98)), Verdict::Holds),
        (2.6e-3 - 1.0 / 380.0, Verdict::Violated),
        (3.2 - frequency(420.0, 0.98), Verdict::Violated),
    ];
    for (own, (margin, verdict)) in summary.requirements.iter().zip(wanted) {
        assert_eq!(own.verdict, verdict, "{own:?}");
        assert!(
            (own.margin - margin).abs() < 1e-5 * margin.abs().max(0.1) + own.error,
            "{}: {} for {margin}",
            own.name,
            own.margin
        );
    }
    assert_eq!(summary.requirements.len(), wanted.len());
    // Only the model's own outputs and the analysis' results are shown.
    assert!(bounds.outputs.iter().all(|output| !output.name.contains("above")), "{:?}", bounds.outputs);
    let shares = &bounds.contributions[bounds.outputs.iter().position(|own| own.name == "mode1.frequency").unwrap()];
    let of = |name: &str| shares.iter().find(|own| own.parameter == name).unwrap().main[0];
    let (k, m) = (0.05_f64.powi(2), 0.02_f64.powi(2));
    assert!((of("k") - k / (k + m)).abs() < 2e-3 && (of("m") - m / (k + m)).abs() < 2e-3, "{} {}", of("k"), of("m"));
    assert_eq!(bounds.responses[0].contributions[0].len(), 2);
    assert!((bounds.responses[0].contributions[0][0].main[0] - 1.0).abs() < 1e-6);
}
