//! A mechanism as an engineer counts it, before anything is simulated.

use serde::Serialize;

/// Mobility, size, mass and loads of a mechanism.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Structure {
    /// Its mobility.
    pub mobility: MobilityCount,
    /// Extent of all bodies and points along x, y and z at the start, m.
    pub size: [f64; 3],
    /// Mass of all bodies.
    pub mass: MassRange,
    /// The sum of all gravities, m/s²; `None` without gravity.
    pub gravity: Option<[f64; 3]>,
    /// Other effects that push or pull, by kind.
    pub acting: Vec<KindCount>,
    /// Effects that only resist, by kind.
    pub resisting: Vec<KindCount>,
    /// Whether it has speeds at the start.
    pub moves_at_start: bool,
}

/// The count of Grübler (in the plane) or Kutzbach (in space), and the mobility by the rank of the constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct MobilityCount {
    /// Whether bodies have six freedoms instead of three.
    pub spatial: bool,
    /// Bodies with the ground.
    pub bodies: usize,
    /// Joints that are no drives.
    pub joints: usize,
    /// Their constraints.
    pub constraints: usize,
    /// Freedoms that bodies lack because their coordinates are prescribed.
    pub held: usize,
    /// Motors and other motions that are prescribed.
    pub drives: usize,
    /// Freedoms of all bodies less `constraints` and `held`.
    pub count: i64,
    /// Number of degrees of freedom without drives, by the rank of the constraints.
    pub mobility: usize,
    /// Constraints that others imply: the difference between both.
    pub over_constrained: usize,
}

/// kg
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MassRange {
    /// At the nominal parameters.
    pub nominal: f64,
    /// At least, over the box of the uncertain parameters.
    pub lower: f64,
    /// At most.
    pub upper: f64,
}

/// Elements of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct KindCount {
    /// The word for it in a model file.
    pub kind: &'static str,
    /// Number of elements.
    pub count: usize,
}
