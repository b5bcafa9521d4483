//! The parts of the box in which motions meet the same events, each with polynomials of its own.
//!
//! In a box of one word these go through the grid's samples. Else each word's are fitted to all samples in its part by
//! least squares, of the degree with the smallest leave-one-out errors; samples are added where a part has few, and
//! next to its surfaces.

use symdiff::jet::JetSpace;

use super::basis::{Basis, End};
use super::fitting::Fitting;
use super::growth::Growth;
use super::parts::Samples;
use super::piece::{Piece, PieceMotions};
use super::surrogate::{HalfBox, SegmentErrors, SegmentSurrogate};
use super::tuning::TUNING;
use crate::methods::ensemble::{Ensemble, EnsembleError};
use crate::methods::validation::Validation;
use crate::numerics::{CutMotions, SegmentMotions, Surrogate, SurrogateWork, corners, spread};

/// All parts.
#[derive(Clone, Debug)]
pub(super) struct Pieces {
    pub all: Vec<Piece>,
    /// Time from which motions of no word are met, s.
    pub known_to: f64,
    /// Samples in addition to the grid's.
    pub added: usize,
}

impl Pieces {
    /// Pieces from the motions of the grid's samples; `None` if validation samples cannot be cut.
    ///
    /// # Errors
    /// If a sample cannot be assembled.
    pub fn new(
        ensemble: &dyn Ensemble,
        grid: &Surrogate,
        motions: CutMotions,
        validation: &Validation,
    ) -> Result<Option<Self>, EnsembleError> {
        let domain = ensemble.domain();
        let Some(direct) = ensemble.segments(&domain.samples(&validation.points))? else { return Ok(None) };
        let whole = |motions: &CutMotions, count: usize| {
            motions.words.len() == 1 && motions.words.iter().all(|word| word.samples.len() == count)
        };
        if whole(&motions, grid.samples().len()) && whole(&direct, validation.points.len()) {
            let mut work = SurrogateWork::default();
            let of_word = |(motions, direct): (&SegmentMotions, &SegmentMotions)| {
                let coefficients = |values: &[f64]| grid.coefficients(values, &mut work);
                let surrogate =
                    SegmentSurrogate::new(Basis::Grid(grid.basis().clone()), Vec::new(), motions, coefficients);
                let errors = SegmentErrors::new(&surrogate, &validation.points, direct);
                let points = validation.points.clone();
                let motions = PieceMotions { fitted: motions.clone(), points, held_out: direct.clone() };
                Piece::new(surrogate, errors, Vec::new(), motions)
            };
            let all = motions.words.iter().zip(&direct.words).map(of_word).collect();
            let known_to = motions.known_to.min(direct.known_to);
            return Ok(Some(Self { all, known_to, added: 0 }));
        }
        let order = grid.basis().orders().iter().copied().max().map_or(0, usize::from);
        let degree = highest_degree(order, domain.dimension());
        let samples = Samples { xi: grid.samples().to_vec(), motions };
        let fitting = Fitting { samples, degree, points: &validation.points, direct };
        fitting.pieces(ensemble).map(|fitted| {
            fitted.map(|(all, samples, known_to)| Self { all, known_to, added: samples - grid.samples().len() })
        })
    }

    /// Pieces from the jet of a box of one word, with errors at validation samples. Behind a surface on which an
    /// event is grazed motions go with a root, which no jet follows: in boxes of several words polynomials are fitted,
    /// and if the centre has no jet, too. `None` if motions are not cut.
    ///
    /// # Errors
    /// If a sample cannot be assembled.
    pub fn of_jets(
        ensemble: &dyn Ensemble,
        space: &JetSpace,
        validation: &Validation,
    ) -> Result<Option<Self>, EnsembleError> {
        let domain = ensemble.domain();
        let k = domain.dimension();
        let points = &validation.points;
        let Some(direct) = ensemble.segments(&domain.samples(points))? else { return Ok(None) };
        let middle = vec![0.0; k];
        if let Some((word, jet)) = ensemble.segment_jets(space, &middle)?
            && let Some(own) = direct.words.get(word).filter(|own| own.samples.len() == points.len())
        {
            let basis = Basis::Taylor { monomials: space.monomials().clone(), centre: middle };
            let all = vec![of_jet(basis, Vec::new(), &jet, points.clone(), own)];
            return Ok(Some(Self { all, known_to: direct.known_to, added: 0 }));
        }
        let (grid, motions) = if k > TUNING.degrees_of_part.len() {
            // A full grid of many parameters has too many samples.
            let Some(Growth { grid, motions }) = Growth::start(ensemble)? else { return Ok(None) };
            (Surrogate::sparse(&grid), motions)
        } else {
            let order = highest_degree(usize::MAX, k);
            let grid = Surrogate::tensor(&vec![order; k], &vec![order + 1; k]);
            let Some(motions) = ensemble.segments(&domain.samples(grid.samples()))? else { return Ok(None) };
            (grid, motions)
        };
        let found = Self::new(ensemble, &grid, motions, validation)?;
        Ok(found.map(|found| Self { added: found.added + grid.samples().len(), ..found }))
    }

    /// Divides the pieces of a box of one word in halves along the axes in which jets lack most: each has a jet about
    /// its middle. `None` if a piece is of several words, or is no jet's.
    ///
    /// # Errors
    /// If a sample cannot be assembled.
    pub fn halved(&self, ensemble: &dyn Ensemble, space: &JetSpace) -> Result<Option<Self>, EnsembleError> {
        let domain = ensemble.domain();
        let k = domain.dimension();
        let (mut all, mut added, mut known_to) = (Vec::new(), self.added, self.known_to);
        for piece in &self.all {
            let Some(halves) = piece.surrogate.halves() else { return Ok(None) };
            for HalfBox { middle, half_widths, ends } in halves {
                let Some((word, jet)) = ensemble.segment_jets(space, &middle)? else { return Ok(None) };
                let within = [corners(k, TUNING.corners), spread(k, TUNING.samples_of_halves * k)].concat();
                let of_box = |xi: &Vec<f64>| -> Vec<f64> {
                    let axes = xi.iter().zip(&middle).zip(&half_widths);
                    axes.map(|((xi, middle), half_width)| middle + xi * half_width).collect()
                };
                let xi: Vec<Vec<f64>> = within.iter().map(of_box).collect();
                let Some(motions) = ensemble.segments(&domain.samples(&xi))? else { return Ok(None) };
                let Some(own) = motions.words.get(word).filter(|own| own.samples.len() == xi.len()) else {
                    return Ok(None);
                };
                added += xi.len() + 1;
                known_to = known_to.min(motions.known_to);
                let basis = Basis::Taylor { monomials: space.monomials().clone(), centre: middle };
                all.push(of_jet(basis, ends, &jet, xi, own));
            }
        }
        Ok(Some(Self { all, known_to, added }))
    }

    /// Leaves the samples' motions, which nobody asks for behind the rows' bounds.
    pub fn forget_samples(&mut self) {
        self.all.iter_mut().for_each(|piece| piece.motions = PieceMotions::default());
    }

    /// The part that some ξ is in: where errors of surfaces leave it in none, that which it is least far from.
    pub fn part_of(&self, xi: &[f64]) -> Option<&Piece> {
        let beyond = |piece: &&Piece| piece.surrogate.ends.iter().map(|end| -end.margin(xi)).fold(0.0, f64::max);
        self.all.iter().min_by(|a, b| beyond(a).total_cmp(&beyond(b)))
    }
}

/// A part from a jet, with the errors at these samples.
fn of_jet(basis: Basis, ends: Vec<End>, jet: &SegmentMotions, xi: Vec<Vec<f64>>, motions: &SegmentMotions) -> Piece {
    let surrogate = SegmentSurrogate::new(basis, ends, jet, <[f64]>::to_vec).told_at(&xi);
    // From the start, which is known, errors grow. Behind events ends are farther from the centre of a jet than samples
    // are: the largest error of a segment counts in all of its steps.
    let errors = SegmentErrors::new(&surrogate, &xi, motions).of_segments_behind_events();
    let own = PieceMotions { fitted: jet.clone(), points: xi.clone(), held_out: motions.clone() };
    Piece::new(surrogate, errors, xi, own)
}

/// Highest total degree in a part, given that over the whole box.
pub(super) fn highest_degree(order: usize, k: usize) -> usize {
    let highest =
        TUNING.degrees_of_part.get(k.saturating_sub(1)).or(TUNING.degrees_of_part.last()).map_or(0, |&most| most);
    order.max(TUNING.least_degree).min(highest)
}
