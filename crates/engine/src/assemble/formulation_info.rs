//! By which coordinates equations are written down.

/// By which coordinates a motion is described.
#[derive(Clone, Debug, PartialEq)]
pub struct FormulationInfo {
    /// Whether by those of joints, as far as that goes.
    pub joint: bool,
    /// For people.
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
