//! Gas springs against scipy, the law of the gas, small oscillations, and the conserved energy.

use mbint::results::Method;

use crate::common::{band, curve, distance, largest, nominal, output, read, row, run};

fn lid(simulation: &str) -> String {
    format!(
        "
bodies: {{ lid: {{ mass: 4, inertia: 0.14, center_of_mass: [0.3, 0], points: {{ eye: [0.25, 0] }} }}, ground: {{ points: {{ foot: [0.05, -0.25] }} }} }}
joints: {{ hinge: {{ revolute: [ground, lid] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  strut: {{ gas_spring: {{ between: [ground.foot, lid.eye], diameter: 20 mm, length: 0.3, pressure: 5 bar, volume: 60 cm^3, exponent: 1.3 }} }}
initial: {{ hinge.angle: 0, hinge.angular_velocity: 0 }}
outputs: {{ a: hinge.angle, w: hinge.angular_velocity, energy: kinetic_energy + potential_energy, p: strut.pressure, length: strut.length, force: strut.force }}
simulation: {{ duration: 1, output_step: 0.1, {simulation} }}
"
    )
}

/// SciPy 1.17, `solve_ivp`, DOP853, rtol 1e-12: angle and rate of a lid with 0.5 kg m² about its hinge.
#[test]
fn motion_of_a_lid_matches_scipy() {
    let wanted = [(0.2, [0.28209002, 2.23507505]), (0.5, [0.81744143, 0.96517115]), (1.0, [0.52246937, -2.06288989])];
    for (simulation, allowed) in [("step: 2e-4", 1e-5), ("scheme: explicit, tolerance: 1e-9", 1e-6)] {
        let bounds = nominal(&read(&lid(simulation)));
        for (time, values) in wanted {
            for (name, value) in ["a", "w"].into_iter().zip(values) {
                let found = curve(&bounds, name)[row(&bounds, time)];
                assert!((found - value).abs() < allowed, "{simulation}: {name} at {time}: {found}, not {value}");
            }
        }
        let energy = curve(&bounds, "energy");
        assert!(largest(energy.iter().map(|e| e - energy[0])) < allowed, "{simulation}");
    }
}

/// p Vⁿ stays, also with the temperature.
#[test]
fn pressure_follows_the_law_of_the_gas() {
    for (exponent, n) in [("exponent: 1.3", 1.3), ("ambient: 101325", 1.0)] {
        let text = lid("step: 1e-3").replace("exponent: 1.3", exponent);
        let bounds = nominal(&read(&text));
        let area = std::f64::consts::FRAC_PI_4 * 0.02 * 0.02;
        let pressure = |length: f64| 5e5 * (6e-5 / (6e-5 + area * (length - 0.3))).powf(n);
        let expected: Vec<f64> = curve(&bounds, "length").iter().map(|&length| pressure(length)).collect();
        assert!(distance(curve(&bounds, "p"), &expected) < 1e-4);
        let push: Vec<f64> = expected.iter().map(|p| (p - 101_325.0) * area).collect();
        assert!(distance(curve(&bounds, "force"), &push) < 1e-7);
        let energy = curve(&bounds, "energy");
        assert!(largest(energy.iter().map(|e| e - energy[0])) < 1e-4, "n = {n}");
    }
}

/// About its balance a mass oscillates with ω² = n p A²/(V m), so that its bounds are those of n.
#[test]
fn frequency_of_small_oscillations_gives_the_exponent() {
    let text = "
parameters: { n: { interval: [1.2, 1.4] } }
bodies: { piston: { mass: 2, coordinates: [y] } }
effects:
  weight: { force: { on: piston, value: [0, -50] } }
  gas: { gas_spring: { between: [ground, piston], diameter: 100 mm, length: 0.5, pressure: p, volume: 4 L, exponent: n, ambient: 1 bar } }
initial: { piston.y: 0.5, piston.vy: 1e-3 }
outputs: { v: piston.vy }
simulation: { duration: 0.3, step: 2e-4, output_step: 0.01 }
";
    let area = std::f64::consts::FRAC_PI_4 * 0.01;
    let pressure = 1e5 + 50.0 / area;
    let bounds = run(&read(&text.replace("pressure: p", &format!("pressure: {pressure:.17e}"))));
    let band = band(output(&bounds, "v"), Method::Chebyshev);
    let speed = |n: f64, t: f64| 1e-3 * ((n * pressure * area * area / (4e-3 * 2.0)).sqrt() * t).cos();
    let last = row(&bounds, 0.1);
    let ends = [speed(1.2, 0.1), speed(1.4, 0.1)];
    let off = largest([band.lower[last] - ends[0].min(ends[1]), band.upper[last] - ends[0].max(ends[1])]);
    assert!(off < 2e-6, "{off:e}");
}

/// In an image it pushes to the other side.
#[test]
fn mirrored_instance_moves_symmetrically() {
    let text = "
assemblies:
  lid:
    bodies: { lid: { mass: 4, inertia: 0.14, points: { eye: [0.25, 0.02] } }, ground: { points: { foot: [0.05, -0.25] } } }
    joints: { hinge: { revolute: [ground, lid] } }
    effects: { strut: { gas_spring: { between: [ground.foot, lid.eye], diameter: 20 mm, length: 0.3, pressure: 5 bar, volume: 60 cm^3 } } }
    initial: { hinge.angle: 0.2, hinge.angular_velocity: 0 }
instances: { one: { of: lid }, two: { of: lid, mirror: y } }
outputs: { angle: one.hinge.angle, image: two.hinge.angle }
simulation: { duration: 0.3, step: 1e-3, output_step: 0.02 }
";
    let bounds = nominal(&read(text));
    let [angle, image] = ["angle", "image"].map(|name| curve(&bounds, name));
    assert!(largest(angle.iter().zip(image).map(|(one, two)| one + two)) < 1e-10);
    assert!(largest(angle.iter().map(|angle| angle - 0.2)) > 0.05, "it moves");
}

/// Bodies whose coordinates start at zero in general position: there the gas has no volume, and a logarithm no value.
/// Accelerations are those of the force at the start.
#[test]
fn start_with_undefined_forces_nearby_is_accepted() {
    let area = std::f64::consts::FRAC_PI_4 * 0.015_f64.powi(2);
    let wanted = [(30e5 - 101_325.0) * area / 25.0, -7.0 * 0.4_f64.ln() / 25.0];
    let springs = [
        "gas_spring: { between: [ground, b], diameter: 15 mm, length: 0.4, pressure: 30 bar, volume: 0.03 L, exponent: 1.25 }",
        "force: { on: b, value: [0, -7 N*log(b.y/(1 m))] }",
    ];
    for (spring, wanted) in springs.into_iter().zip(wanted) {
        let bounds = nominal(&read(&format!(
            "
bodies: {{ b: {{ mass: 25, coordinates: [y] }} }}
effects: {{ s: {{ {spring} }} }}
initial: {{ b.y: 0.4, b.vy: 0 }}
outputs: {{ v: b.vy }}
simulation: {{ duration: 1e-3, step: 1e-4 }}
"
        )));
        // Within a millisecond the force is nearly constant.
        let rate = curve(&bounds, "v").last().unwrap() / 1e-3;
        assert!((rate / wanted - 1.0).abs() < 1e-3, "{rate}, not {wanted}");
    }
}
