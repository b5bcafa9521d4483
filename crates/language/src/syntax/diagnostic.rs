//! Diagnostics of a model with their locations: collected, not thrown one by one.

use std::collections::HashSet;
use std::fmt;

use serde::Serialize;

use super::codes::{Code, Coded};
use super::source::{Sources, Span, TextInstance};

/// Severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The model cannot be used.
    Error,
    /// The model can be used, but something is probably not meant as written.
    Warning,
}

/// An error or a warning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Severity of a diagnostic.
    pub severity: Severity,
    /// The kind of mistake.
    pub code: Code,
    /// Description in one line.
    pub message: String,
    /// Its location; `None` for the file as a whole.
    pub span: Option<Span>,
    /// Text next to the marker.
    pub label: Option<String>,
    /// Other locations that explain it, each with its label.
    pub secondary: Vec<(Span, String)>,
    /// Suggested correction.
    pub help: Option<String>,
}

impl Diagnostic {
    /// An error at a location.
    pub fn error(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            code,
            message: message.into(),
            span: Some(span),
            label: None,
            secondary: Vec::new(),
            help: None,
        }
    }

    /// A warning at a location.
    pub fn warning(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(code, span, message) }
    }

    /// An error of the file as a whole.
    pub fn of_file(code: Code, message: impl Into<String>) -> Self {
        Self { span: None, ..Self::error(code, 0..0, message) }
    }

    /// Whether it reports an unknown name.
    fn is_of_unknown_name(&self) -> bool {
        self.message.starts_with("unknown ") || self.message.contains("` has no point `")
    }

    /// Adds text next to the marker.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = Some(label.into());
        self
    }

    /// Sets the suggested correction.
    #[must_use]
    pub fn help(mut self, help: impl Into<Option<String>>) -> Self {
        self.help = help.into();
        self
    }

    /// Adds another location that explains it.
    #[must_use]
    pub fn also(mut self, span: Span, label: impl Into<String>) -> Self {
        self.secondary.push((span, label.into()));
        self
    }
}

/// All errors and warnings, with the texts that they point into.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    /// The texts that spans point into; the first is the model file.
    pub sources: Sources,
    items: Vec<Diagnostic>,
    /// Whether names could not be read, so that unknown names are not reported.
    names_lost: bool,
}

/// A diagnostic for machines (`--format json`).
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Record {
    /// An error or a warning.
    pub severity: Severity,
    /// The kind of mistake: `mbint explain` has a page of it.
    pub code: Code,
    /// Description of the error.
    pub message: String,
    /// Name of the text.
    pub file: String,
    /// From 1; absent for the file as a whole.
    pub line: Option<usize>,
    /// Characters, from 1.
    pub column: Option<usize>,
    /// Suggested correction.
    pub help: Option<String>,
    /// The instance of an assembly, if it is in one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instance: Option<String>,
}

impl Diagnostics {
    /// No diagnostics yet of this text.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        let mut sources = Sources::default();
        sources.add(name, text);
        Self { sources, ..Self::default() }
    }

    /// Adds a diagnostic unless it is there already. One in a copy also gets the locations of its instance and of those
    /// around it.
    pub fn push(&mut self, mut diagnostic: Diagnostic) {
        // One text may be read several times, one after the other: for each component of its expansion.
        let is_same = |known: &Diagnostic| known.span == diagnostic.span && known.message == diagnostic.message;
        if self.names_lost && diagnostic.is_of_unknown_name() || self.items.iter().rev().take(8).any(is_same) {
            return;
        }
        let mut place = diagnostic.span.clone();
        while let Some(TextInstance { instance, of, span }) = place.and_then(|place| self.sources.within(&place)) {
            diagnostic.secondary.push((span.clone(), format!("in `{instance}`, an instance of `{of}`")));
            place = Some(span.clone());
        }
        self.items.push(diagnostic);
    }

    /// Reads a text that was added to the sources at `start`, and moves its diagnostics there.
    pub fn read_more<T>(&mut self, start: usize, text: &str, read: impl FnOnce(&mut Self) -> T) -> T {
        let mut own = Self::new("", text);
        let result = read(&mut own);
        let moved = |span: Span| start + span.start..start + span.end;
        self.items.extend(own.items.into_iter().map(|found| Diagnostic {
            // A diagnostic of the whole file points to its beginning.
            span: Some(moved(found.span.clone().unwrap_or(0..0))),
            secondary: found.secondary.iter().map(|(span, label)| (moved(span.clone()), label.clone())).collect(),
            ..found
        }));
        result
    }

    /// Unknown names are not reported from now on: names could not be read, which was reported.
    pub fn names_are_lost(&mut self) {
        self.names_lost = true;
    }

    /// Adds to the error of an unknown key which key is missing.
    pub fn also_missing(&mut self, error: usize, key: &str) {
        if let Some(found) = self.items.get_mut(error) {
            let known = found.help.take().map_or_else(String::new, |help| format!("; {help}"));
            found.help = Some(format!("`{key}` is missing{known}"));
        }
    }

    /// Number of diagnostics so far.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Adds to the unknown names among the diagnostics after the `first` whether the name is omitted, one of
    /// `left_out`.
    pub fn found_without(&mut self, first: usize, left_out: &[String]) {
        for diagnostic in self.items[first..].iter_mut().filter(|found| found.message.starts_with("unknown ")) {
            if let Some(name) = left_out.iter().find(|name| diagnostic.message.ends_with(&format!(" `{name}`"))) {
                diagnostic.help = Some(format!("`{name}` is omitted here: omit this too, or put `{name}` in"));
            }
        }
    }

    /// Removes repetitions from the diagnostics from index `first` on, which were found in a scene, and lets those
    /// outside of the scene point to it. `name` is the location of the scene's name, `whole` that of the whole scene.
    pub fn found_in_scene(&mut self, first: usize, name: &Span, whole: &Span) {
        let found = self.items.split_off(first);
        let key = |diagnostic: &Diagnostic| (diagnostic.span.clone(), diagnostic.message.clone());
        let said: HashSet<_> = self.items.iter().map(key).collect();
        for diagnostic in found.into_iter().filter(|diagnostic| !said.contains(&key(diagnostic))) {
            let inside =
                diagnostic.span.as_ref().is_some_and(|span| whole.start <= span.start && span.end <= whole.end);
            self.items.push(if inside { diagnostic } else { diagnostic.also(name.clone(), "in this scene") });
        }
    }

    /// All, in the order of the file.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        let mut sorted: Vec<&Diagnostic> = self.items.iter().collect();
        sorted.sort_by_key(|diagnostic| diagnostic.span.as_ref().map_or(0, |span| span.start));
        sorted.into_iter()
    }

    /// Whether there is neither an error nor a warning.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// Number of errors.
    pub fn errors(&self) -> usize {
        self.items.iter().filter(|diagnostic| diagnostic.severity == Severity::Error).count()
    }

    /// Whether the model cannot be used.
    pub fn has_errors(&self) -> bool {
        self.errors() > 0
    }

    /// All as plain data, in the order of the file.
    pub fn records(&self) -> Vec<Record> {
        self.iter().map(|diagnostic| self.record(diagnostic)).collect()
    }

    fn record(&self, diagnostic: &Diagnostic) -> Record {
        let located = diagnostic.span.as_ref().and_then(|span| self.sources.locate(span));
        let source = located.as_ref().map(|(source, _)| *source).or(self.sources.first());
        let place = located.as_ref().map(|(source, span)| source.place(span.start));
        Record {
            severity: diagnostic.severity,
            code: diagnostic.code,
            message: diagnostic.message.clone(),
            file: source.map_or_else(String::new, |source| source.name.clone()),
            line: place.map(|place| place.line),
            column: place.map(|place| place.column),
            help: diagnostic.help.clone(),
            instance: diagnostic.span.as_ref().and_then(|span| Some(self.sources.within(span)?.instance.clone())),
        }
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.render(false))
    }
}

impl std::error::Error for Diagnostics {}

/// The code of the first error.
impl Coded for Diagnostics {
    fn code(&self) -> Option<Code> {
        self.iter().find(|diagnostic| diagnostic.severity == Severity::Error).map(|diagnostic| diagnostic.code)
    }
}
