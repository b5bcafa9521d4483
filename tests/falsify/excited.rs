//! Oscillators under functions of the time of which only limits, or a spectrum, are known, against integrals of their
//! closed forms.

use std::f64::consts::TAU;

use crate::families::decay;
use crate::random::{Random, digits};
use crate::rows::{self, Drawn, Tally};
use crate::truth::Range;

/// Points of the integrals of a motion, and of a spectrum.
const POINTS: usize = 20_000;

/// Accuracy of the integrals.
const ACCURACY: f64 = 1e-5;

/// The lower and upper end of an interval about one.
fn about_one(random: &mut Random) -> [f64; 2] {
    let half = if random.chance(0.5) { 0.0 } else { random.between(0.01, 0.3) };
    [1.0 - half, 1.0 + half].map(|end| digits(end, 3))
}

fn interval(name: &str, [lower, upper]: [f64; 2]) -> String {
    if lower < upper {
        format!("  {name}: {{ interval: [{lower:?}, {upper:?}] }}\n")
    } else {
        format!("  {name}: {lower:?}\n")
    }
}

/// One to three oscillators x″ + 2δx′ + ω²x = a b u under one function; the output is the sum of positions, or of
/// velocities.
fn function(random: &mut Random) -> Drawn {
    let count = random.whole(1, 3);
    let rows = random.whole(4, 12);
    let duration = random.scale(0.5, 20.0);
    let row = digits(duration / rows as f64, 3);
    let turns = random.scale(0.2, 5.0);
    let oscillators: Vec<[f64; 3]> = (0..count)
        .map(|_| {
            let omega = turns * random.scale(0.3, 1.0) * TAU / duration;
            let delta = random.scale(0.003, 0.8) * omega;
            [digits(omega * omega, 4), digits(delta, 4), random.between(-1.0, 1.0)]
        })
        .collect();
    let steps = random.whole(20, 60) * (1 + (turns / rows as f64) as usize);
    let by_speed = random.chance(0.4);
    let factor = about_one(random);
    let held = digits(row * f64::from(random.pick(&[1, 2, 3])) / random.pick(&[1.0, 2.0]), 6);
    let class = random.whole(0, 2);
    let limits = match class {
        0 => "within: ± 1".to_owned(),
        1 => format!("within: ± 1, held: {held:?}"),
        _ => "rate: 1".to_owned(),
    };
    let mut yaml = format!("parameters:\n{}excitations: {{ u: {{ {limits} }} }}\nbodies:\n", interval("b", factor));
    for place in 0..count {
        yaml += &format!("  m{place}: {{ mass: 1, coordinates: [x] }}\n");
    }
    yaml += "effects:\n";
    for (place, [square, delta, a]) in oscillators.iter().enumerate() {
        let damping = 2.0 * delta;
        yaml += &format!(
            "  f{place}: {{ force: {{ on: m{place}, value: [\"({a:?})*b*u - {square:?}*m{place}.x - {damping:?}*m{place}.vx\", 0] }} }}\n"
        );
    }
    let starts: Vec<String> = (0..count).map(|place| format!("m{place}.x: 0, m{place}.vx: 0")).collect();
    let quantity = if by_speed { "vx" } else { "x" };
    let sum: Vec<String> = (0..count).map(|place| format!("m{place}.{quantity}")).collect();
    yaml += &format!(
        "initial: {{ {} }}\noutputs: {{ o: {} }}\nsimulation: {{ duration: {:?}, step: {:?}, output_step: {row:?} }}\nbounds: {{ chebyshev: {{ order: 3 }} }}\n",
        starts.join(", "),
        sum.join(" + "),
        digits(row * rows as f64, 12),
        row / steps as f64
    );
    let kernel = move |t: f64| -> f64 {
        let one = |[square, delta, a]: &[f64; 3]| a * decay(*square, *delta, 0.0, 1.0, t)[usize::from(by_speed)];
        oscillators.iter().map(one).sum()
    };
    let reach = move |time: f64| {
        let h = time / POINTS as f64;
        let at = |index: usize| h * kernel((index as f64 + 0.5) * h);
        match class {
            0 => (0..POINTS).map(|index| at(index).abs()).sum::<f64>(),
            // Periods count from the start, the kernel from the end; a point belongs to the period of its middle.
            1 => {
                let mut sums = vec![0.0; (time / held) as usize + 2];
                // The ends of periods lie between points: those are divided.
                for index in 0..POINTS {
                    let (from, to) = (time - (index + 1) as f64 * h, time - index as f64 * h);
                    let cut = (to / held + 1e-9).floor() * held;
                    let share = if cut > from { (to - cut) / h } else { 1.0 };
                    sums[((to - 0.5 * share * h) / held) as usize] += share * at(index);
                    sums[(from.max(0.0) / held) as usize] += (1.0 - share) * at(index);
                }
                sums.iter().map(|sum: &f64| sum.abs()).sum()
            }
            _ => {
                let mut response = 0.0;
                let rising = (0..POINTS).map(|index| {
                    let own = at(index);
                    response += own;
                    h * (response - 0.5 * own).abs()
                });
                rising.sum()
            }
        }
    };
    let size = reach(digits(row * rows as f64, 12)) * factor[1];
    let truth = move |time: f64| {
        let end = factor[1] * reach(time);
        Range { lower: -end, upper: end }
    };
    Drawn { yaml, output: "o", truth: Box::new(truth), rounding: ACCURACY * size }
}

/// Ends over functions.
pub fn functions(seed: u64, draws: u64) -> Tally {
    rows::compare(seed, draws, function)
}

/// Root mean square of an oscillator's position or acceleration under a random force.
fn square(random: &mut Random) -> Drawn {
    let frequency = random.scale(0.5, 20.0);
    let omega = TAU * frequency;
    let stiffness = digits(omega * omega, 4);
    let damping = digits(2.0 * random.scale(0.005, 1.5) * omega, 3);
    let (level, wear) = (about_one(random), about_one(random));
    let by_acceleration = random.chance(0.5);
    let band = [random.scale(0.02, 0.5) * frequency, random.scale(2.0, 50.0) * frequency].map(|end| digits(end, 3));
    let corner = digits(frequency * random.scale(0.2, 5.0), 3);
    let ratio = random.scale(0.01, 1.0);
    let speed = random.between(5.0, 40.0);
    let kind = random.whole(0, 4);
    let [from, to] = band;
    let between = digits((from * to).sqrt(), 3);
    let spectrum = match kind {
        0 => format!("white: level, band: [{from:?}, {to:?}]"),
        1 => format!("white: level, band: [{from:?}, {to:?}], filter: {{ frequency: {corner:?} }}"),
        2 => format!("white: level, band: [{from:?}, {to:?}], filter: {{ frequency: {corner:?}, damping: {ratio:?} }}"),
        3 => format!("road: level, speed: {speed:?}, band: [{:?}, {:?}]", from / speed, to / speed),
        _ => format!("density: [[{from:?}, 0.5], [{between:?}, 2], [{to:?}, 1]]"),
    };
    let density = move |f: f64| match kind {
        0 => 1.0,
        1 => 1.0 / (1.0 + (f / corner).powi(2)),
        2 => 1.0 / ((1.0 - (f / corner).powi(2)).powi(2) + (2.0 * ratio * f / corner).powi(2)),
        3 => (0.1 * speed / f).powi(2) / speed,
        _ => {
            let (a, b, low, high) = if f < between { (from, between, 0.5, 2.0) } else { (between, to, 2.0, 1.0) };
            low * f64::powf(high / low, (f / a).ln() / (b / a).ln())
        }
    };
    let quantity = if by_acceleration { "ax" } else { "x" };
    // A table has no level.
    let factor = match kind {
        3 => "(1 N/m)*",
        4 => "level*",
        _ => "",
    };
    let yaml = format!(
        "analysis: modes
parameters:
{}{}excitations: {{ u: {{ random: {{ {spectrum} }} }} }}
bodies: {{ m: {{ mass: 1, coordinates: [x] }} }}
effects: {{ f: {{ force: {{ on: m, value: [\"{factor}u - {stiffness:?}*m.x - {damping:?}*wear*m.vx\", 0] }} }} }}
outputs: {{ o: m.{quantity} }}
bounds: {{ chebyshev: {{ order: 6 }} }}
",
        interval("level", level),
        interval("wear", wear)
    );
    let rms = move |level: f64, wear: f64| {
        let factor = (to / from).ln() / POINTS as f64;
        let at = |index: usize| {
            let f = from * ((index as f64 + 0.5) * factor).exp();
            let w = TAU * f;
            let response = (stiffness - w * w).powi(2) + (damping * wear * w).powi(2);
            let size = if by_acceleration { w.powi(4) } else { 1.0 };
            f * factor * density(f) * size / response
        };
        let level = if kind == 4 { level * level } else { level };
        (level * (0..POINTS).map(at).sum::<f64>()).sqrt()
    };
    let truth = Range { lower: rms(level[0], wear[1]), upper: rms(level[1], wear[0]) };
    Drawn { yaml, output: "o.rms", truth: Box::new(move |_| truth), rounding: ACCURACY * truth.upper }
}

/// Root mean squares.
pub fn squares(seed: u64, draws: u64) -> Tally {
    rows::compare(seed, draws, square)
}
