//! One climb to an end of an output in a row, from gradient to gradient.

/// A step that promises less than this share of the output's range in the row is left out.
const WORTH: f64 = 1e-3;

/// The same as a share of the error that is allowed.
const WORTH_OF_ALLOWED: f64 = 0.1;

/// An output's end in a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct End {
    pub row: usize,
    pub output: usize,
    /// 1 of the upper end, −1 of the lower.
    pub sign: f64,
}

impl End {
    /// Number of the end, of two: the lower one first.
    pub fn side(self) -> usize {
        usize::from(self.sign > 0.0)
    }
}

/// A point with a value and a gradient (in ξ), both upwards for the upper end, downwards for the lower.
#[derive(Clone, Debug)]
pub(super) struct Known {
    pub point: Vec<f64>,
    pub value: f64,
    pub slope: Vec<f64>,
}

/// A climb.
pub(super) struct Climb {
    pub end: End,
    start: Vec<f64>,
    /// The best point so far.
    pub best: Option<Known>,
    /// The point before it, or the last that was not better.
    other: Option<Known>,
    /// Of the whole step.
    share: f64,
    /// What a step promises at least.
    worth: f64,
    pub is_done: bool,
}

impl Climb {
    /// To an end of an output that ranges over so much in the row, by about; its error is `allowed`.
    pub fn new(end: End, start: Vec<f64>, width: f64, allowed: f64) -> Self {
        let worth = (WORTH * width).min(WORTH_OF_ALLOWED * allowed);
        Self { end, start, best: None, other: None, share: 1.0, worth, is_done: false }
    }

    /// What a step promises at least to be taken.
    pub fn worth(&self) -> f64 {
        self.worth
    }

    /// The next point; `None` where nothing is to be gained.
    pub fn step(&self) -> Option<Vec<f64>> {
        let Some(best) = &self.best else { return Some(self.start.clone()) };
        let target = self.target(best);
        let is_worth = gain(best, &target) > self.worth;
        is_worth.then(|| target.iter().zip(&best.point).map(|(to, x)| x + self.share * (to - x)).collect())
    }

    /// What the best point's gradient still promises; infinite where none is known.
    pub fn promise(&self) -> f64 {
        let promise = self.best.as_ref().map_or(f64::INFINITY, |best| gain(best, &self.target(best)));
        if promise.is_nan() { f64::INFINITY } else { promise }
    }

    /// Along each axis the end of the box to which the gradient points, or where its secant vanishes.
    fn target(&self, best: &Known) -> Vec<f64> {
        let Known { point, slope, .. } = best;
        let along = |axis: usize| {
            let (x, own) = (point[axis], slope[axis]);
            if let Some(other) = &self.other {
                let (from, before) = (other.point[axis], other.slope[axis]);
                // An extreme between the two.
                if before * own < 0.0 && from != x {
                    return (x - own * (x - from) / (own - before)).clamp(-1.0, 1.0);
                }
            }
            if own == 0.0 || !own.is_finite() { x } else { own.signum() }
        };
        (0..point.len()).map(along).collect()
    }

    /// Takes in a point.
    pub fn take(&mut self, found: Known) {
        let is_known = found.value.is_finite() && found.slope.iter().all(|slope| slope.is_finite());
        if !is_known {
            self.share *= 0.5;
            // Nothing is known where it begins.
            self.is_done |= self.best.is_none();
        } else if self.best.as_ref().is_none_or(|best| found.value > best.value) {
            self.other = self.best.replace(found);
            self.share = 1.0;
        } else {
            self.share *= 0.5;
            self.other = Some(found);
        }
    }
}

/// What a gradient promises on the way to a target.
fn gain(best: &Known, target: &[f64]) -> f64 {
    target.iter().zip(&best.point).zip(&best.slope).map(|((to, x), slope)| slope * (to - x)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// −(x − a)² + b y: an extreme within, and one at the end.
    #[test]
    fn a_step_finds_what_lies_within_and_what_lies_at_an_end() {
        let known = |point: Vec<f64>| Known {
            value: -(point[0] - 0.3).powi(2) + 2.0 * point[1],
            slope: vec![-2.0 * (point[0] - 0.3), 2.0],
            point,
        };
        let mut climb = Climb::new(End { row: 0, output: 0, sign: 1.0 }, vec![0.0, 0.0], 2.6, 1.0);
        assert_eq!(climb.promise(), f64::INFINITY);
        for _ in 0..5 {
            let Some(step) = climb.step() else { break };
            climb.take(known(step));
        }
        let best = climb.best.as_ref().unwrap();
        assert!(climb.step().is_none(), "{best:?}");
        assert!((best.point[0] - 0.3).abs() < 1e-12 && best.point[1] == 1.0, "{best:?}");
        assert!(climb.promise() < 1e-12);
    }
}
