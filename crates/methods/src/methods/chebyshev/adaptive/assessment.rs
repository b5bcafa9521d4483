//! Error of the surrogate of a sub-box: at nodes that are new to it, and at validation samples.

use super::Adaptation;
use super::tuning::TUNING;
use crate::methods::chebyshev::composition::tuning::TUNING as COMPOSITION;
use crate::methods::chebyshev::composition::{Composer, NodeMotions, Row};
use crate::methods::chebyshev::detail::Detail;
use crate::methods::chebyshev::estimator::RangeEstimator;
use crate::methods::chebyshev::range_search::Previous;
use crate::methods::chebyshev::sensitivity::SensitivityAnalysis;
use crate::methods::chebyshev::sub_box::SubBox;
use crate::methods::ensemble::{Ensemble, EnsembleError, Observed, lines};
use crate::methods::kept::KeptRow;
use crate::methods::result::Estimate;
use crate::numerics::{SAFETY_OF_SURROGATE, Surrogate, largest};

impl Adaptation<'_> {
    /// Number of observed values per row and sample.
    pub(super) fn lines(&self) -> usize {
        lines(self.ensemble, Observed::Motion)
    }

    /// Largest error of a sub-box's surrogate at new nodes, over the one that is allowed: that of the outputs that
    /// follow from its motion, against those that follow from the nodes' own.
    pub(super) fn errors_at(
        &mut self,
        surrogate: &Surrogate,
        sub_box: &SubBox,
        nodes: &[Vec<f64>],
        own: &[f64],
    ) -> Result<Vec<f64>, EnsembleError> {
        let own_stride = self.lines() * nodes.len();
        let reached = self.goal.rows().min(sub_box.rows()).min(own.len() / own_stride.max(1));
        let step = self.every.max(reached.div_ceil(TUNING.rows_at_nodes));
        let rows: Vec<usize> = (0..reached).rev().step_by(step).collect();
        let goal = &self.goal;
        let look = |index: usize, composed: &Row, _: &mut Previous| {
            let own = &own[rows[index] * own_stride..];
            let (expected, found) = (composed.evaluate_motion(nodes, own), composed.predict(nodes));
            let of_node = |node: usize| {
                let of_output = |(expected, found): (&[f64], &[f64])| expected[node] - found[node];
                let outputs = expected.chunks_exact(nodes.len()).zip(found.chunks_exact(nodes.len()));
                goal.share(rows[index], outputs.map(of_output))
            };
            (0..nodes.len()).map(of_node).collect::<Vec<f64>>()
        };
        let by_row = rows_of(
            &mut self.composer,
            self.ensemble,
            sub_box,
            surrogate,
            Looks { rows: &rows, velocities: false, block: COMPOSITION.rows_in_order },
            look,
        )?;
        Ok((0..nodes.len()).map(|node| largest(by_row.iter().map(|errors| errors[node]))).collect())
    }

    /// The examined rows of a sub-box, the last ones first.
    pub(super) fn looked_at(&self, sub_box: &SubBox) -> Vec<usize> {
        (0..self.goal.rows().min(sub_box.rows())).rev().step_by(self.every).collect()
    }

    /// Estimates a sub-box's error. A glance at some rows shows where it may be too large; those rows are examined
    /// closely, the worst first, until the error of one of them is too large.
    pub(super) fn check(&mut self, sub_box: &mut SubBox) -> Result<(), EnsembleError> {
        sub_box.estimates = None;
        let rows = self.looked_at(sub_box);
        let glance = self.glance(sub_box, &rows)?;
        let mut suspects: Vec<usize> = (0..rows.len()).filter(|&index| is_missed(glance[index])).collect();
        suspects.sort_by(|&a, &b| glance[b].total_cmp(&glance[a]).then(a.cmp(&b)));
        sub_box.error = glance.iter().filter(|error| **error <= 1.0).fold(0.0, |most, error| error.max(most));
        let mut suspects: &[usize] = &suspects.into_iter().map(|index| rows[index]).collect::<Vec<usize>>();
        // The worst alone at first: it decides most often.
        let mut together = 1;
        while !suspects.is_empty() && !is_missed(sub_box.error) {
            let (worst, others) = suspects.split_at(together.min(suspects.len()));
            let found = self.estimates(sub_box, worst, Detail::Errors)?.0;
            sub_box.error = largest([sub_box.error, self.worst(worst, &found)]);
            (suspects, together) = (others, 2 * together);
        }
        Ok(())
    }

    /// Largest error of estimates in some rows, as far as samples make it smaller, over the allowed one, with its
    /// safety.
    fn worst(&self, rows: &[usize], found: &[Estimate]) -> f64 {
        let of_row = |(&row, found): (&usize, &[Estimate])| {
            self.goal.share(row, found.iter().map(|found| SAFETY_OF_SURROGATE * (found.error - found.of_search)))
        };
        largest(rows.iter().zip(found.chunks_exact(self.goal.outputs.len())).map(of_row))
    }

    /// For each of some rows the largest error at the samples with the least and the largest values, over the one that
    /// is allowed.
    fn glance(&mut self, sub_box: &SubBox, rows: &[usize]) -> Result<Vec<f64>, EnsembleError> {
        let surrogate = Surrogate::sparse(&sub_box.grid);
        let goal = &self.goal;
        let look = |index: usize, row: &Row, _: &mut Previous| {
            let errors = row.errors_at_samples(sub_box.held_out(), rows[index]);
            goal.share(rows[index], errors.iter().map(|error| SAFETY_OF_SURROGATE * error))
        };
        rows_of(
            &mut self.composer,
            self.ensemble,
            sub_box,
            &surrogate,
            Looks { rows, velocities: false, block: COMPOSITION.rows_in_order },
            look,
        )
    }

    /// Estimates over a sub-box in some rows, by row and output, and the rows that are stored.
    fn estimates(
        &mut self,
        sub_box: &SubBox,
        rows: &[usize],
        detail: Detail,
    ) -> Result<(Vec<Estimate>, Vec<KeptRow>), EnsembleError> {
        let surrogate = Surrogate::sparse(&sub_box.grid);
        let estimator = RangeEstimator {
            search: &self.search,
            validation: sub_box.held_out(),
            halved: (detail != Detail::Errors).then_some((&self.validation.direct, &self.validation.halved)),
            sensitivity: (detail == Detail::Sensitivities).then(|| match self.combined {
                Some(combined) => SensitivityAnalysis::over(combined),
                None => SensitivityAnalysis::new(&sub_box.domain, &surrogate),
            }),
        };
        let keeps = self.kept.is_some() && detail != Detail::Errors;
        let look = |index: usize, row: &Row, previous: &mut Previous| {
            let found = estimator.estimate(row, rows[index], previous);
            let kept = keeps.then(|| row.kept(found.iter().map(|estimate| estimate.is_own).collect()));
            (found, kept)
        };
        // Errors alone are asked for of rows that are not neighbours.
        let (velocities, block) = if detail == Detail::Errors { (false, 1) } else { (true, COMPOSITION.rows_in_order) };
        let looks = Looks { rows, velocities, block };
        let found = rows_of(&mut self.composer, self.ensemble, sub_box, &surrogate, looks, look)?;
        let (found, kept): (Vec<Vec<Estimate>>, Vec<Option<KeptRow>>) = found.into_iter().unzip();
        Ok((found.concat(), kept.into_iter().flatten().collect()))
    }

    /// Estimates over a sub-box in all rows, if they are not known.
    pub(super) fn conclude_box(&mut self, sub_box: &mut SubBox, detail: Detail) -> Result<(), EnsembleError> {
        if sub_box.estimates.is_none() {
            let rows: Vec<usize> = (0..sub_box.rows()).collect();
            let found = self.estimates(sub_box, &rows, detail)?;
            sub_box.error = self.worst(&rows, &found.0);
            sub_box.estimates = Some(found);
        }
        Ok(())
    }
}

/// The examined rows of a sub-box's surrogate.
#[derive(Clone, Copy)]
pub(super) struct Looks<'a> {
    pub rows: &'a [usize],
    /// Whether velocities are expanded even where no output needs them.
    pub velocities: bool,
    /// Rows in a block: those that are neighbours share extremes.
    pub block: usize,
}

/// Applies `look` to some rows of a sub-box's surrogate.
pub(super) fn rows_of<T: Send>(
    composer: &mut Composer,
    ensemble: &dyn Ensemble,
    sub_box: &SubBox,
    surrogate: &Surrogate,
    Looks { rows, velocities, block }: Looks<'_>,
    look: impl Fn(usize, &Row, &mut Previous) -> T + Sync,
) -> Result<Vec<T>, EnsembleError> {
    let values = sub_box.values(rows.iter().copied());
    let times: Vec<f64> = rows.iter().map(|&row| ensemble.time(row)).collect();
    let stride = sub_box.lines * surrogate.samples().len();
    let motions = NodeMotions { times: &times, values: &values, stride, courses: &sub_box.courses };
    composer.rows(surrogate, &sub_box.domain, motions, velocities, block, look)
}

/// Whether an error is more than the one that is allowed, which is 1; NaN is.
fn is_missed(error: f64) -> bool {
    error > 1.0 || error.is_nan()
}
