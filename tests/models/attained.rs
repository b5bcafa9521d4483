//! Ends of bounds with many parameters, against a search of this file: another integrator, differences for gradients,
//! and from corner to corner as their signs say.

use crate::common::runge_kutta::runge_kutta;
use crate::common::{load, read, run};

/// Masses of the chain, each with its spring and its damper; parameters, each ± 10 %.
const MASSES: usize = 3;
const PARAMETERS: usize = 3 * MASSES;
const ROWS: usize = 11;
const OUTPUT_STEP: f64 = 0.1;
/// N/m³: springs are softer the longer they are.
const CUBIC: f64 = -30_000.0;

/// Mass, stiffness and damping of each link.
fn nominal() -> [f64; PARAMETERS] {
    std::array::from_fn(|place| {
        let link = (place / 3) as f64;
        [1.0 + 0.1 * link, 400.0 + 50.0 * link, 1.5][place % 3]
    })
}

fn sample(xi: &[f64]) -> Vec<f64> {
    nominal().iter().zip(xi).map(|(nominal, xi)| nominal * (1.0 + 0.1 * xi)).collect()
}

/// The last mass over time: m x'' = forces of both springs, k d + c d' − 30 000 d³ of each length d.
fn last_mass(parameters: &[f64]) -> Vec<f64> {
    let rates = |y: [f64; 2 * MASSES]| -> [f64; 2 * MASSES] {
        let force = |link: usize| {
            let before = |at: usize| if link == 0 { 0.0 } else { y[at + link - 1] };
            let (length, speed) = (y[link] - before(0), y[MASSES + link] - before(MASSES));
            parameters[3 * link + 1] * length + parameters[3 * link + 2] * speed + CUBIC * length.powi(3)
        };
        std::array::from_fn(|line| match line.checked_sub(MASSES) {
            None => y[MASSES + line],
            Some(mass) => {
                let pull = if mass + 1 < MASSES { force(mass + 1) } else { 0.0 };
                (pull - force(mass)) / parameters[3 * mass]
            }
        })
    };
    let start = std::array::from_fn(|line| if line < MASSES { 0.02 * (line + 1) as f64 } else { 0.0 });
    let motion = runge_kutta(rates, start, OUTPUT_STEP, ROWS, 60);
    motion.iter().map(|state| state[MASSES - 1]).collect()
}

fn model() -> String {
    let mut text = "parameters:\n".to_owned();
    for (index, value) in nominal().iter().enumerate() {
        let (name, unit) = [("m", "kg"), ("k", "N/m"), ("c", "N*s/m")][index % 3];
        text += &format!("  {name}{}: {{ value: {value}, unit: {unit}, tolerance: 10% }}\n", index / 3);
    }
    text += "bodies:\n";
    (0..MASSES).for_each(|mass| text += &format!("  b{mass}: {{ mass: m{mass}, coordinates: [x] }}\n"));
    text += "effects:\n";
    for link in 0..MASSES {
        let (from, length) = match link {
            0 => ("ground".to_owned(), "b0.x".to_owned()),
            _ => (format!("b{}", link - 1), format!("(b{link}.x - b{}.x)", link - 1)),
        };
        text += &format!(
            "  s{link}: {{ spring_damper: {{ between: [{from}, b{link}], along: x, stiffness: k{link}, damping: c{link}, force: \"-30*{length}^3*1000\" }} }}\n"
        );
    }
    text += "initial:\n";
    (0..MASSES).for_each(|mass| text += &format!("  b{mass}.x: {}\n  b{mass}.vx: 0\n", 0.02 * (mass + 1) as f64));
    let duration = OUTPUT_STEP * (ROWS - 1) as f64;
    text + &format!(
        "outputs: {{ end: b{}.x }}\nsimulation: {{ duration: {duration}, output_step: {OUTPUT_STEP} }}\nbounds: {{ tolerance: 1e-2 }}\n",
        MASSES - 1
    )
}

/// Signs of the derivatives by all parameters in a row, by differences into the box.
fn signs(xi: &[f64], row: usize) -> Vec<f64> {
    const STEP: f64 = 1e-4;
    let value = |xi: &[f64]| last_mass(&sample(xi))[row];
    let here = value(xi);
    let of_axis = |axis: usize| {
        let step = if xi[axis] > 0.0 { -STEP } else { STEP };
        let mut moved = xi.to_vec();
        moved[axis] += step;
        ((value(&moved) - here) / step).signum()
    };
    (0..PARAMETERS).map(of_axis).collect()
}

/// The largest (or, with −1, the least) value in a row that a search from corner to corner finds.
fn end(row: usize, sign: f64) -> f64 {
    let mut corner = signs(&[0.0; PARAMETERS], row).into_iter().map(|own| sign * own).collect::<Vec<f64>>();
    let mut best = f64::NEG_INFINITY;
    for _ in 0..4 {
        best = best.max(sign * last_mass(&sample(&corner))[row]);
        let next: Vec<f64> = signs(&corner, row).into_iter().map(|own| sign * own).collect();
        if next == corner {
            break;
        }
        corner = next;
    }
    sign * best
}

#[test]
fn ends_attained_at_corners_are_found_and_replayed() {
    let description = read(&model());
    let bounds = run(&description);
    let (output, band) = (&bounds.outputs[0], &bounds.outputs[0].bands[0]);
    assert_eq!(output.name, "end");
    let mut found = 0;
    for row in 1..ROWS {
        let [lower, upper] = [-1.0, 1.0].map(|sign| end(row, sign));
        let (width, error) = (upper - lower, band.error.total[row]);
        println!(
            "{row}: [{lower:.5}, {upper:.5}], bounds [{:.5}, {:.5}] ± {error:.1e}",
            band.lower[row], band.upper[row]
        );
        assert!(lower >= band.lower[row] - error && upper <= band.upper[row] + error, "row {row}");
        // The ends are attained, so that the band itself contains them but for the finds of another search.
        assert!(lower > band.lower[row] - 5e-3 * width && upper < band.upper[row] + 5e-3 * width, "row {row}");
        for witness in bounds.witnesses.iter().filter(|own| own.row == row) {
            let replayed = last_mass(&witness.parameters)[row];
            // Steps err by a share of the tolerance.
            assert!((witness.value - replayed).abs() < 1e-4 * width, "row {row}: {} is not {replayed}", witness.value);
            let (end, sign) = if witness.is_upper { (upper, 1.0) } else { (lower, -1.0) };
            assert!(sign * (witness.value - end) > -5e-3 * width, "row {row}: {} is short of {end}", witness.value);
            found += 1;
        }
    }
    assert_eq!(found, 2 * (ROWS - 1));
}

/// Few parameters are left to the surrogate.
#[test]
fn few_parameters_have_no_witnesses() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("models/slider_crank_one.yaml");
    assert!(run(&load(&path).asking(|study| study.tolerance(1e-3))).witnesses.is_empty());
}
