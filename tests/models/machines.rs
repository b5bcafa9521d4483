//! Machines of `models/` against closed forms: of positions by trigonometry, of drives at rest by virtual work.

use std::f64::consts::PI;

use crate::common::{curve, distance_from, largest, model, nominal, order};

/// Newton's tolerance (1e-11 of the model's size) times the slopes of the closed forms.
const CLOSED: f64 = 1e-9;

/// A move from rest to rest by the polynomial of degree five.
fn quintic(from: f64, to: f64, share: f64) -> f64 {
    let u = share.clamp(0.0, 1.0);
    from + (to - from) * u * u * u * (10.0 + u * (6.0 * u - 15.0))
}

/// The derivative of a function, by central differences.
fn slope(f: impl Fn(f64) -> f64, x: f64) -> f64 {
    let h = 1e-4;
    (8.0 * (f(x + h) - f(x - h)) - (f(x + 2.0 * h) - f(x - 2.0 * h))) / (12.0 * h)
}

/// Position of the plate of `delta_robot.yaml`, by the arms' angles: the lower of the two points where three spheres
/// meet.
fn plate(angles: [f64; 3]) -> [f64; 3] {
    let (base, arm, rod, plate) = (0.2, 0.3, 0.6, 0.06);
    let centres: [[f64; 3]; 3] = std::array::from_fn(|leg| {
        let (sin, cos) = (2.0 * PI / 3.0 * leg as f64).sin_cos();
        let radius = base + arm * angles[leg].cos() - plate;
        [radius * cos, radius * sin, -arm * angles[leg].sin()]
    });
    // |p − c₀| = |p − c₁| = |p − c₂|: a line along n; then its point at the distance of the rod.
    let minus = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| a[i] - b[i]) };
    let dot = |a: [f64; 3], b: [f64; 3]| -> f64 { (0..3).map(|i| a[i] * b[i]).sum() };
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let (u, v) = (minus(centres[1], centres[0]), minus(centres[2], centres[0]));
    let n = cross(u, v);
    let (uu, vv, nn) = (dot(u, u), dot(v, v), dot(n, n));
    let (first, second) = (cross(n, u), cross(v, n));
    // The circumcentre of the triangle of the centres, from the first.
    let middle: [f64; 3] = std::array::from_fn(|i| (vv * -first[i] + uu * -second[i]) / (-2.0 * nn));
    let height = (rod * rod - dot(middle, middle)).sqrt() / nn.sqrt();
    let sign = if n[2] > 0.0 { -1.0 } else { 1.0 };
    std::array::from_fn(|i| centres[0][i] + middle[i] + sign * height * n[i])
}

/// The arms' angles of `delta_robot.yaml`.
fn arms(t: f64) -> [f64; 3] {
    [0.7, 0.1, 0.4].map(|to| quintic(0.3, to, t / 0.4))
}

#[test]
fn plate_of_the_delta_robot_matches_three_spheres() {
    let formulas = ["plate.x", "plate.y", "plate.z", "plate.p0"];
    let bounds = nominal(&model("delta_robot").observing(&formulas));
    for (index, name) in formulas[..3].iter().enumerate() {
        let error = distance_from(&bounds.times, curve(&bounds, name), |t| plate(arms(t))[index]);
        assert!(error < CLOSED, "{name} is off by {error:e} m");
    }
    // It does not turn.
    assert!(distance_from(&bounds.times, curve(&bounds, "plate.p0"), |_| 1.0) < CLOSED);
}

#[test]
fn the_delta_robots_drives_carry_its_weight() {
    let formulas = ["drive1.torque", "drive2.torque", "drive3.torque"];
    // From 0.4 s on the robot is at rest.
    let bounds = nominal(&model("delta_robot").observing(&formulas));
    let last = bounds.times.len() - 1;
    for (leg, name) in formulas.iter().enumerate() {
        let potential = |angle: f64| {
            let mut angles = arms(0.5);
            angles[leg] = angle;
            9.81 * (1.5 * plate(angles)[2] - 0.8 * 0.15 * angle.sin())
        };
        let expected = slope(potential, arms(0.5)[leg]);
        let torque = curve(&bounds, name)[last];
        assert!((torque - expected).abs() < 1e-6, "{name}: {torque} instead of {expected} N m");
    }
}

/// Angles of boom and stick of `excavator.yaml` by the cylinders' lengths.
fn excavator_angles(lift: f64, reach: f64) -> (f64, f64) {
    let between = |a: f64, b: f64, c: f64| ((a * a + b * b - c * c) / (2.0 * a * b)).acos();
    let foot = (-0.5_f64).atan2(0.6);
    let boom = foot + between(0.6_f64.hypot(0.5), 1.5, lift);
    // From the stick's bearing, the foot of its cylinder is back along the boom and up.
    let foot = PI - 0.4_f64.atan2(3.5 - 1.8);
    let eye = foot - between((3.5_f64 - 1.8).hypot(0.4), 0.5, reach);
    // The eye is opposite to the stick's end.
    (boom, eye - PI)
}

#[test]
fn the_excavators_angles_obey_the_law_of_cosines() {
    let bounds = nominal(&model("excavator").observing(&["boom.angle", "stick.angle - boom.angle", "lift.axial"]));
    let at = |t: f64| excavator_angles(quintic(1.3, 1.6, t / 2.0), quintic(1.5, 1.3, t / 2.0));
    let boom = distance_from(&bounds.times, curve(&bounds, "boom.angle"), |t| at(t).0);
    let stick = distance_from(&bounds.times, curve(&bounds, "stick.angle - boom.angle"), |t| at(t).1);
    assert!(boom < CLOSED && stick < CLOSED, "boom off by {boom:e}, stick by {stick:e}");
}

/// Potential energy of the excavator's parts.
fn excavator_potential(lift: f64, reach: f64) -> f64 {
    let (boom, stick) = excavator_angles(lift, reach);
    let at = |length: f64, height: f64| length * boom.sin() + height * boom.cos();
    let tip = at(3.5, 0.0);
    let end = |length: f64| tip + length * (boom + stick).sin();
    // Centres of barrel and rod are 0.4 m from the ends of the cylinder.
    let cylinder = |foot: f64, eye: f64, length: f64| {
        let sine = (eye - foot) / length;
        40.0 * (foot + 0.4 * sine) + 25.0 * (eye - 0.4 * sine)
    };
    let masses = 500.0 * at(1.75, 0.0) + 250.0 * end(1.0) + 800.0 * end(2.0);
    9.81 * (masses + cylinder(-0.5, at(1.5, 0.0), lift) + cylinder(at(1.8, 0.4), end(-0.5), reach))
}

#[test]
fn the_excavators_cylinders_hold_its_weight() {
    // The move ends at rest, without acceleration.
    let bounds = nominal(&model("excavator"));
    let expected = [
        ("lift", slope(|length| excavator_potential(length, 1.3), 1.6)),
        ("reach", slope(|length| excavator_potential(1.6, length), 1.3)),
    ];
    for (name, expected) in expected {
        let force = curve(&bounds, name).last().unwrap();
        assert!((force - expected).abs() < 1e-4 * expected.abs(), "{name}: {force} instead of {expected} N");
    }
}

/// Angle, speed and acceleration of the wheel of `geneva.yaml`.
fn geneva(t: f64) -> [f64; 3] {
    let (ratio, speed) = (80.0_f64 / 40.0, 2.0 * PI);
    let (sin, cos) = (-PI / 3.0 + speed * t).sin_cos();
    let square = 1.0 + ratio * ratio - 2.0 * ratio * cos;
    let rate = speed * (ratio * cos - 1.0) / square;
    [sin.atan2(ratio - cos), rate, speed * speed * ratio * sin * (1.0 - ratio * ratio) / (square * square)]
}

#[test]
fn geneva_wheel_matches_the_pin_in_its_slot() {
    let formulas = ["wheel.angle - pi", "wheel.angular_velocity", "slot.force"];
    let runs = [2.0, 1.0].map(|steps| nominal(&model("geneva").observing(&formulas).step(steps / 3000.0)));
    let errors = runs.map(|bounds| {
        // The wheel turns against the driver.
        let angle = distance_from(&bounds.times, curve(&bounds, formulas[0]), |t| -geneva(t)[0]);
        assert!(angle < CLOSED, "the wheel is off by {angle:e}");
        let speed = distance_from(&bounds.times, curve(&bounds, formulas[1]), |t| -geneva(t)[1]);
        let push = |t: f64| {
            let (sin, cos) = (-PI / 3.0 + 2.0 * PI * t).sin_cos();
            4e-4 * geneva(t)[2].abs() / (0.08 - 0.04 * cos).hypot(0.04 * sin)
        };
        [speed, distance_from(&bounds.times, curve(&bounds, formulas[2]), push)]
    });
    println!("speed, push: {errors:?}");
    for quantity in 0..2 {
        assert!((order(errors[0][quantity], errors[1][quantity]) - 2.0).abs() < 0.2, "{errors:?}");
    }
    assert!(errors[1][0] < 1e-4 && errors[1][1] < 1e-4, "{errors:?}");
}

#[test]
fn the_planetary_gear_runs_up_as_one_inertia() {
    // All speeds are multiples of the carrier's: 4 of the sun, 1 − 3 of the planets.
    let planet = 0.1;
    let inertia = 2e-5 * 16.0 + 0.15 + 3.0 * (planet * 0.04 * 0.04 + 0.5 * planet * 0.02 * 0.02 * 4.0);
    let carrier = |t: f64| 4.0 * 2.0 / 0.4 * -(-0.4 * t / inertia).exp_m1();
    let formulas = ["carrier.angular_velocity", "sun.angular_velocity - carrier.angular_velocity*3"];
    let errors = [2e-3, 1e-3].map(|h| {
        let bounds = nominal(&model("planetary_gear").observing(&formulas).step(h));
        largest(formulas.map(|name| distance_from(&bounds.times, curve(&bounds, name), carrier)))
    });
    println!("{errors:?}");
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1 && errors[1] < 1e-4, "{errors:?}");
}
