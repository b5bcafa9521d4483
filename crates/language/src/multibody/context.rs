//! Permitted dependencies of formulas, by their location.

use std::fmt;

/// Permitted dependencies of a formula; each includes those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Context {
    /// Masses, points, initial values.
    Parameters,
    /// Prescribed coordinates, and numbers of joints (drivers).
    Time,
    /// Constraints: Φ(q, t).
    Positions,
    /// Effects: Q(t, q, v, λ).
    Motion,
    /// Outputs.
    Everything,
}

impl fmt::Display for Context {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Parameters => "parameters",
            Self::Time => "parameters and t",
            Self::Positions => "parameters, t and positions",
            Self::Motion => "parameters, t, positions, velocities and reactions",
            Self::Everything => "all that is observed",
        })
    }
}
