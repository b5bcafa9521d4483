//! How joints rub.

/// Which friction a joint with teeth has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshKind {
    /// A share of the power that is transmitted.
    Rolling,
    /// A share of the force between the flanks.
    Sliding,
}

/// Which motions of a joint friction resists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionMode {
    /// Its rotation: revolute joints.
    Rotating,
    /// Its sliding: prismatic joints.
    Sliding,
    /// Both at once: cylindrical joints.
    Both,
}
