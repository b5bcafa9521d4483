//! URDF: XML with locations (`check`), values by urdf-rs (`read`) → [`Robot`](robot::Robot), whose links and joints are
//! one tree (`tree`).

mod check;
mod format;
pub mod read;
pub mod robot;
#[cfg(test)]
mod tests;
mod tree;
mod visual;

use std::path::Path;

/// Whether a name is that of a number of a URDF.
pub fn is_number(name: &str) -> bool {
    name.starts_with("link.") || name.starts_with("joint.")
}

/// Whether a path is that of a URDF and not of a model.
pub fn is_urdf(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("urdf"))
}
