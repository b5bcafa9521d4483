//! Solids of a drawing as the report's scripts draw them: boxes, cylinders, spheres, capsules, planes and triangles.

use serde::Serialize;

use super::packing::floats;
use crate::elements::Form;
use crate::export::solid::{Face, SolidFrame, faces, moved_out, polyline, reach, triangulated};
use crate::numerics::{least, most};
use crate::results::DrawnSolid;

/// A solid in its body's frame.
#[derive(Serialize)]
pub(super) struct Visual {
    body: usize,
    /// Whether it is a surface of an effect.
    surface: bool,
    /// Its middle, m.
    position: [f64; 3],
    /// Euler parameters.
    orientation: [f64; 4],
    shape: &'static str,
    /// Sides of a box; radius and length along z, a radius of 0 being a thin line; radius; factors of a mesh; m.
    size: Vec<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    color: Option<[f64; 3]>,
    /// Corners of triangles.
    #[serde(skip_serializing_if = "Option::is_none")]
    vertices: Option<String>,
    /// Least and greatest corner of a box that encloses it, in its frame, m.
    within: [[f64; 3]; 2],
}

/// The visuals that draw a solid.
pub(super) fn visuals(solid: &DrawnSolid) -> Vec<Visual> {
    let frame = SolidFrame::in_body(solid);
    let visual = |frame: SolidFrame, shape: &'static str, size: Vec<f64>| Visual {
        body: solid.body,
        surface: solid.surface.is_some(),
        position: frame.position(),
        orientation: frame.orientation(),
        shape,
        within: extent(shape, &size),
        size,
        color: solid.color,
        vertices: None,
    };
    let triangles = |faces: &[Face]| {
        let corners = faces.iter().flat_map(|face| triangulated(face)).flatten().flatten().collect::<Vec<f64>>();
        let within = bounds(faces.iter().flatten().copied());
        Visual { vertices: Some(floats(&corners)), within, ..visual(frame, "mesh", vec![1.0; 3]) }
    };
    let capsule = |from: [f64; 3], to: [f64; 3], radius: f64| {
        let way: [f64; 3] = std::array::from_fn(|axis| to[axis] - from[axis]);
        let middle = std::array::from_fn(|axis| 0.5 * (from[axis] + to[axis]));
        let length = way.iter().map(|part| part * part).sum::<f64>().sqrt();
        visual(frame.along(middle, way), "capsule", vec![radius, length])
    };
    let line = |points: &[[f64; 3]], radius: f64| -> Vec<Visual> {
        points.windows(2).map(|pair| capsule(pair[0], pair[1], radius)).collect()
    };
    // Faces moved out by the radius, and capsules along their edges.
    let rounded = |faces: &[Face], radius: f64| -> Vec<Visual> {
        let edges = faces.iter().flat_map(|face| face.iter().zip(face.iter().cycle().skip(1)));
        // Each edge belongs to two faces, once in each direction.
        let edges = edges.filter(|(from, to)| from < to).map(|(from, to)| capsule(*from, *to, radius));
        std::iter::once(triangles(&moved_out(faces, radius))).chain(edges).collect()
    };
    match &solid.form {
        Form::Sphere { radius } => vec![visual(frame, "sphere", vec![*radius])],
        Form::Box { size, radius: 0.0 } => vec![visual(frame, "box", size.to_vec())],
        Form::Cylinder { axis, length, radius } => {
            vec![visual(frame.along([0.0; 3], *axis), "cylinder", vec![*radius, *length])]
        }
        Form::Capsule { ends: [from, to], radius } => vec![capsule(*from, *to, *radius)],
        form @ (Form::Bore { .. } | Form::Mesh { .. }) => vec![triangles(&faces(form))],
        Form::Ground { points } => line(points, 0.0),
        Form::HalfSpace { normal } => vec![visual(frame.along([0.0; 3], *normal), "plane", Vec::new())],
        Form::Outline { points, is_closed: false, radius, .. } => line(&polyline(points, false), *radius),
        form @ (Form::Outline { radius, .. } | Form::Box { radius, .. }) => {
            let faces = faces(form);
            if *radius == 0.0 { vec![triangles(&faces)] } else { rounded(&faces, *radius) }
        }
        form @ Form::Hull { radius, .. } => {
            let faces = flat_or_not(form);
            if *radius == 0.0 { vec![triangles(&faces)] } else { rounded(&faces, *radius) }
        }
    }
}

/// The faces of a hull, or both sides of one that is flat in x and y.
fn flat_or_not(form: &Form<f64>) -> Vec<Face> {
    let found = faces(form);
    let Form::Hull { points, .. } = form else { return found };
    if !found.is_empty() {
        return found;
    }
    let ring = crate::export::drawing::flat_hull(points);
    let back = ring.iter().rev().copied().collect();
    vec![ring, back]
}

fn bounds(points: impl Iterator<Item = [f64; 3]>) -> [[f64; 3]; 2] {
    points.fold([[f64::MAX; 3], [f64::MIN; 3]], |[low, high], point| {
        let each = |of: fn(f64, f64) -> f64, bound: [f64; 3]| std::array::from_fn(|axis| of(bound[axis], point[axis]));
        [each(least, low), each(most, high)]
    })
}

/// Enclosing box of forms without triangles.
fn extent(shape: &str, size: &[f64]) -> [[f64; 3]; 2] {
    let z = [0.0, 0.0, 1.0];
    let form = match (shape, size) {
        ("box", [x, y, z]) => Form::Box { size: [*x, *y, *z], radius: 0.0 },
        ("sphere", [radius]) => Form::Sphere { radius: *radius },
        ("cylinder", [radius, length]) => Form::Cylinder { axis: z, length: *length, radius: *radius },
        ("capsule", [radius, length]) => {
            Form::Capsule { ends: [[0.0, 0.0, -0.5 * length], [0.0, 0.0, 0.5 * length]], radius: *radius }
        }
        _ => Form::HalfSpace { normal: z },
    };
    bounds(reach(&form).into_iter())
}
