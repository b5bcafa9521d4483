//! Where climbs by linear programmes end early: on the narrow ridge of a contact, along a ridge that is curved, and
//! next to a corner of the box along parameters that change next to nothing.

use super::climb::{Climb, inward};
use super::row::SegmentRow;
use super::surrogate::Point;
use super::tuning::TUNING;
use crate::numerics::{Extent, Range, extremes_from};

/// Follows ridges from the ends of climbs.
pub(super) fn follow(row: &SegmentRow, climbs: &mut Vec<Climb>) {
    if !row.is_common() {
        TUNING.shares_of_ridge.iter().for_each(|&share| across(row, climbs, share));
    }
    polish(row, climbs);
}

/// The best climbs for both ends of an output.
pub(super) fn best(climbs: &[Climb], output: usize) -> [Option<&Climb>; 2] {
    [-1.0, 1.0].map(|sign| {
        let own = climbs.iter().filter(|climb| climb.output == output && climb.sign == sign);
        own.reduce(|a, b| if sign * b.value > sign * a.value { b } else { a })
    })
}

/// The range that two climbs have found.
pub(super) fn extent(row: &SegmentRow, found: [Option<&Climb>; 2]) -> Extent {
    let [Some(least), Some(most)] = found else { return Extent::unknown(row.domain.dimension()) };
    let range = Range { lower: least.value, upper: most.value };
    Extent::at(range, 0.0, [least, most].map(|climb| climb.point.xi.clone()))
}

/// Adds results of quadratics that go on from the best climbs: along a curved ridge linear programmes end early.
fn polish(row: &SegmentRow, climbs: &mut Vec<Climb>) {
    let known: Vec<Extent> = (0..row.outputs).map(|output| extent(row, best(climbs, output))).collect();
    let polished = extremes_from(&known, &|points| {
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
        // An unknown point leaves the climb where it is.
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

/// The corner of the box that an end may be at: of parameters that change next to nothing any value is as good.
pub(super) fn corner(row: &SegmentRow, climb: &Climb) -> Option<Climb> {
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
    let is_own = own.point.xi == climb.point.xi;
    (is_own || own.point.segment(row.time) == own.segment && own.point.is_inside()).then_some(own)
}
