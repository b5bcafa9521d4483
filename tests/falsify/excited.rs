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
    excited(random, [0, 2])
}

/// The same of functions with a mean, an energy, or a band.
fn class(random: &mut Random) -> Drawn {
    excited(random, [3, 6])
}

fn excited(random: &mut Random, [least, most]: [usize; 2]) -> Drawn {
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
    let class = random.whole(least, most);
    let full = digits(row * rows as f64, 12);
    let mean = if class == 3 { digits(random.between(-0.8, 0.8), 2) } else { 0.0 };
    let energy = if class > 3 { digits(full * random.scale(0.05, 0.8), 3) } else { 0.0 };
    let band = match class {
        6 => {
            let from = if random.chance(0.3) { 0.0 } else { digits(random.scale(0.2, 2.0) * turns / duration, 3) };
            [from, digits(from + random.scale(0.2, 2.0) * turns / duration, 3)]
        }
        _ => [0.0; 2],
    };
    // The first order of the steps shows where a kernel ends with a jump, along which energy is spent.
    let steps = if by_speed && matches!(class, 4 | 5) { 5 * steps } else { steps };
    let limits = match class {
        0 => "within: ± 1".to_owned(),
        1 => format!("within: ± 1, held: {held:?}"),
        2 => "rate: 1".to_owned(),
        3 => format!("within: ± 1, mean: {mean:?}"),
        4 => format!("energy: {energy:?} s"),
        5 => format!("within: ± 1, energy: {energy:?} s"),
        _ => format!("within: ± 1, band: {band:?}"),
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
    let kernel_of_mean = kernel.clone();
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
            4 => (energy * (0..POINTS).map(|index| at(index) * at(index) / h).sum::<f64>()).sqrt(),
            5 => with_energy(energy, h, &(0..POINTS).map(|index| at(index) / h).collect::<Vec<f64>>()),
            6 => largest_sine(band, h, &(0..POINTS).map(at).collect::<Vec<f64>>()),
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
    // The ends of a function with a mean are not symmetrical: its values after a row may make up for those before it.
    let of_mean = move |time: f64, sign: f64| {
        let h = time / POINTS as f64;
        let values: Vec<f64> = (0..POINTS).map(|index| sign * kernel_of_mean((index as f64 + 0.5) * h)).collect();
        let left = full - time;
        with_integral([mean * full - left, mean * full + left], h, values)
    };
    let ends = move |time: f64| -> [f64; 2] {
        if time == 0.0 {
            return [0.0; 2];
        }
        if class == 3 { [-of_mean(time, -1.0), of_mean(time, 1.0)] } else { [-reach(time), reach(time)] }
    };
    let size = ends(full).iter().fold(0.0, |most: f64, end| most.max(end.abs())) * factor[1];
    let truth = move |time: f64| {
        let [lower, upper] = ends(time);
        let [least, most] = factor;
        Range { lower: (least * lower).min(most * lower), upper: (least * upper).max(most * upper) }
    };
    Drawn { yaml, output: "o", truth: Box::new(truth), rounding: ACCURACY * size }
}

/// max ∫ hu with |u| ≤ 1 and ∫ u between two, of values of h at points that are `step` apart.
fn with_integral([least, most]: [f64; 2], step: f64, mut values: Vec<f64>) -> f64 {
    values.sort_by(|a, b| b.total_cmp(a));
    // u is 1 down to some value of h, and −1 below it: at best to the last positive one, if it may be there.
    let whole = values.len() as f64 * step;
    let positive = values.iter().filter(|value| **value > 0.0).count() as f64;
    let share = ((2.0 * positive * step - whole).clamp(least.max(-whole), most.min(whole)) + whole) / (2.0 * step);
    let u = |index: usize| 2.0 * (share - index as f64).clamp(0.0, 1.0) - 1.0;
    values.iter().enumerate().map(|(index, value)| step * value * u(index)).sum()
}

/// max ∫ hu with |u| ≤ 1 and ∫ u² ≤ E: u = λh, cut off.
fn with_energy(energy: f64, step: f64, values: &[f64]) -> f64 {
    let u = |factor: f64, value: f64| (factor * value).clamp(-1.0, 1.0);
    let spent = |factor: f64| values.iter().map(|value| step * u(factor, *value).powi(2)).sum::<f64>();
    let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let (mut from, mut to) = (0.0, 1e9 / largest);
    for _ in 0..80 {
        // Factors range over many orders.
        let middle = if from == 0.0 { 1e-6 * to } else { (from * to).sqrt() };
        if spent(middle) < energy {
            from = middle
        } else {
            to = middle
        }
        if from == 0.0 && to < 1e-12 / largest {
            break;
        }
    }
    values.iter().map(|value| step * value * u(to, *value)).sum()
}

/// max |∫ h exp(iωτ)| over a band, by ever finer grids.
fn largest_sine([mut from, mut to]: [f64; 2], step: f64, parts: &[f64]) -> f64 {
    let size = |frequency: f64| {
        let turn = TAU * frequency * step;
        let sums = parts.iter().enumerate().fold([0.0; 2], |[sine, cosine], (index, part)| {
            let angle = turn * (index as f64 + 0.5);
            [sine + part * angle.sin(), cosine + part * angle.cos()]
        });
        sums[0].hypot(sums[1])
    };
    let mut best = 0.0_f64;
    let mut count = 8.0 * ((to - from) * step * parts.len() as f64).ceil().max(1.0);
    for _ in 0..3 {
        let all: Vec<(f64, f64)> = (0..=count as usize)
            .map(|number| from + (to - from) * number as f64 / count)
            .map(|frequency| (size(frequency), frequency))
            .collect();
        let (largest, at) = all.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, from));
        let width = (to - from) / count;
        best = best.max(largest);
        (from, to, count) = ((at - width).max(from), (at + width).min(to), 10.0);
    }
    best
}

/// Ends over functions with a mean, an energy, or a band.
pub fn classes(seed: u64, draws: u64) -> Tally {
    rows::compare(seed, draws, class)
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
