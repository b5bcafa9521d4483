//! Friction between teeth that roll: the lost power is a share of the transmitted power, whichever gear drives. (That
//! of worms is in `worm`.)

use mbint::results::Bounds;

use crate::common::{curve, nominal, read};

/// Angular speed at the start, rad/s.
const START: f64 = 3.0;
const EFFICIENCY: f64 = 0.9;

fn run(parts: &str, drive: &str, rest: &str) -> Bounds {
    nominal(&read(&format!(
        "
{parts}
effects:
  rubbing: {{ tooth_friction: {{ on: mesh, efficiency: {EFFICIENCY}, transition_velocity: 1e-6 }} }}
{drive}
initial: {{ one.angle: 0, one.angular_velocity: {START} }}
outputs: {{ speed: one.angular_velocity, lost: rubbing.loss }}
simulation: {{ duration: 0.5, step: 1e-3, output_step: 0.05{rest} }}
"
    )))
}

#[track_caller]
fn assert_speeds(bounds: &Bounds, acceleration: f64) {
    for (&t, &found) in bounds.times.iter().zip(curve(bounds, "speed")).skip(1) {
        let gained = acceleration * t;
        assert!((found - START - gained).abs() < 1e-6 * gained.abs(), "at {t}: {found} {}", START + gained);
    }
}

/// Two gears, kg m².
const INERTIA: [f64; 2] = [0.01, 0.08];
const RATIO: f64 = -0.5;
const GEARS: &str = "
bodies: { first: { inertia: 0.01, mass: 1 }, second: { inertia: 0.08, mass: 1 } }
joints: { one: { revolute: [ground, first] }, two: { revolute: [ground, second] }, mesh: { gear: { between: [one, two], ratio: -0.5 } } }";

/// The driven gear gets the share η of the other's power: T₁ = α₁ (J₁ + i² J₂/η), and i T₂ = α₁ (J₁/η + i² J₂).
#[test]
fn efficiency_holds_for_either_driving_gear() {
    let [first, second] = INERTIA;
    let bodies = GEARS.replace("between: [one, two]", "between: [first, second]");
    for (parts, formulation) in [(GEARS, "absolute"), (GEARS, "joint"), (bodies.as_str(), "absolute")] {
        let rest = format!(", formulation: {formulation}");
        let by_first = run(parts, "  drive: { torque: { on: one, value: 2 } }", &rest);
        let acceleration = 2.0 / (first + RATIO * RATIO * second / EFFICIENCY);
        assert_speeds(&by_first, acceleration);
        // The output power speeds the second gear up.
        for (&t, &lost) in by_first.times.iter().zip(curve(&by_first, "lost")).skip(1) {
            let out = RATIO * RATIO * second * acceleration * (START + acceleration * t);
            assert!((lost - out * (1.0 / EFFICIENCY - 1.0)).abs() < 1e-6 * lost, "at {t}: {lost} of {out}");
        }
        let by_second = run(parts, "  drive: { torque: { on: two, value: -4 } }", &rest);
        assert_speeds(&by_second, -4.0 * RATIO / (first / EFFICIENCY + RATIO * RATIO * second));
    }
}

/// A rack of 2 kg on a pinion of 20 mm.
#[test]
fn efficiency_holds_for_rack_and_pinion() {
    let parts = "
bodies: { pinion: { inertia: 0.001, mass: 1 }, bar: { inertia: 1, mass: 2 } }
joints:
  one: { revolute: [ground, pinion] }
  guide: { prismatic: { between: [ground, bar], axis: x } }
  mesh: { rack: { pinion: one, rack: guide, radius: 20 mm } }";
    let reduced = 0.02 * 0.02 * 2.0;
    for formulation in ["absolute", "joint"] {
        let rest = format!(", formulation: {formulation}");
        let by_pinion = run(parts, "  drive: { torque: { on: one, value: 0.05 } }", &rest);
        assert_speeds(&by_pinion, 0.05 / (0.001 + reduced / EFFICIENCY));
        let by_rack = run(parts, "  drive: { force: { on: bar, value: [3, 0] } }", &rest);
        assert_speeds(&by_rack, 3.0 * 0.02 / (0.001 / EFFICIENCY + reduced));
    }
}

/// With the ring fixed, the sun gives the carrier (1 + ρ η)/(1 + ρ) of its power, since only rolling against the
/// carrier has losses; and the carrier gives the sun (1 + ρ)/(1 + ρ/η) (Müller).
#[test]
fn planets_lose_power_only_by_rolling_on_the_carrier() {
    let parts = "
bodies: { sun: { inertia: 0.02, mass: 1 }, carrier: { inertia: 0.3, mass: 1 } }
joints: { one: { revolute: [ground, sun] }, two: { revolute: [ground, carrier] }, mesh: { planetary: { sun: one, carrier: two, ratio: 3 } } }";
    let (sun, carrier, ring, share) = (0.02, 0.3, 3.0, 0.25);
    for formulation in ["absolute", "joint"] {
        let rest = format!(", formulation: {formulation}");
        let by_sun = run(parts, "  drive: { torque: { on: one, value: 0.6 } }", &rest);
        let efficiency = (1.0 + ring * EFFICIENCY) / (1.0 + ring);
        assert_speeds(&by_sun, 0.6 / (sun + share * share * carrier / efficiency));
        let by_carrier = run(parts, "  drive: { torque: { on: two, value: 4 } }", &rest);
        let efficiency = (1.0 + ring) / (1.0 + ring / EFFICIENCY);
        assert_speeds(&by_carrier, 4.0 * share / (sun / efficiency + share * share * carrier));
    }
}

/// Stages multiply: T = α (J₁ + i² J₂/η + i⁴ J₃/η²).
#[test]
fn stages_multiply() {
    let parts = "
bodies: { first: { inertia: 0.01, mass: 1 }, second: { inertia: 0.05, mass: 1 }, third: { inertia: 0.2, mass: 1 } }
joints:
  one: { revolute: [ground, first] }
  two: { revolute: [ground, second] }
  three: { revolute: [ground, third] }
  mesh: { gear: { between: [one, two], ratio: -0.5 } }
  next: { gear: { between: [two, three], ratio: -0.5 } }";
    let next = format!(
        "  drive: {{ torque: {{ on: one, value: 2 }} }}\n  \
         rubbing_too: {{ tooth_friction: {{ on: next, efficiency: {EFFICIENCY}, transition_velocity: 1e-6 }} }}"
    );
    let bounds = run(parts, &next, "");
    let all = 0.01 + 0.25 * 0.05 / EFFICIENCY + 0.0625 * 0.2 / (EFFICIENCY * EFFICIENCY);
    assert_speeds(&bounds, 2.0 / all);
}

/// Driven to and fro, gears lose power or none, and never gain any: energy in is energy there and energy lost.
#[test]
fn no_power_comes_from_teeth() {
    let drive =
        "  drive: { torque: { on: one, value: 2*sin(30*t) } }\n  hold: { torque: { on: two, value: -20*two.angle } }";
    let bounds = nominal(&read(&format!(
        "
{GEARS}
effects:
  rubbing: {{ tooth_friction: {{ on: mesh, efficiency: 0.8, transition_velocity: 0.01 }} }}
{drive}
states:
  given: {{ rate: 2*sin(30*t)*one.angular_velocity, initial: 0 }}
initial: {{ one.angle: 0, one.angular_velocity: 1 }}
outputs: {{ energy: kinetic_energy + 10*two.angle^2 - given, loss: rubbing.loss }}
simulation: {{ duration: 1, step: 1e-4, output_step: 1e-4 }}
"
    )));
    let [energy, loss] = ["energy", "loss"].map(|name| curve(&bounds, name));
    assert!(loss.iter().all(|&loss| loss >= 0.0));
    let (mut lost, mut off) = (0.0, 0.0_f64);
    for row in 1..loss.len() {
        lost += 0.5 * (bounds.times[row] - bounds.times[row - 1]) * (loss[row] + loss[row - 1]);
        off = off.max((energy[row] + lost - energy[0]).abs());
    }
    assert!(lost > 0.05 && off < 1e-4 * lost, "{off} of {lost} J");
}
