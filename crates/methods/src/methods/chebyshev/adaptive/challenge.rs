//! New validation samples for a surrogate that seems to be good enough: where it says that outputs are least and
//! largest, and where neither nodes nor earlier samples are.
//!
//! Samples that a surrogate has been refined against say little of it. So each time it meets them, and before its error
//! is stated, new ones are simulated, more the higher its degree, and only if it meets these too it is believed. They
//! stay validation samples: later refinements have to meet them as well.

use std::borrow::Cow;

use super::Adaptation;
use super::assessment::{Looks, rows_of};
use super::tuning::TUNING;
use crate::methods::chebyshev::composition::Row;
use crate::methods::chebyshev::range_search::Previous;
use crate::methods::chebyshev::sub_box::SubBox;
use crate::methods::ensemble::EnsembleError;
use crate::numerics::{Surrogate, spread};

impl Adaptation<'_> {
    /// Simulations that the next challenge of a sub-box may take.
    pub(super) fn reserve(sub_box: &SubBox) -> usize {
        if sub_box.challenged { 0 } else { most_ends(sub_box) + sub_box.spread_wanted() }
    }

    /// Adds new validation samples to a sub-box, as far as the budget allows.
    pub(super) fn challenge(&mut self, sub_box: &mut SubBox) -> Result<(), EnsembleError> {
        if std::mem::replace(&mut sub_box.challenged, true) {
            return Ok(());
        }
        let k = sub_box.domain.dimension();
        let mut points = self.ends(sub_box)?;
        let known = sub_box.spread;
        sub_box.spread += sub_box.spread_wanted();
        points.extend(spread(k, sub_box.spread).split_off(known));
        points.truncate(self.goal.budget.simulations.saturating_sub(self.goal.spent));
        if points.is_empty() {
            return Ok(());
        }
        let direct = self.hold_out(&sub_box.domain, &points)?;
        sub_box.direct = Cow::Owned(sub_box.direct.with(&direct));
        sub_box.points.to_mut().extend(points);
        self.check(sub_box)
    }

    /// Points near all points at which outputs are least or largest by the surrogate in the examined rows, and not near
    /// nodes or validation samples.
    fn ends(&mut self, sub_box: &SubBox) -> Result<Vec<Vec<f64>>, EnsembleError> {
        let rows = self.looked_at(sub_box);
        let surrogate = Surrogate::sparse(&sub_box.grid);
        let (search, goal) = (&self.search, &self.goal);
        // For each output, the width of its range over the allowed error, and the points of its ends.
        let look = |index: usize, row: &Row, previous: &mut Previous| {
            let found = row.range(search, previous).extents.into_iter().zip(&goal.outputs);
            let counting = found.filter(|(_, goal)| rows[index] < goal.rows);
            counting.map(|(found, goal)| (found.range.width() / goal.allowed, found.places)).collect::<Vec<_>>()
        };
        // The rows are no neighbours.
        let found = rows_of(
            &mut self.composer,
            self.ensemble,
            sub_box,
            &surrogate,
            Looks { rows: &rows, velocities: false, block: 1 },
            look,
        )?;
        let found = found.into_iter().flatten();
        // Outputs that hardly range are not off by much, unless all of it is in one corner: if all of them hardly
        // range, the widest one counts. NaN has no extremes.
        let widest = found.clone().map(|(width, _)| width).fold(0.0, f64::max).min(1.0);
        let matters = found.filter(|(width, _)| *width > 0.0 && *width >= widest);
        let places: Vec<Vec<f64>> = matters.flat_map(|(_, places)| places).collect();
        let known = surrogate.samples().iter().chain(sub_box.points.iter());
        let scale = Scale::of(sub_box);
        Ok(scale.cover(&places, known, most_ends(sub_box)))
    }
}

fn most_ends(sub_box: &SubBox) -> usize {
    TUNING.ends.max(TUNING.ends_a_parameter * sub_box.domain.dimension()).max(sub_box.grid.len() / TUNING.nodes_an_end)
}

/// Distances between points on the scale of a sub-box's surrogate.
struct Scale {
    /// Weight of each axis.
    weights: Vec<f64>,
    /// Nearer points are the same.
    near: f64,
}

impl Scale {
    fn of(sub_box: &SubBox) -> Self {
        let k = sub_box.domain.dimension();
        let first = |axis: usize| {
            let mut levels = vec![0; k];
            levels[axis] = 1;
            sub_box.surplus.get(&levels).copied().unwrap_or(0.0)
        };
        let first: Vec<f64> = (0..k).map(first).collect();
        let most = first.iter().copied().fold(0.0, f64::max);
        let weight = |own: f64| if most > 0.0 { own / most } else { 1.0 };
        let degrees = sub_box.degrees();
        let highest = degrees.iter().copied().max().unwrap_or(0).max(1);
        // An axis that matters little may still be off along it by more than is allowed: its nodes say how much.
        let weight = |own: f64, degree: u8| weight(own).max(f64::from(degree) / f64::from(highest));
        let weights = first.into_iter().zip(degrees).map(|(own, degree)| weight(own, degree)).collect();
        Self { weights, near: TUNING.near_end / f64::from(highest) }
    }

    fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let along = a.iter().zip(b).zip(&self.weights);
        along.map(|((a, b), weight)| weight * (a - b).abs()).fold(0.0, f64::max)
    }

    /// At most `most` of the places, so that each place is near one of them or of the known ones, if `most` are enough:
    /// always the one that is farthest from all before.
    fn cover<'p>(
        &self,
        places: &[Vec<f64>],
        known: impl Iterator<Item = &'p Vec<f64>> + Clone,
        most: usize,
    ) -> Vec<Vec<f64>> {
        let to_known =
            |place: &Vec<f64>| known.clone().map(|known| self.distance(place, known)).fold(f64::INFINITY, f64::min);
        let mut apart: Vec<f64> = places.iter().map(to_known).collect();
        let mut chosen = Vec::new();
        while chosen.len() < most {
            let farther = |a: usize, b: usize| if apart[b] > apart[a] { b } else { a };
            let Some(farthest) = (0..places.len()).reduce(farther).filter(|&place| apart[place] > self.near) else {
                break;
            };
            let new = &places[farthest];
            apart.iter_mut().zip(places).for_each(|(apart, place)| *apart = apart.min(self.distance(place, new)));
            chosen.push(new.clone());
        }
        chosen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_points_represent_many() {
        let scale = Scale { weights: vec![1.0, 0.01], near: 0.05 };
        let known = [vec![1.0, 1.0]];
        // Along the second axis all are alike.
        let places = [[1.0, -1.0], [0.97, 0.3], [-0.5, 1.0], [-0.52, -1.0], [0.2, 0.0]].map(|place| place.to_vec());
        assert_eq!(scale.cover(&places, known.iter(), 9), [places[3].clone(), places[4].clone()]);
        assert_eq!(scale.cover(&places, known.iter(), 1), [places[3].clone()]);
        assert!(scale.cover(&[], known.iter(), 9).is_empty());
    }
}
