//! Derives an element's reader, schema, documentation and references from its struct.
//!
//! ```text
//! /// A drive that controls a joint's coordinate.                     description
//! #[derive(Element)]
//! #[element(keyword = "servo", what = "a servo", equation = "…", source = "…", example = "{ … }", checked)]
//! pub struct Servo {
//!     #[group] on: OnJoint,                                          keys in the same mapping as the others
//!     /// What the coordinate should be.                             description of the key
//!     #[quantity(unit = "m or rad", time)] target: Formula,          required
//!     #[quantity(unit = "N*s/m or N*m*s/rad", default = 0)] derivative: Formula,
//!     #[quantity(unit = "N or N*m", positive, constant)] limit: Option<Formula>,
//! }
//! ```
//!
//! `equation` may be repeated; `short = "key"` lets a list replace the mapping with that key alone. A struct without
//! `keyword` is a mapping within an element if it has `what`, otherwise a group of keys. `checked` calls the struct's
//! `grammar::Checked`. A key may have `default = …`, `otherwise = "in words"` for an `Option`, `default_with("in
//! words", expression of earlier keys)`, `constant`, `time` or `command` for the dependencies of its formula,
//! `dimension = …` if its unit depends on earlier keys, `above = key` for an earlier key that must be smaller,
//! `positive`, `nonnegative`, `nonzero` or `requires = REQUIREMENT`. A `#[derived]` field is no key; it is its type's
//! default, and an `Option` of a type that has `formulas()`.

#![forbid(unsafe_code)]

mod attributes;
mod choice;
mod element;

use proc_macro::TokenStream;
use syn::{DeriveInput, parse_macro_input};

/// Derives `grammar::Group`, and `grammar::Element` or `grammar::Value`.
#[proc_macro_derive(Element, attributes(element, quantity, key, group, derived))]
pub fn element(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    element::derive(&input).unwrap_or_else(|error| error.to_compile_error()).into()
}

/// Derives `grammar::Value` for an enum of words: the variants in snake case, each with its documentation.
#[proc_macro_derive(Choice)]
pub fn choice(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    choice::derive(&input).unwrap_or_else(|error| error.to_compile_error()).into()
}
