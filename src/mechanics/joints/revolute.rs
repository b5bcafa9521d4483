//! Revolute joint: two points coincide.
//!
//! ```text
//! Φ = r_A − r_B = 0          2 rows, m
//! ```
//!
//! A on the first, B on the second body. −Φ_qᵀ λ is the force +λ at B on the second body and −λ at A on the first: λ is
//! the pin's force on the second body, in the ground's axes. No torque. Nothing fails; with both points on held
//! coordinates a row vanishes.

use symdiff::Graph;

use crate::mechanics::mechanism::Mechanism;
use crate::mechanics::plane;
use crate::model::PointRef;

use super::Row;

pub fn rows(g: &mut Graph, m: &Mechanism, between: [PointRef; 2]) -> Vec<Row> {
    let [a, b] = between.map(|point| m.point(g, point));
    let gap = plane::sub(g, a.position, b.position);
    let (zero, one) = (g.constant(0.0), g.constant(1.0));
    vec![
        Row { name: "x", value: gap[0], force: [one, zero], torque: zero },
        Row { name: "y", value: gap[1], force: [zero, one], torque: zero },
    ]
}
