//! `<mesh>`: the solid of its triangles, by its `inertia`; read if the mass of a body needs it.

use std::path::Path;

use super::document::{Attribute, Item};
use super::values::Values;
use crate::robots::algebra;
use crate::robots::meshes::{self, FORMATS, Faults, SolidMeasures, Triangle, Way};
use crate::robots::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest::{self, clip};
use crate::syntax::text_file::regular;
use crate::syntax::tuning::TUNING as SYNTAX;

/// Measures of the body that a named mesh makes up; reports why there are none.
pub fn measured(values: &mut Values, named: &Attribute) -> Option<SolidMeasures> {
    if let Some(known) = values.meshes.known.get(&named.value) {
        return *known;
    }
    let found = match values.meshes.by_name.get(&named.value).copied() {
        Some(item) => read(values, item, &named.value),
        None => {
            let help = suggest::help(&named.value, "meshes", values.meshes.by_name.keys().map(String::as_str));
            let error = Diagnostic::error(
                Code::UnknownName,
                named.span.clone(),
                format!("unknown mesh `{}`", clip(&named.value)),
            );
            values.diagnostics.push(error.help(help));
            None
        }
    };
    values.meshes.known.insert(named.value.clone(), found);
    found
}

fn read<'i>(values: &mut Values<'i, '_>, item: &'i Item, name: &str) -> Option<SolidMeasures> {
    let class = values.class_of(item, None, "class");
    let get = |values: &Values<'i, '_>, name: &'static str| values.get(item, class, &["mesh"], name);
    let ways =
        [("legacy", Some(Way::Unsigned)), ("exact", Some(Way::Exact)), ("shell", Some(Way::Shell)), ("convex", None)];
    let way = match get(values, "inertia") {
        Some(found) => {
            let way = values.word(found, &ways)?;
            if way.is_none() {
                let help = "the inertia may be `exact`, `legacy` or `shell`, or the body's `<inertial>`".to_owned();
                values.error(
                    Code::UnsupportedXml,
                    found.span.clone(),
                    "the inertia of a mesh's convex hull is not computed",
                    help,
                );
            }
            way?
        }
        None => Way::Unsigned,
    };
    let mut triangles = match item.get("file") {
        Some(file) => from_file(values, file)?,
        None => written(values, item)?,
    };
    place(values, item, class, &mut triangles)?;
    let measured = meshes::measure(&triangles, way);
    let Faults { open, turned } = meshes::faults(&triangles);
    let is_closed = open + turned == 0;
    let faults = || match (open, turned) {
        (open, 0) => format!("{open} of its edges are of one triangle only"),
        (0, turned) => format!("along {turned} of its edges neighbours are turned against one another"),
        (open, turned) => format!(
            "{open} of its edges are of one triangle only, and along {turned} neighbours are turned against one another"
        ),
    };
    let wrong = match way {
        Way::Exact if !is_closed => Some(format!("mesh `{}` encloses no volume: {}", clip(name), faults())),
        _ if measured.size.is_nan() || measured.size <= 0.0 => {
            Some(format!("mesh `{}` has no volume, or its triangles are turned inwards", clip(name)))
        }
        _ => None,
    };
    if let Some(wrong) = wrong {
        let help = "mend the mesh, or give the body an `<inertial>`".to_owned();
        values.error(Code::BadMesh, item.span.clone(), wrong, help);
        return None;
    }
    if way == Way::Unsigned && !is_closed {
        values.meshes.open.push((item.span.clone(), format!("mesh `{}`: {}", clip(name), faults())));
    } else if way == Way::Unsigned {
        let exact = meshes::measure(&triangles, Way::Exact).size;
        if measured.size > (1.0 + TUNING.mesh_excess) * exact {
            let more = 100.0 * (measured.size / exact - 1.0);
            values.meshes.folded.push((item.span.clone(), format!("mesh `{}`: {more:.0} % more", clip(name))));
        }
    }
    Some(measured)
}

fn from_file(values: &mut Values, file: &Attribute) -> Option<Vec<Triangle>> {
    let meshes = &values.meshes;
    let named = Path::new(&file.value);
    let named = if meshes.strips { named.file_name().map_or(named, Path::new) } else { named };
    let path = meshes.files.find(&meshes.folder, &meshes.meshdir.join(named).to_string_lossy());
    let path = match path {
        Ok(path) => meshes.files.full(&path),
        Err(error) => {
            values.error(error.code, file.span.clone(), error.message, error.help);
            return None;
        }
    };
    let bytes = match regular(&path, SYNTAX.mesh_bytes) {
        Ok(bytes) => bytes,
        Err(error) => {
            values.error(
                Code::BadMesh,
                file.span.clone(),
                format!("the mesh `{}` cannot be read: {error}", clip(&file.value)),
                None,
            );
            return None;
        }
    };
    let triangles = meshes::triangles(&path, &bytes);
    if triangles.is_none() {
        let message = format!("`{}` is no mesh of triangles", clip(&file.value));
        values.error(
            Code::BadMesh,
            file.span.clone(),
            message,
            format!("files of meshes are {}", suggest::list(&FORMATS)),
        );
    }
    triangles
}

/// `vertex` and `face`.
fn written(values: &mut Values, item: &Item) -> Option<Vec<Triangle>> {
    let (Some(corners), Some(faces)) = (item.get("vertex"), item.get("face")) else {
        let help = "without `face` the mesh is a convex hull, which is not computed".to_owned();
        values.error(Code::BadMesh, item.span.clone(), "`<mesh>` needs `file`, or `vertex` and `face`", help);
        return None;
    };
    let corner_numbers = values.parsed(corners, usize::MAX)?;
    let (corner_numbers, more) = corner_numbers.as_chunks::<3>();
    let place_of = |number: &f64| (number.fract() == 0.0 && *number >= 0.0).then_some(*number as usize);
    let face_numbers: Option<Vec<usize>> = values.parsed(faces, usize::MAX)?.iter().map(place_of).collect();
    let face_numbers = face_numbers.unwrap_or_default();
    let (face_numbers, rest) = face_numbers.as_chunks::<3>();
    let found = meshes::indexed(corner_numbers, face_numbers.iter().copied());
    let found = found.filter(|found| more.is_empty() && rest.is_empty() && !found.is_empty());
    if found.is_none() {
        values.error(
            Code::BadMesh,
            faces.span.clone(),
            "`face` has three places of corners of `vertex` a triangle, from 0",
            None,
        );
    }
    found
}

/// Where the geom's frame is in the mesh, and the mesh's scale.
fn place<'i>(
    values: &mut Values<'i, '_>,
    item: &'i Item,
    class: Option<usize>,
    triangles: &mut [Triangle],
) -> Option<()> {
    let get = |values: &Values<'i, '_>, name: &'static str| values.get(item, class, &["mesh"], name);
    let mut three = |name: &'static str, or: [f64; 3]| match get(values, name) {
        Some(found) => values.exact::<3>(found),
        None => Some(or),
    };
    let (from, scale) = (three("refpos", [0.0; 3])?, three("scale", [1.0; 3])?);
    let turn = match get(values, "refquat") {
        Some(found) => {
            let q = values.exact::<4>(found)?;
            let length = q.iter().map(|part| part * part).sum::<f64>().sqrt();
            algebra::matrix(&algebra::inverse(&q.map(|part| algebra::number(part / length))))
        }
        None => algebra::matrix(&algebra::identity()),
    };
    let turn = turn.each_ref().map(|row| algebra::numbers(row).unwrap_or_default());
    for triangle in triangles.iter_mut() {
        *triangle = triangle.map(|corner| {
            let moved = [0, 1, 2].map(|i| corner[i] - from[i]);
            [0, 1, 2].map(|i| scale[i] * (0..3).map(|k| turn[i][k] * moved[k]).sum::<f64>())
        });
        // A mirror image is turned inside out.
        if scale.iter().product::<f64>() < 0.0 {
            triangle.swap(1, 2);
        }
    }
    Some(())
}

/// Says of which meshes the inertia is in doubt.
pub fn warn(values: &mut Values) {
    let of_open = "this mesh is no closed surface: its inertia is that of tetrahedra to its middle, as MuJoCo has it";
    let of_folded = "tetrahedra to the middle of this mesh, which MuJoCo takes, are more than it encloses";
    let help_open = "mend the mesh, or give the body an `<inertial>`";
    let help_folded = "with `inertia=\"exact\"` its inertia is that of the enclosed volume";
    let open = std::mem::take(&mut values.meshes.open);
    let folded = std::mem::take(&mut values.meshes.folded);
    for (found, message, help) in [(open, of_open, help_open), (folded, of_folded, help_folded)] {
        let Some((span, first)) = found.first() else { continue };
        let others = match found.len() {
            1 => String::new(),
            count => format!(", and {} more meshes", count - 1),
        };
        let warning = Diagnostic::warning(Code::MeshIgnored, span.clone(), format!("{message} ({first}{others})"));
        values.diagnostics.push(warning.help(help.to_owned()));
    }
}
