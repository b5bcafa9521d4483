//! Meshes of a robot's file: triangles, and volume, centre and inertia of what they enclose.

mod msh;
mod obj;
mod solid;
mod stl;

use std::path::Path;

pub use self::solid::{Faults, Measured, Way, faults, measure};
pub use self::stl::stl_corners;

/// Corners of a triangle, counterclockwise seen from outside.
pub type Triangle = [[f64; 3]; 3];

/// Names of files that are read end with one of these.
pub const FORMATS: [&str; 3] = ["stl", "obj", "msh"];

/// The triangles of a file, in the format that its name ends with; none where it is not of that format.
pub fn triangles(path: &Path, bytes: &[u8]) -> Option<Vec<Triangle>> {
    let format = path.extension()?.to_ascii_lowercase();
    match format.to_str()? {
        "stl" => {
            let corners = stl_corners(bytes)?;
            let corner = |from: &[f32]| [0, 1, 2].map(|i| f64::from(from[i]));
            Some(corners.chunks_exact(9).map(|nine| [0, 3, 6].map(|from| corner(&nine[from..from + 3]))).collect())
        }
        "obj" => obj::triangles(std::str::from_utf8(bytes).ok()?),
        "msh" => msh::triangles(bytes),
        _ => None,
    }
}

/// Triangles by the places of their corners; none where a corner is not there.
pub fn indexed(corners: &[[f64; 3]], faces: impl Iterator<Item = [usize; 3]>) -> Option<Vec<Triangle>> {
    faces.map(|[a, b, c]| Some([*corners.get(a)?, *corners.get(b)?, *corners.get(c)?])).collect()
}
