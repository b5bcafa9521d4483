//! Bushing: springs and dampers between two frames, along and about the axes of the first.
//!
//! With d = R_F₁ᵀ (r_B − r_A), q = (q₀, e) the rotation of the second frame against the first (`joints::pair`), and K, C, K_t,
//! C_t diagonal, in the first frame's axes,
//!
//! ```text
//! F_B = −(K d + C ḋ)                                       V = ½ dᵀ K d + 2 eᵀ K_t e          N, J
//! τ₂  = −(2 q₀ K_t e + 2 e × K_t e + C_t (ω₂ − ω₁))                                           N m
//! ```
//!
//! on the second body at B; the opposites act on the first body at the same place. ḋ is what an observer in the first frame
//! sees. 2 e is the rotation vector to second order, so K_t is the stiffness for small rotations, the torque of a rotation
//! by φ about an axis K_t sin φ: a bushing is no spring for full turns.
//!
//! Full matrices 𝐊, 𝐂 (6 × 6, displacements before rotations) add 𝐊 x + 𝐂 ẋ, x = (d, 2 e), ẋ = (ḋ, ω₂ − ω₁), with the torque
//! q₀ y + e × y of the rotational part y of 𝐊 x, so that V gains ½ xᵀ 𝐊 x. Where 𝐊 is not symmetric, or a stiffness depends on
//! the motion, there is no potential and none is counted.


use mbint_derive::Element;
use schemars::{Schema, SchemaGenerator};
use symdiff::{Builder, Expr, Formula, Scalar};

use super::{ForceElement, Forces, MovingPoint, TypedSensor};
use crate::grammar::quantity::Dimension;
use crate::grammar::{Node, PerAxis, PointRef, Quantity, Reader, Span, SymbolTable, Value, values};
use crate::multibody::space::{self, Vector};
use crate::multibody::{BuildError, Vector as Handle, rotation};
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
    /// Along the axes of the first point's frame.
    #[quantity(unit = "N/m", default = 0)]
    pub stiffness: PerAxis,
    /// Along those axes.
    #[quantity(unit = "N*s/m", default = 0)]
    pub damping: PerAxis,
    /// About those axes, for small rotations.
    #[quantity(unit = "N*m/rad", default = 0)]
    pub torsional_stiffness: PerAxis,
    /// About those axes.
    #[quantity(unit = "N*m*s/rad", default = 0)]
    pub torsional_damping: PerAxis,
    /// Six rows: forces along and torques about those axes by displacements (N/m, N) and small rotations (N/rad, N*m/rad).
    #[key(unit = "N/m")]
    pub stiffness_matrix: Option<SixBySix>,
    /// The same by velocities and angular velocities.
    #[key(unit = "N*s/m")]
    pub damping_matrix: Option<SixBySix>,
}

impl ForceElement for Bushing {
    const SENSORS: &'static [TypedSensor] = &[];

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let g = forces.graph();
        let stiffness =
            Law::of(forces, [&self.stiffness, &self.torsional_stiffness], self.stiffness_matrix.as_ref())?;
        let damping = Law::of(forces, [&self.damping, &self.torsional_damping], self.damping_matrix.as_ref())?;
        let pair = forces.pair(self.between);
        let axes: [Vector; 3] = std::array::from_fn(|axis| {
            let unit = space::along(g, axis);
            pair.outward(g, unit)
        });
        let (first, second) = (pair.first.point, pair.second.point);
        let omega = [first, second].map(|point| forces.angular_velocity(point.body).exprs());
        let spin_in_ground = space::sub(g, omega[1], omega[0]);
        let q = pair.relative(g);
        let e = rotation::vector_part(q);

        let offset = pair.offset(g);
        let carried = space::cross(g, omega[0], offset);
        let rate = space::sub(g, second.velocity, first.velocity);
        let rate = space::sub(g, rate, carried);
        let displacement = axes.map(|axis| space::dot(g, axis, offset));
        let elastic = weighted(g, stiffness.straight, displacement);
        let doubled = space::dot(g, displacement, elastic);
        let rate = axes.map(|axis| space::dot(g, axis, rate));
        let viscous = weighted(g, damping.straight, rate);
        let mut pull = space::add(g, elastic, viscous);

        let twisted = weighted(g, stiffness.torsional, e);
        let half = conjugate(g, q[0], e, twisted);
        let elastic = half.map(|component| g.scale(2.0, component));
        let spin = axes.map(|axis| space::dot(g, axis, spin_in_ground));
        let viscous = weighted(g, damping.torsional, spin);
        let mut torque = space::add(g, elastic, viscous);

        let halved = space::dot(g, e, twisted);
        let (straight, twisting) = (g.scale(0.5, doubled), g.scale(2.0, halved));
        let mut potential = g.add(straight, twisting);
        let rotation = e.map(|component| g.scale(2.0, component));
        if let Some([force, moment]) = stiffness.full_times(g, displacement, rotation) {
            pull = space::add(g, pull, force);
            let moment_here = conjugate(g, q[0], e, moment);
            torque = space::add(g, torque, moment_here);
            let (straight, twisting) = (space::dot(g, displacement, force), space::dot(g, rotation, moment));
            let doubled = g.add(straight, twisting);
            let stored = g.scale(0.5, doubled);
            potential = g.add(potential, stored);
        }
        if let Some([force, moment]) = damping.full_times(g, rate, spin) {
            pull = space::add(g, pull, force);
            torque = space::add(g, torque, moment);
        }
        let pull = in_ground(g, axes, pull);
        let there = forces.point_at(first.body, Handle::of(g, second.position));
        forces.between(&MovingPoint::of(g, second), &there, Handle::of(g, pull));
        let torque = in_ground(g, axes, torque);
        forces.torque(second.body, first.body, Handle::of(g, torque));
        if stiffness.is_symmetric() {
            let coefficients: Vec<Scalar> = stiffness.coefficients().into_iter().map(|part| g.scalar(part)).collect();
            forces.potential(&coefficients, g.scalar(potential));
        }
        Ok(())
    }
}

/// Stiffness or damping: by axis and, where there is one, the full matrix.
struct Law {
    straight: Vector,
    torsional: Vector,
    full: Option<[[Expr; 6]; 6]>,
}

impl Law {
    fn of(
        forces: &dyn Forces<'_>,
        [straight, torsional]: [&PerAxis; 2],
        full: Option<&SixBySix>,
    ) -> Result<Self, BuildError> {
        let g = forces.graph();
        let straight = forces.vector(straight)?.exprs();
        let torsional = forces.vector(torsional)?.exprs();
        let mut matrix = full.map(|_| [[g.constant(0.0); 6]; 6]);
        if let (Some(matrix), Some(full)) = (&mut matrix, full) {
            for (entry, formula) in matrix.iter_mut().flatten().zip(full.0.iter().flatten()) {
                *entry = forces.value(formula)?.expr();
            }
        }
        Ok(Self { straight, torsional, full: matrix })
    }

    /// The full matrix times (displacement, rotation): a force and a torque.
    fn full_times(&self, g: &Builder, displacement: Vector, rotation: Vector) -> Option<[Vector; 2]> {
        let along = [displacement, rotation].concat();
        let matrix = self.full?;
        let product = matrix.map(|row| g.dot(&row, &along));
        Some([[product[0], product[1], product[2]], [product[3], product[4], product[5]]])
    }

    /// All its numbers.
    fn coefficients(&self) -> Vec<Expr> {
        let full = self.full.iter().flatten().flatten().copied();
        self.straight.into_iter().chain(self.torsional).chain(full).collect()
    }

    fn is_symmetric(&self) -> bool {
        let symmetric = |m: &[[Expr; 6]; 6]| (0..6).all(|i| (0..i).all(|j| m[i][j] == m[j][i]));
        self.full.as_ref().is_none_or(symmetric)
    }
}


/// The torque q₀ y + e × y that does the work y · d(2 e).
fn conjugate(g: &Builder, q0: Expr, e: Vector, y: Vector) -> Vector {
    let (straight, across) = (space::scale(g, q0, y), space::cross(g, e, y));
    space::add(g, straight, across)
}

/// Component by component.
fn weighted(g: &Builder, weights: Vector, a: Vector) -> Vector {
    std::array::from_fn(|i| g.mul(weights[i], a[i]))
}

/// A vector along given axes.
fn in_ground(g: &Builder, axes: [Vector; 3], a: Vector) -> Vector {
    let mut sum = space::zero(g);
    for (axis, component) in axes.into_iter().zip(a) {
        let part = space::scale(g, component, axis);
        sum = space::add(g, sum, part);
    }
    sum
}

/// Rows of forces, then torques, by displacements, then rotations, or by their rates.
#[derive(Clone, Debug)]
pub struct SixBySix(pub Box<[[Formula; 6]; 6]>);

impl Value for SixBySix {
    fn read<S: SymbolTable>(
        reader: &mut Reader<'_, S>,
        node: &Node,
        _: Span,
        quantity: &Quantity,
    ) -> Option<Self> {
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
    reader.error(node.span.clone(), format!("{wanted} belong here, but here is {found}"), None);
    None
}
