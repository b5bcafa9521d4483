//! Small mechanisms whose motion has a closed form.
//!
//! Where the acceleration is constant the scheme is exact: it integrates quadratics. Elsewhere the error is of second
//! order, so that runs at h and h/2, extrapolated to h = 0, must meet the closed form far more closely than either.

use mbint::model::{Description, Formulation};
use mbint::results::Bounds;

use super::common::{Vary, curve, distance_from, largest, model, nominal, order, read, richardson};

/// Rounding over a thousand steps, with numbers of size 1 to 100.
const ROUNDING: f64 = 1e-10;

/// What rounding of positions (1e-16 m) makes of reactions: it is divided by βh² = 3e-5 s² and multiplied by masses, and
/// its traces in the algorithmic accelerations fade slowly.
const ROUNDING_OF_FORCES: f64 = 1e-8;

/// Asserts that an output has this closed form: exactly up to rounding.
#[track_caller]
fn assert_exact(bounds: &Bounds, name: &str, exact: impl Fn(f64) -> f64) {
    let error = distance_from(&bounds.times, curve(bounds, name), exact);
    assert!(error < ROUNDING, "{name} is off by {error:e}");
}

/// The same for reactions.
#[track_caller]
fn assert_exact_force(bounds: &Bounds, name: &str, exact: impl Fn(f64) -> f64) {
    let error = distance_from(&bounds.times, curve(bounds, name), exact);
    assert!(error < ROUNDING_OF_FORCES, "{name} is off by {error:e}");
}

/// Asserts second order, and that the extrapolation at step h has errors below `limit`.
#[track_caller]
fn assert_converges(description: &Description, h: f64, name: &str, limit: f64, exact: impl Fn(f64) -> f64) {
    let [coarse, fine] = [h, 0.5 * h].map(|h| nominal(&description.clone().step(h)));
    let errors = [&coarse, &fine].map(|run| distance_from(&run.times, curve(run, name), &exact));
    let extrapolated = richardson(curve(&coarse, name), curve(&fine, name));
    let left = distance_from(&fine.times, &extrapolated, &exact);
    let order = order(errors[0], errors[1]);
    println!("{name}: errors {errors:?}, order {order:.3}, extrapolated {left:.3e}");
    assert!((order - 2.0).abs() < 0.1, "{name} converges with order {order}: {errors:?}");
    assert!(left < limit, "{name}: {left:e} is left after extrapolation");
}

#[test]
fn free_fall_and_projectile_are_exact() {
    let bounds = nominal(&read(
        "
bodies: { ball: { mass: 0.3, inertia: 0.01, points: { seam: [0.1, 0] } } }
effects: { weight: { gravity: { acceleration: [0, -9.81] } } }
initial: { ball.x: 1, ball.y: 2, ball.angle: 0, ball.vx: 3, ball.vy: 4, ball.angular_velocity: 5 }
outputs: { x: ball.x, y: ball.y, vy: ball.vy, ay: ball.ay, seam: ball.seam.x, energy: energy }
simulation: { duration: 2, step: 0.01, output_step: 0.1 }
",
    ));
    assert_exact(&bounds, "x", |t| 1.0 + 3.0 * t);
    assert_exact(&bounds, "y", |t| 2.0 + 4.0 * t - 0.5 * 9.81 * t * t);
    assert_exact(&bounds, "vy", |t| 4.0 - 9.81 * t);
    assert_exact(&bounds, "ay", |_| -9.81);
    assert_exact(&bounds, "seam", |t| 1.0 + 3.0 * t + 0.1 * (5.0 * t).cos());
    assert_exact(&bounds, "energy", |_| 0.5 * 0.3 * 25.0 + 0.5 * 0.01 * 25.0 + 0.3 * 9.81 * 2.0);
}

#[test]
fn a_body_slides_down_an_incline() {
    // x = ½ g sin β t² along the slope; the slope carries m g cos β.
    let bounds = nominal(&read(
        "
parameters: { slope: 30 deg, g: 9.81 }
bodies: { box: { mass: 4, inertia: 0.2 } }
joints:
  slide: { prismatic: { between: [ground, box], axis: [cos(slope), -sin(slope)] } }
effects: { weight: { gravity: { acceleration: [0, -g] } } }
initial: { box.x: 0, box.vx: 0 }
outputs:
  along: box.x*cos(slope) - box.y*sin(slope)
  off: box.x*sin(slope) + box.y*cos(slope)
  angle: box.angle
  up: slide.force.y
  across: slide.force.x
  torque: slide.torque
simulation: { duration: 1, step: 0.01, output_step: 0.1 }
",
    ));
    let beta = 30.0_f64.to_radians();
    let normal = 4.0 * 9.81 * beta.cos();
    assert_exact(&bounds, "along", |t| 0.5 * 9.81 * beta.sin() * t * t);
    assert_exact(&bounds, "off", |_| 0.0);
    assert_exact(&bounds, "angle", |_| 0.0);
    assert_exact_force(&bounds, "up", |_| normal * beta.cos());
    assert_exact_force(&bounds, "across", |_| normal * beta.sin());
    assert_exact_force(&bounds, "torque", |_| 0.0);
}

#[test]
fn a_gear_pair_shares_the_torque() {
    // With θ₂ = −2 θ₁ both wheels weigh on the first shaft: (I₁ + 4 I₂) θ̈₁ = τ.
    let bounds = nominal(&read(
        "
bodies:
  pinion: { inertia: 0.02, coordinates: [angle] }
  wheel: { inertia: 0.005, coordinates: [angle] }
joints: { mesh: { gear: { between: [pinion, wheel], ratio: -2 } } }
effects: { motor: { torque: { on: pinion, value: 0.6 } } }
initial: { pinion.angle: 0, pinion.angular_velocity: 1 }
outputs: { pinion: pinion.angle, wheel: wheel.angle, speed: wheel.angular_velocity, torque: mesh.torque }
simulation: { duration: 1, step: 0.01, output_step: 0.1 }
",
    ));
    let acceleration = 0.6 / (0.02 + 4.0 * 0.005);
    let angle = |t: f64| t + 0.5 * acceleration * t * t;
    assert_exact(&bounds, "pinion", angle);
    assert_exact(&bounds, "wheel", |t| -2.0 * angle(t));
    assert_exact(&bounds, "speed", |t| -2.0 * (1.0 + acceleration * t));
    // The mesh turns the wheel backwards.
    assert_exact_force(&bounds, "torque", |_| -2.0 * 0.005 * acceleration);
}

#[test]
fn a_mass_on_a_spring_and_damper_oscillates() {
    let (m, c, k, x0) = (0.5, 0.8, 50.0, 0.2);
    let description = read(
        "
bodies: { mass: { mass: 0.5, coordinates: [x] } }
effects:
  mount: { spring_damper: { between: [ground, mass], along: x, stiffness: 50, damping: 0.8, free_length: 1 } }
initial: { mass.x: 1.2, mass.vx: 0 }
outputs: { stretch: mass.x - 1, speed: mass.vx }
simulation: { duration: 2, step: 1e-3, output_step: 0.01 }
",
    );
    let decay: f64 = c / (2.0 * m);
    let omega = (k / m - decay * decay).sqrt();
    let stretch = |t: f64| x0 * (-decay * t).exp() * ((omega * t).cos() + decay / omega * (omega * t).sin());
    let speed = |t: f64| -x0 * (-decay * t).exp() * (omega + decay * decay / omega) * (omega * t).sin();
    // What is left is of fourth order (third in velocities, whose start is of third): (ω h)⁴ of the amplitude, times ω t.
    assert_converges(&description, 1e-3, "stretch", 1e-8, stretch);
    assert_converges(&description, 1e-3, "speed", 1e-7, speed);
}

#[test]
fn a_torsional_pendulum_twists() {
    let description = read(
        "
bodies:
  disk: { inertia: 0.04, coordinates: [angle] }
effects:
  wire: { torsional_spring_damper: { between: [ground, disk], stiffness: 1, free_angle: 0.5 } }
initial: { disk.angle: 2, disk.angular_velocity: 0 }
outputs: { angle: disk.angle, energy: energy }
simulation: { duration: 4, step: 1e-3, output_step: 0.02 }
",
    );
    let omega = (1.0_f64 / 0.04).sqrt();
    assert_converges(&description, 1e-3, "angle", 1e-7, |t| 0.5 + 1.5 * (omega * t).cos());
    assert_converges(&description, 1e-3, "energy", 1e-7, |_| 0.5 * 1.5 * 1.5);
}

/// Times at which a curve passes zero: cubic Hermite interpolation with its slopes, Newton's method.
fn zeros(times: &[f64], values: &[f64], slopes: &[f64]) -> Vec<f64> {
    let mut found = Vec::new();
    for row in 1..times.len() {
        let (a, b) = (values[row - 1], values[row]);
        if a * b >= 0.0 {
            continue;
        }
        let h = times[row] - times[row - 1];
        let (da, db) = (h * slopes[row - 1], h * slopes[row]);
        let (square, cube) = (3.0 * (b - a) - 2.0 * da - db, 2.0 * (a - b) + da + db);
        let mut s = a / (a - b);
        for _ in 0..20 {
            s -= (a + s * (da + s * (square + s * cube))) / (da + s * (2.0 * square + 3.0 * s * cube));
        }
        found.push(times[row - 1] + s * h);
    }
    found
}

#[test]
fn the_pendulum_has_its_period() {
    // From the horizontal: T = 4 K(sin 45°) √(L/g), 17 digits by the arithmetic-geometric mean.
    const PERIOD: f64 = 2.3678419475762374;
    let period = |h: f64| {
        let bounds = nominal(&model("pendulum").observing(&["bob.x", "bob.vx"]).step(h).rows_every(0.01));
        let zeros = zeros(&bounds.times, curve(&bounds, "bob.x"), curve(&bounds, "bob.vx"));
        // Zeros at T/4 + n T/2: the last but one that passes in the same direction as the first.
        let count = (zeros.len() - 1) / 2;
        (zeros[2 * count] - zeros[0]) / count as f64
    };
    let periods = [1e-3, 5e-4].map(period);
    let errors = periods.map(|period| (period - PERIOD).abs());
    let extrapolated = ((4.0 * periods[1] - periods[0]) / 3.0 - PERIOD).abs();
    println!("errors {errors:?}, extrapolated {extrapolated:.3e}");
    let order = order(errors[0], errors[1]);
    assert!((order - 2.0).abs() < 0.1, "order {order}: {errors:?}");
    // The interpolation between rows 0.01 s apart has errors of about 1e-8 (h⁴/384 · x⁗, x⁗ ≈ 1e3 at the bottom).
    assert!(extrapolated < 1e-7, "{extrapolated:e}");
}

/// t, x, y: `iftomm/pendulum.csv` (Jacobi's elliptic functions, 40 digits).
pub const PENDULUM: [(f64, f64, f64); 5] = [
    (0.5, -0.391048791550546, -0.920369948785192),
    (1.0, 0.986291751131875, -0.165010853125541),
    (2.5, -0.996334403958282, -0.0855438804888806),
    (5.0, -0.942305435043757, -0.334754338414001),
    (10.0, -0.275087462576117, -0.961419205099125),
];

#[test]
fn the_pendulum_swings_as_elliptic_functions_do() {
    let rows = super::common::reference("iftomm/pendulum.csv")
        .map_or(PENDULUM.to_vec(), |rows| rows.iter().map(|row| (row[0], row[1], row[2])).collect());
    let description = model("pendulum").observing(&["bob.x", "bob.y", "rod.force + 3*9.81*bob.y"]).rows_every(0.01);
    let runs = [1e-3, 5e-4].map(|h| nominal(&description.clone().step(h)));
    let error = |x: &[f64], y: &[f64]| {
        largest(rows.iter().flat_map(|&(t, exact_x, exact_y)| {
            let row = super::common::row(&runs[0], t);
            [x[row] - exact_x, y[row] - exact_y]
        }))
    };
    let errors = runs.each_ref().map(|run| error(curve(run, "bob.x"), curve(run, "bob.y")));
    let limits = ["bob.x", "bob.y"].map(|name| richardson(curve(&runs[0], name), curve(&runs[1], name)));
    let left = error(&limits[0], &limits[1]);
    println!("errors {errors:?}, extrapolated {left:.3e}");
    assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1, "{errors:?}");
    // Without its h² term the error is of third order.
    assert!(left < 1e-2 * errors[1], "{left:e}");
    // The rod's tension is 3 m g |y|/L: energy and the centripetal acceleration.
    // (From 0.1 s on: at first it is zero, where its magnitude has a kink.)
    let tensions = runs.each_ref().map(|run| largest(run.outputs[2].nominal[10..].iter().copied()));
    println!("tension {tensions:?}");
    assert!((order(tensions[0], tensions[1]) - 2.0).abs() < 0.1, "{tensions:?}");
}

#[test]
fn a_rod_at_rest_hangs_by_its_weight() {
    // The reaction is on the second body.
    let hanging = |between: &str| {
        nominal(&read(&format!(
            "
bodies:
  ground: {{ points: {{ O: [0, 0] }} }}
  rod: {{ mass: 2, inertia: 0.1, points: {{ top: [0, 0.4] }} }}
joints: {{ hinge: {{ revolute: {between} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -9.81] }} }} }}
initial: {{ rod.angle: 0, rod.angular_velocity: 0 }}
outputs: {{ up: hinge.force.y, side: hinge.force.x, size: hinge.force }}
simulation: {{ duration: 0.1, step: 1e-3, output_step: 0.01 }}
"
        )))
    };
    let bounds = hanging("[ground.O, rod.top]");
    assert_exact_force(&bounds, "up", |_| 2.0 * 9.81);
    assert_exact_force(&bounds, "side", |_| 0.0);
    assert_exact_force(&bounds, "size", |_| 2.0 * 9.81);
    assert_exact_force(&hanging("[rod.top, ground.O]"), "up", |_| -2.0 * 9.81);
}

#[test]
fn a_spinning_rod_pulls_at_its_hinge() {
    // Uniform rotation: the hinge pulls the centre inwards with m ω² l/2; free of other forces, the speed stays.
    let description = read(
        "
bodies: { rod: { mass: 2, inertia: 0.1, points: { hinge: [-0.4, 0] } } }
joints: { hinge: { revolute: [ground, rod.hinge] } }
initial: { rod.angle: 0, rod.angular_velocity: 6 }
outputs: { angle: rod.angle, x: hinge.force.x, y: hinge.force.y }
simulation: { duration: 2, step: 1e-3, output_step: 0.01, formulation: absolute }
",
    );
    let pull = 2.0 * 36.0 * 0.4;
    assert_converges(&description, 1e-3, "angle", 1e-7, |t| 6.0 * t);
    // The reactions' errors of the first steps (see `convergence`) have faded after 0.1 s.
    let after = |bounds: &Bounds, name: &str, exact: &dyn Fn(f64) -> f64| {
        let first = super::common::row(bounds, 0.1);
        distance_from(&bounds.times[first..], &curve(bounds, name)[first..], exact)
    };
    let runs = [1e-3, 5e-4].map(|h| nominal(&description.clone().step(h)));
    let x = |t: f64| -pull * (6.0 * t).cos();
    let y = |t: f64| -pull * (6.0 * t).sin();
    for (name, exact) in [("x", &x as &dyn Fn(f64) -> f64), ("y", &y)] {
        let errors = runs.each_ref().map(|run| after(run, name, exact));
        println!("{name}: {errors:?}");
        assert!((order(errors[0], errors[1]) - 2.0).abs() < 0.1, "{name}: {errors:?}");
        assert!(errors[0] < 1e-4 * pull, "{name}: {errors:?}");
    }
    // The hinge's own angle grows evenly: nothing is left to be approximated.
    let mut own = description;
    own.simulation.formulation = Formulation::Joint;
    let run = nominal(&own);
    for (name, exact) in [("x", &x as &dyn Fn(f64) -> f64), ("y", &y)] {
        assert!(distance_from(&run.times, curve(&run, name), exact) < 1e-9 * pull, "{name} in joint coordinates");
    }
}
