//! Links that are welded together → one body, whose frame is that of the link nearest to the root:
//!
//! ```text
//! m = Σ mᵢ,   m c = Σ mᵢ cᵢ,   J = Σ Rᵢ Jᵢ Rᵢᵀ + mᵢ (dᵢ² 1 − dᵢ dᵢᵀ),   dᵢ = cᵢ − c
//! ```
//!
//! The other links are frames at points of it, named after them.

use super::source::{ParsedUrdf, formula, formulas};
use crate::grammar::Coordinate;
use crate::model::description::{Body, Inertia};
use crate::model::names::Reader;
use crate::model::tuning::TUNING;
use crate::robots::algebra::{self, Pose, Value, Vector};
use crate::robots::masses::{MassPart, center, inertia};
use crate::robots::number::Number;
use crate::robots::urdf::robot::{Joint, UrdfJointType};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;

/// Links that are welded together.
pub struct Group {
    /// The first is nearest to the root.
    pub links: Vec<usize>,
    /// Index of the robot's joint that leads to them; `None` for the root's.
    pub behind: Option<usize>,
    /// Index into the model's bodies; `None` if it is omitted.
    pub body: Option<usize>,
}

/// The body of links that are welded together.
pub fn body(reader: &mut Reader, source: &ParsedUrdf, group: &Group, of_link: &[(usize, Pose)]) -> Body {
    let root = &source.robot.links[group.links[0]];
    let parts = parts(source, group, of_link);
    let masses: Vec<Value> = parts.iter().map(|part| part.mass.clone()).collect();
    let mut mass = algebra::sum(&masses);
    let center = center(&parts, &mass);
    let mut inertia = inertia(&parts, &center);
    if mass.is_zero() && !is_determined(&inertia, group.behind.map(|joint| &source.robot.joints[joint])) {
        mass = algebra::number(TUNING.link_mass);
        let mut taken = format!("{link_mass} kg", link_mass = TUNING.link_mass);
        if inertia.iter().flatten().all(Value::is_zero) {
            (0..3).for_each(|i| inertia[i][i] = algebra::number(TUNING.link_inertia));
            taken = format!("{} kg and {} kg m²", TUNING.link_mass, TUNING.link_inertia);
        }
        let verb = if taken.contains("and") { "are" } else { "is" };
        let message = format!("link `{}` moves, but has no mass: {taken} {verb} taken", root.name);
        reader.diagnostics.push(Diagnostic::warning(Code::MasslessLink, root.span.clone(), message));
    } else if let Some(least) = too_small(&mass, &inertia) {
        let message = format!(
            "link `{}` has next to no inertia about some axis: {least:.1e} kg m² are added about each",
            root.name
        );
        reader.diagnostics.push(Diagnostic::warning(Code::MasslessLink, root.span.clone(), message));
        (0..3).for_each(|i| inertia[i][i] = algebra::sum(&[inertia[i][i].clone(), algebra::number(least)]));
    }
    let coordinates = [Coordinate::X, Coordinate::Y, Coordinate::Z].into_iter().chain(Coordinate::ORIENTATION);
    let mut element = |i: usize, k: usize| formula(reader, &inertia[i][k]);
    let inertia = Inertia {
        xx: element(0, 0),
        yy: element(1, 1),
        zz: element(2, 2),
        xy: element(0, 1),
        xz: element(0, 2),
        yz: element(1, 2),
    };
    Body {
        name: root.name.clone(),
        mass: Some(formula(reader, &mass)),
        inertia: Some(inertia),
        center_of_mass: Some(formulas(reader, &center)),
        coordinates: coordinates.collect(),
        prescribed: Vec::new(),
        prescribed_orientation: None,
        points: Vec::new(),
        standing: None,
        shapes: Vec::new(),
    }
}

/// Whether a body without mass moves as its joint and its inertia say: a fixed joint lets it nowhere, a hinge turns it
/// against its moment about the axis.
fn is_determined(inertia: &[Vector; 3], joint: Option<&Joint>) -> bool {
    let Some(joint) = joint else { return false };
    let axis = algebra::vector(joint.axis);
    let moment = (0..3).map(|i| {
        let row: Vec<Value> = (0..3).map(|k| algebra::mul(&inertia[i][k], &axis[k])).collect();
        algebra::mul(&axis[i], &algebra::sum(&row))
    });
    let moment = algebra::sum(&moment.collect::<Vec<Value>>());
    let is_positive = !matches!(moment, Value::Number(moment) if moment <= 0.0);
    joint.kind == UrdfJointType::Fixed || joint.kind.turns() && is_positive
}

/// The links that have mass or inertia, or of which either is a parameter.
fn parts(source: &ParsedUrdf, group: &Group, of_link: &[(usize, Pose)]) -> Vec<MassPart> {
    let massive = group.links.iter().filter_map(|&link| {
        let inertial = source.robot.links[link].inertial.as_ref()?;
        let acts = |number: &Number| number.value != 0.0 || source.named.contains(&number.name);
        (acts(&inertial.mass) || inertial.inertia.iter().any(acts)).then_some((link, inertial))
    });
    let part = massive.map(|(link, inertial)| {
        let rotation = algebra::roll_pitch_yaw(&source.vector(&inertial.origin.rpy));
        let pose = of_link[link].1.then(&source.vector(&inertial.origin.xyz), &rotation);
        let [xx, yy, zz, xy, xz, yz] = inertial.inertia.each_ref().map(|number| source.value(number));
        let tensor = [[xx, xy.clone(), xz.clone()], [xy, yy, yz.clone()], [xz, yz, zz]];
        MassPart {
            mass: source.value(&inertial.mass),
            center: pose.position,
            inertia: algebra::rotate_tensor(&pose.rotation, &tensor),
        }
    });
    part.collect()
}

/// Amount added to a tensor that makes the equations singular, or nearly; uncertain tensors are unchanged.
fn too_small(mass: &Value, inertia: &[Vector; 3]) -> Option<f64> {
    let Value::Number(mass) = mass else { return None };
    let mut numbers = [0.0; 9];
    for (slot, value) in numbers.iter_mut().zip(inertia.iter().flatten()) {
        let Value::Number(value) = value else { return None };
        *slot = *value;
    }
    let moments = nalgebra::Matrix3::from_row_slice(&numbers).symmetric_eigenvalues();
    let least = TUNING.link_radius_squared * mass;
    (moments.min().abs() < least).then_some(least)
}
