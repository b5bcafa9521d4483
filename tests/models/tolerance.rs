//! Bounds to a tolerance, of few and of many parameters, against truths of other methods.

use mbint::results::{Bounds, Method};

use crate::common::runge_kutta::runge_kutta;
use crate::common::{
    Subject, band, load, model, model_files, read, reference, run, run_methods, with_reversed_parameters,
};

fn within(description: Subject, tolerance: f64, simulations: usize) -> Subject {
    description.asking(move |study| study.tolerance(tolerance).budget(simulations))
}

fn unresolved(bounds: &Bounds) -> usize {
    let bands = bounds.outputs.iter().flat_map(|output| &output.bands);
    bands.map(|band| band.error.unresolved.iter().filter(|&&unresolved| unresolved).count()).sum()
}

/// `bounds: { tolerance: … }` is enough: the true error is within it, and so is the one that is reported.
#[test]
fn true_error_is_within_the_tolerance() {
    let rows = reference("slider_crank/bounds_l1_1pct.csv");
    for tolerance in [1e-2, 1e-3, 1e-4] {
        let description = within(model("slider_crank_one").observing(&["slider.x"]), tolerance, 1000);
        let (bounds, summary) = run_methods(&description, None);
        assert_eq!(unresolved(&bounds), 0, "{tolerance}");
        let band = band(&bounds.outputs[0], Method::Chebyshev);
        let errors = rows.iter().filter(|row| row[0] > 0.0).map(|truth| {
            let row = crate::common::row(&bounds, truth[0]);
            let error = (band.lower[row] - truth[2]).abs().max((band.upper[row] - truth[3]).abs());
            (error, band.error.total[row])
        });
        // x3 ranges over 0.303 m.
        let (errors, report): (Vec<f64>, Vec<f64>) = errors.unzip();
        let largest = errors.iter().copied().fold(0.0, f64::max);
        let covered =
            errors.iter().zip(&report).filter(|(error, report)| error <= report).count() as f64 / errors.len() as f64;
        println!("{tolerance}: {largest:.2e}, covered {covered:.3}, {:?}", summary.methods.last().unwrap());
        assert!(largest <= tolerance * 0.303, "{tolerance}: {largest}");
        assert!(covered >= 0.99, "{tolerance}: {covered}");
    }
}

/// Over two seconds cranks turn six times, and part by a quarter of a turn. Their angles took polynomials of degree 34
/// and 411 simulations, tested against 17 samples; relative to the course of one of them, they took degree 12, and 324
/// simulations where each surrogate is tested against new samples.
#[test]
fn turning_cranks_take_few_simulations() {
    let description = within(model("slider_crank").observing(&["slider.x"]), 1e-5, 400).scan(13);
    let (bounds, summary) = run_methods(&description, None);
    let chebyshev = summary.methods.iter().find(|method| method.method == "chebyshev").unwrap();
    println!("{chebyshev:?}");
    assert!(chebyshev.simulations <= 350, "{}", chebyshev.simulations);
    let [band, inside] = [Method::Chebyshev, Method::Scan].map(|method| band(&bounds.outputs[0], method));
    for (row, error) in band.error.total.iter().enumerate() {
        assert!(*error <= 1e-5 * 0.303 && !band.error.unresolved[row], "{row}: {error}");
        let contains = band.lower[row] - error <= inside.lower[row] && inside.upper[row] <= band.upper[row] + error;
        assert!(contains, "{row}: {} {}, {error}", inside.lower[row], inside.upper[row]);
        // A scan of 13 points misses an end by less than its stated error.
        let apart = (band.lower[row] - inside.lower[row]).abs().max((band.upper[row] - inside.upper[row]).abs());
        let said = error + inside.error.total[row];
        assert!(inside.error.unresolved[row] || apart <= said, "{row}: {apart}, {}", inside.error.total[row]);
    }
}

/// Eight parameters, at the time when some cranks have just passed their dead point: x is least with the fastest of
/// them, after rows in which it was with the slowest. No sample of the surrogate is near that corner.
#[test]
fn an_end_that_moves_to_another_corner_is_followed() {
    let text = "
parameters:
  l1: { value: 0.15, unit: m, tolerance: 1% }
  l2: { value: 0.56, unit: m, tolerance: 1% }
  m1: { value: 0.37, unit: kg, tolerance: 1% }
  m2: { value: 0.77, unit: kg, tolerance: 1% }
  m3: { value: 0.45, unit: kg, tolerance: 1% }
  c: { value: 1, unit: N*s/m, tolerance: 1% }
  k: { value: 5, unit: N/m, tolerance: 1% }
  tau: { value: -0.5, unit: N*m, tolerance: 1% }
bodies:
  crank: { mass: m1, inertia: m1*l1^2/12, points: { A: [-l1/2, 0], B: [l1/2, 0] } }
  rod: { mass: m2, inertia: m2*l2^2/12, points: { B: [-l2/2, 0], C: [l2/2, 0] } }
  slider: { mass: m3, coordinates: [x] }
joints:
  pivot: { revolute: [ground, crank.A] }
  pin: { revolute: [crank.B, rod.B] }
  wrist: { revolute: [rod.C, slider] }
effects:
  drive: { torque: { on: crank, value: tau } }
  spring: { spring_damper: { between: [ground, slider], along: x, stiffness: k, damping: c, free_length: l1 + l2 } }
initial: { crank.angle: 0, crank.angular_velocity: 0 }
outputs: { x: slider.x }
simulation: { duration: 0.8, tolerance: 1e-3, output_step: 0.01 }
";
    let (bounds, summary) = run_methods(&within(read(text), 1e-3, 600), None);
    let corners = text.replace("tolerance: 1e-3", "tolerance: 1e-6") + "bounds: { scan: { points: 2 } }";
    let corners = run(&read(&corners));
    let (found, corners) = (band(&bounds.outputs[0], Method::Chebyshev), band(&corners.outputs[0], Method::Scan));
    // x ranges over 0.3 m.
    for row in 0..bounds.times.len() {
        let beyond = (found.lower[row] - corners.lower[row]).max(corners.upper[row] - found.upper[row]);
        assert!(beyond < 3e-4, "a corner lies {beyond:.1e} m beyond the bounds at {} s", bounds.times[row]);
        assert!(found.error.total[row] <= 3.1e-4, "{:.1e} m at {} s", found.error.total[row], bounds.times[row]);
    }
    let simulations = summary.methods.last().map_or(0, |method| method.simulations);
    assert!(simulations < 250, "{simulations} simulations");
}

#[test]
fn budget_is_kept_and_unresolved_rows_are_flagged() {
    let description = within(model("slider_crank"), 1e-4, 60);
    let (bounds, summary) = run_methods(&description, None);
    let simulations: usize =
        summary.methods.iter().filter(|method| method.method != "nominal").map(|method| method.simulations).sum();
    assert!(simulations <= 60 + 26, "{simulations}");
    assert!(unresolved(&bounds) > 0);
    assert!(summary.errors[0].unresolved_from.is_some());
}

/// Wherever the budget ends, be it between two nodes that are simulated together.
#[test]
fn a_budget_may_end_anywhere() {
    for budget in 27..=45 {
        let (bounds, summary) = run_methods(&within(model("slider_crank").rows_every(0.5), 1e-5, budget), None);
        let chebyshev = summary.methods.iter().find(|method| method.method == "chebyshev").unwrap();
        assert!(chebyshev.simulations <= budget, "{budget}: {}", chebyshev.simulations);
        assert!(unresolved(&bounds) > 0, "{budget}");
    }
}

/// A pendulum that swings over the top: after a second no polynomial in its length follows it.
#[test]
#[ignore = "20 s: neighbours that part"]
fn chaos_is_flagged_from_where_it_begins() {
    let description = read(
        &std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/models/double_pendulum.yaml"))
            .unwrap()
            .replace("upper.angle: -40 deg, lower.angle: -70 deg", "upper.angle: 80 deg, lower.angle: 60 deg")
            .replace("duration: 3", "duration: 12")
            .replace("tolerance: 0.5%", "tolerance: 0.1%"),
    );
    let bounds = run(&description);
    for output in bounds.outputs.iter().filter(|output| output.name != "energy") {
        let error = &band(output, Method::Chebyshev).error;
        let from = error.unresolved_from().unwrap_or_else(|| panic!("{} is taken for resolved", output.name));
        println!("{} from {} s", output.name, bounds.times[from]);
        assert!(bounds.times[from] > 0.5, "{}", output.name);
        assert!(error.unresolved[from..].iter().all(|&unresolved| unresolved), "{}: once lost, lost", output.name);
    }
}

/// The slider crank in its one degree of freedom: l1, l2, m1, m2, m3, c, k, tau → x3 at whole multiples of
/// `output_step`.
fn slider_crank([l1, l2, m1, m2, m3, c, k, tau]: [f64; 8], output_step: f64, rows: usize) -> Vec<f64> {
    // Derivatives by the crank's angle of: x3, the rod's angle, its centre.
    let place = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let rod_sin = -l1 / l2 * sin;
        let rod_cos = (1.0 - rod_sin * rod_sin).sqrt();
        let rod = -l1 / l2 * cos / rod_cos;
        let slider = -l1 * sin - l2 * rod_sin * rod;
        let center = [-l1 * sin - 0.5 * l2 * rod_sin * rod, l1 * cos + 0.5 * l2 * rod_cos * rod];
        (l1 * cos + l2 * rod_cos, slider, rod, center)
    };
    let inertia = |angle: f64| {
        let (_, slider, rod, [x, y]) = place(angle);
        m1 * l1 * l1 / 3.0 + m2 * (x * x + y * y) + m2 * l2 * l2 / 12.0 * rod * rod + m3 * slider * slider
    };
    let f = |[angle, speed]: [f64; 2]| {
        let (x, slider, ..) = place(angle);
        let slope = (inertia(angle + 1e-5) - inertia(angle - 1e-5)) / 2e-5;
        let force = -k * (x - l1 - l2) - c * slider * speed;
        [speed, (tau + force * slider - 0.5 * slope * speed * speed) / inertia(angle)]
    };
    let steps = (output_step / 1e-3).ceil() as usize;
    runge_kutta(f, [0.0, 0.0], output_step, rows, steps).iter().map(|[angle, _]| place(*angle).0).collect()
}

const NOMINAL: [f64; 8] = [0.15, 0.56, 0.37, 0.77, 0.45, 1.0, 5.0, -0.5];

/// All eight parameters known to 1 %.
fn eight() -> Subject {
    let names = ["l1", "l2", "m1", "m2", "m3", "c", "k", "tau"];
    // Its scan is not one of eight parameters.
    let text = include_str!("../../models/slider_crank.yaml").split_once("bounds:").unwrap().0;
    let crank = read(text).observing(&["slider.x"]);
    names.iter().zip(NOMINAL).fold(crank, |found, (name, nominal)| found.with(name, format!("{nominal} ± 1%")))
}

/// The largest x3 (times `sign`) at a row over the box of ± 1 %: climbing from many starts, parameter by parameter.
fn truth(row: usize, sign: f64) -> f64 {
    let at = |xi: [f64; 8]| {
        let parameters = std::array::from_fn(|i| NOMINAL[i] * (1.0 + 0.01 * xi[i]));
        sign * slider_crank(parameters, 0.1 * row as f64, 2)[1]
    };
    let mut best = f64::NEG_INFINITY;
    for start in 0..12 {
        // The middle, then corners of all kinds.
        let mut xi = std::array::from_fn(|i| match start {
            0 => 0.0,
            _ => {
                if ((start * (2 * i + 1) * 37) >> 3) % 2 == 0 {
                    -1.0
                } else {
                    1.0
                }
            }
        });
        let mut value = at(xi);
        let mut reach = 1.0;
        while reach > 0.01 {
            let before = value;
            for i in 0..8 {
                for step in [-reach, reach] {
                    let mut tried = xi;
                    tried[i] = (xi[i] + step).clamp(-1.0, 1.0);
                    let there = at(tried);
                    if there > value {
                        (xi, value) = (tried, there);
                    }
                }
            }
            if value - before < 1e-7 {
                reach *= 0.4;
            }
        }
        best = best.max(value);
    }
    sign * best
}

/// Eight uncertain parameters: bounds within 1 % of the true width from at most 500 simulations, where a tensor of
/// order 5 needs 1.7 million.
#[test]
#[ignore = "30 s: eight parameters against an optimisation from many starts"]
fn eight_parameters_take_five_hundred_simulations() {
    let known = slider_crank(NOMINAL, 0.05, 16);
    for (found, expected) in known.iter().step_by(5).zip([0.71, 0.611715439809, 0.410396368709, 0.67658356591]) {
        assert!((found - expected).abs() < 1e-8, "the other equations are wrong: {found}, {expected}");
    }
    let (bounds, summary) = run_methods(&within(eight().rows_every(0.1), 2e-3, 500), None);
    let simulations: usize = summary.methods.iter().map(|method| method.simulations).sum();
    assert!(simulations <= 501, "{simulations}");
    let band = band(&bounds.outputs[0], Method::Chebyshev);
    let (mut width, mut true_width, mut covered) = (0.0, 0.0, 0);
    let rows = [2, 5, 8, 10, 12, 13, 14, 15, 16, 17, 18, 19, 20];
    for row in rows {
        let (lower, upper) = (truth(row, -1.0), truth(row, 1.0));
        let off = (band.lower[row] - lower).abs().max((band.upper[row] - upper).abs());
        println!(
            "{row}: off by {:.2e} of the width, error {:.2e}",
            off / (upper - lower),
            band.error.total[row] / (upper - lower)
        );
        width += band.upper[row] - band.lower[row];
        true_width += upper - lower;
        covered += usize::from(off <= band.error.total[row]);
    }
    println!("mean width {:.4}", width / true_width);
    assert!((width / true_width - 1.0).abs() < 0.01, "{}", width / true_width);
    assert_eq!(covered, rows.len());
}

/// About 1.57 s some samples stand at the dead centre, where the slider is at l1 + l2 at most. Over the parameters that
/// is a ridge, along which the position rises with both lengths alone.
#[test]
fn an_end_is_followed_along_a_ridge_to_the_longest_links() {
    let bounds = run(&eight().asking(|study| study.tolerance(1e-3)));
    let band = &bounds.outputs[0].bands[0];
    let (longest, row) = (1.01 * (NOMINAL[0] + NOMINAL[1]), 157);
    assert!((band.upper[row] - longest).abs() < band.error.total[row], "{} of {longest}", band.upper[row]);
    assert!(!band.error.unresolved.contains(&true), "{:?}", band.error.unresolved);
}

/// Parameters in another order are the same parameters.
#[test]
#[ignore = "10 s: four parameters in other orders"]
fn permuted_parameters_have_the_same_bounds() {
    let description = within(model("slider_crank"), 1e-3, 1000);
    let permuted = with_reversed_parameters(include_str!("../../models/slider_crank.yaml"));
    let permuted = within(permuted, 1e-3, 1000);
    let (one, other) = (run(&description), run(&permuted));
    let (a, b) = (band(&one.outputs[0], Method::Chebyshev), band(&other.outputs[0], Method::Chebyshev));
    for row in 0..a.lower.len() {
        let allowed = a.error.total[row] + b.error.total[row];
        assert!(
            (a.lower[row] - b.lower[row]).abs() <= allowed && (a.upper[row] - b.upper[row]).abs() <= allowed,
            "{row}"
        );
    }
    assert_eq!(one.contributions[0][0].parameter, other.contributions[0][1].parameter);
}

/// Height of a ball thrown up, v t − g t²/2: a sum, so that every share and every width has a closed form.
#[test]
fn contributions_of_a_throw_are_known() {
    let bounds = run(&read(
        "
parameters:
  v: { interval: [3.5, 4.5], value: 4.1, unit: m/s }
  g: { interval: [9.7, 9.9], value: 9.8, unit: m/s^2 }
bodies: { ball: { mass: 0.3, coordinates: [y] } }
effects: { weight: { gravity: { acceleration: [0, -g] } } }
initial: { ball.y: 0, ball.vy: v }
outputs: { height: ball.y }
simulation: { duration: 2, step: 0.01, output_step: 0.1 }
bounds: { chebyshev: { order: 3 } }
",
    ));
    let [of_v, of_g] = &bounds.contributions[0][..] else { panic!("two parameters") };
    for (row, &t) in bounds.times.iter().enumerate().skip(1) {
        let (by_v, by_g) = (1.0 * t, 0.2 * 0.5 * t * t);
        let share = by_v * by_v / (by_v * by_v + by_g * by_g);
        assert!((of_v.main[row] - share).abs() < 1e-9 && (of_g.total[row] - (1.0 - share)).abs() < 1e-9, "{t}");
        assert!((of_v.width_without[row] - by_g).abs() < 1e-9 && (of_g.width_without[row] - by_v).abs() < 1e-9);
    }
    assert_eq!((of_v.main[0], of_v.width_without[0]), (0.0, 0.0));
}

/// Without uncertain parameters there is nothing to expand, but steps are chosen.
#[test]
fn model_without_uncertainty_accepts_a_tolerance() {
    let bounds = run(&within(model("slider_crank_one").with("l1", 0.15), 1e-3, 100));
    let band = band(&bounds.outputs[0], Method::Chebyshev);
    assert_eq!((&band.lower, &band.upper), (&bounds.outputs[0].nominal, &bounds.outputs[0].nominal));
    assert_eq!(unresolved(&bounds), 0);
}

/// Every model can be bounded to a tolerance: nothing is unknown.
#[test]
#[ignore = "20 s: every model to a tolerance"]
fn every_model_is_bounded_to_a_per_cent() {
    for path in model_files() {
        let bounds = run(&within(load(&path), 1e-2, 400));
        for output in &bounds.outputs {
            let band = band(output, Method::Chebyshev);
            let flagged = band.error.unresolved.iter().filter(|&&unresolved| unresolved).count();
            println!("{}: {} {flagged} of {} rows unresolved", path.display(), output.name, band.lower.len());
            assert!(band.lower.iter().chain(&band.upper).all(|bound| bound.is_finite()), "{}", output.name);
        }
    }
}

/// A bob between three equal springs stays at rest. Its rounding errors are no motion that bounds could miss.
#[test]
fn motion_of_rounding_errors_is_at_rest() {
    let spring = |name: &str| {
        format!("  {name}: {{ spring_damper: {{ between: [ground.{name}, bob], stiffness: k, free_length: 0.2 }} }}\n")
    };
    let springs: String = ["A", "B", "C"].map(spring).concat();
    // The points are on a circle of 0.3 m, 120° apart.
    let text = format!(
        "model: held\nparameters: {{ k: {{ value: 100, unit: N/m, tolerance: 10 % }} }}\n\
         bodies:\n  ground: {{ points: {{ A: [0.2819077862357725, 0.1026060429977006], B: [-0.2298133329356934, 0.19283628290596184], \
         C: [-0.0520944533000791, -0.2954423259036624] }} }}\n  \
         bob: {{ mass: 0.3, coordinates: [x, y] }}\neffects:\n{springs}\
         initial: {{ bob.x: 0, bob.y: 0, bob.vx: 0, bob.vy: 0 }}\noutputs: {{ x: bob.x, vy: bob.vy }}\n\
         simulation: {{ duration: 1, step: 1e-3, output_step: 0.05 }}\nbounds: {{ chebyshev: {{ order: 4 }} }}\n"
    );
    let (bounds, _) = run_methods(&read(&text), None);
    let x = &bounds.outputs[0];
    assert!(x.nominal.iter().any(|value| *value != 0.0) && x.nominal.iter().all(|value| value.abs() < 1e-13));
    assert_eq!(unresolved(&bounds), 0);
}

/// Angular momentum about a spring's end is m v r at the start and stays: its changes are the steps' error, and no
/// error is small relative to them. It takes no shorter steps than the position does.
#[test]
fn conserved_output_is_resolved_under_a_tolerance() {
    let text = "
parameters: { k: 9 N/m ± 4%, v: 1.2 m/s ± 3% }
bodies: { ground: { points: { O: [0, 0] } }, b: { mass: 1.5, inertia: 0.1, points: { P: [0, 0] } } }
effects: { s: { spring_damper: { between: [ground.O, b.P], stiffness: k, free_length: 0.4 } } }
initial: { b.x: 1, b.vy: v }
outputs: { x: b.x, turns: 1.5*(b.x*b.vy - b.y*b.vx), kept: turns - 1.5*v }
simulation: { duration: 3, step: 1e-3 }
bounds: { tolerance: 1e-3 }
";
    let (bounds, summary) = run_methods(&read(text), None);
    for (output, [lower, upper]) in [(1, [1.5 * 1.164, 1.5 * 1.236]), (2, [0.0, 0.0])] {
        let band = &bounds.outputs[output].bands[0];
        for row in 0..bounds.times.len() {
            let error = band.error.total[row];
            assert!(!band.error.unresolved[row] && error < 1e-4, "{row} {error}");
            // Rounding of three seconds.
            let off = (band.lower[row] - lower).abs().max((band.upper[row] - upper).abs());
            assert!(off <= error + 1e-12, "{row} {off} {error}");
        }
    }
    assert!(summary.methods.iter().all(|method| method.steps < 100), "{:?}", summary.methods);
}
