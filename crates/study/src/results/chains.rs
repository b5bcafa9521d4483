//! Chains of dimensions, for drawings.

use serde::Serialize;

/// A chain of dimensions, and the output that closes it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChainSummary {
    /// The output: it leads from the first link's beginning to the last one's end.
    pub output: String,
    /// Its value with every parameter at its nominal value, SI, where it varies most over the time.
    pub nominal: f64,
    /// The dimensions on the way, one after another.
    pub links: Vec<LinkSummary>,
}

/// A dimension of a chain.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinkSummary {
    /// The parameter, or the output if the dimension is a formula.
    pub name: String,
    /// The face where the way enters.
    pub from: String,
    /// The face where the way leaves.
    pub to: String,
    /// Whether the way goes along the dimension's direction: its sign in the sum.
    pub is_forward: bool,
    /// With every parameter at its nominal value, SI.
    pub nominal: f64,
}
