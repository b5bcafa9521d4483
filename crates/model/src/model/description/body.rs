//! Bodies: coordinates, inertia, points.

use symdiff::Formula;

use crate::elements::shapes::ShapeKind;
use crate::grammar::{Coordinate, Rotation};
use crate::syntax::mirrors::Mirrors;

/// Elements of a body's inertia tensor about its centre of mass, along its frame's axes, kg m². I_xy = −∫ x y dm, as in
/// URDF. A body that only turns about z needs no more than zz.
#[derive(Clone, Debug)]
pub struct Inertia {
    /// Moment about x.
    pub xx: Formula,
    /// Moment about y.
    pub yy: Formula,
    /// Moment about z.
    pub zz: Formula,
    /// Product of x and y.
    pub xy: Formula,
    /// Product of x and z.
    pub xz: Formula,
    /// Product of y and z.
    pub yz: Formula,
}

impl Inertia {
    /// The same about every axis.
    pub fn scalar(value: &Formula) -> Self {
        let zero = || Formula::number(0.0);
        Self { xx: value.clone(), yy: value.clone(), zz: value.clone(), xy: zero(), xz: zero(), yz: zero() }
    }
}

/// A rigid body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// kg; absent only where no declared coordinate needs it (ground), and of a beam's node, whose mass is that of its
    /// elements.
    pub mass: Option<Formula>,
    /// Absent only where the body does not turn, and of a beam's node.
    pub inertia: Option<Inertia>,
    /// Centre of mass in the body's frame, m; by default the origin.
    pub center_of_mass: Option<[Formula; 3]>,
    /// The coordinates that the body has; the others are prescribed. Empty for the ground.
    pub coordinates: Vec<Coordinate>,
    /// Values of coordinates that the body does not have (zero if not named).
    pub prescribed: Vec<(Coordinate, Formula)>,
    /// Orientation of a body that does not turn, if it is more than an angle about z.
    pub prescribed_orientation: Option<Rotation>,
    /// Named points in the body's frame, m.
    pub points: Vec<Point>,
    /// Where its instance stands, if that has a ground of its own.
    pub standing: Option<Standing>,
    /// Its looks; nothing of the motion depends on them.
    pub shapes: Vec<ShapeKind>,
}

/// Standing of an instance: the frame in which assembly starts its search for the instance's bodies.
#[derive(Clone, Copy, Debug)]
pub struct Standing {
    /// The body that its ground is.
    pub ground: usize,
    /// The axes across which it is mirrored, before it is placed.
    pub mirrors: Mirrors,
}

impl Body {
    /// Whether its orientation is that of Euler parameters, and not an angle about z.
    pub fn has_orientation(&self) -> bool {
        self.prescribed_orientation.is_some() || self.coordinates.contains(&Coordinate::Euler(0))
    }

    /// Whether it is the ground of an instance.
    pub fn is_ground_of_instance(&self) -> bool {
        self.coordinates.is_empty() && self.name.ends_with(".ground")
    }

    /// Whether nothing of it is prescribed, so that a joint alone may determine its position.
    pub fn is_free(&self, spatial: bool) -> bool {
        let has = |coordinate: &Coordinate| self.coordinates.contains(coordinate);
        let coordinates: &[Coordinate] = if spatial {
            &[Coordinate::X, Coordinate::Y, Coordinate::Z, Coordinate::Euler(0)]
        } else {
            &[Coordinate::X, Coordinate::Y, Coordinate::Angle]
        };
        coordinates.iter().all(has) && self.prescribed.is_empty()
    }
}

/// A flexible body of the plane.
#[derive(Clone, Debug)]
pub struct FlexibleBeam {
    /// Its name, with which the names of its nodes and elements begin.
    pub name: String,
    /// Number of elements; one node more.
    pub elements: usize,
}

/// A named point of a body, and a frame there.
#[derive(Clone, Debug)]
pub struct Point {
    /// Its name within the body.
    pub name: String,
    /// Position in the body's frame, m.
    pub position: [Formula; 3],
    /// Rotation from the frame at the point to the body's; `None` if their axes are parallel.
    pub rotation: Option<Rotation>,
}
