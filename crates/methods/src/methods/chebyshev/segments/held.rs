//! Whether an end is at a corner of the box, however the polynomials err.

use super::ends::Rival;
use super::row::SegmentRow;
use super::surrogate::Point;
use super::tuning::TUNING;
use crate::numerics::{STEP_NODES, largest};

/// An end of an output's range that is at a corner.
pub(super) struct Corner<'c> {
    pub output: usize,
    /// −1 for the least value, 1 for the largest.
    pub sign: f64,
    pub segment: usize,
    pub point: &'c Point,
    pub value: f64,
    /// How far the polynomials' errors move it.
    pub error: f64,
}

/// Places that are looked at in their segments, with the outputs there and how far errors move these (output, place).
pub(super) struct Looked {
    places: Vec<(usize, Point)>,
    values: Vec<f64>,
    errors: Vec<f64>,
}

impl Looked {
    pub fn at(row: &SegmentRow, places: Vec<(usize, Point)>) -> Self {
        let values = row.outputs_in(&places);
        let errors = row.errors(&places, &values);
        Self { places, values, errors }
    }

    /// Whether all places are within a corner, and those beside it.
    pub fn are_within(&self, row: &SegmentRow, corner: &Corner) -> bool {
        let Some(slope) = row.piece.slope_of_errors() else { return false };
        let surrogate = &row.piece.surrogate;
        let xi = &corner.point.xi;
        // Where an event passes through the part, errors change with the share of the segment, too: in a step as a
        // polynomial does by the square of its degree. Those in other segments say nothing of its own.
        let passes = self.places.iter().any(|(segment, _)| *segment != corner.segment);
        let (share, step) = surrogate.share(corner.point, corner.segment, row.time);
        let of_share = if passes { 2.0 * ((STEP_NODES - 1) as f64).powi(2) / step } else { 0.0 };
        let change = |point: &Point| {
            let distance = largest(point.xi.iter().zip(xi).map(|(a, b)| a - b));
            let shares = if passes { surrogate.share(point, corner.segment, row.time).0 - share } else { 0.0 };
            slope * distance + of_share * shares.abs()
        };
        let count = self.places.len();
        let of_place = |(index, (segment, point)): (usize, &(usize, Point))| {
            let at = corner.output * count + index;
            let change = if *segment == corner.segment { change(point) } else { f64::INFINITY };
            Rival { within: corner.sign * (corner.value - self.values[at]), error: self.errors[at], change }
        };
        let moved = |axis: usize| {
            let mut xi = xi.clone();
            xi[axis] -= TUNING.beside_corner * xi[axis].signum();
            xi
        };
        let beside = surrogate.points((0..xi.len()).map(moved).collect());
        let at: Vec<(&Point, usize, f64)> = beside.iter().map(|point| (point, corner.segment, row.time)).collect();
        let values = row.outputs_on(&at);
        let of_axis = |axis: usize| {
            let within = corner.sign * (corner.value - values[corner.output * at.len() + axis]);
            Rival { within, error: corner.error, change: change(&beside[axis]) }
        };
        let places = self.places.iter().enumerate().map(of_place);
        places.chain((0..xi.len()).map(of_axis)).all(|rival| rival.stays_within(corner.error))
    }
}
