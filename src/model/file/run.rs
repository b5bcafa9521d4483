//! How long, in which steps, and which bounds.

use schemars::JsonSchema;

use super::*;

grammar! {
    /// How time is stepped.
    Simulation is "`simulation`" {
        /// s
        duration: Number,
        /// Length of every step, s; by default 1e-3.
        step: Option<Number>,
        /// Instead of `step`: what the steps' position errors may add up to over the run, relative to |q| or, where that is larger, to the model's size.
        tolerance: Option<Number>,
        /// HHT parameter from -1/3 to below 0; by default -0.1.
        alpha: Option<Number>,
        /// s between rows of output; by default about a 200th of the duration.
        output_step: Option<Number>,
        /// By which coordinates the motion is described; by default `auto`, whichever take fewer instructions.
        formulation: Option<FormulationName>,
    }

    /// Which bounds to compute; a method that is not named is not run.
    Bounds is "`bounds`" {
        /// Error allowed of every bound, relative to how far its output ranges over the run. Chebyshev's degree (where it has no
        /// `order`) and the steps are then chosen to meet it; what misses it is flagged.
        tolerance: Option<Number>,
        /// What may be spent on the tolerance.
        budget: Option<Budget>,
        /// A Chebyshev polynomial in the parameters.
        chebyshev: Option<Chebyshev>,
        /// A Taylor polynomial in the parameters.
        taylor: Option<Taylor>,
        /// Many samples; inner bounds.
        scan: Option<Scan>,
    }

    /// Where the search for bounds within the tolerance ends at the latest; what it has come to is kept.
    Budget is "`budget`" {
        /// Simulations; by default 3000.
        solves: Option<u32>,
        /// Seconds; by default as long as it takes. Results then depend on the machine.
        seconds: Option<Number>,
    }

    /// Chebyshev bounds.
    Chebyshev is "`chebyshev`" {
        /// Degree, for all parameters or by parameter; by default 5, or as the tolerance asks for where there is one, or more
        /// than three parameters.
        order: Option<PerParameter>,
        /// Nodes, more than the degree; by default one more.
        nodes: Option<PerParameter>,
        /// What is expanded; by default the coordinates, or the output where a `range` is asked for.
        expand: Option<Expand>,
        /// How the range of an output's polynomial is found; by default tight. Coordinates need none.
        range: Option<Range>,
    }

    /// Taylor bounds.
    Taylor is "`taylor`" {
        /// Total degree; by default 2.
        order: Option<u32>,
        /// By default tight.
        range: Option<Range>,
    }

    /// Scanning bounds.
    Scan is "`scan`" {
        /// Points, for all parameters or by parameter, both ends included; by default 30.
        points: Option<PerParameter>,
    }
}
