//! The models of `models/`, and smaller mechanisms, compared with results that mbint did not compute: closed forms,
//! invariants, published problems, hard cases, and the laws that mechanics and bounds obey. Tests of a single element
//! are in `tests/elements`.
//!
//! One binary for all of them, so that the library is linked once. Every tolerance says where it comes from: rounding
//! and Newton's tolerance (1e-11 of a position), the scheme's order (2), or a measurement that is written next to it.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

#[path = "../common/mod.rs"]
#[allow(dead_code, reason = "shared with the tests of elements")]
mod common;

mod accelerations;
mod assembly;
mod attained;
mod bounds_laws;
mod car_axis;
mod certify;
mod certify_functions;
mod certify_motion;
mod closed_forms;
mod composition;
mod controllers;
mod convergence;
mod deep_trees;
mod design;
mod design_cost;
mod drawing_linkages;
mod excitation_classes;
mod excitations;
mod excited_half_car;
mod explicit;
mod extrapolation;
mod far;
mod fast_functions;
mod features;
mod first_correction;
mod fit;
mod formulas;
mod formulations;
mod gradients;
mod gradients_through_events;
mod grazing;
mod half_car;
mod hard_cases;
mod honesty;
mod honesty_adaptive;
mod honesty_jumps;
mod honesty_search;
mod humanoid;
mod indexing;
mod instants_in_a_part;
mod invariants;
mod joints_of_several_axes;
mod jumps_at_events;
mod jumps_in_time;
mod kept;
mod kinds_of_events;
mod kinematics;
mod linkages;
mod loop_analyses;
mod loop_cuts;
mod loops;
mod machines;
mod massless;
mod metamorphic;
mod mjcf;
mod modes;
mod modes_of_controlled_mechanisms;
mod modes_with_states;
mod moving_machines;
mod peers;
mod pruning;
mod pulses_between_events;
mod questions_apart;
mod questions_through_events;
mod random;
mod random_excitations;
mod reduced;
mod reduced_gradients;
mod reduced_of_many;
mod reductions;
mod reproducibility;
mod requirements;
mod robot_inertia;
mod robot_wrenches;
mod rotation;
mod rotations_at_the_start;
mod rows_between_events;
mod run_all;
mod scheme_between_events;
mod schemes;
mod several_parameters;
mod singular;
mod slider_crank;
mod snapshots;
mod snapshots_questions;
mod spatial_linkages;
mod stacks;
mod starts;
mod states_at_rest;
mod statics;
mod statistics;
mod step_control;
mod subsystems;
mod switches;
mod tables;
mod through_events;
mod throws_to_a_ceiling;
mod time_steps;
mod tolerance;
mod total_degree;
mod urdf;
mod urdf_joints;
mod validation;
mod vehicles;
mod verify;
mod wiper;
mod zones;
