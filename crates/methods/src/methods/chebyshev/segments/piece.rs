//! A part of the box with its polynomials.

use super::surrogate::{Point, SegmentErrors, SegmentSurrogate};
use super::tuning::TUNING;
use crate::numerics::SegmentMotions;

/// A part of the box.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub surrogate: SegmentSurrogate,
    /// Errors from all samples; then from those that are deeper behind all surfaces, if these are enough.
    told: Vec<Told>,
    /// ξ of its samples.
    pub samples: Vec<Vec<f64>>,
    /// Distance of its samples from each surface, at most.
    depths: Vec<f64>,
    pub motions: PieceMotions,
}

/// Errors with the samples that determine them.
#[derive(Clone, Debug)]
pub(super) struct Told {
    /// Share of the depth from which on they hold.
    limit: f64,
    errors: SegmentErrors,
    /// Indices among the samples of the fit, and among those that are held out.
    pub fitted: Vec<usize>,
    pub held_out: Vec<usize>,
}

/// Motions of a part's samples.
#[derive(Clone, Debug, Default)]
pub(super) struct PieceMotions {
    /// Motions that polynomials go through, or are fitted to; for a jet, its own.
    pub fitted: SegmentMotions,
    /// ξ of samples that are held out, and their motions.
    pub points: Vec<Vec<f64>>,
    pub held_out: SegmentMotions,
}

impl Piece {
    /// A piece with the same errors everywhere.
    pub fn new(
        surrogate: SegmentSurrogate,
        errors: SegmentErrors,
        samples: Vec<Vec<f64>>,
        motions: PieceMotions,
    ) -> Self {
        let held_out = (0..motions.points.len()).collect();
        let told = vec![Told { limit: 0.0, errors, fitted: Vec::new(), held_out }];
        Self { surrogate, told, samples, depths: Vec::new(), motions }
    }

    /// A piece of polynomials that were fitted to samples, with their errors at these, given the predictions of each by
    /// polynomials through all others.
    pub fn fitted(
        surrogate: SegmentSurrogate,
        samples: Vec<Vec<f64>>,
        motions: PieceMotions,
        predicted: &SegmentMotions,
    ) -> Self {
        let margins = |xi: &[f64]| surrogate.ends.iter().map(|end| end.margin(xi)).collect::<Vec<f64>>();
        let of_samples: Vec<Vec<f64>> = samples.iter().map(|xi| margins(xi)).collect();
        let of_points: Vec<Vec<f64>> = motions.points.iter().map(|xi| margins(xi)).collect();
        let depth = |end: usize| of_samples.iter().map(|margins| margins[end]).fold(0.0, f64::max);
        let depths: Vec<f64> = (0..surrogate.ends.len()).map(depth).collect();
        let is_inside = |margins: &[f64]| {
            let mut ends = surrogate.ends.iter().zip(margins);
            ends.all(|(end, margin)| end.offset == 0.0 || *margin >= 0.0)
        };
        let told = |limit: f64, fitted: Vec<usize>, held_out: Vec<usize>| {
            let errors = SegmentErrors::between(&motions.fitted.picked(&fitted), &predicted.picked(&fitted));
            let at: Vec<Vec<f64>> = held_out.iter().map(|&point| motions.points[point].clone()).collect();
            let of_points = || SegmentErrors::new(&surrogate, &at, &motions.held_out.picked(&held_out));
            let errors = if at.is_empty() { errors } else { errors.or(&of_points()) };
            Told { limit, errors, fitted, held_out }
        };
        let points: Vec<usize> = (0..of_points.len()).filter(|&point| is_inside(&of_points[point])).collect();
        let of_all = told(0.0, (0..samples.len()).collect(), points.clone());
        let of_depth = |&limit: &f64| {
            let is_deep = |margins: &[f64]| share_of_depth(margins, &depths) >= limit;
            let own: Vec<usize> = (0..samples.len()).filter(|&sample| is_deep(&of_samples[sample])).collect();
            let points: Vec<usize> = points.iter().copied().filter(|&point| is_deep(&of_points[point])).collect();
            (own.len() >= surrogate.terms()).then(|| told(limit, own, points))
        };
        let has_depths = !depths.is_empty() && depths.iter().all(|depth| *depth > 0.0);
        let limits = TUNING.depths_of_errors.iter().filter(|_| has_depths);
        let told = std::iter::once(of_all).chain(limits.filter_map(of_depth)).collect();
        Self { surrogate, told, samples, depths, motions }
    }

    /// Errors at all samples.
    pub fn errors(&self) -> &SegmentErrors {
        &self.told[0].errors
    }

    /// Errors with their samples: all, and then those that are deeper behind surfaces.
    pub fn told(&self) -> &[Told] {
        &self.told
    }

    /// By how many times themselves errors change for a ξ of 1, at most: a polynomial does by the square of its degree
    /// (Markov), which is little more than that of the part's own. Not known in layers, which are thin.
    pub fn slope_of_errors(&self) -> Option<f64> {
        let degree = (self.surrogate.degree() + TUNING.degrees_of_errors) as f64;
        let size = |axis: usize| {
            let own = self.samples.iter().map(|xi| xi[axis]);
            0.5 * (own.clone().fold(f64::NEG_INFINITY, f64::max) - own.fold(f64::INFINITY, f64::min))
        };
        let axes = 0..self.samples.first().map_or(0, Vec::len);
        let least = axes.map(size).fold(1.0, f64::min);
        (!self.surrogate.is_layer()).then_some(degree * degree / least)
    }

    /// Errors at a point: next to a surface they are larger than far behind it, so that only samples count which are
    /// not several times nearer to it.
    pub fn errors_at(&self, point: &Point) -> &SegmentErrors {
        &self.told[self.told_at(point)].errors
    }

    /// Index of the errors at a point.
    pub fn told_at(&self, point: &Point) -> usize {
        let share = share_of_depth(&point.margins, &self.depths);
        self.told.iter().rposition(|told| told.limit <= TUNING.shallower * share).unwrap_or(0)
    }
}

/// The share of the depth behind the nearest surface, given distances from each.
fn share_of_depth(margins: &[f64], depths: &[f64]) -> f64 {
    margins.iter().zip(depths).map(|(margin, depth)| margin / depth).fold(1.0, f64::min)
}
