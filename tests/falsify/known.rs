//! What is known to be missed of the gate's draws.

/// Draws of the gate, and their seed.
pub const DRAWS: u64 = 300;
pub const SEED: u64 = 2007;

/// Bands that are missed, family by family. The numbers only ever get smaller.
const MISSED: &[(&str, usize)] = &[
    ("sum", 1),
    ("far", 2),
    ("forced", 2),
    ("resonance", 2),
    ("kinks", 2),
    ("driven crank", 1),
    ("pendulum", 1),
    ("double pendulum", 1),
    ("slider crank", 1),
];

pub fn missed(family: &str) -> usize {
    MISSED.iter().find(|(name, _)| *name == family).map_or(0, |(_, missed)| *missed)
}
