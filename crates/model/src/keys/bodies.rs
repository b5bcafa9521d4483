//! Bodies, their points and their inertia.

use indexmap::IndexMap;
use schemars::JsonSchema;

use super::*;
use crate::grammar::Image;
use crate::grammar::mapping::Grammar;

/// Image of a point: of its position, or of the frame there.
pub const POINT: Image = Image::PolarOr(<PointFrame as Grammar>::images);

grammar! {
    /// A rigid body with its frame.
    Body is "a body" {
        /// Mass, kg; 0 if joints or springs determine where the body is.
        mass: Option<Number>,
        /// Moment of inertia about the centre of mass, kg*m^2.
        inertia: Option<InertiaFile> as Image::Keys(<Tensor as Grammar>::images),
        /// Centre of mass in the body's frame, m; by default the frame's origin.
        center_of_mass: Option<Components> as Image::Polar,
        /// Coordinates that can change; by default x, y and angle, in space x, y, z and orientation.
        coordinates: Option<Vec<CoordinateName>>,
        /// Values of the coordinates that cannot change, or formulas of t; by default 0.
        held: Option<Held> as Image::Keys(<Held as Grammar>::images),
        /// Named points in the body's frame, m.
        points: Option<IndexMap<String, PointFile>> as Image::Named(&POINT),
        /// Its looks, for `mbint show` and the report; nothing of the motion depends on them.
        shape: Option<ShapeFile> as Image::Shapes,
        /// Instead of all that: a beam with mass, which bends. Its nodes `start`, `node1`, ..., `end` are bodies.
        beam: Option<FlexibleBeam>,
    }

    /// A beam with mass.
    FlexibleBeam is "a beam" {
        /// Length without tension, m.
        length: Number,
        /// Mass per length, kg/m.
        mass_per_length: Number,
        /// Axial stiffness EA, N.
        axial_stiffness: Number,
        /// Bending stiffness EI, N*m^2; in space that about z of the nodes.
        bending_stiffness: Number,
        /// In space: bending stiffness EI about y, N*m^2; by default that about z.
        bending_stiffness_y: Option<Number>,
        /// In space, and needed there: torsional stiffness GJ, N*m^2.
        torsional_stiffness: Option<Number>,
        /// Shear stiffness GA, with the section's shear coefficient in it, N; by default the beam does not shear.
        shear_stiffness: Option<Number>,
        /// Damping of Kelvin and Voigt: stress by strain rate over stress by strain, s; by default 0.
        damping: Option<Number>,
        /// Number of elements between nodes, each of the same length; by default 4.
        elements: Option<usize>,
    }

    /// A frame at a point.
    PointFrame is "a point" {
        /// Position in the body's frame, m; by default its origin.
        position: Option<Components> as Image::Polar,
        /// Rotation of the frame at the point against the body's; by default none.
        rotation: Option<Rotation> as Image::Rotation,
        /// The zone in which it lies about its position: a `disc` in the body's plane, or a `sphere`.
        zone: Option<ZoneFile>,
    }

    /// Elements of the inertia tensor; xy is the integral of -x*y, as in URDF.
    Tensor is "an inertia tensor" {
        /// kg*m^2
        xx: Number,
        /// kg*m^2
        yy: Number,
        /// kg*m^2
        zz: Number,
        /// kg*m^2; by default 0.
        xy: Option<Number> as Image::Product([0, 1]),
        /// kg*m^2; by default 0.
        xz: Option<Number> as Image::Product([0, 2]),
        /// kg*m^2; by default 0.
        yz: Option<Number> as Image::Product([1, 2]),
    }

    /// Values of coordinates that cannot change.
    Held is "`held`" {
        /// m
        x: Option<Number> as Image::Along(0),
        /// m
        y: Option<Number> as Image::Along(1),
        /// m
        z: Option<Number> as Image::Along(2),
        /// rad, about z
        angle: Option<Number> as Image::About(2),
        /// Instead of `angle`.
        orientation: Option<Rotation> as Image::Rotation,
    }
}
