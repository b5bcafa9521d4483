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
//! δ > 0 alone, and whoever uses it sees to it that it is asked for nowhere else.
//!
//! Whatever K and n, an impact at v ends with the speed e v of χ v − ln(1 + χ v) = −χ e v − ln(1 − χ e v) (Marhefka & Orin,
//! IEEE Trans. Syst. Man Cybern. 29 (1999) 566). Both formulas for χ hold for e near 1: at e = 0.5, they leave 0.66 and 0.73.

use symdiff::{Binary, Builder, Expr};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::model::{self, RestitutionLaw};

use super::positive_part::clipped;

/// The law's numbers.
#[derive(Clone, Copy, Debug)]
pub struct Impact {
    /// K, N/mⁿ
    pub stiffness: Expr,
    exponent: f64,
    dissipation: Expr,
}

impl Impact {
    pub fn of(g: &Builder, m: &Mechanism, impact: &model::Impact) -> Result<Self, BuildError> {
        let stiffness = m.formula(g, &impact.stiffness, Context::Motion)?;
        let dissipation = match (&impact.restitution, &impact.impact_velocity, &impact.dissipation) {
            (None, _, Some(dissipation)) => m.formula(g, dissipation, Context::Motion)?,
            (Some(restitution), Some(velocity), _) => {
                let restitution = m.formula(g, restitution, Context::Motion)?;
                let velocity = m.formula(g, velocity, Context::Motion)?;
                let one = g.constant(1.0);
                let (kept, factor) = match impact.law {
                    RestitutionLaw::HuntCrossley => (restitution, 1.5),
                    RestitutionLaw::LankaraniNikravesh => (g.mul(restitution, restitution), 0.75),
                };
                let lost = g.sub(one, kept);
                let ratio = g.div(lost, velocity);
                g.scale(factor, ratio)
            }
            _ => g.constant(0.0),
        };
        Ok(Self { stiffness, exponent: impact.exponent.0, dissipation })
    }

    /// f, by δ > 0 and δ̇.
    pub fn force(&self, g: &Builder, depth: Expr, rate: Expr) -> Expr {
        let one = g.constant(1.0);
        let damping = g.mul(self.dissipation, rate);
        let damping = g.add(one, damping);
        let damping = clipped(g, damping);
        let power = self.power(g, depth, self.exponent);
        let elastic = g.mul(self.stiffness, power);
        g.mul(elastic, damping)
    }

    /// V, by δ > 0.
    pub fn potential(&self, g: &Builder, depth: Expr) -> Expr {
        let power = self.power(g, depth, self.exponent + 1.0);
        let product = g.mul(self.stiffness, power);
        g.scale(1.0 / (self.exponent + 1.0), product)
    }

    /// δ to a power. Half powers are products with a root, which whole tiles take at once.
    fn power(&self, g: &Builder, depth: Expr, exponent: f64) -> Expr {
        let whole = exponent.floor();
        if exponent - whole == 0.5 {
            let (power, root) = (g.powi(depth, whole as i32), g.sqrt(depth));
            return g.mul(power, root);
        }
        let exponent = g.constant(exponent);
        g.binary(Binary::Pow, depth, exponent)
    }
}
