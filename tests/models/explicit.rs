//! The explicit method of order 8: against references that other methods computed and closed forms, and cases outside
//! of its scope.

use mbint::results::Method;
use mbint::{RangeKind, SchemeChoice};

use crate::common::{
    Subject, band, curve, distance, distance_from, largest, model, nominal, output, read, reference, row, run,
    run_methods,
};

fn scheme(description: Subject, scheme: SchemeChoice) -> Subject {
    description.scheme(scheme)
}

/// The slider crank, whose loop is closed by projections, against DOP853 in minimal coordinates (error below 1e-8).
#[test]
fn the_slider_crank_is_within_its_tolerance() {
    for tolerance in [1e-3, 1e-5, 1e-6] {
        let description = model("slider_crank_one").observing(&["slider.x", "crank.angle"]).rows_every(0.05);
        let (bounds, summary) = run_methods(&description.tolerance(tolerance), Some(Vec::new()));
        assert_eq!(summary.integration.as_deref(), Some("Dormand–Prince 8(5,3), explicit"));
        for (name, column) in [("slider.x", 1), ("crank.angle", 2)] {
            let values = curve(&bounds, name);
            let states = reference("slider_crank/nominal_states.csv");
            let span = states.iter().map(|state| state[column]).fold(f64::NEG_INFINITY, f64::max)
                - states.iter().map(|state| state[column]).fold(f64::INFINITY, f64::min);
            let error = largest(states.iter().map(|state| values[row(&bounds, state[0])] - state[column])) / span;
            println!("{name} at {tolerance:e}: {error:.2e}, {} steps", summary.methods[0].steps);
            assert!(error < tolerance.max(1e-7), "{name} at {tolerance:e} is off by {error:e}");
        }
        // DOP853 in minimal coordinates takes 1250 evaluations for 5e-4 m, 3300 for 1e-6 m.
        assert!(12 * summary.methods[0].steps < 5000, "{} steps", summary.methods[0].steps);
    }
}

/// The pendulum in Cartesian coordinates: positions by Jacobi's elliptic functions, the tension by energy. Rows lie
/// between steps.
#[test]
fn dense_rows_match_the_motion_of_the_pendulum() {
    let rows = reference("iftomm/pendulum.csv");
    let description = model("pendulum").observing(&["bob.x", "bob.y", "rod.force + 3*9.81*bob.y"]).rows_every(0.01);
    let (bounds, summary) = run_methods(&description.tolerance(1e-8), Some(Vec::new()));
    assert!(summary.methods[0].steps < bounds.times.len() / 2, "rows are interpolated");
    let (x, y) = (curve(&bounds, "bob.x"), curve(&bounds, "bob.y"));
    let place = |line: &Vec<f64>| row(&bounds, line[0]);
    let error = largest(rows.iter().flat_map(|line| [x[place(line)] - line[1], y[place(line)] - line[2]]));
    let square = |row: usize| x[row] * x[row] + y[row] * y[row];
    let length = largest((0..x.len()).map(|row| square(row) - square(0)));
    let tension = largest(bounds.outputs[2].nominal[10..].iter().copied());
    println!("{} steps: positions {error:.2e}, length {length:.2e}, tension {tension:.2e}", summary.methods[0].steps);
    assert!(error < 1e-7 && length < 1e-12 && tension < 1e-5);
}

/// Over a box: a free oscillator, x₀ cos(√(k/m) t), by every method; jets are those of the motion.
#[test]
fn bounds_by_every_method_match_the_oscillator() {
    let text = "
parameters: { k: { value: 30, unit: N/m, tolerance: 3% } }
bodies: { block: { mass: 1.5, coordinates: [x] } }
effects: { spring: { spring_damper: { between: [ground, block], along: x, stiffness: k, damping: 0, free_length: 0 } } }
initial: { block.x: 0.02, block.vx: 0 }
outputs: { x: block.x, a: block.ax }
simulation: { duration: 3, output_step: 0.03, tolerance: 1e-8 }
bounds: { chebyshev: { order: 10 }, taylor: { order: 12 }, scan: { points: 41 } }
";
    let (bounds, summary) = run_methods(&read(text), None);
    assert!(summary.integration.is_some());
    for (name, power) in [("x", 0), ("a", 2)] {
        let exact = |k: f64, t: f64| {
            let omega = (k / 1.5).sqrt();
            0.02 * (omega * t).cos() * if power == 0 { 1.0 } else { -omega * omega }
        };
        for band in &output(&bounds, name).bands {
            for (row, &t) in bounds.times.iter().enumerate() {
                let values = (0..=2000).map(|i| exact(30.0 * (1.0 + 0.03 * (f64::from(i) / 1000.0 - 1.0)), t));
                let (lower, upper) =
                    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
                let error = (band.lower[row] - lower).abs().max((band.upper[row] - upper).abs());
                let stated = band.error.total[row] + 1e-9;
                assert!(error <= stated, "{name}.{} at {t}: {error:e} of {stated:e}", band.method.name());
            }
            println!("{name}.{}: of the steps {:.2e}", band.method.name(), band.error.time);
        }
    }
}

#[test]
fn tolerance_of_the_bounds_selects_the_explicit_method() {
    let description = model("slider_crank_one").asking(|study| study.tolerance(1e-4));
    let description = description.chebyshev(8, RangeKind::Tight).duration(1.5);
    let (bounds, summary) = run_methods(&description, None);
    assert_eq!(summary.integration.as_deref(), Some("Dormand–Prince 8(5,3), explicit"));
    let truth = reference("slider_crank/bounds_l1_1pct.csv");
    let band = band(&bounds.outputs[0], Method::Chebyshev);
    let error = largest(truth.iter().filter(|line| line[0] <= 1.5).flat_map(|line| {
        let row = row(&bounds, line[0]);
        [band.lower[row] - line[2], band.upper[row] - line[3]]
    }));
    assert!(error < 5e-5, "{error:e}");
}

/// A tolerance of the steps holds beside a looser one of the bounds: a free oscillator, x₀ cos(√(k/m) t).
#[test]
fn tolerance_of_the_steps_holds_beside_that_of_the_bounds() {
    let text = |own: &str| {
        format!(
            "
parameters: {{ k: {{ value: 30, unit: N/m, tolerance: 3% }} }}
bodies: {{ block: {{ mass: 1.5, coordinates: [x] }} }}
effects: {{ spring: {{ spring_damper: {{ between: [ground, block], along: x, stiffness: k, free_length: 0 }} }} }}
initial: {{ block.x: 0.02, block.vx: 0 }}
outputs: {{ x: block.x }}
simulation: {{ duration: 3, output_step: 0.03, {own} }}
bounds: {{ tolerance: 1e-2 }}
"
        )
    };
    let omega = (30.0_f64 / 1.5).sqrt();
    for (own, tolerance) in
        [("tolerance: 1e-9", 1e-9), ("scheme: explicit, tolerance: 1e-9", 1e-9), ("scheme: hht, tolerance: 1e-5", 1e-5)]
    {
        let (bounds, _) = run_methods(&read(&text(own)), None);
        let error = distance_from(&bounds.times, curve(&bounds, "x"), |t| 0.02 * (omega * t).cos()) / 0.04;
        let stated = band(output(&bounds, "x"), Method::Chebyshev).error.time / 0.04;
        println!("{own}: {error:.1e}, stated {stated:.1e}");
        assert!(error < tolerance && stated < tolerance, "{own}: off by {error:e}, stated {stated:e}");
    }
}

/// A stiff bushing: stability limits the explicit steps, which is reported, and `auto` takes HHT-I3.
#[test]
fn stiff_models_are_integrated_by_the_scheme() {
    let text = "
bodies: { block: { mass: 1, coordinates: [x] }, tip: { mass: 0.001, coordinates: [x] } }
effects:
  soft: { spring_damper: { between: [ground, block], along: x, stiffness: 20, damping: 0.1, free_length: 0 } }
  hard: { spring_damper: { between: [block, tip], along: x, stiffness: 1e6, damping: 200, free_length: 0 } }
initial: { block.x: 0.1, block.vx: 0, tip.x: 0.1, tip.vx: 0 }
outputs: { x: block.x }
simulation: { duration: 2, tolerance: 1e-5 }
";
    let (_, summary) = run_methods(&read(text), Some(Vec::new()));
    assert_eq!(summary.integration, None);
    let explicit = scheme(read(text), SchemeChoice::Explicit);
    let refused = explicit.refused();
    assert!(refused.contains("stiff from t = "), "{refused}");
}

/// A scheme that is asked for with a step takes that step, and switches are crossed within the stated error.
#[test]
fn steps_that_are_given_are_taken() {
    let description = model("double_pendulum").observing(&["lower.end.x"]).duration(1.0).rows_every(0.1);
    let exact = nominal(&scheme(description.clone().step(1e-3), SchemeChoice::Explicit));
    let [coarse, fine] = [0.05, 0.025].map(|h| {
        let bounds = nominal(&scheme(description.clone().step(h), SchemeChoice::Explicit));
        distance(&bounds.outputs[0].nominal, &exact.outputs[0].nominal)
    });
    println!("double pendulum: {coarse:.2e} at 0.05 s, {fine:.2e} at 0.025 s");
    // Half the steps: 2⁸ times less, rounding apart.
    assert!(coarse < 1e-5 && fine < coarse / 64.0);
    let plain = nominal(&description.step(5e-5));
    assert!(distance(&plain.outputs[0].nominal, &exact.outputs[0].nominal) < 1e-4);
}

#[test]
fn jets_follow_the_explicit_method() {
    let description = model("slider_crank_one").observing(&["slider.x"]).duration(0.5).rows_every(0.05).taylor(6);
    let fine = description.clone().step(5e-4).extrapolation(4);
    let (fine, explicit) = (run(&fine), run(&description.tolerance(1e-8)));
    let (band, exact) = (&explicit.outputs[0].bands[0], &fine.outputs[0].bands[0]);
    let error = largest(band.upper.iter().zip(&exact.upper).map(|(a, b)| a - b));
    println!("Taylor: {error:.2e}");
    assert!(error < 1e-8, "{error:e}");
}

/// `explain` names the method under a tolerance, and why it is not taken.
#[test]
fn explain_names_the_integrator_of_a_model() {
    let decisions = |bounds: &str, simulation: &str| -> Vec<String> {
        let text = include_str!("../../models/slider_crank_one.yaml")
            .replace("\nbounds:\n", &format!("\nbounds:\n{bounds}"))
            .replace("simulation: {", &format!("simulation: {{ {simulation}"));
        let explained = read(&text).study().explain().unwrap().decisions.into_iter();
        explained
            .filter(|one| one.what.starts_with("integrated"))
            .map(|one| format!("{}: {}", one.what, one.why))
            .collect()
    };
    assert!(decisions("", "").is_empty(), "nothing is chosen without a tolerance");
    let tolerance = "  tolerance: 1e-4\n";
    let [one] = &decisions(tolerance, "")[..] else { panic!("{:?}", decisions(tolerance, "")) };
    println!("{one}");
    assert!(one.starts_with("integrated by the explicit method of order 8: not stiff"), "{one}");
    assert!(decisions(tolerance, "scheme: hht, ").is_empty(), "the model says it");
}

/// The output is off by no more than the stated error, and this error is below `allowed`.
#[track_caller]
fn assert_located(force: &str, start: &str, allowed: f64, exact: impl Fn(f64) -> f64) {
    let text = "
space: planar
bodies: { m: { mass: 1, coordinates: [x] } }
effects: { ends: { force: { on: m, value: ['FORCE', 0] } } }
initial: { m.x: START, m.vx: 1 }
outputs: { x: m.x }
simulation: { duration: 5, scheme: explicit, tolerance: 1e-9, output_step: 0.01 }
bounds: { scan: { points: 2 } }
";
    let bounds = run(&read(&text.replace("FORCE", force).replace("START", start)));
    let off = distance_from(&bounds.times, curve(&bounds, "x"), exact);
    let stated = largest(band(output(&bounds, "x"), Method::Scan).error.total.iter().copied());
    assert!(off <= stated + 1e-14 && stated < allowed, "{off:e}, stated {stated:e}");
}

/// A mass flies between two springs: it meets each at v and leaves it half a period later at −v. Where its force jumps,
/// it moves by parabolas.
#[test]
fn steps_end_where_equations_switch() {
    let half = std::f64::consts::PI / 20.0;
    assert_located("-(400 N/m)*max(m.x - 0.1, 0) + (400 N/m)*max(-0.1 - m.x, 0)", "0", 1e-10, |t| {
        let since = (t + 0.1).rem_euclid(2.0 * (0.2 + half));
        let (since, sign) = if since < 0.2 + half { (since, 1.0) } else { (since - 0.2 - half, -1.0) };
        sign * if since < 0.2 { since - 0.1 } else { 0.1 + (20.0 * (since - 0.2)).sin() / 20.0 }
    });
    let speed = (1.0 + 4.0 * 0.01_f64).sqrt();
    assert_located("-(2 N)*sign(m.x)", "0.01", 1e-8, |t| {
        let since = t + (speed - 1.0) / 2.0;
        let (turn, since) = ((since / speed).floor(), since.rem_euclid(speed));
        (if turn % 2.0 == 0.0 { 1.0 } else { -1.0 }) * (speed * since - since * since)
    });
}
