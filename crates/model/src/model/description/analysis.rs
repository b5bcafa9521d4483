//! Analysis of a mechanism: it moves, or it is examined in one configuration or in many.

/// Analysis of a mechanism.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Analysis {
    /// It moves by its forces.
    #[default]
    Motion,
    /// It rests where its forces are in equilibrium.
    Statics,
    /// It moves as its motors say; forces and masses are of no interest.
    Kinematics,
    /// It vibrates about a configuration.
    Modes(LinearisedAt),
    /// There is no mechanism: a program answers, a black box.
    BlackBox,
    /// There is no mechanism and no time: outputs are formulas of parameters.
    Dimensions,
}

/// Configuration about which a mechanism's small vibrations are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearisedAt {
    /// At its start.
    #[default]
    Start,
    /// Where its forces are in equilibrium.
    Equilibrium,
    /// In every row of its motion.
    Motion,
}

impl Analysis {
    /// The word of a model file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Motion => "motion",
            Self::Statics => "statics",
            Self::Kinematics => "kinematics",
            Self::Modes(_) => "modes",
            Self::BlackBox => "black_box",
            Self::Dimensions => "dimensions",
        }
    }

    /// Analysis, for people; `None` of a motion.
    pub fn in_words(self) -> Option<&'static str> {
        match self {
            Self::Motion => None,
            Self::Statics => Some("statics: the equilibrium nearest to `guess`, no time steps"),
            Self::Kinematics => Some("kinematics: positions by the motors, row by row, without forces"),
            Self::Modes(LinearisedAt::Start) => Some("modes: vibrations about the start, no time steps"),
            Self::Modes(LinearisedAt::Equilibrium) => {
                Some("modes: vibrations about the equilibrium nearest to `guess`, no time steps")
            }
            Self::Modes(LinearisedAt::Motion) => Some("modes: vibrations about every row of the motion"),
            Self::BlackBox => Some("black box: a program answers, row by row"),
            Self::Dimensions => Some("dimensions: formulas of parameters, without a mechanism or time"),
        }
    }

    /// Whether there are no time steps.
    pub fn is_without_steps(self) -> bool {
        !matches!(self, Self::Motion | Self::Modes(LinearisedAt::Motion))
    }

    /// Whether more than the time steps' own rows is found of every sample.
    pub fn visits(self) -> bool {
        self != Self::Motion
    }
}

/// Questions about small vibrations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModesRequest {
    /// How many modes, the slowest first.
    pub number: usize,
    /// Responses to harmonic loads.
    pub responses: Vec<ResponseRequest>,
}

/// Response of an output to a harmonic load.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseRequest {
    /// Its name in files.
    pub name: String,
    /// The output along which the load of size one acts: a length or an angle.
    pub load: String,
    /// The output that is observed.
    pub output: String,
    /// Hz, ascending.
    pub frequencies: Vec<f64>,
}
