//! `axial`: positive in tension, of whatever acts along the line between two points; signed forces of the other joints
//! whose direction is known.

use std::f64::consts::PI;

use crate::common::{curve, nominal, read};

const G: f64 = 9.81;

/// The first nominal value of an output.
#[track_caller]
fn first(text: &str, output: &str) -> f64 {
    curve(&nominal(&read(text)), output)[0]
}

#[track_caller]
fn close(found: f64, wanted: f64, tolerance: f64, case: &str) {
    assert!((found - wanted).abs() <= tolerance * wanted.abs(), "{case}: {found} instead of {wanted}");
}

/// A scissor lift on a rod from the ground to its left arm: by virtual work the rod carries −V'(θ)/ℓ'(θ).
#[test]
fn rod_lifts_scissors_by_pressure_or_tension() {
    let (arm, beyond, angle, load, mass) = (1.6_f64, 0.3, 20_f64.to_radians(), 500.0, 30.0);
    let reach = 0.5 * arm + beyond;
    for anchor in [[0.35, 0.0], [1.4, 2.5]] {
        let eye = [reach * angle.cos(), reach * angle.sin()];
        let line = [eye[0] - anchor[0], eye[1] - anchor[1]];
        let length = line[0].hypot(line[1]);
        let by_angle = (line[0] * -eye[1] + line[1] * eye[0]) / length;
        let tension = -(load + mass) * G * arm * angle.cos() / by_angle;
        assert_eq!(tension > 0.0, anchor[1] > 0.0);
        for formulation in ["absolute", "joint"] {
            for between in ["[ground.C, left.E]", "[left.E, ground.C]"] {
                let text = format!(
                    "
analysis: statics
bodies:
  ground: {{ points: {{ C: {anchor:?} }} }}
  left:  {{ mass: {mass}, inertia: 6, points: {{ A: [-{arm}/2, 0], E: [{beyond}, 0], T: [{arm}/2, 0] }} }}
  right: {{ mass: {mass}, inertia: 6, points: {{ B: [-{arm}/2, 0], T: [{arm}/2, 0] }} }}
  table: {{ mass: {load}, inertia: 50, points: {{ P: [-0.7, 0] }} }}
joints:
  foot: {{ revolute: [ground, left.A] }}
  middle: {{ revolute: [left, right] }}
  slide_low: {{ point_on_line: {{ between: [ground, right.B], axis: x }} }}
  top: {{ revolute: [right.T, table.P] }}
  slide_top: {{ point_on_line: {{ between: [table.P, left.T], axis: x }} }}
  rod: {{ distance: {{ between: {between}, length: {length} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -{G}] }} }} }}
guess: {{ left.angle: {angle}, right.angle: {} }}
outputs: {{ axial: rod.axial }}
simulation: {{ duration: 1, formulation: {formulation} }}
",
                    PI - angle
                );
                close(first(&text, "axial"), tension, 1e-9, &format!("{between} {formulation}"));
            }
        }
    }
}

/// A boom that turns about y, in space, and whatever holds it: m g c cos θ + T ℓ'(θ) = 0.
#[test]
fn axial_force_of_a_boom_in_space_has_the_right_sign() {
    let (mass, center, reach, aside) = (40.0, 0.5, 1.2, 0.2);
    let above = [0.1, -0.3, 1.5];
    let below = [0.3, 0.5, -0.8];
    let tie = "joints: { hinge: {revolute: {between: [ground, boom.A], axis: y}}, e: {distance: {between: [ground.C, boom.E], length: L}} }
effects: { ";
    let by = |element: &str| {
        format!(
            "joints: {{ hinge: {{ revolute: {{ between: [ground, boom.A], axis: y }} }} }}\neffects: {{ e: {{ {element} }}, "
        )
    };
    let cases = [
        (above, tie.replace('L', "1.95"), "joint"),
        (below, tie.replace('L', "1.3"), "joint"),
        (above, tie.replace('L', "1.95"), "absolute"),
        (below, tie.replace('L', "1.3"), "absolute"),
        (above, by("spring_damper: { between: [ground.C, boom.E], stiffness: 2e4, free_length: 1.9 }"), "absolute"),
        (below, by("spring_damper: { between: [boom.E, ground.C], stiffness: 2e4, free_length: 1.4 }"), "joint"),
        (above, by("cable: { between: [boom.E, ground.C], stiffness: 3e4, free_length: 1.9 }"), "absolute"),
        (
            below,
            by(
                "gas_spring: { between: [ground.C, boom.E], diameter: 25 mm, length: 1.4, pressure: 9 bar, volume: 0.1 L }",
            ),
            "absolute",
        ),
    ];
    for (anchor, elements, formulation) in cases {
        let text = format!(
            "
analysis: statics
bodies:
  ground: {{ points: {{ C: {anchor:?} }} }}
  boom: {{ mass: {mass}, inertia: [3, 4, 4], points: {{ A: [-{center}, 0, 0], E: [{}, {aside}, 0] }} }}
{elements} weight: {{ gravity: {{ acceleration: [0, 0, -{G}] }} }} }}
guess: {{ boom.x: {center} }}
outputs: {{ axial: e.axial, x: boom.x, z: boom.z }}
simulation: {{ duration: 1, formulation: {formulation} }}
",
            reach - center
        );
        let bounds = nominal(&read(&text));
        let [axial, x, z] = ["axial", "x", "z"].map(|name| curve(&bounds, name)[0]);
        let (cos, sin) = (x / center, z / center);
        let line = [reach * cos - anchor[0], aside - anchor[1], reach * sin - anchor[2]];
        let length = line.iter().map(|part| part * part).sum::<f64>().sqrt();
        let by_angle = reach * (cos * line[2] - sin * line[0]) / length;
        let tension = -mass * G * center * cos / by_angle;
        assert_eq!(tension > 0.0, anchor[2] > 0.0);
        close(axial, tension, 1e-7, &elements);
    }
}

/// A mast carries its top's weight; turned over it hangs.
#[test]
fn beams_and_superelements_carry_weights() {
    let beam = "beam: { between: [foot, top], length: 0.6, axial_stiffness: 1e6, bending_stiffness: 900, axis: x }";
    let matrices = "{ nodes: [[0, 0], [0.6, 0]], mass: [[1.4], [0, 1.56], [0, 0.132, 0.0144], [0.7, 0, 0, 1.4], [0, 0.54, 0.078, 0, 1.56], [0, -0.078, -0.0108, 0, -0.132, 0.0144]], stiffness: [[1e5], [0, 1000], [0, 300, 120], [-1e5, 0, 0, 1e5], [0, -1000, -300, 0, 1000], [0, 300, 60, 0, -300, 120]] }";
    let superelement = format!("superelement: {{ nodes: [foot, top], mass: 1e-7, matrices: {matrices} }}");
    for element in [beam, &superelement] {
        for (down, tension) in [(-G, -12.0 * G), (G, 12.0 * G)] {
            let text = format!(
                "
analysis: statics
bodies: {{ foot: {{ mass: 1, inertia: 0.1 }}, top: {{ mass: 12, inertia: 0.1 }} }}
joints: {{ wall: {{ fixed: [ground, foot] }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [{down}, 0] }} }}, e: {{ {element} }} }}
guess: {{ top.x: 0.6 }}
outputs: {{ axial: e.axial }}
simulation: {{ duration: 1 }}
"
            );
            close(first(&text, "axial"), tension, 1e-5, element);
        }
    }
}

/// A positive preload pulls; a cylinder pushes by its pressures.
#[test]
fn a_preload_is_a_tension_and_a_cylinder_pushes() {
    let at_start = |element: &str| {
        let text = format!(
            "
bodies: {{ slide: {{ mass: 5, coordinates: [x] }} }}
effects: {{ e: {{ {element} }} }}
initial: {{ slide.x: 0.5, slide.vx: 0 }}
outputs: {{ axial: e.axial }}
simulation: {{ duration: 1e-3, step: 1e-4, output_step: 1e-3 }}
"
        );
        first(&text, "axial")
    };
    for value in [15.0, -15.0] {
        let element = format!("preload: {{ between: [ground, slide], value: {value} }}");
        close(at_start(&element), value, 1e-12, &element);
    }
    let cylinder = "hydraulic_cylinder: { between: [ground, slide], bore: 40 mm, rod: 25 mm, stroke: 0.3, retracted: 0.4, \
                    dead_volume: 0.1 L, \
                    supply: 100 bar, valve: 0, rated_flow: 20 L/min, rated_drop: 35 bar, piston_pressure: 20 bar, rod_pressure: 30 bar }";
    let area = |diameter: f64| PI / 4.0 * diameter * diameter;
    let push = 20e5 * area(0.04) - 30e5 * (area(0.04) - area(0.025));
    close(at_start(cylinder), -push, 1e-9, cylinder);
}

/// Normals, rails and cams: positive along the normal, which the second body's weight presses against.
#[test]
fn forces_of_contact_joints_have_signs() {
    let rests = |joint: &str, output: &str, down: f64| {
        let text = format!(
            "
analysis: statics
bodies: {{ block: {{ mass: 2, inertia: 0.1 }} }}
joints: {{ e: {{ {joint} }}, upright: {{ prismatic: {{ between: [ground, block], axis: y }} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, {down}] }} }} }}
guess: {{ block.y: 0.1 }}
outputs: {{ force: e.{output} }}
simulation: {{ duration: 1 }}
"
        );
        first(&text, "force")
    };
    for (joint, output) in [
        ("point_on_plane: { between: [ground, block], normal: y }", "axial"),
        ("point_on_line: { between: [ground, block], axis: x }", "radial"),
        ("pin_in_slot: { between: [ground, block], axis: x }", "radial"),
        ("cam: { between: [ground, block], base: 0.1, lift: 0*angle, phase: 90 deg }", "axial"),
        ("cam: { between: [ground, block], base: 0.1, lift: 0*angle, phase: 90 deg, follower: flat }", "axial"),
    ] {
        for down in [-G, G] {
            close(rests(joint, output, down), -2.0 * down, 1e-9, joint);
        }
    }
}

/// A disc rolls down a slope: friction m g sin β/(1 + m r²/I) up the rail, m g cos β away from it.
#[test]
fn rolling_splits_its_force_along_the_rail() {
    let bounds = nominal(&read(&format!(
        "
bodies: {{ disc: {{ mass: 3, inertia: 3*0.1^2/2 }} }}
joints: {{ roll: {{ rolling: {{ between: [ground, disc], axis: [cos(30 deg), -sin(30 deg)], radius: 0.1 }} }} }}
effects: {{ weight: {{ gravity: {{ acceleration: [0, -{G}] }} }} }}
initial: {{ disc.angle: 0, disc.angular_velocity: 0 }}
outputs: {{ along: roll.axial, away: roll.radial }}
simulation: {{ duration: 0.1, step: 1e-2, output_step: 0.1 }}
"
    )));
    close(curve(&bounds, "along")[0], -3.0 * G * 0.5 / 3.0, 1e-9, "along");
    close(curve(&bounds, "away")[0], 3.0 * G * 30_f64.to_radians().cos(), 1e-9, "away");
}
