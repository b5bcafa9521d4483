//! Places of names in a list, so that a name of a long list is not looked for one by one.

use std::collections::HashMap;
use std::fmt;
use std::sync::{Mutex, PoisonError};

/// Remembers where the names of a list are. The list may grow, be cut, and be another one: a remembered index is
/// compared with its end. A name that stays in its place stays as it is.
#[derive(Default)]
pub struct NameIndex(Mutex<Known>);

#[derive(Default)]
struct Known {
    places: HashMap<String, usize>,
    /// Names of the list that were entered.
    entered: usize,
}

impl NameIndex {
    /// The first place of a name in a list of this length.
    pub fn find<'n>(&self, name: &str, length: usize, name_at: impl Fn(usize) -> &'n str) -> Option<usize> {
        // What a panic left is compared with the list as everything is.
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let Known { places, entered } = &mut *known;
        let is_same = |last: &usize| *entered <= length && places.get(name_at(*last)) == Some(last);
        if entered.checked_sub(1).is_some_and(|last| !is_same(&last)) {
            (*places, *entered) = (HashMap::new(), 0);
        }
        for place in *entered..length {
            places.entry(name_at(place).to_owned()).or_insert(place);
        }
        *entered = length;
        match places.get(name) {
            Some(&place) if name_at(place) == name => Some(place),
            None => None,
            // The list has changed.
            Some(_) => {
                (*places, *entered) = (HashMap::new(), 0);
                (0..length).find(|&place| name_at(place) == name)
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
