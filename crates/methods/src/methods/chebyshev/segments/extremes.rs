//! The extremes of the outputs in a row of a part, and how far they may be off.

use super::climb::{Climb, begun, step};
use super::ends::{Ends, HeldCorner};
use super::held::{Corner, Looked, Misses};
use super::is_corner;
use super::ridges::{best, corner, extent, follow};
use super::row::SegmentRow;
use super::seeds::Lattice;
use super::surrogate::Point;
use super::tuning::TUNING;
use crate::numerics::{Extent, SAFETY_OF_SURROGATE};

/// The outputs' ranges, with the places of their ends and their errors; `misses` are those of samples, for ends at
/// corners.
pub(super) fn ends(row: &SegmentRow, lattice: &Lattice, misses: Option<&Misses>) -> Vec<Ends> {
    let (seeds, mut climbs) = begun(row, lattice);
    for _ in 0..TUNING.moves {
        if !step(row, &mut climbs) {
            break;
        }
    }
    follow(row, &mut climbs);
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
    // A corner far below the end does not count.
    let near_corner = |climb: &Climb, error: f64| {
        corner(row, climb).filter(|corner| (climb.value - corner.value).abs() <= SAFETY_OF_SURROGATE * error)
    };
    let of_output = |(output, ends): (usize, &[Option<&Climb>; 2])| {
        let errors = errors(output);
        [0, 1].map(|end| ends[end].and_then(|climb| near_corner(climb, errors[end])))
    };
    let corners: Vec<[Option<Climb>; 2]> = of_outputs.iter().enumerate().map(of_output).collect();
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
