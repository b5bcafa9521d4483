//! How the numbers of a URDF are named.

use crate::model::robots::numbers::Format;

pub const FORMAT: Format = Format {
    name: "URDF",
    forms: "e.g. `link.NAME.mass`, `.com.x`, `.inertia.xx`, `joint.NAME.damping`, `.friction`, `.origin.z`, `.origin.yaw`",
    is_number,
};

/// Whether a name is that of a number of a URDF.
pub fn is_number(name: &str) -> bool {
    name.starts_with("link.") || name.starts_with("joint.")
}
