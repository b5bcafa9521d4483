//! Results of a verification of a model.

use serde::Serialize;
use symdiff::math;

use super::tuning::TUNING;
use crate::numerics::larger;

/// A quantity whose error is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Generalised coordinates.
    #[default]
    Positions,
    /// Their rates.
    Velocities,
    /// The rates of these.
    Accelerations,
    /// States of controllers and of effects.
    States,
    /// Lagrange multipliers.
    Reactions,
}

impl Quantity {
    /// Its name, in the plural.
    pub fn name(self) -> &'static str {
        match self {
            Self::Positions => "positions",
            Self::Velocities => "velocities",
            Self::Accelerations => "accelerations",
            Self::States => "states",
            Self::Reactions => "reactions",
        }
    }
}

/// Errors of a quantity against an exact motion, with shorter and shorter steps.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Convergence {
    /// The quantity whose error is measured.
    pub quantity: Quantity,
    /// The order predicted by theory.
    pub theory: f64,
    /// Step, s, and largest error as a share of the quantity's size, from the longest steps on.
    pub errors: Vec<(f64, f64)>,
    /// Observed orders: of each error and the one before.
    pub orders: Vec<f64>,
    /// Error below which rounding counts.
    pub rounding: f64,
    /// The observed order that counts; `None` if steps of any length are exact.
    pub order: Option<f64>,
    /// Whether the error falls as theory predicts.
    pub is_verified: bool,
}

/// A way to integrate, with the errors of all quantities.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SchemeVerification {
    /// E.g. `HHT-I3`.
    pub scheme: String,
    /// By quantity.
    pub convergence: Vec<Convergence>,
    /// Why there are none.
    pub failure: Option<String>,
}

/// Effect on the mechanism's energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Exchange {
    /// No power.
    None,
    /// All power is stored.
    Conserves,
    /// Energy is only taken.
    Dissipates,
    /// Energy is put in, at times at least.
    Drives,
}

impl Exchange {
    /// In a word or two.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Conserves => "kept",
            Self::Dissipates => "taken",
            Self::Drives => "put in",
        }
    }
}

/// Power of an effect along a motion.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct EffectBalance {
    /// Its name in the model.
    pub effect: String,
    /// E.g. `spring_damper`.
    pub kind: String,
    /// Largest power that it exchanges with the bodies, W.
    pub power: f64,
    /// Largest power that it puts in, in addition to the loss of its potential energy, W.
    pub put_in: f64,
    /// Largest power that it takes, in addition to the gain of its potential energy, W.
    pub taken: f64,
}

/// Balance of power along a motion: the virtual power of the equations' rows against the rate of kinetic energy and the
/// powers of all effects, which are summed body by body.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PowerBalance {
    /// Largest defect, as a share of `size`.
    pub defect: f64,
    /// Largest sum of the sizes of all terms, W.
    pub size: f64,
    /// By effect, in file order.
    pub effects: Vec<EffectBalance>,
}

impl EffectBalance {
    /// Adds the power at one more instant, and the rate at which energy is stored.
    pub fn add(&mut self, power: f64, stored: f64) {
        self.power = larger(self.power, power.abs());
        self.put_in = larger(self.put_in, power + stored);
        self.taken = larger(self.taken, -(power + stored));
    }

    /// The exchange of energy that it shows.
    pub fn exchange(&self) -> Exchange {
        let least = TUNING.rounding * self.power;
        match (self.put_in <= least, self.taken <= least) {
            _ if self.power == 0.0 => Exchange::None,
            (true, true) => Exchange::Conserves,
            (true, false) => Exchange::Dissipates,
            _ => Exchange::Drives,
        }
    }
}

impl PowerBalance {
    /// Whether powers are balanced to rounding.
    pub fn is_verified(&self) -> bool {
        self.defect <= TUNING.rounding
    }
}

/// Derivatives of a program against differences with twice the digits.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DerivativeCheck {
    /// The rows that are differentiated.
    pub of: String,
    /// The variables of the derivatives.
    pub by: String,
    /// Number of derivatives at one point.
    pub derivatives: usize,
    /// Largest difference at all points, as a share of the row's largest derivative by a variable of its scale.
    pub difference: f64,
}

impl DerivativeCheck {
    /// Adds the largest difference at one more point.
    pub fn add(&mut self, difference: f64) {
        self.difference = larger(self.difference, difference);
    }

    /// Whether all derivatives are exact to rounding.
    pub fn is_verified(&self) -> bool {
        self.difference <= TUNING.rounding
    }
}

/// Findings about a formulation's equations.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FormulationVerification {
    /// `absolute` or `joint`.
    pub formulation: String,
    /// Number of coordinates, and of constraints.
    pub coordinates: usize,
    /// Number of constraints.
    pub constraints: usize,
    /// Names of constraints that follow from others.
    pub redundant: Vec<String>,
    /// Names of constraints that depend on others at the start only.
    pub singular_at_start: Vec<String>,
    /// Start of the manufactured motion in the run, s: after a switch, if it is not the start of the run.
    pub begin: f64,
    /// Length of the manufactured motion, s.
    pub duration: f64,
    /// Derivatives of its programs.
    pub derivatives: Vec<DerivativeCheck>,
    /// Balance of power along it.
    pub balance: Option<PowerBalance>,
    /// By scheme.
    pub schemes: Vec<SchemeVerification>,
    /// Why nothing could be verified.
    pub failure: Option<String>,
}

/// Results of a verification of a model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verification {
    /// Name of the model.
    pub model: String,
    /// By formulation, as far as the model has it, and by part of the run.
    pub formulations: Vec<FormulationVerification>,
}

impl Convergence {
    /// Convergence of a quantity whose errors below `rounding` are not due to the steps.
    pub fn new(quantity: Quantity, theory: f64, rounding: f64) -> Self {
        Self { quantity, theory, rounding, ..Self::default() }
    }

    /// Adds the error of steps half as long.
    pub fn add(&mut self, step: f64, error: f64) {
        if let Some((_, before)) = self.errors.last() {
            self.orders.push(math::log2(before / error));
        }
        self.errors.push((step, error));
        self.order = self.observed();
        self.is_verified = self.is_as_in_theory();
    }

    /// Forgets the errors of longer steps, of which some did not converge.
    pub fn restart(&mut self) {
        *self = Self::new(self.quantity, self.theory, self.rounding);
    }

    /// The order that counts, for people.
    pub fn shown_order(&self) -> String {
        match self.order {
            None => "exact".to_owned(),
            // Transients that long steps damp, or rounding at once.
            Some(order) if order > TUNING.far_above_theory * self.theory => format!("> {:.0}", self.theory),
            Some(order) => format!("{order:.2}"),
        }
    }

    /// Whether shorter steps do not make the error smaller, which is small already.
    fn is_flat(&self) -> bool {
        let is_small = self.errors.last().is_some_and(|(_, error)| *error < TUNING.small_error);
        is_small && self.orders.last().is_some_and(|order| *order < TUNING.flat_order)
    }

    /// Whether the last error is rounding's.
    fn is_exact(&self) -> bool {
        self.errors.last().is_some_and(|(_, error)| *error <= self.rounding)
    }

    /// The error of rounding, as far as it is known.
    fn rounding(&self) -> f64 {
        match self.errors.as_slice() {
            [.., (_, before), (_, last)] if self.is_flat() => before.max(*last).max(self.rounding),
            _ => self.rounding,
        }
    }

    /// Orders after errors larger than `least`, those of the longest steps first.
    fn known(&self, least: f64) -> impl DoubleEndedIterator<Item = f64> {
        self.orders.iter().zip(&self.errors).filter(move |(_, (_, before))| *before > least).map(|(order, _)| *order)
    }

    fn follows(&self, order: f64) -> bool {
        order >= (1.0 - TUNING.below_theory) * self.theory
    }

    /// Whether the last two orders are that of theory, and rounding does not touch them.
    fn is_asymptotic(&self) -> bool {
        let is_near = |order: &f64| self.follows(*order) && *order <= (1.0 + TUNING.above_theory) * self.theory;
        let least = TUNING.touched * self.rounding();
        let is_clean = self.errors.last().is_some_and(|(_, error)| *error > least);
        is_clean && self.orders.len() >= 2 && self.orders.iter().rev().take(2).all(is_near)
    }

    /// The observed order after errors that rounding does not touch: the last one; where rounding ends the errors'
    /// fall, the largest of the last three, which it only lowers, and of those below the stated rounding, as far as
    /// errors fell there. `None` if there are none: steps of any length are exact.
    fn observed(&self) -> Option<f64> {
        let stated = TUNING.touched * self.rounding();
        if !(self.is_flat() || self.is_exact()) {
            return self.known(stated).next_back();
        }
        let largest = |least: f64| self.known(least).rev().take(3).reduce(f64::max);
        let reached = self.errors.iter().fold(stated, |least, (_, error)| least.min(TUNING.touched * error));
        largest(stated).map(|order| largest(reached).map_or(order, |below| order.max(below)))
    }

    /// Whether shorter steps give no more information: errors are at the level of rounding, or two orders agree with
    /// theory.
    pub fn is_settled(&self) -> bool {
        self.is_exact() || self.is_flat() || self.is_asymptotic()
    }

    fn is_as_in_theory(&self) -> bool {
        let ends = self.is_flat() || self.is_exact();
        let is_limited = |order: f64| self.theory > TUNING.high_order && ends && order > TUNING.high_order;
        self.order.map_or(ends, |order| self.follows(order) || is_limited(order))
    }
}

impl SchemeVerification {
    /// Whether all errors fall as theory predicts.
    pub fn is_verified(&self) -> bool {
        self.failure.is_none() && self.convergence.iter().all(|own| own.is_verified)
    }
}

impl FormulationVerification {
    /// Whether all schemes behave as theory predicts.
    pub fn is_verified(&self) -> bool {
        let is_balanced = self.balance.as_ref().is_none_or(PowerBalance::is_verified);
        let are_exact = self.derivatives.iter().all(DerivativeCheck::is_verified);
        self.failure.is_none() && are_exact && is_balanced && self.schemes.iter().all(SchemeVerification::is_verified)
    }
}

impl Verification {
    /// Whether all formulations are verified.
    pub fn is_verified(&self) -> bool {
        self.formulations.iter().all(FormulationVerification::is_verified)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_errors(theory: f64, errors: &[f64]) -> Convergence {
        let mut own = Convergence::new(Quantity::Positions, theory, 1e-13);
        errors.iter().enumerate().for_each(|(index, &error)| own.add(0.5_f64.powi(index as i32), error));
        own
    }

    #[test]
    fn orders_follow_errors_above_rounding() {
        let own = of_errors(8.0, &[2.56e-6, 1e-8, 4e-11, 3.9e-11]);
        assert!((own.order.unwrap() - 8.0).abs() < 1e-12, "{own:?}");
        assert!(own.is_settled() && own.is_verified);
        let own = of_errors(2.0, &[4e-2, 1e-2]);
        assert!(!own.is_settled() && own.is_verified);
        assert!(of_errors(2.0, &[1.6e-1, 4e-2, 1e-2]).is_settled());
    }

    /// The stated rounding is that of the worst quantity: errors that fall below it by the order of theory have it.
    #[test]
    fn errors_below_the_stated_rounding_have_orders() {
        let own = of_errors(4.0, &[3.5e-13, 1.1e-13, 7.2e-15]);
        assert!(own.is_verified && own.order.unwrap() > 3.9, "{own:?}");
        let exact = of_errors(4.0, &[2e-13, 1e-13, 3e-15]);
        assert!(exact.is_verified && exact.order.is_none(), "{exact:?}");
    }

    #[test]
    fn slowly_falling_error_is_not_verified() {
        let own = of_errors(2.0, &[4e-2, 2e-2, 1e-2]);
        assert!(!own.is_settled() && !own.is_verified);
        assert!(of_errors(2.0, &[1e-12, 1e-12]).is_verified);
        assert!(!of_errors(2.0, &[1e-3, 1e-3]).is_verified);
    }
}
