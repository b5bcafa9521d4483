//! Balls and discs that roll on planes: on a slope, on a turntable, in circles, falling over, on a cart.

use mbint::Formulation;
use mbint::results::Method;

use crate::common::dormand_prince::dormand_prince;
use crate::common::power::{APART_IN_SPACE, assert_balance, spatial_pair};
use crate::common::{Subject, band, curve, distance, distance_from, largest, nominal, order, output, read, run};

const G: f64 = 9.81;

/// How a motion is integrated, and by how much it may be off.
const WAYS: [(&str, f64); 4] = [
    ("step: 1e-3", 1e-4),
    ("step: 2e-3, extrapolation: 4", 2e-8),
    ("tolerance: 1e-8", 1e-6),
    ("scheme: explicit, tolerance: 1e-9", 1e-7),
];

fn formulated(description: Subject, formulation: Formulation) -> Subject {
    description.formulation(formulation)
}

/// A solid ball on a slope has 5/7 of a slide's acceleration, and needs 2/7 of its weight along the slope as friction.
#[test]
fn a_ball_rolls_down_a_slope() {
    let description = read(
        "
parameters: { k: { value: 0.4, tolerance: 5% } }
bodies: { ball: { mass: 2, inertia: k*2*0.1^2 } }
joints: { roll: { rolling_on_plane: { between: [ground, ball], normal: [-3, 0, 4], radius: 0.1 } } }
effects: { weight: { gravity: { acceleration: [0, 0, -9.81] } } }
initial: { ball.x: 0, ball.y: 0.2, ball.vx: 0, ball.vy: 0.5, ball.orientation: { rpy: [0, 0, 0] }, ball.omega.z: 0 }
outputs: { x: ball.x, y: ball.y, z: ball.z, fx: roll.force.x, fz: roll.force.z }
simulation: { duration: 1, step: 2e-3, extrapolation: 4, output_step: 0.1 }
bounds: { chebyshev: { order: 4 }, taylor: {} }
",
    );
    let acceleration = |k: f64| -G * 0.6 / (1.0 + k);
    for formulation in [Formulation::Absolute, Formulation::Auto] {
        let bounds = run(&formulated(description.clone(), formulation));
        let off = |name: &str, wanted: &dyn Fn(f64) -> f64| distance_from(&bounds.times, curve(&bounds, name), wanted);
        let x = |k: f64, t: f64| 0.8 * 0.5 * acceleration(k) * t * t;
        assert!(off("x", &|t| x(0.4, t)) < 1e-9, "{}", off("x", &|t| x(0.4, t)));
        assert!(off("y", &|t| 0.2 + 0.5 * t) < 1e-9);
        assert!(off("z", &|t| 0.75 * x(0.4, t) + 0.1 / 0.8) < 1e-9);
        let (push, friction) = (2.0 * G * 0.8, 2.0 * G * 0.6 * 0.4 / 1.4);
        assert!(off("fx", &|_| -0.6 * push + 0.8 * friction) < 1e-7);
        assert!(off("fz", &|_| 0.8 * push + 0.6 * friction) < 1e-7);
        for method in [Method::Chebyshev, Method::Taylor] {
            let band = band(output(&bounds, "x"), method);
            for (row, &t) in bounds.times.iter().enumerate() {
                let allowed = band.error.total[row] + 1e-9;
                let [low, high] = [0.38, 0.42].map(|k| x(k, t));
                let off = (band.lower[row] - low).abs().max((band.upper[row] - high).abs());
                assert!(off < allowed, "{method:?} {t}: {off:e} {allowed:e}");
            }
        }
    }
}

/// On a table that turns with Ω a solid ball moves on a circle, 2/7 as fast as the table, whatever its size.
#[test]
fn a_ball_circles_on_a_turntable() {
    let text = |simulation: &str| {
        format!(
            "
parameters: {{ turn: {{ value: 3, unit: rad/s, tolerance: 2% }} }}
bodies: {{ table: {{ mass: 5, inertia: 1 }}, ball: {{ mass: 0.3, inertia: 0.4*0.3*0.05^2 }} }}
joints:
  bearing: {{ revolute: {{ between: [ground, table], axis: z }} }}
  drive: {{ motor: {{ on: bearing, speed: turn }} }}
  roll: {{ rolling_on_plane: {{ between: [table, ball], radius: 0.05 }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }} }}
initial: {{ ball.x: 0.4, ball.y: 0, ball.vx: 0, ball.vy: 0.3, ball.orientation: {{ rpy: [0, 0, 0] }}, ball.omega.z: 0 }}
outputs: {{ x: ball.x, y: ball.y }}
simulation: {{ duration: 2, output_step: 0.2, {simulation} }}
bounds: {{ chebyshev: {{ order: 6 }} }}
"
        )
    };
    let x = |turn: f64, t: f64| 0.4 - 0.3 * (1.0 - (2.0 / 7.0 * turn * t).cos()) / (2.0 / 7.0 * turn);
    for (simulation, allowed) in WAYS {
        for formulation in [Formulation::Absolute, Formulation::Auto] {
            let bounds = run(&formulated(read(&text(simulation)), formulation));
            let off = distance_from(&bounds.times, curve(&bounds, "x"), |t| x(3.0, t));
            assert!(off < allowed, "{simulation}: {off:e}");
            let off = distance_from(&bounds.times, curve(&bounds, "y"), |t| 0.3 * (6.0 / 7.0 * t).sin() / (6.0 / 7.0));
            assert!(off < allowed, "{simulation}: {off:e}");
            let band = band(output(&bounds, "x"), Method::Chebyshev);
            for (row, &t) in bounds.times.iter().enumerate() {
                let all = (0..=200).map(|index| x(2.94 + 0.12 * f64::from(index) / 200.0, t));
                let (low, high) = all.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
                let off = (band.lower[row] - low).abs().max((band.upper[row] - high).abs());
                assert!(off < band.error.total[row] + allowed, "{simulation} {t}: {off:e}");
            }
        }
    }
}

/// A coin of mass 0.2 and radius 0.1 with its axle at an angle from upright, that turns with ω₁ about the horizontal of
/// its plane, ω₂ about the steepest line of it and ω₃ about its axle.
fn coin(tilt: f64, [omega_1, omega_2, omega_3]: [f64; 3], simulation: &str) -> Subject {
    let (s, c) = tilt.sin_cos();
    let omega = [omega_3 * s - omega_2 * c, omega_1, omega_2 * s + omega_3 * c];
    read(&format!(
        "
bodies: {{ coin: {{ mass: 0.2, inertia: [5e-4, 5e-4, 1e-3], points: {{ tip: [0, 0, 1] }} }} }}
joints: {{ roll: {{ rolling_on_plane: {{ between: [ground, coin], axle: z, radius: 0.1 }} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }} }}
initial:
  coin.x: 0
  coin.y: 0
  coin.orientation: {{ rpy: [0, {tilt}, 0] }}
  coin.omega: {omega:?}
outputs: {{ x: coin.x, y: coin.y, up: coin.tip.z - coin.z, fz: roll.force.z, energy: energy }}
simulation: {{ duration: 2, output_step: 0.05, {simulation} }}
"
    ))
}

/// The same by the Newton–Euler equations in axes that follow the steepest line of the coin: tilt, ω₁, ω₂, ω₃, heading,
/// x, y.
fn rolling_coin(tilt: f64, omega: [f64; 3], rows: usize) -> Vec<[f64; 7]> {
    let (m, r, across, along) = (0.2, 0.1, 5e-4, 1e-3);
    let law = |_: f64, [tilt, w1, w2, w3, heading, _, _]: [f64; 7]| {
        let (s, c) = tilt.sin_cos();
        let frame = w2 * c / s;
        let total = along + m * r * r;
        let v = [-r * w3, r * w1 * s];
        let (sin, cos) = heading.sin_cos();
        [
            w1,
            (across * frame * w2 - total * w2 * w3 - m * G * r * c) / (across + m * r * r),
            (along * w1 * w3 - across * frame * w1) / across,
            m * r * r * w1 * w2 / total,
            w2 / s,
            -v[0] * sin + v[1] * cos,
            v[0] * cos + v[1] * sin,
        ]
    };
    dormand_prince(law, [tilt, omega[0], omega[1], omega[2], 0.0, 0.0, 0.0], 0.05, rows, 1e-12)
}

#[test]
fn wobbling_coin_matches_newton_euler_equations() {
    let (tilt, omega) = (1.0, [0.3, 1.5, -9.0]);
    let exact = rolling_coin(tilt, omega, 41);
    let wanted = |index: usize| exact.iter().map(|row| row[index]).collect::<Vec<f64>>();
    let up: Vec<f64> = exact.iter().map(|row| row[0].cos()).collect();
    assert!(largest(up.iter().map(|value| value - up[0])) > 0.15, "it hardly wobbles: {up:?}");
    for (simulation, allowed) in [("step: 5e-4", 2e-3), ("step: 1e-3, extrapolation: 4", 1e-6), WAYS[3]] {
        for formulation in [Formulation::Absolute, Formulation::Auto] {
            let found = nominal(&formulated(coin(tilt, omega, simulation), formulation));
            for (name, wanted) in [("x", wanted(5)), ("y", wanted(6)), ("up", up.clone())] {
                let off = distance(curve(&found, name), &wanted);
                assert!(off < allowed, "{simulation} {name}: {off:e}");
            }
        }
    }
}

/// A coin runs in a circle of radius b at the rate Ω where m g r cos α = Ω² sin α (A cos α + C b/r + m r b).
#[test]
fn a_coin_runs_in_a_circle() {
    let (tilt, b) = (1.1_f64, 0.4);
    let (s, c) = tilt.sin_cos();
    let rate = (0.2 * G * 0.1 * c / (s * (5e-4 * c + 1e-3 * b / 0.1 + 0.2 * 0.1 * b))).sqrt();
    let found = nominal(&coin(tilt, [0.0, rate * s, -rate * b / 0.1], "step: 1e-3, extrapolation: 3"));
    for (name, wanted) in [("up", c), ("fz", 0.2 * G)] {
        let off = distance_from(&found.times, curve(&found, name), |_| wanted);
        assert!(off < 1e-6, "{name}: {off:e}");
    }
    // It starts on the x axis, seen from the centre of its circle.
    let off = distance_from(&found.times, curve(&found, "x"), |t| b * ((rate * t).cos() - 1.0));
    assert!(off < 1e-6, "{off:e}");
}

/// Upright, a thin disc is stable where it rolls faster than ω² = g/(3 r): one that leans by ε comes as far as (2 κ/(κ
/// − 1) − 1) ε, where κ is the ratio of ω² to that.
#[test]
fn a_coin_falls_over_where_it_rolls_too_slowly() {
    let lean = 1e-4;
    for share in [0.8, 0.95, 1.05, 1.3] {
        let speed = share * (G / 0.3_f64).sqrt();
        let found = nominal(&coin(std::f64::consts::FRAC_PI_2 - lean, [0.0, 0.0, -speed], "step: 1e-3"));
        let farthest = largest(curve(&found, "up").iter().copied()) / lean;
        if share < 1.0 {
            assert!(farthest > 100.0, "{share} of the critical speed: {farthest}");
        } else {
            let wanted = 2.0 * share * share / (share * share - 1.0) - 1.0;
            assert!(
                (farthest - wanted).abs() < 0.01 * wanted,
                "{share} of the critical speed: {farthest}, not {wanted}"
            );
        }
    }
}

/// No power is lost, the touching point has no velocity, and the steps are of order two.
#[test]
fn a_coin_keeps_its_energy_and_does_not_slip() {
    // The lowest point is at −r w/|w|, w = ẑ − u_z u with the axle u.
    let u = "(coin.tip.z - coin.z)";
    let steep = format!("sqrt(1 - {u}^2)");
    let arm = [
        format!("(0.1*{u}*(coin.tip.x - coin.x)/{steep})"),
        format!("(0.1*{u}*(coin.tip.y - coin.y)/{steep})"),
        format!("(-0.1*{steep})"),
    ];
    let slip = [
        format!("coin.vx + coin.omega.y*{} - coin.omega.z*{}", arm[2], arm[1]),
        format!("coin.vy + coin.omega.z*{} - coin.omega.x*{}", arm[0], arm[2]),
        format!("coin.z + {}", arm[2]),
    ];
    let mut observed: Vec<&str> = slip.iter().map(String::as_str).collect();
    observed.push("energy");
    let runs = [2e-3, 1e-3, 5e-4].map(|h| {
        let description = coin(1.0, [0.3, 1.5, -9.0], "step: 1e-3").step(h).observing(&observed);
        nominal(&description)
    });
    for found in &runs {
        for slip in &slip {
            let off = largest(curve(found, slip).iter().copied());
            assert!(off < 1e-9, "{slip}: {off:e}");
        }
    }
    let drift = |index: usize| {
        let energy = curve(&runs[index], "energy");
        largest(energy.iter().map(|value| value - energy[0]))
    };
    assert!(drift(2) < 1e-4 && order(drift(1), drift(2)) > 1.7, "{} {}", drift(1), drift(2));
}

/// On a body that is thrown, about an axle that is askew.
#[test]
fn reactions_do_no_work() {
    for (joint, kept) in [
        ("between: [a.P, b], normal: [1, 2, -0.5], axle: [0.3, 1, 2], radius: 0.2", &["b.orientation", "b.omega"][..]),
        ("between: [a.P, b.P], normal: [-1, 0.3, 1], radius: 0.3", &["b.orientation", "b.omega"]),
    ] {
        let is_kept = |line: &&str| kept.iter().any(|name| line.trim().starts_with(name));
        let start: Vec<&str> = APART_IN_SPACE.lines().filter(is_kept).collect();
        assert_balance(
            &spatial_pair(&format!("  j: {{ rolling_on_plane: {{ {joint} }} }}"), "", &start.join("\n")),
            "0",
        );
    }
}

/// A cart on two wheels and a caster without friction: heights and one sideways slip are redundant.
#[test]
fn a_cart_steers_by_its_wheels() {
    let text = "
space: spatial
bodies:
  ground: { points: { high: [0, 0, 0.1] } }
  cart: { mass: 4, inertia: [0.1, 0.1, 0.3], center_of_mass: [0.2, 0, 0], points: { left: [0, 0.25, 0], right: [0, -0.25, 0] } }
  left: { mass: 0.5, inertia: { xx: 1.25e-3, yy: 2.5e-3, zz: 1.25e-3 } }
  right: { mass: 0.5, inertia: { xx: 1.25e-3, yy: 2.5e-3, zz: 1.25e-3 } }
joints:
  floor: { planar: { between: [ground.high, cart], normal: z } }
  axle_left: { revolute: { between: [cart.left, left], axis: y } }
  axle_right: { revolute: { between: [cart.right, right], axis: y } }
  roll_left: { rolling_on_plane: { between: [ground, left], axle: y, radius: 0.1 } }
  roll_right: { rolling_on_plane: { between: [ground, right], axle: y, radius: 0.1 } }
effects: { push: { force: { on: cart, value: [1, 0, 0], frame: body } } }
initial: { cart.x: 0, cart.y: 0, cart.orientation: { rpy: [0, 0, 0] }, axle_left.angle: 0, axle_right.angle: 0, cart.omega.z: 0.8, cart.vx: 0.2 }
outputs: { x: cart.x, y: cart.y, omega: cart.omega.z }
simulation: { duration: 2, step: 1e-3, output_step: 0.1 }
";
    // The midpoint of the axle moves along the cart; its centre of mass is d before it (Chaplygin's sleigh, with wheels
    // that turn).
    let (mass, inertia, before) =
        (5.0 + 2.0 * 0.25, 0.3 + 0.16 + 2.0 * (0.5 * 0.0625 + 1.25e-3) + 0.5 * 0.0625, 4.0 * 0.2);
    let law = |_: f64, [u, omega, heading, ..]: [f64; 5]| {
        let (sin, cos) = heading.sin_cos();
        [(1.0 + before * omega * omega) / mass, -before * u * omega / inertia, omega, u * cos, u * sin]
    };
    let exact = dormand_prince(law, [0.2, 0.8, 0.0, 0.0, 0.0], 0.1, 21, 1e-12);
    for (simulation, allowed) in WAYS {
        for formulation in [Formulation::Absolute, Formulation::Joint] {
            let found = nominal(&formulated(read(&text.replace("step: 1e-3", simulation)), formulation));
            for (name, index) in [("x", 3), ("y", 4), ("omega", 1)] {
                let wanted: Vec<f64> = exact.iter().map(|row| row[index]).collect();
                let off = distance(curve(&found, name), &wanted);
                assert!(off < allowed, "{simulation} {formulation:?} {name}: {off:e}");
            }
        }
    }
}

#[test]
fn certified_bounds_refuse_rolling_with_a_reason() {
    let description = read(
        "
parameters: { r: { value: 0.1 m, tolerance: 1% } }
bodies: { ball: { mass: 2, inertia: 0.008 } }
joints: { roll: { rolling_on_plane: { between: [ground, ball], radius: r } } }
initial: { ball.x: 0, ball.y: 0.2, ball.vx: 0.3, ball.vy: 0.5, ball.orientation: { rpy: [0, 0, 0] }, ball.omega.z: 0 }
outputs: { x: ball.x }
simulation: { duration: 0.1, step: 1e-3 }
",
    );
    let (bounds, summary) = description.finished(Some(vec![Method::Certified]));
    let wanted = "not supported with --certify: constraints of velocities, as of joint roll";
    assert_eq!(summary.failure.as_deref(), Some(wanted));
    assert!(band(output(&bounds, "x"), Method::Certified).upper.iter().all(|value| value.is_nan()));
}
