//! Contents of a model file: reading, checking, and the typed [`Description`].
//!
//! `load` goes text → tree (`yaml`) → sections (one file each) → [`Description`]. Reading goes on after an error:
//! `Diagnostics` collects them all, each with its location.

mod definitions;
mod description;
mod design;
mod names;
mod references;

mod analysis;
mod beams;
mod black_box;
mod bodies;
mod bounds;
mod display;
mod effects;
mod excitations;
mod fmu;
mod instances;
mod joints;
mod load;
mod motion_times;
mod named_outputs;
mod open;
mod overlay;
mod parameters;
mod random;
mod reading;
mod reduced;
mod requests;
mod requirements;
mod results_by_name;
mod scheme;
mod sections;
mod space;
mod stack;
mod states;
mod statistics;
mod tables;
mod teeth;
#[cfg(test)]
mod tests;

mod trajectories;
mod tuning;
mod urdf;
mod witness;
mod zone_sizes;

pub use crate::elements::effects::*;
pub use crate::elements::{Class, Excitation, JointKind, Trajectory};
pub use crate::expand::overrides::Override;
pub use crate::grammar::{Coordinate, JointCoordinate, PointRef, Reference, Rotation, Symbol, TimeOrder};
pub use crate::keys::{SCHEMA_VERSION, schema};
pub use description::*;
pub use load::{Changes, is_robot, is_standard_input, load, load_str, read, read_rooted, read_str, read_text, shown};
pub use open::{Opened, read_open};
pub use overlay::read_overlay;
pub use parameters::{deviation_of, seed_of};
pub use reading::{Reading, Scene, UnknownScene};
pub use scheme::{NOT_OF_EXPLICIT, refused_alpha, refused_levels};
pub use tuning::tuning;
pub use witness::{Witness, WitnessError};
