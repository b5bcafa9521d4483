//! Free nominal values, and their objective.

use schemars::JsonSchema;

use super::*;
use crate::grammar::mapping::schema_only;

schema_only! {
    /// The smallest and the largest nominal value.
    #[schemars(untagged, inline)]
    pub enum DesignRange {
        Ends([Number; 2]),
        /// `0.2 to 0.3 m`, or `[0.2, 0.3] m`
        Text(String),
    }

    #[schemars(rename_all = "lowercase", inline)]
    pub enum ObjectiveName {
        /// The largest margin of all requirements, each as a share of its limit.
        Margin,
        /// The cheapest tolerances that meet all requirements, allocated with the nominal values.
        Cost,
    }

    /// Objective of a design.
    #[schemars(untagged, inline)]
    pub enum ObjectiveFile {
        Name(ObjectiveName),
        Full(Box<ObjectiveKinds>),
    }
}

grammar! {
    /// An output whose worst case is to be as good as can be.
    ObjectiveKinds is "an `objective`" {
        /// The output or reduced output, or a formula of such, whose largest value is to be small.
        least: Option<Number>,
        /// The output or reduced output, or a formula of such, whose smallest value is to be large.
        most: Option<Number>,
    }
}
