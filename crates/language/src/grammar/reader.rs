//! The state of reading a model: its names and parameters so far, and the report of its errors.
//!
//! Methods that need no names are those of [`Report`].

use std::collections::HashSet;
use std::ops::{Deref, DerefMut};

use symdiff::Spline;

use super::declared::DeclaredStates;
use super::dimension::KnownDimension;
use super::own_names::LikeName;
use super::quantity::Dimension;
use super::report::Report;
use super::symbols::{Sensor, SymbolTable};
use crate::syntax::source::Span;
use crate::syntax::yaml::Entry;

/// Parts of a model read so far, with its names; `S` is the table of symbols.
pub struct Reader<'d, S> {
    /// Errors and warnings so far.
    pub report: Report<'d>,
    /// Symbols of the model: first their names, then their meanings.
    pub model: S,
    /// Effects that are not in the model, with their sensors: the last is being read, and its own formulas may refer to
    /// it; the others had errors.
    pub unread: Vec<(String, Vec<(Sensor, Dimension)>)>,
    /// Names of joints that had errors, so their kinds are not known.
    pub unread_joints: Vec<String>,
    /// Names of outputs that had errors.
    pub unread_outputs: Vec<String>,
    /// States that are known before they are read.
    pub declared: DeclaredStates,
    /// Own variable of the formula being read, and its dimension.
    pub variable: Option<(&'static str, Dimension)>,
    /// Dimension of each parameter.
    pub kinds: Vec<KnownDimension>,
    /// Parameter values at which requirements are checked.
    pub corners: Vec<Corner>,
    /// For each parameter the corners at which its value is not the nominal one, ascending.
    pub corners_of: Vec<Vec<usize>>,
    /// Whether each parameter's value is uncertain.
    pub varies: Vec<bool>,
    /// Parameters whose nominal values are to be chosen: other samples may have other values.
    pub free: HashSet<String>,
    /// Whether a parameter has no value because of an error that was reported.
    pub broken: bool,
    /// Whether each parameter is used, other parameters aside.
    pub used: Vec<bool>,
    /// Trajectories that are used.
    pub used_trajectories: HashSet<usize>,
    /// Whether each parameter is used by other parameters.
    pub used_by_parameters: Vec<bool>,
    /// Parameters that vary in omitted parts only.
    pub idle: HashSet<String>,
    /// Parameters whose interval has no width.
    pub certain: HashSet<String>,
    /// Words of units in the value read last that are also names of the model.
    pub like_names: Vec<LikeName>,
    /// Lengths, some of which may be in another unit.
    pub lengths: Lengths,
    /// Functions that the file gives by their values.
    pub tables: Vec<FunctionTable>,
}

/// Lengths of a model seen so far.
#[derive(Clone, Debug, Default)]
pub struct Lengths {
    /// Locations of large bare numbers, each with its help.
    pub(super) large: Vec<(Span, String)>,
    /// Parameters without units that were examined.
    pub(super) said: HashSet<String>,
    /// Whether there is a small length.
    pub(super) small: bool,
}

/// A function that is given by its values.
#[derive(Clone, Debug)]
pub struct FunctionTable {
    /// Name of the function.
    pub name: String,
    /// Interpolation of its values.
    pub spline: Spline,
    /// Dimensions of argument and value, if the file gives them.
    pub dimensions: [Option<Dimension>; 2],
}

/// Values of all parameters at once.
#[derive(Clone, Debug)]
pub struct Corner {
    /// One value per parameter.
    pub values: Vec<f64>,
    /// ` at l1 = 0.1`; empty for the nominal values.
    pub label: String,
}

impl<'d, S> Reader<'d, S> {
    /// A reader that has read nothing; `model` is an empty table of symbols.
    pub fn new(report: Report<'d>, model: S) -> Self {
        Self {
            report,
            model,
            unread: Vec::new(),
            unread_joints: Vec::new(),
            unread_outputs: Vec::new(),
            declared: DeclaredStates::default(),
            variable: None,
            kinds: Vec::new(),
            corners: Vec::new(),
            corners_of: Vec::new(),
            varies: Vec::new(),
            free: HashSet::new(),
            broken: false,
            used: Vec::new(),
            used_trajectories: HashSet::new(),
            used_by_parameters: Vec::new(),
            idle: HashSet::new(),
            certain: HashSet::new(),
            like_names: Vec::new(),
            lengths: Lengths::default(),
            tables: Vec::new(),
        }
    }
}

impl<'d, S> Deref for Reader<'d, S> {
    type Target = Report<'d>;

    fn deref(&self) -> &Report<'d> {
        &self.report
    }
}

impl<S> DerefMut for Reader<'_, S> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.report
    }
}

impl<S: SymbolTable> Reader<'_, S> {
    /// Whether the key can be a name; reports an error if it cannot.
    pub fn name(&mut self, entry: &Entry, what: &str) -> bool {
        // The text before the last dot is checked where instances are made.
        let is_part = |known: &str| entry.key.strip_prefix(known).is_some_and(|rest| rest.starts_with('.'));
        let of_instance = entry.key.rsplit_once('.').filter(|_| self.model.instances().any(is_part));
        let name = of_instance.map_or(entry.key.as_str(), |(_, name)| name);
        self.report.is_name(name, &entry.key_span, what)
    }
}
