//! `wiper.yaml` against geometry and power: pins are where circles meet, and the motor gives the power that the glass
//! takes and the swinging masses gain.

use std::f64::consts::TAU;

use super::drawing_linkages::{Point, left_of};
use crate::common::{curve, distance_from, model, nominal, order};

const SPEED: f64 = 0.75 * TAU;
const SHAFTS: [Point; 2] = [[0.2, 0.0], [0.65, 0.0]];

/// The pins of the crank, the left and the right arm.
fn pins(t: f64) -> [Point; 3] {
    let crank = [0.04 * (SPEED * t).cos(), 0.04 * (SPEED * t).sin()];
    let left = left_of(crank, 0.195, SHAFTS[0], 0.065);
    [crank, left, left_of(left, 0.452, SHAFTS[1], 0.06)]
}

/// The angle of an arm.
fn arm(t: f64, side: usize) -> f64 {
    let (pin, shaft) = (pins(t)[side + 1], SHAFTS[side]);
    (pin[1] - shaft[1]).atan2(pin[0] - shaft[0])
}

/// The derivative of a function of the time, by central differences.
fn rate(f: impl Fn(f64) -> f64, t: f64) -> f64 {
    let h = 1e-3;
    (8.0 * (f(t + h) - f(t - h)) - (f(t + 2.0 * h) - f(t - 2.0 * h))) / (12.0 * h)
}

/// Kinetic energy of both rods and both arms with their blades; the crank's is constant.
fn kinetic_energy(t: f64) -> f64 {
    let rod = |first: usize, mass: f64, inertia: f64| {
        let middle = |axis: usize| rate(|t| (pins(t)[first][axis] + pins(t)[first + 1][axis]) / 2.0, t);
        let turn = rate(
            |t| {
                let [from, to] = [pins(t)[first], pins(t)[first + 1]];
                (to[1] - from[1]).atan2(to[0] - from[0])
            },
            t,
        );
        mass * (middle(0).powi(2) + middle(1).powi(2)) + inertia * turn * turn
    };
    let blade = 0.2 * (0.5 * 0.5 + 0.5 * 0.5 / 12.0);
    let arms = [0, 1].map(|side| (0.02 + blade) * rate(|t| arm(t, side), t).powi(2));
    (rod(0, 0.08, 3e-4) + rod(1, 0.15, 3e-3) + arms[0] + arms[1]) / 2.0
}

#[test]
fn pins_of_the_wiper_match_intersections_of_circles() {
    let names = ["left.angle", "right.angle"];
    let bounds = nominal(&model("wiper").observing(&names));
    for (side, name) in names.iter().enumerate() {
        let error = distance_from(&bounds.times, curve(&bounds, name), |t| arm(t, side));
        // Newton's tolerance (1e-11 of the model's size) times the slope of the closed form.
        assert!(error < 1e-10, "{name} is off by {error:e}");
    }
}

#[test]
fn power_of_the_wipers_motor_is_balanced() {
    let torque = |t: f64| {
        let glass: f64 = [0, 1].map(|side| 0.6 * rate(|t| arm(t, side), t).powi(2)).iter().sum();
        (glass + rate(kinetic_energy, t)) / SPEED
    };
    let errors = [2e-3, 1e-3].map(|h| {
        let bounds = nominal(&model("wiper").observing(&["drive.torque"]).step(h));
        distance_from(&bounds.times, curve(&bounds, "drive.torque"), torque)
    });
    println!("{errors:?}");
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.2 && errors[1] < 1e-3, "{errors:?}");
}
