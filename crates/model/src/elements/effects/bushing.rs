//! Bushing: springs and dampers between two frames, along and about the axes of the first.
//!
//! With d = R_F₁ᵀ (r_B − r_A), q = (q₀, e) the rotation of the second frame against the first (`joints::pair`), and K,
//! C, K_t, C_t diagonal, in the first frame's axes,
//!
//! ```text
//! F_B = −(K d + C ḋ)                                       V = ½ dᵀ K d + 2 eᵀ K_t e          N, J
//! τ₂  = −(2 q₀ K_t e + 2 e × K_t e + C_t (ω₂ − ω₁))                                           N m
//! ```
//!
//! on the second body at B; the opposites act on the first body at the same point. ḋ is what an observer in the first
//! frame sees. 2 e is the rotation vector to second order, so K_t is the stiffness for small rotations, the torque of a
//! rotation by φ about an axis K_t sin φ: a bushing is no spring for full turns.
//!
//! Full matrices 𝐊, 𝐂 (6 × 6, displacements before rotations) add 𝐊 x + 𝐂 ẋ, x = (d, 2 e), ẋ = (ḋ, ω₂ − ω₁), with the
//! torque q₀ y + e × y of the rotational part y of 𝐊 x, so that V gains ½ xᵀ 𝐊 x. Where 𝐊 is not symmetric, or a
//! stiffness depends on the motion, there is no potential and none is counted.

use mbint_derive::Element;
use schemars::{Schema, SchemaGenerator};
use symdiff::{Formula, Scalar};

use super::{ForceElement, Forces, TypedSensor};
use crate::elements::Glyph;
use crate::grammar::quantity::Dimension;
use crate::grammar::{Image, Node, PerAxis, PointRef, Quantity, Reader, Span, SymbolTable, Value, values};
use crate::multibody::{BuildError, Matrix, Vector};
use crate::syntax::codes::Code;
use crate::syntax::yaml;

/// Springs and dampers between two frames.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "bushing",
    what = "a bushing",
    equation = "F = −(K d + C ḋ), τ = −(K_t 2e + C_t ω), or six by six; d, 2e in the first frame's axes",
    source = "Shabana, Dynamics of Multibody Systems, 5th ed. (2020)",
    example = "{ between: [arm.tip, ball], stiffness: [1e4, 2e4, 0], damping: 20, torsional_stiffness: 30 }"
)]
pub struct Bushing {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Stiffness along the axes of the first point's frame.
    #[quantity(unit = "N/m", default = 0)]
    pub stiffness: PerAxis,
    /// Damping along those axes.
    #[quantity(unit = "N*s/m", default = 0)]
    pub damping: PerAxis,
    /// Stiffness about those axes, for small rotations.
    #[quantity(unit = "N*m/rad", default = 0)]
    pub torsional_stiffness: PerAxis,
    /// Damping about those axes.
    #[quantity(unit = "N*m*s/rad", default = 0)]
    pub torsional_damping: PerAxis,
    /// Six rows: forces along and torques about those axes by displacements (N/m, N) and small rotations (N/rad,
    /// N*m/rad).
    #[key(unit = "N/m")]
    pub stiffness_matrix: Option<SixBySix>,
    /// The same by velocities and angular velocities.
    #[key(unit = "N*s/m")]
    pub damping_matrix: Option<SixBySix>,
}

impl ForceElement for Bushing {
    const GLYPH: Glyph = Glyph::Spring;
    const SENSORS: &'static [TypedSensor] = &[];

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let stiffness = Law::of(forces, [&self.stiffness, &self.torsional_stiffness], self.stiffness_matrix.as_ref())?;
        let damping = Law::of(forces, [&self.damping, &self.torsional_damping], self.damping_matrix.as_ref())?;
        let pair = forces.pair(self.between);
        let axes: [Vector; 3] = std::array::from_fn(|axis| pair.outward(Vector::along(forces.graph(), axis)));
        // Into the first frame.
        let inward = Matrix::from(axes);
        let (first, second) = (pair.first.point, pair.second.point);
        let omega = [first, second].map(|point| forces.angular_velocity(point.body));
        let relative_omega = omega[1] - omega[0];
        let q = pair.relative();
        let e = q.vector_part();

        let offset = pair.offset();
        let entrained = omega[0].cross(offset);
        let rate = second.velocity - first.velocity - entrained;
        let displacement = inward * offset;
        let elastic = stiffness.straight.weighting(displacement);
        let doubled = displacement.dot(elastic);
        let rate = inward * rate;
        let mut pull = elastic + damping.straight.weighting(rate);

        let twisted = stiffness.torsional.weighting(e);
        let elastic = 2.0 * conjugate(q[0], e, twisted);
        let spin = inward * relative_omega;
        let mut torque = elastic + damping.torsional.weighting(spin);

        let halved = e.dot(twisted);
        let mut potential = 0.5 * doubled + 2.0 * halved;
        let rotation = 2.0 * e;
        if let Some([force, moment]) = stiffness.full_times(displacement, rotation) {
            pull += force;
            torque += conjugate(q[0], e, moment);
            potential += 0.5 * (displacement.dot(force) + rotation.dot(moment));
        }
        if let Some([force, moment]) = damping.full_times(rate, spin) {
            pull += force;
            torque += moment;
        }
        let pull = in_ground(axes, pull);
        let there = forces.point_at(first.body, second.position);
        forces.between(&second, &there, pull);
        forces.torque(second.body, first.body, in_ground(axes, torque));
        if stiffness.is_symmetric() {
            forces.potential(&stiffness.coefficients(), potential);
        }
        Ok(())
    }
}

/// Stiffness or damping: by axis, and the full matrix if there is one.
struct Law<'g> {
    straight: Vector<'g>,
    torsional: Vector<'g>,
    full: Option<[[Scalar<'g>; 6]; 6]>,
}

impl<'g> Law<'g> {
    fn of(
        forces: &dyn Forces<'g>,
        [straight, torsional]: [&PerAxis; 2],
        full: Option<&SixBySix>,
    ) -> Result<Self, BuildError> {
        let (straight, torsional) = (forces.vector(straight)?, forces.vector(torsional)?);
        let mut matrix = full.map(|_| [[forces.graph().number(0.0); 6]; 6]);
        if let (Some(matrix), Some(full)) = (&mut matrix, full) {
            for (entry, formula) in matrix.iter_mut().flatten().zip(full.0.iter().flatten()) {
                *entry = forces.value(formula)?;
            }
        }
        Ok(Self { straight, torsional, full: matrix })
    }

    /// The full matrix times (displacement, rotation): a force and a torque.
    fn full_times(&self, displacement: Vector<'g>, rotation: Vector<'g>) -> Option<[Vector<'g>; 2]> {
        let along = [displacement.components(), rotation.components()].concat();
        let [fx, fy, fz, tx, ty, tz] = self.full?.map(|row| row[0].builder().dot(&row, &along));
        Some([[fx, fy, fz].into(), [tx, ty, tz].into()])
    }

    /// All its numbers.
    fn coefficients(&self) -> Vec<Scalar<'g>> {
        let full = self.full.iter().flatten().flatten().copied();
        self.straight.components().into_iter().chain(self.torsional.components()).chain(full).collect()
    }

    fn is_symmetric(&self) -> bool {
        let symmetric = |m: &[[Scalar; 6]; 6]| (0..6).all(|i| (0..i).all(|j| m[i][j] == m[j][i]));
        self.full.as_ref().is_none_or(symmetric)
    }
}

/// The torque q₀ y + e × y that does the work y · d(2 e).
fn conjugate<'g>(q0: Scalar<'g>, e: Vector<'g>, y: Vector<'g>) -> Vector<'g> {
    q0 * y + e.cross(y)
}

/// A vector along given axes.
fn in_ground<'g>(axes: [Vector<'g>; 3], a: Vector<'g>) -> Vector<'g> {
    axes.into_iter().zip(a.components()).fold(Vector::zero(a[0].builder()), |sum, (axis, part)| sum + part * axis)
}

/// Rows of forces, then torques, by displacements, then rotations, or by their rates.
#[derive(Clone, Debug)]
pub struct SixBySix(pub Box<[[Formula; 6]; 6]>);

impl Value for SixBySix {
    const IMAGE: Image = Image::SixRows;

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, _: Span, quantity: &Quantity) -> Option<Self> {
        // Force by displacement, force by rotation and torque by displacement, torque by rotation.
        let straight = quantity.dimension();
        let mixed = straight.times(Dimension::LENGTH);
        let dimensions = [straight, mixed, mixed.times(Dimension::LENGTH).per(Dimension::ANGLE)];
        let mut matrix = Vec::with_capacity(6);
        for (row, entries) in six(reader, node, "six rows of six numbers")?.iter().enumerate() {
            let mut line = Vec::with_capacity(6);
            for (column, entry) in six(reader, entries, "a row of six numbers")?.iter().enumerate() {
                let dimension = dimensions[usize::from(row >= 3) + usize::from(column >= 3)];
                line.push(reader.formula(entry, quantity.context, dimension)?);
            }
            matrix.push(<[Formula; 6]>::try_from(line).ok()?);
        }
        <[[Formula; 6]; 6]>::try_from(matrix).ok().map(|matrix| Self(Box::new(matrix)))
    }

    fn schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<[[values::Number; 6]; 6]>()
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.extend(self.0.iter().flatten());
    }
}

fn six<'n, S: SymbolTable>(reader: &mut Reader<'_, S>, node: &'n Node, wanted: &str) -> Option<&'n [Node]> {
    let found = match &node.value {
        yaml::Value::Sequence(items) if items.len() == 6 => return Some(items),
        yaml::Value::Sequence(items) => format!("a list of {}", items.len()),
        _ => node.kind().to_owned(),
    };
    reader.error(Code::WrongShape, node.span.clone(), format!("{wanted} belong here, but here is {found}"), None);
    None
}
