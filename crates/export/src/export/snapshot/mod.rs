//! Snapshots: bounds of a run as a small text that is stored next to the model, read back and compared with those of a
//! later run.

mod compare;
mod read;
mod table;

pub use compare::{Moved, moved};
pub use read::Snapshot;
pub use table::{snapshot_file, snapshot_table, write_snapshot};
