//! Forms as flat faces, whose corners turn left when seen from outside.

use nalgebra::Vector3;
use symdiff::math;

use super::flat::{normal, polyline};
use super::frame::SolidFrame;
use crate::elements::Form;
use crate::elements::effects::faces_of_hull;
use crate::export::tuning::TUNING;

/// A flat polygon.
pub(in crate::export) type Face = Vec<[f64; 3]>;

/// The faces of a form, without its rounding radius.
pub(in crate::export) fn faces(form: &Form<f64>) -> Vec<Face> {
    match form {
        Form::Box { size, .. } => of_box(*size),
        Form::Cylinder { axis, length, radius } => turned(prism(&ring(*radius), *length), *axis),
        Form::Outline { points, is_closed: true, thickness, .. } => prism(&polyline(points, true), *thickness),
        Form::Hull { points, .. } => faces_of_hull(points.clone()).unwrap_or_default(),
        Form::Bore { axis, radius } => turned(wall(*radius), *axis),
        Form::Mesh { mesh, scale } => {
            let scaled = |corner: &[f64; 3]| [0, 1, 2].map(|axis| scale[axis] * corner[axis]);
            // A reflection turns corners the other way.
            let is_reflected = scale.iter().product::<f64>() < 0.0;
            let face = |[a, b, c]: &[[f64; 3]; 3]| {
                let [b, c] = if is_reflected { [c, b] } else { [b, c] };
                [a, b, c].map(scaled).to_vec()
            };
            mesh.triangles.iter().map(face).collect()
        }
        Form::Outline { .. } | Form::Sphere { .. } | Form::Capsule { .. } => Vec::new(),
        Form::HalfSpace { .. } | Form::Ground { .. } => Vec::new(),
    }
}

/// Faces moved out along their normals.
pub(in crate::export) fn moved_out(faces: &[Face], distance: f64) -> Vec<Face> {
    let moved = |face: &Face| {
        let step = distance * normal(face).try_normalize(0.0).unwrap_or_default();
        face.iter().map(|&corner| (Vector3::from(corner) + step).into()).collect()
    };
    faces.iter().map(moved).collect()
}

/// The corners of a box about the origin.
pub(super) fn corners(size: [f64; 3]) -> [[f64; 3]; 8] {
    std::array::from_fn(|corner| {
        [0, 1, 2].map(|axis| if corner >> axis & 1 == 0 { -0.5 * size[axis] } else { 0.5 * size[axis] })
    })
}

fn of_box(size: [f64; 3]) -> Vec<Face> {
    let corners = corners(size);
    let rings = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    rings.map(|ring| ring.map(|corner| corners[corner]).to_vec()).into()
}

/// A circle about z.
fn ring(radius: f64) -> Face {
    let at = |step: usize| {
        let angle = std::f64::consts::TAU * step as f64 / TUNING.pieces_of_turn as f64;
        [radius * math::cos(angle), radius * math::sin(angle), 0.0]
    };
    (0..TUNING.pieces_of_turn).map(at).collect()
}

/// A plate about z = 0; one without thickness has two sides.
fn prism(outline: &[[f64; 3]], thickness: f64) -> Vec<Face> {
    let mut outline = outline.to_vec();
    if normal(&outline).z < 0.0 {
        outline.reverse();
    }
    let lifted = |z: f64| outline.iter().map(|[x, y, _]| [*x, *y, z]).collect::<Face>();
    let (low, high) = (lifted(-0.5 * thickness), lifted(0.5 * thickness));
    let mut found = Vec::with_capacity(outline.len() + 2);
    if thickness > 0.0 {
        let count = outline.len();
        found.extend((0..count).map(|at| vec![low[at], low[(at + 1) % count], high[(at + 1) % count], high[at]]));
    }
    found.push(low.into_iter().rev().collect());
    found.push(high);
    found
}

/// The wall of a hole about z, as thick as a tenth of its radius.
fn wall(radius: f64) -> Vec<Face> {
    let (inner, outer) = (ring(radius), ring(1.1 * radius));
    let half = 0.1 * radius;
    let at = |ring: &Face, index: usize, z: f64| {
        [ring[index % TUNING.pieces_of_turn][0], ring[index % TUNING.pieces_of_turn][1], z]
    };
    let pieces = (0..TUNING.pieces_of_turn).flat_map(|index| {
        let quad = |a: (&Face, f64), b: (&Face, f64)| {
            vec![at(a.0, index, a.1), at(a.0, index + 1, a.1), at(b.0, index + 1, b.1), at(b.0, index, b.1)]
        };
        [
            quad((&inner, half), (&inner, -half)),
            quad((&outer, -half), (&outer, half)),
            quad((&outer, half), (&inner, half)),
            quad((&inner, -half), (&outer, -half)),
        ]
    });
    pieces.collect()
}

/// Faces about z, rotated to an axis.
fn turned(faces: Vec<Face>, axis: [f64; 3]) -> Vec<Face> {
    let frame = SolidFrame::still().along([0.0; 3], axis);
    faces.into_iter().map(|face| face.into_iter().map(|corner| frame.place(corner)).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume by the divergence theorem; correct only if all faces point outwards.
    fn volume(faces: &[Face]) -> f64 {
        faces.iter().map(|face| Vector3::from(face[0]).dot(&normal(face)) / 6.0).sum()
    }

    #[test]
    fn faces_look_outside() {
        let size = [0.2, 0.3, 0.5];
        assert!((volume(&faces(&Form::Box { size, radius: 0.0 })) - 0.03).abs() < 1e-15);
        let points = corners(size).to_vec();
        assert!((volume(&faces(&Form::Hull { points, radius: 0.0 })) - 0.03).abs() < 1e-15);
        let cylinder = Form::Cylinder { axis: [1.0, 2.0, -1.0], length: 2.0, radius: 0.5 };
        let circle = std::f64::consts::PI * 0.25;
        assert!((volume(&faces(&cylinder)) / (2.0 * circle) - 1.0).abs() < 2e-3);
        let ring = Form::Bore { axis: [0.0, 0.0, -1.0], radius: 0.5 };
        assert!((volume(&faces(&ring)) / (0.1 * circle * 0.21) - 1.0).abs() < 2e-3);
    }

    #[test]
    fn a_reflected_mesh_looks_outside() {
        let size = [1.0, 1.0, 1.0];
        let triangles: Vec<[[f64; 3]; 3]> =
            of_box(size).iter().flat_map(|face| super::super::triangulated(face)).collect();
        let mesh = crate::grammar::Mesh { file: String::new(), triangles: triangles.into() };
        for scale in [[2.0, 1.0, 1.0], [-2.0, 1.0, 1.0], [-1.0, -1.0, -2.0]] {
            assert!((volume(&faces(&Form::Mesh { mesh: mesh.clone(), scale })) - 2.0).abs() < 1e-12);
        }
    }
}
