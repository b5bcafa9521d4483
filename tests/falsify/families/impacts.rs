//! Impacts on stiff springs: parabolas and sines, one after the other.

use std::f64::consts::PI;

use super::{Scale, closed_form, lines, named, parameter};
use crate::draw::Term;
use crate::random::Random;

/// Angular frequency of a contact that lasts from a third of a step to 50 steps.
fn contact(random: &mut Random, scale: &Scale) -> f64 {
    PI / (random.scale(0.3, 50.0) * scale.step)
}

fn ball(index: usize) -> (Vec<String>, Vec<String>) {
    (vec![named("b#: { mass: m#, coordinates: [y] }", index)], lines(&["b#.y", "b#.vy"], index))
}

/// A mass that falls onto a stiff spring, and comes back.
pub fn bounce(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    // Number of falls that fit in the duration.
    let falls = random.between(0.7, 8.0);
    let gravity = random.pick(&[9.81, 1.62]);
    let height = crate::random::digits(0.5 * gravity * (scale.duration / falls).powi(2), 3);
    let m = random.scale(0.1, 10.0);
    let stiffness = crate::random::digits(m * contact(random, scale).powi(2), 3);
    let (bodies, channels) = ball(place);
    let curves = closed_form(|p, t| {
        let [m, stiffness, gravity, height] = p[..4] else { unreachable!() };
        let omega = (stiffness / m).sqrt();
        let (fall, speed) = ((2.0 * height / gravity).sqrt(), (2.0 * gravity * height).sqrt());
        let contact = 2.0 / omega * (PI - (speed * omega / gravity).atan());
        // From the top down, through the contact, and up to the top.
        let since = t % (2.0 * fall + contact);
        if since < fall {
            [height - 0.5 * gravity * since * since, -gravity * since]
        } else if since < fall + contact {
            let (sin, cos) = (omega * (since - fall)).sin_cos();
            let sag = gravity / (omega * omega);
            [-sag * (1.0 - cos) - speed / omega * sin, -sag * omega * sin - speed * cos]
        } else {
            let left = 2.0 * fall + contact - since;
            [height - 0.5 * gravity * left * left, gravity * left]
        }
    });
    Term {
        parameters: vec![
            parameter("m", place, m, 0.2),
            parameter("K", place, stiffness, 0.3),
            parameter("g", place, gravity, 0.02),
            parameter("h", place, height, 0.1),
        ],
        bodies,
        joints: vec![],
        effects: vec![named("f#: { force: { on: b#, value: [0, \"K#*max(-b#.y, 0) - m#*g#\"] } }", place)],
        initial: lines(&["b#.y: h#", "b#.vy: 0"], place),
        guess: vec![],
        channels,
        curves,
        integrated: false,
        size: height,
        spatial: false,
        hidden: None,
    }
}

/// A mass thrown up, which some speeds of the box take to a stiff ceiling.
pub fn ceiling(random: &mut Random, scale: &Scale) -> Term {
    let place = scale.place;
    let gravity = 9.81;
    let speed = crate::random::digits(gravity * scale.duration * random.between(0.3, 0.9), 3);
    // The apex of a speed up to a tenth off.
    let touching = speed * random.between(0.9, 1.1);
    let height = crate::random::digits(touching * touching / (2.0 * gravity), 4);
    let m = random.scale(0.1, 10.0);
    let stiffness = crate::random::digits(m * contact(random, scale).powi(2), 3);
    let (bodies, channels) = ball(place);
    let curves = closed_form(|p, t| {
        let [m, stiffness, gravity, height, speed] = p[..5] else { unreachable!() };
        let fly = |t: f64| [speed * t - 0.5 * gravity * t * t, speed - gravity * t];
        let left = speed * speed - 2.0 * gravity * height;
        if left <= 0.0 {
            return fly(t);
        }
        let (omega, at) = ((stiffness / m).sqrt(), left.sqrt());
        let begins = (speed - at) / gravity;
        let contact = 2.0 / omega * (at * omega / gravity).atan();
        if t < begins {
            fly(t)
        } else if t < begins + contact {
            let (sin, cos) = (omega * (t - begins)).sin_cos();
            let push = gravity / (omega * omega);
            [height + at / omega * sin - push * (1.0 - cos), at * cos - push * omega * sin]
        } else {
            let since = t - begins - contact;
            [height - at * since - 0.5 * gravity * since * since, -at - gravity * since]
        }
    });
    Term {
        parameters: vec![
            parameter("m", place, m, 0.2),
            parameter("K", place, stiffness, 0.3),
            parameter("g", place, gravity, 0.02),
            parameter("H", place, height, 0.1),
            parameter("v", place, speed, 0.2),
        ],
        bodies,
        joints: vec![],
        effects: vec![named("f#: { force: { on: b#, value: [0, \"-K#*max(b#.y - H#, 0) - m#*g#\"] } }", place)],
        initial: lines(&["b#.y: 0", "b#.vy: v#"], place),
        guess: vec![],
        channels,
        curves,
        integrated: false,
        size: height,
        spatial: false,
        hidden: None,
    }
}
