//! The file of a unit, and its `modelDescription.xml`.

mod archive;
mod description;
pub(crate) mod tuning;
mod variable;

pub use archive::{digest, unpack};
pub use description::{Interface, Unit, Version};
pub use variable::{BaseUnit, NumberType, Variable};

/// Reasons why a file cannot be read as a unit.
#[derive(Debug, thiserror::Error)]
pub enum NotRead {
    /// The file cannot be read.
    #[error("{0}")]
    File(#[from] std::io::Error),
    /// The file is not an archive, or a damaged one.
    #[error("it is not a zip archive: {0}")]
    Archive(#[from] rawzip::Error),
    /// An entry cannot be read.
    #[error("`{name}` in it cannot be read: {why}")]
    Entry {
        /// Path in the archive.
        name: String,
        /// The reason.
        why: String,
    },
    /// The archive has no description.
    #[error("it has no `modelDescription.xml`")]
    NoDescription,
    /// The description is not XML.
    #[error("`modelDescription.xml`: {0}")]
    Xml(#[from] roxmltree::Error),
    /// The description lacks something, or has something else instead.
    #[error("`modelDescription.xml`: {0}")]
    Description(String),
}
