//! A flexible body by its mass and stiffness matrices, as finite elements and Craig and Bampton's reduction give them.
//!
//! Nodes i = 1 … n are frames of bodies; R is the orientation of the first one, X_i where node i is in the undeformed
//! body. In the axes of the first node stand displacements, rotations and rates of the nodes, and q are the coordinates
//! of the modes:
//!
//! ```text
//! d_i = Rᵀ (r_i − r_1) − (X_i − X_1),     ρ_i = 2 tan(θ_i/2) n_i of the rotation Rᵀ R_i          m, rad
//! u = (d_2, ρ_2, …, d_n, ρ_n, q),     V = ½ s uᵀ K u          J
//! f = s K (u + τ u̇):   −R f_i at node i, R f_i at the same place on the first body,
//!                      −R (m + ½ ρ × m + ¼ ρ (ρ · m)) between both, −f_q on the modes
//! T = ½ ∫ |Rᵀ ṙ_1 + Rᵀ ω_1 × (x + N u) + N u̇|² dm          J
//! N: the displacement by u, see `assemble::superelement_inertia`
//! ```
//!
//! Deformation is small against the first node, its motion is not; rigid motions strain nothing. The matrices are
//! constant, so tension and spin do not stiffen the body: one that bends far, or spins fast, is divided into several,
//! or is a `beam`.

pub(super) mod carried;
pub mod matrices;

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use self::matrices::{Matrices, OF_NODE};
use super::{ForceElement, Forces, ReducedInertia, TypedSensor};
use crate::elements::Glyph;
use crate::grammar::quantity::Dimension;
use crate::grammar::{Checked, Fields, PointRef, Reader, Sensor, SymbolTable};
use crate::multibody::{BuildError, Pair, RelativeDisplacement, Vector};
use crate::syntax::codes::Code;

/// A flexible body by its mass and stiffness matrices: by nodes and modes.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "superelement",
    what = "a superelement",
    equation = "V = ½ s uᵀ K u, T = ½ ∫ |v_1 + ω_1 × (x + N u) + N u̇|² dm; u the nodes' displacements and rotations against the first one, and the modes",
    equation = "with damping τ: forces of u plus τ times its rate",
    source = "Craig & Bampton, AIAA J. 6 (1968) 1313; Géradin & Cardona, Flexible Multibody Dynamics (2001), ch. 10",
    example = "{ nodes: [arm.tip, cart], damping: 1e-3, matrices: { nodes: [[0, 0], [0.6, 0]], mass: [[1.4], [0, 1.56], [0, 0.132, 0.0144], [0.7, 0, 0, 1.4], [0, 0.54, 0.078, 0, 1.56], [0, -0.078, -0.0108, 0, -0.132, 0.0144]], stiffness: [[1e5], [0, 1000], [0, 300, 120], [-1e5, 0, 0, 1e5], [0, -1000, -300, 0, 1000], [0, 300, 60, 0, -300, 120]] } }",
    checked
)]
pub struct Superelement {
    /// The frames at its nodes, each `body.point` or `body`, in the order of the matrices; their axes are those of the
    /// undeformed body.
    pub nodes: Vec<PointRef>,
    /// `nodes`, `mass`, `stiffness` and the number of `modes`, here or in a YAML file of their own.
    pub matrices: Matrices,
    /// Factor of the mass matrix.
    #[quantity(unit = "1", constant, positive, default = 1)]
    pub mass: Formula,
    /// Factor of the stiffness matrix, s.
    #[quantity(unit = "1", constant, positive, default = 1)]
    pub stiffness: Formula,
    /// Stiffness-proportional: force by rate over force by displacement.
    #[quantity(unit = "s", nonnegative, constant, default = 0)]
    pub damping: Formula,
}

impl ForceElement for Superelement {
    const GLYPH: Glyph = Glyph::Beam;
    const SENSORS: &'static [TypedSensor] = &[(Sensor::AXIAL, Dimension::FORCE)];

    fn sensors(&self) -> Vec<TypedSensor> {
        Self::SENSORS.iter().copied().filter(|_| self.nodes.len() == 2).collect()
    }

    fn reduced_inertia(&self) -> Option<ReducedInertia<'_>> {
        Some(ReducedInertia { nodes: &self.nodes, matrices: &self.matrices, factor: &self.mass })
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let g = forces.graph();
        let (factor, damping) = (forces.value(&self.stiffness)?, forces.value(&self.damping)?);
        let first = self.nodes[0];
        let ends: Vec<End> = (1..self.nodes.len()).map(|node| self.end(forces, node)).collect();
        let modes: Vec<[Scalar; 2]> = (0..self.matrices.modes).map(|mode| forces.mode(mode)).collect();

        // u and u̇, with the rows that they have in K.
        let mut rows = Vec::new();
        for (end, node) in ends.iter().zip(1..) {
            let values = [end.at.displacement, end.at.rotation].into_iter().flat_map(Vector::components);
            let rates = end.rates.into_iter().flat_map(Vector::components);
            let places = (0..OF_NODE).map(|coordinate| Matrices::of_node(node, coordinate));
            rows.extend(places.zip(values.zip(rates)));
        }
        let of_modes = modes.iter().enumerate();
        rows.extend(of_modes.map(|(mode, &[value, rate])| (self.matrices.of_mode(mode), (value, rate))));
        let times = |row: usize, of: &dyn Fn((Scalar<'g>, Scalar<'g>)) -> Scalar<'g>| {
            g.sum(rows.iter().map(|&(column, pair)| self.matrices.stiffness[(row, column)] * of(pair)))
        };
        let felt = |row: usize| factor * times(row, &|(value, rate)| value + damping * rate);

        for (end, node) in ends.iter().zip(1..) {
            let three = |from: usize| -> Vector<'g> {
                std::array::from_fn(|axis| felt(Matrices::of_node(node, from + axis))).into()
            };
            let second = &end.pair.second.point;
            let there = forces.point_at(first.body, second.position);
            let pull = end.at.outward * three(0);
            forces.between(&there, second, -pull);
            if ends.len() == 1 {
                let line = end.pair.offset();
                forces.sensor(Sensor::AXIAL, pull.dot(line) / line.norm());
            }
            forces.torque(first.body, second.body, -end.at.torque(three(3)));
        }
        for mode in 0..self.matrices.modes {
            forces.modal_force(mode, -felt(self.matrices.of_mode(mode)));
        }
        let energy = g.sum(rows.iter().map(|&(row, (value, _))| value * times(row, &|(value, _)| value)));
        forces.potential(&[factor], 0.5 * (factor * energy));
        Ok(())
    }
}

/// A node as the first one sees it.
struct End<'g> {
    pair: Pair<'g>,
    at: RelativeDisplacement<'g>,
    /// ḋ and ρ̇
    rates: [Vector<'g>; 2],
}

impl Superelement {
    fn end<'g>(&self, forces: &dyn Forces<'g>, node: usize) -> End<'g> {
        let between = [self.nodes[0], self.nodes[node]];
        let pair = forces.pair(between);
        let at = RelativeDisplacement::of(&pair, self.matrices.offset_in(forces.graph(), node));
        let rates = at.rates(&pair, between.map(|point| forces.angular_velocity(point.body)));
        End { pair, at, rates }
    }
}

impl Checked for Superelement {
    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let (named, known) = (self.nodes.len(), self.matrices.nodes.len());
        if named != known {
            let message = format!("{named} nodes are named, but the matrices have {known}");
            reader.error(Code::BadMatrix, fields.key_span("nodes"), message, None);
        }
        let twice = (1..named).find(|&node| self.nodes[..node].iter().any(|other| other.body == self.nodes[node].body));
        if let Some(node) = twice {
            let body = reader.model.body_name(self.nodes[node].body).to_owned();
            let help = "each node is a frame of a body of its own".to_owned();
            reader.error(Code::SameBody, fields.key_span("nodes"), format!("two nodes are on body `{body}`"), help);
        }
    }
}
