//! Tyres: their characteristics with published coefficients, a single-track car against its linear solution and scipy,
//! and images.

use mbint::results::Method;

use crate::common::{band, curve, distance, largest, nominal, output, read, row, run};

/// A cart that is too heavy to be steered turns while it moves along x: the slip angle is −angle.
fn characteristic(tyre: &str, space: &str) -> mbint::results::Bounds {
    let (inertia, spin, start) = match space {
        "planar" => ("1e9", "angular_velocity", ", cart.angle: -0.3"),
        _ => ("[1e9, 1e9, 1e9]", "omega.z", ", cart.orientation: { axis: [0, 0, 1], angle: -0.3 }"),
    };
    nominal(&read(&format!(
        "
space: {space}
bodies: {{ cart: {{ mass: 1e9, inertia: {inertia} }} }}
effects: {{ wheel: {{ tyre: {{ on: cart, rest_speed: 1e-6, {tyre} }} }} }}
initial: {{ cart.x: 0, cart.y: 0, cart.vx: 20{start}, cart.{spin}: 0.6 }}
outputs: {{ slip: wheel.slip_angle, force: wheel.force }}
simulation: {{ duration: 1, step: 1e-2, output_step: 0.02 }}
"
    )))
}

/// Published values of a radial tyre under 4 kN (Bakker, Nyborg & Pacejka 1987, table 1): D = a₁ F² + a₂ F, BCD = a₃
/// sin(a₄ atan(a₅ F)), E = a₆ F² + a₇ F + a₈, in kN, N and degrees; a = −22.1, 1011, 1078, 1.82, 0.208, 0, −0.354,
/// 0.707, C = 1.3.
#[test]
fn the_magic_formula_has_its_published_values() {
    let load = 4.0_f64;
    let peak = -22.1 * load * load + 1011.0 * load;
    let slope = 1078.0 * (1.82 * (0.208 * load).atan()).sin();
    let curvature = -0.354 * load + 0.707;
    let published = |degrees: f64| {
        let b = slope / (1.3 * peak);
        let phi = (1.0 - curvature) * degrees + curvature / b * (b * degrees).atan();
        peak * (1.3 * (b * phi).atan()).sin()
    };
    for space in ["planar", "spatial"] {
        let tyre = format!(
            "load: 4 kN, friction: {}, cornering_stiffness: {}, shape: 1.3, curvature: {curvature}",
            peak / 4e3,
            slope * 180.0 / std::f64::consts::PI
        );
        let bounds = characteristic(&tyre, space);
        let slips = curve(&bounds, "slip");
        let expected: Vec<f64> = slips.iter().map(|slip| -published(slip.to_degrees())).collect();
        assert!(distance(curve(&bounds, "force"), &expected) < 1e-6 * peak, "{space}");
        let angles: Vec<f64> = bounds.times.iter().map(|t| 0.3 - 0.6 * t).collect();
        assert!(distance(slips, &angles) < 1e-6, "{space}");
        let most = largest(curve(&bounds, "force").iter().copied());
        assert!((most / peak - 1.0).abs() < 1e-3, "{most} of {peak}");
    }
}

/// Linear up to the largest force, with the steering angle on top.
#[test]
fn force_without_shape_is_linear_up_to_its_limit() {
    let bounds = characteristic("load: 4 kN, friction: 0.9, cornering_stiffness: 3e4, steer: 0.1", "planar");
    for (t, slip) in bounds.times.iter().zip(curve(&bounds, "slip")) {
        assert!((slip - (0.2 - 0.6 * t)).abs() < 1e-6);
    }
    for (slip, force) in curve(&bounds, "slip").iter().zip(curve(&bounds, "force")) {
        let expected = -(3e4 * slip).clamp(-3600.0, 3600.0);
        // The corner of the limit is round: 1 % of it.
        assert!((force - expected).abs() < 0.006 * 3600.0, "{slip}: {force}, not {expected}");
        assert!(slip.abs() > 0.06 || (force - expected).abs() < 2e-4 * 3600.0);
    }
}

fn car(tyres: &str, steer: &str, simulation: &str) -> String {
    format!(
        "
parameters: {{ C: {{ value: 80, unit: kN/rad, tolerance: 5% }} }}
bodies: {{ car: {{ mass: 1500, inertia: 2500, points: {{ front: [1.2, 0], rear: [-1.5, 0] }} }} }}
effects:
  front: {{ tyre: {{ on: car.front, steer: {steer}, load: 1500 kg*9.81 m/s^2*1.5/2.7, friction: 0.9, cornering_stiffness: C, {tyres} }} }}
  rear: {{ tyre: {{ on: car.rear, load: 1500 kg*9.81 m/s^2*1.2/2.7, friction: 0.9, cornering_stiffness: 9e4, {tyres} }} }}
initial: {{ car.x: 0, car.y: 0, car.angle: 0, car.vx: 25, car.vy: 0, car.angular_velocity: 0 }}
outputs: {{ x: car.x, y: car.y, angle: car.angle, vx: car.vx, vy: car.vy, w: car.angular_velocity }}
simulation: {{ output_step: 0.1, {simulation} }}
"
    )
}

/// SciPy 1.17, `solve_ivp`, DOP853, rtol 1e-12: a slalom beyond the grip of the front tyres.
#[test]
fn slalom_matches_scipy() {
    let wanted = [
        (0.5, [12.4816355, 0.272216401, 0.0952417688, 24.8393474, 1.68746827, 0.413237609]),
        (1.0, [24.6646758, 2.07796099, 0.336308001, 23.6990724, 5.62114391, 0.501712975]),
        (2.0, [46.188923, 11.4432092, 0.795682995, 19.0063541, 12.7328613, 0.333927636]),
        (4.0, [82.9594307, 35.8804418, 0.609883838, 18.4645454, 11.1944913, 0.612446185]),
    ];
    for (simulation, allowed) in
        [("duration: 4, step: 5e-4", 1e-4), ("duration: 4, scheme: explicit, tolerance: 1e-8", 1e-6)]
    {
        let bounds = nominal(&read(&car("shape: 1.3, curvature: -0.7", "0.12*sin(2*t)", simulation)));
        for (time, values) in wanted {
            for (name, value) in ["x", "y", "angle", "vx", "vy", "w"].into_iter().zip(values) {
                let found = curve(&bounds, name)[row(&bounds, time)];
                assert!((found - value).abs() < allowed, "{simulation}: {name} at {time}: {found}, not {value}");
            }
        }
    }
}

/// Yaw rate of a single-track car that is steered little: v δ/(l + m (l_r C_r − l_f C_f)/(l C_f C_r) v²) (Rajamani,
/// *Vehicle Dynamics and Control*, 2nd ed. (2012), sec. 3.3), so that its bounds are those of the front's stiffness.
#[test]
fn a_car_understeers() {
    let bounds = run(&read(&car("rest_speed: 0.01", "1e-3", "duration: 3, step: 2e-3")));
    let band = band(output(&bounds, "w"), Method::Chebyshev);
    let last = bounds.times.len() - 1;
    let rate = |front: f64| {
        let gradient = 1500.0 * (1.5 * 9e4 - 1.2 * front) / (2.7 * front * 9e4);
        25.0 * 1e-3 / (2.7 + gradient * 625.0)
    };
    let off = largest([band.lower[last] / rate(7.6e4) - 1.0, band.upper[last] / rate(8.4e4) - 1.0]);
    // The slope of a smooth limit is short by 5e-5.
    assert!(off < 3e-4, "{off:e}");
}

/// In an image it steers the other way.
#[test]
fn mirrored_instance_moves_symmetrically() {
    for axis in ["x", "y"] {
        let text = format!(
            "
assemblies:
  car:
    bodies: {{ car: {{ mass: 1500, inertia: 2500, points: {{ front: [1.2, 0.1], rear: [-1.5, 0] }} }} }}
    effects:
      front: {{ tyre: {{ on: car.front, steer: 0.1 + 0.05*t, load: 8 kN, friction: 0.9, cornering_stiffness: 8e4 }} }}
      rear: {{ tyre: {{ on: car.rear, load: 7 kN, friction: 0.9, cornering_stiffness: 9e4, shape: 1.3 }} }}
    initial: {{ car.x: 0, car.y: 0, car.angle: 0, car.vx: 20, car.vy: 0, car.angular_velocity: 0 }}
instances: {{ one: {{ of: car }}, two: {{ of: car, mirror: {axis} }} }}
outputs: {{ x: one.car.x, y: one.car.y, a: two.car.x, b: two.car.y }}
simulation: {{ duration: 1, step: 1e-3, output_step: 0.1 }}
"
        );
        let bounds = nominal(&read(&text));
        for (name, image) in [("x", "a"), ("y", "b")] {
            let sign = if name == axis { -1.0 } else { 1.0 };
            let off = largest(curve(&bounds, name).iter().zip(curve(&bounds, image)).map(|(a, b)| a - sign * b));
            assert!(off < 1e-8, "{axis} {name}: {off:e}");
        }
        assert!(largest(curve(&bounds, "y").iter().copied()) > 0.5, "it turns");
    }
}

/// A wheel that is too heavy to be driven slips from −100 to 100 %; Bakker, Nyborg & Pacejka 1987, table 1 for braking:
/// D = a₁ F² + a₂ F, BCD = (a₃ F² + a₄ F)/exp(a₅ F), E = a₆ F² + a₇ F + a₈, in kN, N and per cent; a = −21.3, 1144,
/// 49.6, 226, 0.069, −0.006, 0.056, 0.486, C = 1.65.
#[test]
fn longitudinal_magic_formula_matches_published_values() {
    let load = 4.0_f64;
    let peak = -21.3 * load * load + 1144.0 * load;
    let slope = (49.6 * load * load + 226.0 * load) / (0.069 * load).exp();
    let curvature = -0.006 * load * load + 0.056 * load + 0.486;
    let published = |percent: f64| {
        let b = slope / (1.65 * peak);
        let phi = (1.0 - curvature) * percent + curvature / b * (b * percent).atan();
        peak * (1.65 * (b * phi).atan()).sin()
    };
    let keys = format!(
        "load: 4 kN, friction: {}, slip_stiffness: {}, shape: 1.65, curvature: {curvature}, wheel: wheel, radius: 0.3, rest_speed: 1e-6",
        peak / 4e3,
        slope * 100.0
    );
    for (space, body, start, torque) in [
        ("planar", "inertia: 1e6", "wheel.angular_velocity: 0", "-4e7/0.3"),
        ("spatial", "inertia: [1e6, 1e6, 1e6]", "wheel.omega: [0, 0, 0]", "[0, 4e7/0.3, 0]"),
    ] {
        // From a locked wheel to one that turns twice as fast as it rolls, at 20 m/s.
        let bounds = nominal(&read(&format!(
            "
space: {space}
bodies:
  cart: {{ mass: 1e9, coordinates: [x] }}
  wheel: {{ mass: 1, {body} }}
joints: {{ axle: {{ revolute: {{ between: [cart, wheel], axis: {} }} }} }}
effects:
  contact: {{ tyre: {{ on: cart, {keys} }} }}
  drive: {{ torque: {{ on: wheel, value: {torque} }} }}
initial: {{ cart.x: 0, cart.vx: 20, {start} }}
outputs: {{ slip: contact.slip, force: contact.force_along }}
simulation: {{ duration: 1, step: 1e-3, output_step: 0.02 }}
",
            if space == "planar" { "z" } else { "y" }
        )));
        let slips = curve(&bounds, "slip");
        let expected: Vec<f64> = slips.iter().map(|slip| published(100.0 * slip)).collect();
        assert!(distance(curve(&bounds, "force"), &expected) < 1e-6 * peak, "{space}");
        assert!((slips[0] + 1.0).abs() < 1e-9 && (slips[50] - 1.0).abs() < 1e-2, "{space}: {slips:?}");
    }
}

/// A car of 400 kg, seen from the side.
fn braked(joint: &str, effect: &str, start: &str) -> mbint::results::Bounds {
    nominal(&read(&format!(
        "
bodies:
  car: {{ mass: 380, coordinates: [x] }}
  wheel: {{ mass: 20, inertia: 1.5 }}
joints: {{ axle: {{ {joint}: [car, wheel] }} }}
effects:
  tyre: {{ tyre: {{ on: car, wheel: wheel, radius: 0.3, load: 400 kg*9.81 m/s^2, friction: 0.8, slip_stiffness: 1e6, rest_speed: 1e-3 }} }}
{effect}
initial: {{ car.x: 0, car.vx: 20{start} }}
outputs: {{ v: car.vx, slip: tyre.slip }}
simulation: {{ duration: 2, step: 2e-4, output_step: 0.1 }}
"
    )))
}

/// A locked wheel slows a car down by μ g; a braked one by T/R/(m + (1 + κ) J/R²), where it slips by κ = m v̇/C_x.
#[test]
fn braking_of_a_car_matches_closed_forms() {
    let locked = braked("fixed", "", "");
    let expected: Vec<f64> = locked.times.iter().map(|t| 20.0 - 0.8 * 9.81 * t).collect();
    assert!(distance(curve(&locked, "v"), &expected) < 1e-5);

    let brake = "  brake: { torque: { on: wheel, from: car, value: 300 } }";
    let rolling = braked("revolute", brake, ", wheel.angular_velocity: -20/0.3");
    let slip = |rate: f64| 400.0 * rate / 1e6;
    let rate = (0..20).fold(0.0, |rate, _| -1000.0 / (400.0 + (1.0 + slip(rate)) * 1.5 / 0.09));
    let (speeds, slips) = (curve(&rolling, "v"), curve(&rolling, "slip"));
    let found = (speeds[15] - speeds[5]) / (rolling.times[15] - rolling.times[5]);
    // The slope of a smooth limit at no slip is short by 5e-5.
    assert!((found / rate - 1.0).abs() < 1e-4, "{found}, not {rate}");
    assert!((slips[10] / slip(rate) - 1.0).abs() < 2e-4, "{}, not {}", slips[10], slip(rate));
}

/// Forces along and across lie within the ellipse of both limits, and on it where the wheel slides, with or without the
/// magic formula.
#[test]
fn forces_of_both_directions_share_the_slip() {
    for shape in ["", ", shape: 1"] {
        let bounds = nominal(&read(&format!(
            "
space: spatial
bodies:
  cart: {{ mass: 1e9, inertia: [1e9, 1e9, 1e9] }}
  wheel: {{ mass: 1, inertia: [1, 1, 1] }}
joints: {{ axle: {{ fixed: [cart, wheel] }} }}
effects:
  contact:
    tyre: {{ on: cart, wheel: wheel, radius: 0.3, load: 4 kN, friction: 0.9, friction_along: 1.1, cornering_stiffness: 6e7, slip_stiffness: 9e7, rest_speed: 1e-6{shape} }}
initial: {{ cart.x: 0, cart.y: 0, cart.z: 0, cart.vx: 20, cart.orientation: {{ axis: [0, 0, 1], angle: -0.3 }}, cart.omega.z: 0.6 }}
outputs: {{ angle: contact.slip_angle, slip: contact.slip, along: contact.force_along, aside: contact.force, fx: axle.force.x, fy: axle.force.y }}
simulation: {{ duration: 1, step: 1e-2, output_step: 0.02 }}
"
        )));
        for row in 0..bounds.times.len() {
            let value = |name: &str| curve(&bounds, name)[row];
            let (along, aside) = (value("along") / 4400.0, value("aside") / 3600.0);
            assert!((along.hypot(aside) - 1.0).abs() < 1e-4, "{along} {aside}");
            // Both by their own stiffness and slip.
            let (s_x, s_y) = (9e7 * value("slip") / 4400.0, 6e7 * value("angle") / 3600.0);
            assert!((along * s_y + aside * s_x).abs() < 1e-6 * s_x.hypot(s_y), "{along} {aside}");
        }
    }
}
