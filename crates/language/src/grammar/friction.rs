//! Friction in joints.

/// Kind of friction of a joint with teeth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshKind {
    /// A share of the power that is transmitted.
    Rolling,
    /// A share of the force between the flanks.
    Sliding,
}

/// Motions of a joint that friction resists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionMode {
    /// Its rotation: revolute joints.
    Rotating,
    /// Its sliding: prismatic joints.
    Sliding,
    /// Both at once: cylindrical joints.
    Both,
}
