//! Indices of names in a list, so that a name of a long list is not searched for one by one.

use std::collections::HashMap;
use std::fmt;
use std::sync::{Mutex, PoisonError};

/// Remembers the indices of the names in a list. The list may grow, be cut, and be another one: a remembered index is
/// compared with its end. A name that keeps its index is not changed.
#[derive(Default)]
pub struct NameIndex(Mutex<Known>);

#[derive(Default)]
struct Known {
    indices: HashMap<String, usize>,
    /// Names of the list that were entered.
    entered: usize,
}

impl NameIndex {
    /// Index of the first entry with a name in a list of this length.
    pub fn find<'n>(&self, name: &str, length: usize, name_at: impl Fn(usize) -> &'n str) -> Option<usize> {
        // A state that a panic left is compared with the list like any other.
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let Known { indices, entered } = &mut *known;
        let is_same = |last: &usize| *entered <= length && indices.get(name_at(*last)) == Some(last);
        if entered.checked_sub(1).is_some_and(|last| !is_same(&last)) {
            (*indices, *entered) = (HashMap::new(), 0);
        }
        for index in *entered..length {
            indices.entry(name_at(index).to_owned()).or_insert(index);
        }
        *entered = length;
        match indices.get(name) {
            Some(&index) if name_at(index) == name => Some(index),
            None => None,
            // The list has changed.
            Some(_) => {
                (*indices, *entered) = (HashMap::new(), 0);
                (0..length).find(|&index| name_at(index) == name)
            }
        }
    }
}

impl Clone for NameIndex {
    /// Knows nothing yet.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl fmt::Debug for NameIndex {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("NameIndex")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_in_lists_that_change() {
        let index = NameIndex::default();
        let find = |list: &[&'static str], name: &str| index.find(name, list.len(), |place| list[place]);
        assert_eq!(find(&["a", "b", "a"], "a"), Some(0));
        assert_eq!(find(&["a", "b", "a", "c"], "c"), Some(3));
        assert_eq!(find(&["c", "b", "a", "d"], "c"), Some(0));
        assert_eq!(find(&["c", "b", "a", "d"], "d"), Some(3));
        assert_eq!(find(&["x"], "c"), None);
        assert_eq!(find(&["x"], "x"), Some(0));
        assert_eq!(find(&[], "x"), None);
    }
}
