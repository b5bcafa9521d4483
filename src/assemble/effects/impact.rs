//! The force between two surfaces by the depth δ to which they overlap.
//!
//! ```text
//! f = K ⟨δ⟩ⁿ ⟨1 + χ δ̇⟩ ≥ 0,   ⟨x⟩ = max(x, 0),   V = K ⟨δ⟩ⁿ⁺¹/(n + 1)          N, J
//! χ = 3 (1 − e)/(2 v)          Hunt & Crossley, J. Appl. Mech. 42 (1975) 440
//! χ = 3 (1 − e²)/(4 v)         Lankarani & Nikravesh, J. Mech. Des. 112 (1990) 369
//! ```
//!
//! e is the coefficient of restitution of an impact at the speed v. Hertz's n = 3/2 has a continuous slope where the
//! surfaces first touch, and the damping grows with the depth, so the force has no jump there. Surfaces do not stick: where
//! 1 + χ δ̇ is negative they have parted already. Apart the force is exactly zero, and so is its slope: the law is written for
//! δ > 0 alone, and the caller guards it by that condition.
//!
//! Whatever K and n, an impact at v ends with the speed e v of χ v − ln(1 + χ v) = −χ e v − ln(1 − χ e v) (Marhefka & Orin,
//! IEEE Trans. Syst. Man Cybern. 29 (1999) 566). Both formulas for χ hold for e near 1: at e = 0.5, they leave 0.66 and 0.73.

use symdiff::{Builder, Scalar};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model::{self, RestitutionLaw};

use super::positive_part::clipped;

/// The law's numbers.
#[derive(Clone, Copy, Debug)]
pub struct Impact<'g> {
    /// K, N/mⁿ
    pub stiffness: Scalar<'g>,
    exponent: f64,
    dissipation: Scalar<'g>,
}

impl<'g> Impact<'g> {
    pub fn of(g: &'g Builder, m: &Mechanism, impact: &model::Impact) -> Result<Self, BuildError> {
        let stiffness = m.value(g, &impact.stiffness)?;
        let dissipation = match (&impact.restitution, &impact.impact_velocity, &impact.dissipation) {
            (None, _, Some(dissipation)) => m.value(g, dissipation)?,
            (Some(restitution), Some(velocity), _) => {
                let (restitution, velocity) = (m.value(g, restitution)?, m.value(g, velocity)?);
                let (kept, factor) = match impact.law {
                    RestitutionLaw::HuntCrossley => (restitution, 1.5),
                    RestitutionLaw::LankaraniNikravesh => (restitution * restitution, 0.75),
                };
                factor * ((1.0 - kept) / velocity)
            }
            _ => g.number(0.0),
        };
        Ok(Self { stiffness, exponent: impact.exponent.0, dissipation })
    }

    /// f, by δ > 0 and δ̇.
    pub fn force(&self, depth: Scalar<'g>, rate: Scalar<'g>) -> Scalar<'g> {
        let damping = clipped(1.0 + self.dissipation * rate);
        self.stiffness * power(depth, self.exponent) * damping
    }

    /// V, by δ > 0.
    pub fn potential(&self, depth: Scalar<'g>) -> Scalar<'g> {
        let exponent = self.exponent + 1.0;
        1.0 / exponent * (self.stiffness * power(depth, exponent))
    }
}

/// Half powers are products with a root, which are evaluated for whole tiles at once.
fn power(depth: Scalar<'_>, exponent: f64) -> Scalar<'_> {
    let whole = exponent.floor();
    if exponent - whole == 0.5 {
        return depth.powi(whole as i32) * depth.sqrt();
    }
    depth.pow(depth.builder().number(exponent))
}
