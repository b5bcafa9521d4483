//! How long, and in which steps.

use schemars::JsonSchema;

use super::*;

grammar! {
    /// How time is stepped.
    Simulation is "`simulation`" {
        /// Duration of the motion, s.
        duration: Number,
        /// Length of every step, s; by default 1e-3.
        step: Option<Number>,
        /// Instead of `step`: error that the steps may leave in every output, relative to how far it moves in the run;
        /// every sample keeps it, and steps end at events.
        tolerance: Option<Number>,
        /// HHT parameter from -1/3 to below 0; by default -0.1.
        alpha: Option<Number>,
        /// Time between rows of output, s; by default about a 200th of the duration. The last row is at the end,
        /// however near.
        output_step: Option<Number>,
        /// Coordinates that describe the motion; by default `auto`, whichever take fewer instructions. With `joint`,
        /// one joint of each loop is a constraint: the one with which a step is shortest.
        formulation: Option<FormulationName>,
        /// Scheme that integrates the motion; by default `auto`.
        scheme: Option<SchemeName>,
        /// Number of step lengths, each half the one before, to combine for an order one higher: 2, 3 or 4.
        extrapolation: Option<u32>,
    }
}
