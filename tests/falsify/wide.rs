//! Bounds of many parameters against the truth: an oscillator whose stiffness and start are sums over 6 to 40
//! parameters, alone or in pairs, so that their ranges are closed forms. Some rise along a parameter, some have their
//! extreme inside, and some are saddles or products, whose gradient vanishes in the middle of the box.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::random::Random;
use crate::rows::{self, Drawn, Tally};
use crate::truth::Range;

/// Share of the values for rounding, and for the error of steps, which is at most 1e-8 of the run.
const ROUNDING: f64 = 1e-6;

/// A sum over parameters from −1 to 1.
#[derive(Default)]
struct Sum {
    terms: Vec<String>,
    range: [f64; 2],
}

impl Sum {
    /// Adds a term of parameters number `next` and, some, the one after; returns how many it takes.
    fn add(&mut self, random: &mut Random, next: usize, room: usize) -> usize {
        let (a, c) = (random.scale(0.2, 1.0), random.between(-0.8, 0.8));
        let (p, q) = (format!("p{next}"), format!("p{}", next + 1));
        let far = a * (1.0 + c.abs()).powi(2);
        let kind = if room < 2 { random.whole(0, 2) } else { random.whole(0, 5) };
        let (term, range, taken) = match kind {
            0 => (format!("{a:?}*{p}"), [-a, a], 1),
            1 => (format!("{a:?}*({p} - ({c:?}))^2"), [0.0, far], 1),
            2 => (format!("-{a:?}*({p} - ({c:?}))^2"), [-far, 0.0], 1),
            3 => (format!("{a:?}*({p}^2 - {q}^2)"), [-a, a], 2),
            4 => (format!("{a:?}*{p}*{q}"), [-a, a], 2),
            // At corners: ± a ± c, in all four ways.
            _ => (format!("{a:?}*{p}*{q} + ({c:?})*{p}"), [-a - c.abs(), a + c.abs()], 2),
        };
        self.terms.push(format!("({term})"));
        self.range = [self.range[0] + range[0], self.range[1] + range[1]];
        taken
    }
}

/// A model, and its output's range at a time.
struct Draw {
    yaml: String,
    stiffness: Range,
    start: Range,
}

const MASS: f64 = 2.0;
const STIFFNESS: f64 = 50.0;
/// Largest shares by which stiffness and start change.
const SHARES: [f64; 2] = [0.2, 0.3];

impl Draw {
    fn new(random: &mut Random) -> Self {
        let count = random.whole(6, 40);
        let turns = random.scale(0.2, 2.0);
        let mut sums = [Sum::default(), Sum::default()];
        let mut next = 0;
        while next < count {
            // Both have a term before either has its second.
            let which = if next < 4 { usize::from(next > 1) } else { random.whole(0, 1) };
            next += sums[which].add(random, next, count - next);
        }
        let parts = sums.each_ref().map(|sum| sum.terms.join(" + "));
        let scales: Vec<f64> =
            sums.iter().zip(SHARES).map(|(sum, share)| share / sum.range[0].abs().max(sum.range[1].abs())).collect();
        let of = |which: usize, nominal: f64| {
            let [lower, upper] = sums[which].range.map(|end| nominal * (1.0 + scales[which] * end));
            Range { lower, upper }
        };
        let parameters: String = (0..count).map(|own| format!("  p{own}: {{ interval: [-1, 1] }}\n")).collect();
        let duration = turns * TAU / (STIFFNESS / MASS).sqrt();
        let (row, step) = (duration / 10.0, duration / 400.0);
        let yaml = format!(
            "parameters:
{parameters}  k: {STIFFNESS}*(1 + {}*({}))
  x: 0.1*(1 + {}*({}))
bodies: {{ b: {{ mass: {MASS}, coordinates: [x] }} }}
effects: {{ s: {{ force: {{ on: b, value: [\"-k*b.x*(1 N/m)\", 0] }} }} }}
initial: {{ b.x: x*(1 m), b.vx: 0 }}
outputs: {{ x: b.x }}
simulation: {{ duration: {duration:?}, step: {step:?}, output_step: {row:?} }}
bounds: {{ tolerance: 2e-2 }}
",
            scales[0], parts[0], scales[1], parts[1]
        );
        Self { yaml, stiffness: of(0, STIFFNESS), start: of(1, 0.1) }
    }

    /// x cos(√(k/m) t) for all stiffnesses and starts, which depend on different parameters.
    fn truth(&self, time: f64) -> Range {
        let angle = self.stiffness.map(|k| (k / MASS).sqrt() * time + FRAC_PI_2);
        // Whether the sine is 1 somewhere at `peak` + 2πn.
        let reaches = |peak: f64| ((angle.lower - peak) / TAU).ceil() <= ((angle.upper - peak) / TAU).floor();
        let ends = angle.map(f64::sin);
        let lower = if reaches(-FRAC_PI_2) { -1.0 } else { ends.lower };
        let upper = if reaches(FRAC_PI_2) { 1.0 } else { ends.upper };
        let products = [lower, upper].map(|cosine| self.start.map(|start| start * cosine));
        Range { lower: products[0].lower.min(products[1].lower), upper: products[0].upper.max(products[1].upper) }
    }
}

/// Draws and compares.
pub fn compare(seed: u64, draws: u64) -> Tally {
    rows::compare(seed, draws, |random| {
        let draw = Draw::new(random);
        Drawn {
            yaml: draw.yaml.clone(),
            output: "x",
            truth: Box::new(move |time| draw.truth(time)),
            rounding: ROUNDING * 0.13,
        }
    })
}
