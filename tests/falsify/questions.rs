//! Answers of other analyses against the truth: shares that fail, and tolerances that are allocated.

use std::fmt::{self, Display, Formatter, Write};

use mbint::Model;
use mbint::results::Criterion;

use crate::random::{Random, digits};

/// Counts of the outcomes of a question's draws.
#[derive(Default)]
pub struct Tally {
    pub draws: usize,
    /// The stated answer misses the truth.
    pub missed: usize,
    /// Nothing is stated.
    pub open: usize,
}

impl Display for Tally {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        write!(f, "{} of {} draws are missed, {} have no answer", self.missed, self.draws, self.open)
    }
}

/// A requirement of independent normal deviations, and the share of them that fails it.
struct Share {
    yaml: String,
    fails: f64,
}

/// The share of the normal law beyond z, by Simpson's rule.
fn tail(z: f64) -> f64 {
    let (steps, reach) = (2000, 12.0);
    let h = reach / f64::from(steps);
    let density = |x: f64| (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let inner = (0..=steps).map(|i| {
        let weight = if i == 0 || i == steps { 1.0 } else { 2.0 * f64::from(1 + i % 2) };
        weight * density(z + h * f64::from(i))
    });
    inner.sum::<f64>() * h / 3.0
}

/// The probability that a sum of squares of normal variables, even in number, exceeds a limit: Poisson's distribution.
fn above(squares: usize, limit: f64) -> f64 {
    let half = 0.5 * limit;
    let mut term = 1.0;
    let mut sum = 0.0;
    for i in 0..squares / 2 {
        sum += term;
        term *= half / (i + 1) as f64;
    }
    sum * (-half).exp()
}

/// Argument at which a falling function has a value, by bisection.
fn solve(f: impl Fn(f64) -> f64, value: f64, mut lower: f64, mut upper: f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (lower + upper);
        if f(middle) > value { lower = middle } else { upper = middle }
    }
    0.5 * (lower + upper)
}

/// A set that surrounds the middle: outside of a sphere, beyond two planes, or outside of a box, in up to twenty
/// directions.
fn share(random: &mut Random) -> Share {
    let wanted = random.scale(1e-8, 3e-3);
    let kind = random.whole(0, 2);
    let count = if kind == 0 { 2 * random.whole(1, 10) } else { random.whole(1, 20) };
    let deviation = random.scale(0.01, 0.3);
    let (mut parameters, mut bodies, mut initial) = (String::new(), Vec::new(), Vec::new());
    for i in 0..count {
        let tolerance = 3.0 * deviation;
        writeln!(
            parameters,
            "  p{i}: {{ value: 1, tolerance: {tolerance:?}, distribution: {{ normal: {{ sigma: {deviation:?} }} }} }}"
        )
        .unwrap();
        bodies.push(format!("b{i}: {{ mass: 1, coordinates: [x] }}"));
        initial.push(format!("b{i}.x: p{i}, b{i}.vx: 0"));
    }
    let score = |i: usize| format!("(b{i}.x - 1)/{deviation:?}");
    let scores = (0..count).map(score);
    let (outputs, requirements, fails) = match kind {
        0 => {
            let limit = digits(solve(|limit| above(count, limit), wanted, 0.0, 200.0), 4);
            let squares: Vec<String> = scores.map(|score| format!("({score})^2")).collect();
            (format!("f: {}", squares.join(" + ")), format!("ok: f <= {limit:?}"), above(count, limit))
        }
        1 => {
            let z = digits(solve(|z| 2.0 * tail(z), wanted, 0.0, 10.0), 4);
            let signed = scores.map(|score| format!("{}{score}", random.pick(&["+ ", "- "])));
            let sum = signed.collect::<Vec<_>>().join(" ");
            let limit = z * (count as f64).sqrt();
            let both = format!("ok: {{ output: f, min: {:?}, max: {limit:?} }}", -limit);
            (format!("f: 0 {sum}"), both, 2.0 * tail(z))
        }
        _ => {
            let all = |z: f64| 1.0 - (1.0 - 2.0 * tail(z)).powi(count as i32);
            let z = digits(solve(all, wanted, 0.0, 10.0), 4);
            let each = scores.enumerate().map(|(i, score)| format!("f{i}: {score}"));
            let limits = (0..count).map(|i| format!("ok{i}: {{ output: f{i}, min: {:?}, max: {z:?} }}", -z));
            // In digits that a difference from one still has.
            let fails = -(count as f64 * (-2.0 * tail(z)).ln_1p()).exp_m1();
            (each.collect::<Vec<_>>().join(", "), limits.collect::<Vec<_>>().join(", "), fails)
        }
    };
    let (bodies, initial) = (bodies.join(", "), initial.join(", "));
    // With more parameters a full grid is refused, though each body has but one.
    let bounds = if count <= 8 { "chebyshev: { order: 4 }" } else { "tolerance: 1e-4" };
    let yaml = format!(
        "model: share
parameters:
{parameters}bodies: {{ {bodies} }}
initial: {{ {initial} }}
outputs: {{ {outputs} }}
requirements: {{ {requirements} }}
statistics: {{ quantiles: [50%] }}
simulation: {{ duration: 0.1, step: 0.1, output_step: 0.1 }}
bounds: {{ {bounds} }}
"
    );
    Share { yaml, fails }
}

/// Intervals of shares that fail, of 95 % each.
pub fn shares(seed: u64, draws: u64) -> Tally {
    let mut tally = Tally::default();
    for number in 0..draws {
        let Share { yaml, fails } = share(&mut Random::new(seed, number));
        let result = Model::from_yaml_str("share", &yaml).unwrap().study().allow_costly().run();
        let result = result.unwrap_or_else(|error| panic!("draw {number}: {error}\n{yaml}"));
        let statistics = &result.summary().statistics.as_ref().expect("the model asks for them").summary;
        let stated = statistics.together.as_ref().or(statistics.requirements.first());
        tally.draws += 1;
        let Some([lower, upper]) = stated.map(|stated| stated.ppm_interval).filter(|ends| !ends[0].is_nan()) else {
            tally.open += 1;
            continue;
        };
        if !(lower..=upper).contains(&(1e6 * fails)) {
            tally.missed += 1;
            println!("# share {number}: {:.4e} ppm fail, {lower:.4e} to {upper:.4e} are stated\n{yaml}", 1e6 * fails);
        }
    }
    tally
}

/// A sum of f(d) = a d − b d² over independent deviations d, between two limits.
struct Allocated {
    yaml: String,
    /// a, b, the model's tolerance and its cost there, of each.
    terms: Vec<[f64; 4]>,
    least: f64,
    most: f64,
}

/// Widest tolerances of the search, as multiples of the model's.
const WIDEST: f64 = 3.0;

/// The largest and the smallest value for |d| ≤ t.
fn ends(a: f64, b: f64, t: f64) -> [f64; 2] {
    let apex = 0.5 * a / b;
    let at = t.min(apex);
    [a * at - b * at * at, -a * t - b * t * t]
}

impl Allocated {
    /// The apex of each parabola, the worst case above, is at 0.3 to 4 times the tolerance.
    fn draw(random: &mut Random) -> Self {
        let count = random.whole(1, 3);
        let terms: Vec<[f64; 4]> = (0..count)
            .map(|_| {
                let (slope, tolerance) = (random.scale(0.3, 3.0), random.scale(0.01, 0.2));
                let bend = digits(0.5 * slope / (tolerance * random.scale(0.3, 4.0)), 3);
                [slope, bend, tolerance, random.scale(0.5, 5.0)]
            })
            .collect();
        let sum = |side: usize, at: f64| terms.iter().map(|[a, b, t, _]| ends(*a, *b, at * t)[side]).sum::<f64>();
        let most = digits(sum(0, WIDEST) * random.scale(0.3, 1.2), 3);
        let least = digits(sum(1, WIDEST) * random.scale(0.2, 1.2), 3);
        let (mut parameters, mut bodies, mut initial, mut parts) = (String::new(), vec![], vec![], vec![]);
        for (i, [a, b, t, cost]) in terms.iter().enumerate() {
            let own = format!("{{ value: 1, tolerance: {t:?}, cost: {{ reciprocal: {cost:?} }} }}");
            writeln!(parameters, "  p{i}: {own}").unwrap();
            bodies.push(format!("b{i}: {{ mass: 1, coordinates: [x] }}"));
            initial.push(format!("b{i}.x: p{i}, b{i}.vx: 0"));
            parts.push(format!("{a:?}*(b{i}.x - 1) - {b:?}*(b{i}.x - 1)^2"));
        }
        let (bodies, initial, parts) = (bodies.join(", "), initial.join(", "), parts.join(" + "));
        let yaml = format!(
            "model: allocated
parameters:
{parameters}bodies: {{ {bodies} }}
initial: {{ {initial} }}
outputs: {{ f: {parts} }}
requirements: {{ ok: {{ output: f, min: {least:?}, max: {most:?} }} }}
simulation: {{ duration: 0.2, step: 0.1, output_step: 0.1 }}
bounds: {{ chebyshev: {{ order: 5 }} }}
"
        );
        Self { yaml, terms, least, most }
    }

    /// Whether every case within these tolerances is between the limits, up to a share of them.
    fn is_met(&self, tolerances: &[f64], slack: f64) -> bool {
        let sum =
            |side: usize| self.terms.iter().zip(tolerances).map(|([a, b, ..], t)| ends(*a, *b, *t)[side]).sum::<f64>();
        sum(0) <= self.most * (1.0 + slack) && sum(1) >= self.least * (1.0 + slack)
    }

    fn cost(&self, tolerances: &[f64]) -> f64 {
        self.terms.iter().zip(tolerances).map(|([_, _, t, cost], own)| cost * t / own).sum()
    }

    /// The least cost, by nested grids that close in on the cheapest multiples.
    fn cheapest(&self) -> f64 {
        const POINTS: usize = 24;
        let count = self.terms.len();
        let mut boxes = vec![[0.01_f64, WIDEST]; count];
        let (mut best, mut at) = (f64::INFINITY, vec![0.01; count]);
        for _ in 0..12 {
            for number in 0..POINTS.pow(count as u32) {
                let of_axis = |axis: usize| {
                    let i = number / POINTS.pow(axis as u32) % POINTS;
                    let [a, b] = boxes[axis];
                    a * (b / a).powf(i as f64 / (POINTS - 1) as f64)
                };
                let multiples: Vec<f64> = (0..count).map(of_axis).collect();
                let tolerances: Vec<f64> = multiples.iter().zip(&self.terms).map(|(own, term)| own * term[2]).collect();
                let cost = self.cost(&tolerances);
                if cost < best && self.is_met(&tolerances, 0.0) {
                    (best, at) = (cost, multiples);
                }
            }
            for (own, at) in boxes.iter_mut().zip(&at) {
                let ratio = (own[1] / own[0]).powf(0.2);
                *own = [(at / ratio).max(0.01), (at * ratio).min(WIDEST)];
            }
        }
        best
    }
}

/// A cost above the cheapest by less than this share is no fault: tolerances have four digits, and margins have errors.
const DEARER: f64 = 0.02;

/// Allocations with worst cases inside of the box: numbers, that meet the requirement, as cheap as can be.
pub fn allocations(seed: u64, draws: u64) -> Tally {
    let mut tally = Tally::default();
    for number in 0..draws {
        let draw = Allocated::draw(&mut Random::new(seed, number));
        let model = Model::from_yaml_str("allocated", &draw.yaml).unwrap();
        let found = model.study().allocate(Criterion::WorstCase, WIDEST);
        let found = found.unwrap_or_else(|error| panic!("draw {number}: {error}\n{}", draw.yaml));
        tally.draws += 1;
        let after: Vec<f64> = found.tolerances.iter().map(|own| own.after.above).collect();
        let shares = found.tolerances.iter().flat_map(|own| [own.share_before, own.share_after]);
        let points = found.trade.iter().chain(&found.trade_before).chain(&found.trade_after);
        let numbers = points.flat_map(|point| [point.margin, point.cost]).chain(shares).chain(after.iter().copied());
        let is_finite = numbers.into_iter().all(f64::is_finite);
        let cheapest = draw.cheapest();
        let is_right =
            !found.is_confirmed || (draw.is_met(&after, 1e-6) && draw.cost(&after) <= (1.0 + DEARER) * cheapest);
        tally.open += usize::from(!found.is_confirmed);
        if !is_finite || !is_right {
            tally.missed += 1;
            let (cost, yaml) = (draw.cost(&after), &draw.yaml);
            let is_met = draw.is_met(&after, 1e-6);
            println!(
                "# allocation {number}: {after:?} cost {cost:.6}, the cheapest {cheapest:.6}; met: {is_met}, numbers: {is_finite}\n{yaml}"
            );
        }
    }
    tally
}

#[cfg(test)]
mod tests {
    use super::{above, tail};

    /// Φ(−3) and Φ(−6) of tables; χ² of two degrees is exponential, and 18.47 the 99.9 % quantile of four.
    #[test]
    fn tails_match_tables() {
        let near = |found: f64, wanted: f64| assert!((found / wanted - 1.0).abs() < 1e-4, "{found} {wanted}");
        near(tail(3.0), 1.349_898e-3);
        near(tail(6.0), 9.865_876e-10);
        near(above(2, 9.0), (-4.5_f64).exp());
        near(above(4, 18.466_83), 1e-3);
    }
}
