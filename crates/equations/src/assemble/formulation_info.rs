//! The coordinates in which equations are written down.

/// The coordinates that describe a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct FormulationInfo {
    /// Whether they are those of joints, as far as possible.
    pub joint: bool,
    /// The reason, for users.
    pub why: String,
    /// The joints that close loops of the trees, by number; none in absolute coordinates.
    pub cut: Vec<usize>,
    /// The assembled start in absolute coordinates from which loops are closed; `None` if it is not known.
    pub closed_from: Option<Vec<f64>>,
}

impl FormulationInfo {
    /// `absolute` or `joint`.
    pub fn name(&self) -> &'static str {
        if self.joint { "joint" } else { "absolute" }
    }
}
