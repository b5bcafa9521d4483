//! `bodies: { LINK: { points: … } }`: points that the model gives to links of the robot, in the links' frames.

use symdiff::{Binary, Formula};

use super::DeclaredRobot;
use super::source::{Built, formula, formulas};
use crate::grammar::{PointRef, Rotation};
use crate::keys;
use crate::model::bodies;
use crate::model::description::Point;
use crate::model::names::Reader;
use crate::robots::algebra::{self, Pose};
use crate::syntax::codes::Code;
use crate::syntax::yaml::{Entry, Node, Value};

/// A point's name in its body: of a link that is welded to another, the link's name goes before it.
fn name_of(link: &str, place: PointRef, point: &str) -> String {
    match place.point {
        None => point.to_owned(),
        Some(_) => format!("{link}.{point}"),
    }
}

/// The points of an entry, unread.
fn entries(entry: &Entry) -> &[Entry] {
    match entry.value.get("points").map(|points| &points.value) {
        Some(Value::Mapping(points)) => points,
        _ => &[],
    }
}

/// Makes the names of the points known.
pub fn declare(reader: &mut Reader, built: &Built, of_links: &[(usize, &Entry)]) {
    for &(link, entry) in of_links {
        let Some(place) = built.frames[link] else { continue };
        for point in entries(entry) {
            let name = name_of(&entry.key, place, &point.key);
            let points = &mut reader.model.mechanism_mut().bodies[place.body].points;
            if points.iter().any(|known| known.name == name) {
                let message = format!("`{}` has a point or a link called `{}` already", entry.key, point.key);
                reader.error(Code::NameTaken, point.key_span.clone(), message, None);
                continue;
            }
            points.push(Point { name, position: [0.0; 3].map(Formula::number), rotation: None });
        }
    }
}

impl DeclaredRobot {
    /// Reads the points of links, once parameters are known.
    pub fn read_points(&self, reader: &mut Reader) {
        for (link, entry) in self.urdf.entries_of_links() {
            let Some(fields) = reader.fields::<keys::Body>(&entry.value, entry.key_span.clone()) else { continue };
            let other = match &entry.value.value {
                Value::Mapping(keys) => keys.iter().find(|key| key.key != "points"),
                _ => None,
            };
            if let Some(other) = other {
                let message = format!("`{}` is a link of the robot: its `{}` is in the URDF", entry.key, other.key);
                let help = format!(
                    "the model may give it `points`; numbers of the URDF are parameters, e.g. `link.{}.mass`, and a body of the model's \
                     own has another name",
                    entry.key
                );
                reader.error(Code::MisplacedKey, other.key_span.clone(), message, help);
                continue;
            }
            let (Some(node), Some(place)) = (fields.get("points"), self.built.frames[link]) else { continue };
            self.read_points_of(reader, link, entry, node, place);
        }
    }

    fn read_points_of(&self, reader: &mut Reader, link: usize, entry: &Entry, node: &Node, place: PointRef) {
        for point in reader.named_entries(node, "points") {
            if !bodies::is_name_of_point(reader, point) {
                continue;
            }
            let Some((position, rotation)) = bodies::point(reader, point) else { continue };
            let (position, rotation) = match place.point {
                None => (position, rotation),
                Some(_) => {
                    if let Some(turned) = point.value.get("rotation").filter(|_| rotation.is_some()) {
                        let body = reader.model.bodies[place.body].name.clone();
                        let message =
                            format!("link `{}` is welded to `{body}`, and its points have its own axes", entry.key);
                        let help = format!("give `{body}` the point with its rotation");
                        reader.error(Code::MisplacedKey, turned.span.clone(), message, help);
                        continue;
                    }
                    let (_, pose) = &self.built.places[link];
                    (
                        seen_from_body(reader, pose, &position),
                        Some(Rotation::Quaternion(formulas(reader, &pose.rotation))),
                    )
                }
            };
            let name = name_of(&entry.key, place, &point.key);
            let points = &mut reader.model.mechanism_mut().bodies[place.body].points;
            if let Some(known) = points.iter_mut().find(|known| known.name == name) {
                known.position = position;
                known.rotation = rotation;
            }
        }
    }
}

/// r + R s of a point s of a welded link.
fn seen_from_body(reader: &mut Reader, pose: &Pose, local: &[Formula; 3]) -> [Formula; 3] {
    let rows = algebra::matrix(&pose.rotation);
    std::array::from_fn(|axis| {
        let origin = formula(reader, &pose.position[axis]);
        rows[axis].iter().zip(local).filter(|(cosine, _)| !cosine.is_zero()).fold(origin, |sum, (cosine, local)| {
            let part = formula(reader, cosine).combined(Binary::Mul, local);
            sum.combined(Binary::Add, &part)
        })
    })
}
