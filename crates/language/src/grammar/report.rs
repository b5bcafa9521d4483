//! Errors and warnings of reading, and the shapes of nodes: mappings with known keys, words, lists.
//!
//! A report knows no names of a model; conversions of one tree into another need no more. Reading continues after an
//! error, so that one run reports as many as can be found; a method returns `None` only when it has reported why.

use std::cell::Cell;
use std::collections::HashMap;
use std::path::Path;

use super::beside_kind::within_kind;
use super::mapping::Grammar;
use super::mentions::Notes;
use super::names;
use super::quantity::Dimension;
use super::values;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::tuning::TUNING;
use crate::syntax::within::AllowedFolders;
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// Errors and warnings of a model, and the files that it may name.
pub struct Report<'d> {
    /// Errors and warnings so far.
    pub diagnostics: &'d mut Diagnostics,
    /// Folders of the files that the model may name.
    pub files: AllowedFolders,
    /// Names and formulas that were read; `None` unless an editor asks for them.
    pub mentions: Option<&'d Notes>,
}

/// A mapping whose keys are known.
pub struct Fields<'n> {
    /// Location at which missing keys are reported.
    pub at: Span,
    what: &'static str,
    keys: Vec<&'static str>,
    entries: HashMap<&'n str, (Span, &'n Node)>,
    /// Keys of which an unknown key is probably a misspelling, which has been reported.
    misspelt: Vec<&'static str>,
    /// Index of the error of the only unknown key without a similar known one: it is taken for the missing key.
    strange: Cell<Option<usize>>,
}

impl<'n> Fields<'n> {
    /// A mapping of one key, given by the key's value alone.
    pub fn single(what: &'static str, keys: Vec<&'static str>, key: &'n str, node: &'n Node, at: Span) -> Self {
        Self {
            at,
            what,
            keys,
            entries: HashMap::from([(key, (node.span.clone(), node))]),
            misspelt: Vec::new(),
            strange: Cell::new(None),
        }
    }

    /// The value of a key, if it is given.
    pub fn get(&self, key: &str) -> Option<&'n Node> {
        debug_assert!(self.keys.contains(&key), "`{key}` is not in the grammar of {}", self.what);
        self.entries.get(key).map(|(_, node)| *node)
    }

    /// Whether a key is missing, and is not reported as misspelt.
    pub fn lacks(&self, key: &str) -> bool {
        self.get(key).is_none() && !self.misspelt.contains(&key)
    }

    /// Whether [`Self::lacks`] holds for all of these alternatives.
    pub fn lacks_all(&self, keys: &[&str]) -> bool {
        keys.iter().all(|key| self.lacks(key))
    }

    /// The location of a key; that for missing keys if it is not given.
    pub fn key_span(&self, key: &str) -> Span {
        self.entries.get(key).map_or_else(|| self.at.clone(), |(span, _)| span.clone())
    }
}

impl Report<'_> {
    /// Reports an error.
    pub fn error(&mut self, code: Code, span: Span, message: impl Into<String>, help: impl Into<Option<String>>) {
        self.diagnostics.push(Diagnostic::error(code, span, message).help(help));
    }

    /// The entries of a mapping with free keys; an empty value is an empty mapping.
    pub fn entries<'n>(&mut self, node: &'n Node, what: &str) -> &'n [Entry] {
        match &node.value {
            Value::Mapping(entries) => entries,
            Value::Scalar(scalar) if scalar.is_null() => &[],
            _ => {
                let message = format!("{what} are a mapping, but here is {}", node.kind());
                self.error(Code::WrongShape, node.span.clone(), message, "write `name: …` for each".to_owned());
                &[]
            }
        }
    }

    /// The same for names that others refer to: unknown names are not reported if these could not be read.
    pub fn named_entries<'n>(&mut self, node: &'n Node, what: &str) -> &'n [Entry] {
        let entries = self.entries(node, what);
        if !matches!(node.value, Value::Mapping(_)) && !node.is_null() {
            self.diagnostics.names_are_lost();
        }
        entries
    }

    /// Reads a mapping with the keys of `G`; missing ones are reported at `at`.
    pub fn fields<'n, G: Grammar>(&mut self, node: &'n Node, at: Span) -> Option<Fields<'n>> {
        self.mapping(G::WHAT, G::KEYS.to_vec(), node, at)
    }

    /// Reads a mapping with these keys; missing ones are reported at `at`.
    pub fn mapping<'n>(
        &mut self,
        what: &'static str,
        keys: Vec<&'static str>,
        node: &'n Node,
        at: Span,
    ) -> Option<Fields<'n>> {
        let entries: &[Entry] = match &node.value {
            Value::Mapping(entries) => entries,
            Value::Scalar(scalar) if scalar.is_null() => &[],
            _ => {
                let message = format!("{what} is a mapping, but here is {}", node.kind());
                let help = format!("its keys are {}", suggest::list(&keys));
                self.error(Code::WrongShape, node.span.clone(), message, help);
                return None;
            }
        };
        let (mut misspelt, mut strange) = (Vec::new(), Vec::new());
        for entry in entries.iter().filter(|entry| !keys.contains(&entry.key.as_str())) {
            let message = format!("{what} has no `{}`", clip(&entry.key));
            let help = if entry.key.contains(':') {
                Some("a space belongs behind the `:`".to_owned())
            } else {
                suggest::help(&entry.key, "keys", keys.iter().copied())
            };
            match suggest::nearest(entry.key.split(':').next().unwrap_or(""), keys.iter().copied()) {
                Some(near) => misspelt.push(near),
                None => strange.push(self.diagnostics.len()),
            }
            self.error(Code::UnknownKey, entry.key_span.clone(), message, help);
            if keys.iter().any(|key| ["bodies", "points"].contains(key))
                && matches!(entry.value.value, Value::Mapping(_))
            {
                self.diagnostics.names_are_lost();
            }
        }
        let entries =
            entries.iter().map(|entry| (entry.key.as_str(), (entry.key_span.clone(), &entry.value))).collect();
        let strange = Cell::new(strange.first().copied().filter(|_| strange.len() == 1));
        Some(Fields { at, what, keys, entries, misspelt, strange })
    }

    /// The value of a required key; reports an error if it is missing.
    pub fn required<'n>(&mut self, fields: &Fields<'n>, key: &str) -> Option<&'n Node> {
        let found = fields.get(key);
        if fields.lacks(key) && !self.is_strange(fields, key) {
            self.error(Code::MissingKey, fields.at.clone(), format!("{} needs `{key}`", fields.what), None);
        }
        found
    }

    /// Whether the only unknown key may have been meant as the missing key: its error then says so.
    pub fn is_strange(&mut self, fields: &Fields, key: &str) -> bool {
        let strange = fields.strange.take();
        strange.inspect(|&error| self.diagnostics.also_missing(error, key)).is_some()
    }

    /// The only entry of a mapping that chooses a kind: `{ torque: … }`.
    pub fn only<'n, G: Grammar>(&mut self, node: &'n Node, at: Span) -> Option<&'n Entry> {
        self.kind_of_entry(G::WHAT, G::KEYS, node, at)
    }

    /// The only entry of a mapping that chooses one of these kinds.
    pub fn kind_of_entry<'n>(&mut self, what: &str, known: &[&str], node: &'n Node, at: Span) -> Option<&'n Entry> {
        let kinds = || suggest::list(known);
        match &node.value {
            Value::Mapping(entries) => match entries.as_slice() {
                [entry] if known.contains(&entry.key.as_str()) => Some(entry),
                [entry] => {
                    let message = format!("`{}` is not a kind of {}", clip(&entry.key), bare(what));
                    let help = suggest::help(&entry.key, "kinds", known.iter().copied());
                    self.error(Code::UnknownKind, entry.key_span.clone(), message, help);
                    None
                }
                [] => {
                    self.error(
                        Code::OneKind,
                        at,
                        format!("{} needs a kind", what),
                        format!("the kinds are {}", kinds()),
                    );
                    None
                }
                [_, second, ..] => {
                    let message = format!("{} has one kind, but `{}` is a second key", what, clip(&second.key));
                    let help = within_kind(known, entries)
                        .unwrap_or_else(|| format!("write `name: {{ kind: … }}`, with one of {}", kinds()));
                    self.error(Code::OneKind, second.key_span.clone(), message, help);
                    None
                }
            },
            _ => {
                let message = format!("{} is a mapping of its kind, but here is {}", what, node.kind());
                let help = match node.scalar().filter(|scalar| known.contains(&&*scalar.text)) {
                    Some(kind) => format!("write `{{ {}: {{ … }} }}`, with its keys within", kind.text),
                    None => format!("write `{{ kind: … }}`; the kinds are {}", kinds()),
                };
                self.error(Code::OneKind, if node.is_null() { at } else { node.span.clone() }, message, help);
                None
            }
        }
    }

    /// Whether this can be the name of `what`; reports an error if it cannot.
    pub fn is_name(&mut self, name: &str, at: &Span, what: &str) -> bool {
        let mut letters = name.chars();
        let well_formed = letters.next().is_some_and(|c| c.is_alphabetic() || c == '_')
            && letters.all(|c| c.is_alphanumeric() || c == '_');
        if !well_formed {
            let message = format!("`{}` cannot be the name of {what}", clip(name));
            let help = match name.contains('{') {
                true => "the name of a repeated entry contains the index: `repeat: { i: 1..6 }`",
                false => "a name is made of letters, digits and `_`, a letter first",
            };
            self.error(Code::BadName, at.clone(), message, help.to_owned());
        } else if let Some(meaning) = names::meaning(name) {
            let message = format!("`{name}` cannot be the name of {what}: in formulas it is {meaning}");
            self.error(Code::BadName, at.clone(), message, None);
            return false;
        }
        well_formed
    }

    /// Whether a text can be the name of something that has a folder of results; reports an error if it cannot.
    pub fn is_folder_name(&mut self, name: &str, span: Span, what: &str) -> bool {
        if name.is_empty() {
            let help = "write one, or leave the key out: a model is called like its file".to_owned();
            self.error(Code::BadName, span, format!("the name of {what} is empty"), help);
            return false;
        }
        let good = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-');
        let fine = name.len() <= 100 && name.chars().all(good);
        if !fine {
            let help = "it names a folder of results: use letters, digits, `_` and `-`".to_owned();
            self.error(Code::BadName, span, format!("`{}` cannot be the name of {what}", clip(name)), help);
        }
        fine
    }

    /// The text of a node; reports an error if there is none.
    pub fn scalar<'n>(&mut self, node: &'n Node, wanted: &str) -> Option<&'n Scalar> {
        match node.scalar() {
            Some(scalar) if !scalar.is_null() => Some(scalar),
            _ => {
                self.error(
                    Code::WrongShape,
                    node.span.clone(),
                    format!("{wanted} belongs here, but here is {}", node.kind()),
                    None,
                );
                None
            }
        }
    }

    /// Reads a file that a node names, in the model's folder: its offset among the sources, and its text.
    pub fn file(&mut self, node: &Node) -> Option<(usize, String)> {
        let scalar = self.scalar(node, "the name of a file")?;
        let found = self.files.find(Path::new(""), &scalar.text).and_then(|path| {
            let path = self.files.full(&path);
            let text = self.files.read(&path, TUNING.file_bytes)?;
            Ok((self.diagnostics.sources.add(path.display().to_string(), text.clone()), text))
        });
        match found {
            Ok(found) => Some(found),
            Err(error) => {
                let help = error.help.clone().or_else(|| Some("paths are relative to the model's folder".to_owned()));
                self.diagnostics.push(Diagnostic::error(error.code, node.span.clone(), error.message).help(help));
                None
            }
        }
    }

    /// A list of two.
    pub fn two<'n>(&mut self, node: &'n Node, wanted: &str) -> Option<[&'n Node; 2]> {
        let found = match &node.value {
            Value::Sequence(items) => match items.as_slice() {
                [first, second] => return Some([first, second]),
                items => format!("a list of {}", items.len()),
            },
            _ => node.kind().to_owned(),
        };
        self.error(Code::WrongShape, node.span.clone(), format!("{wanted} belongs here, but here is {found}"), None);
        None
    }

    /// A list of `count` numbers, three or four.
    pub fn list_of<'n>(&mut self, node: &'n Node, count: usize) -> Option<&'n [Node]> {
        let found = match &node.value {
            Value::Sequence(items) if items.len() == count => return Some(items),
            Value::Sequence(items) => format!("a list of {}", items.len()),
            _ => node.kind().to_owned(),
        };
        let wanted = if count == 3 { "three" } else { "four" };
        self.error(
            Code::WrongShape,
            node.span.clone(),
            format!("a list of {wanted} numbers belongs here, but here is {found}"),
            None,
        );
        None
    }

    /// The key that gives a rotation, `rpy`, `axis` or `quaternion`, and all keys; missing ones are reported at `at`.
    pub fn kind_of_rotation<'n>(&mut self, node: &'n Node, at: Span) -> Option<(&'static str, Fields<'n>)> {
        let fields = self.fields::<values::Rotation>(node, at)?;
        let given: Vec<&'static str> =
            ["rpy", "axis", "quaternion"].into_iter().filter(|key| fields.get(key).is_some()).collect();
        let [kind] = given.as_slice() else {
            let help = "e.g. `{ rpy: [0, 90 deg, 0] }`, `{ axis: z, angle: 30 deg }` or `{ quaternion: [1, 0, 0, 0] }`";
            let message = "a rotation is one of `rpy`, `axis` with `angle`, and `quaternion`";
            self.error(Code::OneKind, node.span.clone(), message, help.to_owned());
            return None;
        };
        if *kind != "axis" && fields.get("angle").is_some() {
            self.error(
                Code::MisplacedKey,
                fields.key_span("angle"),
                format!("`angle` goes with `axis`, not with `{kind}`"),
                None,
            );
            return None;
        }
        Some((kind, fields))
    }

    /// Reports two keys that exclude each other, at the first.
    pub fn exclude(&mut self, fields: &Fields, [first, second]: [&str; 2]) {
        if fields.get(first).is_some() && fields.get(second).is_some() {
            self.error(
                Code::ExclusiveKeys,
                fields.key_span(first),
                format!("`{first}` and `{second}` exclude each other"),
                None,
            );
        }
    }

    /// Whether a dimension fits the one that belongs there; reports an error if it does not.
    pub fn check_fits(&mut self, span: &Span, found: Dimension, wanted: Dimension) -> bool {
        let fits = found.fits(wanted);
        if !fits {
            self.error(Code::WrongDimension, span.clone(), format!("{found} stands where {wanted} belongs"), None);
        }
        fits
    }

    /// One of a few words.
    pub fn choice<T: Copy>(&mut self, node: &Node, choices: &[(&str, T)]) -> Option<T> {
        let words: Vec<&str> = choices.iter().map(|(word, _)| *word).collect();
        let scalar = self.scalar(node, &format!("one of {}", suggest::list(&words)))?;
        let found = choices.iter().find(|(word, _)| *word == scalar.text);
        if found.is_none() {
            let message = format!("`{}` is not one of {}", clip(&scalar.text), suggest::list(&words));
            let help = suggest::nearest(&scalar.text, words).map(|near| format!("did you mean `{near}`?"));
            self.error(Code::UnknownWord, node.span.clone(), message, help);
        }
        found.map(|(_, value)| *value)
    }

    /// A whole number in a range.
    pub fn count(&mut self, node: &Node, least: usize, most: usize) -> Option<usize> {
        let wanted = format!("a whole number from {least} to {most}");
        let scalar = self.scalar(node, &wanted)?;
        let number = scalar.text.parse::<usize>().ok().filter(|number| (least..=most).contains(number));
        if number.is_none() {
            self.error(Code::OutOfRange, node.span.clone(), format!("`{}` is not {wanted}", clip(&scalar.text)), None);
        }
        number
    }
}

/// `a joint` → `joint`.
fn bare(what: &str) -> &str {
    what.strip_prefix("a ").or_else(|| what.strip_prefix("an ")).unwrap_or(what)
}
