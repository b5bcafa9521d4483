//! Vehicles of `models/` against another method: their equations by hand, by Dormand and Prince's pair.

use crate::common::dormand_prince::dormand_prince;
use crate::common::{curve, distance, model, nominal, order};

const G: f64 = 9.81;

/// Heights and speeds of wheel and body of `quarter_car.yaml`, every 20 ms.
fn quarter_car() -> Vec<[f64; 4]> {
    let (body, wheel, spring, damper, tyre) = (350.0, 40.0, 20e3, 1.5e3, 180e3);
    let motion = |t: f64, [low, high, low_rate, high_rate]: [f64; 4]| {
        let share = ((t - 0.1) * 10.0 / 2.0).clamp(0.0, 1.0);
        let road = 0.025 * (1.0 - (std::f64::consts::TAU * share).cos());
        let suspension = spring * (high - low) + damper * (high_rate - low_rate);
        [low_rate, high_rate, (suspension - tyre * (low - road)) / wheel - G, -suspension / body - G]
    };
    let rest = -(body + wheel) * G / tyre;
    dormand_prince(motion, [rest, rest - body * G / spring, 0.0, 0.0], 0.02, 76, 1e-10)
}

#[test]
fn the_quarter_car_drives_over_its_bump() {
    let expected = quarter_car();
    let errors = [1e-3, 5e-4].map(|h| {
        let bounds = nominal(&model("quarter_car").observing(&["wheel.y", "body.y"]).step(h));
        let error = |name: &str, index: usize| {
            let expected: Vec<f64> = expected.iter().map(|row| row[index]).collect();
            distance(curve(&bounds, name), &expected)
        };
        error("wheel.y", 0).max(error("body.y", 1))
    });
    println!("{errors:?}");
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1 && errors[1] < 2e-5, "{errors:?}");
}

/// Force of the axle's spring of `braking_car.yaml`, by the height of its end and its rate.
fn axle(height: f64, rate: f64) -> f64 {
    -22e3 * height - 1.8e3 * rate
}

/// x, y, angle of the braking car and their rates, every 20 ms.
fn braking_car() -> Vec<[f64; 6]> {
    let (mass, inertia, front, rear, unloaded): (f64, f64, f64, f64, f64) = (600.0, 700.0, 1.2, 1.5, 0.68);
    let motion = |t: f64, [_, y, angle, vx, vy, turn]: [f64; 6]| {
        let (sin, cos) = angle.sin_cos();
        let push = |along: f64| axle(y + along * sin, vy + along * cos * turn);
        let (first, second) = (push(front), push(-rear));
        let brake = 0.7 * ((t - 0.2) / 0.1).clamp(0.0, 1.0);
        // The road's forces act below the axles, on the road.
        let torque = |along: f64, push: f64| along * cos * push - (unloaded + y) * brake * push;
        let about = torque(front, first) + torque(-rear, second);
        [vx, vy, turn, -brake * (first + second) / mass, (first + second) / mass - G, about / inertia]
    };
    let length = front + rear;
    let sine = mass * G / 22e3 * (rear - front) / (length * length);
    let start = [0.0, -mass * G / 22e3 * rear / length + front * sine, -sine.asin(), 20.0, 0.0, 0.0];
    dormand_prince(motion, start, 0.02, 76, 1e-10)
}

#[test]
fn the_braking_car_dives() {
    let expected = braking_car();
    let names = ["car.vx", "car.y", "car.angle"];
    let errors = [2e-3, 1e-3].map(|h| {
        let bounds = nominal(&model("braking_car").observing(&names).step(h));
        let errors = names.iter().zip([3, 1, 2]).map(|(name, index)| {
            let expected: Vec<f64> = expected.iter().map(|row| row[index]).collect();
            distance(curve(&bounds, name), &expected)
        });
        errors.fold(0.0, f64::max)
    });
    println!("{errors:?}");
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.2 && errors[1] < 1e-4, "{errors:?}");
}

#[test]
fn the_braking_cars_front_axle_carries_more() {
    // The pitch has faded after 6 s.
    let names = ["-front.force", "car.y", "car.angle"];
    let bounds = nominal(&model("braking_car").observing(&names).duration(6.0));
    let [front, y, angle] = names.map(|name| *curve(&bounds, name).last().unwrap());
    let expected = 600.0 * G * (1.5 + 0.7 * (0.68 + y) / angle.cos()) / 2.7;
    assert!((front - expected).abs() < 1e-3, "{front} instead of {expected} N");
}
