//! Spherical joint: two points coincide.
//!
//! ```text
//! Φ = r_A − r_B = 0          3 rows, m; in the plane, where it is the pin of a revolute joint, 2
//! ```
//!
//! λ is the force on the second body, at B, in the ground's axes. No torque.

use symdiff::Builder;

use crate::assemble::mechanism::Mechanism;
use crate::assemble::space;
use crate::model::PointRef;

use super::Row;

pub fn rows(g: &Builder, m: &Mechanism, between: [PointRef; 2]) -> Vec<Row> {
    let [a, b] = between.map(|point| m.point(g, point));
    let gap = space::sub(g, a.position, b.position);
    let names = ["x", "y", "z"];
    let row = |axis: usize| {
        let (force, torque) = (space::along(g, axis), space::zero(g));
        Row { name: names[axis], value: gap[axis], force, torque }
    };
    (0..if m.is_spatial() { 3 } else { 2 }).map(row).collect()
}
