//! An ensemble over fewer parameters: where several act through one number alone, a line through the box from the least
//! to the greatest value of that number shows all of their effect.
//!
//! The number is continuous, so that along the line it takes every value that it has in the box, and each value of an
//! output occurs there. Eight parameters that a stiffness sees through their sum become one, and a polynomial in it
//! costs a simulation a degree (decision 0148).

use std::ops::Range as Rows;

use symdiff::jet::JetSpace;
use symdiff::taylor_model::ModelSpace;

use super::range_search::{Functions, Previous, RangeSearch};
use super::tuning::TUNING;
use crate::methods::closure::Closure;
use crate::methods::ensemble::{Combination, DenseMotions, Ensemble, EnsembleError, Sampling, Simulated};
use crate::methods::proof::{EnclosedRow, EnclosureEnd, Proof};
use crate::methods::validation::Validation;
use crate::numerics::{CutMotions, ParameterBox, Range, Sample, largest};

/// Motions of an ensemble over lines through its box.
pub(in crate::methods) struct Combined<'e> {
    ensemble: &'e dyn Ensemble,
    lines: Vec<Line<'e>>,
    /// From −1 to 1 along each line.
    domain: ParameterBox,
}

/// A line through the intervals of some parameters.
struct Line<'e> {
    /// Along it this has all values that it has in the box; `None` for a parameter alone.
    combination: Option<Combination<'e>>,
    /// The parameters, by number.
    parameters: Vec<usize>,
    /// Their values at both ends.
    ends: [Vec<f64>; 2],
}

impl<'e> Combined<'e> {
    /// `None` if the ensemble has no combinations from which anything is gained, or whose ranges can be found.
    pub fn new(ensemble: &'e dyn Ensemble) -> Option<Self> {
        let domain = ensemble.domain();
        let through = |combination| Line::through(domain, combination).filter(|line| line.is_shorter(domain));
        let mut lines: Vec<Line> = ensemble.combinations().into_iter().filter_map(through).collect();
        if lines.is_empty() {
            return None;
        }
        let alone = (0..domain.dimension()).filter(|own| lines.iter().all(|line| !line.parameters.contains(own)));
        let alone: Vec<Line> = alone.map(|parameter| Line::along(domain, parameter)).collect();
        lines.extend(alone);
        let nominal: Sample = lines.iter().map(|line| line.project(&domain.nominal)).collect();
        let (lower, upper) = (vec![-1.0; lines.len()], vec![1.0; lines.len()]);
        let domain = ParameterBox { nominal, lower, upper, zones: Vec::new() };
        Some(Self { ensemble, lines, domain })
    }

    /// The same validation samples, at the points of the lines at which combinations have their values.
    pub fn validation(&self, validation: &Validation) -> Validation {
        validation.at(validation.points.iter().map(|xi| self.project(xi)).collect())
    }

    /// The box with all its parameters.
    pub fn of_box(&self) -> &ParameterBox {
        self.ensemble.domain()
    }

    /// ξ of the box where all combinations are least, and where they are greatest.
    fn ends(&self) -> Vec<Vec<f64>> {
        let ends = |xi: f64| self.xi(&vec![xi; self.lines.len()]);
        [-1.0, 1.0].map(ends).into()
    }

    /// Points of the lines at which the combinations have their values at ξ of the box.
    pub fn project(&self, xi: &[f64]) -> Vec<f64> {
        let sample = self.of_box().sample(xi);
        self.lines.iter().map(|line| line.project(&sample)).collect()
    }

    /// ξ of the box at a point of the lines.
    pub fn xi(&self, along: &[f64]) -> Vec<f64> {
        self.of_box().xi(&self.embed(along))
    }

    /// Values for each parameter of the box from those along each line.
    pub fn of_parameters<T: Copy + Default>(&self, of_lines: &[T]) -> Vec<T> {
        let mut all = vec![T::default(); self.of_box().dimension()];
        for (line, &own) in self.lines.iter().zip(of_lines) {
            line.parameters.iter().for_each(|&parameter| all[parameter] = own);
        }
        all
    }

    /// The box's parameters at a point of the lines.
    fn embed(&self, along: &[f64]) -> Vec<f64> {
        let mut values = vec![0.0; self.of_box().dimension()];
        for (line, &xi) in self.lines.iter().zip(along) {
            line.parameters.iter().zip(line.at(xi)).for_each(|(&parameter, value)| values[parameter] = value);
        }
        values
    }

    fn samples(&self, samples: &[Sample]) -> Vec<Sample> {
        samples.iter().map(|along| self.embed(along).into()).collect()
    }
}

impl<'e> Line<'e> {
    fn along(domain: &ParameterBox, parameter: usize) -> Self {
        let ends = [vec![domain.lower[parameter]], vec![domain.upper[parameter]]];
        Self { combination: None, parameters: vec![parameter], ends }
    }

    /// `None` if a range of the combination cannot be found.
    fn through(domain: &ParameterBox, combination: Combination<'e>) -> Option<Self> {
        let parameters = combination.parameters.clone();
        let at = |xi: &[f64]| -> Vec<f64> {
            parameters.iter().zip(xi).map(|(&parameter, &xi)| domain.value(parameter, xi)).collect()
        };
        // The first has all its values along this, so that the last has, too; of those a part may be enough.
        let ends = ends_of(parameters.len(), &|xi| (combination.first)(&at(xi)))?.map(|end| at(&end));
        let whole = Self { combination: Some(combination), parameters, ends };
        let ends = ends_of(1, &|xi| whole.value(&whole.at(xi[0])))?.map(|end| whole.at(end[0]));
        Some(Self { ends, ..whole })
    }

    /// The last function of its combination.
    fn value(&self, values: &[f64]) -> f64 {
        self.combination.as_ref().map_or(values[0], |combination| (combination.last)(values))
    }

    /// Whether it spares a parameter, or a part of one's interval.
    fn is_shorter(&self, domain: &ParameterBox) -> bool {
        let ends = |parameter: usize| [domain.lower[parameter], domain.upper[parameter]];
        let is_end = |end: &Vec<f64>| ends(self.parameters[0]).contains(&end[0]);
        self.parameters.len() > 1 || !self.ends.iter().all(is_end)
    }

    /// Values of its parameters at ξ ∈ [−1, 1] of the line.
    fn at(&self, xi: f64) -> Vec<f64> {
        let [from, to] = &self.ends;
        let between = |(&from, &to): (&f64, &f64)| {
            let value = 0.5 * (1.0 - xi) * from + 0.5 * (1.0 + xi) * to;
            value.clamp(f64::min(from, to), f64::max(from, to))
        };
        from.iter().zip(to).map(between).collect()
    }

    /// Point of the line at which the combination has its value of a sample; the nearest end if the value lies beyond.
    fn project(&self, sample: &Sample) -> f64 {
        let own: Vec<f64> = self.parameters.iter().map(|&parameter| sample[parameter]).collect();
        let wanted = self.value(&own);
        let [mut below, mut above] = [-1.0, 1.0];
        for _ in 0..TUNING.halvings_of_combination {
            let middle = 0.5 * (below + above);
            let end = if self.value(&self.at(middle)) <= wanted { &mut below } else { &mut above };
            *end = middle;
        }
        0.5 * (below + above)
    }
}

/// ξ at which a function of k of them is least and greatest; `None` if that is not found.
fn ends_of(k: usize, function: &dyn Fn(&[f64]) -> f64) -> Option<[Vec<f64>; 2]> {
    let evaluate = |_: &[usize], points: &[Vec<f64>]| -> Vec<f64> { points.iter().map(|xi| function(xi)).collect() };
    let search = RangeSearch::new(k);
    let functions = Functions {
        outputs: vec![0],
        degrees: &vec![TUNING.degree_of_combination; k],
        are_polynomials: false,
        rounding: &[0.0],
        places: &[],
        evaluate: &evaluate,
    };
    let values = evaluate(&[0], search.points());
    let found = search.range(&functions, &[values], &mut Previous::default()).pop()?;
    let beside: Vec<Vec<f64>> = found.places.iter().flat_map(|end| points_beside(end)).collect();
    let exceeded = largest(evaluate(&[0], &beside).into_iter().map(|value| found.range.distance(value)));
    // Written so that NaN is no range.
    let is_found = found.range.width().is_finite() && exceeded <= TUNING.exceeded * found.range.width();
    is_found.then_some(found.places)
}

/// A little to both sides of a point along each axis, inside of the box.
fn points_beside(point: &[f64]) -> impl Iterator<Item = Vec<f64>> + '_ {
    (0..point.len()).flat_map(move |axis| {
        [-TUNING.beside_end, TUNING.beside_end].map(|by| {
            let mut beside = point.to_vec();
            beside[axis] = (beside[axis] + by).clamp(-1.0, 1.0);
            beside
        })
    })
}

impl Ensemble for Combined<'_> {
    fn domain(&self) -> &ParameterBox {
        &self.domain
    }

    fn outputs(&self) -> usize {
        self.ensemble.outputs()
    }

    fn rows(&self) -> usize {
        self.ensemble.rows()
    }

    fn time(&self, row: usize) -> f64 {
        self.ensemble.time(row)
    }

    fn rounding(&self, output: usize) -> f64 {
        self.ensemble.rounding(output)
    }

    fn has_kink(&self, output: usize) -> bool {
        self.ensemble.has_kink(output)
    }

    fn is_extreme(&self, output: usize) -> bool {
        self.ensemble.is_extreme(output)
    }

    fn jumps(&self, output: usize) -> bool {
        self.ensemble.jumps(output)
    }

    fn seen(&self, row: usize, output: usize) -> Range {
        self.ensemble.seen(row, output)
    }

    fn is_interrupted(&self) -> bool {
        self.ensemble.is_interrupted()
    }

    fn simulate(
        &self,
        samples: &[Sample],
        sampling: Sampling,
        reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
    ) -> Result<Simulated, EnsembleError> {
        self.ensemble.simulate(&self.samples(samples), sampling, reduce)
    }

    fn dense_motions(&self, samples: &[Sample]) -> Result<Option<DenseMotions>, EnsembleError> {
        self.ensemble.dense_motions(&self.samples(samples))
    }

    fn segments(&self, samples: &[Sample]) -> Result<Option<CutMotions>, EnsembleError> {
        self.ensemble.segments(&self.samples(samples))
    }

    fn jets(&self, _: &JetSpace, _: &mut dyn FnMut(Rows<usize>, &[f64])) -> Result<Simulated, EnsembleError> {
        Err("a combination of parameters has no Taylor polynomial of its own".into())
    }

    fn obstacle_to_enclosure(&self, _: Proof) -> Option<String> {
        Some("a combination of parameters".to_owned())
    }

    fn enclose(&self, _: Proof, _: &ModelSpace, _: &ParameterBox, _: &mut EnclosedRow) -> EnclosureEnd {
        EnclosureEnd::default()
    }

    fn scales(&self) -> &[f64] {
        self.ensemble.scales()
    }

    fn independent(&self, parameters: &[f64], motion: &[f64], time: f64) -> Vec<usize> {
        self.ensemble.independent(&self.embed(parameters), motion, time)
    }

    fn closure(&self, independent: Vec<usize>) -> Result<Box<dyn Closure + '_>, EnsembleError> {
        Ok(Box::new(AlongLines { combined: self, closure: self.ensemble.closure(independent)? }))
    }
}

/// A closure of the box at points of the lines.
struct AlongLines<'c> {
    combined: &'c Combined<'c>,
    closure: Box<dyn Closure + 'c>,
}

impl Closure for AlongLines<'_> {
    fn independent(&self) -> &[usize] {
        self.closure.independent()
    }

    fn needs_velocities(&self) -> bool {
        self.closure.needs_velocities()
    }

    fn outputs(&self, time: f64, count: usize, parameters: Vec<f64>, motion: Vec<f64>) -> Vec<f64> {
        let dimension = self.combined.of_box().dimension();
        let mut embedded = vec![0.0; dimension * count];
        for point in 0..count {
            let along: Vec<f64> = parameters.iter().skip(point).step_by(count).copied().collect();
            let values = self.combined.embed(&along);
            values.into_iter().enumerate().for_each(|(index, value)| embedded[index * count + point] = value);
        }
        self.closure.outputs(time, count, embedded, motion)
    }
}

/// ξ of the box where the numbers through which parameters act are least, and where they are greatest; none if every
/// parameter acts on its own.
pub fn ends_of_combinations(ensemble: &dyn Ensemble) -> Vec<Vec<f64>> {
    Combined::new(ensemble).iter().flat_map(Combined::ends).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bell on a ring: from the ring, which is in the box, to the farthest corner.
    #[test]
    fn a_line_has_all_values_of_a_combination() {
        let (lower, upper) = (vec![0.5, -1.0], vec![2.0, 1.5]);
        let domain = ParameterBox { nominal: vec![1.0, 0.0].into(), lower, upper, zones: Vec::new() };
        let squares = |p: &[f64]| (p[0] - 1.2).powi(2) + 2.0 * (p[1] - 0.1).powi(2);
        let bell = move |p: &[f64]| (-(squares(p) - 0.5).powi(2)).exp();
        let combination = Combination { parameters: vec![0, 1], first: Box::new(squares), last: Box::new(bell) };
        let line = Line::through(&domain, combination).unwrap();
        assert_eq!(line.at(-1.0), [2.0, 1.5]);
        assert!((squares(&line.at(1.0)) - 0.5).abs() < 1e-6, "{:?}", line.at(1.0));
        for sample in [[0.5, -1.0], [1.7, 0.3], [1.2, 1.5], [2.0, 1.5]] {
            let along = line.at(line.project(&sample.to_vec().into()));
            assert!((bell(&along) - bell(&sample)).abs() < 1e-12, "{sample:?} {along:?}");
        }
        let undefined = |p: &[f64]| (p[0] - 1.0).ln();
        let undefined = Combination { parameters: vec![0, 1], first: Box::new(undefined), last: Box::new(undefined) };
        assert!(Line::through(&domain, undefined).is_none());
    }
}
