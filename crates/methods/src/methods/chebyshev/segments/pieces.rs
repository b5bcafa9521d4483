//! The parts of the box in which motions meet the same events, each with polynomials of its own.
//!
//! Of a box of one word these go through the grid's samples. Else each word's are fitted to all samples in its part by
//! least squares, of the degree at which samples that are left out are met best; samples are added where a part has
//! few, and beside its surfaces.

use super::basis::{Basis, Fitted, Level, SAMPLES_A_TERM};
use super::surrogate::{SegmentErrors, SegmentSurrogate};
use crate::methods::ensemble::{Ensemble, EnsembleError};
use crate::methods::validation::Validation;
use crate::numerics::{
    CutMotions, LeastSquares, SegmentMotions, Surrogate, SurrogateWork, corners, largest, spread,
};

/// Least and highest total degree in a part, the latter by the number of parameters.
const LEAST_DEGREE: usize = 3;
const DEGREES: [usize; 4] = [8, 5, 3, 2];

/// Rounds in which samples are added, and candidates of each round.
const ROUNDS: usize = 3;
const CANDIDATES: usize = 512;
const CORNERS: usize = 16;

/// Of the samples that a part lacks, one in so many is added beside its surfaces.
const BESIDE: usize = 3;

/// Bounding boxes of a part's samples are widened by this share.
const WIDER: f64 = 0.1;

/// A part of the box.
pub(super) struct Piece<'a> {
    pub surrogate: SegmentSurrogate<'a>,
    pub errors: SegmentErrors,
    /// ξ of its samples.
    pub samples: Vec<Vec<f64>>,
}

/// All parts.
pub(super) struct Pieces<'a> {
    pub all: Vec<Piece<'a>>,
    /// Time from which motions of no word are met, s.
    pub known_to: f64,
    /// Samples beside the grid's.
    pub added: usize,
}

impl<'a> Pieces<'a> {
    /// From the motions of the grid's samples; `None` where validation samples cannot be cut.
    ///
    /// # Errors
    /// Where a sample cannot be assembled.
    pub fn new(
        ensemble: &dyn Ensemble,
        grid: &'a Surrogate,
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
                let surrogate = SegmentSurrogate::new(Basis::Grid(grid.basis()), Vec::new(), motions, coefficients);
                let errors = SegmentErrors::new(&surrogate, &validation.points, direct);
                Piece { surrogate, errors, samples: Vec::new() }
            };
            let all = motions.words.iter().zip(&direct.words).map(of_word).collect();
            let known_to = motions.known_to.min(direct.known_to);
            return Ok(Some(Self { all, known_to, added: 0 }));
        }
        let order = grid.basis().orders().iter().copied().max().map_or(0, usize::from);
        let mut samples = Samples { xi: grid.samples().to_vec(), motions };
        let degree = DEGREES.get(domain.dimension() - 1).or(DEGREES.last()).map_or(0, |&most| most);
        let degree = order.max(LEAST_DEGREE).min(degree);
        for _ in 0..ROUNDS {
            let wanted = samples.wanted(degree);
            if wanted.is_empty() || ensemble.is_interrupted() {
                break;
            }
            let Some(motions) = ensemble.segments(&domain.samples(&wanted))? else { return Ok(None) };
            samples.motions.append(motions, samples.xi.len());
            samples.xi.extend(wanted);
        }
        let levels = samples.levels();
        let of_word = |word: usize| samples.piece(word, degree, &levels, (&validation.points, &direct));
        let all = (0..samples.motions.words.len()).filter_map(of_word).collect();
        let known_to = samples.motions.known_to.min(direct.known_to);
        Ok(Some(Self { all, known_to, added: samples.xi.len() - grid.samples().len() }))
    }

    /// The part that some ξ is in: where errors of surfaces leave it in none, that which it is least far from.
    pub fn part_of(&self, xi: &[f64]) -> Option<&Piece<'a>> {
        let beyond = |piece: &&Piece| {
            piece.surrogate.ends.iter().map(|(level, sign)| -sign * level.at(xi)).fold(0.0, f64::max)
        };
        self.all.iter().min_by(|a, b| beyond(a).total_cmp(&beyond(b)))
    }
}

/// Samples with their motions.
struct Samples {
    xi: Vec<Vec<f64>>,
    motions: CutMotions,
}

impl Samples {
    /// The surfaces between words, as far as samples tell.
    fn levels(&self) -> Vec<Option<Level>> {
        let of = |values: &Vec<f64>| {
            let known: Vec<(&[f64], f64)> =
                self.xi.iter().map(Vec::as_slice).zip(values.iter().copied()).filter(|(_, m)| m.is_finite()).collect();
            Level::through(&known)
        };
        self.motions.boundaries.iter().map(|boundary| of(&boundary.values)).collect()
    }

    /// Surfaces that end a word's part, each with the sign that it has there.
    fn ends(&self, word: usize, levels: &[Option<Level>]) -> Vec<(Level, f64)> {
        let of = |(boundary, level): (&crate::numerics::BoundaryMargins, &Option<Level>)| {
            let sign = match () {
                () if boundary.met.contains(&word) => -1.0,
                () if boundary.missed.contains(&word) => 1.0,
                () => return None,
            };
            Some((level.clone()?, sign))
        };
        self.motions.boundaries.iter().zip(levels).filter_map(of).collect()
    }

    /// Points at which samples are missing for fits of a degree in each part.
    fn wanted(&self, degree: usize) -> Vec<Vec<f64>> {
        let levels = self.levels();
        let k = self.xi.first().map_or(0, Vec::len);
        let mut wanted = Vec::new();
        for (word, motions) in self.motions.words.iter().enumerate() {
            let ends = self.ends(word, &levels);
            let depths = ends.iter().filter(|(_, sign)| *sign < 0.0).map(|(level, _)| level.clone());
            let terms = Fitted::new(degree, &depths.collect::<Vec<_>>(), k).len();
            let lacks = ((SAMPLES_A_TERM * terms as f64) as usize + 2).saturating_sub(motions.samples.len());
            let is_inside = |xi: &Vec<f64>| ends.iter().all(|(level, sign)| sign * level.at(xi) >= 0.0);
            let is_new = |xi: &Vec<f64>| !self.xi.contains(xi);
            let of_box = [corners(k, CORNERS), spread(k, CANDIDATES)].concat();
            let found: Vec<Vec<f64>> = of_box.into_iter().filter(is_inside).collect();
            let own = motions.samples.iter().map(|&sample| &self.xi[sample]);
            let Some(extent) = bounding(own.chain(&found)) else { continue };
            let within = |xi: Vec<f64>| -> Vec<f64> {
                let place = |(xi, [low, high]): (&f64, &[f64; 2])| low + 0.5 * (xi + 1.0) * (high - low);
                xi.iter().zip(&extent).map(place).collect()
            };
            // Of every round others.
            let skipped = self.xi.len();
            let candidates = spread(k, CANDIDATES + skipped).split_off(skipped);
            let mut candidates: Vec<Vec<f64>> =
                candidates.into_iter().map(within).filter(|xi| is_inside(xi) && is_new(xi)).collect();
            let ends_of_box = corners(k, CORNERS).into_iter().map(within).filter(|xi| is_inside(xi) && is_new(xi));
            wanted.extend(ends_of_box.take(lacks));
            wanted.extend(candidates.iter().take(lacks - lacks / BESIDE).cloned());
            let nearest =
                |xi: &Vec<f64>| ends.iter().map(|(level, _)| level.at(xi).abs()).fold(f64::INFINITY, f64::min);
            candidates.sort_by(|a, b| nearest(a).total_cmp(&nearest(b)));
            wanted.extend(candidates.into_iter().take(if ends.is_empty() { 0 } else { lacks / BESIDE }));
        }
        wanted
    }

    /// The part of a word, by the degree at which instants, and states there, of samples that are left out are met best.
    fn piece<'b>(
        &self,
        word: usize,
        degree: usize,
        levels: &[Option<Level>],
        (points, direct): (&[Vec<f64>], &CutMotions),
    ) -> Option<Piece<'b>> {
        let motions = &self.motions.words[word];
        let xi: Vec<Vec<f64>> = motions.samples.iter().map(|&sample| self.xi[sample].clone()).collect();
        let k = xi.first()?.len();
        let ends = self.ends(word, levels);
        let depths: Vec<Level> = ends.iter().filter(|(_, sign)| *sign < 0.0).map(|(level, _)| level.clone()).collect();
        let of_degree = |degree: usize, depths: &[Level]| {
            let basis = Basis::Fitted(Fitted::new(degree, depths, k));
            let is_enough = xi.len() as f64 >= SAMPLES_A_TERM * basis.len() as f64 || degree == 0;
            let squares = LeastSquares::new(&basis.values(&xi), vec![1.0; xi.len()]).filter(|_| is_enough)?;
            let left_out = |values: &[f64]| {
                let [low, high] = [f64::min, f64::max].map(|pick| values.iter().copied().reduce(pick).unwrap_or(0.0));
                let error = squares.fit(values).map_or(f64::INFINITY, |(_, error)| largest(error));
                // What does not vary says nothing of a degree.
                if high > low { error / (high - low) } else { 0.0 }
            };
            let ends = motions.nodes.iter().filter_map(|nodes| nodes.last()).flat_map(|node| node.chunks_exact(xi.len()));
            let error: f64 = motions.times.iter().map(Vec::as_slice).chain(ends).map(left_out).sum();
            Some((error, basis, squares))
        };
        let none: &[Level] = &[];
        let tried = (0..=degree).flat_map(|degree| [none, &depths].map(|depths| of_degree(degree, depths)));
        let (_, basis, squares) = tried.flatten().min_by(|a, b| a.0.total_cmp(&b.0))?;
        let count = xi.len();
        let by_line = |values: &[f64], pick: fn((Vec<f64>, Vec<f64>)) -> Vec<f64>| -> Vec<f64> {
            values.chunks_exact(count).filter_map(|line| squares.fit(line)).flat_map(pick).collect()
        };
        let surrogate = SegmentSurrogate::new(basis, ends, motions, |values| by_line(values, |(own, _)| own));
        let errors = SegmentErrors::of_samples(motions, |values| by_line(values, |(_, left_out)| left_out));
        let own = &direct.words[word];
        let held_out: Vec<Vec<f64>> = own.samples.iter().map(|&sample| points[sample].clone()).collect();
        let errors = match held_out.is_empty() {
            true => errors,
            false => errors.or(&SegmentErrors::new(&surrogate, &held_out, own)),
        };
        Some(Piece { surrogate, errors, samples: xi })
    }
}

/// The box around some points, a little wider.
fn bounding<'x>(points: impl Iterator<Item = &'x Vec<f64>>) -> Option<Vec<[f64; 2]>> {
    let join = |a: Vec<[f64; 2]>, b: Vec<[f64; 2]>| {
        a.into_iter().zip(b).map(|(a, b)| [a[0].min(b[0]), a[1].max(b[1])]).collect()
    };
    let extent = points.map(|xi| xi.iter().map(|&xi| [xi, xi]).collect::<Vec<_>>()).reduce(join)?;
    let wider = |[low, high]: [f64; 2]| {
        let by = WIDER * (high - low).max(WIDER);
        [(low - by).max(-1.0), (high + by).min(1.0)]
    };
    Some(extent.into_iter().map(wider).collect())
}
