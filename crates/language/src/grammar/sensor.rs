//! Measured quantities of effects, and the coordinates of joints along which some are counted.

/// A coordinate of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum JointCoordinate {
    /// Angle of the second frame against the first about the joint's axis, rad, never wrapped.
    Angle,
    /// Displacement of the second point from the first along the joint's axis, m.
    Displacement,
}

/// A quantity that an effect measures, by its name; elements may have their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Sensor {
    name: &'static str,
    is_motion: bool,
    has_unit: bool,
    is_along_joint: bool,
}

impl Sensor {
    /// Distance between two points.
    pub const LENGTH: Self = Self::of_motion("length");
    /// Angle of a spring or of teeth.
    pub const ANGLE: Self = Self::of_motion("angle").along_joint();
    /// Gap between two surfaces.
    pub const GAP: Self = Self::of_motion("gap");
    /// Rate of a length, an angle or a gap.
    pub const RATE: Self = Self::of_motion("rate").along_joint();
    /// Load of a joint with friction.
    pub const LOAD: Self = Self::of_force("load");
    /// The force.
    pub const FORCE: Self = Self::of_force("force");
    /// The torque; for a beam, that at its end.
    pub const TORQUE: Self = Self::of_force("torque");
    /// Torque of a beam at its start.
    pub const START_TORQUE: Self = Self::of_force("start_torque");
    /// Friction between two surfaces.
    pub const FRICTION: Self = Self::of_force("friction");
    /// Tension between two points, whatever the sign of the effect's own force.
    pub const AXIAL: Self = Self::of_force("axial");

    /// Value of a state; the name of the effect alone refers to it too.
    pub const VALUE: Self = Self::of_motion("value");
    /// Rate of change of a state.
    pub const CHANGE: Self = Self::of_force("rate");

    /// Locations and components of the forces that an effect applies at points, for pictures. For each of up to three
    /// pairs of bodies: x, y and z of the location, then of the force on the second body. No formula of a file can have
    /// such a name.
    pub const THRUSTS: [[Self; 6]; 3] = [
        Self::of_thrust(["<x 0>", "<y 0>", "<z 0>", "<fx 0>", "<fy 0>", "<fz 0>"]),
        Self::of_thrust(["<x 1>", "<y 1>", "<z 1>", "<fx 1>", "<fy 1>", "<fz 1>"]),
        Self::of_thrust(["<x 2>", "<y 2>", "<z 2>", "<fx 2>", "<fy 2>", "<fz 2>"]),
    ];

    const fn of_thrust([x, y, z, fx, fy, fz]: [&'static str; 6]) -> [Self; 6] {
        let [x, y, z] = [Self::of_force(x), Self::of_force(y), Self::of_force(z)];
        [x, y, z, Self::of_force(fx), Self::of_force(fy), Self::of_force(fz)]
    }

    /// A measure of positions, velocities and states alone, so the effect's own formulas may refer to it.
    pub const fn of_motion(name: &'static str) -> Self {
        Self { name, is_motion: true, has_unit: true, is_along_joint: false }
    }

    /// A measure that depends on the forces.
    pub const fn of_force(name: &'static str) -> Self {
        Self { name, is_motion: false, has_unit: true, is_along_joint: false }
    }

    /// The same with an unknown unit.
    #[must_use]
    pub const fn of_unknown_unit(self) -> Self {
        Self { has_unit: false, ..self }
    }

    /// The same, counted along the coordinate of the effect's joint, if it is on one.
    #[must_use]
    pub const fn along_joint(self) -> Self {
        Self { is_along_joint: true, ..self }
    }

    /// Generalised force on a joint's coordinate.
    pub fn of_effort(coordinate: JointCoordinate) -> Self {
        match coordinate {
            JointCoordinate::Angle => Self::TORQUE,
            JointCoordinate::Displacement => Self::FORCE,
        }
    }

    /// Its name, as in `spring.length`.
    pub const fn name(self) -> &'static str {
        self.name
    }

    /// Whether it depends on positions, velocities and states alone.
    pub fn is_motion(self) -> bool {
        self.is_motion
    }

    /// Whether it is counted along a joint's coordinate: in a mirror it changes its sign if that joint turns.
    pub fn is_along_joint(self) -> bool {
        self.is_along_joint
    }

    /// Whether its unit is known.
    pub fn has_unit(self) -> bool {
        self.has_unit
    }
}
