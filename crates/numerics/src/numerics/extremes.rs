//! The extremes of functions of few parameters: local extremes on a lattice over the box, and then the peaks next to
//! them.
//!
//! The lattice is as dense as the functions ask for: where a value differs from the prediction of its neighbours by
//! some share of the function's range, the lattice is made finer along that axis. Every local extreme from which the
//! best may be within reach is refined. Points of a low-discrepancy sequence, which have nothing to do with the
//! lattice, check the result: a value beyond it makes the lattice finer, and where that cannot be, it is an error.
//! Nothing depends on the functions' size or sign.

use rustc_hash::FxHashMap;

use super::extent::Extent;
use super::lattice::Lattice;
use super::lattices::{CheckedLattice, Lattices};
use super::peak::Peak;
use super::range::Range;
use super::tuning::TUNING;

/// Values of some functions at points: function by function, point by point.
pub type ValuesAt<'f> = dyn Fn(&[Vec<f64>]) -> Vec<f64> + 'f;

/// The least and the largest value are sought.
const SIGNS: [f64; 2] = [-1.0, 1.0];

/// Extremes of functions over [−1, 1]^k at once: `evaluate` gives their values at some ξ, function by function. The
/// first lattice, of `lattices`, has `intervals` ≥ 2 along each axis. Differences of at most `least`, a number for each
/// function and at least its rounding, are not searched for. Unknown if a value on a lattice is NaN.
pub fn extremes(lattices: &Lattices, intervals: &[usize], least: &[f64], evaluate: &ValuesAt) -> Vec<Extent> {
    let mut intervals = intervals.to_vec();
    loop {
        let checked = lattices.of(&intervals);
        let CheckedLattice { lattice, count, points: all } = &*checked;
        let (count, checks) = (*count, &all[*count..]);
        let values = evaluate(all);
        let lines: Vec<(&[f64], &[f64])> =
            values.chunks_exact(all.len()).take(least.len()).map(|line| line.split_at(count)).collect();
        let finer = finer(lattice, &intervals, &lines, least);
        if finer != intervals {
            intervals = finer;
            continue;
        }
        let search = |(output, line): (usize, &(&[f64], &[f64]))| Search::new(output, least[output], lattice, line.0);
        let mut searches: Vec<Search> = lines.iter().enumerate().map(search).collect();
        for _ in 0..TUNING.more_candidates {
            climb(&mut searches.iter_mut().flat_map(|search| &mut search.ends).collect::<Vec<_>>(), evaluate);
            let mut refines = false;
            searches.iter_mut().for_each(|search| refines |= search.refine_more(lattice));
            if !refines {
                break;
            }
        }
        let mut found: Vec<Extent> = searches.iter().map(|search| search.extent(intervals.len())).collect();
        let beyond = |index: usize| {
            let range = &found[index].range;
            let beyond = lines[index].1.iter().map(|&value| range.distance(value)).fold(0.0, f64::max);
            beyond > least[index].max(TUNING.beyond_range * range.width())
        };
        let doubled: Vec<usize> = intervals.iter().map(|count| 2 * count).collect();
        if (0..found.len()).any(beyond) && has_room(&doubled) {
            intervals = doubled;
            continue;
        }
        found.iter_mut().zip(&lines).for_each(|(extent, line)| extent.include(checks, line.1));
        return found;
    }
}

fn has_room(intervals: &[usize]) -> bool {
    let points = intervals.iter().fold(1_usize, |points, count| points.saturating_mul(count + 1));
    points <= TUNING.lattice_points[intervals.len().clamp(1, TUNING.lattice_points.len()) - 1]
}

/// Intervals of a lattice that is finer along the axes along which some function is not resolved, as far as there is
/// room.
fn finer(lattice: &Lattice, intervals: &[usize], lines: &[(&[f64], &[f64])], least: &[f64]) -> Vec<usize> {
    let mut worst = vec![0.0_f64; intervals.len()];
    for ((values, _), &least) in lines.iter().zip(least) {
        let width = Range::of(values).width();
        if width > least {
            let residuals = lattice.residuals(values);
            let matters = worst.iter_mut().zip(residuals).filter(|(_, residual)| *residual > least);
            matters.for_each(|(worst, residual)| *worst = worst.max(residual / width));
        }
    }
    let mut finer = intervals.to_vec();
    let mut axes: Vec<usize> = (0..intervals.len()).filter(|&axis| worst[axis] > TUNING.coarse).collect();
    axes.sort_by(|&a, &b| worst[b].total_cmp(&worst[a]));
    for axis in axes {
        finer[axis] *= 2;
        if !has_room(&finer) {
            finer[axis] /= 2;
        }
    }
    finer
}

/// Extremes of other functions, not far from those of similar ones.
pub fn extremes_near(known: &[Extent], evaluate: &ValuesAt) -> Vec<Extent> {
    search_near(known, false, evaluate)
}

/// Extremes of functions near known places. Extremes known at corners of the box are believed.
pub fn extremes_from(known: &[Extent], evaluate: &ValuesAt) -> Vec<Extent> {
    search_near(known, true, evaluate)
}

fn search_near(known: &[Extent], corners_stay: bool, evaluate: &ValuesAt) -> Vec<Extent> {
    let near = |(output, extent): (usize, &Extent)| {
        let width = extent.range.width();
        let settled = TUNING.settled_end * width;
        let end = |end: usize| {
            let limits = [settled, TUNING.left_candidate * width];
            let near = End::near(output, &extent.places[end], &extent.spacing[end], SIGNS[end], limits);
            if corners_stay && extent.places[end].iter().all(|xi| xi.abs() == 1.0) {
                let best = [extent.range.lower, extent.range.upper][end];
                return End { best, gap: 0.0, found: true, ..near };
            }
            near
        };
        Search { ends: [0, 1].map(end).into(), settled, output, omitted: [Vec::new(), Vec::new()] }
    };
    let mut searches: Vec<Search> = known.iter().enumerate().map(near).collect();
    climb(&mut searches.iter_mut().flat_map(|search| &mut search.ends).collect::<Vec<_>>(), evaluate);
    let dimension = known.first().map_or(0, |extent| extent.places[0].len());
    searches.iter().map(|search| search.extent(dimension)).collect()
}

/// Search for one function.
struct Search {
    ends: Vec<End>,
    /// Number of the function, and its negligible difference.
    output: usize,
    settled: f64,
    /// Local extremes that are not refined, the highest last: their indices on the lattice, and how low and how high
    /// they may be; the former negative.
    omitted: [Vec<(usize, f64)>; 2],
}

/// Searches until each end is found, or cannot exceed the best by a difference that matters.
fn climb(ends: &mut [&mut End], evaluate: &ValuesAt) {
    let mut tops: FxHashMap<(usize, bool), f64> = FxHashMap::default();
    for _ in 0..TUNING.steps_to_end {
        let searched: Vec<usize> = (0..ends.len()).filter(|&end| !ends[end].found).collect();
        let (mut points, mut firsts) = (Vec::new(), Vec::with_capacity(searched.len() + 1));
        for &end in &searched {
            firsts.push(points.len());
            points.extend(ends[end].points());
        }
        if points.is_empty() {
            break;
        }
        firsts.push(points.len());
        let values = evaluate(&points);
        for (&end, bounds) in searched.iter().zip(firsts.windows(2)) {
            let around = &points[bounds[0]..bounds[1]];
            let of_output = ends[end].output * points.len() + bounds[0];
            ends[end].refine(around, &values[of_output..][..around.len()]);
            let top = tops.entry(ends[end].goal()).or_insert(f64::NEG_INFINITY);
            *top = top.max(ends[end].height());
        }
        for &end in &searched {
            let top = tops[&ends[end].goal()];
            ends[end].give_up(top);
        }
    }
}

impl Search {
    /// Search from the values of function number `output`, for which differences of `least` do not matter, on a
    /// lattice.
    fn new(output: usize, least: f64, lattice: &Lattice, values: &[f64]) -> Self {
        let range = Range::of(values);
        let settled = (TUNING.settled_end * range.width()).max(TUNING.settled_of_least * least);
        let mut search = Self { ends: Vec::new(), output, settled, omitted: [Vec::new(), Vec::new()] };
        let limits = [settled, settled.max(TUNING.left_candidate * range.width())];
        let end =
            |index: usize, sign: f64| End::near(output, &lattice.point(index), &lattice.spacing(index), sign, limits);
        for (sign, omitted) in SIGNS.into_iter().zip(&mut search.omitted) {
            if range.lower.is_nan() {
                search.ends.push(End { best: f64::NAN, found: true, ..end(0, sign) });
                continue;
            }
            let best = if sign > 0.0 { range.upper } else { -range.lower };
            let mut peaks = lattice.peaks(values, sign);
            // Peaks that cannot reach the best are omitted. The best itself stays, and comes first.
            peaks.retain(|&(_, height)| height >= best);
            let is_best = |index: usize| sign * values[index] == best;
            peaks.sort_by(|a, b| is_best(b.0).cmp(&is_best(a.0)).then(b.1.total_cmp(&a.1)).then(a.0.cmp(&b.0)));
            search.ends.extend(peaks.iter().take(TUNING.candidates).map(|peak| end(peak.0, sign)));
            omitted.extend(peaks.into_iter().skip(TUNING.candidates).rev());
        }
        search
    }

    /// The best value for an end, whichever sign it has there.
    fn best(&self, sign: f64) -> f64 {
        let ends = self.ends.iter().filter(|end| end.sign == sign);
        ends.fold(f64::NEG_INFINITY, |best, end| best.max(sign * end.best))
    }

    /// Refines more local extremes if an omitted one may exceed the best by a difference that matters. Returns whether
    /// it did.
    fn refine_more(&mut self, lattice: &Lattice) -> bool {
        let [below, above] = SIGNS.map(|sign| self.best(sign));
        let matters = self.settled.max(TUNING.left_candidate * (below + above));
        let mut more = false;
        for (index, best) in [below, above].into_iter().enumerate() {
            let left = &mut self.omitted[index];
            if left.last().is_some_and(|&(_, height)| height > best + matters) {
                let taken = left.split_off(left.len().saturating_sub(TUNING.candidates));
                let sign = SIGNS[index];
                let end = |(at, _): (usize, f64)| {
                    End::near(self.output, &lattice.point(at), &lattice.spacing(at), sign, [self.settled, matters])
                };
                self.ends.extend(taken.into_iter().rev().map(end));
                more = true;
            }
        }
        more
    }

    /// The extent from the best of all ends, over `dimension` parameters.
    fn extent(&self, dimension: usize) -> Extent {
        let best = |(sign, omitted): (f64, &Vec<(usize, f64)>)| {
            let omitted = omitted.last().map_or(f64::NEG_INFINITY, |&(_, height)| height);
            let ends = self.ends.iter().filter(|end| end.sign == sign);
            let best = ends.reduce(|a, b| if sign * b.best > sign * a.best { b } else { a })?;
            let given_up = self.ends.iter().filter(|end| end.sign == sign && end.given_up).map(End::promise);
            let beside = given_up.fold(omitted, f64::max);
            Some((best, best.gap.max(beside - best.height())))
        };
        let [Some((least, below)), Some((largest, above))] = [0, 1].map(|end| best((SIGNS[end], &self.omitted[end])))
        else {
            // There is no best where a value is NaN.
            return Extent::unknown(dimension);
        };
        Extent {
            range: Range { lower: least.best, upper: largest.best },
            gap: below.max(above),
            places: [least.best_xi.clone(), largest.best_xi.clone()],
            spacing: [least.spacing.clone(), largest.spacing.clone()],
        }
    }
}

/// Search for one end of a function's range from one place.
struct End {
    output: usize,
    sign: f64,
    /// The end is found when a step changes less than this.
    settled: f64,
    /// The search is given up if it may exceed another end's best by less than this.
    matters: f64,
    /// Distances of the first neighbours.
    spacing: Vec<f64>,
    /// Neighbourhood in which the peak is searched for, and where it is believed to be.
    around: Peak,
    xi: Vec<f64>,
    /// The best value seen, and where; NaN if one was not.
    best: f64,
    best_xi: Vec<f64>,
    /// Gain of the last step of the search.
    gap: f64,
    /// Whether the neighbours are nearer than those that were no better than the best.
    is_near: bool,
    found: bool,
    /// Whether it was left although it may be the best by an amount that does not matter.
    given_up: bool,
}

impl End {
    /// Search near a place, with neighbours at these distances.
    fn near(output: usize, xi: &[f64], spacing: &[f64], sign: f64, [settled, matters]: [f64; 2]) -> Self {
        let spacing: Vec<f64> = spacing.iter().map(|spacing| spacing.min(TUNING.near_extreme)).collect();
        let around = Peak::new(xi.to_vec(), spacing.clone());
        let best = -sign * f64::INFINITY;
        let (xi, best_xi) = (xi.to_vec(), xi.to_vec());
        Self {
            output,
            sign,
            settled,
            matters,
            spacing,
            around,
            best_xi,
            xi,
            best,
            gap: f64::NAN,
            is_near: false,
            found: false,
            given_up: false,
        }
    }

    /// Function of which it is an end.
    fn goal(&self) -> (usize, bool) {
        (self.output, self.sign > 0.0)
    }

    /// Its height.
    fn height(&self) -> f64 {
        self.sign * self.best
    }

    /// Height that it may reach, if each round that is left gains as much as the last one.
    fn promise(&self) -> f64 {
        self.height() + TUNING.steps_to_end as f64 * self.gap
    }

    /// Gives up if it cannot exceed the best by a difference that matters.
    fn give_up(&mut self, top: f64) {
        // Written so that nothing follows from NaN. A search that gained nothing may have been led away from its peak.
        if !self.found && self.gap > 0.0 && self.height() < top && self.promise() <= top + self.matters {
            (self.found, self.given_up) = (true, self.promise() > top + self.settled);
        }
    }

    /// Points at which the function is needed for the next step: around the peak, and on it.
    fn points(&self) -> impl Iterator<Item = Vec<f64>> {
        self.around.neighbours().chain([self.xi.clone()])
    }

    /// Takes in the values there.
    fn refine(&mut self, points: &[Vec<f64>], values: &[f64]) {
        let best = (0..values.len()).fold(0, |a, b| if self.sign * values[b] > self.sign * values[a] { b } else { a });
        let gain = self.sign * (values[best] - self.best);
        // NaN next to the lattice's points changes nothing.
        if gain > 0.0 {
            // Once may be by chance. (At first nothing is known, and NaN is not settled.)
            self.found = gain.max(self.gap) <= self.settled && !self.gap.is_nan();
            self.gap = gain;
            self.is_near = false;
            self.best = values[best];
            self.best_xi.clone_from(&points[best]);
            self.xi = self.around.vertex(&values[..values.len() - 1], self.sign);
            self.around = self.around.next(&self.xi);
        } else {
            // Nothing better around the best, or the quadratic led away from it.
            self.gap = 0.0;
            let vertex = self.around.vertex(&values[..values.len() - 1], self.sign);
            let stays = vertex.iter().zip(&self.best_xi).all(|(vertex, best)| (vertex - best).abs() <= TUNING.stays);
            // Neighbours so near show nothing more, and those that are not numbers do not either.
            let is_last = self.around.is_within(TUNING.finest) || values.iter().any(|value| value.is_nan());
            self.found = stays || (self.is_near && is_last);
            self.is_near = true;
            self.xi = if is_last { self.best_xi.clone() } else { vertex };
            self.around = self.around.nearer(&self.best_xi);
        }
    }
}

#[cfg(test)]
mod tests;
