//! A program that uses mbint as others do: the examples of the guide are compiled and run here, and `tests/` asks from
//! Rust what the command line can ask. Nothing of `mbint::inner` is used.

#![doc = include_str!("../../../docs/guides/rust.md")]
