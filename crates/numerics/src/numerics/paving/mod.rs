//! Set inversion: the parameters for which polynomials take values within given intervals, as boxes in [−1, 1]^k.
//!
//! A box belongs to the set where all Bernstein coefficients of all quantities lie within their inner intervals, and
//! not to it where those of one lie beyond the outer one; others are halved (Jaulin & Walter 1993, with ranges by
//! Bernstein's form). A quantity that is within its interval all over a box is not examined again in its parts.

mod cuts;
mod least_excess;
mod parts;
pub(crate) mod tuning;

use rayon::prelude::*;

use cuts::Cut;
pub use least_excess::{LeastExcess, least_excess};
use parts::{PavingBox, Shape};

/// Polynomials of one shape, and the intervals for their values.
#[derive(Clone, Debug)]
pub struct Tubes {
    /// Degree along each axis (k).
    pub orders: Vec<usize>,
    /// Chebyshev coefficients of the tensor, the last index fastest, quantity by quantity.
    pub coefficients: Vec<f64>,
    /// For each quantity the interval outside of which a value is impossible.
    pub outer: Vec<[f64; 2]>,
    /// For each quantity the interval within which a value is certainly possible; empty if there is no such value.
    pub inner: Vec<[f64; 2]>,
    /// For each quantity the unit in which an excess is measured.
    pub scales: Vec<f64>,
}

/// Limits at which a paving ends.
#[derive(Clone, Copy, Debug)]
pub struct PavingLimits {
    /// Volume of the boxes that are not decided, as a share of the outer volume.
    pub undecided: f64,
    /// Boxes that are not decided.
    pub boxes: usize,
    /// Coefficients in memory.
    pub numbers: usize,
}

/// Boxes in [−1, 1]^k: for each the lower ends (k), then the upper ends (k).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Boxes {
    dimension: usize,
    ends: Vec<f64>,
}

/// An inner and an outer approximation of a set.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Paving {
    /// Boxes within the set.
    pub inside: Boxes,
    /// Boxes that are not decided: with those within it they cover the set.
    pub undecided: Boxes,
    /// Planes that cut each of these.
    cuts: Vec<Cut>,
}

impl Boxes {
    /// No boxes yet, of k axes.
    pub fn new(dimension: usize) -> Self {
        Self { dimension, ends: Vec::new() }
    }

    fn add(&mut self, ends: &[f64]) {
        self.ends.extend_from_slice(ends);
    }

    /// Number of boxes.
    pub fn len(&self) -> usize {
        self.ends.len() / (2 * self.dimension).max(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Lower and upper ends of each.
    pub fn iter(&self) -> impl Iterator<Item = (&[f64], &[f64])> {
        self.ends.chunks_exact((2 * self.dimension).max(1)).map(|ends| ends.split_at(self.dimension))
    }

    /// Their volume as a share of that of [−1, 1]^k.
    pub fn volume(&self) -> f64 {
        self.iter().map(|ends| volume(ends.0, ends.1)).sum()
    }

    /// Whether one of them has a point.
    pub fn contains(&self, point: &[f64]) -> bool {
        self.iter().any(|ends| holds(ends.0, ends.1, point))
    }
}

/// Volume of a box as a share of that of [−1, 1]^k.
fn volume(lower: &[f64], upper: &[f64]) -> f64 {
    lower.iter().zip(upper).map(|(lower, upper)| 0.5 * (upper - lower)).product()
}

fn holds(lower: &[f64], upper: &[f64], point: &[f64]) -> bool {
    point.iter().zip(lower.iter().zip(upper)).all(|(value, (lower, upper))| (lower..=upper).contains(&value))
}

impl Paving {
    /// Volumes of the inner and the outer approximation, with the parts that planes cut off, as shares of that of
    /// [−1, 1]^k.
    pub fn volumes(&self) -> [f64; 2] {
        let mut volumes = [self.inside.volume(); 2];
        for (cut, (lower, upper)) in self.cuts.iter().zip(self.undecided.iter()) {
            let shares = cut.shares();
            let own = volume(lower, upper);
            (0..2).for_each(|side| volumes[side] += own * shares[side]);
        }
        volumes
    }

    /// Whether a point may belong to the set.
    pub fn may_contain(&self, point: &[f64]) -> bool {
        let is_below = |cut: &Cut, lower: &[f64], upper: &[f64]| {
            let share = |axis: usize| (point[axis] - lower[axis]) / (upper[axis] - lower[axis]);
            let along: f64 = cut.normal.iter().enumerate().map(|(axis, own)| own * share(axis)).sum();
            holds(lower, upper, point) && along <= cut.outer
        };
        let mut cuts = self.cuts.iter().zip(self.undecided.iter());
        self.inside.contains(point) || cuts.any(|own| is_below(own.0, own.1.0, own.1.1))
    }
}

/// Paves the set, box by box of a layer in parallel: the same boxes for any number of threads.
pub fn pave(tubes: &Tubes, limits: PavingLimits, interrupted: &(dyn Fn() -> bool + Sync)) -> Paving {
    let shape = Shape::new(&tubes.orders);
    let k = shape.dimension();
    let mut paving = Paving { inside: Boxes::new(k), undecided: Boxes::new(k), cuts: Vec::new() };
    let mut layer = Vec::new();
    paving.sort(PavingBox::whole(&shape, tubes).classified(&shape, tubes), &mut layer);
    loop {
        let numbers: usize = layer.iter().map(PavingBox::numbers).sum();
        let cuts: Vec<Cut> = layer.par_iter().map(|part| Cut::of(part, &shape, tubes)).collect();
        let [mut inner, mut outer] = [paving.inside.volume(); 2];
        for (part, cut) in layer.iter().zip(&cuts) {
            let [least, most] = cut.shares();
            inner += part.volume() * least;
            outer += part.volume() * most;
        }
        let is_enough = outer - inner <= limits.undecided * outer;
        if is_enough || 2 * layer.len() > limits.boxes || 2 * numbers > limits.numbers || interrupted() {
            layer.iter().for_each(|part| paving.undecided.add(&part.ends));
            return Paving { cuts, ..paving };
        }
        let halves = |part: PavingBox| part.halves(&shape, tubes).map(|half| half.classified(&shape, tubes));
        let parts: Vec<[Option<PavingBox>; 2]> = std::mem::take(&mut layer).into_par_iter().map(halves).collect();
        parts.into_iter().flatten().for_each(|part| paving.sort(part, &mut layer));
    }
}

impl Paving {
    /// Adds a box to those inside or to those to be divided; `None` does not belong to the set.
    fn sort(&mut self, part: Option<PavingBox>, layer: &mut Vec<PavingBox>) {
        match part {
            Some(part) if part.rows.is_empty() => self.inside.add(&part.ends),
            Some(part) => layer.push(part),
            None => (),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: PavingLimits = PavingLimits { undecided: 0.02, boxes: 1 << 17, numbers: 1 << 24 };

    /// x² + y² of degree 2 in both: 1 + C₂(x)/2 + C₂(y)/2.
    fn disc(radius: f64) -> Tubes {
        let square = radius * radius;
        Tubes {
            orders: vec![2, 2],
            coefficients: vec![1.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0],
            outer: vec![[-1.0, square]],
            inner: vec![[-1.0, square]],
            scales: vec![1.0],
        }
    }

    #[test]
    fn area_of_a_disc_lies_between_both_volumes() {
        let paving = pave(&disc(0.7), LIMITS, &|| false);
        let [inner, outer] = paving.volumes();
        let exact = std::f64::consts::PI * 0.49 / 4.0;
        assert!(inner <= exact && exact <= outer && outer - inner <= 0.02 * outer, "{inner} {exact} {outer}");
        assert!(
            paving.inside.len() + paving.undecided.len() < 400,
            "planes cut what boxes would have to be halved for"
        );
        for number in 0..1000 {
            let angle = 0.1 * f64::from(number);
            let at = |radius: f64| [radius * angle.cos(), radius * angle.sin()];
            assert!(paving.may_contain(&at(0.7)) && !paving.may_contain(&at(0.75)));
            assert!(!paving.inside.contains(&at(0.7001)));
        }
    }

    #[test]
    fn an_error_shrinks_the_inner_set_and_extends_the_outer_one() {
        let mut tubes = disc(0.7);
        (tubes.outer[0][1], tubes.inner[0][1]) = (0.55, 0.43);
        let limits = PavingLimits { undecided: 0.01, boxes: 1 << 12, numbers: 1 << 20 };
        let [inner, outer] = pave(&tubes, limits, &|| false).volumes();
        let area = |square: f64| std::f64::consts::PI * square / 4.0;
        assert!(inner <= area(0.43) && outer >= area(0.55), "{inner} {outer}");
        assert!(inner > 0.98 * area(0.43) && outer < 1.02 * area(0.55), "{inner} {outer}");
    }

    #[test]
    fn an_empty_set_has_no_boxes_and_a_least_excess() {
        // x² + y² ≥ 2.5 is nowhere; at the corners 0.5 are lacking.
        let mut tubes = disc(0.7);
        tubes.outer[0] = [2.5, 3.0];
        tubes.inner[0] = [2.5, 3.0];
        let paving = pave(&tubes, LIMITS, &|| false);
        assert!(paving.inside.is_empty() && paving.undecided.is_empty());
        let found = least_excess(&tubes, 1e-3, 10_000, &|| false);
        assert!(found.lower <= 0.5 && 0.5 <= found.upper + 1e-12 && found.upper - found.lower < 1e-3, "{found:?}");
    }

    #[test]
    fn the_least_excess_of_two_quantities_lies_between_them() {
        // x within ± 0 of 0.5 and of −0.5: at 0 both lack 0.5.
        let tubes = Tubes {
            orders: vec![1],
            coefficients: vec![0.0, 1.0, 0.0, 1.0],
            outer: vec![[0.5, 0.5], [-0.5, -0.5]],
            inner: vec![[0.5, 0.5], [-0.5, -0.5]],
            scales: vec![1.0, 1.0],
        };
        let found = least_excess(&tubes, 1e-6, 10_000, &|| false);
        assert!((found.upper - 0.5).abs() < 1e-5 && found.lower <= 0.5 && found.at[0].abs() < 1e-5, "{found:?}");
    }
}
