//! A mechanism at one instant, as a drawing needs it. Positions and directions are those of the ground's frame, m.

use serde::Serialize;

use crate::elements::{Form, Glyph};

/// An assembled mechanism.
#[derive(Clone, Debug, Serialize)]
pub struct Drawing {
    /// The model's name.
    pub model: String,
    /// Whether it leaves the plane; if not, all z are zero.
    pub spatial: bool,
    /// The ground first.
    pub bodies: Vec<DrawnBody>,
    /// Joints, then effects, in file order.
    pub elements: Vec<DrawnElement>,
    /// Shapes of bodies, and surfaces of effects.
    pub solids: Vec<DrawnSolid>,
    /// The sum of all gravities, m/s²; `None` without gravity.
    pub gravity: Option<[f64; 3]>,
    /// Lengths of bodies that are uncertain parameters.
    pub lengths: Vec<DrawnLength>,
}

/// A body.
#[derive(Clone, Debug, Serialize)]
pub struct DrawnBody {
    /// Its name.
    pub name: String,
    /// The origin of its frame.
    pub position: [f64; 3],
    /// In the plane, its angle against the ground about z, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// In space, its Euler parameters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub orientation: Option<[f64; 4]>,
    /// Its centre of mass, if it has a mass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub center_of_mass: Option<[f64; 3]>,
    /// Direction of its motion, if a translation is its only coordinate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub guide: Option<[f64; 3]>,
    /// Its named points, and its frame's origin, without a name, where an element refers to it.
    pub points: Vec<DrawnPoint>,
}

/// A point of a body.
#[derive(Clone, Debug, Serialize)]
pub struct DrawnPoint {
    /// Its name; empty for the frame's origin.
    pub name: String,
    /// Its position.
    pub position: [f64; 3],
}

/// A joint or an effect.
#[derive(Clone, Debug, Serialize)]
pub struct DrawnElement {
    /// Its name.
    pub name: String,
    /// The word for it in a model file.
    pub kind: &'static str,
    /// Its symbol.
    pub glyph: Glyph,
    /// Points at which it acts.
    pub ends: Vec<[f64; 3]>,
    /// The bodies there, by index.
    pub bodies: Vec<usize>,
    /// Its axis, or the direction that it acts in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
}

/// A form that moves with a body.
#[derive(Clone, Debug, Serialize)]
pub struct DrawnSolid {
    /// Its body, by index; 0 is the ground.
    pub body: usize,
    /// The effect whose surface it is; `None` for the body's own shape.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface: Option<String>,
    /// The origin of its frame in the body's frame.
    pub position: [f64; 3],
    /// Orientation of its frame in the body's frame: Euler parameters.
    pub orientation: [f64; 4],
    /// Red, green and blue from 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<[f64; 3]>,
    /// In its frame.
    #[serde(flatten)]
    pub form: Form<f64>,
}

/// The distance of two points of a body that an uncertain parameter is.
#[derive(Clone, Debug, Serialize)]
pub struct DrawnLength {
    /// The parameter's name.
    pub parameter: String,
    /// Its nominal value, m.
    pub nominal: f64,
    /// Its least value, m.
    pub lower: f64,
    /// Its greatest value, m.
    pub upper: f64,
    /// The points.
    pub between: [[f64; 3]; 2],
}
