//! Polynomials by least squares in the parts of a box of several words.
//!
//! In each part the degree is that with the smallest leave-one-out errors of instants, and of states there; samples are
//! added where a part has few. Behind a surface that is grazed motions change within a layer, which becomes a part of
//! its own where one polynomial does not suffice.

use super::basis::{Basis, Fitted, Level};
use super::parts::{Samples, WordPart};
use super::piece::{Piece, PieceMotions};
use super::surrogate::SegmentSurrogate;
use super::tuning::TUNING;
use crate::methods::ensemble::{Ensemble, EnsembleError};
use crate::numerics::{CutMotions, LeastSquares, SegmentMotions, corners, largest, spread};

/// Samples, and the motions with which their polynomials are compared.
pub(super) struct Fitting<'v> {
    pub samples: Samples,
    /// Highest degree.
    pub degree: usize,
    /// ξ of validation samples, and their motions.
    pub points: &'v [Vec<f64>],
    pub direct: CutMotions,
}

/// Pieces, the number of samples, and the time from which motions of no word are met, s.
type Found = (Vec<Piece>, usize, f64);

impl Fitting<'_> {
    /// The polynomials; `None` if samples that are added cannot be cut.
    ///
    /// # Errors
    /// If a sample cannot be assembled.
    pub fn pieces(mut self, ensemble: &dyn Ensemble) -> Result<Option<Found>, EnsembleError> {
        let shows = |word: &SegmentMotions| !word.samples.is_empty();
        if !self.samples.motions.words.iter().all(shows) {
            // A word that none of the samples has was met by one of those that are spread over the box.
            let k = ensemble.domain().dimension();
            let middle = vec![vec![0.0; k]];
            let mut others = [middle, corners(k, TUNING.corners), spread(k, TUNING.samples_of_parts * k)].concat();
            others.retain(|xi| !self.samples.xi.contains(xi));
            if !others.is_empty() && !self.add(ensemble, others)? {
                return Ok(None);
            }
        }
        let words = self.samples.motions.words.len();
        let mut parts: Vec<WordPart> = (0..words).map(|word| WordPart::of_word(word, &self.samples.motions)).collect();
        let (mut layer, mut covered) = (0, 0);
        loop {
            for _ in 0..TUNING.rounds_of_samples {
                let wanted = self.wanted(&parts);
                if wanted.is_empty() || ensemble.is_interrupted() {
                    break;
                }
                if !self.add(ensemble, wanted)? {
                    return Ok(None);
                }
            }
            let beside = if layer == 0 && covered == 0 { self.grazing(&parts) } else { Vec::new() };
            if !beside.is_empty() && !self.add(ensemble, beside)? {
                return Ok(None);
            }
            let levels = self.samples.levels();
            let (mut found, mut next, mut wanted) = (Vec::new(), Vec::new(), Vec::new());
            for part in &parts {
                let fitted = self.fitted(part, &levels);
                wanted.extend(fitted.iter().flat_map(|(_, piece)| self.uncovered(part, piece)));
                let misses = fitted.as_ref().is_some_and(|(misses, _)| *misses > TUNING.enough);
                let divided = fitted.as_ref().filter(|_| misses && layer < TUNING.layers);
                match divided.and_then(|(_, piece)| part.layers(&levels, &piece.samples)) {
                    Some(layers) => next.extend(layers),
                    None => next.push(part.clone()),
                }
                found.extend(fitted.map(|(_, piece)| piece));
            }
            if next.len() == parts.len() && !wanted.is_empty() && covered < TUNING.coverings {
                covered += 1;
                if !self.add(ensemble, wanted)? {
                    return Ok(None);
                }
            } else if next.len() == parts.len() {
                let all_known = self.samples.motions.words.iter().all(shows);
                let known_to = self.samples.motions.known_to.min(self.direct.known_to);
                let known_to = if all_known { known_to } else { 0.0 };
                return Ok(Some((found, self.samples.xi.len(), known_to)));
            }
            layer += usize::from(next.len() > parts.len());
            parts = next;
        }
    }

    /// Adds samples. Returns whether they can be cut.
    fn add(&mut self, ensemble: &dyn Ensemble, xi: Vec<Vec<f64>>) -> Result<bool, EnsembleError> {
        let Some(motions) = ensemble.segments(&ensemble.domain().samples(&xi))? else { return Ok(false) };
        self.samples.motions.append(motions, self.samples.xi.len());
        self.samples.xi.extend(xi);
        Ok(true)
    }

    /// The polynomials of a part, and their largest leave-one-out error as a share of the values' range.
    fn fitted(&self, part: &WordPart, levels: &[Option<Level>]) -> Option<(f64, Piece)> {
        let places = self.samples.places(part, levels);
        let motions = self.samples.motions.words[part.word].picked(&places);
        let xi: Vec<Vec<f64>> = motions.samples.iter().map(|&sample| self.samples.xi[sample].clone()).collect();
        xi.first()?;
        let (count, depths) = (xi.len(), part.depths(levels));
        // A line that is zero at an event, but for rounding, is no measure of it.
        let duration = largest(motions.times.iter().flatten().copied());
        let scales = motions.scales();
        let of_terms = |(degree, fitted): (usize, Fitted)| {
            let is_enough = count as f64 >= TUNING.samples_a_term * fitted.len() as f64 || degree == 0;
            let basis = Basis::Fitted(fitted);
            let squares = LeastSquares::new(&basis.values(&xi), vec![1.0; count]).filter(|_| is_enough)?;
            let left_out = |(values, scale): (&[f64], f64)| {
                let [low, high] = [f64::min, f64::max].map(|pick| values.iter().copied().reduce(pick).unwrap_or(0.0));
                let error = squares.fit(values).map_or(f64::INFINITY, |(_, error)| largest(error));
                // Values that vary by rounding only say nothing of a degree.
                if high - low > TUNING.rounding * scale { error / (high - low) } else { 0.0 }
            };
            let times = motions.times.iter().map(|times| (times.as_slice(), duration));
            let ends = motions.nodes.iter().filter_map(|nodes| nodes.last());
            let ends = ends.flat_map(|node| node.chunks_exact(count).zip(scales.iter().copied()));
            let misses = times.chain(ends).map(left_out).fold(0.0, f64::max);
            Some((misses, basis, squares))
        };
        let axes: Vec<usize> = depths.iter().map(|depth| depth.steepest(&xi)).collect();
        let of_degree = |degree: usize| {
            let plain = [&[][..], &depths].map(|depths| Fitted::new(degree, depths, &xi));
            let across = depths.iter().zip(&axes).filter(|_| degree > 0);
            let across = across.map(|(depth, &axis)| Fitted::across(degree, depth, axis, &xi));
            plain.into_iter().chain(across).map(|fitted| (degree, fitted)).collect::<Vec<_>>()
        };
        let tried = (0..=self.degree).flat_map(of_degree).filter_map(of_terms);
        let (misses, basis, squares) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let fits = |values: &[f64]| -> Vec<(Vec<f64>, Vec<f64>)> {
            values.chunks_exact(count).filter_map(|line| squares.fit(line)).collect()
        };
        let ends = part.ends(levels);
        let coefficients = |values: &[f64]| fits(values).into_iter().flat_map(|(own, _)| own).collect();
        let surrogate = SegmentSurrogate::new(basis, ends, &motions, coefficients).fitted_by(squares.clone());
        let without = |values: &Vec<f64>| -> Vec<f64> {
            let left_out = fits(values).into_iter().flat_map(|(_, left_out)| left_out);
            values.iter().zip(left_out).map(|(own, left_out)| own - left_out).collect()
        };
        let predicted = motions.mapped(without);
        let held_out = self.direct.words[part.word].clone();
        let points = held_out.samples.iter().map(|&sample| self.points[sample].clone()).collect();
        let motions = PieceMotions { fitted: motions, points, held_out };
        Some((misses, Piece::fitted(surrogate, xi, motions, &predicted)))
    }
}

#[cfg(test)]
mod tests {
    use std::ops::Range as Rows;

    use symdiff::jet::JetSpace;
    use symdiff::taylor_model::ModelSpace;

    use super::*;
    use crate::methods::closure::Closure;
    use crate::methods::ensemble::{Sampling, Simulated};
    use crate::methods::proof::{EnclosedRow, EnclosureEnd, Proof};
    use crate::numerics::{
        BoundaryMargins, ParameterBox, STEP_NODES, Sample, SegmentMotions, Surrogate, largest, spread, step_nodes,
    };

    /// Balls thrown up at speeds from 4.5 to 5.5 m/s, under a ceiling at a height of 1.3 m on a spring of ω²; those
    /// that are faster than a speed pass next to it.
    struct Throws {
        domain: ParameterBox,
        omega: f64,
        beside: f64,
    }

    const G: f64 = 9.81;

    /// Position and velocity after a time, from those at a wall of ω (0 in flight) about an origin.
    fn moved([y, v]: [f64; 2], omega: f64, t: f64) -> [f64; 2] {
        if omega == 0.0 {
            return [y + v * t - 0.5 * G * t * t, v - G * t];
        }
        let (sin, cos) = (omega * t).sin_cos();
        let sag = G / (omega * omega);
        [(y + sag) * cos + v / omega * sin - sag, -(y + sag) * omega * sin + v * cos]
    }

    impl Throws {
        /// Margin, instants, and the motion in each segment of a speed.
        fn cut(&self, speed: f64) -> (f64, Vec<f64>, Vec<[f64; 2]>) {
            let height = 1.3;
            let margin = (height - speed * speed / (2.0 * G)).max(speed - self.beside);
            if margin >= 0.0 {
                return (margin, vec![0.0, 1.0], vec![[0.0, speed]]);
            }
            let at = (speed * speed - 2.0 * G * height).sqrt();
            let begins = (speed - at) / G;
            let contact = 2.0 / self.omega * (at * self.omega / G).atan();
            (margin, vec![0.0, begins, begins + contact, 1.0], vec![[0.0, speed], [0.0, at], [height, -at]])
        }

        /// Motion at the nodes of each segment.
        fn nodes(&self, times: &[f64], starts: &[[f64; 2]], segment: usize) -> Vec<[f64; 2]> {
            let length = times[segment + 1] - times[segment];
            let omega = if segment == 1 { self.omega } else { 0.0 };
            let at = |share: &f64| {
                let [y, v] = moved(starts[segment], omega, share * length);
                [if segment == 1 { 1.3 + y } else { y }, v]
            };
            step_nodes().iter().map(at).collect()
        }
    }

    impl Ensemble for Throws {
        fn domain(&self) -> &ParameterBox {
            &self.domain
        }
        fn is_interrupted(&self) -> bool {
            false
        }
        fn segments(&self, samples: &[Sample]) -> Result<Option<CutMotions>, EnsembleError> {
            let cut: Vec<_> = samples.iter().map(|sample| self.cut(sample[0])).collect();
            let word = |segments: usize| {
                let own: Vec<usize> = (0..cut.len()).filter(|&sample| cut[sample].2.len() == segments).collect();
                let node = |segment: usize, node: usize| {
                    let line = |line: usize| own.iter().map(move |&sample| (sample, line)).collect::<Vec<_>>();
                    let value = |(sample, line): (usize, usize)| {
                        let (_, times, starts) = &cut[sample];
                        self.nodes(times, starts, segment)[node][line]
                    };
                    [line(0), line(1)].concat().into_iter().map(value).collect::<Vec<f64>>()
                };
                SegmentMotions {
                    samples: own.clone(),
                    steps: vec![vec![1.0]; segments],
                    times: (0..=segments).map(|begin| own.iter().map(|&own| cut[own].1[begin]).collect()).collect(),
                    nodes: (0..segments).map(|of| (0..STEP_NODES).map(|number| node(of, number)).collect()).collect(),
                }
            };
            let values = cut.iter().map(|(margin, ..)| *margin).collect();
            let boundaries = vec![BoundaryMargins { met: vec![1], missed: vec![0], values }];
            Ok(Some(CutMotions { words: vec![word(1), word(3)], boundaries, known_to: 1.0 }))
        }
        fn outputs(&self) -> usize {
            unreachable!()
        }
        fn rows(&self) -> usize {
            unreachable!()
        }
        fn time(&self, _: usize) -> f64 {
            unreachable!()
        }
        fn rounding(&self, _: usize) -> f64 {
            unreachable!()
        }
        fn has_kink(&self, _: usize) -> bool {
            unreachable!()
        }
        fn jumps(&self, _: usize) -> bool {
            unreachable!()
        }
        fn simulate(
            &self,
            _: &[Sample],
            _: Sampling,
            _: &mut dyn FnMut(Rows<usize>, &[f64]),
        ) -> Result<Simulated, EnsembleError> {
            unreachable!()
        }
        fn jets(&self, _: &JetSpace, _: &mut dyn FnMut(Rows<usize>, &[f64])) -> Result<Simulated, EnsembleError> {
            unreachable!()
        }
        fn obstacle_to_enclosure(&self, _: Proof) -> Option<String> {
            unreachable!()
        }
        fn enclose(&self, _: Proof, _: &ModelSpace, _: &ParameterBox, _: &mut EnclosedRow) -> EnclosureEnd {
            unreachable!()
        }
        fn scales(&self) -> &[f64] {
            unreachable!()
        }
        fn independent(&self, _: &[f64], _: &[f64], _: f64) -> Vec<usize> {
            unreachable!()
        }
        fn closure(&self, _: Vec<usize>) -> Result<Box<dyn Closure + '_>, EnsembleError> {
            unreachable!()
        }
    }

    /// Throws, and polynomials of those of the grid's samples.
    fn thrown(omega: f64, beside: f64) -> (Throws, Found) {
        let (nominal, lower, upper) = (vec![5.0].into(), vec![4.5], vec![5.5]);
        let throws =
            Throws { domain: ParameterBox { nominal, lower, upper, ..ParameterBox::default() }, omega, beside };
        let grid = Surrogate::tensor(&[5], &[6]);
        let cut = |xi: &[Vec<f64>]| throws.segments(&throws.domain.samples(xi)).unwrap().unwrap();
        let samples = Samples { xi: grid.samples().to_vec(), motions: cut(grid.samples()) };
        let points = spread(1, 8);
        let direct = cut(&points);
        let fitting = Fitting { samples, degree: 8, points: &points, direct };
        let found = fitting.pieces(&throws).unwrap().unwrap();
        (throws, found)
    }

    #[test]
    fn layers_behind_a_surface_are_resolved() {
        for omega in [30.0, 300.0] {
            let (throws, (pieces, count, _)) = thrown(omega, f64::INFINITY);
            assert!(count < 120, "{count}");
            for xi in spread(1, 97) {
                let beyond =
                    |piece: &&Piece| piece.surrogate.ends.iter().map(|end| -end.margin(&xi)).fold(0.0, f64::max);
                let piece = pieces.iter().min_by(|a, b| beyond(a).total_cmp(&beyond(b))).unwrap();
                let [point] = &piece.surrogate.points(vec![xi.clone()])[..] else { panic!() };
                let (_, times, _) = throws.cut(5.0 + 0.5 * xi[0]);
                assert_eq!(times.len(), point.times.len(), "at {xi:?}");
                let stated = &piece.errors().times;
                for ((own, truth), stated) in point.times.iter().zip(times).zip(stated) {
                    assert!((own - truth).abs() <= 3.0 * stated + 1e-12, "{own} {truth} {stated} at {xi:?}");
                }
                assert!(largest(stated.iter().copied()) < 1e-4);
            }
        }
    }

    /// The ceiling is met from 5.05 to 5.1 m/s only, where none of the grid's samples is.
    #[test]
    fn word_without_samples_in_the_grid_is_fitted() {
        let (throws, (pieces, _, known_to)) = thrown(30.0, 5.1);
        let words = |xi: &Vec<f64>| throws.cut(throws.domain.value(0, xi[0])).2.len();
        assert!(Surrogate::tensor(&[5], &[6]).samples().iter().map(words).all(|segments| segments == 1));
        let met = pieces.iter().filter(|piece| piece.surrogate.segments() == 3);
        assert!(met.count() > 0 && known_to > 0.0);
    }
}
