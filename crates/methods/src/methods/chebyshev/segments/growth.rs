//! Polynomials of many parameters: terms are added from which most is expected, by the coefficients of the instants and
//! motions so far.

use rustc_hash::FxHashMap;

use super::surrogate::SegmentErrors;
use super::tuning::TUNING;
use crate::methods::ensemble::{Ensemble, EnsembleError};
use crate::numerics::{CutMotions, Range, SegmentMotions, SparseGrid, Surrogate, SurrogateWork, expected, largest};

/// A grid that grows, with the motions of its samples.
pub(super) struct Growth {
    pub grid: SparseGrid,
    pub motions: CutMotions,
}

/// Units of instants and motions.
struct Scales {
    /// Shortest segment, s.
    shortest: f64,
    /// Spans by line.
    spans: Vec<f64>,
}

impl Growth {
    /// Starts from a low degree; `None` if motions are not cut, or if it has too many terms.
    ///
    /// # Errors
    /// If a sample cannot be assembled.
    pub fn start(ensemble: &dyn Ensemble) -> Result<Option<Self>, EnsembleError> {
        let k = ensemble.domain().dimension();
        let mut grid = SparseGrid::new(&vec![TUNING.highest_degree; k]);
        let Some(first) = SparseGrid::simplex(&vec![TUNING.first_degree; k], TUNING.most_terms) else {
            return Ok(None);
        };
        (1..first.len()).for_each(|index| grid.add(first.levels(index)));
        let motions = motions_from(ensemble, &grid, 0)?;
        Ok(motions.map(|motions| Self { grid, motions }))
    }

    /// Highest degree along each axis.
    pub fn orders(&self) -> Vec<usize> {
        let level = |axis: usize| (0..self.grid.len()).map(|index| usize::from(self.grid.levels(index)[axis])).max();
        (0..self.grid.dimension()).map(|axis| level(axis).unwrap_or(0)).collect()
    }

    /// Grows to `wanted` terms, as far as there are any: `false` where nothing is added.
    ///
    /// # Errors
    /// If a sample cannot be assembled.
    pub fn grow(&mut self, ensemble: &dyn Ensemble, wanted: usize) -> Result<bool, EnsembleError> {
        let (before, Some(mut sizes)) = (self.grid.len(), self.sizes()) else { return Ok(false) };
        let rates = self.rates(&sizes);
        while self.grid.len() < wanted.min(TUNING.most_terms) {
            let candidates = self.grid.candidates().into_iter();
            let all = candidates.map(|levels| (foreseen(&sizes, &rates, &levels), levels));
            let Some((size, levels)) = all.max_by(|a, b| a.0.total_cmp(&b.0)) else { break };
            self.grid.add(&levels);
            sizes.insert(levels, size);
        }
        let Some(added) = motions_from(ensemble, &self.grid, before)? else { return Ok(false) };
        self.motions.append(added, before);
        Ok(self.grid.len() > before)
    }

    /// Largest error of an instant as a share of the shortest segment, and of a line as a share of its span.
    pub fn error(&self, errors: &SegmentErrors) -> f64 {
        let Some(scales) = self.motions.words.first().map(Scales::of) else { return f64::NAN };
        let times = errors.times.iter().map(|error| error / scales.shortest);
        let steps = errors.lines.iter().flatten();
        let lines = steps.flat_map(|lines| lines.iter().zip(&scales.spans).map(|(own, span)| own / span));
        largest(times.chain(lines))
    }

    /// Size of the coefficients of each term; `None` if samples meet other events.
    fn sizes(&self) -> Option<FxHashMap<Vec<u8>, f64>> {
        let motions = self.motions.words.first().filter(|word| word.samples.len() == self.grid.len())?;
        let (scales, surrogate) = (Scales::of(motions), Surrogate::sparse(&self.grid));
        let (terms, mut work) = (self.grid.len(), SurrogateWork::default());
        let mut sizes = vec![0.0_f64; terms];
        let mut note = |values: &[f64], units: &[f64]| {
            let coefficients = surrogate.coefficients(values, &mut work);
            for (line, unit) in coefficients.chunks_exact(terms).zip(units) {
                sizes.iter_mut().zip(line).for_each(|(size, own)| *size = size.max((own / unit).abs()));
            }
        };
        motions.times.iter().for_each(|times| note(times, &[scales.shortest]));
        motions.nodes.iter().flatten().for_each(|node| note(node, &scales.spans));
        Some((0..terms).map(|term| (self.grid.levels(term).to_vec(), sizes[term])).collect())
    }

    /// Rate at which coefficients of one parameter alone fall with the degree, by parameter.
    fn rates(&self, sizes: &FxHashMap<Vec<u8>, f64>) -> Vec<f64> {
        let rate = |(axis, order): (usize, usize)| {
            let size = |degree: usize| {
                let mut levels = vec![0; self.grid.dimension()];
                levels[axis] = degree as u8;
                sizes.get(&levels).copied().unwrap_or(0.0)
            };
            // Even or odd ones may be missing: pairs are compared, the first of which is not the constant.
            let (last, before) = (size(order), size((order - 1).max(1)));
            let pair = if order > 2 { (size(order - 2).max(before), last.max(before)) } else { (before, last) };
            if pair.0 > 0.0 { (pair.1 / pair.0).min(TUNING.slowest_fall) } else { 0.0 }
        };
        self.orders().into_iter().enumerate().map(rate).collect()
    }
}

impl Scales {
    fn of(motions: &SegmentMotions) -> Self {
        let count = motions.samples.len();
        let lengths =
            motions.times.windows(2).flat_map(|pair| pair[1].iter().zip(&pair[0]).map(|(end, own)| end - own));
        let lines = motions.nodes.first().and_then(|nodes| nodes.first()).map_or(0, |node| node.len() / count);
        let span = |line: usize| {
            let values = motions.nodes.iter().flatten().flat_map(|node| node[line * count..][..count].iter().copied());
            let width = Range::of(&values.collect::<Vec<f64>>()).width();
            // A line that does not move counts for nothing.
            if width > 0.0 { width } else { f64::INFINITY }
        };
        Self { shortest: lengths.fold(f64::INFINITY, f64::min), spans: (0..lines).map(span).collect() }
    }
}

/// Motions of the samples of a grid from an index on.
fn motions_from(ensemble: &dyn Ensemble, grid: &SparseGrid, from: usize) -> Result<Option<CutMotions>, EnsembleError> {
    let points: Vec<Vec<f64>> = (from..grid.len()).map(|index| grid.sample(index)).collect();
    ensemble.segments(&ensemble.domain().samples(&points))
}

/// Size of a coefficient that is expected of the sizes before it.
fn foreseen(sizes: &FxHashMap<Vec<u8>, f64>, rates: &[f64], levels: &[u8]) -> f64 {
    expected(levels, 1, |axis| rates[axis], |before| Some(sizes.get(before).copied().unwrap_or(0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (1 + a x + b y)⁻¹ has terms of the powers of a x + b y, so that the estimate of x y from the axes is right.
    #[test]
    fn mixed_term_is_predicted_from_lower_terms() {
        let (a, b) = (0.2, 0.05);
        let sizes: FxHashMap<Vec<u8>, f64> =
            [(vec![0, 0], 1.0), (vec![1, 0], a), (vec![0, 1], b), (vec![2, 0], a * a), (vec![0, 2], b * b)]
                .into_iter()
                .collect();
        assert!((foreseen(&sizes, &[a, b], &[1, 1]) - 2.0 * a * b).abs() < 1e-15);
        assert!(foreseen(&sizes, &[a, b], &[3, 0]) > foreseen(&sizes, &[a, b], &[0, 3]));
    }
}
