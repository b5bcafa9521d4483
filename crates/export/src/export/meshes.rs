//! Meshes of a drawing: files named by robots are read here, others with the model.

use std::path::Path;

use super::tuning::TUNING;
use crate::elements::Form;
use crate::grammar::Mesh;
use crate::results::Drawing;
use crate::syntax::mesh_file::{Triangle, triangles};
use crate::syntax::regular;
use crate::syntax::tuning::TUNING as SYNTAX;

/// Most triangles of all meshes of a drawing; the rest is omitted.
pub const MOST_TRIANGLES: usize = TUNING.most_triangles;

/// Reads meshes that have not been read, from files in the model's folder `beside` or below it, and omits those that
/// cannot be read, and those that are too many.
pub fn read_meshes(drawing: &mut Drawing, beside: &Path, most: usize) {
    let mut left = most;
    drawing.solids.retain_mut(|solid| {
        let Form::Mesh { mesh, .. } = &mut solid.form else { return true };
        if mesh.triangles.is_empty()
            && let Some(found) = read(&mesh.file, beside)
        {
            *mesh = Mesh { triangles: found.into(), ..mesh.clone() };
        }
        let count = mesh.triangles.len();
        let fits = (1..=left).contains(&count);
        left -= if fits { count } else { 0 };
        fits
    });
}

fn read(file: &str, beside: &Path) -> Option<Vec<Triangle>> {
    let plain = file.strip_prefix("file://").unwrap_or(file);
    // The package of `package://NAME/…` may be the model's folder.
    let within = plain.strip_prefix("package://").map(|path| path.split_once('/').map_or(path, |(_, rest)| rest));
    let name = Path::new(plain).file_name()?;
    let candidates = [Path::new(within.unwrap_or(plain)), Path::new(name)];
    let beside = if beside.as_os_str().is_empty() { Path::new(".") } else { beside };
    let folder = beside.canonicalize().ok()?;
    // A link may lead out of the folder.
    let within = |path: &Path| beside.join(path).canonicalize().ok().filter(|full| full.starts_with(&folder));
    let found = candidates.into_iter().find_map(|path| regular(&within(path)?, SYNTAX.mesh_bytes).ok())?;
    triangles(&found).ok()
}
