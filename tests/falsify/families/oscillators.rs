//! Linear oscillators, free and forced, in closed form.

use std::f64::consts::TAU;

use super::{Scale, closed_form, lines, named, parameter, removable};
use crate::draw::Term;
use crate::random::Random;

/// Position and velocity of x'' + 2δx' + ω²x = 0.
pub fn decay(omega_square: f64, delta: f64, x: f64, v: f64, t: f64) -> [f64; 2] {
    let inside = omega_square - delta * delta;
    if inside > 0.0 {
        let omega = inside.sqrt();
        let (sin, cos) = (omega * t).sin_cos();
        let fade = (-delta * t).exp();
        let b = (v + delta * x) / omega;
        [fade * (x * cos + b * sin), fade * (v * cos - (delta * b + omega * x) * sin)]
    } else {
        let root = (-inside).sqrt();
        let (slow, quick) = (-delta + root, -delta - root);
        let (a, b) = ((v - quick * x) / (slow - quick), (slow * x - v) / (slow - quick));
        let (ea, eb) = (a * (slow * t).exp(), b * (quick * t).exp());
        [ea + eb, slow * ea + quick * eb]
    }
}

/// An oscillator's own period is from a tenth of the duration to 30 times it.
pub fn slow_frequency(random: &mut Random, scale: &Scale) -> f64 {
    let turns = random.scale(0.3, 8.0);
    // At least some 30 steps a turn.
    (turns * TAU / scale.duration).min(0.2 / scale.step)
}

/// Mass, stiffness, damping and start of an oscillator of a frequency.
struct Mass {
    m: f64,
    k: f64,
    c: f64,
    x: f64,
    v: f64,
}

impl Mass {
    fn draw(random: &mut Random, omega: f64, damping: f64) -> Self {
        let m = random.scale(0.1, 10.0);
        let x = random.scale(1e-3, 1.0) * random.pick(&[-1.0, 1.0]);
        let v = if random.chance(0.5) { 0.0 } else { crate::random::digits(random.between(-1.0, 1.0) * omega * x, 3) };
        let k = crate::random::digits(m * omega * omega, 3);
        Self { m, k, c: crate::random::digits(2.0 * damping * m * omega, 3), x, v }
    }

    fn term(&self, index: usize, origin: f64) -> Term {
        let parameters = vec![
            parameter("m", index, self.m, 0.2),
            parameter("k", index, self.k, 0.3),
            removable("c", index, self.c, 0.5),
            parameter("x", index, self.x, 0.3),
            removable("v", index, self.v, 0.3),
            removable("L", index, origin, 0.0),
        ];
        let curves = closed_form(|p, t| {
            let [m, k, c, x, v, origin] = p[..6] else { unreachable!() };
            let [x, v] = decay(k / m, c / (2.0 * m), x, v, t);
            [origin + x, v, -(k * x + c * v) / m]
        });
        Term {
            parameters,
            bodies: vec![named("b#: { mass: m#, coordinates: [x] }", index)],
            joints: vec![],
            effects: vec![named("s#: { force: { on: b#, value: [\"-k#*(b#.x - L#) - c#*b#.vx\", 0] } }", index)],
            initial: lines(&["b#.x: L# + x#", "b#.vx: v#"], index),
            guess: vec![],
            channels: lines(&["b#.x", "b#.vx", "b#.ax"], index),
            curves,
            integrated: false,
            size: origin.abs() + self.x.abs(),
            spatial: false,
            hidden: None,
        }
    }
}

fn damping(random: &mut Random) -> f64 {
    let light = random.scale(1e-3, 0.3);
    let heavy = random.scale(1.2, 3.0);
    random.pick(&[0.0, 0.0, light, light, heavy])
}

pub fn free(random: &mut Random, scale: &Scale) -> Term {
    free_at(random, scale, 0.0)
}

pub fn free_at(random: &mut Random, scale: &Scale, origin: f64) -> Term {
    let omega = slow_frequency(random, scale);
    let damping = damping(random);
    let mut term = Mass::draw(random, omega, damping).term(scale.place, origin);
    if origin != 0.0 {
        term.channels.push(named("b#.x - L#", scale.place));
        let curves = term.curves;
        term.curves = std::sync::Arc::new(move |p, times| {
            let mut all = curves(p, times);
            all.push(all[0].iter().map(|x| x - p[5]).collect());
            all
        });
    }
    term
}

/// A mode that the steps hardly resolve, or not at all; small, and certain.
pub fn fast(random: &mut Random, scale: &Scale) -> Term {
    let omega = random.scale(0.2, 100.0) / scale.step;
    let damping = if random.chance(0.5) { 0.0 } else { random.scale(1e-3, 1.0) };
    let mut term = Mass::draw(random, omega, damping).term(scale.place, 0.0);
    for parameter in &mut term.parameters {
        parameter.most = 0.0;
    }
    // Accelerations of such a mode would hide all else.
    term.channels.truncate(1);
    let curves = term.curves;
    term.curves = std::sync::Arc::new(move |p, times| {
        let mut all = curves(p, times);
        all.truncate(1);
        all
    });
    term
}

/// A force with a period from h/100 to 100 h.
pub fn forced(random: &mut Random, scale: &Scale) -> Term {
    let omega = slow_frequency(random, scale);
    let damping = random.scale(1e-2, 0.5);
    let mass = Mass::draw(random, omega, damping);
    let period = match random.whole(0, 3) {
        // The steps, or half of them, see the same phase every time.
        0 => scale.step / random.pick(&[1.0, 2.0, 3.0, 4.0, 6.0, 8.0]),
        1 => scale.step / random.pick(&[0.5, 1.5, 2.5]),
        _ => random.scale(1e-2, 1e2) * scale.step,
    };
    force(random, scale, &mass, TAU / period)
}

/// A narrow resonance that the box may contain.
pub fn resonant(random: &mut Random, scale: &Scale) -> Term {
    let omega = (random.scale(3.0, 40.0) * TAU / scale.duration).min(0.2 / scale.step);
    let damping = random.scale(1e-3, 3e-2);
    let mass = Mass::draw(random, omega, damping);
    let detuned = random.between(0.85, 1.15);
    force(random, scale, &mass, detuned * (mass.k / mass.m).sqrt())
}

/// F cos(Ωt + φ) on a damped oscillator.
fn force(random: &mut Random, scale: &Scale, mass: &Mass, frequency: f64) -> Term {
    let place = scale.place;
    let mut term = mass.term(place, 0.0);
    let amplitude = crate::random::digits(mass.k * mass.x * random.scale(0.1, 10.0), 3);
    let phase = random.pick(&[0.0, 0.7, 1.57, 3.0]);
    term.parameters.push(removable("F", place, amplitude, 0.2));
    term.parameters.push(parameter("w", place, crate::random::digits(frequency, 8), 0.0));
    term.parameters.push(removable("p", place, phase, 0.2));
    let force = "s#: { force: { on: b#, value: [\"-k#*(b#.x - L#) - c#*b#.vx + F#*cos(w#*t + p#)\", 0] } }";
    term.effects = lines(&[force], place);
    term.curves = closed_form(|p, t| {
        let [m, k, c, x, v, origin, f, w, phase] = p[..9] else { unreachable!() };
        let (square, delta) = (k / m, c / (2.0 * m));
        let (detuned, damped) = (square - w * w, 2.0 * delta * w);
        let share = f / m / (detuned * detuned + damped * damped);
        let steady = |t: f64| {
            let (sin, cos) = (w * t + phase).sin_cos();
            [share * (detuned * cos + damped * sin), share * w * (damped * cos - detuned * sin)]
        };
        let [from, rate] = steady(0.0);
        let [fading, slowing] = decay(square, delta, x - from, v - rate, t);
        let [x, rate] = steady(t);
        let (x, v) = (x + fading, rate + slowing);
        [origin + x, v, (f * (w * t + phase).cos() - k * x - c * v) / m]
    });
    term
}
