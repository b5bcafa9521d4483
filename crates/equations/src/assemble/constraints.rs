//! The constraints of a mechanism, with their multipliers.

use symdiff::Scalar;

use super::mechanism::Mechanism;
use super::reaction::Reaction;
use super::system::{ConstraintInfo, Omission, ResidualUnit};
use super::teeth::reactions_are_asked;
use crate::assemble::tuning::TUNING;
use crate::elements::joints::Row;
use crate::grammar::JointCoordinate;
use crate::model::Description;
use crate::multibody::{Body, BuildError, EULER, Quaternion, RotationCoordinates};

/// Constraints of a kind, with their multipliers.
#[derive(Default)]
pub struct ConstraintRows<'g> {
    /// Names and units.
    pub infos: Vec<ConstraintInfo>,
    /// Φ, or Ψ.
    pub values: Vec<Scalar<'g>>,
    /// λ
    pub lambda: Vec<Scalar<'g>>,
}

/// The rows that constrain something.
#[derive(Default)]
pub struct Constraints<'g> {
    /// Φ
    pub positions: ConstraintRows<'g>,
    /// Ψ
    pub velocities: ConstraintRows<'g>,
    /// The joints that are no inboard joints.
    pub closures: Vec<usize>,
}

impl<'g> Constraints<'g> {
    /// Constraints of a mechanism of size `length`. The joints' reactions go to the mechanism; those of inboard joints
    /// follow from the motion, once the forces are known, and are zero here.
    pub fn of(
        m: &mut Mechanism<'g, '_>,
        description: &Description,
        length: f64,
        left_out: &mut Vec<Omission>,
    ) -> Result<Self, BuildError> {
        let mut constraints = Self::default();
        for (body, built) in description.bodies.iter().zip(&m.bodies) {
            if let Some(value) = normalisation(built) {
                let (name, joint) = (format!("{}.norm", body.name), body.name.clone());
                constraints.positions.add(ConstraintInfo { name, joint, unit: ResidualUnit::Number }, value);
            }
        }
        for (joint, p) in m.euler_parameters() {
            let owner = m.joints[joint].name.clone();
            m.normalisations.insert(joint, constraints.positions.values.len());
            let info = ConstraintInfo { name: format!("{owner}.norm"), joint: owner, unit: ResidualUnit::Number };
            // A joint may be called like a body.
            let multiplier = format!("lambda:joint:{}", info.name);
            constraints.positions.add_with(&multiplier, info, normalised(p));
        }
        let with_teeth = reactions_are_asked(m.questions);
        for (index, joint) in m.joints.iter().enumerate() {
            let kept = if m.tree.contains(index) {
                Vec::new()
            } else {
                constraints.closures.push(index);
                let [positions, velocities] = [m.rows(index)?, m.velocity_rows(index)?];
                let mut kept = constraints.positions.add_rows(m, index, positions, length, left_out)?;
                kept.extend(constraints.velocities.add_rows(m, index, velocities, length, left_out)?);
                kept
            };
            let mut reaction = Reaction::of(m.g, &*joint.kind, &kept);
            let tooth = match kept.as_slice() {
                &[(_, lambda)] if with_teeth => m.tooth_force(index, lambda)?,
                _ => None,
            };
            if let Some(tooth) = tooth {
                reaction = reaction.with_teeth(&tooth);
                m.teeth.push(tooth);
            }
            m.reactions.push(reaction);
            m.multipliers.push(match kept.as_slice() {
                &[(_, lambda)] => Some(lambda),
                _ => None,
            });
            for definition in m.definitions(index)? {
                let name = format!("{}.{}", joint.name, definition.name);
                let unit = match definition.coordinate {
                    JointCoordinate::Angle => ResidualUnit::Angle,
                    JointCoordinate::Displacement => ResidualUnit::Length,
                };
                constraints.positions.add(ConstraintInfo { name, joint: joint.name.clone(), unit }, definition.value);
            }
        }
        Ok(constraints)
    }
}

impl<'g> ConstraintRows<'g> {
    /// The rows of a joint that constrain anything, each with its multiplier, in a model of a size.
    fn add_rows(
        &mut self,
        m: &Mechanism<'g, '_>,
        index: usize,
        rows: Vec<Row<'g>>,
        length: f64,
        left_out: &mut Vec<Omission>,
    ) -> Result<Vec<(Row<'g>, Scalar<'g>)>, BuildError> {
        let joint = &m.joints[index];
        let mut kept = Vec::with_capacity(rows.len());
        for row in rows {
            let name = if row.name.is_empty() { joint.name.clone() } else { format!("{}.{}", joint.name, row.name) };
            let info = ConstraintInfo { name, joint: joint.name.clone(), unit: residual_unit(&row) };
            if is_effective(m, length, &info, row)? {
                kept.push((row, self.add(info, row.value)));
            } else {
                let why = "nothing that it constrains can move".to_owned();
                left_out.push(Omission { what: format!("constraint {}", info.name), why });
            }
        }
        Ok(kept)
    }

    pub(super) fn add(&mut self, info: ConstraintInfo, value: Scalar<'g>) -> Scalar<'g> {
        let multiplier = format!("lambda:{}", info.name);
        self.add_with(&multiplier, info, value)
    }

    /// The same with a name of its multiplier's symbol.
    fn add_with(&mut self, multiplier: &str, info: ConstraintInfo, value: Scalar<'g>) -> Scalar<'g> {
        let lambda = value.builder().variable(multiplier);
        self.infos.push(info);
        self.values.push(value);
        self.lambda.push(lambda);
        lambda
    }
}

/// (pᵀp − 1) / 2 of a body that turns by Euler parameters.
fn normalisation<'g>(body: &Body<'g>) -> Option<Scalar<'g>> {
    body.index[EULER + 1].filter(|_| body.rotation_coordinates == RotationCoordinates::Euler)?;
    Some(normalised(body.euler()))
}

/// (pᵀp − 1) / 2
fn normalised(p: Quaternion<'_>) -> Scalar<'_> {
    0.5 * (p.dot(p) - 1.0)
}

/// Unit of a row's Φ: m where its multiplier is a force, rad where it is a torque alone.
fn residual_unit(row: &Row) -> ResidualUnit {
    match (row.force.is_zero(), row.torque.is_zero()) {
        (false, _) => ResidualUnit::Length,
        (true, false) => ResidualUnit::Angle,
        (true, true) => ResidualUnit::Number,
    }
}

/// Whether a row constrains anything. One without a coordinate holds always, and is not needed, or never.
fn is_effective(m: &Mechanism, length: f64, info: &ConstraintInfo, row: Row) -> Result<bool, BuildError> {
    let value = [row.value];
    if !m.is_given(&value) {
        return Ok(true);
    }
    let samples = [
        (None, m.sample(&value, 0.0, |parameter| parameter.nominal)),
        (Some("at the parameters' lower bounds"), m.sample(&value, 0.0, |parameter| parameter.lower)),
        (Some("at the parameters' upper bounds"), m.sample(&value, 0.0, |parameter| parameter.upper)),
        (Some("at t = 1 s"), m.sample(&value, 1.0, |parameter| parameter.nominal)),
    ];
    for (at, values) in samples {
        let residual = values[0];
        // NaN is not closed.
        let closed = residual.abs() <= TUNING.closed * length.min(1.0);
        if !closed {
            let (joint, constraint) = (info.joint.clone(), info.name.clone());
            return Err(BuildError::Contradiction { joint, constraint, residual, at });
        }
    }
    Ok(false)
}
