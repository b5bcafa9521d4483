//! Oscillators that see many parameters through one number: bumps, ridges, corners, rings and sums. That number's range
//! over the box is known exactly, whatever the number of parameters. Half of those that change a stiffness have two
//! forces, which write the number in two ways: a program that searches for one number finds two.

use std::sync::Arc;

use super::oscillators::{decay, slow_frequency};
use super::{Scale, closed_form, lines, named, parameter};
use crate::draw::{Parameter, Term};
use crate::random::{Random, digits};
use crate::truth::Range;

/// A combination z of the uᵢ = (pᵢ − cᵢ)/wᵢ.
#[derive(Clone, Copy)]
enum Inner {
    Sum,
    SumOfSquares,
    /// Product of (1 + uᵢ)/2.
    Product,
}

/// A function of z, with values from −1 to 1.
#[derive(Clone, Copy)]
enum Outer {
    Itself,
    /// exp(−z)
    Fading,
    /// exp(−((z − r)/d)²)
    Bell(f64, f64),
    /// tanh z
    Step,
}

/// How uᵢ are written.
#[derive(Clone, Copy)]
enum Form {
    Quotients,
    Differences,
}

#[derive(Clone)]
struct Shape {
    inner: Inner,
    outer: Outer,
    centres: Vec<f64>,
    widths: Vec<f64>,
}

/// A hill in one to four parameters.
pub fn bump(random: &mut Random, scale: &Scale) -> Term {
    let count = random.pick(&[1, 1, 2, 2, 3, 4]);
    let narrowest = [0.08, 0.25, 0.4, 0.6][count - 1];
    oscillator(random, scale, count, |random, boxes| Shape {
        inner: Inner::SumOfSquares,
        outer: Outer::Fading,
        centres: boxes.iter().map(|own| inside(random, own)).collect(),
        widths: boxes.iter().map(|own| digits(own.half * random.scale(narrowest, 1.0), 3)).collect(),
    })
}

/// A ridge, or a step, across two to eight parameters.
pub fn ridge(random: &mut Random, scale: &Scale) -> Term {
    let count = random.whole(2, 8);
    oscillator(random, scale, count, |random, boxes| Shape {
        inner: Inner::Sum,
        outer: random.pick(&[Outer::Bell(0.0, 1.0), Outer::Step]),
        centres: boxes.iter().map(|own| inside(random, own)).collect(),
        widths: slopes(random, boxes, random_sharpness),
    })
}

fn random_sharpness(random: &mut Random, count: usize) -> f64 {
    count as f64 * random.scale(0.25, 2.0)
}

/// All happens in one corner of one to eight parameters.
pub fn corner(random: &mut Random, scale: &Scale) -> Term {
    let count = random.whole(1, 8);
    oscillator(random, scale, count, |random, boxes| Shape {
        inner: Inner::Product,
        outer: Outer::Itself,
        centres: boxes.iter().map(|own| own.value).collect(),
        widths: slopes(random, boxes, |_, _| 1.0),
    })
}

/// A circular ridge, or a shell, in two to four parameters.
pub fn ring(random: &mut Random, scale: &Scale) -> Term {
    let count = random.whole(2, 4);
    oscillator(random, scale, count, |random, boxes| Shape {
        inner: Inner::SumOfSquares,
        outer: Outer::Bell(random.between(0.3, 1.0), random.scale(0.3, 1.0)),
        centres: boxes.iter().map(|own| inside(random, own)).collect(),
        widths: boxes.iter().map(|own| digits(own.half * random.scale(0.7, 1.3), 3)).collect(),
    })
}

/// A stack: the sum of one to eight parameters.
pub fn stack(random: &mut Random, scale: &Scale) -> Term {
    let count = random.whole(1, 8);
    oscillator(random, scale, count, |random, boxes| Shape {
        inner: Inner::Sum,
        outer: Outer::Itself,
        centres: boxes.iter().map(|own| own.value).collect(),
        widths: slopes(random, boxes, |random, count| count as f64 * random.scale(1.0, 3.0)),
    })
}

/// A random value of three digits inside a parameter's interval.
fn inside(random: &mut Random, own: &Parameter) -> f64 {
    digits(own.value + own.half * random.between(-0.95, 0.95), 3)
}

/// Half widths times a factor, upwards or downwards.
fn slopes(random: &mut Random, boxes: &[Parameter], factor: fn(&mut Random, usize) -> f64) -> Vec<f64> {
    let mut slope = |own: &Parameter| random.pick(&[-1.0, 1.0]) * own.half * factor(random, boxes.len());
    boxes.iter().map(&mut slope).collect()
}

/// A free oscillator; a shape of `count` parameters changes its stiffness or its start.
fn oscillator(
    random: &mut Random,
    scale: &Scale,
    count: usize,
    shape: impl FnOnce(&mut Random, &[Parameter]) -> Shape,
) -> Term {
    let place = scale.place;
    let omega = slow_frequency(random, scale);
    let (k, x) = (digits(omega * omega, 3), random.scale(0.01, 1.0));
    let gain = random.pick(&[-1.0, 1.0]) * random.scale(0.1, 0.6);
    let letters = ["p", "q", "r", "s", "t", "u", "y", "z"];
    let boxes: Vec<Parameter> = letters[..count]
        .iter()
        .map(|letter| Parameter {
            half: random.scale(0.3, 2.0),
            ..parameter(letter, place, random.between(-1.0, 1.0), 0.0)
        })
        .collect();
    let shape = shape(random, &boxes);
    let is_stiffness = random.chance(0.7);
    // By the last of three digits that were drawn: another number would change all that are drawn after it.
    let is_twice = is_stiffness && (x * 100.0 / 10.0_f64.powf(x.log10().floor())).round() as u64 % 2 == 1;
    let share = if is_twice { 0.5 * gain } else { gain };
    let of_shape = |form: Form| format!("({share:?})*{}", shape.formula(&boxes, form));
    let once = format!("(1 + {})", of_shape(Form::Quotients));
    let (stiffness, start) = if is_stiffness { (&*once, "1") } else { ("1", &*once) };
    let force = |name: &str, stiffness: &str| {
        named(&format!("{name}#: {{ force: {{ on: b#, value: [\"-k#*{stiffness}*b#.x\", 0] }} }}"), place)
    };
    let mut effects = vec![force("s", stiffness)];
    if is_twice {
        effects.push(force("f", &of_shape(Form::Differences)));
    }
    let start = format!("b#.x: \"x#*{start}\"");
    let hidden = move |all: &[Parameter]| {
        let (boxes, own) = all.split_at(count);
        let factor = shape.range(boxes);
        let ends = [1.0 + gain * factor.lower, 1.0 + gain * factor.upper];
        let mut seen = own.to_vec();
        let changed = &mut seen[usize::from(!is_stiffness)];
        changed.half = 0.5 * changed.value * (ends[1] - ends[0]).abs();
        changed.value *= 0.5 * (ends[0] + ends[1]);
        seen
    };
    Term {
        parameters: [boxes, vec![parameter("k", place, k, 0.0), parameter("x", place, x, 0.0)]].concat(),
        bodies: vec![named("b#: { mass: 1, coordinates: [x] }", place)],
        joints: vec![],
        effects,
        initial: lines(&[&start, "b#.vx: 0"], place),
        guess: vec![],
        channels: lines(&["b#.x", "b#.vx"], place),
        curves: closed_form(|p, t| decay(p[0], 0.0, p[1], 0.0, t)),
        hidden: Some(Arc::new(hidden)),
        integrated: false,
        size: x,
        spatial: false,
    }
}

impl Shape {
    fn formula(&self, boxes: &[Parameter], form: Form) -> String {
        let terms = boxes.iter().zip(&self.centres).zip(&self.widths);
        let mut terms = terms.map(|((own, centre), width)| match form {
            Form::Quotients => format!("({} - ({centre:?}))/({width:?})", own.name),
            Form::Differences => format!("({}/({width:?}) - ({centre:?})/({width:?}))", own.name),
        });
        let inner = match self.inner {
            Inner::Sum => terms.collect::<Vec<_>>().join(" + "),
            Inner::SumOfSquares => terms.map(|u| format!("({u})^2")).collect::<Vec<_>>().join(" + "),
            Inner::Product => terms.by_ref().map(|u| format!("(1 + {u})/2")).collect::<Vec<_>>().join("*"),
        };
        match self.outer {
            Outer::Itself => format!("({inner})"),
            Outer::Fading => format!("exp(-({inner}))"),
            Outer::Bell(at, width) => format!("exp(-(({inner} - {at:?})/{width:?})^2)"),
            Outer::Step => format!("tanh({inner})"),
        }
    }

    /// Range over a box.
    fn range(&self, boxes: &[Parameter]) -> Range {
        let each = boxes.iter().zip(&self.centres).zip(&self.widths).map(|((own, centre), width)| {
            let [a, b] = own.interval().map(|p| (p - centre) / width);
            Range { lower: a.min(b), upper: a.max(b) }
        });
        let sum = |a: Range, b: Range| Range { lower: a.lower + b.lower, upper: a.upper + b.upper };
        // For numbers that are not negative.
        let product = |a: Range, b: Range| Range { lower: a.lower * b.lower, upper: a.upper * b.upper };
        let inner = match self.inner {
            Inner::Sum => each.reduce(sum),
            Inner::SumOfSquares => each.map(square).reduce(sum),
            Inner::Product => each.map(|u| u.map(|u| (0.5 * (1.0 + u)).max(0.0))).reduce(product),
        };
        let inner = inner.expect("a shape has a parameter");
        match self.outer {
            Outer::Itself => inner,
            Outer::Fading => inner.map(|z| (-z).exp()),
            Outer::Bell(at, width) => square(inner.map(|z| (z - at) / width)).map(|z| (-z).exp()),
            Outer::Step => inner.map(f64::tanh),
        }
    }
}

fn square(range: Range) -> Range {
    let ends = range.map(|u| u * u);
    let [a, b] = [range.lower * range.lower, range.upper * range.upper];
    if range.lower < 0.0 && range.upper > 0.0 { Range { lower: 0.0, upper: a.max(b) } } else { ends }
}

#[cfg(test)]
mod tests {
    use super::{bump, corner, ridge, ring, stack};
    use crate::families::Scale;
    use crate::random::Random;

    /// The hidden range contains all values in the box, and its ends are attained: by a search of corners, faces and
    /// inner points.
    #[test]
    fn hidden_ranges_match_those_of_the_boxes() {
        for (number, family) in [bump, ridge, corner, ring, stack].into_iter().cycle().take(40).enumerate() {
            let mut random = Random::new(5, number as u64);
            let term = family(&mut random, &Scale { place: 0, step: 1e-3, duration: 1.0 });
            let seen = term.seen();
            let which = usize::from(seen[0].half == 0.0);
            let [lower, upper] = seen[which].interval();
            let count = term.parameters.len() - 2;
            let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
            for _ in 0..20_000 {
                let mut point = term.parameters.clone();
                for own in &mut point[..count] {
                    let within = 2.0 * random.unit() - 1.0;
                    let share = random.pick(&[-1.0, 1.0, within]);
                    (own.value, own.half) = (own.value + share * own.half, 0.0);
                }
                let hidden = term.hidden.as_ref().unwrap()(&point);
                assert_eq!(hidden[which].half, 0.0);
                least = least.min(hidden[which].value);
                greatest = greatest.max(hidden[which].value);
            }
            let width = upper - lower;
            assert!(
                least >= lower - 1e-12 * width && greatest <= upper + 1e-12 * width,
                "{number}: {least} {greatest}"
            );
            assert!(least - lower < 0.1 * width && upper - greatest < 0.1 * width, "{number}: [{lower}, {upper}]");
        }
    }
}
