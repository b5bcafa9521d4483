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

use symdiff::{Builder, Formula, Scalar};

use crate::assemble::error::BuildError;
use crate::assemble::mechanism::Mechanism;
use crate::model;

/// The law's numbers.
#[derive(Clone, Copy, Debug)]
pub struct DryFriction<'g> {
    /// μ
    pub coefficient: Scalar<'g>,
    breakaway: Scalar<'g>,
    stribeck: Option<Scalar<'g>>,
    transition: Scalar<'g>,
}

impl<'g> DryFriction<'g> {
    pub fn of(
        g: &'g Builder,
        m: &Mechanism,
        coefficient: &Formula,
        law: &model::DryFriction,
    ) -> Result<Self, BuildError> {
        let stribeck = law.stribeck_velocity.as_ref().map(|speed| m.value(g, speed)).transpose()?;
        Ok(Self {
            coefficient: m.value(g, coefficient)?,
            breakaway: m.value(g, &law.breakaway)?,
            stribeck,
            transition: m.value(g, &law.transition_velocity)?,
        })
    }

    /// s/√(|u|² + u₀²): dry friction by its bound and the velocity of sliding; `square` is |u|².
    pub fn resistance(&self, square: Scalar<'g>) -> Scalar<'g> {
        let smooth = (square + self.transition * self.transition).sqrt();
        let strength = match self.stribeck {
            Some(speed) => {
                let fading = (-(square / (speed * speed))).exp();
                1.0 + (self.breakaway - 1.0) * fading
            }
            None => square.builder().number(1.0),
        };
        strength / smooth
    }
}
