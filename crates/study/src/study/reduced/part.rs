//! Bounds of a part of a requirement's margin.

/// Bounds of a part of a margin. The margin compared with its error decides, however little or much it moves.
pub struct MarginPart {
    pub lower: f64,
    pub error: f64,
    pub surrogate: f64,
    pub time: f64,
    /// Whether the error is to be believed.
    pub is_known: bool,
    pub method: &'static str,
}

impl MarginPart {
    /// Least margin within the error.
    pub fn reached(&self) -> f64 {
        self.lower - self.error
    }
}
