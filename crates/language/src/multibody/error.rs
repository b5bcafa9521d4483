//! What can be wrong with a mechanism that only shows when its equations are written down.

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
        /// Where between the bounds of the parameters; `None` where it is so at the nominal values.
        at: Option<&'static str>,
    },
    /// Joint coordinates are asked for where they are not possible.
    #[error("`formulation: joint` is not possible here: {why}")]
    NoJointCoordinates {
        /// Obstacle.
        why: String,
    },
    /// The speed of a motor has no integral that is known. The reader of model files lets none through.
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
    /// A coordinate without inertia that forces do not place.
    #[error("`{coordinate}` has no inertia, and {why}")]
    Massless {
        /// Name of the coordinate.
        coordinate: String,
        /// Obstacle and remedy.
        why: &'static str,
    },
    /// A name means nothing, or cannot be known where it is used. The reader of model files lets neither through.
    #[error("`{name}` cannot stand in a formula of {allowed}")]
    Name {
        /// The name.
        name: String,
        /// What the formula may depend on.
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
