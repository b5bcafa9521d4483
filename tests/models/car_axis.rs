//! The car axis of the test set for IVP solvers against a solution in minimal coordinates (Radau, 1e-13).
//!
//! Its springs oscillate with 1/s-frequencies of √(k/m) = 45 rad/s, so steps of 1e-3 s resolve a period with 140 steps.

use crate::common::{Subject, curve, largest, model, nominal, order, reference, richardson, row};

const NAMES: [&str; 4] = ["left.x", "left.y", "right.x", "right.y"];

fn car_axis() -> Subject {
    model("car_axis").observing(&NAMES)
}

fn error(curves: [&[f64]; 4], row_of: impl Fn(f64) -> usize) -> f64 {
    let states = reference("ivp/car_axis.csv");
    let errors = states
        .iter()
        .flat_map(|state| (0..4).map(move |index| (state[0], index, state[index + 1])))
        .map(|(t, index, exact)| curves[index][row_of(t)] - exact);
    largest(errors)
}

#[test]
fn motion_converges_to_the_reference() {
    let steps = [1e-3, 5e-4, 2.5e-4];
    let runs = steps.map(|h| nominal(&car_axis().step(h)));
    let errors = runs.each_ref().map(|run| error(NAMES.map(|name| curve(run, name)), |t| row(run, t)));
    println!("errors {errors:?}");
    for (&coarse, &fine) in errors.iter().zip(&errors[1..]) {
        let order = order(coarse, fine);
        assert!((order - 2.0).abs() < 0.1, "order {order} from {errors:?}");
    }
    let limits = NAMES.map(|name| richardson(curve(&runs[1], name), curve(&runs[2], name)));
    let left = error(limits.each_ref().map(Vec::as_slice), |t| row(&runs[2], t));
    println!("extrapolated {left:.3e}");
    assert!(left < errors[2] / 50.0, "{left} of {}", errors[2]);
}

#[test]
fn road_follows_its_prescribed_motion() {
    let bounds = nominal(&car_axis().observing(&["road.x - sqrt(1 - 0.01*sin(10*t)^2)", "road.y - 0.1*sin(10*t)"]));
    for output in &bounds.outputs {
        // Newton's tolerance.
        assert!(largest(output.nominal.iter().copied()) < 1e-11, "{}", output.name);
    }
}
