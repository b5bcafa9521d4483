//! Values of keys: numbers, names of things, and short forms.

use indexmap::IndexMap;
use schemars::JsonSchema;

use super::*;
use crate::elements::shapes::ShapeKind;
use crate::grammar::mapping::schema_only;

schema_only! {
    #[schemars(rename_all = "lowercase", inline)]
    pub enum CoordinateName {
        X,
        Y,
        Z,
        /// Angle about z.
        Angle,
        /// Euler parameters: any rotation.
        Orientation,
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum SpaceName {
        /// z = 0, and rotations about z only.
        Planar,
        /// Bodies have six degrees of freedom unless they declare their coordinates.
        Spatial,
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum FormulationName {
        /// Whichever takes fewer instructions.
        Auto,
        /// Each body has coordinates of its own, and joints constrain them.
        Absolute,
        /// The joints' angles and displacements, as far as joints give bodies their positions; those that close loops
        /// constrain them.
        Joint,
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum SchemeName {
        /// Under a tolerance whichever reaches it with the least work; else HHT-I3.
        Auto,
        /// HHT-I3.
        Hht,
        /// Dormand and Prince's method of order 8, for non-stiff models.
        Explicit,
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum BaseName {
        /// The root link is part of the ground.
        Fixed,
        /// The root link is a body like any other.
        Floating,
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum InterpolationName {
        /// The natural cubic spline.
        Cubic,
        /// Straight lines: rates jump in the points.
        Linear,
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum TimingName {
        /// Polynomials of degree three: rates are given, accelerations jump.
        Cubic,
        /// Polynomials of degree five: rates are given, accelerations are 0 in every point.
        Quintic,
        /// From rest to rest: a constant rate between constant accelerations.
        Trapezoidal,
        /// The cubic spline at rest at both ends: rates and accelerations have no jumps between them.
        Spline,
    }

    /// A time, a value, and perhaps the rate there.
    #[schemars(untagged, inline)]
    pub enum WaypointFile {
        AtRest([Number; 2]),
        WithRate([Number; 3]),
    }

    /// A position in a body's frame, or a frame there.
    #[schemars(untagged, inline)]
    pub enum PointFile {
        At(Components),
        Frame(Box<PointFrame>),
    }

    /// A shape, or several.
    #[schemars(untagged, inline)]
    pub enum ShapeFile {
        One(Box<ShapeKind>),
        Several(Vec<ShapeKind>),
    }

    /// A moment of inertia, the three principal ones along the frame's axes, or a tensor.
    #[schemars(untagged, inline)]
    pub enum InertiaFile {
        /// Moment of inertia about z; in space the same about every axis.
        Scalar(Number),
        /// xx, yy and zz.
        Principal([Number; 3]),
        Full(Tensor),
    }

    /// A number; three of a vector; or a rotation.
    #[schemars(untagged, inline)]
    pub enum StartFile {
        Number(Number),
        Vector([Number; 3]),
        Rotation(Rotation),
    }

    /// Values by name, or `equilibrium`.
    #[schemars(untagged, inline)]
    pub enum InitialFile {
        Equilibrium(EquilibriumName),
        Values(IndexMap<String, StartFile>),
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum EquilibriumName {
        /// At rest where the forces are in equilibrium, near `guess`.
        Equilibrium,
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum AnalysisName {
        /// It moves by its forces.
        Motion,
        /// It rests where its forces are in equilibrium.
        Statics,
        /// It moves as its motors say, whatever its forces and masses are.
        Kinematics,
        /// It vibrates about a configuration: see `modes`.
        Modes,
        /// There is no mechanism and no time: outputs are formulas of parameters. The default of a model that has
        /// parameters or dimensions, outputs, and nothing of a mechanism.
        Dimensions,
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum LinearisedAtName {
        /// As `initial` says.
        Start,
        /// Where forces are in equilibrium, near `guess`.
        Equilibrium,
        /// In every row of the motion.
        Motion,
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum Frame {
        /// Components along the ground's axes.
        Ground,
        /// Components along the body's axes.
        Body,
    }

    /// A column by its name, or by its number.
    #[schemars(untagged, inline)]
    pub enum Column {
        Number(u32),
        Name(String),
    }

    #[schemars(rename_all = "snake_case", inline)]
    pub enum RestitutionLawName {
        /// An impact at that speed leaves the restitution
        Exact,
        /// 3 (1 - e)/(2 v)
        HuntCrossley,
        /// 3 (1 - e^2)/(4 v)
        LankaraniNikravesh,
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum AllEffects {
        All,
    }

    /// Names of effects, joints and outputs, or `all` effects.
    #[schemars(untagged, inline)]
    pub enum Without {
        All(AllEffects),
        Names(Vec<String>),
    }

    #[schemars(untagged, inline)]
    pub enum IntervalFile {
        Ends([Number; 2]),
        /// `[490, 510] mm`
        Text(String),
    }

    /// Class of a road.
    #[schemars(inline)]
    pub enum RoadName {
        A,
        B,
        C,
        D,
        E,
        F,
        G,
        H,
    }

    #[schemars(untagged, inline)]
    pub enum RoadFile {
        Class(RoadName),
        Density(Number),
    }

    #[schemars(untagged, inline)]
    pub enum WithinFile {
        /// Both limits, of t and parameters.
        Ends([Number; 2]),
        /// `± 5 N`, `20 N ± 10%`.
        Text(String),
    }

    #[schemars(untagged, inline)]
    pub enum MeanFile {
        /// The least and the largest mean.
        Ends([Number; 2]),
        /// `0 N`, `0 N ± 1 N`.
        Value(Number),
    }

    #[schemars(untagged, inline)]
    pub enum ParameterFile {
        /// A number, a formula, or a number with its unit, perhaps with its deviation: `0.5 m ± 1%`,
        /// `0.5 m +0.01 -0.02`, `[0.49, 0.51] m`.
        Number(Number),
        /// Its smallest and largest value.
        Interval([Number; 2]),
        Full(Parameter),
    }
}
