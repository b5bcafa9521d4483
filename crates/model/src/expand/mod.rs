//! Tree → tree: robots of MJCF, parts (`include`, `assemblies`, `repeat`, …), dimensions, zones and scenes
//! are written out, so that the model's reader sees nothing but bodies, joints, effects and questions.
//!
//! Every node keeps its location in the file that it comes from. No names are resolved here (decision 0156).

pub mod asked_outputs;
pub mod dimensions;
pub mod fmu;
pub mod instance;
pub mod mjcf;
pub mod notation;
pub mod numbers;
pub mod overrides;
pub mod parts;
pub mod scenes;
mod sections;
pub mod tuning;
pub mod zones;
