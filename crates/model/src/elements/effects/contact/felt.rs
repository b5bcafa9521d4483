//! Measured quantities of contacts.

use symdiff::Scalar;

use crate::elements::effects::{Forces, TypedSensor};
use crate::grammar::Sensor;
use crate::grammar::quantity::Dimension;

/// Sensors of two surfaces.
pub const SENSORS: &[TypedSensor] = &[
    (Sensor::GAP, Dimension::LENGTH),
    (Sensor::RATE, Dimension::VELOCITY),
    (Sensor::FORCE, Dimension::FORCE),
    (Sensor::FRICTION, Dimension::FORCE),
];

/// Sensors of two surfaces.
#[derive(Clone, Copy, Debug)]
pub struct Felt<'g> {
    /// m
    pub gap: Scalar<'g>,
    /// m/s
    pub rate: Scalar<'g>,
    /// N
    pub force: Scalar<'g>,
    /// N
    pub friction: Option<Scalar<'g>>,
}

impl<'g> Felt<'g> {
    /// Combines two contacts: the smaller gap with its rate, and the sums of the forces.
    pub fn and(self, other: Self) -> Self {
        Self {
            gap: self.gap.min(other.gap),
            rate: (self.gap - other.gap).select(other.rate, self.rate),
            force: self.force + other.force,
            friction: self.friction.zip(other.friction).map(|(one, other)| one + other),
        }
    }

    /// Says so.
    pub fn measured(self, forces: &mut dyn Forces<'g>) {
        if let Some(friction) = self.friction {
            forces.sensor(Sensor::FRICTION, friction);
        }
        forces.sensors([(Sensor::GAP, self.gap), (Sensor::RATE, self.rate), (Sensor::FORCE, self.force)]);
    }
}
