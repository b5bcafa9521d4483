//! Ranges of the outputs in a row over the box: apart for parameters that do not act together, on a lattice for up to
//! three that do, by climbs for more.

use super::tuning::TUNING;
use crate::numerics::{
    Extent, ExtremeSearch, Extremes, Lattices, Range, Separation, ValuesAt, extremes, extremes_from, largest, spread,
};

/// The extremes of each output in the row before, where they were searched for by climbs.
pub(super) type Previous = Vec<Option<Extremes>>;

/// Values of the outputs of these numbers, one after the other, at some ξ.
pub(super) type Evaluate<'f> = dyn Fn(&[usize], &[Vec<f64>]) -> Vec<f64> + 'f;

/// Functions of the parameters whose ranges are sought.
pub(super) struct Functions<'f> {
    /// Numbers of the outputs.
    pub outputs: Vec<usize>,
    /// Highest degree along each axis.
    pub degrees: &'f [u8],
    /// Whether they are polynomials of these degrees; else they are composed of such.
    pub are_polynomials: bool,
    /// Rounding of each output, below which no difference is searched for, by number of the output.
    pub rounding: &'f [f64],
    /// Points at which some of them are known to be large or small, by [`block`].
    pub places: &'f [Vec<Vec<f64>>],
    /// Their values.
    pub evaluate: &'f Evaluate<'f>,
}

/// Number of the block of outputs that are searched together with this one.
pub(super) const fn block(output: usize) -> usize {
    output / TUNING.outputs_together
}

/// Search for ranges over a box.
pub(super) struct RangeSearch {
    separation: Separation,
    lattices: Lattices,
    climbs: Option<ExtremeSearch>,
    /// Points at which the results of climbs are checked.
    checks: Vec<Vec<f64>>,
}

impl RangeSearch {
    /// Search for k parameters.
    pub fn new(k: usize) -> Self {
        // Mirrored, they are apart from the search's own.
        let checks = spread(k, TUNING.checks_of_climbs * k)
            .into_iter()
            .map(|xi| xi.into_iter().rev().map(|xi| -xi).collect())
            .collect();
        let climbs = (k > TUNING.lattice_parameters).then(|| ExtremeSearch::new(k));
        Self { separation: Separation::new(k), lattices: Lattices::default(), climbs, checks }
    }

    /// The search by climbs, for more parameters than a lattice can take.
    pub fn climbs(&self) -> Option<&ExtremeSearch> {
        self.climbs.as_ref()
    }

    /// Points at which functions have to be known before their ranges are sought.
    pub fn points(&self) -> &[Vec<f64>] {
        self.separation.points()
    }

    /// Ranges of functions, given their values at [`points`](Self::points).
    pub fn range(&self, functions: &Functions, values: &[Vec<f64>], previous: &mut Previous) -> Vec<Extent> {
        let mut found = Vec::with_capacity(values.len());
        for outputs in functions.outputs.chunk_by(|a, b| block(*a) == block(*b)) {
            let of_block = Functions { outputs: outputs.to_vec(), ..*functions };
            found.extend(self.range_of_block(&of_block, &values[found.len()..][..outputs.len()], previous));
        }
        found
    }

    /// The same of functions that are searched together.
    fn range_of_block(&self, functions: &Functions, values: &[Vec<f64>], previous: &mut Previous) -> Vec<Extent> {
        let k = functions.degrees.len();
        // Outputs that come apart in the same way are searched together.
        let mut alike: Vec<(Vec<Vec<usize>>, Vec<usize>)> = Vec::new();
        let mut defects = Vec::with_capacity(values.len());
        for (index, values) in values.iter().enumerate() {
            let of_output = |points: &[Vec<f64>]| (functions.evaluate)(&functions.outputs[index..=index], points);
            let separated = self.separation.of(values, &of_output);
            defects.push(separated.defect);
            match alike.iter_mut().find(|(groups, _)| *groups == separated.groups) {
                Some((_, places)) => places.push(index),
                None => alike.push((separated.groups, vec![index])),
            }
        }
        let mut found = vec![Extent::unknown(k); values.len()];
        for (groups, places) in &alike {
            let outputs: Vec<usize> = places.iter().map(|&index| functions.outputs[index]).collect();
            let extents = if groups.len() == 1 && groups[0].len() == k {
                self.together(functions, &outputs, previous)
            } else {
                let anchored: Vec<f64> = places.iter().map(|&index| values[index][0]).collect();
                let mut sums = self.apart(functions, &outputs, groups, &anchored);
                self.hold_sums(functions, &outputs, &mut sums, previous);
                sums
            };
            for (&index, mut extent) in places.iter().zip(extents) {
                extent.gap += defects[index];
                found[index] = extent;
            }
        }
        found
    }

    /// Ranges of outputs on which all parameters act together.
    fn together(&self, functions: &Functions, outputs: &[usize], previous: &mut Previous) -> Vec<Extent> {
        let evaluate = |points: &[Vec<f64>]| (functions.evaluate)(outputs, points);
        let Some(search) = &self.climbs else {
            let all: Vec<usize> = (0..functions.degrees.len()).collect();
            return extremes(&self.lattices, &functions.intervals(&all), &functions.rounding(outputs), &evaluate);
        };
        previous.resize(previous.len().max(outputs.iter().max().map_or(0, |most| most + 1)), None);
        // Neighbours are used only if all outputs have them.
        let neighbours: Option<Vec<Extremes>> = outputs.iter().map(|&output| previous[output].clone()).collect();
        let places = outputs.first().and_then(|&output| functions.places.get(block(output)));
        let places = places.map_or(&[][..], Vec::as_slice);
        let mut found = search.extremes(outputs.len(), &neighbours.unwrap_or_default(), places, &evaluate);
        let checked = evaluate(&self.checks);
        let lines = || checked.chunks_exact(self.checks.len());
        let beyond = |(found, line): (&Extremes, &[f64])| {
            line.iter().any(|&value| found.range.distance(value) > TUNING.beyond_range * found.range.width())
        };
        if found.iter().zip(lines()).any(beyond) {
            let places = [places, &self.checks].concat();
            found = search.extremes(outputs.len(), &[], &places, &evaluate);
        }
        outputs.iter().zip(&found).for_each(|(&output, found)| previous[output] = Some(found.clone()));
        let mut extents: Vec<Extent> = found.into_iter().map(extent).collect();
        extents.iter_mut().zip(lines()).for_each(|(extent, line)| extent.include(&self.checks, line));
        polish(&mut extents, &evaluate);
        extents
    }

    /// Ranges of outputs that are sums over groups of parameters; `anchored` are their values where all parameters are
    /// at the anchor.
    fn apart(&self, functions: &Functions, outputs: &[usize], groups: &[Vec<usize>], anchored: &[f64]) -> Vec<Extent> {
        let anchor = self.separation.embed(&[], &[]);
        let constant =
            |&value: &f64| Extent::at(Range { lower: value, upper: value }, 0.0, [anchor.clone(), anchor.clone()]);
        let mut sums: Vec<Extent> = anchored.iter().map(constant).collect();
        for group in groups {
            let evaluate = |points: &[Vec<f64>]| {
                let whole: Vec<Vec<f64>> = points.iter().map(|xi| self.separation.embed(group, xi)).collect();
                (functions.evaluate)(outputs, &whole)
            };
            let parts = if group.len() <= TUNING.lattice_parameters {
                extremes(&self.lattices, &functions.intervals(group), &functions.rounding(outputs), &evaluate)
            } else {
                let search = ExtremeSearch::new(group.len());
                let found = search.extremes(outputs.len(), &[], &[], &evaluate);
                let mut parts: Vec<Extent> = found.into_iter().map(extent).collect();
                polish(&mut parts, &evaluate);
                parts
            };
            for ((sum, part), anchored) in sums.iter_mut().zip(&parts).zip(anchored) {
                sum.range.lower += part.range.lower - anchored;
                sum.range.upper += part.range.upper - anchored;
                sum.gap += part.gap;
                for end in 0..2 {
                    for (index, &axis) in group.iter().enumerate() {
                        sum.places[end][axis] = part.places[end][index];
                        sum.spacing[end][axis] = part.spacing[end][index];
                    }
                }
            }
        }
        sums
    }
}

impl RangeSearch {
    /// Searches anew, over all parameters together, for the ranges of outputs that are no sums at the ends of these: a
    /// kink may lie between all points at which sums are tried.
    fn hold_sums(&self, functions: &Functions, outputs: &[usize], sums: &mut [Extent], previous: &mut Previous) {
        let places: Vec<Vec<f64>> = sums.iter().flat_map(|sum| sum.places.iter().cloned()).collect();
        let values = (functions.evaluate)(outputs, &places);
        let is_sum = |&index: &usize| {
            let (at_ends, range) = (&values[index * places.len() + 2 * index..][..2], sums[index].range);
            let apart = largest([at_ends[0] - range.lower, at_ends[1] - range.upper]);
            // Written so that NaN is no sum.
            apart <= TUNING.sum_off * range.width() + functions.rounding[outputs[index]]
        };
        let others: Vec<usize> = (0..outputs.len()).filter(|index| !is_sum(index)).collect();
        if !others.is_empty() {
            let wanted: Vec<usize> = others.iter().map(|&index| outputs[index]).collect();
            let found = self.together(functions, &wanted, previous);
            others.into_iter().zip(found).for_each(|(index, found)| sums[index] = found);
        }
    }
}

impl Functions<'_> {
    fn intervals(&self, axes: &[usize]) -> Vec<usize> {
        intervals(self.degrees, axes, self.are_polynomials)
    }

    fn rounding(&self, outputs: &[usize]) -> Vec<f64> {
        outputs.iter().map(|&output| self.rounding[output]).collect()
    }
}

/// Intervals of the first lattice along some axes, for polynomials or compositions of them.
fn intervals(degrees: &[u8], axes: &[usize], are_polynomials: bool) -> Vec<usize> {
    let index = axes.len().clamp(1, TUNING.lattice_parameters) - 1;
    let each =
        if are_polynomials { TUNING.intervals_of_polynomial[index] } else { TUNING.intervals_of_composed[index] };
    let along =
        |&axis: &usize| TUNING.least_intervals[index].max(each * usize::from(degrees[axis])).next_multiple_of(2);
    axes.iter().map(along).collect()
}

/// Continues climbs by quadratics: along a ridge climbs end early.
fn polish(extents: &mut [Extent], evaluate: &ValuesAt) {
    let polished = extremes_from(extents, evaluate);
    extents.iter_mut().zip(polished).for_each(|(extent, polished)| extent.improve(polished));
}

/// Extent from the result of a search, which may miss the ends by its tolerance.
pub(super) fn extent(found: Extremes) -> Extent {
    Extent::at(found.range, ExtremeSearch::TOLERANCE * found.range.width(), [found.lowest, found.highest])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As a crank's slider in the row in which some samples pass their dead point: all values on a ridge are nearly the
    /// same, and the best lies where the ridge ends. Climbs alone miss it by a thousandth of the range.
    #[test]
    fn the_end_of_a_ridge_is_found() {
        let weight = |axis: usize| if axis == 0 { 1.0 } else { 0.05 };
        let f = |xi: &[f64]| {
            let beside: f64 = xi.iter().enumerate().map(|(axis, xi)| weight(axis) * xi).sum::<f64>() - 0.5;
            xi[0] - 40.0 * beside * beside
        };
        let evaluate = |_: &[usize], points: &[Vec<f64>]| points.iter().map(|xi| f(xi)).collect::<Vec<f64>>();
        let search = RangeSearch::new(8);
        let values = evaluate(&[0], search.points());
        let functions = Functions {
            outputs: vec![0],
            degrees: &[2; 8],
            are_polynomials: false,
            rounding: &[0.0],
            places: &[],
            evaluate: &evaluate,
        };
        let found = &search.range(&functions, &[values], &mut Previous::default())[0];
        // ξ₁ + … + ξ₇ = −7 lets ξ₀ be 0.85 on the ridge, and next to it 1/80 more.
        let (upper, lower) = (0.85 + 1.0 / 160.0, -1.0 - 40.0 * 1.85 * 1.85);
        assert!((found.range.upper - upper).abs() < 1e-7 * (upper - lower), "{} of {upper}", found.range.upper);
        assert!((found.range.lower - lower).abs() < 1e-12, "{} of {lower}", found.range.lower);
    }
}
