//! Outputs that a drawing requests of a model: hidden, by their indices in the list of all.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use symdiff::{Binary, Formula, math};

use crate::grammar::Rotation;
use crate::model::{Body, Description, Output};

/// Outputs that are requested.
#[derive(Default)]
pub(in crate::study) struct DrawingOutputs(pub Vec<Output>);

/// Three of them.
pub(in crate::study) type AskedVector = [usize; 3];

/// The orientation of a frame against another.
#[derive(Clone, Copy)]
pub(in crate::study) enum AskedRotation {
    None,
    /// Rotation about z.
    Angle(usize),
    Euler([usize; 4]),
    RollPitchYaw(AskedVector),
    AxisAngle(AskedVector, usize),
}

/// A body's frame, its centre of mass and its points, in the frame.
pub(in crate::study) struct AskedBody {
    position: Option<AskedVector>,
    rotation: AskedRotation,
    pub center_of_mass: Option<AskedVector>,
    pub has_mass: bool,
    pub points: Vec<(AskedVector, AskedRotation)>,
}

/// A frame in another.
#[derive(Clone, Copy)]
pub(in crate::study) struct RelativeFrame {
    pub position: Vector3<f64>,
    pub rotation: UnitQuaternion<f64>,
}

impl RelativeFrame {
    /// A point of the frame in the other.
    pub fn place(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.position + self.rotation * point
    }
}

impl DrawingOutputs {
    pub fn formula(&mut self, formula: Formula) -> usize {
        self.0.push(Output { name: String::new(), formula, unit: String::new(), dimension: None, of_results: false });
        self.0.len() - 1
    }

    fn motion(&mut self, body: &str, motion: &str) -> usize {
        self.formula(Formula::name(&format!("{body}.{motion}")))
    }

    pub fn vector(&mut self, formulas: &[Formula; 3]) -> AskedVector {
        formulas.each_ref().map(|formula| self.formula(formula.clone()))
    }

    pub fn rotation(&mut self, rotation: &Rotation) -> AskedRotation {
        match rotation {
            Rotation::RollPitchYaw(angles) => AskedRotation::RollPitchYaw(self.vector(angles)),
            Rotation::AxisAngle(axis, angle) => {
                AskedRotation::AxisAngle(self.vector(axis), self.formula(angle.clone()))
            }
            Rotation::Quaternion(parameters) => {
                AskedRotation::Euler(parameters.each_ref().map(|parameter| self.formula(parameter.clone())))
            }
        }
    }

    pub fn body(&mut self, description: &Description, index: usize, body: &Body) -> AskedBody {
        let zero = || Formula::number(0.0);
        let (position, rotation) = if index == 0 {
            (None, AskedRotation::None)
        } else {
            let mut motion = |motion: &str| self.motion(&body.name, motion);
            let (x, y) = (motion("x"), motion("y"));
            let z = if description.space.spatial { motion("z") } else { self.formula(zero()) };
            let rotation = if body.has_orientation() {
                AskedRotation::Euler(["p0", "p1", "p2", "p3"].map(|parameter| self.motion(&body.name, parameter)))
            } else {
                AskedRotation::Angle(self.motion(&body.name, "angle"))
            };
            (Some([x, y, z]), rotation)
        };
        let center_of_mass = body.center_of_mass.as_ref().map(|center| self.vector(center));
        let points = body.points.iter().map(|point| {
            let rotation = point.rotation.as_ref().map_or(AskedRotation::None, |rotation| self.rotation(rotation));
            (self.vector(&point.position), rotation)
        });
        let points = points.collect();
        AskedBody { position, rotation, center_of_mass, has_mass: body.mass.is_some(), points }
    }

    /// The distance of two points of a body.
    pub fn distance(&mut self, a: &[Formula; 3], b: &[Formula; 3]) {
        let square = |(a, b): (&Formula, &Formula)| {
            let difference = a.combined(Binary::Sub, b);
            difference.combined(Binary::Mul, &difference)
        };
        let [x, y, z] = [(&a[0], &b[0]), (&a[1], &b[1]), (&a[2], &b[2])].map(square);
        self.formula(x.combined(Binary::Add, &y).combined(Binary::Add, &z));
    }
}

/// Values of the requested quantities.
pub(in crate::study) struct DrawingValues(pub Vec<f64>);

impl DrawingValues {
    pub fn vector(&self, asked: AskedVector) -> Vector3<f64> {
        Vector3::from(asked.map(|output| self.0[output]))
    }

    pub fn rotation(&self, asked: AskedRotation) -> UnitQuaternion<f64> {
        match asked {
            AskedRotation::None => UnitQuaternion::identity(),
            AskedRotation::Angle(angle) => about(Vector3::z(), self.0[angle]),
            AskedRotation::Euler(parameters) => {
                let [p0, p1, p2, p3] = parameters.map(|parameter| self.0[parameter]);
                UnitQuaternion::from_quaternion(Quaternion::new(p0, p1, p2, p3))
            }
            AskedRotation::RollPitchYaw(angles) => roll_pitch_yaw(self.vector(angles).into()),
            AskedRotation::AxisAngle(axis, angle) => about(self.vector(axis), self.0[angle]),
        }
    }

    /// A body's angle relative to the ground about z, if it has no other orientation.
    pub fn angle(&self, body: &AskedBody) -> Option<f64> {
        match body.rotation {
            AskedRotation::None => Some(0.0),
            AskedRotation::Angle(angle) => Some(self.0[angle]),
            _ => None,
        }
    }

    /// Origin of a body's frame in the ground's, m.
    pub fn position(&self, body: &AskedBody) -> Vector3<f64> {
        body.position.map_or_else(Vector3::zeros, |position| self.vector(position))
    }

    /// Orientation of a body's frame in the ground's.
    pub fn orientation(&self, body: &AskedBody) -> UnitQuaternion<f64> {
        self.rotation(body.rotation)
    }

    /// A body's frame in the ground's.
    pub fn frame(&self, body: &AskedBody) -> RelativeFrame {
        RelativeFrame { position: self.position(body), rotation: self.orientation(body) }
    }
}

/// Rotation by sines and cosines that are the same bits everywhere; nalgebra's are the system's.
fn about(axis: Vector3<f64>, angle: f64) -> UnitQuaternion<f64> {
    let half = 0.5 * angle;
    let parts = Quaternion::from_parts(math::cos(half), math::sin(half) * axis.normalize());
    UnitQuaternion::new_unchecked(parts)
}

/// Rotation about the fixed x, then y, then z.
pub(super) fn roll_pitch_yaw([roll, pitch, yaw]: [f64; 3]) -> UnitQuaternion<f64> {
    about(Vector3::z(), yaw) * about(Vector3::y(), pitch) * about(Vector3::x(), roll)
}
