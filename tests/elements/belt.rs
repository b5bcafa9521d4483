//! Belts: the ratio, and tensions by the torque carried.

use crate::common::power::{APART, assert_balance, pair};
use crate::common::{curve, nominal, read, row};

/// A pulley turned at a constant speed drives another against a brake, until nothing changes any more: its speed and
/// the tensions of the strand that pulls against the first pulley and of the other.
fn driven(run: &str) -> [f64; 3] {
    let description = read(&format!(
        "
bodies:
  first: {{ inertia: 0.01, coordinates: [angle] }}
  second: {{ inertia: 0.02, coordinates: [angle] }}
joints: {{ drive: {{ equation: first.angle = 10*t }} }}
effects:
  belt: {{ belt: {{ between: [first, second], first_radius: 0.1, second_radius: 0.25, run: {run}, stiffness: 2e4, damping: 50, preload: 80 }} }}
  brake: {{ torque: {{ on: second, value: -2*second.angular_velocity }} }}
initial: {{ second.angle: 0, second.angular_velocity: 0 }}
outputs: {{ speed: second.angular_velocity, first: belt.first_tension, second: belt.second_tension }}
simulation: {{ duration: 3, step: 1e-3, output_step: 0.1 }}
"
    ));
    let bounds = nominal(&description);
    let last = row(&bounds, 3.0);
    ["speed", "first", "second"].map(|name| curve(&bounds, name)[last])
}

/// ω₂ = σ (r₁/r₂) ω₁, T₁ − T₂ = M/r₂, T₁ + T₂ = 2 F₀.
#[test]
fn speeds_follow_the_radii_and_tensions_carry_the_torque() {
    for (run, side) in [("open", 1.0), ("crossed", -1.0)] {
        let [speed, first, second] = driven(run);
        let wanted = side * 10.0 * 0.1 / 0.25;
        assert!((speed - wanted).abs() < 1e-6 * wanted.abs(), "{run}: {speed}, not {wanted}");
        assert!((first + second - 160.0).abs() < 1e-6, "{run}: {first} + {second}");
        let carried = 2.0 * wanted.abs() / 0.25;
        assert!((first - second - carried).abs() < 1e-4, "{run}: {first} - {second} is not {carried}");
    }
}

/// More torque than the preload bears: the other strand is slack, and the first carries all of it.
#[test]
fn a_slack_strand_pulls_nothing() {
    let description = read(
        "
bodies: { wheel: { inertia: 0.01, coordinates: [angle] }, pulley: { inertia: 0.01, coordinates: [angle] } }
joints: { hold: { equation: pulley.angle = 0 } }
effects:
  belt: { belt: { between: [wheel, pulley], first_radius: 0.1, second_radius: 0.1, stiffness: 1e4, damping: 60, preload: 20 } }
  load: { torque: { on: wheel, value: 10 } }
initial: { wheel.angle: 0, wheel.angular_velocity: 0 }
outputs: { angle: wheel.angle, first: belt.first_tension, second: belt.second_tension }
simulation: { duration: 2, step: 1e-3, output_step: 0.1 }
",
    );
    let bounds = nominal(&description);
    let last = row(&bounds, 2.0);
    let [angle, first, second] = ["angle", "first", "second"].map(|name| curve(&bounds, name)[last]);
    assert!((first - 100.0).abs() < 1e-4 && second == 0.0, "{first} {second}");
    // T = F₀ + k r θ
    assert!((angle - (100.0 - 20.0) / (1e4 * 0.1)).abs() < 1e-7, "{angle}");
}

/// Centres that part stretch both strands by L(d) − L(distance), and these pull them together by 2 T d/L.
#[test]
fn growing_centre_distance_tightens_the_belt() {
    let description = read(
        "
bodies:
  first: { mass: 1, inertia: 0.01 }
  second: { mass: 1, inertia: 0.02, coordinates: [angle], held: { x: 0.51 } }
joints: { pin: { fixed: [ground, first] } }
effects:
  belt:
    belt:
      { between: [first, second], first_radius: 0.1, second_radius: 0.2, stiffness: 1e4, preload: 50, centers: [first, second], distance: 0.5 }
initial: { second.angle: 0, second.angular_velocity: 0 }
outputs: { first: belt.first_tension, second: belt.second_tension, reaction: pin.force }
simulation: { duration: 0.1, step: 1e-3 }
",
    );
    let bounds = nominal(&description);
    let strand = |distance: f64| (distance * distance - 0.01_f64).sqrt();
    let tension = 50.0 + 1e4 * (strand(0.51) - strand(0.5));
    for name in ["first", "second"] {
        let found = curve(&bounds, name)[0];
        assert!((found - tension).abs() < 1e-6, "{name}: {found}, not {tension}");
    }
    let (found, pull) = (curve(&bounds, "reaction")[0], 2.0 * tension * 0.51 / strand(0.51));
    assert!((found - pull).abs() < 1e-4, "{found}, not {pull}");
}

/// Damping takes c (ẋ₁² + ẋ₂²) from the energy of pulleys and strands, of which both stay taut.
#[test]
fn only_damping_dissipates_energy() {
    let rates = |run: &str, [first, second]: [f64; 2], parting: &str| {
        let sign = if run == "open" { -1.0 } else { 1.0 };
        let shift = format!("({first}*a.angular_velocity + {}*b.angular_velocity)", sign * second);
        format!("(({parting}) + {shift})^2 + (({parting}) - {shift})^2")
    };
    for run in ["open", "crossed"] {
        let belt = format!(
            "  belt: {{ belt: {{ between: [a, b], run: {run}, first_radius: 0.3, second_radius: 0.5, stiffness: 20, damping: 0.5, preload: 40 }} }}"
        );
        assert_balance(&pair("", &belt, APART), &format!("-0.5*({})", rates(run, [0.3, 0.5], "0")));
    }
    let belt = "  belt:
    belt:
      { between: [a, b], first_radius: 0.15, second_radius: 0.25, stiffness: 1, damping: 0.3, preload: 1.5, centers: [a.P, b.P], distance: 1.7 }";
    // dL/dt, L² = d² − (r₁ − r₂)²
    let along = |axis: &str| format!("(b.P.{axis} - a.P.{axis})*(b.P.v{axis} - a.P.v{axis})");
    let square = "((b.P.x - a.P.x)^2 + (b.P.y - a.P.y)^2 - 0.01)";
    let parting = format!("({} + {})/sqrt({square})", along("x"), along("y"));
    assert_balance(&pair("", belt, APART), &format!("-0.3*({})", rates("open", [0.15, 0.25], &parting)));
}
