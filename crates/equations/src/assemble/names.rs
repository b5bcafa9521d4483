//! Meaning of names in formulas, and the contexts in which it is known.

use crate::elements::Trajectory;
use crate::grammar::{Symbol, TimeOrder};
use crate::model::Description;
use crate::multibody::{BuildError, Context};

/// The names of a description.
#[derive(Clone, Copy)]
pub struct DescriptionNames<'d>(&'d Description);

impl<'d> DescriptionNames<'d> {
    /// All of them.
    pub fn of(description: &'d Description) -> Self {
        Self(description)
    }

    /// Meaning of a name, if it has one.
    pub fn symbol(self, name: &str) -> Option<Symbol> {
        self.0.symbol(name)
    }

    /// A function of the time.
    pub fn trajectory(self, index: usize) -> &'d Trajectory {
        &self.0.trajectories[index]
    }

    /// Meaning of a name that is known in the context.
    pub fn known(self, name: &str, context: Context) -> Result<Symbol, BuildError> {
        let known = self.symbol(name).filter(|&symbol| least_context(symbol) <= context);
        known.ok_or_else(|| BuildError::Name { name: name.to_owned(), allowed: context })
    }
}

/// The smallest context in which something is known.
fn least_context(symbol: Symbol) -> Context {
    match symbol {
        Symbol::Parameter(_) => Context::Parameters,
        Symbol::Time | Symbol::Trajectory { .. } => Context::Time,
        Symbol::Coordinate { order, .. }
        | Symbol::Point { order, .. }
        | Symbol::AngularMotion { order, .. }
        | Symbol::JointCoordinate { order, .. } => match order {
            TimeOrder::Position => Context::Positions,
            TimeOrder::Velocity => Context::Motion,
            TimeOrder::Acceleration => Context::Everything,
        },
        Symbol::RollPitchYaw { .. } => Context::Positions,
        Symbol::Reaction { .. } => Context::Motion,
        Symbol::Sensor { measure, .. } if measure.is_motion() => Context::Motion,
        Symbol::Sensor { .. } | Symbol::Energy(_) | Symbol::BlackBox { .. } => Context::Everything,
    }
}
