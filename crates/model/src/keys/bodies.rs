//! Bodies, their points and their inertia.

use indexmap::IndexMap;
use schemars::JsonSchema;

use super::*;

grammar! {
    /// A rigid body with its frame.
    Body is "a body" {
        /// kg; 0 where joints or springs determine where the body is.
        mass: Option<Number>,
        /// About the centre of mass, kg*m^2.
        inertia: Option<InertiaFile>,
        /// In the body's frame, m; by default the frame's origin.
        center_of_mass: Option<Components>,
        /// What can change; by default x, y and angle, in space x, y, z and orientation.
        coordinates: Option<Vec<CoordinateName>>,
        /// Values of the coordinates that cannot change, or formulas of t; by default 0.
        held: Option<Held>,
        /// Named points in the body's frame, m.
        points: Option<IndexMap<String, PointFile>>,
        /// Its looks, for `mbint show` and the report; nothing of the motion depends on them.
        shape: Option<ShapeFile>,
        /// Instead of all that: a beam with mass, which bends. Its nodes `start`, `node1`, ..., `end` are bodies.
        beam: Option<FlexibleBeam>,
    }

    /// A beam with mass.
    FlexibleBeam is "a beam" {
        /// Without tension, m.
        length: Number,
        /// kg/m
        mass_per_length: Number,
        /// EA, N
        axial_stiffness: Number,
        /// EI, N*m^2; in space that about z of the nodes.
        bending_stiffness: Number,
        /// In space: EI about y, N*m^2; by default that about z.
        bending_stiffness_y: Option<Number>,
        /// In space, and needed there: GJ, N*m^2
        torsional_stiffness: Option<Number>,
        /// GA of shear, with the section's shear coefficient in it, N; by default it does not shear.
        shear_stiffness: Option<Number>,
        /// Kelvin and Voigt's: stress by strain rate over stress by strain, s; by default 0.
        damping: Option<Number>,
        /// Between nodes, each of the same length; by default 4.
        elements: Option<usize>,
    }

    /// A frame at a point.
    PointFrame is "a point" {
        /// In the body's frame, m; by default its origin.
        position: Option<Components>,
        /// Of the frame at the point against the body's; by default none.
        rotation: Option<Rotation>,
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
        xy: Option<Number>,
        /// kg*m^2; by default 0.
        xz: Option<Number>,
        /// kg*m^2; by default 0.
        yz: Option<Number>,
    }

    /// Values of coordinates that cannot change.
    Held is "`held`" {
        /// m
        x: Option<Number>,
        /// m
        y: Option<Number>,
        /// m
        z: Option<Number>,
        /// rad, about z
        angle: Option<Number>,
        /// Instead of `angle`.
        orientation: Option<Rotation>,
    }
}
