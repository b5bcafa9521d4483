//! Laws of mechanics, tested on mechanisms that no one has drawn: chains, trees and loops of random bodies, springs and
//! torques, in the plane and in space.
//!
//! `PROPTEST_CASES=1000 cargo test --test models random` tries more of them.

mod laws;
mod mechanism;
mod quaternion;
mod scene;
