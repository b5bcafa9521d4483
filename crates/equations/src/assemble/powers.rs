//! Energies of a mechanism and powers of its effects, as a system has them.

use symdiff::Expr;

/// Power and stored energy of an effect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EffectPower {
    /// Name in the model; `teeth` for the forces between teeth of joints.
    pub name: String,
    /// E.g. `spring_damper`.
    pub kind: &'static str,
    /// Pₑ, W.
    pub power: Expr,
    /// Its potential energy, J.
    pub stored: Expr,
}

/// The energies and powers of a mechanism.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PowerBalance {
    /// T, J.
    pub kinetic: Expr,
    /// Powers by effect, in file order.
    pub effects: Vec<EffectPower>,
}
