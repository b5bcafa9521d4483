//! Gradients of motions that are cut at events, against closed forms, whose derivatives are central differences.

use crate::common::model_of;

const GRAVITY: f64 = 9.81;

/// Asserts heights and speeds and their derivatives in all rows but those next to a kink, where the speed has none:
/// in many rows, which jets give, and in two, which adjoints give.
fn are_those_of(text: &str, parameters: &[f64], of: impl Fn(&[f64], f64) -> [f64; 2], kinks: &[f64]) {
    let (_, duration) = text.split_once("duration: ").unwrap();
    let (duration, _) = duration.split_once(',').unwrap();
    let two_rows = text.replace("output_step: 0.05", &format!("output_step: {duration}"));
    assert!(compared(text, parameters, &of, kinks) > 20);
    assert_eq!(compared(&two_rows, parameters, &of, kinks), 1);
}

/// Compares values and derivatives after the start; the number of rows that were compared.
fn compared(text: &str, parameters: &[f64], of: impl Fn(&[f64], f64) -> [f64; 2], kinks: &[f64]) -> usize {
    // Steps err by 1e-10 of the motion at most, and events follow each other: values differ by up to 4e-9 here,
    // derivatives by up to 5e-8.
    let found = model_of(text).gradients().unwrap();
    let mut rows = 0;
    for (row, &time) in found.times.iter().enumerate().filter(|(_, time)| **time > 0.0) {
        if kinks.iter().any(|kink| (kink - time).abs() < 1e-4) {
            continue;
        }
        rows += 1;
        let value = of(parameters, time);
        for (output, value) in found.outputs.iter().zip(value) {
            assert!((output.values[row] - value).abs() < 1e-8, "{} at {time}: {}", output.name, output.values[row]);
        }
        for parameter in 0..parameters.len() {
            let step = 1e-6 * parameters[parameter];
            let at = |sign: f64| {
                let mut moved = parameters.to_vec();
                moved[parameter] += sign * step;
                of(&moved, time)
            };
            let (high, low) = (at(1.0), at(-1.0));
            for (line, output) in found.outputs.iter().enumerate() {
                let (own, by) = (output.by_parameters[row][parameter], (high[line] - low[line]) / (2.0 * step));
                let name = format!("{} by {}", output.name, found.parameters[parameter].name);
                assert!((own - by).abs() < 1e-7 * (1.0 + by.abs()), "{name} at {time}: {own}, not {by}");
            }
        }
    }
    rows
}

/// Below a border that rises, a constant push acts: the force jumps, so that instants matter to first order.
#[test]
fn gradients_through_force_jumps_are_exact() {
    let text = "
parameters:
  h: { value: 1 m, tolerance: 2% }
  border: { value: 0.2 m, tolerance: 2% }
  rise: { value: 0.05 m/s, tolerance: 2% }
  push: { value: 40 N, tolerance: 2% }
  mass: { value: 1.1 kg, tolerance: 2% }
bodies: { ball: { mass: mass, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  layer: { force: { on: ball, value: [0, \"if(ball.y < border + rise*t, push, 0)\"] } }
initial: { ball.y: h, ball.vy: 0 }
outputs: { y: ball.y, v: ball.vy }
simulation: { duration: 2, step: 1e-3, output_step: 0.05 }
";
    /// When y + v t + a t²/2, relative to the border, is zero next after its time.
    fn passes(gap: f64, speed: f64, acceleration: f64) -> f64 {
        let root = (speed * speed - 2.0 * acceleration * gap).sqrt();
        let candidates = [(-speed - root) / acceleration, (-speed + root) / acceleration];
        candidates.into_iter().filter(|time| *time > 1e-9).fold(f64::INFINITY, f64::min)
    }
    let motion = |parameters: &[f64], time: f64| {
        let &[h, border, rise, push, mass] = parameters else { unreachable!("five parameters") };
        let (mut begin, mut y, mut v, mut is_below) = (0.0, h, 0.0, false);
        loop {
            let a = if is_below { push / mass - GRAVITY } else { -GRAVITY };
            let length = passes(y - border - rise * begin, v - rise, a);
            if begin + length >= time {
                let rest = time - begin;
                return [y + v * rest + 0.5 * a * rest * rest, v + a * rest];
            }
            (y, v) = (y + v * length + 0.5 * a * length * length, v + a * length);
            (begin, is_below) = (begin + length, !is_below);
        }
    };
    are_those_of(text, &[1.0, 0.2, 0.05, 40.0, 1.1], motion, &[]);
}

/// On an elastic floor, m y″ = −k y − m g while y < 0: flights and half waves in turn.
#[test]
fn gradients_through_contacts_are_exact() {
    let text = "
parameters:
  h: { value: 1 m, tolerance: 2% }
  stiffness: { value: 1e5 N/m, tolerance: 5% }
  mass: { value: 1.1 kg, tolerance: 5% }
bodies: { ball: { mass: mass, coordinates: [y] } }
effects:
  weight: { gravity: { acceleration: [0, -9.81] } }
  floor: { contact: { between: [ground, ball], plane: y, impact: { stiffness: stiffness, exponent: 1, dissipation: 0 s/m } } }
initial: { ball.y: h, ball.vy: 0 }
outputs: { y: ball.y, v: ball.vy }
simulation: { duration: 2.5, step: 1e-4, output_step: 0.05 }
";
    let motion = |parameters: &[f64], time: f64| {
        let &[h, stiffness, mass] = parameters else { unreachable!("three parameters") };
        let (fall, omega) = ((2.0 * h / GRAVITY).sqrt(), (stiffness / mass).sqrt());
        let (speed, sag) = (GRAVITY * fall, GRAVITY / omega.powi(2));
        // y = sag (cos ω t − 1) − (speed/ω) sin ω t, which is zero again after:
        let contact = 2.0 * (std::f64::consts::PI - (speed / omega).atan2(sag)) / omega;
        let since = time + fall - (2.0 * fall + contact) * ((time + fall) / (2.0 * fall + contact)).floor();
        // A period begins with the rise.
        if since < 2.0 * fall {
            return [speed * since - 0.5 * GRAVITY * since * since, speed - GRAVITY * since];
        }
        let phase = omega * (since - 2.0 * fall);
        let y = sag * (phase.cos() - 1.0) - speed / omega * phase.sin();
        [y, -sag * omega * phase.sin() - speed * phase.cos()]
    };
    are_those_of(text, &[1.0, 1e5, 1.1], motion, &[]);
}

/// A motion with states that change at instants is not followed from event to event: its derivatives depend on the
/// steps behind the first contact, and that is reported.
#[test]
fn motions_without_event_following_are_reported() {
    let text = |floor: f64| {
        format!(
            "
parameters: {{ h: {{ value: 1 m, tolerance: 2% }} }}
bodies: {{ ball: {{ mass: 1, coordinates: [y] }} }}
effects:
  weight: {{ gravity: {{ acceleration: [0, -9.81] }} }}
  floor: {{ force: {{ on: ball, value: [0, \"1e5 N/m*max({floor} m - ball.y, 0 m)\"] }} }}
  seen: {{ sampled: {{ input: ball.y, period: 0.1 s }} }}
initial: {{ ball.y: h, ball.vy: 0 }}
outputs: {{ y: ball.y, v: ball.vy }}
simulation: {{ duration: 1, step: 1e-4, output_step: 0.05 }}
"
        )
    };
    let unreliable_from = |floor: f64| model_of(&text(floor)).gradients().unwrap().unreliable_from;
    // It falls for 0.4515 s.
    assert_eq!(unreliable_from(0.0), Some(0.5));
    assert_eq!(unreliable_from(-10.0), None);
}
