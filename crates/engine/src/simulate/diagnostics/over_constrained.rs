//! Why a mechanism with more constraints than its coordinates can fulfil cannot be assembled.
//!
//! The rank of Φ_q is taken off the constraints, at a state in no particular position: there rows depend on others only
//! where the joints' kinds make them, and not since lengths or a symmetry do.

use nalgebra::{DMatrix, DVector};

use super::tuning::TUNING;
use crate::assemble::{ResidualUnit, System};
use crate::compile::StartProgram;
use crate::simulate::start::tuning::TUNING as START;
use crate::simulate::start::{dependent_rows, jacobian_rows};

/// Coordinates, constraints, and which of these the others imply, near a state (the layout's registers); `None` where
/// all can hold.
pub fn over_constrained(system: &System, start: &StartProgram, near: &[f64]) -> Option<String> {
    let mut state = near.to_vec();
    for (index, register) in start.layout.q.clone().enumerate() {
        // Additive recurrence: evenly spread, the same on every machine.
        let direction = 2.0 * ((index + 1) as f64 * 0.618_033_988_749_895).fract() - 1.0;
        state[register] += TUNING.off_position * system.coordinates[index].scale * direction;
    }
    let is_given = |index: usize| system.start.position[index].is_some();
    let rows: Vec<Vec<(usize, f64)>> = jacobian_rows(system, start, &state)
        .into_iter()
        .map(|row| row.into_iter().filter(|(index, _)| !is_given(*index)).collect())
        .collect();
    let dependent = dependent_rows(&rows, START.dependent_row);
    let &first = dependent.first()?;
    let (coordinates, constraints) = (system.q.len(), system.lambda.len());
    let given = match (0..coordinates).filter(|&index| is_given(index)).count() {
        0 => String::new(),
        given => format!(" ({given} given by `initial`)"),
    };
    let mut text = format!(
        "{coordinates} coordinates{given}, {constraints} constraints: over-constrained by {}",
        in_words(dependent.len())
    );
    if constraints <= TUNING.most_constraints {
        text += &format!("; {}", who_fixes(system, &rows, first));
    }
    Some(text)
}

/// Joints that together already fix the motion that a constraint fixes.
fn who_fixes(system: &System, rows: &[Vec<(usize, f64)>], constraint: usize) -> String {
    let dense = |row: &[(usize, f64)]| {
        let mut vector = DVector::zeros(system.q.len());
        row.iter().for_each(|&(index, value)| vector[index] += value);
        vector
    };
    let others: Vec<usize> = (0..constraint).collect();
    let columns: Vec<DVector<f64>> = others.iter().map(|&row| dense(&rows[row])).collect();
    let own = dense(&rows[constraint]);
    let shares = match columns.as_slice() {
        [] => DVector::zeros(0),
        columns => {
            let solution = DMatrix::from_columns(columns).svd(true, true).solve(&own, TUNING.part_of_row);
            solution.unwrap_or_else(|_| DVector::zeros(columns.len()))
        }
    };
    let has_part = |&row: &usize| (shares[row] * columns[row].norm()).abs() > TUNING.part_of_row * own.norm();
    let parts: Vec<usize> = others.into_iter().filter(has_part).collect();
    let info = &system.constraints[constraint];
    // If two joints fix one rotation, the message names both.
    let rotation = |row: &usize| {
        let other = &system.constraints[*row];
        other.unit == ResidualUnit::Angle && other.joint != info.joint
    };
    if let (ResidualUnit::Angle, Some(&other)) = (info.unit, parts.iter().rev().find(|row| rotation(row))) {
        return format!("`{}` fixes the rotation that `{}` needs", info.joint, system.constraints[other].joint);
    }
    let mut joints: Vec<&str> = Vec::new();
    for &row in &parts {
        let joint = system.constraints[row].joint.as_str();
        if joint != info.joint && !joints.contains(&joint) {
            joints.push(joint);
        }
    }
    match joints.split_last() {
        None => format!("`{}` has no coordinate left to move", info.name),
        Some((last, [])) => format!("`{last}` fixes `{}` already", info.name),
        Some((last, rest)) => {
            let rest: Vec<String> = rest.iter().map(|joint| format!("`{joint}`")).collect();
            format!("{} and `{last}` fix `{}` already", rest.join(", "), info.name)
        }
    }
}

fn in_words(count: usize) -> String {
    match count {
        1 => "one".to_owned(),
        2 => "two".to_owned(),
        3 => "three".to_owned(),
        _ => count.to_string(),
    }
}
