//! What is done with a mechanism: it moves, or it is looked at in one configuration or in many.

/// What is done with a mechanism.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Analysis {
    /// It moves by its forces.
    #[default]
    Motion,
    /// It rests where its forces are in equilibrium.
    Statics,
    /// It moves as its motors say; forces and masses are of no interest.
    Kinematics,
    /// Its small vibrations.
    Modes,
}

impl Analysis {
    /// The word of a model file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Motion => "motion",
            Self::Statics => "statics",
            Self::Kinematics => "kinematics",
            Self::Modes => "modes",
        }
    }

    /// Whether configurations are looked at one by one, without time steps between them.
    pub fn is_without_steps(&self) -> bool {
        *self != Self::Motion
    }
}
