//! Cases on which solvers of multibody dynamics fail or lose accuracy: `docs/guides/hard-cases.md` tells what is hard
//! about each, and shows the numbers that these tests print.
//!
//! What takes more than a few seconds is ignored, with what it takes, and has a smaller version beside it.

mod benchmarks;
mod effects;
mod events;
mod positions;
mod sweeps;
