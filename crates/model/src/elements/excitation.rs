//! An excitation: any function of the time within limits.
//!
//! ```text
//! x(t) = m(t) + b(t, p) u(t)    u a function of a class:
//!
//! bounded                |u| ≤ 1                          with jumps
//! held                   |u| ≤ 1, constant over each period T
//! bounded rate           |u̇| ≤ 1, u(0) = 0               b is the largest rate, m = 0
//! bounded, bounded rate  |u| ≤ 1, |u̇| ≤ ρ = r/b
//! ```
//!
//! As a constant, u is one number between −1 and 1, or t times one: an uncertain parameter, `NAME.deviation`. As a
//! function it is u(t) = level + slope · t over cells of the time, of which both numbers are inputs of the equations.

use symdiff::{Formula, Scalar};

/// Limits of a function of the time.
#[derive(Clone, Debug)]
pub struct Excitation {
    /// The parameter that it is as a constant.
    pub deviation: Formula,
    /// m, of t and parameters.
    pub middle: Formula,
    /// b, of t and parameters: half of the distance of the limits, or the largest rate.
    pub reach: Formula,
    /// Which functions u may be.
    pub class: Class,
}

/// Functions that an excitation may be.
#[derive(Clone, Debug)]
pub enum Class {
    /// All between the limits.
    Bounded,
    /// Those between the limits that are constant over each period, s.
    Held(f64),
    /// Those with a bounded rate, from 0 on.
    Rate,
    /// Those between the limits with a bounded rate: its ratio to `reach`, 1/s, of parameters.
    BoundedRate(Formula),
}

impl Class {
    /// Whether the functions jump, so that they have no rate.
    pub fn jumps(&self) -> bool {
        matches!(self, Self::Bounded | Self::Held(_))
    }
}

impl Excitation {
    /// Every formula in it.
    pub fn formulas(&self) -> impl Iterator<Item = &Formula> {
        let ratio = match &self.class {
            Class::BoundedRate(ratio) => Some(ratio),
            _ => None,
        };
        [&self.deviation, &self.middle, &self.reach].into_iter().chain(ratio)
    }

    /// x(t), of u; `number` makes expressions of formulas.
    ///
    /// # Errors
    /// Whatever `number` says.
    pub fn value<'g, E>(
        &self,
        u: Scalar<'g>,
        number: impl Fn(&Formula) -> Result<Scalar<'g>, E>,
    ) -> Result<Scalar<'g>, E> {
        Ok(number(&self.middle)? + number(&self.reach)? * u)
    }

    /// u as a constant: the parameter, or what grows at a constant rate.
    pub fn as_constant<'g>(&self, parameter: Scalar<'g>, time: Scalar<'g>) -> Scalar<'g> {
        match self.class {
            Class::Rate => parameter * time,
            _ => parameter,
        }
    }
}
