//! The joint law of all uncertain parameters of a model.

use super::tuning::TUNING;
use super::zones::LawInZone;
use super::{intervals, law_summary};
use crate::model::{Description, Law};
use crate::numerics::PointSet;
use crate::numerics::statistics::{Copula, Distribution, JointLaw};
use crate::results::LawSummary;
use symdiff::math;

/// Laws and correlations of the uncertain parameters in the model's order.
pub struct Laws {
    /// Names of the parameters.
    pub names: Vec<String>,
    laws: Vec<Law>,
    /// Lower ends of the box that is bounded, SI.
    pub lower: Vec<f64>,
    /// Its upper ends, SI.
    pub upper: Vec<f64>,
    /// Nominal values, SI.
    pub nominal: Vec<f64>,
    /// Law of all of them, in the box that samples are drawn from; in zones by its polar coordinates.
    joint: JointLaw,
    /// Joint laws of parameters in zones.
    zones: Vec<LawInZone>,
}

impl Laws {
    /// Laws of a model.
    ///
    /// # Errors
    /// If nothing is uncertain.
    pub fn of(description: &Description) -> Result<Self, String> {
        let all: Vec<(&str, [f64; 3])> = intervals(description).collect();
        if all.is_empty() {
            return Err("no parameter is uncertain".to_owned());
        }
        let of = |&(name, [_, lower, upper]): &(&str, [f64; 3])| description.statistics.law(name, lower, upper);
        let along = |which: usize| -> Vec<f64> { all.iter().map(|(_, ends)| ends[which]).collect() };
        let names: Vec<String> = all.iter().map(|(name, _)| (*name).to_owned()).collect();
        let mut matrix: Vec<Vec<f64>> =
            (0..names.len()).map(|i| (0..names.len()).map(|j| f64::from(u8::from(i == j))).collect()).collect();
        for group in &description.statistics.correlations {
            let indices: Vec<Option<usize>> =
                group.names.iter().map(|name| names.iter().position(|known| known == name)).collect();
            for (i, row) in indices.iter().zip(&group.matrix) {
                for (j, &value) in indices.iter().zip(row) {
                    if let (Some(i), Some(j)) = (*i, *j) {
                        matrix[i][j] = value;
                    }
                }
            }
        }
        let copula =
            Copula::new(&matrix).map_err(|_| "the matrix of correlations is not positive definite".to_owned())?;
        let (nominal, lower, upper) = (along(0), along(1), along(2));
        let laws: Vec<Law> = all.iter().map(of).collect();
        let zones = LawInZone::all(description, &names);
        let ends = lower.iter().zip(&upper).map(|(lower, upper)| [*lower, *upper]).collect();
        let joint = JointLaw::new(distributions(&laws), copula, ends);
        Ok(Self { names, laws, lower, upper, nominal, joint, zones })
    }

    /// Number of parameters.
    pub fn dimension(&self) -> usize {
        self.laws.len()
    }

    /// Whether something may lie outside of the box.
    pub fn reach_beyond(&self) -> bool {
        self.outside() > 0.0
    }

    /// Has samples drawn from a box that has nearly all of the laws.
    pub fn widen(&mut self) {
        let wide = |(law, (lower, upper)): (&Law, (f64, f64))| ends(law, (lower, upper)).into();
        let box_ends = self.laws.iter().zip(self.bounded()).map(wide).collect();
        self.joint.set_box(box_ends);
    }

    /// The box that samples are drawn from: ends of each parameter.
    pub fn drawn(&self) -> impl Iterator<Item = [f64; 2]> {
        self.joint.box_ends().iter().copied()
    }

    /// Cuts off normal and lognormal laws at the box' ends.
    pub fn cut_off(&mut self) {
        for (index, law) in self.laws.iter_mut().enumerate() {
            if let Distribution::Normal { mean, sigma } = law.distribution {
                let (lower, upper) = (self.lower[index], self.upper[index]);
                law.distribution = Distribution::TruncatedNormal { mean, sigma, lower, upper };
            }
            if let Distribution::Lognormal { lower, upper, .. } = &mut law.distribution {
                (*lower, *upper) = (lower.max(self.lower[index]), upper.min(self.upper[index]));
            }
        }
        let box_ends = self.bounded().map(|(lower, upper)| [lower, upper]).collect();
        self.joint.set_box(box_ends);
        self.joint.set_laws(distributions(&self.laws));
    }

    /// Ends of the box that is bounded.
    fn bounded(&self) -> impl Iterator<Item = (f64, f64)> {
        self.lower.iter().copied().zip(self.upper.iter().copied())
    }

    /// Largest probability outside the box that is bounded.
    pub fn outside(&self) -> f64 {
        self.laws.iter().zip(self.bounded()).map(|(law, (a, b))| law.distribution.outside(a, b)).sum()
    }

    /// Largest probability outside the domain from which samples are drawn.
    pub fn left_out(&self) -> f64 {
        self.laws.iter().zip(self.drawn()).map(|(law, [a, b])| law.distribution.outside(a, b)).sum()
    }

    /// One replicate of samples: values of all parameters.
    pub fn samples(&self, number: usize, count: usize) -> PointSet {
        self.placed(self.joint.samples(number, count))
    }

    /// The samples with these independent normal scores.
    pub fn of_scores(&self, points: &[Vec<f64>]) -> PointSet {
        self.placed(self.joint.of_scores(points))
    }

    /// Samples with the laws of zones.
    fn placed(&self, mut samples: PointSet) -> PointSet {
        for zone in &self.zones {
            samples.for_each_mut(|sample| zone.place(sample));
        }
        samples
    }

    /// As they are printed.
    pub fn summaries(&self) -> Vec<LawSummary> {
        self.names
            .iter()
            .zip(&self.laws)
            .zip(self.bounded())
            .map(|((name, law), ends)| law_summary(name, law, ends))
            .collect()
    }
}

fn distributions(laws: &[Law]) -> impl Iterator<Item = &Distribution> {
    laws.iter().map(|law| &law.distribution)
}

/// The ends of an interval that has nearly all of a law.
pub(super) fn ends(law: &Law, (lower, upper): (f64, f64)) -> (f64, f64) {
    match law.distribution {
        Distribution::Normal { mean, sigma } => {
            (lower.min(mean - TUNING.sigmas_of_surrogate * sigma), upper.max(mean + TUNING.sigmas_of_surrogate * sigma))
        }
        Distribution::Lognormal { median, sigma, .. } => {
            let far = math::exp(TUNING.sigmas_of_surrogate * sigma);
            (lower.min(median / far), upper.max(median * far))
        }
        _ => (lower, upper),
    }
}
