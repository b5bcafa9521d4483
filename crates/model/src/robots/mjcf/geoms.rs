//! Mass and inertia of a body's geoms.

use super::document::Item;
use super::meshes;
use super::values::{Values, along_z};
use crate::robots::algebra::{self, Pose, Value};
use crate::robots::masses::{self, MassPart};
use crate::robots::meshes::SolidMeasures;
use crate::robots::tuning::TUNING;
use crate::syntax::codes::Code;

/// The mass of geoms with the inertia about their centre in the body's frame.
pub struct GeomMass {
    pub mass: f64,
    pub center: [f64; 3],
    /// xx, yy, zz, xy, xz, yz.
    pub inertia: [f64; 6],
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Shape {
    Plane,
    Field,
    Sphere,
    Capsule,
    Ellipsoid,
    Cylinder,
    Box,
    Mesh,
}

const SHAPES: [(&str, Shape); 9] = [
    ("plane", Shape::Plane),
    ("hfield", Shape::Field),
    ("sphere", Shape::Sphere),
    ("capsule", Shape::Capsule),
    ("ellipsoid", Shape::Ellipsoid),
    ("cylinder", Shape::Cylinder),
    ("box", Shape::Box),
    ("mesh", Shape::Mesh),
    ("sdf", Shape::Mesh),
];

/// A geom's mass and inertia in the frame around it; `None` if it has none, or none that is known.
pub fn part<'i>(values: &mut Values<'i, '_>, item: &'i Item, class: Option<usize>, around: &Pose) -> Option<MassPart> {
    let get = |values: &Values<'i, '_>, name: &'static str| values.get(item, class, &["geom"], name);
    let shape = match get(values, "type") {
        Some(found) => values.word(found, &SHAPES)?,
        None => Shape::Sphere,
    };
    if let Some(found) = get(values, "group") {
        let [group] = values.exact(found)?;
        let [least, most] = values.settings.groups;
        if group < least || group > most {
            return None;
        }
    }
    let mut single = |name: &'static str| {
        let found = get(values, name)?;
        values.exact::<1>(found).map(|[value]| value)
    };
    let (mass, density) = (single("mass"), single("density").unwrap_or(TUNING.density));
    if mass.unwrap_or(density) == 0.0 || matches!(shape, Shape::Plane | Shape::Field) {
        return None;
    }
    if let Some(wrong) =
        ["mass", "density"].into_iter().find(|name| item.get(name).is_some_and(|_| single(name) < Some(0.0)))
    {
        values.error(Code::BadXmlValue, item.span.clone(), format!("the {wrong} of this geom is negative"), None);
        return None;
    }
    let (pose, volume, inertia) = match (shape, get(values, "mesh")) {
        (Shape::Mesh, Some(mesh)) => {
            let SolidMeasures { size, center, inertia } = meshes::measured(values, mesh)?;
            let (position, rotation) = values.frame(item, class, &["geom"]);
            let pose = Pose { position: algebra::vector(position), rotation };
            let center = pose.then(&algebra::vector(center), &algebra::identity());
            (center, size, inertia.map(|row| row.map(|moment| moment / size)))
        }
        (Shape::Mesh, None) => {
            values.error(Code::MissingXml, item.span.clone(), "a geom that is a mesh needs `mesh`", None);
            return None;
        }
        (_, Some(mesh)) => {
            let help = "give the body an `<inertial>`, or the geom no mass: `mass=\"0\"`".to_owned();
            values.error(
                Code::UnsupportedXml,
                mesh.span.clone(),
                "a shape that is fitted to a mesh is not supported",
                help,
            );
            return None;
        }
        _ => {
            let (pose, sizes) = placed(values, item, class, shape)?;
            let (volume, [x, y, z]) = of_unit_mass(shape, sizes);
            (pose, volume, [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]])
        }
    };
    let mass = mass.unwrap_or(density * volume);
    let tensor = inertia.map(|row| row.map(|moment| Value::Number(mass * moment)));
    let pose = around.then(&pose.position, &pose.rotation);
    Some(MassPart {
        mass: Value::Number(mass),
        center: pose.position,
        inertia: algebra::rotate_tensor(&pose.rotation, &tensor),
    })
}

/// Where the geom is, and its three sizes: radius and half length, or half axes.
fn placed<'i>(
    values: &mut Values<'i, '_>,
    item: &'i Item,
    class: Option<usize>,
    shape: Shape,
) -> Option<(Pose, [f64; 3])> {
    let get = |values: &Values<'i, '_>, name: &'static str| values.get(item, class, &["geom"], name);
    let needed = match shape {
        Shape::Sphere => 1,
        Shape::Capsule | Shape::Cylinder => 2,
        _ => 3,
    };
    let mut sizes = match get(values, "size") {
        Some(found) => values.parsed(found, 3)?,
        None => Vec::new(),
    };
    let (position, rotation) = values.frame(item, class, &["geom"]);
    let mut pose = Pose { position: algebra::vector(position), rotation };
    if let Some(found) = get(values, "fromto").filter(|_| shape != Shape::Sphere) {
        let [a, b, c, d, e, f] = values.exact(found)?;
        let line = [a - d, b - e, c - f];
        let length = line.iter().map(|part| part * part).sum::<f64>().sqrt();
        if length == 0.0 {
            values.error(Code::BadXmlValue, found.span.clone(), "both ends of `fromto` are the same point", None);
            return None;
        }
        pose.position = algebra::vector([(a + d) / 2.0, (b + e) / 2.0, (c + f) / 2.0]);
        pose.rotation = along_z(line);
        let width = sizes.first().copied();
        sizes.truncate(1);
        if needed == 3 {
            sizes.extend(width);
        }
        sizes.push(length / 2.0);
    }
    if sizes.len() < needed || sizes[..needed].iter().any(|size| *size <= 0.0) {
        let span = get(values, "size").map_or_else(|| item.span.clone(), |found| found.span.clone());
        values.error(Code::BadXmlValue, span, format!("the `size` of this geom has {needed} numbers above zero"), None);
        return None;
    }
    sizes.resize(3, 0.0);
    Some((pose, [sizes[0], sizes[1], sizes[2]]))
}

/// Volume, and principal moments over the mass.
fn of_unit_mass(shape: Shape, [a, b, c]: [f64; 3]) -> (f64, [f64; 3]) {
    use std::f64::consts::PI;
    match shape {
        Shape::Sphere => (4.0 / 3.0 * PI * a * a * a, [0.4 * a * a; 3]),
        Shape::Cylinder => {
            let across = (3.0 * a * a + 4.0 * b * b) / 12.0;
            (2.0 * PI * a * a * b, [across, across, a * a / 2.0])
        }
        Shape::Capsule => {
            // A cylinder, and two halves of a sphere, each with its centre of mass 3/8 of the radius beyond the
            // cylinder's end.
            let height = 2.0 * b;
            let ball = 4.0 * a / (4.0 * a + 3.0 * height);
            let across = (1.0 - ball) * (3.0 * a * a + height * height) / 12.0
                + ball * (0.4 * a * a + height * (3.0 * a + 2.0 * height) / 8.0);
            let along = (1.0 - ball) * a * a / 2.0 + ball * 0.4 * a * a;
            (PI * a * a * (height + 4.0 / 3.0 * a), [across, across, along])
        }
        Shape::Box => {
            let moment = |p: f64, q: f64| (p * p + q * q) / 3.0;
            (8.0 * a * b * c, [moment(b, c), moment(a, c), moment(a, b)])
        }
        _ => {
            let moment = |p: f64, q: f64| (p * p + q * q) / 5.0;
            (4.0 / 3.0 * PI * a * b * c, [moment(b, c), moment(a, c), moment(a, b)])
        }
    }
}

/// All parts as one; `None` if there are none.
pub fn solid(parts: &[MassPart]) -> Option<GeomMass> {
    if parts.is_empty() {
        return None;
    }
    let masses: Vec<Value> = parts.iter().map(|part| part.mass.clone()).collect();
    let mass = algebra::sum(&masses);
    let center = masses::center(parts, &mass);
    let [x, y, z] = masses::inertia(parts, &center);
    let ([mass], center) = (algebra::numbers(&[mass])?, algebra::numbers(&center)?);
    let [[xx, xy, xz], [_, yy, yz], [.., zz]] = [x, y, z];
    Some(GeomMass { mass, center, inertia: algebra::numbers(&[xx, yy, zz, xy, xz, yz])? })
}

/// A body's inertia with `boundmass`, `boundinertia` and `balanceinertia`.
pub fn bounded(values: &Values, mut solid: GeomMass) -> GeomMass {
    solid.mass = solid.mass.max(values.settings.least_mass);
    let [xx, yy, zz, xy, xz, yz] = solid.inertia;
    let tensor = nalgebra::Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let mut own = tensor.symmetric_eigen();
    let least = values.settings.least_inertia;
    if own.eigenvalues.min() < least {
        own.eigenvalues.apply(|moment| *moment = moment.max(least));
        let tensor = own.recompose();
        solid.inertia = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|index| tensor[index]);
    }
    let moments = own.eigenvalues;
    if values.settings.balance && 2.0 * moments.max() > moments.sum() {
        let mean = moments.sum() / 3.0;
        solid.inertia = [mean, mean, mean, 0.0, 0.0, 0.0];
    }
    solid
}
