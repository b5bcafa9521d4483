//! Cases on which solvers of multibody dynamics fail or lose accuracy: `docs/guides/hard-cases.md` explains the
//! difficulty of each, and shows the numbers that these tests print.
//!
//! Tests of more than a few seconds are ignored, with a note of their time, and have smaller versions next to them.

mod benchmarks;
mod events;
mod friction;
mod impacts;
mod positions;
mod sweeps;
