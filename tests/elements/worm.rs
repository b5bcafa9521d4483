//! Worm gears: speeds, forces on bearings, efficiency, self-locking.

use mbint::results::Bounds;

use crate::common::closed_forms::{assert_converges, assert_exact};
use crate::common::{curve, nominal, read};

/// Axes 0.1 m apart; 2 starts on 40 teeth; kg m², N m.
const DISTANCE: f64 = 0.1;
const RATIO: f64 = 0.05;
const INERTIA: [f64; 2] = [0.002, 0.3];
const LEAD: f64 = 12.0;
const PRESSURE: f64 = 20.0;

/// The worm about x through the origin, the wheel about z next to it. Torques act on both; rad/s at the start.
fn text(lead: f64, start: f64, torques: [f64; 2], effects: &str, outputs: &str, rest: &str) -> String {
    let [worm, wheel] = INERTIA;
    let [on_worm, on_wheel] = torques;
    format!(
        "
bodies:
  ground: {{ points: {{ side: [0, {DISTANCE}, 0] }} }}
  worm: {{ mass: 1, inertia: [{worm}, 0.01, 0.01] }}
  wheel: {{ mass: 2, inertia: [0.2, 0.2, {wheel}] }}
joints:
  shaft: {{ revolute: {{ between: [ground, worm], axis: x }} }}
  axle: {{ revolute: {{ between: [ground.side, wheel], axis: z }} }}
  mesh: {{ worm: {{ worm: shaft, wheel: axle, ratio: 2/40, lead_angle: {lead} deg, pressure_angle: {PRESSURE} deg }} }}
effects:
  drive: {{ torque: {{ on: shaft, value: {on_worm} }} }}
  load: {{ torque: {{ on: axle, value: {on_wheel} }} }}
{effects}
initial: {{ shaft.angle: 0, shaft.angular_velocity: {start} }}
outputs: {{ worm: shaft.angular_velocity, wheel: axle.angular_velocity{outputs} }}
simulation: {{ duration: 0.5, step: 1e-3, output_step: 0.05{rest} }}
"
    )
}

fn run(text: &str) -> Bounds {
    nominal(&read(text))
}

/// A right-handed worm that turns about x pushes the teeth next to it along −x. The wheel's axis is at y > 0, so it
/// turns about −z.
#[test]
fn handedness_sets_the_sense_of_rotation() {
    let acceleration = 0.2 / (INERTIA[0] + RATIO * RATIO * INERTIA[1]);
    for (lead, sense) in [(LEAD, -1.0), (-LEAD, 1.0)] {
        let bounds = run(&text(lead, 0.0, [0.2, 0.0], "", "", ", formulation: joint"));
        assert_exact(&bounds, "worm", |t| acceleration * t);
        assert_exact(&bounds, "wheel", |t| sense * RATIO * acceleration * t);
        let absolute = read(&text(lead, 0.0, [0.2, 0.0], "", "", ", formulation: absolute"));
        assert_converges(&absolute, 1e-3, "wheel", 1e-5, |t| sense * RATIO * acceleration * t);
    }
}

/// F_a2 = F_t1, F_t2 = F_a1 = 2 T₂/d₂, and the force apart that of the pressure angle (Norton, ch. 13).
#[test]
fn bearing_forces_match_textbooks() {
    let outputs = ", fx: shaft.force.x, fy: shaft.force.y, fz: shaft.force.z, gx: axle.force.x, gy: axle.force.y, gz: axle.force.z";
    let load = 5.0;
    for formulation in ["absolute", "joint"] {
        // The load rests against the torque on the worm.
        let rest = format!(", formulation: {formulation}");
        let bounds = run(&text(LEAD, 0.0, [RATIO * load, load], "", outputs, &rest));
        let (lead, pressure) = (LEAD.to_radians(), PRESSURE.to_radians());
        let share = RATIO / lead.tan();
        let wheel_radius = DISTANCE / (1.0 + share);
        let worm_radius = DISTANCE - wheel_radius;
        let axial = load / wheel_radius;
        let tangential = RATIO * load / worm_radius;
        assert!((tangential / axial - lead.tan()).abs() < 1e-12);
        let apart = axial * pressure.tan() / lead.cos();
        // Teeth push the wheel along −x, away along y, and along z with the thread; bearings push back.
        for (name, force) in
            [("gx", axial), ("gy", -apart), ("gz", -tangential), ("fx", -axial), ("fy", apart), ("fz", tangential)]
        {
            let found = curve(&bounds, name)[5];
            assert!((found - force).abs() < 1e-8 * axial, "{formulation} {name}: {found} {force}");
        }
        let [worm, wheel] = ["worm", "wheel"].map(|name| curve(&bounds, name)[5]);
        assert!(worm.abs() < 1e-9 && wheel.abs() < 1e-9, "{worm} {wheel}");
    }
}

const FRICTION: f64 = 0.08;

fn with_friction(lead: f64, start: f64, torques: [f64; 2], transition: f64, rest: &str) -> Bounds {
    let friction = format!(
        "  rubbing: {{ tooth_friction: {{ on: mesh, coefficient: {FRICTION}, transition_velocity: {transition} }} }}"
    );
    run(&text(lead, start, torques, &friction, ", lost: rubbing.loss", rest))
}

/// tan ρ = μ/cos α. The worm that drives gives tan γ/tan(γ + ρ) of its power, and the wheel that drives tan(γ − ρ)/tan
/// γ.
#[test]
fn efficiency_of_a_worm_is_that_of_its_thread() {
    let (lead, pressure) = (LEAD.to_radians(), PRESSURE.to_radians());
    let angle = (FRICTION / pressure.cos()).atan();
    let [driving, driven] = [lead.tan() / (lead + angle).tan(), (lead - angle).tan() / lead.tan()];
    let [worm, wheel] = INERTIA;
    // α₁ (J₁ + i² J₂/η) = T₁ from the worm, and α₁ (J₁/η + i² J₂) = i T₂ from the wheel.
    for (torques, acceleration) in [
        ([0.05, 0.0], 0.05 / (worm + RATIO * RATIO * wheel / driving)),
        ([0.0, -1.0], RATIO / (worm / driven + RATIO * RATIO * wheel)),
    ] {
        let bounds = with_friction(LEAD, 1.0, torques, 1e-6, ", formulation: joint");
        for (&t, &found) in bounds.times.iter().zip(curve(&bounds, "worm")).skip(1) {
            assert!((found - 1.0 - acceleration * t).abs() < 1e-6 * acceleration * t, "{torques:?} at {t}: {found}");
        }
        let bounds = with_friction(LEAD, 1.0, torques, 1e-6, ", formulation: absolute");
        let (t, found) = (bounds.times[10], curve(&bounds, "worm")[10]);
        assert!((found - 1.0 - acceleration * t).abs() < 1e-4 * acceleration * t, "{torques:?} at {t}: {found}");
    }
}

/// Below the angle of friction the wheel cannot drive, whatever its torque: the worm creeps at the speed at which the
/// smooth law of friction bears tan γ/tan ρ of itself.
#[test]
fn a_worm_of_little_lead_locks() {
    let lead = 3.0_f64.to_radians();
    let part = lead.tan() * PRESSURE.to_radians().cos() / FRICTION;
    let share = RATIO / lead.tan();
    let worm_radius = DISTANCE * share / (1.0 + share);
    let creeping = 1e-3 * part / (1.0 - part * part).sqrt() * lead.cos() / worm_radius;
    for (torque, formulation) in [(-4.0, "joint"), (-40.0, "joint"), (-40.0, "absolute")] {
        let bounds = with_friction(3.0, 0.0, [0.0, torque], 1e-3, &format!(", formulation: {formulation}"));
        for &found in &curve(&bounds, "worm")[2..] {
            assert!((found - creeping).abs() < 1e-6 * creeping, "{torque} {formulation}: {found} {creeping}");
        }
    }
    let free = with_friction(LEAD, 0.0, [0.0, -4.0], 1e-3, "");
    assert!(curve(&free, "worm")[10] > 10.0);
}

/// Models that can be read, but have no pitch point.
#[test]
fn intersecting_or_parallel_axes_are_refused() {
    let good = text(LEAD, 0.0, [0.2, 0.0], "", "", "");
    let axle = "between: [ground.side, wheel], axis: z";
    assert!(good.contains(axle));
    for (other, expected) in [
        ("between: [ground.side, wheel], axis: x", "do not cross at right angles"),
        ("between: [ground, wheel], axis: z", "intersect"),
    ] {
        let wrong = read(&good.replace(axle, other)).unbuilt();
        assert!(wrong.contains(expected), "{wrong}");
    }
}
