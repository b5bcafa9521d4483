//! The parts of the box in which motions meet the same events, each with polynomials of its own.
//!
//! Of a box of one word these go through the grid's samples. Else each word's are fitted to all samples in its part by
//! least squares, of the degree at which samples that are left out are met best; samples are added where a part has
//! few, and beside its surfaces.

use symdiff::jet::JetSpace;

use super::basis::Basis;
use super::fitting::Fitting;
use super::parts::{Samples, WordPart};
use super::piece::Piece;
use super::surrogate::{SegmentErrors, SegmentSurrogate};
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
    /// Samples beside the grid's.
    pub added: usize,
}

impl Pieces {
    /// From the motions of the grid's samples; `None` where validation samples cannot be cut.
    ///
    /// # Errors
    /// Where a sample cannot be assembled.
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
                Piece::new(surrogate, errors, Vec::new())
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

    /// From jets, each about the sample that is nearest to the middle of a part: samples that show the parts tell the
    /// errors, too; `None` where motions are not cut, or validation samples cannot be.
    ///
    /// # Errors
    /// Where a sample cannot be assembled.
    pub fn of_jets(
        ensemble: &dyn Ensemble,
        space: &JetSpace,
        validation: &Validation,
    ) -> Result<Option<Self>, EnsembleError> {
        let domain = ensemble.domain();
        let k = domain.dimension();
        let Some((first, jet)) = ensemble.segment_jets(space, &vec![0.0; k])? else { return Ok(None) };
        let Some(direct) = ensemble.segments(&domain.samples(&validation.points))? else { return Ok(None) };
        let mut samples = Samples { xi: validation.points.clone(), motions: direct };
        let is_one = samples.motions.words.iter().filter(|word| !word.samples.is_empty()).count() == 1;
        if !is_one {
            let others = [corners(k, TUNING.corners), spread(k, TUNING.samples_of_parts * k)].concat();
            let Some(motions) = ensemble.segments(&domain.samples(&others))? else { return Ok(None) };
            samples.motions.append(motions, samples.xi.len());
            samples.xi.extend(others);
        }
        let levels = samples.levels();
        let mut all = Vec::new();
        for (word, motions) in samples.motions.words.iter().enumerate() {
            let xi: Vec<Vec<f64>> = motions.samples.iter().map(|&sample| samples.xi[sample].clone()).collect();
            let Some(centre) = central(&xi) else { continue };
            let (centre, jet) = match word == first {
                true => (vec![0.0; k], Some((first, jet.clone()))),
                false => (centre.clone(), ensemble.segment_jets(space, centre)?),
            };
            let Some((_, jet)) = jet.filter(|(own, _)| *own == word) else { return Ok(None) };
            let basis = Basis::Taylor { monomials: space.monomials().clone(), centre };
            let ends = WordPart::of_word(word, &samples.motions).ends(&levels);
            let surrogate = SegmentSurrogate::new(basis, ends, &jet, <[f64]>::to_vec).told_at(&xi);
            // From the start, which is known, errors grow. Behind events ends are farther from the centre of a jet than
            // samples are: what one of them shows is said of all steps.
            let errors = SegmentErrors::new(&surrogate, &xi, motions).of_segments_behind_events();
            all.push(Piece::new(surrogate, errors, xi));
        }
        let added = samples.xi.len() - validation.points.len() + all.len() - 1;
        Ok(Some(Self { all, known_to: samples.motions.known_to, added }))
    }

    /// The part that some ξ is in: where errors of surfaces leave it in none, that which it is least far from.
    pub fn part_of(&self, xi: &[f64]) -> Option<&Piece> {
        let beyond = |piece: &&Piece| piece.surrogate.ends.iter().map(|end| -end.margin(xi)).fold(0.0, f64::max);
        self.all.iter().min_by(|a, b| beyond(a).total_cmp(&beyond(b)))
    }
}

/// Highest total degree in a part, given that over the whole box.
pub(super) fn highest_degree(order: usize, k: usize) -> usize {
    let highest =
        TUNING.degrees_of_part.get(k.saturating_sub(1)).or(TUNING.degrees_of_part.last()).map_or(0, |&most| most);
    order.max(TUNING.least_degree).min(highest)
}

/// The point that is nearest to the middle of all.
fn central(points: &[Vec<f64>]) -> Option<&Vec<f64>> {
    let count = points.len() as f64;
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / count;
    let means: Vec<f64> = (0..points.first()?.len()).map(mean).collect();
    let distance = |xi: &Vec<f64>| xi.iter().zip(&means).map(|(xi, mean)| (xi - mean) * (xi - mean)).sum::<f64>();
    points.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))
}
