//! MJCF: XML with its included files (`document`), every name checked against the table of the format (`table`,
//! `elements`) → [`Robot`](robot::Robot) with defaults applied (`values`, `read`, `geoms`, `couplings`).

mod actuators;
mod assets;
mod attach;
mod couplings;
pub mod document;
mod elements;
mod flags;
mod format;
mod geoms;
mod meshes;
pub mod read;
pub mod robot;
mod springs;
mod table;
#[cfg(test)]
mod tests;
pub mod values;

use std::path::Path;

/// Whether a name is that of a number of an MJCF.
pub fn is_number(name: &str) -> bool {
    let mut parts = name.split('.');
    matches!(parts.next(), Some("body" | "joint" | "tendon" | "actuator")) && parts.count() >= 2
}

/// Whether a path is that of an MJCF and not of a model.
pub fn is_mjcf(path: &Path) -> bool {
    path.extension().is_some_and(|extension| ["xml", "mjcf"].iter().any(|known| extension.eq_ignore_ascii_case(known)))
}
