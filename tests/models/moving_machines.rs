//! Machines of `models/` in motion against closed forms and against other programs.

use std::f64::consts::TAU;

use crate::common::dormand_prince::dormand_prince;
use crate::common::{curve, distance, distance_from, model, nominal, order};

/// Newton's tolerance (1e-11 of the model's size) times the slopes of the closed forms.
const CLOSED: f64 = 1e-9;

/// Lift of the cam of `cam.yaml` by its angle, and the lift's first two derivatives: 3-4-5 polynomials.
fn lift(angle: f64) -> [f64; 3] {
    let third = TAU / 3.0;
    let rise = |share: f64| {
        let u = share.clamp(0.0, 1.0);
        let slope = 30.0 * u * u * (1.0 - u) * (1.0 - u);
        let curvature = 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u);
        [u * u * u * (10.0 + u * (6.0 * u - 15.0)), slope / third, curvature / (third * third)]
    };
    let (up, down) = (rise(angle / third), rise(angle / third - 1.0));
    std::array::from_fn(|order| 0.01 * (up[order] - down[order]))
}

#[test]
fn the_cam_pushes_with_the_followers_inertia_and_spring() {
    let (base, stiffness, preload, mass, speed) = (0.03, 2000.0, 60.0, 0.25, 300.0 / 60.0 * TAU);
    let names = ["height", "contact", "side", "torque"];
    // The follower's position is kinematics; forces follow from accelerations, which have the scheme's order of two.
    let expected = |t: f64| {
        let [s, slope, curvature] = lift(speed * t);
        let upwards = mass * curvature * speed * speed + preload + stiffness * s;
        let pressure = slope / (base + s);
        [base + s, upwards * pressure.hypot(1.0), upwards * pressure, upwards * slope]
    };
    let errors = [2e-4, 1e-4].map(|h| {
        let bounds = nominal(&model("cam").step(h));
        let after_start = |t: f64| t > 0.01;
        names.map(|name| {
            let values = curve(&bounds, name).iter().zip(&bounds.times).filter(|(_, t)| after_start(**t));
            let index = names.iter().position(|known| *known == name).unwrap();
            values.map(|(value, t)| (value.abs() - expected(*t)[index].abs()).abs()).fold(0.0, f64::max)
        })
    });
    println!("{errors:?}");
    assert!(errors[1][0] < CLOSED, "{errors:?}");
    for index in 1..4 {
        let largest = [1.0, 100.0, 10.0, 1.0][index];
        assert!(errors[1][index] < 1e-7 * largest, "{}: {errors:?}", names[index]);
        assert!((order(errors[0][index], errors[1][index]) - 2.0).abs() < 0.3, "{}: {errors:?}", names[index]);
    }
}

#[test]
fn strands_of_the_belt_share_the_torque_of_the_fan() {
    let (stiffness, damping, preload) = (2e5, 60.0, 300.0);
    let [first, second] = [0.04, 0.1];
    let stretch =
        |t: f64, [angle, rate]: [f64; 2]| [first * 50.0 * t * t - second * angle, first * 100.0 * t - second * rate];
    // Both strands stay taut: a linear equation of one angle.
    let motion = |t: f64, fan: [f64; 2]| {
        let [shift, rate] = stretch(t, fan);
        [fan[1], (2.0 * second * (stiffness * shift + damping * rate) - 0.005 * fan[1]) / 0.02]
    };
    let solution = dormand_prince(motion, [0.0, 0.0], 0.01, 51, 1e-11);
    let errors = [1e-4, 5e-5].map(|h| {
        let bounds = nominal(&model("belt").step(h));
        let expected = |of: &dyn Fn(f64, [f64; 2]) -> f64| -> Vec<f64> {
            bounds.times.iter().zip(&solution).map(|(&t, fan)| of(t, *fan)).collect()
        };
        let pull = |t: f64, fan: [f64; 2]| {
            let [shift, rate] = stretch(t, fan);
            stiffness * shift + damping * rate
        };
        let tight = expected(&|t, fan| preload + pull(t, fan));
        let slack = expected(&|t, fan| preload - pull(t, fan));
        assert!(slack.iter().all(|tension| *tension > 0.0));
        [
            distance(curve(&bounds, "speed"), &expected(&|_, fan| fan[1])),
            distance(curve(&bounds, "tight"), &tight),
            distance(curve(&bounds, "slack"), &slack),
        ]
    });
    println!("{errors:?}");
    for index in 0..3 {
        let (coarse, fine) = (errors[0][index], errors[1][index]);
        assert!(fine < [5e-5, 2e-3, 2e-3][index] && (order(coarse, fine) - 2.0).abs() < 0.2, "{errors:?}");
    }
}

/// Squares of the lengths of odd and even legs of `stewart.yaml`.
fn legs(t: f64) -> [f64; 2] {
    let (base, plate, height) = (0.6_f64, 0.35, 0.7);
    let straight = (base * base + plate * plate - 2.0 * base * plate * (TAU / 12.0).cos() + height * height).sqrt();
    let (rise, swing) = (0.02 * (1.0 - (TAU * t).cos()), 0.005 * (TAU * t).sin().powi(3));
    [(straight + rise - swing).powi(2), (straight + rise + swing).powi(2)]
}

/// Height and turn of the platform: legs of one kind are a third of a turn apart, so that it rises and turns only.
fn platform(t: f64) -> [f64; 2] {
    let (base, plate) = (0.6_f64, 0.35);
    let [odd, even] = legs(t);
    let turn = ((odd - even) / (2.0 * base * plate)).asin();
    let across = base * base + plate * plate - 2.0 * base * plate * (TAU / 12.0 + turn).cos();
    [(odd - across).sqrt(), turn]
}

/// The second derivative, by central differences.
fn second(f: impl Fn(f64) -> f64, t: f64) -> f64 {
    let h = 1e-3;
    let pair = |h: f64| f(t + h) + f(t - h) - 2.0 * f(t);
    (16.0 * pair(h) - pair(2.0 * h)) / (12.0 * h * h)
}

#[test]
fn the_platform_on_six_legs_rises_and_turns() {
    let bounds = nominal(&model("stewart").observing(&[
        "plate.x",
        "plate.y",
        "plate.z",
        "plate.yaw",
        "plate.roll",
        "plate.pitch",
    ]));
    for (name, expected) in [("plate.z", 0), ("plate.yaw", 1)] {
        let error = distance_from(&bounds.times, curve(&bounds, name), |t| platform(t)[expected]);
        assert!(error < CLOSED, "{name} is off by {error:e}");
    }
    for name in ["plate.x", "plate.y", "plate.roll", "plate.pitch"] {
        assert!(distance_from(&bounds.times, curve(&bounds, name), |_| 0.0) < CLOSED, "{name}");
    }
}

#[test]
fn the_platforms_legs_carry_and_turn_it() {
    let (mass, inertia, lever) = (12.0, 0.7, 0.6 * 0.35);
    // Three legs of a kind push alike: lift and twist.
    let forces = |t: f64| {
        let ([height, turn], lengths) = (platform(t), legs(t).map(f64::sqrt));
        let lift = mass * (9.81 + second(|t| platform(t)[0], t)) / 3.0;
        let twist = inertia * second(|t| platform(t)[1], t) / 3.0;
        let lifts = lengths.map(|length| height / length);
        let twists = [(TAU / 12.0 + turn).sin() * lever / lengths[0], -(TAU / 12.0 - turn).sin() * lever / lengths[1]];
        let determinant = lifts[0] * twists[1] - lifts[1] * twists[0];
        [(lift * twists[1] - twist * lifts[1]) / determinant, (twist * lifts[0] - lift * twists[0]) / determinant]
    };
    let names = ["force_1", "force_2", "force_3", "force_4", "force_5", "force_6"];
    let errors = [1e-3, 5e-4].map(|h| {
        let bounds = nominal(&model("stewart").step(h));
        let start = bounds.times.iter().position(|&t| t > 0.05).unwrap();
        let error = |leg: usize| {
            let expected = |t: f64| forces(t)[leg % 2].abs();
            distance_from(&bounds.times[start..], &curve(&bounds, names[leg])[start..], expected)
        };
        (0..6).map(error).fold(0.0, f64::max)
    });
    println!("{errors:?}");
    assert!(errors[1] < 2e-6 && (order(errors[0], errors[1]) - 2.0).abs() < 0.3, "{errors:?}");
}

/// Results of Pinocchio 4.1.0's articulated-body algorithm and SciPy's DOP853 (tolerances 1e-11 and 1e-13) for
/// `arm.urdf` with the payload, the controllers and friction v/√(v² + 0.05²): time, tool's x and z, shoulder, upper
/// arm, forearm, second wrist.
const ARM: [[f64; 7]; 5] = [
    [0.0, 0.5906262788, 1.0897074732, 0.0, 0.2, 0.6, 0.5],
    [0.1, 0.6952160138, 0.9866335245, 0.1604655101, 0.3020245948, 0.7180706927, 0.3212762578],
    [0.2, 0.7681409197, 0.8186740236, 0.3037279632, 0.4172673750, 0.8453576563, 0.3592544771],
    [0.5, 0.7404062437, 0.7052545623, 0.5200001120, 0.5029048710, 0.9154214640, 0.3527654838],
    [1.0, 0.7096412053, 0.7102560550, 0.5896556027, 0.5035842422, 0.9092350360, 0.3415392048],
];

#[test]
fn the_arm_moves_as_in_pinocchio() {
    let names = ["tool_x", "tool_z", "shoulder", "upper_arm", "forearm", "wrist_2"];
    let errors = [1e-3, 5e-4].map(|h| {
        let bounds = nominal(&model("six_axis_arm").step(h));
        let at = |t: f64| bounds.times.iter().position(|time| (time - t).abs() < 1e-9).unwrap();
        let error = |row: &[f64; 7]| {
            let found = names.iter().map(|name| curve(&bounds, name)[at(row[0])]);
            found.zip(&row[1..]).map(|(value, expected)| (value - expected).abs()).fold(0.0, f64::max)
        };
        ARM.iter().map(error).fold(0.0, f64::max)
    });
    println!("{errors:?}");
    assert!(errors[1] < 1e-5 && (order(errors[0], errors[1]) - 2.0).abs() < 0.2, "{errors:?}");
}
