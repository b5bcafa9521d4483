//! Meanings of names in a copy of a piece of a file: in an instance of an assembly, or in one of several repetitions.

use std::collections::HashMap;
use std::sync::Arc;

use symdiff::formula::indices::{self, Index};

use super::frame::InstanceFrame;

/// The instance and the indices of a copy.
///
/// In an instance every name belongs to the instance, except the ground of a part that is not placed; the reader knows
/// reserved words (`t`, `energy`). A repetition outside of instances has no prefix.
#[derive(Clone, Debug, Default)]
pub struct Scope {
    /// The instance's name with a dot behind it, `front_left.`; empty outside of instances.
    prefix: String,
    /// Full name of `ground`; `None` for the model's ground.
    ground: Option<String>,
    /// Indices of the repetitions around it, the innermost last.
    indices: Vec<(String, Index)>,
    /// Parameters that are whole numbers.
    counts: Arc<HashMap<String, i64>>,
    /// Whether the number has the other sign, in a mirror.
    is_negated: bool,
    /// Placement of the instance in the model; `None` if it is placed as its assembly is written.
    frame: Option<InstanceFrame>,
}

/// Name of the ground.
const GROUND: &str = "ground";

impl Scope {
    /// The scope of the model itself.
    pub fn of_model(counts: Arc<HashMap<String, i64>>) -> Self {
        Self { counts, ..Self::default() }
    }

    /// The scope of an instance, by its full name.
    pub fn of_instance(name: &str, ground: Option<String>, counts: Arc<HashMap<String, i64>>) -> Self {
        Self { prefix: format!("{name}."), ground, counts, ..Self::default() }
    }

    /// The same with a placement.
    #[must_use]
    pub fn standing(self, frame: Option<InstanceFrame>) -> Self {
        Self { frame, ..self }
    }

    /// Placement of the instance in the model; `None` if it is placed as its assembly is written.
    pub fn frame(&self) -> Option<InstanceFrame> {
        self.frame
    }

    /// Whether the instance has a ground of its own.
    pub fn has_ground(&self) -> bool {
        self.ground.is_some()
    }

    /// Whether the number has the other sign.
    pub fn is_negated(&self) -> bool {
        self.is_negated
    }

    /// The same with a sign.
    #[must_use]
    pub fn with_sign(&self, is_negated: bool) -> Self {
        Self { is_negated, ..self.clone() }
    }

    /// The same in a repetition.
    #[must_use]
    pub fn with(&self, index: &str, value: Index) -> Self {
        let mut scope = self.clone();
        scope.indices.push((index.to_owned(), value));
        scope
    }

    /// The instance's name with a dot behind it.
    pub fn prefix(&self) -> &str {
        &self.prefix
    }

    /// The value of an index.
    pub fn index(&self, name: &str) -> Option<Index> {
        self.indices.iter().rev().find(|(known, _)| known == name).map(|(_, value)| value.clone())
    }

    /// A parameter that is a whole number.
    pub fn count(&self, name: &str) -> Option<i64> {
        if self.prefix.is_empty() {
            return self.counts.get(name).copied();
        }
        self.counts.get(&format!("{}{name}", self.prefix)).copied()
    }

    /// The value of a name in braces and ranges.
    pub fn whole(&self, name: &str) -> Option<Index> {
        self.index(name).or_else(|| self.count(name).map(Index::Number))
    }

    /// The full name of a name in the copy.
    pub fn full(&self, name: &str) -> String {
        let owner = name.split('.').next().unwrap_or(name);
        match &self.ground {
            Some(ground) if owner == GROUND => format!("{ground}{}", &name[GROUND.len()..]),
            None if owner == GROUND => name.to_owned(),
            _ => format!("{}{name}", self.prefix),
        }
    }

    /// The full name of a name that may have braces; errors in the braces were reported when the copy was made.
    pub fn reference(&self, text: &str) -> String {
        let filled = indices::fill(text, &|name| self.whole(name));
        self.full(&filled.unwrap_or_else(|_| text.to_owned()))
    }
}
