//! Coordinates that turn are expanded as the times at which one sample, that of their course, has their values.

use std::borrow::Cow;

use super::tuning::TUNING;
use crate::methods::closure::Closure;
use crate::methods::ensemble::{Ensemble, EnsembleError};
use crate::methods::validation::ValidationTable;
use crate::numerics::{Course, ParameterBox, Phase, Range, SparseBasis};

/// For each coordinate that turns, the corner of the box at which it turns furthest, estimated from samples at
/// `points`.
pub fn turning(direct: &ValidationTable, points: &[Vec<f64>], ensemble: &dyn Ensemble) -> Vec<Option<Vec<f64>>> {
    let Some(last) = direct.rows().checked_sub(1) else { return Vec::new() };
    let of_coordinate = |(coordinate, scale): (usize, &f64)| {
        let ends = direct.line(0, coordinate).iter().zip(direct.line(last, coordinate));
        let ways: Vec<f64> = ends.map(|(from, to)| to - from).collect();
        let mean = ways.iter().sum::<f64>() / ways.len() as f64;
        // Each parameter by how the way changes with it. NaN is no turn.
        let along = |axis: usize| points.iter().zip(&ways).map(|(xi, way)| xi[axis] * (way - mean)).sum::<f64>();
        let corner = |axis: usize| if along(axis) * mean < 0.0 { -1.0 } else { 1.0 };
        (mean.abs() > TUNING.turned * scale).then(|| (0..ensemble.domain().dimension()).map(corner).collect())
    };
    ensemble.scales().iter().enumerate().map(of_coordinate).collect()
}

/// Simulates corners of a box, one for each coordinate that turns: the number of simulations, and the coordinates'
/// courses there.
///
/// # Errors
/// If a corner cannot be assembled.
pub fn courses(
    ensemble: &dyn Ensemble,
    domain: &ParameterBox,
    corners: &[Option<Vec<f64>>],
) -> Result<(usize, Vec<Option<Course>>), EnsembleError> {
    let mut nodes: Vec<Vec<f64>> = Vec::new();
    for corner in corners.iter().flatten() {
        if !nodes.contains(corner) {
            nodes.push(corner.clone());
        }
    }
    let dense = if nodes.is_empty() { None } else { ensemble.dense_motions(&domain.samples(&nodes))? };
    let Some((times, values)) = dense else { return Ok((0, Vec::new())) };
    let (n, count) = (corners.len(), nodes.len());
    let course = |(coordinate, corner): (usize, &Option<Vec<f64>>)| {
        let sample = nodes.iter().position(|node| Some(node) == corner.as_ref())?;
        let line = |line: usize| values.chunks_exact(2 * n * count).map(|row| row[line * count + sample]).collect();
        Course::new(times.clone(), line(coordinate), line(n + coordinate))
    };
    Ok((count, corners.iter().enumerate().map(course).collect()))
}

/// The independent coordinates whose samples are on the way of a course.
pub(super) fn phases<'c>(
    closure: &dyn Closure,
    courses: &'c [Option<Course>],
    extent: &[(f64, f64)],
) -> Vec<(usize, Phase<'c>)> {
    let of = |&coordinate: &usize| {
        let (lower, upper) = extent[coordinate];
        let phase = courses.get(coordinate)?.as_ref()?.over(Range { lower, upper })?;
        Some((coordinate, phase))
    };
    closure.independent().iter().filter_map(of).collect()
}

/// Positions (n lines of samples), and velocities if there are any, with those of such coordinates as times of their
/// courses, and rates of these. `known` are the times, line by line of the courses, as far as they are known.
pub(super) fn as_times<'m>(
    motion: &'m [f64],
    phases: &[(usize, Phase)],
    courses: &[Option<Course>],
    known: &[f64],
    samples: usize,
) -> Cow<'m, [f64]> {
    let mut motion = Cow::Borrowed(motion);
    for (coordinate, phase) in phases {
        let (positions, velocities) = motion.to_mut().split_at_mut(courses.len() * samples);
        let line = |line: usize| line * samples..(line + 1) * samples;
        let mut known = known[line(courses[..*coordinate].iter().flatten().count())].iter();
        let mut velocities = velocities.get_mut(line(*coordinate)).into_iter().flatten();
        for position in &mut positions[line(*coordinate)] {
            let told = known.next().copied().filter(|&time| phase.holds(time));
            *position = told.unwrap_or_else(|| phase.time(*position));
            velocities.next().into_iter().for_each(|velocity| *velocity /= phase.at(*position).1);
        }
    }
    motion
}

/// Highest degree along each axis, or how far a coordinate that is expanded as times turns along it, in its scale: the
/// degree that polynomials of the coordinate itself would need. An axis turns it by the share of the coefficients whose
/// terms it has.
pub fn with_turns(
    basis: &SparseBasis,
    coefficients: &[f64],
    phases: &[(usize, Phase)],
    extent: &[(f64, f64)],
    scales: &[f64],
) -> Vec<u8> {
    let mut degrees = basis.orders().to_vec();
    for (coordinate, _) in phases {
        let (low, high) = extent[*coordinate];
        let own = &coefficients[coordinate * basis.len()..][..basis.len()];
        let sum = |axis: Option<usize>| -> f64 {
            let counts = |term: &usize| axis.is_none_or(|axis| basis.degrees(*term)[axis] > 0);
            (1..own.len()).filter(counts).map(|term| own[term].abs()).sum()
        };
        for (axis, degree) in degrees.iter_mut().enumerate() {
            let turns = (high - low) / scales[*coordinate] * (sum(Some(axis)) / sum(None));
            *degree = (turns.ceil().min(f64::from(u8::MAX)) as u8).max(*degree);
        }
    }
    degrees
}
