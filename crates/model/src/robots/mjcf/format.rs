//! How the table of MJCF's elements is written.

/// Treatment of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    Supported,
    /// Ignored, with everything in it, and why.
    Ignored(&'static str),
    /// An error, and why.
    Refused(&'static str),
}

/// An element within others.
#[derive(Debug)]
pub struct Rule {
    pub tag: &'static str,
    /// Elements that it stands in, with spaces between.
    pub within: &'static str,
    pub fate: Fate,
    /// Attributes that have their meaning.
    pub supported: &'static str,
    /// Attributes without effect, and why.
    pub ignored: &'static [(&'static str, &'static str)],
    /// Attributes that are errors, unless they have the value behind them, and why.
    pub refused: &'static [(&'static str, &'static str, &'static str)],
}

impl Rule {
    /// All attributes.
    pub fn attributes(&self) -> impl Iterator<Item = &'static str> {
        let ignored = self.ignored.iter().map(|(names, _)| *names);
        let refused = self.refused.iter().map(|(names, ..)| *names);
        std::iter::once(self.supported).chain(ignored).chain(refused).flat_map(str::split_whitespace)
    }

    /// Why an attribute is refused, and the value that is not.
    pub fn refusal(&self, attribute: &str) -> Option<(&'static str, &'static str)> {
        let found = self.refused.iter().find(|(names, ..)| names.split_whitespace().any(|name| name == attribute));
        found.map(|&(_, harmless, why)| (harmless, why))
    }
}
