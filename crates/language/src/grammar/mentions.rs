//! Names and formulas of a model with their locations, for editors.
//!
//! Readers record them for an editor; a run records nothing.

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

/// Definition of a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Definition {
    /// Kind of the named thing.
    pub kind: NameKind,
    /// The full name: `front_left.upright`; for a point, with that of its body.
    pub name: String,
    /// The key.
    pub span: Span,
    /// The key with its value.
    pub extent: Span,
}

/// Use of a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mention {
    /// The full name, perhaps with parts of the motion behind it: `crank.B.vx`.
    pub name: String,
    /// Kind of the named thing, if only one kind is allowed there.
    pub kind: Option<NameKind>,
    /// Its bytes; the text may be only the end of the full name.
    pub span: Span,
}

/// A formula that was read.
#[derive(Clone, Debug)]
pub struct ReadFormula {
    /// Offset from which locations in the formula count; `None` if the text is not in the source word for word.
    pub start: Option<usize>,
    /// Bytes of its node.
    pub span: Span,
    /// The formula, with full names.
    pub formula: Formula,
    /// The dimension of each term.
    pub kinds: Vec<KnownDimension>,
}

/// All names and formulas that were read, in the order of reading; repeated for scenes.
#[derive(Clone, Debug, Default)]
pub struct Mentions {
    /// Definitions.
    pub definitions: Vec<Definition>,
    /// Uses.
    pub uses: Vec<Mention>,
    /// Formulas.
    pub formulas: Vec<ReadFormula>,
}

/// Records of readers.
pub type Notes = RefCell<Mentions>;
