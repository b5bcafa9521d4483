//! Extrapolated steps: several step lengths combined, against references that other methods computed, and closed forms.

use mbint::results::Method;

use crate::common::run_methods;
use crate::common::{
    Subject, band, curve, distance_from, largest, model, nominal, order, output, read, reference, row, run,
};

fn levels(description: Subject, levels: usize) -> Subject {
    description.extrapolation(levels)
}

/// Largest error of the slider crank's x3 against DOP853 in minimal coordinates (error below 1e-8).
fn slider_crank_error(of_levels: usize, h: f64) -> f64 {
    let description = model("slider_crank_one").observing(&["slider.x"]).step(h).rows_every(0.05);
    let bounds = nominal(&levels(description, of_levels));
    let x = curve(&bounds, "slider.x");
    largest(reference("slider_crank/nominal_states.csv").iter().map(|state| x[row(&bounds, state[0])] - state[1]))
}

#[test]
fn each_level_gains_an_order() {
    let errors = [1, 2, 3, 4].map(|of_levels| slider_crank_error(of_levels, 1e-3));
    println!("slider crank over 2 s at 1e-3 s: {errors:?}");
    // With levels 1e-3, 5e-4 and 2.5e-4 s another implementation has 1.8e-3, 2.8e-5 and 8.1e-7; with 1.25e-4 s 6.7e-9.
    for (error, least) in errors.into_iter().zip([2e-3, 4e-5, 1e-6, 2e-8]) {
        assert!(error < least, "{errors:?}");
    }
    for (of_levels, h) in [(2, 5e-4), (3, 2e-3)] {
        let [coarse, fine] = [h, 0.5 * h].map(|h| slider_crank_error(of_levels, h));
        let order = order(coarse, fine);
        println!("{of_levels} levels: {coarse:.2e}, {fine:.2e}, order {order:.2}");
        assert!(order > of_levels as f64 + 0.5, "{of_levels} levels have order {order}");
    }
}

/// The pendulum from the horizontal, in Cartesian coordinates with a multiplier: positions by Jacobi's elliptic
/// functions, the rod's tension 3 m g |y|/L by energy and the centripetal acceleration.
#[test]
fn reactions_and_accelerations_are_extrapolated_too() {
    let rows = reference("iftomm/pendulum.csv");
    let tension = "rod.force + 3*9.81*bob.y";
    let description = model("pendulum").observing(&["bob.x", "bob.y", tension]).rows_every(0.01).step(2e-3);
    let of_levels = |of_levels: usize| {
        let bounds = nominal(&levels(description.clone(), of_levels));
        let (x, y) = (curve(&bounds, "bob.x"), curve(&bounds, "bob.y"));
        let place = |line: &Vec<f64>| row(&bounds, line[0]);
        let position = largest(rows.iter().flat_map(|line| [x[place(line)] - line[1], y[place(line)] - line[2]]));
        let square = |row: usize| x[row] * x[row] + y[row] * y[row];
        let length = (0..x.len()).map(|row| square(row) - square(0));
        (position, largest(bounds.outputs[2].nominal[10..].iter().copied()), largest(length))
    };
    let (plain, three) = (of_levels(1), of_levels(3));
    println!("plain {plain:?}, three levels {three:?}");
    assert!(three.0 < 1e-3 * plain.0 && three.1 < 1e-2 * plain.1, "{plain:?} {three:?}");
    assert!(three.2 < 1e-12, "the rod's length is off by {:e}", three.2);
}

/// A free oscillator over its stiffness: x = x₀ cos(√(k/m) t). The bounds' errors are stated, and small.
#[test]
fn bounds_by_every_method_are_extrapolated() {
    let text = "
parameters: { k: { value: 50, unit: N/m, tolerance: 4% } }
bodies: { block: { mass: 2, coordinates: [x] } }
effects: { spring: { spring_damper: { between: [ground, block], along: x, stiffness: k, damping: 0, free_length: 0 } } }
initial: { block.x: 0.03, block.vx: 0 }
outputs: { x: block.x }
simulation: { duration: 2, step: 0.01, output_step: 0.02, extrapolation: 3 }
bounds: { chebyshev: { order: 9 }, taylor: { order: 9 }, scan: { points: 41 } }
";
    let (bounds, summary) = run_methods(&read(text), None);
    assert_eq!(summary.integration.as_deref(), Some("HHT-I3 extrapolated over 3 levels"));
    // 200 steps, 400 and 800.
    assert_eq!(summary.methods[0].steps, 1400);
    let exact = |k: f64, t: f64| 0.03 * ((k / 2.0_f64).sqrt() * t).cos();
    for band in &output(&bounds, "x").bands {
        let mut worst: f64 = 0.0;
        for (row, &t) in bounds.times.iter().enumerate() {
            let values = (0..=2000).map(|i| exact(50.0 * (1.0 + 0.04 * (f64::from(i) / 1000.0 - 1.0)), t));
            let (lower, upper) =
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
            let error = (band.lower[row] - lower).abs().max((band.upper[row] - upper).abs());
            assert!(error <= band.error.total[row] + 1e-12, "{} at {t}: {error:e}", band.method.name());
            worst = worst.max(error);
        }
        println!("{}: error {worst:.2e}, of the steps {:.2e} stated", band.method.name(), band.error.time);
        assert!(band.error.time < 2e-7, "{}: {:e}", band.method.name(), band.error.time);
    }
    let plain = nominal(&read(&text.replace(", extrapolation: 3", "")));
    let off = |bounds| distance_from(&plain.times, curve(bounds, "x"), |t| exact(50.0, t));
    assert!(off(&bounds) < 1e-3 * off(&plain), "{:e} {:e}", off(&bounds), off(&plain));
}

/// Where a kink passes between steps, the order falls, and the stated error with it: no gain is claimed.
#[test]
fn no_gain_is_claimed_across_a_kink() {
    // x' = v, v' = −c sign(x) is a sequence of parabolas.
    let text = "
parameters: { c: { value: 1, unit: m/s^2, tolerance: 1% } }
bodies: { block: { mass: 1, coordinates: [x] } }
effects: { push: { force: { on: block, value: [\"-c*sign(block.x)*(1 kg)\", 0] } } }
initial: { block.x: 0.3, block.vx: 0 }
outputs: { x: block.x }
simulation: { duration: 3, step: 0.01, output_step: 0.03, extrapolation: 3 }
bounds: { scan: { points: 21 } }
";
    let bounds = run(&read(text));
    let exact = |c: f64, t: f64| {
        let quarter = (2.0 * 0.3 / c).sqrt();
        let phase = (t / quarter).rem_euclid(4.0);
        let s = if phase < 1.0 {
            phase
        } else if phase < 3.0 {
            phase - 2.0
        } else {
            phase - 4.0
        };
        (if (1.0..3.0).contains(&phase) { -1.0 } else { 1.0 }) * (0.3 - 0.3 * s * s)
    };
    let band = band(output(&bounds, "x"), Method::Scan);
    let mut covered = 0;
    for (row, &t) in bounds.times.iter().enumerate() {
        let values = (0..=400).map(|i| exact(1.0 + 0.01 * (f64::from(i) / 200.0 - 1.0), t));
        let (lower, upper) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let error = (band.lower[row] - lower).abs().max((band.upper[row] - upper).abs());
        covered += usize::from(error <= band.error.total[row] + 1e-12 || band.error.unresolved[row]);
    }
    assert!(covered as f64 >= 0.99 * bounds.times.len() as f64, "{covered} of {}", bounds.times.len());
    assert!(band.error.time > 1e-6, "a gain is claimed: {:e}", band.error.time);
}

/// Equations that switch are not for the explicit method; this force never does switch.
#[test]
fn a_tolerance_of_the_bounds_chooses_levels() {
    let text = "
parameters: { k: { value: 50, unit: N/m, tolerance: 4% } }
bodies: { block: { mass: 2, coordinates: [x] } }
effects: { spring: { force: { on: block, value: [\"-k*block.x*(1 + max(block.x/(1 m) - 9, 0))\", 0] } } }
initial: { block.x: 0.03, block.vx: 0 }
outputs: { x: block.x }
simulation: { duration: 4, step: 0.01, output_step: 0.02, scheme: SCHEME }
bounds: { tolerance: 1e-6, chebyshev: {} }
";
    let (bounds, summary) = run_methods(&read(&text.replace("SCHEME", "auto")), None);
    assert!(summary.integration.as_deref().is_some_and(|name| name.starts_with("HHT-I3 extrapolated")), "{summary:?}");
    let band = band(output(&bounds, "x"), Method::Chebyshev);
    for (row, &t) in bounds.times.iter().enumerate() {
        let values = (0..=4000).map(|i| 0.03 * ((25.0 * (0.96 + 0.08 * f64::from(i) / 4000.0)).sqrt() * t).cos());
        let (lower, upper) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let error = (band.lower[row] - lower).abs().max((band.upper[row] - upper).abs());
        assert!(error < 6e-8 && error <= band.error.total[row] + 1e-9, "{t}: {error:e}");
    }
    // A scheme that the model names is not overruled.
    let plain = run_methods(&read(&text.replace("SCHEME", "hht")), None).1;
    assert_eq!(plain.integration, None);
    assert!(
        plain.methods[0].steps > 3 * summary.methods[0].steps,
        "{} {}",
        plain.methods[0].steps,
        summary.methods[0].steps
    );
}

/// Taylor's coefficients are those of the extrapolated motion: the derivative by the stiffness of x₀ cos(√(k/m) t).
#[test]
fn jets_are_extrapolated() {
    let description = model("slider_crank_one").observing(&["slider.x"]).duration(0.5).rows_every(0.05).taylor(6);
    assert_eq!(description.uncertain_count(), 1);
    let fine = run(&description.clone().step(5e-5));
    let [plain, three] = [1, 3].map(|of_levels| {
        let bounds = run(&levels(description.clone().step(2e-3), of_levels));
        let (band, exact) = (&bounds.outputs[0].bands[0], &fine.outputs[0].bands[0]);
        largest(band.upper.iter().zip(&exact.upper).map(|(a, b)| a - b))
    });
    println!("Taylor at 2e-3 s: plain {plain:.2e}, three levels {three:.2e}");
    assert!(three < 0.05 * plain, "{plain:e} {three:e}");
}
