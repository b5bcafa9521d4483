//! A part of the box with its polynomials.

use super::surrogate::{Point, SegmentErrors, SegmentSurrogate};
use super::tuning::TUNING;
use crate::numerics::SegmentMotions;

/// A part of the box.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub surrogate: SegmentSurrogate,
    pub errors: SegmentErrors,
    /// Errors at samples that are deeper behind all surfaces: by the shares of the depth from which on they hold, as
    /// far as samples are enough.
    deeper: Vec<(f64, SegmentErrors)>,
    /// ξ of its samples.
    pub samples: Vec<Vec<f64>>,
    /// Distance of its samples from each surface, at most.
    depths: Vec<f64>,
}

/// Motions of samples, and those that polynomials through all others predict.
#[derive(Clone, Copy)]
pub(super) struct FittedMotions<'m> {
    pub motions: &'m SegmentMotions,
    pub predicted: &'m SegmentMotions,
}

/// Validation samples: ξ of all, and motions of those of the word.
#[derive(Clone, Copy)]
pub(super) struct ValidationMotions<'m> {
    pub points: &'m [Vec<f64>],
    pub motions: &'m SegmentMotions,
}

impl Piece {
    /// With the same errors everywhere.
    pub fn new(surrogate: SegmentSurrogate, errors: SegmentErrors, samples: Vec<Vec<f64>>) -> Self {
        Self { surrogate, errors, samples, deeper: Vec::new(), depths: Vec::new() }
    }

    /// Of polynomials that were fitted to samples, with the errors of those.
    pub fn fitted(
        surrogate: SegmentSurrogate,
        samples: Vec<Vec<f64>>,
        fitted: FittedMotions<'_>,
        held_out: ValidationMotions<'_>,
    ) -> Self {
        let margins = |xi: &[f64]| surrogate.ends.iter().map(|end| end.margin(xi)).collect::<Vec<f64>>();
        let of_samples: Vec<Vec<f64>> = samples.iter().map(|xi| margins(xi)).collect();
        let of_points: Vec<Vec<f64>> =
            held_out.motions.samples.iter().map(|&sample| margins(&held_out.points[sample])).collect();
        let depth = |end: usize| of_samples.iter().map(|margins| margins[end]).fold(0.0, f64::max);
        let depths: Vec<f64> = (0..surrogate.ends.len()).map(depth).collect();
        let is_inside = |margins: &[f64]| {
            let mut ends = surrogate.ends.iter().zip(margins);
            ends.all(|(end, margin)| end.offset == 0.0 || *margin >= 0.0)
        };
        let errors = |own: &[usize], points: &[usize]| {
            let errors = SegmentErrors::between(&fitted.motions.picked(own), &fitted.predicted.picked(own));
            let direct = held_out.motions.picked(points);
            let at: Vec<Vec<f64>> = direct.samples.iter().map(|&sample| held_out.points[sample].clone()).collect();
            if at.is_empty() { errors } else { errors.or(&SegmentErrors::new(&surrogate, &at, &direct)) }
        };
        let points: Vec<usize> = (0..of_points.len()).filter(|&point| is_inside(&of_points[point])).collect();
        let of_all = errors(&(0..samples.len()).collect::<Vec<_>>(), &points);
        let of_depth = |&limit: &f64| {
            let is_deep = |margins: &[f64]| share_of_depth(margins, &depths) >= limit;
            let own: Vec<usize> = (0..samples.len()).filter(|&sample| is_deep(&of_samples[sample])).collect();
            let points: Vec<usize> = points.iter().copied().filter(|&point| is_deep(&of_points[point])).collect();
            (own.len() >= surrogate.terms()).then(|| (limit, errors(&own, &points)))
        };
        let has_depths = !depths.is_empty() && depths.iter().all(|depth| *depth > 0.0);
        let limits = TUNING.depths_of_errors.iter().filter(|_| has_depths);
        let deeper = limits.filter_map(of_depth).collect();
        Self { surrogate, errors: of_all, deeper, samples, depths }
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

    /// Errors at a point: beside a surface they are larger than far behind it, so that only samples count which are
    /// not several times nearer to it.
    pub fn errors_at(&self, point: &Point) -> &SegmentErrors {
        let share = share_of_depth(&point.margins, &self.depths);
        let fits = |(limit, _): &&(f64, SegmentErrors)| *limit <= TUNING.shallower * share;
        self.deeper.iter().rev().find(fits).map_or(&self.errors, |(_, errors)| errors)
    }
}

/// The share of the depth behind the nearest surface, given distances from each.
fn share_of_depth(margins: &[f64], depths: &[f64]) -> f64 {
    margins.iter().zip(depths).map(|(margin, depth)| margin / depth).fold(1.0, f64::min)
}
