//! Errors of a mechanism that appear only when its equations are built.

use super::context::Context;
use crate::syntax::{Code, Coded};

/// Why a description has no equations of motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// A constraint without a coordinate in it, and not zero.
    #[error(
        "joint `{joint}`: nothing in `{constraint}` can move, yet it is {residual} instead of 0{}",
        match at { Some(sample) => format!(" ({sample})"), None => String::new() }
    )]
    Contradiction {
        /// Name of the joint.
        joint: String,
        /// Name of the constraint, e.g. `pin.y`.
        constraint: String,
        /// Its value, m or rad.
        residual: f64,
        /// Bounds of the parameters, or time, at which it occurs; `None` for the nominal values at t = 0.
        at: Option<&'static str>,
    },
    /// Joint coordinates are requested, but not possible.
    #[error("`formulation: joint` is not possible here: {why}")]
    NoJointCoordinates {
        /// Obstacle.
        why: String,
    },
    /// The speed of a motor has no known integral. The reader of model files refuses such a speed.
    #[error("a motor's speed cannot be integrated")]
    Speed,
    /// Teeth cannot touch where the bearings are.
    #[error("joint `{joint}`: {why}")]
    Teeth {
        /// Name of the joint that has teeth.
        joint: String,
        /// Obstacle.
        why: String,
    },
    /// A coordinate without inertia that forces do not determine.
    #[error("`{coordinate}` has no inertia, and {why}")]
    Massless {
        /// Name of the coordinate.
        coordinate: String,
        /// Obstacle and remedy.
        why: &'static str,
    },
    /// A name is unknown, or its value is unknown where it is used. The reader of model files refuses both.
    #[error("`{name}` cannot stand in a formula of {allowed}")]
    Name {
        /// The name.
        name: String,
        /// Quantities that the formula may depend on.
        allowed: Context,
    },
}

impl Coded for BuildError {
    fn code(&self) -> Option<Code> {
        Some(match self {
            Self::Contradiction { .. } => Code::Contradiction,
            Self::NoJointCoordinates { .. } => Code::NoJointCoordinates,
            Self::Speed => Code::BadMotor,
            Self::Teeth { .. } => Code::BadTeeth,
            Self::Massless { .. } => Code::Massless,
            Self::Name { .. } => Code::NotHere,
        })
    }
}
