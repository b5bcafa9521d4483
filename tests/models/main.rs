//! The models of `models/`, and smaller mechanisms, held against what mbint did not compute: closed forms, invariants,
//! published problems, and the laws that bounds obey.
//!
//! One binary for all of them, so that the library is linked once. Every tolerance says where it comes from: rounding and
//! Newton's tolerance (1e-11 of a position), the scheme's order (2), or a measurement that is written beside it.

mod adams_joints;
mod assembly;
mod bounds_laws;
mod car_axis;
mod certify;
mod closed_forms;
mod common;
mod composition;
mod convergence;
mod effects_beam;
mod effects_clearance;
mod effects_contact;
mod belt;
mod effects_drives;
mod effects_friction;
mod far;
mod flexible_beam;
mod formulations;
mod honesty;
mod invariants;
mod linkages;
mod motors;
mod reproducibility;
mod restitution;
mod rotation;
mod run_all;
mod runge_kutta;
mod schemes;
mod singular;
mod slider_crank;
mod snapshots;
mod spatial_linkages;
mod step_control;
mod tables;
mod tolerance;
mod urdf;
