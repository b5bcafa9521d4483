//! Names and formulas of a model with their locations, for editors.
//!
//! Readers note what they read where an editor asks for it; a run notes nothing.

use std::cell::RefCell;

use symdiff::formula::Term;
use symdiff::{Formula, Unary};

use super::dimension::Kind;
use super::reader::Reader;
use super::report::Report;
use super::symbols::SymbolTable;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node, Scalar};

/// What a name is of.
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
    /// What it is of.
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
    /// What it is of, where only one kind can stand there.
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
    pub kinds: Vec<Kind>,
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

impl Report<'_> {
    fn note(&self, note: impl FnOnce(&mut Mentions)) {
        if let Some(mentions) = self.mentions {
            note(&mut mentions.borrow_mut());
        }
    }

    /// Notes that an entry gives a name its meaning.
    pub fn defines(&self, kind: NameKind, name: &str, entry: &Entry) {
        self.note(|all| {
            let extent = entry.key_span.start..entry.value.span.end.max(entry.key_span.end);
            let definition = Definition { kind, name: name.to_owned(), span: entry.key_span.clone(), extent };
            all.definitions.push(definition);
        });
    }

    /// Notes the use of a name.
    pub fn mentions(&self, kind: Option<NameKind>, name: &str, span: &Span) {
        self.note(|all| all.uses.push(Mention { name: name.to_owned(), kind, span: span.clone() }));
    }

    /// Notes the use of the name that a node is.
    pub fn mentions_node(&self, kind: Option<NameKind>, node: &Node) {
        if let Some(scalar) = node.scalar() {
            let text = 0..scalar.text.len();
            self.note(|all| {
                let span = scalar.place(&node.span, text);
                all.uses.push(Mention { name: scalar.name().into_owned(), kind, span });
            });
        }
    }

    /// Notes the names of a formula that begins at a byte of a scalar.
    pub fn mentions_names(&self, node: &Node, scalar: &Scalar, formula: &Formula, offset: usize) {
        self.note(|all| {
            all.uses.extend(formula.names().map(|(name, span)| {
                let span = scalar.place(&node.span, offset + span.start..offset + span.end);
                Mention { name: name.to_owned(), kind: None, span }
            }));
        });
    }

    /// Notes a formula that begins at a byte of a node, with the dimensions of its terms.
    pub fn mentions_formula(&self, node: &Node, offset: usize, formula: &Formula, kinds: &[Kind]) {
        self.note(|all| {
            let start = node.scalar().and_then(|scalar| scalar.start).map(|start| start + offset);
            let (formula, kinds) = (formula.clone(), kinds.to_vec());
            all.formulas.push(ReadFormula { start, span: node.span.clone(), formula, kinds });
        });
    }
}

impl<S: SymbolTable> Reader<'_, S> {
    /// Notes the tables of a formula that begins at a byte of a scalar: a call begins with the name of its table.
    pub(super) fn mentions_tables(&self, node: &Node, scalar: &Scalar, formula: &Formula, offset: usize) {
        for (term, span) in formula.terms() {
            let Term::Unary(Unary::Spline(spline, _), _) = term else { continue };
            let Some(table) = self.tables.iter().find(|table| table.spline == *spline) else { continue };
            let start = offset + span.start;
            if scalar.text.get(start..).is_some_and(|text| text.starts_with(&table.name)) {
                let span = scalar.place(&node.span, start..start + table.name.len());
                self.mentions(Some(NameKind::Table), &table.name, &span);
            }
        }
    }
}

/// Where readers note what they read.
pub type Notes = RefCell<Mentions>;
