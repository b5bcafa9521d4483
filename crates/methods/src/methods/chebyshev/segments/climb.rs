//! Ranges of the outputs at a time: the extremes over each part of the box that is in a segment, its surfaces included.
//!
//! Within such a part an output is smooth, but it may change much faster with the share of the segment than along a
//! surface on which that is the same: a contact is short compared with the spread of its instants. A climb moves by a
//! linear programme in a trust region that is as narrow across these surfaces as it has to be: the steepest way that
//! leaves neither the box nor the segment. Then it is moved to the surface that it was to reach.

use super::row::SegmentRow;
use super::seeds::Lattice;
use super::surrogate::Point;
use super::tuning::TUNING;

/// A point on the way to an extreme.
#[derive(Clone)]
pub(super) struct Climb {
    pub output: usize,
    /// −1 for the least value, 1 for the largest.
    pub sign: f64,
    pub segment: usize,
    pub point: Point,
    pub value: f64,
    pub radius: f64,
    pub of_share: f64,
}

impl Climb {
    /// The share of the segment that a point is at.
    pub fn share(&self, point: &Point, time: f64) -> f64 {
        let [begin, end] = [point.times[self.segment], point.times[self.segment + 1]];
        (time - begin) / (end - begin)
    }
}

/// A move: where to, the share that is to be reached there, the share's slopes, and those of the margins.
struct Move {
    xi: Vec<f64>,
    share: f64,
    slopes: Vec<f64>,
    of_margins: Vec<Vec<f64>>,
}

/// Points that are examined, each in its segment, and climbs from the best of them.
pub(super) fn begun(row: &SegmentRow, lattice: &Lattice) -> (Vec<(usize, Point)>, Vec<Climb>) {
    let time = row.time;
    let surrogate = &row.piece.surrogate;
    let mut seeds: Vec<(usize, Point)> =
        lattice.looked_at().map(|point| (point.segment(time), point.clone())).collect();
    for segment in 0..surrogate.segments() {
        for share in [0.0, 0.5, 1.0] {
            // The start and the end of the motion are no surfaces.
            let is_end = segment == 0 && share == 0.0 || segment + 1 == surrogate.segments() && share == 1.0;
            let found = if is_end { Vec::new() } else { lattice.on_surface(surrogate, segment, share, time) };
            seeds.extend(found.into_iter().map(|point| (segment, point)));
        }
    }
    let is_in_segment = |segment: usize, point: &Point| {
        let [begin, end] = [point.times[segment], point.times[segment + 1]];
        (-TUNING.beyond_of_seed..=1.0 + TUNING.beyond_of_seed).contains(&((time - begin) / (end - begin)))
    };
    // A sample that a surface leaves outside of its word's part is of it nevertheless.
    let is_inside = |point: &Point| point.is_inside() || row.piece.samples.contains(&point.xi);
    seeds.retain(|(segment, point)| is_in_segment(*segment, point) && is_inside(point));
    if seeds.is_empty() {
        return (Vec::new(), Vec::new());
    }
    let values = row.outputs_in(&seeds);
    let mut climbs = Vec::new();
    for (output, values) in values.chunks_exact(seeds.len()).enumerate() {
        for sign in [-1.0, 1.0] {
            let mut order: Vec<usize> = (0..seeds.len()).filter(|&seed| values[seed].is_finite()).collect();
            order.sort_by(|&a, &b| (sign * values[b]).total_cmp(&(sign * values[a])));
            let mut chosen: Vec<usize> = Vec::new();
            for &seed in &order {
                let (segment, point) = &seeds[seed];
                let differs = |&other: &usize| {
                    let (of_other, other) = &seeds[other];
                    let is_apart = point.xi.iter().zip(&other.xi).any(|(a, b)| (a - b).abs() > TUNING.climbs_apart);
                    segment != of_other || is_apart
                };
                if chosen.len() < TUNING.climbs && chosen.iter().all(differs) {
                    chosen.push(seed);
                }
            }
            // Where two segments meet, both have the value there, and the ridge may be in either.
            let first = chosen.first().map(|&seed| seeds[seed].0);
            let is_other = |seed: &usize| Some(seeds[*seed].0) != first;
            if !chosen.iter().any(is_other) {
                chosen.extend(order.iter().copied().find(is_other));
            }
            climbs.extend(chosen.into_iter().map(|seed| {
                let (segment, point) = seeds[seed].clone();
                Climb {
                    output,
                    sign,
                    segment,
                    point,
                    value: values[seed],
                    radius: TUNING.radius,
                    of_share: widest_share(row),
                }
            }));
        }
    }
    (seeds, climbs)
}

/// Moves all climbs that have not ended; whether there are any.
pub(super) fn step(row: &SegmentRow, climbs: &mut [Climb]) -> bool {
    let mut going: Vec<&mut Climb> = climbs.iter_mut().filter(|climb| climb.radius > TUNING.least_radius).collect();
    if going.is_empty() {
        return false;
    }
    let k = row.domain.dimension();
    let beside = |climb: &&mut Climb| {
        let xi = climb.point.xi.clone();
        (0..k).map(move |axis| {
            let mut xi = xi.clone();
            xi[axis] += inward(xi[axis]);
            xi
        })
    };
    let around = row.piece.surrogate.points(going.iter().flat_map(beside).collect());
    let at: Vec<(&Point, usize, f64)> =
        around.iter().enumerate().map(|(index, point)| (point, going[index / k].segment, row.time)).collect();
    let values = row.outputs_on(&at);
    let mut moves = Vec::with_capacity(going.len());
    for (index, climb) in going.iter().enumerate() {
        let own = &around[index * k..][..k];
        let slopes = |of: &dyn Fn(usize) -> f64, here: f64| -> Vec<f64> {
            (0..k).map(|axis| (of(axis) - here) / inward(climb.point.xi[axis])).collect()
        };
        let value = |axis: usize| climb.sign * values[climb.output * at.len() + index * k + axis];
        let ascent = slopes(&value, climb.sign * climb.value);
        let share = climb.share(&climb.point, row.time);
        let slopes = slopes(&|axis| climb.share(&own[axis], row.time), share);
        let opposite: Vec<f64> = slopes.iter().map(|slope| -slope).collect();
        let room = [share.min(climb.of_share), (1.0 - share).min(climb.of_share)];
        let limits = climb.point.xi.iter().map(|xi| [(-1.0 - xi).max(-climb.radius), (1.0 - xi).min(climb.radius)]);
        let margins = &climb.point.margins;
        let of_margins: Vec<Vec<f64>> = (0..margins.len())
            .map(|end| {
                let of = |axis: usize| (own[axis].margins[end] - margins[end]) / inward(climb.point.xi[axis]);
                (0..k).map(of).collect()
            })
            .collect();
        let surfaces = [(&slopes[..], room[0]), (&opposite[..], room[1])].into_iter();
        let surfaces: Vec<(&[f64], f64)> =
            surfaces.chain(of_margins.iter().map(Vec::as_slice).zip(margins.iter().copied())).collect();
        let way = steepest(&ascent, &limits.collect::<Vec<_>>(), &surfaces);
        let by: f64 = slopes.iter().zip(&way).map(|(slope, by)| slope * by).sum();
        let xi = climb.point.xi.iter().zip(way).map(|(xi, by)| (xi + by).clamp(-1.0, 1.0)).collect();
        moves.push(Move { xi, share: (share + by).clamp(0.0, 1.0), slopes, of_margins });
    }
    let points_of = |moves: &[Move]| row.piece.surrogate.points(moves.iter().map(|to| to.xi.clone()).collect());
    let mut points = points_of(&moves);
    for _ in 0..TUNING.returns {
        let mut moved = false;
        for ((climb, to), point) in going.iter().zip(&mut moves).zip(&points) {
            let lacks = to.share - climb.share(point, row.time);
            moved |= !row.is_common() && lacks.abs() > TUNING.missed && back(&mut to.xi, &to.slopes, lacks);
            for (slopes, margin) in to.of_margins.iter().zip(&point.margins) {
                moved |= *margin < 0.0 && back(&mut to.xi, slopes, -TUNING.moved_back * margin);
            }
        }
        if !moved {
            break;
        }
        points = points_of(&moves);
    }
    let at: Vec<(&Point, usize, f64)> =
        points.iter().zip(&going).map(|(point, climb)| (point, climb.segment, row.time)).collect();
    let values = row.outputs_on(&at);
    let count = going.len();
    for (index, (climb, point)) in going.iter_mut().zip(&points).enumerate() {
        let value = values[climb.output * count + index];
        let in_segment = (-2.0 * TUNING.missed..=1.0 + 2.0 * TUNING.missed).contains(&climb.share(point, row.time));
        let inside = in_segment && point.is_inside();
        let rises = inside && climb.sign * value > climb.sign * climb.value;
        if rises {
            (climb.value, climb.point) = (value, point.clone());
        }
        let (of_xi, of_share) = if rises { TUNING.grows } else { TUNING.shrinks };
        (climb.radius, climb.of_share) =
            ((of_xi * climb.radius).min(1.0), (of_share * climb.of_share).min(widest_share(row)));
    }
    true
}

/// The largest radius of trust regions in the share of the segment: any, where no event passes through the part.
fn widest_share(row: &SegmentRow) -> f64 {
    if row.is_common() { f64::INFINITY } else { TUNING.radius_of_share }
}

/// A difference that stays in the box.
pub(super) fn inward(xi: f64) -> f64 {
    if xi > 0.0 { -TUNING.step_of_slopes } else { TUNING.step_of_slopes }
}

/// The move within limits that ascends most, and along the slopes of each surface by no less than −room.
/// One surface after the other: where several end a move, it may leave the first again, and is refused.
fn steepest(ascent: &[f64], limits: &[[f64; 2]], surfaces: &[(&[f64], f64)]) -> Vec<f64> {
    let favoured = |slope: f64, [low, high]: [f64; 2]| if slope > 0.0 { high } else { low };
    let mut way: Vec<f64> = ascent.iter().zip(limits).map(|(&slope, &limits)| favoured(slope, limits)).collect();
    for &(slopes, room) in surfaces {
        let mut lacks = -room.max(0.0) - slopes.iter().zip(&way).map(|(slope, by)| slope * by).sum::<f64>();
        if lacks <= 0.0 {
            continue;
        }
        // The axis that costs least ascent goes first: a linear programme with one constraint.
        let mut order: Vec<usize> = (0..way.len()).filter(|&axis| slopes[axis] != 0.0).collect();
        let cost = |axis: &usize| (ascent[*axis] / slopes[*axis]).abs();
        order.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
        for axis in order {
            let most = favoured(slopes[axis], limits[axis]) - way[axis];
            let share = (lacks / (slopes[axis] * most)).clamp(0.0, 1.0);
            if share.is_finite() && lacks > 0.0 {
                way[axis] += share * most;
                lacks -= share * slopes[axis] * most;
            }
        }
    }
    way
}

/// Moves a point back by its lack along a slope, within the box; whether it could be.
fn back(xi: &mut [f64], slope: &[f64], lacks: f64) -> bool {
    let is_free = |(xi, slope): (&f64, &f64)| if *slope > 0.0 { *xi < 1.0 } else { *xi > -1.0 };
    let free: Vec<bool> = xi.iter().zip(slope).map(is_free).collect();
    let square: f64 = slope.iter().zip(&free).filter(|(_, free)| **free).map(|(slope, _)| slope * slope).sum();
    if square <= 0.0 || square.is_nan() {
        return false;
    }
    for ((xi, slope), _) in xi.iter_mut().zip(slope).zip(free).filter(|(_, free)| *free) {
        *xi = (*xi + lacks * slope / square).clamp(-1.0, 1.0);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Greatest ascent of (2, 1) in the square, with x + y ≤ 0.5 left: the vertex where x is largest.
    #[test]
    fn moves_keep_to_the_side_of_a_surface() {
        let limits = [[-1.0, 1.0]; 2];
        let free = (&[0.0, 0.0][..], 1.0);
        let way = steepest(&[2.0, 1.0], &limits, &[(&[-1.0, -1.0], 0.5), free]);
        assert_eq!(way, [1.0, -0.5]);
        assert_eq!(steepest(&[2.0, 1.0], &limits, &[free, free]), [1.0, 1.0]);
        let mut xi = [1.0, 0.8];
        assert!(back(&mut xi, &[-1.0, -1.0], 1.0));
        assert!((xi[0] + xi[1] - 0.8).abs() < 1e-15);
    }
}
