//! Dimensions between faces, of which chains are made.

use schemars::JsonSchema;

use super::*;

grammar! {
    /// A dimension from one face to another. With a value it is a parameter, with a formula an output; without both it
    /// closes a chain: an output, the sum of the dimensions that lead from its first face to its second.
    DimensionFile is "a dimension" {
        /// The face, edge or axis where it begins: any name.
        from: String,
        /// The face, edge or axis where it ends.
        to: String,
        /// Instead of a value: a formula, e.g. of a position in a mechanism.
        formula: Option<Number>,
        /// Its nominal value, perhaps with its deviation: `30 mm ± 0.1 mm`.
        value: Option<Number>,
        /// Unit of the bare numbers given here; of a formula or a closing dimension, the unit that shows it.
        unit: Option<UnitName>,
        /// Largest deviation either way: `1%` of the value, or a quantity; or `+0.01 -0.02`.
        tolerance: Option<Number>,
        /// Smallest and largest value; without `value`, the nominal is the middle.
        interval: Option<IntervalFile>,
        /// Largest deviation upwards.
        plus: Option<Number>,
        /// Largest deviation downwards.
        minus: Option<Number>,
        /// How it is distributed; by default uniformly over its interval.
        distribution: Option<LawFile>,
        /// Cost of its tolerance, for `mbint allocate`.
        cost: Option<CostFile>,
        /// Description for people.
        description: Option<String>,
    }
}
