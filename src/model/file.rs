//! The grammar of a model file: which keys stand where.
//!
//! One declaration serves the reader, which takes the known keys from it, and the JSON Schema for editors.

#![allow(dead_code)] // the fields are there for their names and types

use indexmap::IndexMap;
use schemars::transform::{RecursiveTransform, Transform};
use schemars::{JsonSchema, Schema};

/// A mapping of the file whose keys are fixed.
pub trait Grammar {
    /// What the mapping is, for messages: `a body`.
    const WHAT: &'static str;
    /// Its keys, in the order in which they are suggested.
    const KEYS: &'static [&'static str];
}

/// A number, a formula, or a number with its unit.
#[derive(JsonSchema)]
#[schemars(untagged)]
enum Number {
    /// A number in SI units.
    Plain(f64),
    /// A formula (`m1*l1^2/12`) or a number with a unit (`120 mm`).
    Text(String),
}

/// Components along x and y, and in space along z, which is 0 where it is left out.
#[derive(JsonSchema)]
#[schemars(untagged, inline)]
enum Components {
    Planar([Number; 2]),
    Spatial([Number; 3]),
}

/// Direction: `x`, `y`, `z` or components.
#[derive(JsonSchema)]
#[schemars(untagged, inline)]
enum Direction {
    Named(Axis),
    Components(Components),
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase", inline)]
enum Axis {
    X,
    Y,
    Z,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase", inline)]
enum CoordinateName {
    X,
    Y,
    Z,
    /// About z.
    Angle,
    /// Euler parameters: any rotation.
    Orientation,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase", inline)]
enum SpaceName {
    /// z = 0, and rotations about z only.
    Planar,
    /// Bodies that say nothing else have six freedoms.
    Spatial,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase", inline)]
enum FormulationName {
    /// Whichever takes fewer instructions.
    Auto,
    /// Each body has coordinates of its own, and joints constrain them.
    Absolute,
    /// The joints' angles and displacements, of which each carries a body; joints that close loops constrain them.
    Joint,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase", inline)]
enum BaseName {
    /// The root link is part of the ground.
    Fixed,
    /// The root link is a body like any other.
    Floating,
}

/// A place in a body's frame, or a frame there.
#[derive(JsonSchema)]
#[schemars(untagged, inline)]
enum PointFile {
    At(Components),
    Frame(Box<PointFrame>),
}

/// A moment of inertia, the three principal ones along the frame's axes, or a tensor.
#[derive(JsonSchema)]
#[schemars(untagged, inline)]
enum InertiaFile {
    /// About z; in space the same about every axis.
    Scalar(Number),
    /// xx, yy and zz.
    Principal([Number; 3]),
    Full(Tensor),
}

/// A number of the frame's axes each, or one for all.
#[derive(JsonSchema)]
#[schemars(untagged, inline)]
enum PerAxis {
    All(Number),
    Each([Number; 3]),
}

/// A number; three of a vector; or a rotation.
#[derive(JsonSchema)]
#[schemars(untagged, inline)]
enum StartFile {
    Number(Number),
    Vector([Number; 3]),
    Rotation(Rotation),
}

/// A number (in the plane, about z), or components.
#[derive(JsonSchema)]
#[schemars(untagged, inline)]
enum TorqueValue {
    Scalar(Number),
    Vector([Number; 3]),
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase", inline)]
enum Frame {
    /// Components along the ground's axes.
    Ground,
    /// Components along the body's axes.
    Body,
}

/// A column by its name, or by its number.
#[derive(JsonSchema)]
#[schemars(untagged, inline)]
enum Column {
    Number(u32),
    Name(String),
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase", inline)]
enum JointCoordinateName {
    /// About the joint's axis.
    Angle,
    /// Along it.
    Displacement,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase", inline)]
enum ProfileName {
    /// Its acceleration is a sine.
    Cycloidal,
    /// A polynomial that begins and ends without rate and acceleration.
    Quintic,
    /// A constant rate between constant accelerations.
    Trapezoidal,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case", inline)]
enum RestitutionLawName {
    /// 3 (1 - e)/(2 v)
    HuntCrossley,
    /// 3 (1 - e^2)/(4 v)
    LankaraniNikravesh,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase", inline)]
enum Range {
    /// The polynomial's own range.
    Tight,
    /// Interval arithmetic term by term, as in the paper: wider.
    Interval,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase", inline)]
enum Expand {
    /// The independent coordinates and their velocities; outputs follow from them through the loop closure.
    Coordinates,
    /// Each output, as in the paper.
    Output,
}

/// Either the mapping or, where it needs nothing else, the list of what it is between.
#[derive(JsonSchema)]
#[schemars(untagged, inline)]
enum OrBetween<T> {
    /// Short for `{ between: [a, b] }`.
    Short([String; 2]),
    Full(T),
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase", inline)]
enum AllEffects {
    All,
}

/// Names of effects, joints and outputs, or `all` effects.
#[derive(JsonSchema)]
#[schemars(untagged, inline)]
enum Without {
    All(AllEffects),
    Names(Vec<String>),
}

/// A whole number for all parameters, or one for each uncertain parameter.
#[derive(JsonSchema)]
#[schemars(untagged, inline)]
enum PerParameter {
    All(u32),
    Each(IndexMap<String, u32>),
}

#[derive(JsonSchema)]
#[schemars(untagged, inline)]
enum ParameterFile {
    /// A number, a formula, or a number with its unit.
    Number(Number),
    /// Of a number of the URDF: its smallest and largest value.
    Interval([Number; 2]),
    Full(Parameter),
}

macro_rules! grammar {
    ($(
        $(#[doc = $doc:literal])*
        $name:ident is $what:literal $(with $extension:literal = $value:literal)* {
            $($(#[doc = $field_doc:literal])* $field:ident: $type:ty,)*
        }
    )*) => {$(
        $(#[doc = $doc])*
        #[derive(JsonSchema)]
        #[schemars(deny_unknown_fields $(, extend($extension = $value))*)]
        pub(super) struct $name {
            $($(#[doc = $field_doc])* $field: $type,)*
        }

        impl Grammar for $name {
            const WHAT: &'static str = $what;
            const KEYS: &'static [&'static str] = &[$(stringify!($field)),*];
        }
    )*};
}

grammar! {
    /// A mechanism, its uncertain parameters, and what is asked of it.
    File is "a model" {
        /// Short name; by default the file's.
        model: Option<String>,
        /// One line for people.
        description: Option<String>,
        /// Whether the mechanism stays in the plane; by default it does where nothing in the file leaves it.
        space: Option<SpaceName>,
        /// A robot to begin with: a URDF file, beside this one. Its links are bodies, its numbers parameters.
        urdf: Option<String>,
        /// Whether the robot's root link is fixed to the ground, which is the default.
        base: Option<BaseName>,
        /// Named numbers; those with a tolerance or an interval are uncertain.
        parameters: Option<IndexMap<String, ParameterFile>>,
        /// Functions given by their values: in formulas, `NAME(t)`.
        tables: Option<IndexMap<String, Table>>,
        /// Bodies, rigid or beams. `ground` is there already, and may be given points.
        bodies: Option<IndexMap<String, Body>>,
        /// What holds the bodies together.
        joints: Option<IndexMap<String, Joint>>,
        /// What moves the bodies.
        effects: Option<IndexMap<String, Effect>>,
        /// Coordinates and velocities at the start, e.g. `crank.angle: 30 deg`; assembly finds the others.
        initial: Option<IndexMap<String, StartFile>>,
        /// Where assembly begins to look for coordinates, e.g. `rocker.angle: 60 deg`.
        guess: Option<IndexMap<String, StartFile>>,
        /// What is observed: names with formulas, e.g. `x3: slider.x`.
        outputs: Option<IndexMap<String, Number>>,
        /// How long, and in which steps.
        simulation: Simulation,
        /// Which bounds to compute; without this, Chebyshev of order 5.
        bounds: Option<Bounds>,
        /// Makes stops of the limits of the robot's joints; by default they do nothing.
        limits: Option<Limits>,
        /// What is not in: effects, joints and outputs by name, or `all` effects. A scene can put them in.
        without: Option<Without>,
        /// Named variants of this model; `mbint run` runs each of them instead of it.
        scenes: Option<IndexMap<String, Scene>>,
    }

    /// A variant of the model: what is not said here is as the model says it.
    Scene is "a scene" {
        /// One line for people.
        description: Option<String>,
        /// A scene whose changes come first.
        extends: Option<String>,
        /// What is not in: effects, joints and outputs by name, or `all` effects.
        without: Option<Without>,
        /// What is in although the model, the scene that is extended or this one's `without` leaves it out.
        with: Option<Vec<String>>,
        /// New values of the model's parameters, in the model's units.
        parameters: Option<IndexMap<String, ParameterFile>>,
        /// Instead of the model's of the same name, or on top.
        joints: Option<IndexMap<String, Joint>>,
        /// Instead of the model's of the same name, or on top.
        effects: Option<IndexMap<String, Effect>>,
        /// Instead of the model's of the same name, or on top.
        initial: Option<IndexMap<String, StartFile>>,
        /// Instead of the model's of the same name, or on top.
        guess: Option<IndexMap<String, StartFile>>,
        /// Instead of the model's of the same name, or on top.
        outputs: Option<IndexMap<String, Number>>,
        /// Keys that are not as in the model.
        simulation: Option<SceneSimulation>,
        /// Instead of the model's.
        bounds: Option<Bounds>,
        /// Instead of the model's.
        limits: Option<Limits>,
    }

    /// How time is stepped in a scene.
    SceneSimulation is "`simulation`" {
        /// s
        duration: Option<Number>,
        /// Length of every step, s; instead of a `tolerance` of the model.
        step: Option<Number>,
        /// Instead of `step`: what the steps' position errors may add up to over the run, relative to |q| or, where that is larger, to the model's size.
        tolerance: Option<Number>,
        /// HHT parameter from -1/3 to below 0.
        alpha: Option<Number>,
        /// s between rows of output.
        output_step: Option<Number>,
        /// By which coordinates the motion is described.
        formulation: Option<FormulationName>,
    }

    /// Stops at the limits of a robot's joints.
    Limits is "`limits`" {
        /// How they push back.
        impact: Impact,
    }

    /// A parameter; certain unless it has a tolerance, an interval, or plus and minus.
    Parameter is "a parameter" {
        /// Its nominal value.
        value: Option<Number>,
        /// Unit of the bare numbers given here, e.g. `mm` or `N*s/m`.
        unit: Option<String>,
        /// Largest deviation either way: `1%` of the value, or a quantity.
        tolerance: Option<Number>,
        /// Smallest and largest value; without `value`, the nominal is the middle.
        interval: Option<[Number; 2]>,
        /// Largest deviation upwards.
        plus: Option<Number>,
        /// Largest deviation downwards.
        minus: Option<Number>,
        /// What it is, for people.
        description: Option<String>,
    }

    /// A function of one number by its values: a natural cubic spline through them, which goes on straight beyond its ends.
    Table is "a table" {
        /// A CSV file, beside the model; `#` begins a comment.
        file: Option<String>,
        /// Names or numbers (from 1) of the file's columns with argument and value; by default the first two.
        columns: Option<[Column; 2]>,
        /// Instead of `file`: pairs of argument and value, arguments ascending.
        points: Option<Vec<[f64; 2]>>,
        /// Units of argument and value, e.g. [ms, mm]; by default they are in SI units and fit anywhere.
        units: Option<[String; 2]>,
    }

    /// A rigid body with its frame.
    Body is "a body" {
        /// kg
        mass: Option<Number>,
        /// About the centre of mass, kg*m^2.
        inertia: Option<InertiaFile>,
        /// In the body's frame, m; by default the frame's origin.
        center_of_mass: Option<Components>,
        /// What can change; by default x, y and angle, in space x, y, z and orientation.
        coordinates: Option<Vec<CoordinateName>>,
        /// Values of the coordinates that cannot change; by default 0.
        held: Option<Held>,
        /// Named points in the body's frame, m.
        points: Option<IndexMap<String, PointFile>>,
        /// Instead of all that: a beam of the plane with mass, which bends. Its nodes `start`, `node1`, ..., `end` are bodies.
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
        /// EI, N*m^2
        bending_stiffness: Number,
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

    /// A rotation: one of `rpy`, `axis` with `angle`, and `quaternion`.
    Rotation is "a rotation" {
        /// Roll, pitch and yaw: about the fixed x, then y, then z, rad.
        rpy: Option<[Number; 3]>,
        /// The axis of a rotation by `angle`.
        axis: Option<Direction>,
        /// rad
        angle: Option<Number>,
        /// Euler parameters p0 (cosine of half the angle) to p3, of any length.
        quaternion: Option<[Number; 4]>,
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

    /// A joint: one kind with its details.
    Joint is "a joint" with "minProperties" = 1 with "maxProperties" = 1 {
        /// Two points coincide, and the bodies turn about an axis against one another.
        revolute: Option<OrBetween<AboutAxis>>,
        /// The second point moves along a line through the first, without turning against the first body.
        prismatic: Option<Prismatic>,
        /// Two points coincide and the bodies do not turn against one another.
        fixed: Option<OrBetween<Fixed>>,
        /// The second point moves along a line through the first, fixed in the first body; it may turn about z.
        pin_in_slot: Option<PinInSlot>,
        /// The second point moves along an axis through the first, and the bodies turn about it.
        cylindrical: Option<OrBetween<AboutAxis>>,
        /// A cylindrical joint that advances as it turns.
        screw: Option<Screw>,
        /// Two points coincide.
        spherical: Option<OrBetween<Between>>,
        /// Two points coincide, and an axis of the first frame stays perpendicular to one of the second.
        universal: Option<OrBetween<Universal>>,
        /// The second point moves in a plane through the first, and the bodies turn about its normal.
        planar: Option<OrBetween<InPlane>>,
        /// The second point moves along a line through the first, fixed in the first body.
        point_on_line: Option<PinInSlot>,
        /// The second point moves in a plane through the first, fixed in the first body.
        point_on_plane: Option<OrBetween<InPlane>>,
        /// Two points keep their distance.
        distance: Option<Distance>,
        /// Angles in a fixed ratio: angle of the second = ratio * angle of the first + offset.
        gear: Option<Gear>,
        /// A displacement in a fixed ratio to an angle: displacement of the rack = radius * angle of the pinion + offset.
        rack: Option<Rack>,
        /// A joint's coordinate moves as is prescribed.
        motor: Option<Motor>,
        /// `left = right` between coordinates, parameters and t, e.g. `crank.angle = omega*t`.
        equation: Option<String>,
    }

    /// Two points.
    Between is "a spherical joint" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
    }

    /// A joint that turns about an axis.
    AboutAxis is "a joint about an axis" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Direction in both points' frames; by default z.
        axis: Option<Direction>,
    }

    /// A screw joint.
    Screw is "a screw joint" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Direction in both points' frames; by default z.
        axis: Option<Direction>,
        /// Advance of the second point in a turn, m; positive for a right-handed thread.
        pitch: Number,
    }

    /// A universal joint.
    Universal is "a universal joint" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// The arms of the cross: one in the first point's frame, one in the second's; by default [x, y].
        axes: Option<[Direction; 2]>,
    }

    /// A joint that keeps a point in a plane.
    InPlane is "a joint on a plane" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Direction in both points' frames; by default z.
        normal: Option<Direction>,
    }

    /// A prismatic joint.
    Prismatic is "a prismatic joint" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Direction in the first body's frame.
        axis: Direction,
        /// Angle of the second body against the first, rad; by default 0.
        angle: Option<Number>,
    }

    /// A fixed joint.
    Fixed is "a fixed joint" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Angle of the second body against the first, rad; by default 0.
        angle: Option<Number>,
    }

    /// A pin in a slot.
    PinInSlot is "a pin in a slot" {
        /// A point of the slot's line, then the pin; each `body.point` or `body`.
        between: [String; 2],
        /// Direction of the slot in the first body's frame.
        axis: Direction,
    }

    /// A massless rod between two points.
    Distance is "a distance joint" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// m
        length: Number,
    }

    /// A rack and pinion.
    Rack is "a rack" {
        /// The joint about which the pinion turns.
        pinion: String,
        /// The joint along which the rack slides.
        rack: String,
        /// m a radian; negative where the rack goes against the angle.
        radius: Number,
        /// m; by default 0.
        offset: Option<Number>,
    }

    /// A prescribed motion; one of `position`, `speed` and `to` says which.
    Motor is "a motor" {
        /// A revolute, prismatic, cylindrical or screw joint.
        on: String,
        /// Which of the joint's; by default the displacement of a prismatic joint, the angle of others.
        coordinate: Option<JointCoordinateName>,
        /// The coordinate over time, rad or m: a formula of t, twice differentiable.
        position: Option<Number>,
        /// rad/s or m/s: from the beginning, also as a formula of t, or, with a `profile`, from rest within the `duration`.
        speed: Option<Number>,
        /// Where a move from rest to rest ends, rad or m.
        to: Option<Number>,
        /// Where the motion begins, rad or m; by default 0.
        from: Option<Number>,
        /// How the coordinate (of a move) or the speed (of a run-up) gets from the one to the other.
        profile: Option<ProfileName>,
        /// s; by default 0.
        start: Option<Number>,
        /// s
        duration: Option<Number>,
        /// Part of the duration that a trapezoidal profile takes to its full rate, and again to rest; by default 0.25.
        ramp: Option<Number>,
    }

    /// A gear pair.
    Gear is "a gear" {
        /// Two bodies (their angles about z) or two joints.
        between: [String; 2],
        /// Angle of the second per angle of the first; negative for external gears.
        ratio: Number,
        /// rad; by default 0.
        offset: Option<Number>,
    }

    /// An effect: one kind with its details.
    Effect is "an effect" with "minProperties" = 1 with "maxProperties" = 1 {
        /// The same acceleration on every body.
        gravity: Option<Gravity>,
        /// A force at a point.
        force: Option<Force>,
        /// A torque on a body.
        torque: Option<Torque>,
        /// A spring and damper between two points.
        spring_damper: Option<SpringDamper>,
        /// A spring and damper between the angles of two bodies, or on the angle of a joint.
        torsional_spring_damper: Option<TorsionalSpringDamper>,
        /// Springs and dampers between two frames.
        bushing: Option<Bushing>,
        /// Friction in a revolute, prismatic or cylindrical joint, proportional to the joint's reaction.
        joint_friction: Option<JointFriction>,
        /// Stops at the ends of a joint's way.
        stop: Option<Stop>,
        /// Contact of a plane, circle, sphere or cylinder on one body with a circle, sphere, cylinder or point on another.
        contact: Option<Contact>,
        /// A journal that is loose in its bearing.
        clearance_joint: Option<ClearanceJoint>,
        /// A drive that controls a joint's coordinate, with a limit.
        servo: Option<Servo>,
        /// Resistance of a fluid.
        drag: Option<Drag>,
        /// A cable: it pulls, and does not push.
        cable: Option<Cable>,
        /// A gear pair whose teeth have play.
        backlash: Option<Backlash>,
        /// A constant tension between two points, or a constant force or torque of a joint.
        preload: Option<Preload>,
        /// A massless beam of the plane that bends between two bodies.
        beam: Option<Beam>,
    }

    /// Gravity.
    Gravity is "`gravity`" {
        /// m/s^2, e.g. [0, -9.81].
        acceleration: Components,
    }

    /// A force.
    Force is "a force" {
        /// `body.point` or `body`.
        on: String,
        /// N; may depend on t, positions and velocities.
        value: Components,
        /// Whose axes the components are along; by default the ground's.
        frame: Option<Frame>,
    }

    /// A torque.
    Torque is "a torque" {
        /// The body it acts on, or the joint: then on its second body about its axis, and back on its first.
        on: String,
        /// The body its reaction acts on; by default the ground.
        from: Option<String>,
        /// N*m, one number about z; may depend on t, positions and velocities.
        value: TorqueValue,
        /// Whose axes the components are along; by default the ground's.
        frame: Option<Frame>,
    }

    /// A spring and damper.
    SpringDamper is "`spring_damper`" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Direction in the ground's frame; by default the line between the points.
        along: Option<Direction>,
        /// N/m; by default 0.
        stiffness: Option<Number>,
        /// N*s/m; by default 0.
        damping: Option<Number>,
        /// m; by default 0.
        free_length: Option<Number>,
        /// Further tension, N; may speak of the spring's own `NAME.length` and `NAME.rate`.
        force: Option<Number>,
    }

    /// A torsional spring and damper.
    TorsionalSpringDamper is "`torsional_spring_damper`" {
        /// Two bodies, by their angles about z.
        between: Option<[String; 2]>,
        /// Instead of `between`: a joint.
        on: Option<String>,
        /// N*m/rad; by default 0.
        stiffness: Option<Number>,
        /// N*m*s/rad; by default 0.
        damping: Option<Number>,
        /// rad; by default 0.
        free_angle: Option<Number>,
        /// Further torque against the twist, N*m; may speak of the spring's own `NAME.angle` and `NAME.rate`.
        torque: Option<Number>,
    }

    /// A bushing.
    Bushing is "a bushing" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Along the axes of the first point's frame, N/m; by default 0.
        stiffness: Option<PerAxis>,
        /// N*s/m; by default 0.
        damping: Option<PerAxis>,
        /// About those axes, for small rotations, N*m/rad; by default 0.
        torsional_stiffness: Option<PerAxis>,
        /// N*m*s/rad; by default 0.
        torsional_damping: Option<PerAxis>,
        /// Six rows: forces along and torques about those axes by displacements (N/m, N) and small rotations (N/rad, N*m/rad).
        stiffness_matrix: Option<[[Number; 6]; 6]>,
        /// The same by velocities and angular velocities.
        damping_matrix: Option<[[Number; 6]; 6]>,
    }

    /// Friction in a joint.
    JointFriction is "a joint friction" {
        /// A revolute, prismatic or cylindrical joint.
        on: String,
        /// Dry friction over the joint's reaction while sliding; by default 0.
        coefficient: Option<Number>,
        /// Dry friction at rest over that while sliding; by default 1.
        breakaway: Option<Number>,
        /// Speed at which the excess at rest has fallen to 1/e: rad/s of a revolute joint, else m/s.
        stribeck_velocity: Option<Number>,
        /// Speed that counts as rest: rad/s of a revolute joint, else m/s; by default 1e-3.
        transition_velocity: Option<Number>,
        /// Dry friction that does not depend on the reaction: N*m of a revolute joint, else N; by default 0.
        coulomb: Option<Number>,
        /// N*m*s/rad of a revolute joint, else N*s/m; by default 0.
        viscous: Option<Number>,
        /// Of the pin, m; needed where something turns and has a `coefficient`.
        radius: Option<Number>,
        /// Of the bearing along its axis, m: then the torque across the axis presses on its ends.
        length: Option<Number>,
    }

    /// Stops of a joint.
    Stop is "a stop" {
        /// A revolute, prismatic, cylindrical or screw joint.
        on: String,
        /// Which of the joint's; by default the displacement of a prismatic joint, the angle of others.
        coordinate: Option<JointCoordinateName>,
        /// m or rad
        lower: Option<Number>,
        /// m or rad
        upper: Option<Number>,
        /// How it pushes back.
        impact: Impact,
    }

    /// How surfaces push each other apart: K*depth^n*(1 + dissipation*rate).
    Impact is "`impact`" {
        /// K, N/m^n or N*m/rad^n
        stiffness: Number,
        /// n, from 1 to 3; by default 1.5.
        exponent: Option<Number>,
        /// s/m or s/rad; by default 0: nothing is lost.
        dissipation: Option<Number>,
        /// Instead of `dissipation`: speed after over speed before, above 0 and at most 1.
        restitution: Option<Number>,
        /// Speed of the impact for which the restitution holds, m/s or rad/s.
        impact_velocity: Option<Number>,
        /// Whose formula makes dissipation of restitution; by default Hunt and Crossley's.
        law: Option<RestitutionLawName>,
    }

    /// Dry friction.
    Friction is "`friction`" {
        /// Over the force across the contact, while sliding.
        coefficient: Number,
        /// Dry friction at rest over that while sliding; by default 1.
        breakaway: Option<Number>,
        /// Speed at which the excess at rest has fallen to 1/e, m/s.
        stribeck_velocity: Option<Number>,
        /// Speed that counts as rest, m/s; by default 1e-3.
        transition_velocity: Option<Number>,
    }

    /// A contact; one of `plane`, `circle` and `hollow` says what the first body's surface is.
    Contact is "a contact" {
        /// A point of the first surface or its centre, then the centre of the second; each `body.point` or `body`.
        between: [String; 2],
        /// Normal of a plane in the first point's frame, to the side where the second body is.
        plane: Option<Direction>,
        /// Radius of a circle, sphere or cylinder, m.
        circle: Option<Number>,
        /// Radius of a hollow circle, sphere or cylinder that the second is in, m.
        hollow: Option<Number>,
        /// Of the second, m; by default 0: a point.
        radius: Option<Number>,
        /// In space: axis of two parallel cylinders, in the first point's frame; by default they are spheres.
        axis: Option<Direction>,
        /// How the surfaces push each other apart.
        impact: Impact,
        /// By default none.
        friction: Option<Friction>,
    }

    /// A journal that is loose in its bearing.
    ClearanceJoint is "a clearance joint" {
        /// The bearing's centre, then the journal's; each `body.point` or `body`.
        between: [String; 2],
        /// Radius of the bearing less that of the journal, m.
        clearance: Number,
        /// Of the journal, m; by default 0.
        radius: Option<Number>,
        /// Direction in the bearing's frame; by default z.
        axis: Option<Direction>,
        /// How the surfaces push each other apart.
        impact: Impact,
        /// By default none.
        friction: Option<Friction>,
    }

    /// A controlled drive.
    Servo is "a servo" {
        /// A revolute, prismatic, cylindrical or screw joint.
        on: String,
        /// Which of the joint's; by default the displacement of a prismatic joint, the angle of others.
        coordinate: Option<JointCoordinateName>,
        /// What the coordinate should be, rad or m; may depend on t.
        target: Number,
        /// N*m/rad or N/m
        proportional: Number,
        /// N*m*s/rad or N*s/m; by default 0.
        derivative: Option<Number>,
        /// Largest torque or force, N*m or N; by default none.
        limit: Option<Number>,
    }

    /// Resistance of a fluid; either `quadratic`, or `density`, `drag_coefficient` and `area`.
    Drag is "a drag" {
        /// `body.point` or `body`.
        on: String,
        /// Force by the square of the speed, N*s^2/m^2.
        quadratic: Option<Number>,
        /// Of the fluid, kg/m^3.
        density: Option<Number>,
        /// c_d, a pure number.
        drag_coefficient: Option<Number>,
        /// That c_d refers to, m^2.
        area: Option<Number>,
        /// Force by the speed, N*s/m; by default 0.
        linear: Option<Number>,
        /// Velocity of the fluid in the ground's frame, m/s; by default 0.
        wind: Option<Components>,
    }

    /// A cable.
    Cable is "a cable" {
        /// Two points, each `body.point` or `body`.
        between: [String; 2],
        /// Length without tension, m.
        free_length: Number,
        /// N/m
        stiffness: Number,
        /// While taut, N*s/m; by default 0.
        damping: Option<Number>,
        /// Stretch over which it becomes taut, m; by default a ten-thousandth of `free_length`.
        transition: Option<Number>,
    }

    /// A gear pair whose teeth have play.
    Backlash is "a backlash" {
        /// Two bodies (their angles about z) or two joints.
        between: [String; 2],
        /// Angle of the second per angle of the first; negative for external gears.
        ratio: Number,
        /// rad; by default 0.
        offset: Option<Number>,
        /// Angle by which the second can turn while the first is held, rad.
        backlash: Number,
        /// Of the teeth at the second, N*m/rad.
        stiffness: Number,
        /// N*m*s/rad; by default 0.
        damping: Option<Number>,
        /// Angle over which teeth come to bear, rad; by default a hundredth of `backlash`.
        transition: Option<Number>,
    }

    /// A constant force.
    Preload is "a preload" {
        /// Two points, each `body.point` or `body`, that it pulls together.
        between: Option<[String; 2]>,
        /// Instead of `between`: a joint whose coordinate it pushes up.
        on: Option<String>,
        /// Which of the joint's; by default the displacement of a prismatic joint, the angle of others.
        coordinate: Option<JointCoordinateName>,
        /// N, or N*m about a joint's axis; may depend on t and the motion.
        value: Number,
    }

    /// A beam.
    Beam is "a beam" {
        /// Two points, each `body.point` or `body`, of bodies that turn about z only.
        between: [String; 2],
        /// Direction of the straight beam in both bodies' frames; by default x.
        axis: Option<Direction>,
        /// Without tension, m.
        length: Number,
        /// EA, N
        axial_stiffness: Number,
        /// EI, N*m^2
        bending_stiffness: Number,
        /// Stiffness-proportional: force by rate over force by displacement, s; by default 0.
        damping: Option<Number>,
    }

    /// How time is stepped.
    Simulation is "`simulation`" {
        /// s
        duration: Number,
        /// Length of every step, s; by default 1e-3.
        step: Option<Number>,
        /// Instead of `step`: what the steps' position errors may add up to over the run, relative to |q| or, where that is larger, to the model's size.
        tolerance: Option<Number>,
        /// HHT parameter from -1/3 to below 0; by default -0.1.
        alpha: Option<Number>,
        /// s between rows of output; by default about a 200th of the duration.
        output_step: Option<Number>,
        /// By which coordinates the motion is described; by default `auto`, whichever take fewer instructions.
        formulation: Option<FormulationName>,
    }

    /// Which bounds to compute; a method that is not named is not run.
    Bounds is "`bounds`" {
        /// Error allowed of every bound, relative to how far its output ranges over the run. Chebyshev's degree (where it has no
        /// `order`) and the steps are then chosen to meet it; what misses it is flagged.
        tolerance: Option<Number>,
        /// What may be spent on the tolerance.
        budget: Option<Budget>,
        /// A Chebyshev polynomial in the parameters.
        chebyshev: Option<Chebyshev>,
        /// A Taylor polynomial in the parameters.
        taylor: Option<Taylor>,
        /// Many samples; inner bounds.
        scan: Option<Scan>,
    }

    /// Where the search for bounds within the tolerance ends at the latest; what it has come to is kept.
    Budget is "`budget`" {
        /// Simulations; by default 3000.
        solves: Option<u32>,
        /// Seconds; by default as long as it takes. Results then depend on the machine.
        seconds: Option<Number>,
    }

    /// Chebyshev bounds.
    Chebyshev is "`chebyshev`" {
        /// Degree, for all parameters or by parameter; by default 5, or as the tolerance asks for where there is one, or more
        /// than three parameters.
        order: Option<PerParameter>,
        /// Nodes, more than the degree; by default one more.
        nodes: Option<PerParameter>,
        /// What is expanded; by default the coordinates, or the output where a `range` is asked for.
        expand: Option<Expand>,
        /// How the range of an output's polynomial is found; by default tight. Coordinates need none.
        range: Option<Range>,
    }

    /// Taylor bounds.
    Taylor is "`taylor`" {
        /// Total degree; by default 2.
        order: Option<u32>,
        /// By default tight.
        range: Option<Range>,
    }

    /// Scanning bounds.
    Scan is "`scan`" {
        /// Points, for all parameters or by parameter, both ends included; by default 30.
        points: Option<PerParameter>,
    }
}

/// The JSON Schema of model files, as text that ends with a newline.
pub fn schema() -> String {
    let mut schema = schemars::schema_for!(File);
    schema.insert("title".to_owned(), "mbint model".into());
    RecursiveTransform(without_null).transform(&mut schema);
    // A schema is a tree of JSON values: writing it out cannot fail.
    let mut text = serde_json::to_string_pretty(&schema).unwrap_or_default();
    text.push('\n');
    text
}

/// A key may be left out, but a value that is given is one: only a mapping may be written as nothing (`taylor:`).
fn without_null(schema: &mut Schema) {
    let null = serde_json::json!({ "type": "null" });
    if let Some(serde_json::Value::Array(choices)) = schema.get_mut("anyOf") {
        let mapping = |choice: &serde_json::Value| {
            let target = choice.get("$ref").and_then(serde_json::Value::as_str);
            target.is_some_and(|target| !target.ends_with("/Number"))
        };
        if !choices.iter().any(mapping) {
            choices.retain(|choice| *choice != null);
        }
    }
    if let Some(serde_json::Value::Array(types)) = schema.get("type")
        && let [only, serde_json::Value::String(second)] = types.as_slice()
        && second == "null"
        && only != "object"
    {
        let only = only.clone();
        schema.insert("type".to_owned(), only);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn same_keys<G: Grammar + JsonSchema>() {
        let schema = schemars::schema_for!(G);
        let properties = schema.get("properties").and_then(|properties| properties.as_object()).unwrap();
        let mut known: Vec<&str> = properties.keys().map(String::as_str).collect();
        let mut read = G::KEYS.to_vec();
        known.sort_unstable();
        read.sort_unstable();
        assert_eq!(known, read, "{}", G::WHAT);
        let described = |property: &serde_json::Value| property.get("description").is_some();
        assert!(properties.values().all(described), "{}", G::WHAT);
    }

    #[test]
    fn the_reader_and_the_schema_know_the_same_keys() {
        same_keys::<File>();
        same_keys::<Scene>();
        same_keys::<SceneSimulation>();
        same_keys::<Parameter>();
        same_keys::<Body>();
        same_keys::<Held>();
        same_keys::<Joint>();
        same_keys::<Prismatic>();
        same_keys::<Screw>();
        same_keys::<Rotation>();
        same_keys::<Bushing>();
        same_keys::<Effect>();
        same_keys::<SpringDamper>();
        same_keys::<JointFriction>();
        same_keys::<Contact>();
        same_keys::<Impact>();
        same_keys::<Simulation>();
        same_keys::<Bounds>();
        same_keys::<Budget>();
        same_keys::<Chebyshev>();
    }
}
