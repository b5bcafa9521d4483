//! Mechanisms that index by contact: a Geneva wheel whose slots end, and a ratchet with its pawl.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use mbint::results::Bounds;

use crate::common::{curve, largest, nominal, read};

/// A point at a radius along a direction and an offset to its left, as a model has it.
fn place(radius: f64, offset: f64, angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [radius * cos - offset * sin, radius * sin + offset * cos]
}

fn list(points: impl IntoIterator<Item = [f64; 2]>) -> String {
    let points: Vec<String> = points.into_iter().map(|[x, y]| format!("[{x}, {y}]")).collect();
    format!("[{}]", points.join(", "))
}

/// Distance of the centres, m.
const CENTRES: f64 = 0.1;

/// Four slots between the centres of a crank with a pin and a wheel, and a disc of the crank with 260° that holds the
/// wheel by its horns.
fn geneva() -> Bounds {
    let (crank, pin, rounding, play) = (CENTRES * FRAC_PI_4.cos(), 5e-3, 1e-4, 1e-4);
    let (half, depth, tip) = (pin + rounding + play, CENTRES - crank - pin - 2e-3, 5e-4);
    let law = "impact: { stiffness: 2e6, exponent: 1, dissipation: 10 }";
    let directions = [0, 1, 2, 3].map(|slot| FRAC_PI_4 + FRAC_PI_2 * f64::from(slot));
    let horns: Vec<[f64; 2]> =
        directions.iter().flat_map(|&angle| [1.0, -1.0].map(|side| place(crank, side * (half + tip), angle))).collect();
    let nearest = horns.iter().map(|[x, y]| (CENTRES + x).hypot(*y)).fold(f64::INFINITY, f64::min);
    let disc = nearest - tip - rounding - play;
    let slots: Vec<String> = directions
        .iter()
        .enumerate()
        .map(|(slot, &angle)| {
            let path = [(crank, half), (depth, half), (depth, -half), (crank, -half)];
            let path = list(path.map(|(radius, offset)| place(radius, offset, angle)));
            format!("  slot{slot}: {{ contact: {{ between: [wheel, crank.pin], path: {path}, rounding: {rounding}, radius: {pin}, {law} }} }}")
        })
        .collect();
    let at = |degrees: f64| place(disc, 0.0, degrees * PI / 180.0);
    let arcs: Vec<String> =
        [120.0, 240.0, 310.0].map(|end| format!("{{ to: {:?}, radius: {disc} }}", at(end))).to_vec();
    nominal(&read(&format!(
        "
bodies:
  ground: {{ points: {{ centre: [{CENTRES}, 0] }} }}
  crank: {{ mass: 1, inertia: 1e-3, points: {{ pin: [{crank}, 0] }} }}
  wheel: {{ mass: 0.5, inertia: 6e-4 }}
joints:
  crank_axle: {{ revolute: [ground, crank] }}
  wheel_axle: {{ revolute: [ground.centre, wheel] }}
  drive: {{ motor: {{ on: crank_axle, position: 2*pi*t - 60 deg }} }}
effects:
  bearing: {{ torque: {{ on: wheel, value: -0.02*wheel.angular_velocity }} }}
  load: {{ torque: {{ on: wheel, value: 0.15*sin(40*t)*exp(-((t - 0.65)/0.08)^2) }} }}
{}
  lock:
    contact:
      {{ between: [crank, wheel], path: [{:?}, {}], rounding: {rounding}, corners: {}, radius: {tip}, {law} }}
initial: {{ wheel.angle: 0, wheel.angular_velocity: 0 }}
outputs: {{ crank: crank_axle.angle, wheel: wheel.angle, lock: lock.force }}
simulation: {{ duration: 1, step: 5e-5, output_step: 0.01 }}
",
        slots.join("\n"),
        at(50.0),
        arcs.join(", "),
        list(horns),
    )))
}

/// While the pin is in a slot the wheel turns by 45° + atan(a sin φ/(c − a cos φ)) backwards, within the play; then the
/// disc holds it at a quarter, against a load of either sign.
#[test]
fn a_geneva_wheel_with_slots_that_end_turns_by_a_quarter() {
    let bounds = geneva();
    let a = CENTRES * FRAC_PI_4.cos();
    for (crank, wheel) in curve(&bounds, "crank").iter().zip(curve(&bounds, "wheel")) {
        let (sin, cos) = crank.sin_cos();
        // The play is 0.1 mm to either side, at the pin's distance from the wheel's axle, and 0.1 mm at the horns.
        let (expected, play) = match crank.to_degrees() {
            ..-45.0 => (0.0, 0.1 / 70.0),
            -45.0..45.0 => {
                let distance = (CENTRES - a * cos).hypot(a * sin);
                (-FRAC_PI_4 - (a * sin).atan2(CENTRES - a * cos), 1.3e-4 / distance)
            }
            // One horn is next to the disc, the other one is where it begins.
            45.0..100.0 => (-FRAC_PI_2, 0.01),
            _ => (-FRAC_PI_2, 0.2 / 70.0),
        };
        assert!((wheel - expected).abs() < play, "{}: {wheel}, not {expected}", crank.to_degrees());
    }
    assert!(largest(curve(&bounds, "lock").iter().copied()) > 1.0, "the disc holds it");
}

/// A wheel of twelve teeth that is pulled to and fro turns one way, and rests at whole teeth.
#[test]
fn a_pawl_lets_a_ratchet_turn_one_way() {
    let teeth = (0..12).flat_map(|tooth| {
        let angle = FRAC_PI_2 + PI / 6.0 * f64::from(tooth);
        [place(0.05, 0.0, angle), place(0.043, 0.0, angle)]
    });
    let bounds = nominal(&read(&format!(
        "
bodies:
  ground: {{ points: {{ post: [-0.04, 0.062] }} }}
  wheel: {{ mass: 0.3, inertia: 4e-4 }}
  pawl: {{ mass: 0.02, inertia: 8e-6, points: {{ eye: [-0.022, 0], tip: [0.022, 0] }} }}
joints: {{ axle: {{ revolute: [ground, wheel] }}, hinge: {{ revolute: [ground.post, pawl.eye] }} }}
effects:
  load: {{ torque: {{ on: wheel, value: 0.25*sin(12*t) - 0.01*wheel.angular_velocity }} }}
  press: {{ torque: {{ on: pawl, value: -0.02 - 2e-4*pawl.angular_velocity }} }}
  teeth:
    contact:
      between: [wheel, pawl.tip]
      polygon: {}
      radius: 1e-3
      rounding: 5e-4
      impact: {{ stiffness: 5e5, exponent: 1, dissipation: 5 }}
initial: {{ wheel.angle: -10 deg, wheel.angular_velocity: 0, pawl.angle: -18 deg, pawl.angular_velocity: 0 }}
outputs: {{ angle: deg(wheel.angle), push: teeth.force }}
simulation: {{ duration: 1.25, step: 1e-4, output_step: 0.01 }}
",
        list(teeth)
    )));
    let angles = curve(&bounds, "angle");
    let at = |time: f64| angles[(time / 0.01).round() as usize];
    // Angles at which it is pushed against a tooth: the middle of each half wave that turns it back.
    let rests = [0.2, 0.72, 1.23].map(at);
    for pair in rests.windows(2) {
        let teeth = (pair[0] - pair[1]) / 30.0;
        assert!(teeth > 1.5 && (teeth - teeth.round()).abs() < 2e-3, "{rests:?}");
    }
    // It never turns back by more than a tooth.
    let mut least = f64::INFINITY;
    for angle in angles {
        least = least.min(*angle);
        assert!(*angle < least + 30.0, "{angle} after {least}");
    }
}
