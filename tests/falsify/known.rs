//! Known misses of the gate's draws.

/// Draws of the gate, and their seed.
pub const DRAWS: u64 = 300;
pub const SEED: u64 = 2007;

/// Bands that are missed, family by family. The numbers only ever get smaller, unless a new family changes the draws.
const MISSED: &[(&str, usize)] = &[("rotor", 1)];

pub fn missed(family: &str) -> usize {
    MISSED.iter().find(|(name, _)| *name == family).map_or(0, |(_, missed)| *missed)
}

/// Bands that contradict their own runs.
pub const CONTRADICTED: usize = 0;

/// Draws of shares that fail and of allocations, and how many are known to be missed.
pub const SHARES: (u64, usize) = (12, 0);
pub const ALLOCATIONS: (u64, usize) = (24, 0);

/// Rows of many parameters that are missed without a flag.
pub const WIDE: usize = 0;

/// Rows under excitations that are missed without a flag: three of one draw, whose periods are not whole rows, so that
/// the steps' errors of rows between the measured ones are larger.
pub const EXCITED: usize = 3;
