//! Coordinates of joints: the angle about an axis, the displacement along it.
//!
//! One that a formula, the start or a coupling names becomes a coordinate of the mechanism, without inertia, with a
//! constraint that defines it. With q = (q₀, e) the rotation of the second frame against the first and a the axis,
//!
//! ```text
//! angle φ:           Φ = 2 [cos(φ/2) e·a − sin(φ/2) q₀] = 0          (for a rotation by ψ about a: 2 sin((ψ − φ)/2))
//! displacement s:    Φ = R₁ a · (r_B − r_A) − s = 0
//! ```
//!
//! so that angles are continuous over any number of turns, and can be driven, coupled and given at the start like any
//! other coordinate. Forces on them reach the bodies through the constraint's multiplier, which is no part of the
//! joint's reaction. In the plane an angle is the difference θ₂ − θ₁, and is a coordinate of its own only where the
//! start names it.

use std::collections::BTreeSet;

use symdiff::{Formula, Scalar};

use super::mechanism::Mechanism;
use super::questions::Questions;
use crate::grammar::JointCoordinate;
use crate::model::{Description, StartValue, Symbol};
use crate::multibody::{ANGLE, BuildError, Context};

/// The coordinates of joints that are coordinates of their own.
pub fn called_for(questions: &Questions) -> BTreeSet<(usize, JointCoordinate)> {
    let description = questions.description;
    let mut found = BTreeSet::new();
    for value in description.initial.iter().chain(&description.guess) {
        if let StartValue::Joint { joint, coordinate, .. } = value {
            found.insert((*joint, *coordinate));
        }
    }
    let mut add = |joint: usize, coordinate: JointCoordinate| {
        if description.space.spatial || coordinate != JointCoordinate::Angle {
            found.insert((joint, coordinate));
        }
    };
    for (index, joint) in description.joints.iter().enumerate() {
        joint.kind.coordinates(index).into_iter().for_each(|on| add(on.joint, on.coordinate));
    }
    for effect in &description.effects {
        effect.kind.coordinates().into_iter().for_each(|on| add(on.joint, on.coordinate));
    }
    for formula in formulas(questions) {
        for (name, _) in formula.names() {
            if let Some(Symbol::JointCoordinate { joint, coordinate, .. }) = description.symbol(name) {
                add(joint, coordinate);
            }
        }
    }
    found
}

/// Formulas that may depend on the motion.
fn formulas<'q>(questions: &'q Questions) -> Vec<&'q Formula> {
    let outputs = questions.outputs.iter().map(|output| &output.formula);
    formulas_of_motion(questions.description).into_iter().chain(outputs).collect()
}

/// Formulas of constraints and effects.
pub fn formulas_of_motion(description: &Description) -> Vec<&Formula> {
    let equations = description.joints.iter().filter_map(|joint| joint.kind.equation());
    let mut found: Vec<&Formula> = equations.flatten().collect();
    found.extend(description.effects.iter().flat_map(|effect| effect.kind.formulas()));
    found
}

/// Φ of a constraint that defines a joint's own coordinate.
pub struct Definition<'g> {
    /// Name of the coordinate.
    pub name: &'static str,
    /// The coordinate.
    pub coordinate: JointCoordinate,
    /// Φ, rad or m.
    pub value: Scalar<'g>,
}

impl<'g> Mechanism<'g, '_> {
    /// The constraints that define a joint's own coordinates.
    pub fn definitions(&self, joint: usize) -> Result<Vec<Definition<'g>>, BuildError> {
        let kind = &self.joints[joint].kind;
        let mut rows = Vec::new();
        let mobilizer = kind.mobilizer().filter(|_| self.tree.contains(joint));
        for (coordinate, name) in [(JointCoordinate::Angle, "angle"), (JointCoordinate::Displacement, "displacement")] {
            // A coordinate by which a tree moves needs no definition.
            if mobilizer.as_ref().is_some_and(|mobilizer| mobilizer.is_counted_by(coordinate)) {
                continue;
            }
            let Some(&index) = self.joint_coordinates.get(&(joint, coordinate)) else { continue };
            let (Some(between), Some(axis)) = (kind.between(), kind.axis_of(coordinate)) else { continue };
            let own = self.q[index];
            let planar_angle = coordinate == JointCoordinate::Angle && !self.is_spatial;
            let value = if planar_angle {
                let [first, second] = between.map(|point| self.bodies[point.body].position[ANGLE]);
                second - first - own
            } else {
                let pair = self.pair(between);
                let axis = self.unit_vector(axis, Context::Time)?;
                match coordinate {
                    JointCoordinate::Angle => pair.turned_by(axis, own),
                    JointCoordinate::Displacement => pair.displacement(axis) - own,
                }
            };
            rows.push(Definition { name, coordinate, value });
        }
        Ok(rows)
    }
}
