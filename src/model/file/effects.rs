//! Effects, one mapping each.

use schemars::JsonSchema;

use super::*;

grammar! {
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
}
