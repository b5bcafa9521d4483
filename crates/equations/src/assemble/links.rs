//! The children of trees, and the values through which bodies before them feel them.

use symdiff::Scalar;

use super::applied_forces::AppliedForces;
use super::mechanism::Mechanism;
use super::recursion::InertialForces;
use super::system::ChildLink;
use crate::multibody::{Attitude, Vector, Wrench};

/// The children with the values that pass through them: motions, and the sums of forces.
pub(super) fn links_of<'g>(
    m: &Mechanism<'g, '_>,
    inertial: &InertialForces<'g>,
    applied: &[&AppliedForces<'g>],
) -> Vec<ChildLink> {
    let applied: Vec<Vec<Wrench>> = applied.iter().map(|forces| forces.with_children(m)).collect();
    let mut links = Vec::new();
    let mut link_of: Vec<Option<usize>> = vec![None; m.bodies.len()];
    for &index in &m.tree.order {
        let body = &m.bodies[index];
        let Some(relative) = &body.relative_motion else { continue };
        let mut values = inertial.motions[index].clone();
        values.extend(body.position.iter().chain(&body.velocity).chain(&body.acceleration));
        if let Some(Attitude { matrix, omega, alpha }) = body.attitude {
            values.extend((0..3).flat_map(|i| (0..3).map(move |j| matrix[i][j])));
            values.extend([omega, alpha].into_iter().flat_map(Vector::components));
        }
        values.extend(applied.iter().flat_map(|wrenches| components(wrenches[index])));
        let inertial_forces = Scalar::exprs(&components(inertial.wrenches[index]));
        let coordinates = relative.dofs.iter().map(|dof| dof.index).collect();
        let normalisation = m.normalisations.get(&relative.joint).copied();
        let parent = link_of[relative.parent];
        link_of[index] = Some(links.len());
        links.push(ChildLink { parent, coordinates, normalisation, values: Scalar::exprs(&values), inertial_forces });
    }
    links
}

fn components<'g>(wrench: Wrench<'g>) -> Vec<Scalar<'g>> {
    [wrench.force, wrench.torque].into_iter().flat_map(Vector::components).collect()
}
