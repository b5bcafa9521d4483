//! Meshes of a robot's file: triangles, and volume, centre and inertia of the solid that they enclose.

mod msh;
mod solid;

use std::path::Path;

pub use self::solid::{Faults, SolidMeasures, Way, faults, measure};
use crate::syntax::mesh_file;
pub use crate::syntax::mesh_file::Triangle;

/// Names of files that are read end with one of these.
pub const FORMATS: [&str; 3] = ["stl", "obj", "msh"];

/// The triangles of a file, counterclockwise seen from outside; `None` if it is not of the format that its name ends
/// with.
pub fn triangles(path: &Path, bytes: &[u8]) -> Option<Vec<Triangle>> {
    match path.extension()?.to_ascii_lowercase().to_str()? {
        "stl" | "obj" => mesh_file::triangles(bytes).ok(),
        "msh" => msh::triangles(bytes),
        _ => None,
    }
}

/// Triangles by the indices of their corners; `None` if a corner does not exist.
pub fn indexed(corners: &[[f64; 3]], faces: impl Iterator<Item = [usize; 3]>) -> Option<Vec<Triangle>> {
    faces.map(|[a, b, c]| Some([*corners.get(a)?, *corners.get(b)?, *corners.get(c)?])).collect()
}
