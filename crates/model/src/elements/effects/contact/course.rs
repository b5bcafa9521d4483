//! Points in a frame, and lines through them of straight edges and arcs, as a file has them.

use std::ops::Deref;

use schemars::{Schema, SchemaGenerator, json_schema};
use symdiff::{Formula, Scalar, math};

use crate::elements::effects::Forces;
use crate::elements::form::Bend;
use crate::grammar::{Image, Node, Quantity, Reader, Span, SymbolTable, Value, values};
use crate::multibody::{BuildError, Vector};
use crate::syntax::codes::Code;
use crate::syntax::yaml;

/// Points in a frame.
#[derive(Clone, Debug)]
pub struct Points(Vec<[Formula; 3]>);

impl Deref for Points {
    type Target = [[Formula; 3]];

    fn deref(&self) -> &[[Formula; 3]] {
        &self.0
    }
}

impl Value for Points {
    const IMAGE: Image = Image::Polars;

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, _: Span, quantity: &Quantity) -> Option<Self> {
        let items = items(reader, node)?;
        let points: Vec<_> =
            items.iter().map(|item| reader.components(item, quantity.context, quantity.dimension())).collect();
        points.into_iter().collect::<Option<_>>().map(Self)
    }

    fn schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<Vec<values::Components>>()
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.extend(self.0.iter().flatten());
    }

    fn leaves_plane(node: &Node) -> bool {
        matches!(&node.value, yaml::Value::Sequence(items) if items.iter().any(crate::grammar::plane::points_out))
    }
}

/// The items of a list of points.
fn items<'n, S: SymbolTable>(reader: &mut Reader<'_, S>, node: &'n Node) -> Option<&'n [Node]> {
    match &node.value {
        yaml::Value::Sequence(items) if !items.is_empty() => Some(items),
        _ => {
            let help = "e.g. `[[0, 0], [0.2, 0], [0.2, 0.1]]`".to_owned();
            let message = "a list of points belongs here, each a list of two or three numbers";
            reader.error(Code::WrongShape, node.span.clone(), message, help);
            None
        }
    }
}

/// A line through points.
#[derive(Clone, Debug)]
pub struct ContactLine(Vec<Stop>);

/// A point of a line, and how it comes there.
#[derive(Clone, Debug)]
struct Stop {
    place: [Formula; 3],
    /// Radius of the arc from the point before; `None` for a straight edge.
    radius: Option<Formula>,
}

/// The same as expressions.
#[derive(Clone, Copy, Debug)]
pub struct Corner<'g> {
    /// m
    pub place: Vector<'g>,
    /// m, negative where the arc turns right
    pub radius: Option<Scalar<'g>>,
}

impl ContactLine {
    /// Its points as expressions.
    pub fn corners<'g>(&self, forces: &dyn Forces<'g>) -> Result<Vec<Corner<'g>>, BuildError> {
        let corner = |stop: &Stop| {
            let radius = stop.radius.as_ref().map(|radius| forces.prescribed(radius)).transpose()?;
            Ok(Corner { place: forces.prescribed_vector(&stop.place)?, radius })
        };
        self.0.iter().map(corner).collect()
    }

    /// Its points for a picture.
    pub fn bends(&self) -> Vec<Bend<Formula>> {
        self.0.iter().map(|stop| Bend { to: stop.place.clone(), radius: stop.radius.clone() }).collect()
    }

    /// Reports too few points, neighbours that are one point somewhere in the box of parameters, and arcs that do not
    /// reach.
    pub fn check_edges<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, at: Span, key: &str, least: usize) {
        let count = self.0.len();
        if count < least {
            let article = if key.starts_with('o') { "an" } else { "a" };
            reader.error(
                Code::BadSurface,
                at,
                format!("{article} `{key}` has {least} points or more, not {count}"),
                None,
            );
            return;
        }
        let is_open = least == 2;
        if is_open && self.0[0].radius.is_some() {
            reader.error(
                Code::BadSurface,
                at,
                format!("a `{key}` does not begin with an arc: there is no point before"),
                None,
            );
            return;
        }
        let edges = if is_open { count - 1 } else { count };
        for corner in 0..reader.corners.len() {
            let place = |stop: &Stop| {
                let [x, y] = [0, 1].map(|axis| reader.evaluate(&stop.place[axis], corner));
                x.zip(y)
            };
            for edge in 0..edges {
                let next = &self.0[(edge + 1) % count];
                let Some(((x, y), (to_x, to_y))) = place(&self.0[edge]).zip(place(next)) else { continue };
                let chord = math::hypot(to_x - x, to_y - y);
                let radius = next.radius.as_ref().and_then(|radius| reader.evaluate(radius, corner));
                let (start, end) = (edge + 1, (edge + 1) % count + 1);
                let label = reader.corners[corner].label.clone();
                if chord == 0.0 {
                    let help = (end == 1).then(|| "it closes by itself: leave its last point out".to_owned());
                    reader.error(
                        Code::BadSurface,
                        at,
                        format!("points {start} and {end} of the `{key}` are one point{label}"),
                        help,
                    );
                    return;
                }
                if let Some(radius) = radius.filter(|radius| 2.0 * radius.abs() <= chord) {
                    let message = format!(
                        "points {start} and {end} of the `{key}` are {chord} m apart: an arc of radius {radius} m does not reach{label}"
                    );
                    let help = "an arc is less than half a turn; give it a point in between".to_owned();
                    reader.error(Code::BadSurface, at, message, help);
                    return;
                }
            }
        }
    }
}

impl Value for ContactLine {
    const IMAGE: Image = Image::Polars;

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, _: Span, quantity: &Quantity) -> Option<Self> {
        let stop = |reader: &mut Reader<'_, S>, item: &Node| {
            let yaml::Value::Mapping(_) = &item.value else {
                let place = reader.components(item, quantity.context, quantity.dimension())?;
                return Some(Stop { place, radius: None });
            };
            let fields = reader.mapping("an arc", vec!["to", "radius"], item, item.span.clone())?;
            let [to, radius] = ["to", "radius"].map(|key| reader.required(&fields, key));
            let place = reader.components(to?, quantity.context, quantity.dimension());
            let radius = reader.formula(radius?, quantity.context, quantity.dimension());
            Some(Stop { place: place?, radius: Some(radius?) })
        };
        let stops: Vec<_> = items(reader, node)?.iter().map(|item| stop(reader, item)).collect();
        stops.into_iter().collect::<Option<_>>().map(Self)
    }

    fn schema(generator: &mut SchemaGenerator) -> Schema {
        let (point, number) =
            (generator.subschema_for::<values::Components>(), generator.subschema_for::<values::Number>());
        json_schema!({
            "type": "array",
            "items": {
                "anyOf": [
                    point,
                    {
                        "description": "An arc from the point before, of less than half a turn; it turns right where the radius is negative.",
                        "type": "object",
                        "properties": { "to": point, "radius": number },
                        "required": ["to", "radius"],
                        "additionalProperties": false
                    }
                ]
            }
        })
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.extend(self.0.iter().flat_map(|stop| stop.place.iter().chain(&stop.radius)));
    }

    fn leaves_plane(node: &Node) -> bool {
        let place = |item: &Node| {
            item.get("to").map_or_else(|| crate::grammar::plane::points_out(item), crate::grammar::plane::points_out)
        };
        matches!(&node.value, yaml::Value::Sequence(items) if items.iter().any(place))
    }
}

/// Formulas of points as vectors.
pub fn placed<'g>(forces: &dyn Forces<'g>, points: &Points) -> Result<Vec<Vector<'g>>, BuildError> {
    points.iter().map(|point| forces.prescribed_vector(point)).collect()
}
