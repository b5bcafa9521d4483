//! Dry friction at a speed of sliding: Coulomb's law with Stribeck's excess at rest, without its jump.
//!
//! ```text
//! F = −R u,   R = μ N s(|u|) / √(|u|² + u₀²),   s = 1 + (b − 1) exp(−(|u|/u_s)²)          N
//! ```
//!
//! u is the velocity of sliding, a number or a vector, N the load, b the breakaway ratio. The sign u/|u| of Coulomb's law is
//! u/√(|u|² + u₀²) (Oden & Martins, Comput. Methods Appl. Mech. Eng. 52 (1985) 527), which is smooth and falls short of it by
//! ½(u₀/u)²; s is that of Armstrong-Hélouvry, *Control of Machines with Friction* (1991). What sticks creeps: under a part κ
//! of the friction that it could bear at u₀ κ/√(1 − κ²).

use symdiff::{Builder, Expr, Formula, Unary};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::{Context, Mechanism};
use crate::model;

/// The law's numbers.
#[derive(Clone, Copy, Debug)]
pub struct DryFriction {
    /// μ
    pub coefficient: Expr,
    breakaway: Expr,
    stribeck: Option<Expr>,
    transition: Expr,
}

impl DryFriction {
    pub fn of(g: &Builder, m: &Mechanism, coefficient: &Formula, law: &model::DryFriction) -> Result<Self, BuildError> {
        let stribeck = law.stribeck_velocity.as_ref().map(|speed| m.formula(g, speed, Context::Motion)).transpose()?;
        Ok(Self {
            coefficient: m.formula(g, coefficient, Context::Motion)?,
            breakaway: m.formula(g, &law.breakaway, Context::Motion)?,
            stribeck,
            transition: m.formula(g, &law.transition_velocity, Context::Motion)?,
        })
    }

    /// s/√(|u|² + u₀²): what a unit of dry friction takes for a unit of velocity.
    pub fn resistance(&self, g: &Builder, velocity: &[Expr]) -> Expr {
        let square = g.dot(velocity, velocity);
        let rest = g.mul(self.transition, self.transition);
        let smooth = g.add(square, rest);
        let smooth = g.sqrt(smooth);
        let one = g.constant(1.0);
        let excess = match self.stribeck {
            Some(speed) => {
                let scale = g.mul(speed, speed);
                let ratio = g.div(square, scale);
                let ratio = g.neg(ratio);
                let fading = g.unary(Unary::Exp, ratio);
                let excess = g.sub(self.breakaway, one);
                g.mul(excess, fading)
            }
            None => g.constant(0.0),
        };
        let strength = g.add(one, excess);
        g.div(strength, smooth)
    }
}
