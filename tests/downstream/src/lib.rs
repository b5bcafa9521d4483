//! A program that uses mbint as others do: the examples of the guide are compiled and run here, and `tests/` asks the
//! questions of the command line from Rust. Nothing of `mbint::inner` is used.

#![doc = include_str!("../../../docs/guides/rust.md")]
