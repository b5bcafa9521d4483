//! Bounds of a number that motions have in a part of the box only, such as the instant of an event that does not
//! always occur.

use symdiff::math;

use super::basis::End;
use super::ends::Ends;
use super::fitting::Fitting;
use super::parts::Samples;
use super::piece::Piece;
use super::pieces::highest_degree;
use super::row::SegmentRow;
use super::seeds::Lattice;
use super::tuning::TUNING;
use super::{extremes, joined};
use crate::methods::closure::Closure;
use crate::methods::ensemble::{Ensemble, EnsembleError};
use crate::methods::validation::Validation;
use crate::numerics::{CutMotions, Range, STEP_NODES, SegmentMotions, corners, largest, spread};

/// The motions of a word that stand for a number of each of its samples; without numbers, of a word that has none.
pub fn number_as_motion(samples: Vec<usize>, numbers: Option<&[f64]>) -> SegmentMotions {
    let Some(numbers) = numbers else { return SegmentMotions { samples, ..SegmentMotions::default() } };
    let count = samples.len();
    let node = [numbers, &vec![0.0; count]].concat();
    SegmentMotions {
        samples,
        steps: vec![vec![1.0]],
        times: vec![vec![0.0; count], vec![1.0; count]],
        nodes: vec![vec![node; STEP_NODES]],
    }
}

/// The number itself.
pub(super) struct Number;

impl Closure for Number {
    fn independent(&self) -> &[usize] {
        &[0]
    }

    fn needs_velocities(&self) -> bool {
        false
    }

    fn outputs(&self, _: f64, count: usize, _: Vec<f64>, mut motion: Vec<f64>) -> Vec<f64> {
        motion.truncate(count);
        motion
    }
}

/// A number over the parts of the box that have one.
#[derive(Clone, Copy, Debug)]
pub struct RangeInPart {
    pub range: Range,
    /// How far its ends may be off.
    pub error: f64,
    /// Share of the box that these parts are, at least and at most.
    pub share: [f64; 2],
}

/// The range of a number over the parts of the box that have one. The ensemble's
/// segments are those of [`number_as_motion`], and it has no other output. `None` if a sample has none of the words
/// that `known_to` speaks of.
///
/// # Errors
/// If a sample cannot be assembled.
pub fn range_in_part(
    ensemble: &dyn Ensemble,
    degree: usize,
    validation: &Validation,
) -> Result<Option<RangeInPart>, EnsembleError> {
    let domain = ensemble.domain();
    let k = domain.dimension();
    let xi = [corners(k, TUNING.corners), spread(k, TUNING.samples_of_parts * k)].concat();
    let cut = |xi: &[Vec<f64>]| ensemble.segments(&domain.samples(xi));
    let (Some(motions), Some(direct)) = (cut(&xi)?, cut(&validation.points)?) else { return Ok(None) };
    let points = &validation.points;
    let held_out = numbers_of(&direct);
    let fitting = Fitting { samples: Samples { xi, motions }, degree: highest_degree(degree, k), points, direct };
    let Some((pieces, _, known_to)) = fitting.pieces(ensemble)? else { return Ok(None) };
    // Motions that stand for the number are read at the middle of their time.
    let middle = 0.5;
    if known_to < middle {
        return Ok(None);
    }
    let of_piece = |piece: &Piece| {
        let lattice = Lattice::new(&piece.surrogate, &piece.samples, k);
        let row = SegmentRow { domain, outputs: 1, piece, motion: None, closure: &Number, time: middle };
        extremes::ends(&row, &lattice, None)
    };
    let parts: Vec<Vec<Ends>> = pieces.iter().filter(|piece| piece.surrogate.segments() > 0).map(of_piece).collect();
    let (extent, moved) = joined(&parts, 0);
    let error = largest(held_out.map(|number| extent.range.distance(number)).chain([moved]));
    Ok(Some(RangeInPart { range: extent.range, error, share: share(&pieces, k) }))
}

/// Share of the box that has a number, at least and at most: of points spread over it, those that surfaces leave in
/// parts with a number only, and in any such part, wherever within their errors surfaces are. N points in k dimensions
/// miss the volume behind a smooth surface by N^(−(k + 1)/2k) or so (J. Beck, Acta Math. 159 (1987) 1).
fn share(pieces: &[Piece], k: usize) -> [f64; 2] {
    let points = spread(k, TUNING.points_of_share);
    let beyond = |piece: &Piece, xi: &[f64]| {
        let of = |end: &End| -end.margin(xi) - end.error();
        piece.surrogate.ends.iter().map(of).fold(0.0, f64::max)
    };
    let mut counts = [0_usize; 2];
    for xi in &points {
        let nearest = pieces.iter().map(|piece| beyond(piece, xi)).fold(f64::INFINITY, f64::min);
        let possible = pieces.iter().filter(|piece| beyond(piece, xi) <= nearest);
        let has: Vec<bool> = possible.map(|piece| piece.surrogate.segments() > 0).collect();
        let [all, any] = [!has.contains(&false), has.contains(&true)];
        counts = [counts[0] + usize::from(all), counts[1] + usize::from(any)];
    }
    let count = points.len() as f64;
    let missed = TUNING.missed_share * math::pow(count, -0.5 - 0.5 / k as f64);
    [counts[0] as f64 / count - missed, counts[1] as f64 / count + missed].map(|share| share.clamp(0.0, 1.0))
}

/// All numbers that motions stand for.
fn numbers_of(motions: &CutMotions) -> impl Iterator<Item = f64> + use<> {
    let of_word = |word: &SegmentMotions| -> Vec<f64> {
        let node = word.nodes.first().and_then(|nodes| nodes.first());
        node.map(|node| node[..word.samples.len()].to_vec()).unwrap_or_default()
    };
    motions.words.iter().flat_map(of_word).collect::<Vec<f64>>().into_iter()
}
