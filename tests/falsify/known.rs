//! What is known to be missed of the gate's draws.

/// Draws of the gate, and their seed.
pub const DRAWS: u64 = 300;
pub const SEED: u64 = 2007;

/// Bands that are missed, family by family. The numbers only ever get smaller.
const MISSED: &[(&str, usize)] = &[
    ("sum", 1),
    ("far", 2),
    ("forced", 18),
    ("resonance", 5),
    ("fast and slow", 22),
    ("kinks", 3),
    ("pulse", 3),
    ("bounce", 4),
    ("driven crank", 4),
    ("pendulum", 1),
    ("double pendulum", 1),
    ("spring pendulum", 3),
    ("slider crank", 1),
    ("four-bar", 1),
    ("top", 17),
];

pub fn missed(family: &str) -> usize {
    MISSED.iter().find(|(name, _)| *name == family).map_or(0, |(_, missed)| *missed)
}
