//! A number of a robot's file, which may become a parameter of a model.

use crate::syntax::source::Span;

/// A number of the file.
#[derive(Clone, Debug)]
pub struct Number {
    /// Name as a parameter, e.g. `link.forearm.mass`.
    pub name: String,
    /// SI.
    pub value: f64,
    /// Empty where its owner decides.
    pub unit: &'static str,
    /// Where it stands, or where it would.
    pub span: Span,
    /// Text of mbint's own attribute for it, and its location.
    pub uncertain: Option<(String, Span)>,
}
