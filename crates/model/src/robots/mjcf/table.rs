//! Elements and attributes of MJCF, and the treatment of each.

use super::elements::{BODIES, COUPLINGS, SECTIONS};
use super::format::Rule;

/// The rule of an element in another.
pub fn rule(tag: &str, within: &str) -> Option<&'static Rule> {
    rules().find(|rule| rule.tag == tag && rule.within.split(' ').any(|known| known == within))
}

/// Elements that may stand in another.
pub fn elements_of(within: &str) -> impl Iterator<Item = &'static str> {
    rules().filter(move |rule| rule.within.split(' ').any(|known| known == within)).map(|rule| rule.tag)
}

/// All of them.
pub fn rules() -> impl Iterator<Item = &'static Rule> {
    SECTIONS.iter().chain(BODIES).chain(COUPLINGS)
}
