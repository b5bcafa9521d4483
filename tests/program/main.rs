//! The program as users meet it: its command line, files and messages, the contents of the documents, and the order of
//! the source.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

mod allocate;
mod analyses;
mod bad_models;
mod black_box;
mod book;
mod certificate;
mod check_and_run;
mod cli;
mod codes;
mod cost;
mod declared_units;
mod dependencies;
mod design;
mod docs_effects;
mod everyday;
mod export;
mod faults;
mod fit;
mod fmu;
mod lsp;
#[path = "../common/measured.rs"]
#[allow(dead_code, reason = "shared with the tests of models")]
mod measured;
mod measurements;
mod old_models;
mod parts;
mod parts_mirrored;
mod parts_nested;
mod parts_nested_in_space;
mod parts_nested_in_the_plane;
mod parts_placed;
mod place;
mod readme;
mod report;
mod requirements;
mod rooms;
mod root;
mod run_modes;
mod sample;
mod scenes;
mod scenes_run;
mod schema;
mod shapes;
mod shards;
mod shells;
mod show;
mod snapshot;
mod stacks;
mod statistics;
mod structure;
mod studio;
mod submit;
mod tables;
mod tolerance_forms;
mod verify;
