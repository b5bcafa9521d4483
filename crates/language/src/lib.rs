//! Parts of a model file, before they are a model: text and trees with spans (`syntax`), keys with types and units from
//! which both the reader and the schema follow (`grammar`), and symbols of bodies, points and frames (`multibody`).

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions"))]

pub mod grammar;
pub mod multibody;
pub mod syntax;
