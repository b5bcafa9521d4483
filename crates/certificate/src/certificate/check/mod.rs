//! The checker: computes again what a certificate claims, and refuses it if the claim does not follow.
//!
//! Nothing but the equations and the arithmetic of Taylor models is trusted. For each piece of the box a start near the
//! given polynomials is proven; positions and velocities are the integrals of the accelerations that are given; over
//! each cell a motion cannot leave the tube about them ([`cell`]); at the rows its outputs are within the bounds.
//! Pieces have to cover the box, cells the time without a gap.

mod cell;
mod evaluation;
mod range;

use rayon::prelude::*;
use symdiff::Interval;
use symdiff::taylor_model::{MAX_ORDER, ModelSpace};

use super::frame::Frame;
use super::matrix::Models;
use super::spaces::{Cell, Space};
use super::tuning::TUNING;
use super::{Certificate, Certified, Piece, ProvenCell};
use cell::{Open, Passed, Shapes, Unknowns};
use evaluation::{Given, State, evaluate};
use range::Ranges;

/// Numbers of checked pieces, cells and bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Checked {
    /// Pieces of boxes.
    pub pieces: usize,
    /// Cells of time of all pieces.
    pub cells: usize,
    /// Bounds of an output at an instant.
    pub bounds: usize,
}

/// Why a certificate proves nothing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// Lengths or indices do not fit.
    #[error("system {system}: {what}")]
    Malformed {
        /// From 1.
        system: usize,
        /// The fault.
        what: String,
    },
    /// Some parameters are in no piece.
    #[error("system {system}: its pieces do not cover the box of the parameters")]
    NotCovered {
        /// From 1.
        system: usize,
    },
    /// Something of a piece does not follow.
    #[error("system {system}, piece {piece}: {why}")]
    Piece {
        /// From 1.
        system: usize,
        /// From 1.
        piece: usize,
        /// The statement, and why it does not follow.
        why: String,
    },
}

/// Checks a certificate on all threads.
///
/// # Errors
/// For the first thing that does not follow.
pub fn check(certificate: &Certificate) -> Result<Checked, Refusal> {
    let mut checked = Checked::default();
    for (index, own) in certificate.systems.iter().enumerate() {
        let system = index + 1;
        is_sound(own).map_err(|what| Refusal::Malformed { system, what })?;
        if !is_covered(own) {
            return Err(Refusal::NotCovered { system });
        }
        let of_piece = |(index, piece): (usize, &Piece)| {
            check_piece(own, piece).map_err(|why| Refusal::Piece { system, piece: index + 1, why })
        };
        own.pieces.par_iter().enumerate().map(of_piece).collect::<Vec<_>>().into_iter().collect::<Result<(), _>>()?;
        checked.pieces += own.pieces.len();
        checked.cells += own.pieces.iter().map(|piece| piece.cells.len()).sum::<usize>();
        checked.bounds += own.bounds.iter().flatten().flatten().count();
    }
    Ok(checked)
}

/// Whether lists have the lengths that they must have.
fn is_sound(own: &Certified) -> Result<(), String> {
    let wrong = |what: &str| Err(what.to_owned());
    let (k, equations) = (own.parameters.len(), &own.equations);
    if !equations.is_sound(k) {
        return wrong("equations have unknown names, or their number is not that of the unknowns");
    }
    if own.order > MAX_ORDER || own.order == 0 {
        return wrong("polynomials have an order that is not supported");
    }
    let is_box = |lower: &[f64], upper: &[f64]| {
        lower.len() == k && upper.len() == k && lower.iter().zip(upper).all(|(lower, upper)| lower <= upper)
    };
    let is_piece = |piece: &Piece| is_box(&piece.lower, &piece.upper);
    if !is_box(&own.lower, &own.upper) || !own.pieces.iter().all(is_piece) {
        return wrong("a box does not have two ends of each parameter, the smaller first");
    }
    if own.outputs.len() != equations.outputs.len() || own.bounds.iter().any(|row| row.len() != own.outputs.len()) {
        return wrong("a row does not have a bound of each output");
    }
    if own.times.len() != own.bounds.len()
        || own.times.first().is_some_and(|first| *first < 0.0)
        || !own.times.is_sorted()
    {
        return wrong("instants do not ascend from 0 s");
    }
    Ok(())
}

/// Whether pieces cover the box: in the grid through all their ends each part is in a piece.
fn is_covered(own: &Certified) -> bool {
    let ends = |axis: usize| -> Vec<f64> {
        let inside = own.pieces.iter().flat_map(|piece| [piece.lower[axis], piece.upper[axis]]);
        let mut ends: Vec<f64> = inside.filter(|end| own.lower[axis] < *end && *end < own.upper[axis]).collect();
        ends.extend([own.lower[axis], own.upper[axis]]);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        // A box without width has one part too.
        if ends.len() == 1 { [ends[0]; 2].to_vec() } else { ends }
    };
    let axes: Vec<Vec<f64>> = (0..own.lower.len()).map(ends).collect();
    let count = axes.iter().try_fold(1_usize, |count, ends| count.checked_mul(ends.len() - 1));
    let Some(count) = count.filter(|count| *count <= TUNING.most_parts) else { return false };
    (0..count).all(|part| {
        let mut rest = part;
        let part: Vec<[f64; 2]> = axes
            .iter()
            .map(|ends| {
                let at = rest % (ends.len() - 1);
                rest /= ends.len() - 1;
                [ends[at], ends[at + 1]]
            })
            .collect();
        own.pieces.iter().any(|piece| {
            part.iter().enumerate().all(|(axis, ends)| piece.lower[axis] <= ends[0] && ends[1] <= piece.upper[axis])
        })
    })
}

/// A piece's start, its cells, and the bounds at all rows.
fn check_piece(own: &Certified, piece: &Piece) -> Result<(), String> {
    let (equations, k) = (&own.equations, own.parameters.len());
    let (n, m) = (equations.coordinates, equations.multipliers);
    // Derivatives by differentiation lose more than symbolic ones: one order more than the search has.
    let (fine, coarse) = (Space::new(k, own.order), Space::new(k, own.order.div_ceil(2) + 1));
    let parameters = |space: &ModelSpace, first: usize| -> Vec<Vec<f64>> {
        let variable = |index: usize| {
            let mut model = vec![0.0; space.size()];
            space.variable(first + index, piece.lower[index], piece.upper[index], &mut model);
            model
        };
        (0..k).map(variable).collect()
    };
    let parameters = [parameters(&fine.cell, 1), parameters(&coarse.cell, 1), parameters(&fine.box_of, 0)];
    let shapes = Shapes { fine, coarse, parameters };
    let needed = equations.needed(&equations.motion);
    let indices = (2 * n..3 * n + m).collect();
    let motion = Unknowns { equations, rows: &equations.motion, needed: &needed, indices };
    let of_outputs = equations.needed(&equations.outputs);
    let ranges = Ranges::new(&shapes.fine.box_of);

    let (mut at, mut frame) = started(own, piece, &shapes)?;
    let (mut time, mut row) = (0.0, 0);
    let is_stated = |row: usize| own.bounds[row].iter().any(Option::is_some);
    for (index, proven) in piece.cells.iter().enumerate() {
        let why = |why: String| format!("cell {} from {time} s: {why}", index + 1);
        let cell = shaped(proven, time, &shapes, &motion).map_err(why)?;
        let passed = Passed::new(&motion, &shapes, &at, frame, proven).map_err(|open| why(said(&open, n)))?;
        while row < own.times.len() && own.times[row] <= cell.end() {
            if is_stated(row) {
                observed(own, row, &passed, &motion, &of_outputs, &shapes, &ranges)?;
            }
            row += 1;
        }
        time = cell.end();
        (at, frame) = (passed.end, passed.next);
    }
    match (row..own.times.len()).find(|&row| is_stated(row)) {
        None => Ok(()),
        Some(row) => Err(format!("its cells end at {time} s, and bounds are stated at {} s", own.times[row])),
    }
}

/// Why a cell is open, for people.
fn said(open: &Open, n: usize) -> String {
    match open {
        Open::Irregular => "no accelerations are proven over the tube".to_owned(),
        Open::Transition => "how distances grow is not proven".to_owned(),
        Open::Leaves { index, reached, tube } => {
            let (kind, number) = if *index < n { ("position", index) } else { ("velocity", &(index - n)) };
            format!("{kind} {number} may be {reached:.3e} from its polynomials, and the radius is {tube:.3e}")
        }
    }
}

/// Polynomials at the start, and how far the motion is from them there.
fn started(own: &Certified, piece: &Piece, shapes: &Shapes) -> Result<((Models, Models), Frame), String> {
    let (equations, space) = (&own.equations, &shapes.fine.box_of);
    let (n, m) = (equations.coordinates, equations.multipliers);
    let fill = |polynomials: &[Vec<f64>]| -> Result<Models, String> {
        let mut models = Models::zero(space, n, 1);
        if polynomials.len() != n || polynomials.iter().any(|own| own.len() >= space.size()) {
            return Err("the number of polynomials of the start is not that of the coordinates, or they are too long"
                .to_owned());
        }
        for (row, own) in polynomials.iter().enumerate() {
            models.at_mut(row, 0)[..own.len()].copy_from_slice(own);
        }
        Ok(models)
    };
    let (w, lambda) = (Models::zero(space, n, 1), Models::zero(space, m, 1));
    let mut state = State { q: fill(&piece.q)?, v: fill(&piece.v)?, w, lambda };
    let time = vec![0.0; space.size()];
    let given = Given { space, time: &time, parameters: &shapes.parameters[2] };
    for (level, rows) in equations.start.iter().enumerate() {
        let needed = equations.needed(rows);
        let indices = (level * n..(level + 1) * n).collect();
        let unknowns = Unknowns { equations, rows, needed: &needed, indices };
        let proven =
            unknowns.inverse(&given, &state).and_then(|inverse| unknowns.enclose(&given, &mut state, &inverse));
        let what = ["positions", "velocities"][level];
        proven.ok_or_else(|| format!("no {what} of the start are proven near their polynomials"))?;
    }
    let last = space.size() - 1;
    let radii = [&state.q, &state.v].into_iter().flat_map(|models| (0..n).map(|row| models.at(row, 0)[last]));
    let frame = Frame::new(&shapes.coarse.box_of, radii.collect());
    Ok(((state.q.without_radii(), state.v.without_radii()), frame))
}

/// The cell's time: a power of two long, at a multiple of it, from where the one before ends.
fn shaped(proven: &ProvenCell, time: f64, shapes: &Shapes, motion: &Unknowns) -> Result<Cell, String> {
    let (n, m) = (motion.equations.coordinates, motion.equations.multipliers);
    let ProvenCell { middle, half, w, lambda, tube } = proven;
    let is_power_of_two = *half > 0.0 && half.is_normal() && half.to_bits().trailing_zeros() >= 52;
    // The ends are then exact.
    let place = middle / half;
    if !is_power_of_two || place.fract() != 0.0 || place.abs() > 1e15 {
        return Err("half its length is no power of two, or its middle no multiple of that".to_owned());
    }
    let cell = Cell { middle: *middle, half: *half };
    if middle - half != time {
        return Err(format!("it begins at {} s", middle - half));
    }
    let size = shapes.fine.cell.size();
    let is_short = |own: &Vec<f64>| own.len() < size;
    if w.len() != n || lambda.len() != m || tube.len() != 2 * n || !w.iter().chain(lambda).all(is_short) {
        return Err(
            "the number of polynomials and radii is not that of the coordinates, or they are too long".to_owned()
        );
    }
    Ok(cell)
}

/// The outputs in a row.
fn observed(
    own: &Certified,
    row: usize,
    passed: &Passed,
    motion: &Unknowns,
    of_outputs: &[usize],
    shapes: &Shapes,
    ranges: &Ranges,
) -> Result<(), String> {
    let (space, time) = (&shapes.fine.box_of, own.times[row]);
    let tau = ((time - passed.cell.middle) / passed.cell.half).clamp(-1.0, 1.0);
    let mut state = passed.at(shapes, tau);
    let mut t = vec![0.0; space.size()];
    t[0] = time;
    let given = Given { space, time: &t, parameters: &shapes.parameters[2] };
    let solved = motion.inverse(&given, &state.bare()).and_then(|inverse| motion.enclose(&given, &mut state, &inverse));
    if solved.is_none() {
        // Outputs may not depend on them.
        for models in [&mut state.w, &mut state.lambda] {
            (0..models.rows).for_each(|row| space.constant(Interval::ENTIRE, models.at_mut(row, 0)));
        }
    }
    let found = evaluate(&own.equations, of_outputs, &given, &state, false);
    for ((name, &node), bounds) in own.outputs.iter().zip(&own.equations.outputs).zip(&own.bounds[row]) {
        let Some(ends) = *bounds else { continue };
        if !found[node].as_ref().is_some_and(|output| ranges.is_within(&output.value, ends)) {
            return Err(format!("output {name} at {time} s is not proven to be between {} and {}", ends[0], ends[1]));
        }
    }
    Ok(())
}
