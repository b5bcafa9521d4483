//! Nominal values that are free, and their objective.

use super::Requirement;

/// A question of which nominal values are best.
#[derive(Clone, Debug)]
pub struct Design {
    /// Parameters whose nominal values are free; at least one.
    pub free: Vec<Free>,
    /// Objective.
    pub objective: Objective,
}

/// A parameter whose nominal value is free.
#[derive(Clone, Debug, PartialEq)]
pub struct Free {
    /// Name of the parameter, which is a number or an interval.
    pub name: String,
    /// Smallest nominal value, SI.
    pub lower: f64,
    /// Largest nominal value, SI; above `lower`.
    pub upper: f64,
    /// Whether the deviations upwards and downwards are shares of the nominal value.
    pub relative: [bool; 2],
}

/// Objective of the best nominal values; in any case all requirements have to hold.
#[derive(Clone, Debug)]
pub enum Objective {
    /// The least margin of all requirements, each as a share of its limit.
    Margin,
    /// Sum of the costs of the tolerances, which are allocated with the nominal values.
    Cost,
    /// The worst value of an output.
    Worst {
        /// Whether the largest value is to be small; else the smallest one is to be large.
        is_largest: bool,
        /// The distance of the output from zero, as a requirement that the model does not make.
        distance: Box<Requirement>,
    },
}
