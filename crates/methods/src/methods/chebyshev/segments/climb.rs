//! Ranges of the outputs at a time: the extremes over each part of the box that is in a segment, its surfaces included.
//!
//! Within such a part an output is smooth, but it may change much faster with the share of the segment than along a
//! surface on which that is the same: a contact is short beside the spread of its instants. A climb moves by a linear
//! programme in a trust region that is as narrow across these surfaces as it has to be: the steepest way that leaves
//! neither the box nor the segment. Then it is moved to the surface that it was to reach.

use super::ends::{Ends, HeldCorner};
use super::held::{Corner, Looked, Misses};
use super::is_corner;
use super::row::SegmentRow;
use super::seeds::Lattice;
use super::surrogate::Point;
use super::tuning::TUNING;
use crate::numerics::{Extent, Range, extremes_from};

/// A place on the way to an extreme.
#[derive(Clone)]
struct Climb {
    output: usize,
    /// −1 for the least value, 1 for the largest.
    sign: f64,
    segment: usize,
    point: Point,
    value: f64,
    radius: f64,
    of_share: f64,
}

impl Climb {
    /// The share of the segment that a point is at.
    fn share(&self, point: &Point, time: f64) -> f64 {
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

/// The outputs' ranges, with the places of their ends and their errors; samples tell of their misses at corners.
pub(super) fn ends(row: &SegmentRow, lattice: &Lattice, misses: Option<&Misses>) -> Vec<Ends> {
    let (seeds, mut climbs) = begun(row, lattice);
    for _ in 0..TUNING.moves {
        if !step(row, &mut climbs) {
            break;
        }
    }
    if !row.is_common() {
        TUNING.shares_of_ridge.iter().for_each(|&share| across(row, &mut climbs, share));
    }
    polish(row, &mut climbs);
    let of_outputs: Vec<[Option<&Climb>; 2]> = (0..row.outputs).map(|output| best(&climbs, output)).collect();
    let extents: Vec<Extent> = of_outputs.iter().map(|found| extent(row, *found)).collect();
    let places = extents.iter().flat_map(|extent| extent.places.iter().cloned()).collect();
    let points = row.piece.surrogate.points(places).into_iter().zip(of_outputs.iter().flatten());
    let in_segment = |(point, climb): (Point, &Option<&Climb>)| {
        (climb.map_or_else(|| point.segment(row.time), |climb| climb.segment), point)
    };
    let places: Vec<(usize, Point)> = points.map(in_segment).collect();
    let errors = row.errors(&places, &row.outputs_in(&places));
    let count = 2 * row.outputs;
    let errors = |output: usize| [0, 1].map(|end| errors[output * count + 2 * output + end]);
    let corners: Vec<[Option<Climb>; 2]> =
        of_outputs.iter().map(|ends| ends.map(|climb| climb.and_then(|climb| corner(row, climb)))).collect();
    let has_corners = corners.iter().flatten().any(Option::is_some);
    let ends = || climbs.iter().filter(|climb| !is_corner(&climb.point.xi)).map(|own| (own.segment, own.point.clone()));
    let looked = has_corners.then(|| Looked::at(row, seeds.into_iter().chain(ends()).collect()));
    let held = |climb: &Option<Climb>, error: f64| {
        let Climb { output, sign, segment, value, point, .. } = climb.as_ref()?;
        let corner = Corner { output: *output, sign: *sign, segment: *segment, value: *value, error, point };
        let beyond = looked.as_ref()?.beyond(row, &corner, misses);
        (beyond < error).then(|| HeldCorner { xi: point.xi.clone(), beyond })
    };
    let all = extents.into_iter().zip(&corners).enumerate();
    all.map(|(output, (extent, found))| {
        let errors = errors(output);
        Ends { extent, errors, corners: [0, 1].map(|end| held(&found[end], errors[end])) }
    })
    .collect()
}

/// The corner of the box that an end may be at: of parameters that change next to nothing any value is as good.
fn corner(row: &SegmentRow, climb: &Climb) -> Option<Climb> {
    let mut own = climb.clone();
    for axis in 0..own.point.xi.len() {
        if own.point.xi[axis].abs() == 1.0 {
            continue;
        }
        let moved = [-1.0, 1.0].map(|xi| [&own.point.xi[..axis], &[xi], &own.point.xi[axis + 1..]].concat());
        let points = row.piece.surrogate.points(moved.to_vec());
        let at: Vec<(&Point, usize, f64)> = points.iter().map(|point| (point, own.segment, row.time)).collect();
        let values = row.outputs_on(&at);
        let height = |end: usize| own.sign * values[own.output * 2 + end];
        let end = usize::from(height(1) > height(0));
        (own.value, own.point) = (values[own.output * 2 + end], points[end].clone());
    }
    let in_segment = own.point.segment(row.time) == own.segment || climb.point.xi == own.point.xi;
    let inside = climb.point.xi == own.point.xi || own.point.is_inside();
    (in_segment && inside).then_some(own)
}

/// The best climbs for both ends of an output.
fn best(climbs: &[Climb], output: usize) -> [Option<&Climb>; 2] {
    [-1.0, 1.0].map(|sign| {
        let own = climbs.iter().filter(|climb| climb.output == output && climb.sign == sign);
        own.reduce(|a, b| if sign * b.value > sign * a.value { b } else { a })
    })
}

/// The range that two climbs have found.
fn extent(row: &SegmentRow, found: [Option<&Climb>; 2]) -> Extent {
    let [Some(least), Some(most)] = found else { return Extent::unknown(row.domain.dimension()) };
    let range = Range { lower: least.value, upper: most.value };
    Extent::at(range, 0.0, [least, most].map(|climb| climb.point.xi.clone()))
}

/// Adds where quadratics go on from the best climbs: along a curved ridge linear programmes end early.
fn polish(row: &SegmentRow, climbs: &mut Vec<Climb>) {
    let known: Vec<Extent> = (0..row.outputs).map(|output| extent(row, best(climbs, output))).collect();
    let polished = extremes_from(&known, |points| {
        let points = row.piece.surrogate.points(points.to_vec());
        let values = row.outputs_at(&points).into_iter().enumerate();
        values.map(|(at, value)| if points[at % points.len()].is_inside() { value } else { f64::NAN }).collect()
    });
    for (output, (known, found)) in known.into_iter().zip(polished).enumerate() {
        let better = [found.range.lower < known.range.lower, found.range.upper > known.range.upper];
        let values = [found.range.lower, found.range.upper];
        for (end, xi) in found.places.into_iter().enumerate().filter(|(end, _)| better[*end]) {
            let point = row.piece.surrogate.points(vec![xi]).swap_remove(0);
            let (segment, sign) = (point.segment(row.time), [-1.0, 1.0][end]);
            climbs.push(Climb { output, sign, segment, point, value: values[end], radius: 0.0, of_share: 0.0 });
        }
    }
}

/// Places that are looked at, each in its segment, and climbs from the best of them.
fn begun(row: &SegmentRow, lattice: &Lattice) -> (Vec<(usize, Point)>, Vec<Climb>) {
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
fn step(row: &SegmentRow, climbs: &mut [Climb]) -> bool {
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

/// Moves all climbs to the vertex of the parabola across surfaces of equal share, through points that are so far to
/// either side: a contact's ridge is so narrow there that trust regions end before it.
fn across(row: &SegmentRow, climbs: &mut [Climb], share: f64) {
    if climbs.is_empty() {
        return;
    }
    let k = row.domain.dimension();
    let time = row.time;
    let points = |all: &[Vec<f64>]| row.piece.surrogate.points(all.to_vec());
    let values = |points: &[Point], climbs: &[Climb]| {
        let sides = points.len() / climbs.len().max(1);
        let at: Vec<(&Point, usize, f64)> =
            points.iter().enumerate().map(|(index, point)| (point, climbs[index / sides].segment, time)).collect();
        let values = row.outputs_on(&at);
        let of = |index: usize| {
            let climb = &climbs[index / sides];
            let is_inside = points[index].is_inside() && (0.0..=1.0).contains(&climb.share(&points[index], time));
            if is_inside { climb.sign * values[climb.output * at.len() + index] } else { f64::NAN }
        };
        (0..points.len()).map(of).collect::<Vec<f64>>()
    };
    let moved = |climb: &Climb, axis: usize| {
        let mut xi = climb.point.xi.clone();
        xi[axis] += inward(xi[axis]);
        xi
    };
    let beside: Vec<Vec<f64>> = climbs.iter().flat_map(|own| (0..k).map(move |axis| moved(own, axis))).collect();
    let beside = points(&beside);
    let of_climb = |(climb, beside): (&Climb, &[Point])| -> Vec<f64> {
        let here = climb.share(&climb.point, time);
        let slope = |axis: usize| (climb.share(&beside[axis], time) - here) / inward(climb.point.xi[axis]);
        let slopes: Vec<f64> = (0..k).map(slope).collect();
        let square: f64 = slopes.iter().map(|slope| slope * slope).sum();
        slopes.iter().map(|slope| share * slope / square).collect()
    };
    let ways: Vec<Vec<f64>> = climbs.iter().zip(beside.chunks_exact(k)).map(of_climb).collect();
    let along = |climb: &Climb, way: &[f64], by: f64| -> Vec<f64> {
        climb.point.xi.iter().zip(way).map(|(xi, way)| (xi + by * way).clamp(-1.0, 1.0)).collect()
    };
    let pairs: Vec<Vec<f64>> =
        climbs.iter().zip(&ways).flat_map(|(climb, way)| [-1.0, 1.0].map(|by| along(climb, way, by))).collect();
    let of_pairs = values(&points(&pairs), climbs);
    let vertex = |((climb, way), pair): ((&Climb, &Vec<f64>), &[f64])| {
        let (below, above) = (pair[0] - climb.sign * climb.value, pair[1] - climb.sign * climb.value);
        let by = 0.5 * (below - above) / (below + above);
        // A point that is not known leaves the climb where it is.
        let by = if below + above < 0.0 { by.clamp(-1.0, 1.0) } else { 0.0 };
        along(climb, way, by)
    };
    let ends: Vec<Vec<f64>> = climbs.iter().zip(&ways).zip(of_pairs.chunks_exact(2)).map(vertex).collect();
    let ends = points(&ends);
    let of_ends = values(&ends, climbs);
    for ((climb, point), value) in climbs.iter_mut().zip(ends).zip(of_ends) {
        if value > climb.sign * climb.value {
            (climb.value, climb.point) = (climb.sign * value, point);
        }
    }
}

/// The largest radius of trust regions in the share of the segment: any, where no event passes through the part.
fn widest_share(row: &SegmentRow) -> f64 {
    if row.is_common() { f64::INFINITY } else { TUNING.radius_of_share }
}

/// A difference that stays in the box.
fn inward(xi: f64) -> f64 {
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
        // What costs least ascent goes first: a linear programme with one constraint.
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
