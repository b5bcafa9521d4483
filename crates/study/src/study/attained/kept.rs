//! Polynomials through values and gradients as the surrogate of a run, for statistics of many parameters.

use super::surface::{Surface, Surfaces};
use super::{AttainedSearch, FollowedRow};
use crate::methods::{KeptRow, KeptSurrogate};
use crate::numerics::Interpolation;

/// The outputs in all rows; between those that are followed coefficients are interpolated over the time. `None` where
/// an output is in no row a polynomial.
pub(super) fn surrogate(
    search: &AttainedSearch<'_, '_>,
    surfaces: &Surfaces,
    followed: &[FollowedRow],
) -> Option<KeptSurrogate> {
    let (rows, outputs, terms) = (search.motions.rows(), search.motions.outputs(), surfaces.basis().len());
    let mut lines = vec![vec![vec![0.0; terms]; outputs]; rows];
    for output in 0..outputs {
        let known = followed.iter().filter(|own| own.output == output);
        let mut known: Vec<(usize, &Surface)> =
            known.filter_map(|own| Some((own.row, own.surface.as_ref()?))).collect();
        known.sort_by_key(|(row, _)| *row);
        let times: Vec<f64> = known.iter().map(|(row, _)| search.motions.time(*row)).collect();
        for (row, lines) in lines.iter_mut().enumerate() {
            let weights = Interpolation::new(&times, search.motions.time(row))?;
            for (index, weight) in weights.fine {
                let (_, Surface(coefficients)) = known[index];
                lines[output].iter_mut().zip(coefficients).for_each(|(sum, own)| *sum += weight * own);
            }
        }
    }
    let kept = lines.iter().enumerate().map(|(row, lines)| {
        let lines: Vec<&[f64]> = lines.iter().map(Vec::as_slice).collect();
        KeptRow::of_outputs(search.motions.time(row), &lines)
    });
    Some(KeptSurrogate::of_box(&search.study.domain, surfaces.basis(), kept.collect()))
}
