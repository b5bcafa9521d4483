//! Cases on which solvers of multibody dynamics fail or lose accuracy: `docs/guides/hard-cases.md` tells what is hard about each,
//! and shows the numbers that these tests print.
//!
//! What takes more than a few seconds is ignored, with what it takes, and has a smaller version beside it.

mod benchmarks;
#[path = "../models/common.rs"]
#[allow(dead_code, reason = "shared with the tests of models")]
mod common;
mod dormand_prince;
mod effects;
mod events;
mod positions;
#[path = "../models/restitution.rs"]
mod restitution;
#[path = "../models/runge_kutta.rs"]
mod runge_kutta;
mod sweeps;
