//! A heavy top, in Euler parameters about its fixed point.

use super::{Scale, integrated, lines, named, parameter};
use crate::draw::Term;
use crate::random::Random;
use crate::random::digits;

/// A symmetric top that spins about its axis z, tilted at the start; its foot is fixed.
pub fn top(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let arm = random.scale(0.05, 0.5);
    let [across, axial] = [0.3, 0.15].map(|share| digits(arm * arm * share * random.scale(0.5, 2.0), 3));
    // From a tenth of a turn within the step down to a hundredth.
    let spin = digits(random.scale(0.02, 0.5) / scale.step, 3).min(digits(300.0 / scale.duration, 3));
    let tilt = random.between(0.1, 1.4);
    let curves = integrated(
        1.0 / spin,
        |p| [(0.5 * p[4]).cos(), (0.5 * p[4]).sin(), 0.0, 0.0, 0.0, 0.0, p[3]],
        |p, _, y, d| {
            let [arm, across, axial, _, _, m] = p[..6] else { unreachable!() };
            let [e0, e1, e2, e3, wx, wy, wz] = y else { unreachable!() };
            let about = across + m * arm * arm;
            // The upward direction in the body's frame; the weight's torque is −m g arm (z × up).
            let up = [2.0 * (e1 * e3 - e0 * e2), 2.0 * (e2 * e3 + e0 * e1)];
            let torque = m * 9.81 * arm;
            d.copy_from_slice(&[
                0.5 * (-e1 * wx - e2 * wy - e3 * wz),
                0.5 * (e0 * wx + e2 * wz - e3 * wy),
                0.5 * (e0 * wy + e3 * wx - e1 * wz),
                0.5 * (e0 * wz + e1 * wy - e2 * wx),
                (torque * up[1] - (axial - about) * wy * wz) / about,
                (-torque * up[0] + (axial - about) * wx * wz) / about,
                0.0,
            ]);
        },
        |p, _, y| {
            let [e0, e1, e2, e3] = [y[0], y[1], y[2], y[3]];
            let axis = [2.0 * (e1 * e3 + e0 * e2), 2.0 * (e2 * e3 - e0 * e1), 1.0 - 2.0 * (e1 * e1 + e2 * e2)];
            axis.map(|x| p[0] * x)
        },
    );
    Term {
        parameters: vec![
            parameter("r", place, arm, 0.05),
            parameter("I", place, across, 0.05),
            parameter("J", place, axial, 0.05),
            parameter("w", place, spin, 0.03),
            parameter("a", place, tilt, 0.05),
            parameter("m", place, 1.0, 0.1),
        ],
        bodies: vec![named("b#: { mass: m#, inertia: [I#, I#, J#], points: { o: [0, 0, -r#] } }", place)],
        joints: vec![named("j#: { spherical: [ground, b#.o] }", place)],
        effects: vec![named("g#: { gravity: { acceleration: [0, 0, -9.81] } }", place)],
        initial: lines(&["b#.orientation: { axis: x, angle: a# }", "b#.omega_body: [0, 0, w#]"], place),
        guess: vec![],
        channels: lines(&["b#.x", "b#.y", "b#.z"], place),
        curves,
        integrated: true,
        size: arm,
        spatial: true,
        hidden: None,
    }
}
