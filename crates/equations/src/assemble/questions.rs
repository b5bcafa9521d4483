//! Questions to the equations of a description, which stays as it is.

use std::borrow::Cow;

use crate::model::{Description, Formulation, ModesRequest, Output};

/// A description with the questions that its equations are built for.
#[derive(Clone, Debug)]
pub struct Questions<'d> {
    /// The mechanism.
    pub description: &'d Description,
    /// Outputs over time.
    pub outputs: Cow<'d, [Output]>,
    /// Modes and frequency responses.
    pub modes: Cow<'d, ModesRequest>,
    /// Coordinates in which the equations are written down.
    pub formulation: Formulation,
    /// Whether each joint's bodies move as one, without a reaction between them; joints beyond the list's end are not
    /// merged. A result of `reduce`.
    pub merged: Cow<'d, [bool]>,
    /// Joints that close loops in joint coordinates, though a body could move with them, and no others that could be
    /// inboard joints. Without any, the cut is open.
    pub cut: Vec<usize>,
    /// Whether excitations are functions of the time, which inputs give, and not constants.
    pub as_functions: bool,
    /// Whether the powers of all effects are asked for.
    pub powers: bool,
}

impl<'d> Questions<'d> {
    /// Questions of the description itself, with nothing merged and an open cut.
    pub fn of(description: &'d Description) -> Self {
        Self {
            description,
            outputs: Cow::Borrowed(&description.outputs),
            modes: Cow::Borrowed(&description.modes),
            formulation: description.simulation.formulation,
            merged: Cow::Borrowed(&[]),
            cut: Vec::new(),
            as_functions: false,
            powers: false,
        }
    }

    /// The same with another cut of the loops.
    #[must_use]
    pub fn cut_at(&self, cut: Vec<usize>) -> Self {
        Self { cut, ..self.clone() }
    }

    /// Whether a joint's bodies move as one.
    pub fn is_merged(&self, joint: usize) -> bool {
        self.merged.get(joint).is_some_and(|merged| *merged)
    }

    /// Whether the cut of loops is left open.
    pub fn is_cut_open(&self) -> bool {
        self.cut.is_empty()
    }
}
