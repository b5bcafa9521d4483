//! A random excitation: a stationary function of the time of which the spectral density is known.
//!
//! ```text
//! x(t) = s(t) Σ aₖ cos(2π νₖ v (t − τ) + φₖ),   aₖ = √(−2 σₖ² ln u),   φₖ = 2π u′,   σₖ² = g ∫ G dν over bin k
//! ```
//!
//! G is a one-sided density over ν, g its level, v the speed at which ν is passed (1 of a density over the frequency),
//! τ a delay, s a smooth begin. u, u′ and u″, which chooses νₖ in its bin as G has it, are independent and even between
//! 0 and 1. So x is a normal number at every time, and outputs that are linear in it have their variance and their laws
//! exactly, whatever the number of lines (Shinozuka & Deodatis, Appl. Mech. Rev. 44 (1991) 191, with random amplitudes
//! and frequencies).
//!
//! All of them follow from one parameter between 0 and 1, `NAME.seed`: u = frac(c s) for whole numbers c that no short
//! sum relates. A model has one realisation; samples vary the parameter.

use symdiff::{Formula, Scalar, Unary, math};

use super::tuning::TUNING;
use crate::numerics::statistics::Normals;
use crate::numerics::{Bin, Spectrum};

/// Largest of the whole numbers: the rest of the digits of c s is enough for a phase.
const LARGEST: f64 = 4_294_967_296.0;

/// Stream of the whole numbers, the same in all models.
const STREAM: usize = 8608;

/// A stationary random function.
#[derive(Clone, Debug)]
pub struct RandomFunction {
    /// The parameter that chooses a realisation, between 0 and 1.
    pub seed: Formula,
    /// g, of parameters.
    pub level: Formula,
    /// v, of parameters.
    pub speed: Formula,
    /// τ, s, of parameters.
    pub delay: Formula,
    /// Length of the smooth begin, s; 0 of none.
    pub ramp: f64,
    /// G.
    pub spectrum: Spectrum,
    /// Least and largest ν.
    pub band: [f64; 2],
    /// Number of lines.
    pub lines: usize,
}

impl RandomFunction {
    /// Every formula in it.
    pub fn formulas(&self) -> impl Iterator<Item = &Formula> {
        [&self.seed, &self.level, &self.speed, &self.delay].into_iter()
    }

    /// Whether a parameter chooses its realisation.
    pub fn is_chosen_by(&self, parameter: &str) -> bool {
        self.seed.names().any(|(name, _)| name == parameter)
    }

    /// x(t); `number` makes expressions of formulas.
    ///
    /// # Errors
    /// Whatever `number` says.
    pub fn value<'g, E>(
        &self,
        time: Scalar<'g>,
        number: impl Fn(&Formula) -> Result<Scalar<'g>, E>,
    ) -> Result<Scalar<'g>, E> {
        let (g, seed) = (time.builder(), number(&self.seed)?);
        let [level, speed] = [number(&self.level)?, number(&self.speed)?];
        let since = time - number(&self.delay)?;
        let mut numbers = Normals::new(STREAM);
        let mut share = || {
            let turned = seed * ((numbers.uniform() * LARGEST).floor() + 1.0);
            turned - g.scalar(g.with(|graph| graph.unary(Unary::Floor, turned.expr())))
        };
        let mut line = |bin: &Bin| {
            let [u, phase, at] = [share(), share(), share()];
            // 1 − u is not zero.
            let amplitude = (-2.0 * bin.variance * (1.0 - u).ln()).sqrt();
            let turns = std::f64::consts::TAU * (frequency(bin, at) * speed);
            amplitude * (turns * since + std::f64::consts::TAU * phase).cos()
        };
        let bins = self.spectrum.bins(self.band, self.lines);
        let sum = level.sqrt() * g.sum(bins.iter().map(&mut line).collect::<Vec<_>>());
        if self.ramp == 0.0 {
            return Ok(sum);
        }
        let (left, u) = (self.ramp - time, time / self.ramp);
        Ok(left.select(u * u * (3.0 - 2.0 * u), g.number(1.0)) * sum)
    }
}

/// The frequency in a bin below which a share of its variance lies, by the power law through its ends.
fn frequency<'g>(bin: &Bin, share: Scalar<'g>) -> Scalar<'g> {
    let [from, to] = bin.ends;
    let exponent = bin.exponent + 1.0;
    if from == 0.0 {
        return share * to;
    }
    let ratio = to / from;
    if exponent.abs() < TUNING.no_exponent {
        return from * (share * math::ln(ratio)).exp();
    }
    from * ((1.0 + share * (math::pow(ratio, exponent) - 1.0)).ln() / exponent).exp()
}
