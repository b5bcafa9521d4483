//! An excitation: any function of the time within limits.
//!
//! ```text
//! x(t) = m(t) + b(t, p) u(t)    u a function of a class:
//!
//! bounded                |u| ≤ 1                          with jumps
//! held                   |u| ≤ 1, constant over each period T
//! bounded rate           |u̇| ≤ 1, u(0) = 0               b is the largest rate, m = 0
//! bounded, bounded rate  |u| ≤ 1, |u̇| ≤ ρ = r/b
//! moving, bounded rate   |u| ≤ 1, |ẋ| ≤ r                 m and b change in time
//! mean                   |u| ≤ 1, with a given mean over the duration
//! energy                 ∫ u² dt ≤ E/b² over the duration, and |u| ≤ 1 if there are limits
//! band                   mixtures of sines of a band whose amplitudes add up to 1 at most
//! ```
//!
//! As a constant, u is one number of its class, or t times one: an uncertain parameter between −1 and 1,
//! `NAME.deviation`, says which. As a function it is u(t) = level + slope · t over cells of the time, of which both
//! numbers are inputs of the equations.

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
    /// Class of the functions u.
    pub class: Class,
}

/// Functions that an excitation may be.
#[derive(Clone, Debug)]
pub enum Class {
    /// All between the limits.
    Bounded,
    /// Functions between the limits that are constant over each period, s.
    Held(f64),
    /// Functions with a bounded rate, from 0 on.
    Rate,
    /// Functions between the limits with a bounded rate: its ratio to `reach`, 1/s, of parameters.
    BoundedRate(Formula),
    /// Functions between limits that move with a bounded rate, of parameters.
    MovingRate(Formula),
    /// Functions between the limits with a mean over the duration between two, of parameters.
    Mean([Formula; 2]),
    /// Functions of a bounded energy over the duration.
    Energy {
        /// Largest ∫ u² dt, s, of parameters.
        energy: Formula,
        /// Whether they are between the limits too.
        is_bounded: bool,
        /// The largest constant of them, of parameters.
        constant: Formula,
    },
    /// Mixtures of sines of frequencies between these, Hz.
    Band([f64; 2]),
}

impl Class {
    /// Whether the functions jump, so that they have no rate.
    pub fn jumps(&self) -> bool {
        matches!(self, Self::Bounded | Self::Held(_) | Self::Mean(_) | Self::Energy { .. })
    }

    /// Every formula in it.
    fn formulas(&self) -> Vec<&Formula> {
        match self {
            Self::BoundedRate(rate) | Self::MovingRate(rate) => vec![rate],
            Self::Mean(mean) => mean.iter().collect(),
            Self::Energy { energy, constant, .. } => vec![energy, constant],
            Self::Bounded | Self::Held(_) | Self::Rate | Self::Band(_) => Vec::new(),
        }
    }
}

impl Excitation {
    /// Every formula in it.
    pub fn formulas(&self) -> impl Iterator<Item = &Formula> {
        [&self.deviation, &self.middle, &self.reach].into_iter().chain(self.class.formulas())
    }

    /// x(t), of the function u; `number` makes expressions of formulas.
    ///
    /// # Errors
    /// Whatever `number` says.
    pub fn of_function<'g, E>(
        &self,
        u: Scalar<'g>,
        number: impl Fn(&Formula) -> Result<Scalar<'g>, E>,
    ) -> Result<Scalar<'g>, E> {
        Ok(number(&self.middle)? + number(&self.reach)? * u)
    }

    /// x(t) as a constant: of a number of the class, or of a function that grows at a constant rate.
    ///
    /// # Errors
    /// Whatever `number` says.
    pub fn as_constant<'g, E>(
        &self,
        time: Scalar<'g>,
        number: impl Fn(&Formula) -> Result<Scalar<'g>, E>,
    ) -> Result<Scalar<'g>, E> {
        let parameter = number(&self.deviation)?;
        let u = match &self.class {
            Class::Rate => parameter * time,
            Class::Mean([lower, upper]) => {
                let (lower, upper) = (number(lower)?, number(upper)?);
                0.5 * (lower + upper) + 0.5 * (upper - lower) * parameter
            }
            Class::Energy { constant, .. } => number(constant)? * parameter,
            Class::Band([least, _]) if *least > 0.0 => time.builder().number(0.0),
            _ => parameter,
        };
        self.of_function(u, number)
    }
}
