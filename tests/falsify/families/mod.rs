//! Families of draws: mechanisms whose motion is known without mbint.

mod branches;
mod driven;
mod drives;
mod impacts;
mod linkages;
mod nonlinear;
mod oscillators;
mod pulses;
mod shapes;
mod slides;
mod stops;
mod swings;
mod tops;

pub use oscillators::decay;

use crate::draw::{Bounds, Combine, Curves, Draw, Output, Parameter, Stepping, Term, Time, Wrap};
use crate::random::Random;
use crate::{dop853, truth};

/// Index and time scale of a mechanism to be drawn.
pub struct Scale {
    /// Its index in the model: names end in it.
    pub place: usize,
    /// Step, s; with a tolerance, of the size that it leads to.
    pub step: f64,
    pub duration: f64,
}

/// A kind of draws.
pub struct Family {
    pub name: &'static str,
    draw: fn(&mut Random, &Frame) -> Vec<Term>,
    /// Whether outputs have kinks or many turns.
    wraps: bool,
    /// Tolerances of the simulation that may be drawn: those that do not take too long.
    tolerances: &'static [f64],
    /// Share of draws whose bounds are to a tolerance, not of an order.
    adaptive: f64,
    analysis: &'static str,
}

impl Family {
    /// Draws this family mostly for bounds to a tolerance.
    const fn adaptive(self) -> Self {
        Self { adaptive: 0.8, tolerances: &[1e-3, 1e-4], ..self }
    }
}

/// Time of a draw.
pub struct Frame {
    step: f64,
    duration: f64,
}

impl Frame {
    fn scale(&self, index: usize) -> Scale {
        Scale { place: index, step: self.step, duration: self.duration }
    }
}

const fn family(name: &'static str, draw: fn(&mut Random, &Frame) -> Vec<Term>) -> Family {
    Family { name, draw, wraps: false, tolerances: &[1e-3, 1e-4, 1e-5, 1e-6], adaptive: 0.12, analysis: "motion" }
}

pub const FAMILIES: &[Family] = &[
    family("oscillator", |random, frame| vec![oscillators::free(random, &frame.scale(0))]),
    family("sum", |random, frame| {
        let terms = random.whole(2, 4);
        (0..terms).map(|place| oscillators::free(random, &frame.scale(place))).collect()
    }),
    family("far", |random, frame| {
        let far = random.scale(1.0, 1e4);
        vec![oscillators::free_at(random, &frame.scale(0), far)]
    }),
    family("forced", |random, frame| vec![oscillators::forced(random, &frame.scale(0))]),
    Family {
        tolerances: &[1e-3, 1e-4],
        ..family("resonance", |random, frame| vec![oscillators::resonant(random, &frame.scale(0))])
    },
    Family {
        tolerances: &[],
        ..family("fast and slow", |random, frame| {
            vec![oscillators::free(random, &frame.scale(0)), oscillators::fast(random, &frame.scale(1))]
        })
    },
    Family {
        wraps: true,
        ..family("kinks", |random, frame| {
            let terms = random.whole(1, 2);
            (0..terms).map(|place| oscillators::free(random, &frame.scale(place))).collect()
        })
    },
    family("pulse", |random, frame| vec![pulses::pulse(random, &frame.scale(0))]),
    family("bounce", |random, frame| vec![impacts::bounce(random, &frame.scale(0))]),
    family("ceiling", |random, frame| vec![impacts::ceiling(random, &frame.scale(0))]),
    family("rotor", |random, frame| vec![drives::rotor(random, &frame.scale(0))]),
    family("driven crank", |random, frame| vec![drives::slider_crank(random, &frame.scale(0))]),
    family("driven four-bar", |random, frame| vec![drives::four_bar(random, &frame.scale(0))]),
    family("friction", |random, frame| vec![slides::friction(random, &frame.scale(0))]),
    family("drag", |random, frame| vec![slides::drag(random, &frame.scale(0))]),
    family("pendulum", |random, frame| vec![swings::pendulum(random, &frame.scale(0))]),
    family("double pendulum", |random, frame| vec![swings::double_pendulum(random, &frame.scale(0))]),
    family("spring pendulum", |random, frame| vec![swings::spring_pendulum(random, &frame.scale(0))]),
    family("coupled", |random, frame| vec![nonlinear::coupled(random, &frame.scale(0))]),
    family("parametric", |random, frame| vec![nonlinear::parametric(random, &frame.scale(0))]),
    family("stick-slip", |random, frame| vec![nonlinear::stick_slip(random, &frame.scale(0))]),
    family("post", |random, frame| vec![nonlinear::post(random, &frame.scale(0))]),
    family("ratchet", |random, frame| vec![stops::ratchet(random, &frame.scale(0))]),
    family("clearance", |random, frame| vec![stops::clearance(random, &frame.scale(0))]),
    family("slider crank", |random, frame| vec![linkages::slider_crank(random, &frame.scale(0))]),
    family("four-bar", |random, frame| vec![linkages::four_bar(random, &frame.scale(0))]),
    Family { tolerances: &[1e-3, 1e-4], ..family("top", |random, frame| vec![tops::top(random, &frame.scale(0))]) },
    family("bump", |random, frame| vec![shapes::bump(random, &frame.scale(0))]).adaptive(),
    family("ridge", |random, frame| vec![shapes::ridge(random, &frame.scale(0))]).adaptive(),
    family("corner", |random, frame| vec![shapes::corner(random, &frame.scale(0))]).adaptive(),
    family("ring", |random, frame| vec![shapes::ring(random, &frame.scale(0))]).adaptive(),
    family("stack", |random, frame| vec![shapes::stack(random, &frame.scale(0))]).adaptive(),
    family("many", |random, frame| {
        let terms = random.whole(5, 8);
        (0..terms).map(|place| oscillators::free(random, &frame.scale(place))).collect()
    })
    .adaptive(),
    family("tuned", |random, frame| vec![oscillators::resonant(random, &frame.scale(0))]).adaptive(),
    family("hardening", |random, frame| vec![driven::hardening(random, &frame.scale(0))]).adaptive(),
    family("driven pendulum", |random, frame| vec![driven::pendulum(random, &frame.scale(0))]).adaptive(),
    Family {
        tolerances: &[],
        adaptive: 0.4,
        analysis: "kinematics",
        ..family("change point", |random, frame| vec![branches::change_point(random, &frame.scale(0))])
    },
];

/// The draw of a number; families take turns.
pub fn draw(seed: u64, number: u64, only: Option<&str>) -> Draw {
    let mut random = Random::new(seed, number);
    let chosen: Vec<&Family> =
        FAMILIES.iter().filter(|family| only.is_none_or(|name| family.name.starts_with(name))).collect();
    assert!(!chosen.is_empty(), "there is no such family");
    let family = chosen[number as usize % chosen.len()];

    let rows = random.whole(20, 50);
    let steps = random.whole(4, 40);
    let step = random.pick(&[1.0, 2.0, 5.0]) * random.pick(&[1e-4, 1e-3, 1e-2]);
    let row = crate::random::digits(step * steps as f64, 12);
    let time = Time { row, rows, stepping: Stepping::Steps(steps) };
    let frame = Frame { step, duration: time.duration() };
    let mut terms = (family.draw)(&mut random, &frame);
    let is_adaptive = family.adaptive > 0.5;
    make_uncertain(&mut random, &mut terms, is_adaptive);
    let outputs = observe(&mut random, family, &terms, &time);
    let mut draw =
        Draw { family: family.name, analysis: family.analysis, terms, outputs, time, bounds: Bounds::default() };
    draw.bounds = request(&mut random, draw.uncertain_count(), family.adaptive);
    if !family.tolerances.is_empty() && random.chance(0.15) {
        draw.time.stepping = Stepping::Tolerance(random.pick(family.tolerances));
    }
    draw
}

/// Gives one to four parameters an interval, at least one of every term but those that have none to give; wide ones,
/// and up to the number of terms, if a surrogate is to find its own degree.
fn make_uncertain(random: &mut Random, terms: &mut [Term], is_adaptive: bool) {
    let wanted = random.pick(&[1, 1, 1, 1, 1, 2, 2, 2, 3, 4]);
    let wide = is_adaptive || random.chance(0.5);
    let limit = terms.len().max(4);
    let mut count = 0;
    for round in 0..4 {
        for term in &mut *terms {
            let possible =
                |parameter: &&mut Parameter| parameter.most > 0.0 && parameter.value != 0.0 && parameter.half == 0.0;
            let mut free: Vec<&mut Parameter> = term.parameters.iter_mut().filter(possible).collect();
            // Integrated terms are sampled on a grid.
            let full = term.integrated && round >= 2;
            if free.is_empty() || full || (round > 0 && count >= wanted) || count >= limit {
                continue;
            }
            let which = random.whole(0, free.len() - 1);
            let parameter = &mut free[which];
            let most = if wide { parameter.most } else { 0.1 * parameter.most };
            let least = if is_adaptive { 0.1 * most } else { most.min(1e-3) };
            let relative = random.scale(least, most);
            parameter.half = crate::random::digits(relative * parameter.value.abs(), 3);
            count += 1;
        }
    }
}

/// One or two outputs.
fn observe(random: &mut Random, family: &Family, terms: &[Term], time: &Time) -> Vec<Output> {
    let count = random.whole(1, 2);
    let times: Vec<f64> = (0..=time.rows).map(|row| row as f64 * time.row).collect();
    (0..count)
        .map(|_| {
            // The same of every term, so that units agree.
            let channels = terms.iter().map(|term| term.channels.len()).min().unwrap_or(1);
            let channel = random.whole(0, channels - 1);
            let inputs: Vec<_> = (0..terms.len()).map(|term| (term, channel)).collect();
            let mut output = Output { inputs, combine: Combine::Sum, wrap: Wrap::Nothing };
            if family.wraps {
                output.combine = random.pick(&[Combine::Sum, Combine::Max, Combine::Min, Combine::Product]);
                let draw = Draw {
                    family: family.name,
                    analysis: family.analysis,
                    terms: terms.to_vec(),
                    outputs: Vec::new(),
                    time: *time,
                    bounds: Bounds::default(),
                };
                output.wrap = wrap(random, &truth::nominal(&draw, &output, &times));
            }
            output
        })
        .collect()
}

/// A function with kinks or turns where the nominal output is.
fn wrap(random: &mut Random, nominal: &[f64]) -> Wrap {
    let lower = nominal.iter().copied().fold(f64::INFINITY, f64::min);
    let upper = nominal.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let inside = random.between(lower, upper.max(lower + 1e-9));
    let turns = random.scale(0.3, 30.0) / (upper - lower).max(1e-9);
    let sine = Wrap::Sine(crate::random::digits(turns, 3));
    random.pick(&[
        Wrap::Nothing,
        Wrap::Abs,
        Wrap::Square,
        Wrap::Above(inside),
        Wrap::Below(inside),
        Wrap::Distance(inside),
        sine,
    ])
}

/// Methods and orders that take at most a few hundred simulations.
fn request(random: &mut Random, uncertain: usize, adaptive: f64) -> Bounds {
    if random.chance(adaptive) || uncertain > 4 {
        // With few parameters now and then a scan in addition, which the band must not exclude.
        let scan = (adaptive > 0.5 && uncertain <= 2 && random.chance(0.3)).then(|| random.whole(5, 20));
        return Bounds { tolerance: Some(random.pick(&[1e-2, 1e-3, 1e-4])), scan, ..Bounds::default() };
    }
    let [most_order, most_degree, most_points] =
        [[20, 8, 40], [9, 5, 15], [4, 4, 6], [3, 3, 4]][uncertain.clamp(1, 4) - 1];
    Bounds {
        chebyshev: Some(random.whole(2, most_order)),
        expand_output: random.chance(0.2),
        taylor: Some(random.whole(1, most_degree)),
        scan: Some(random.whole(3, most_points)),
        tolerance: None,
    }
}

/// A parameter that may be uncertain by at most this share of its value.
fn parameter(name: &str, index: usize, value: f64, most: f64) -> Parameter {
    Parameter { name: format!("{name}{index}"), value, half: 0.0, most, removable: false }
}

/// One that may be 0 as well.
fn removable(name: &str, index: usize, value: f64, most: f64) -> Parameter {
    Parameter { removable: true, ..parameter(name, index, value, most) }
}

/// A formula with the index in place of `#`.
fn named(formula: &str, index: usize) -> String {
    formula.replace('#', &index.to_string())
}

fn lines(formulas: &[&str], index: usize) -> Vec<String> {
    formulas.iter().map(|formula| named(formula, index)).collect()
}

/// Curves from a closed form of all channels at one time.
fn closed_form<const N: usize>(at: impl Fn(&[f64], f64) -> [f64; N] + Send + Sync + 'static) -> Curves {
    std::sync::Arc::new(move |parameters, times| {
        let mut curves = vec![Vec::with_capacity(times.len()); N];
        for &t in times {
            for (curve, value) in curves.iter_mut().zip(at(parameters, t)) {
                curve.push(value);
            }
        }
        curves
    })
}

/// Error allowed in each step of a reference solution.
const TOLERANCE: f64 = 1e-12;

/// Curves of the quantities that `observe` derives from an equation's solution. Its steps are no longer than `longest`,
/// s.
fn integrated<const N: usize, const C: usize>(
    longest: f64,
    start: impl Fn(&[f64]) -> [f64; N] + Send + Sync + 'static,
    slope: impl Fn(&[f64], f64, &[f64], &mut [f64]) + Send + Sync + 'static,
    observe: impl Fn(&[f64], f64, &[f64]) -> [f64; C] + Send + Sync + 'static,
) -> Curves {
    std::sync::Arc::new(move |p, times| {
        let solution = dop853::solve(|t, y, d| slope(p, t, y, d), &start(p), times, TOLERANCE, longest);
        let mut curves = vec![Vec::with_capacity(times.len()); C];
        for (&t, y) in times.iter().zip(&solution) {
            for (curve, value) in curves.iter_mut().zip(observe(p, t, y)) {
                curve.push(value);
            }
        }
        curves
    })
}
