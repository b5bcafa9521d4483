//! Forms of bodies and of surfaces that touch, for pictures.

use serde::Serialize;
use symdiff::Formula;

use crate::grammar::{Mesh, PointRef, Rotation};

/// A form in its own frame. Its numbers, m, are formulas in a model, outputs of it where they are asked, and numbers
/// in a drawing.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "shape", rename_all = "snake_case")]
pub enum Form<T> {
    /// A box about the origin, and all points within a radius of it.
    Box {
        /// Edges along x, y and z, m.
        size: [T; 3],
        /// Rounding of edges and corners, m.
        radius: T,
    },
    /// A cylinder about an axis through the origin.
    Cylinder {
        /// Direction of the axis.
        axis: [T; 3],
        /// Length along the axis, m.
        length: T,
        /// Radius, m.
        radius: T,
    },
    /// A ball about the origin.
    Sphere {
        /// Radius, m.
        radius: T,
    },
    /// All points within a radius of a line.
    Capsule {
        /// Ends of the line, m.
        ends: [[T; 3]; 2],
        /// Radius, m.
        radius: T,
    },
    /// All points within a radius of the convex hull of points.
    Hull {
        /// Its points, m.
        points: Vec<[T; 3]>,
        /// Rounding of edges and corners, m.
        radius: T,
    },
    /// A line in x and y, or the plate inside it if it is closed, and all points within a radius of them.
    Outline {
        /// Its points, m.
        points: Vec<Bend<T>>,
        /// Whether the last point is joined to the first.
        is_closed: bool,
        /// Extent along z, m.
        thickness: T,
        /// Distance around the line, m.
        radius: T,
    },
    /// The wall of a hole about an axis.
    Bore {
        /// Direction of the axis.
        axis: [T; 3],
        /// Radius, m.
        radius: T,
    },
    /// All that is below a plane through the origin.
    HalfSpace {
        /// Direction out of the half space.
        normal: [T; 3],
    },
    /// Ground over the origin by its height.
    Ground {
        /// Its points, m.
        points: Vec<[T; 3]>,
    },
    /// Triangles of a file.
    Mesh {
        /// Its triangles.
        #[serde(skip)]
        mesh: Mesh,
        /// Factors along x, y and z.
        scale: [T; 3],
    },
}

/// A point of a line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bend<T> {
    /// Its position.
    pub to: [T; 3],
    /// Radius of the arc from the point before, which turns right if it is negative; `None` for a straight line.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<T>,
}

/// A form of a body, or of a surface of it.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The origin of its frame, in the body's frame or in that of the point that it belongs to, m.
    pub position: [Formula; 3],
    /// Rotation of its frame against that one.
    pub rotation: Option<Rotation>,
    /// The form, in its frame.
    pub form: Form<Formula>,
}

impl Shape {
    /// A form in the frame itself.
    pub fn in_place(form: Form<Formula>) -> Self {
        Self::at([0.0; 3].map(Formula::number), form)
    }

    /// A form about a point.
    pub fn at(position: [Formula; 3], form: Form<Formula>) -> Self {
        Self { position, rotation: None, form }
    }
}

/// A surface that an effect has at a point of a body.
pub type SurfaceAt = (PointRef, Shape);

/// The surroundings of surfaces without an end.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings {
    /// Whether the model leaves the plane.
    pub spatial: bool,
    /// Interval along x in which ground is drawn, m; `None` to draw none.
    pub along: Option<[f64; 2]>,
}

impl<T> Form<T> {
    /// The same with other numbers.
    pub fn map<U>(&self, mut to: impl FnMut(&T) -> U) -> Form<U> {
        let mut three = |point: &[T; 3]| point.each_ref().map(&mut to);
        match self {
            Self::Box { size, radius } => Form::Box { size: three(size), radius: to(radius) },
            Self::Cylinder { axis, length, radius } => {
                Form::Cylinder { axis: three(axis), length: to(length), radius: to(radius) }
            }
            Self::Sphere { radius } => Form::Sphere { radius: to(radius) },
            Self::Capsule { ends, radius } => Form::Capsule { ends: ends.each_ref().map(three), radius: to(radius) },
            Self::Hull { points, radius } => {
                Form::Hull { points: points.iter().map(three).collect(), radius: to(radius) }
            }
            Self::Outline { points, is_closed, thickness, radius } => {
                let mut bend = |bend: &Bend<T>| Bend {
                    to: bend.to.each_ref().map(&mut to),
                    radius: bend.radius.as_ref().map(&mut to),
                };
                let points = points.iter().map(&mut bend).collect();
                Form::Outline { points, is_closed: *is_closed, thickness: to(thickness), radius: to(radius) }
            }
            Self::Bore { axis, radius } => Form::Bore { axis: three(axis), radius: to(radius) },
            Self::HalfSpace { normal } => Form::HalfSpace { normal: three(normal) },
            Self::Ground { points } => Form::Ground { points: points.iter().map(three).collect() },
            Self::Mesh { mesh, scale } => Form::Mesh { mesh: mesh.clone(), scale: three(scale) },
        }
    }
}
