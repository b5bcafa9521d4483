//! Names and formulas of a model with their locations, for editors.
//!
//! Readers note them where an editor asks for it; a run notes nothing.

use std::cell::RefCell;

use symdiff::Formula;

use super::dimension::KnownDimension;
use crate::syntax::source::Span;

/// Kind of a named thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum NameKind {
    /// A parameter.
    Parameter,
    /// A body.
    Body,
    /// A point of a body, called `body.point`.
    Point,
    /// A joint.
    Joint,
    /// An effect.
    Effect,
    /// A state.
    State,
    /// An output.
    Output,
    /// A requirement.
    Requirement,
    /// A table.
    Table,
    /// A trajectory.
    Trajectory,
    /// An excitation.
    Excitation,
    /// An assembly.
    Assembly,
    /// An instance of an assembly.
    Instance,
    /// A port of an instance.
    Port,
    /// A scene.
    Scene,
}

/// Where a name gets its meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Definition {
    /// Kind of the named thing.
    pub kind: NameKind,
    /// The full name: `front_left.upright`; of a point with its body's.
    pub name: String,
    /// The key.
    pub span: Span,
    /// The key with its value.
    pub extent: Span,
}

/// Where a name is used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mention {
    /// The full name, perhaps with parts of the motion behind it: `crank.B.vx`.
    pub name: String,
    /// Kind of the named thing, where only one kind can stand there.
    pub kind: Option<NameKind>,
    /// Its bytes; the text may be the end of the full name only.
    pub span: Span,
}

/// A formula that was read.
#[derive(Clone, Debug)]
pub struct ReadFormula {
    /// The offset that places in the formula count from; `None` where the text is not there word for word.
    pub start: Option<usize>,
    /// The node that it stands in.
    pub span: Span,
    /// The formula, with full names.
    pub formula: Formula,
    /// The dimension of each term.
    pub kinds: Vec<KnownDimension>,
}

/// All names and formulas that were read, in the order of reading; those of scenes again.
#[derive(Clone, Debug, Default)]
pub struct Mentions {
    /// Definitions.
    pub definitions: Vec<Definition>,
    /// Uses.
    pub uses: Vec<Mention>,
    /// Formulas.
    pub formulas: Vec<ReadFormula>,
}

/// Notes of readers.
pub type Notes = RefCell<Mentions>;
