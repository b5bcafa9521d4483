//! Names of a model: where each is defined and where it is used, in all its files.
//!
//! Definitions with the same full name are one symbol, such as a joint of the model and the joint of a scene that
//! replaces it; so are definitions at the same location, such as a body of an assembly in all its instances.

use std::collections::HashMap;
use std::ops::Range;
use std::path::PathBuf;
use std::rc::Rc;

use crate::grammar::mentions::{Definition, Mention, NameKind};
use crate::grammar::{Span, Symbol};
use crate::model::{Description, Opened};
use crate::syntax::source::Sources;

/// A location in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// The file.
    pub file: Rc<PathBuf>,
    /// Bytes in the file.
    pub span: Range<usize>,
}

/// An occurrence of a symbol.
#[derive(Clone, Debug)]
pub struct Occurrence {
    /// Its location.
    pub at: Location,
    /// Index of the symbol.
    pub symbol: usize,
    /// Whether it is defined there.
    pub is_definition: bool,
}

/// A name with a meaning.
#[derive(Clone, Debug)]
pub struct Named {
    /// Kind of the named thing.
    pub kind: NameKind,
    /// Its full name; with several instances, the first of their names.
    pub name: String,
    /// The definitions, keys with their values.
    pub extents: Vec<Location>,
}

/// All names of a model.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// Symbols.
    pub symbols: Vec<Named>,
    /// Their occurrences, by file and offset, without duplicates.
    pub occurrences: Vec<Occurrence>,
    /// Symbols by full name.
    by_name: HashMap<String, Vec<usize>>,
}

/// The files of a reading, by the names of their sources.
#[derive(Default)]
struct Files(HashMap<String, Rc<PathBuf>>);

impl Files {
    fn locate(&mut self, sources: &Sources, span: &Span) -> Option<Location> {
        let (source, span) = sources.locate(span)?;
        let file = match self.0.get(&source.name) {
            Some(file) => Rc::clone(file),
            None => {
                let file = Rc::new(PathBuf::from(&source.name));
                self.0.insert(source.name.clone(), Rc::clone(&file));
                file
            }
        };
        Some(Location { file, span })
    }
}

impl Names {
    /// Collects the names of a model; `known` is the last model that could be read, which distinguishes things of the
    /// same name.
    pub fn of(opened: &Opened, known: Option<&Description>) -> Self {
        let (sources, mut files) = (&opened.reading.diagnostics.sources, Files::default());
        let mut names = Self::default();
        // Keyed by the file, which is one object, and the offset.
        let mut by_location: HashMap<(*const PathBuf, usize), usize> = HashMap::new();
        // For each symbol the one that it is the same as; itself if there is none.
        let mut same: Vec<usize> = Vec::new();
        for Definition { kind, name, span, extent } in &opened.mentions.definitions {
            let (Some(at), Some(extent)) = (files.locate(sources, span), files.locate(sources, extent)) else {
                continue;
            };
            let of_name =
                names.by_name.get(name).and_then(|all| all.iter().find(|&&own| names.symbols[own].kind == *kind));
            let key = (Rc::as_ptr(&at.file), at.span.start);
            let (of_name, of_place) = (of_name.copied(), by_location.get(&key).copied());
            let symbol = match (of_name, of_place) {
                (Some(symbol), None) | (None, Some(symbol)) => root(&same, symbol),
                (Some(first), Some(second)) => {
                    let (first, second) = (root(&same, first), root(&same, second));
                    let (kept, other) = (first.min(second), first.max(second));
                    same[other] = kept;
                    kept
                }
                (None, None) => {
                    names.symbols.push(Named { kind: *kind, name: name.clone(), extents: Vec::new() });
                    same.push(same.len());
                    same.len() - 1
                }
            };
            if of_name.is_none() {
                names.by_name.entry(name.clone()).or_default().push(symbol);
            }
            if of_place.is_none() {
                by_location.insert(key, symbol);
                names.symbols[symbol].extents.push(extent);
                names.occurrences.push(Occurrence { at, symbol, is_definition: true });
            }
        }
        for mention in &opened.mentions.uses {
            names.mention(mention, sources, &mut files, known);
        }
        for occurrence in &mut names.occurrences {
            occurrence.symbol = root(&same, occurrence.symbol);
        }
        for symbols in names.by_name.values_mut() {
            symbols.iter_mut().for_each(|symbol| *symbol = root(&same, *symbol));
        }
        for other in (0..same.len()).filter(|&symbol| same[symbol] != symbol) {
            let extents = std::mem::take(&mut names.symbols[other].extents);
            names.symbols[root(&same, other)].extents.extend(extents);
        }
        names.occurrences.sort_by(|a, b| {
            let files = a.at.file.as_os_str().cmp(b.at.file.as_os_str());
            let key = |own: &Occurrence| (own.at.span.start, own.at.span.end, !own.is_definition);
            files.then_with(|| key(a).cmp(&key(b)))
        });
        names.occurrences.dedup_by(|next, own| next.at.span == own.at.span && Rc::ptr_eq(&next.at.file, &own.at.file));
        names
    }

    /// Records the locations of a name. A text with line breaks, escapes or quotes is searched for the name as a word.
    fn mention(&mut self, mention: &Mention, sources: &Sources, files: &mut Files, known: Option<&Description>) {
        let Some(at) = files.locate(sources, &mention.span) else { return };
        let Some(written) = sources.locate(&mention.span).map(|(source, span)| &source.text[span]) else { return };
        let quotes = usize::from(written.starts_with(['"', '\'']));
        let inner = written.get(quotes..written.len() - quotes).unwrap_or_default();
        let is_name = mention.name.strip_suffix(inner).is_some_and(|rest| rest.is_empty() || rest.ends_with('.'));
        let starts = if is_name || !written.contains(['\n', '\\', '"', '\'']) {
            vec![(quotes, inner)]
        } else {
            let own =
                std::iter::successors(Some(mention.name.as_str()), |name| name.split_once('.').map(|(_, rest)| rest));
            let found = own.map(|name| words(written, name)).find(|found| !found.is_empty());
            found.unwrap_or_default()
        };
        for (start, text) in starts {
            let end = at.span.start + start + text.len();
            self.parts(mention, text, &at.file, end, known);
        }
    }

    /// Records each part of a name that has a definition; `text`, the name or its last parts, ends at byte `end`.
    fn parts(
        &mut self,
        mention: &Mention,
        text: &str,
        file: &Rc<PathBuf>,
        mut end: usize,
        known: Option<&Description>,
    ) {
        let mut written: Vec<&str> = text.split('.').collect();
        let mut prefix = mention.name.as_str();
        // From the last part to the first, as long as the text agrees with the name.
        while let Some(part) = written.pop() {
            if prefix.rsplit('.').next() != Some(part) {
                return;
            }
            let start = end - part.len();
            if let Some(symbol) = self.meant(prefix, mention, known) {
                let at = Location { file: Rc::clone(file), span: start..end };
                self.occurrences.push(Occurrence { at, symbol, is_definition: false });
            }
            end = start.saturating_sub(1);
            prefix = &prefix[..prefix.len().saturating_sub(part.len() + 1)];
        }
    }

    /// The symbol of a name, which is the beginning of the mention's name.
    fn meant(&self, name: &str, mention: &Mention, known: Option<&Description>) -> Option<usize> {
        let all = self.by_name.get(name)?;
        let of_kind = |kind: NameKind| all.iter().copied().find(|&symbol| self.symbols[symbol].kind == kind);
        if let [only] = all.as_slice() {
            return Some(*only);
        }
        let by_symbol = || {
            Some(match known?.symbol(&mention.name)? {
                Symbol::Parameter(_) => NameKind::Parameter,
                Symbol::Coordinate { .. } | Symbol::AngularMotion { .. } | Symbol::RollPitchYaw { .. } => {
                    NameKind::Body
                }
                Symbol::Point { .. } => NameKind::Body,
                Symbol::JointCoordinate { .. } | Symbol::Reaction { .. } => NameKind::Joint,
                Symbol::Sensor { .. } => NameKind::Effect,
                Symbol::Trajectory { .. } => NameKind::Trajectory,
                Symbol::BlackBox { .. } | Symbol::Time | Symbol::Energy(_) => return None,
            })
        };
        mention.kind.and_then(of_kind).or_else(|| of_kind(by_symbol()?)).or_else(|| all.first().copied())
    }

    /// The occurrence at a byte of a file; the shortest of several.
    pub fn at(&self, file: &std::path::Path, offset: usize) -> Option<&Occurrence> {
        let touches = |own: &&Occurrence| {
            own.at.file.as_path() == file && own.at.span.start <= offset && offset <= own.at.span.end
        };
        self.occurrences.iter().filter(touches).min_by_key(|own| own.at.span.len())
    }

    /// Occurrences of a symbol.
    pub fn of_symbol(&self, symbol: usize) -> impl Iterator<Item = &Occurrence> {
        self.occurrences.iter().filter(move |own| own.symbol == symbol)
    }

    /// Full names with their kinds, sorted.
    pub fn all(&self) -> Vec<(&str, NameKind)> {
        let mut all: Vec<(&str, NameKind)> = Vec::new();
        for (name, symbols) in &self.by_name {
            all.extend(symbols.iter().map(|&symbol| (name.as_str(), self.symbols[symbol].kind)));
        }
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// Offsets at which a name is a word of a text, each with the name.
fn words<'n>(text: &str, name: &'n str) -> Vec<(usize, &'n str)> {
    let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
    let is_word = |start: &usize| {
        !text[..*start].ends_with(is_part) && !text[start + name.len()..].starts_with(is_part) && !name.is_empty()
    };
    text.match_indices(name).map(|(start, _)| start).filter(is_word).map(|start| (start, name)).collect()
}

/// The symbol that a symbol is the same as, in the end.
fn root(same: &[usize], mut symbol: usize) -> usize {
    while same[symbol] != symbol {
        symbol = same[symbol];
    }
    symbol
}
