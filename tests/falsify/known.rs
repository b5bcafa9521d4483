//! What is known to be missed of the gate's draws.

/// Draws of the gate, and their seed.
pub const DRAWS: u64 = 300;
pub const SEED: u64 = 2007;

/// Bands that are missed, family by family. The numbers only ever get smaller.
const MISSED: &[(&str, usize)] = &[
    ("sum", 1),
    ("far", 1),
    ("forced", 2),
    ("resonance", 2),
    ("fast and slow", 2),
    ("kinks", 2),
    ("pulse", 1),
    ("bounce", 2),
    ("driven crank", 2),
    ("pendulum", 1),
    ("double pendulum", 1),
    ("spring pendulum", 1),
    ("slider crank", 1),
    ("four-bar", 1),
    ("top", 3),
];

pub fn missed(family: &str) -> usize {
    MISSED.iter().find(|(name, _)| *name == family).map_or(0, |(_, missed)| *missed)
}
