//! MJCF text → elements with locations, included files in place of their `<include>`, every name checked against
//! [`table`](super::table).

use std::path::{Path, PathBuf};

use super::format::{Fate, Rule};
use super::table;
use crate::robots::tuning::TUNING;
use crate::robots::xml::{self, Element, NAMESPACE, XmlSpans};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::within::AllowedFolders;

/// An element.
pub struct Item {
    pub tag: String,
    /// Span of its start tag.
    pub span: Span,
    pub attributes: Vec<Attribute>,
    pub items: Vec<Item>,
}

pub struct Attribute {
    pub name: String,
    pub value: String,
    /// Span of the value.
    pub span: Span,
    /// Whether it is mbint's own.
    pub own: bool,
}

impl Item {
    /// An attribute of the format.
    pub fn get(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| !attribute.own && attribute.name == name)
    }

    /// An attribute of mbint's own.
    pub fn own(&self, name: &str) -> Option<&Attribute> {
        self.attributes.iter().find(|attribute| attribute.own && attribute.name == name)
    }

    /// Elements in it of a name.
    pub fn of<'i>(&'i self, tag: &'static str) -> impl Iterator<Item = &'i Item> {
        self.items.iter().filter(move |item| item.tag == tag)
    }
}

/// Reads a file, whose path is seen from the model's folder, with its includes.
pub fn read(path: &Path, at: Option<Span>, files: &AllowedFolders, diagnostics: &mut Diagnostics) -> Option<Item> {
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let mut reader = Reader { diagnostics, within: files, folder, open: Vec::new(), files: 0, items: 0, levels: 0 };
    let mut whole = Vec::new();
    reader.file(path, at, None, &mut whole);
    whole.pop()
}

struct Reader<'d> {
    diagnostics: &'d mut Diagnostics,
    within: &'d AllowedFolders,
    /// Folder of the outermost file: names are from it.
    folder: PathBuf,
    /// Files that include the next.
    open: Vec<PathBuf>,
    files: usize,
    items: usize,
    levels: usize,
}

impl Reader<'_> {
    fn error(&mut self, code: Code, span: Span, message: impl Into<String>, help: impl Into<Option<String>>) {
        self.diagnostics.push(Diagnostic::error(code, span, message).help(help));
    }

    /// The elements of a file: the outermost, or, of a file that is included in an element, those in its outermost.
    fn file(&mut self, path: &Path, at: Option<Span>, within: Option<&str>, found: &mut Vec<Item>) {
        self.files += 1;
        let full = self.within.full(path);
        let text = match self.within.read(&full, TUNING.file_bytes) {
            Ok(text) => text,
            Err(error) => {
                let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
                let message = match at {
                    Some(_) => error.message.replacen("the file", &format!("the file `{}`", clip(&name)), 1),
                    None => error.message,
                };
                self.diagnostics.push(Diagnostic { span: at, message, ..*error });
                return;
            }
        };
        let start = self.diagnostics.sources.add(full.display().to_string(), text.clone());
        let mut held = String::new();
        let parsed = xml::parse(&text, &mut held, start, "an MJCF", self.diagnostics);
        let Some((document, places)) = parsed else { return };
        let root = document.root_element();
        let tag = root.tag_name().name();
        if tag != "mujoco" && (within.is_none() || tag != "mujocoinclude" && Some(tag) != within) {
            let message = format!("an MJCF is a `<mujoco>`, but here is `<{}>`", clip(tag));
            let help = (tag == "robot").then(|| "a `<robot>` is a URDF: name it by `urdf`".to_owned());
            self.error(Code::WrongRobot, places.tag(root), message, help);
            return;
        }
        self.open.push(path.to_owned());
        match within {
            None => found.extend(self.item(root, places, "")),
            Some(within) => self.items_of(root, places, within, found),
        }
        self.open.pop();
    }

    fn items_of(&mut self, element: Element, places: XmlSpans, within: &str, found: &mut Vec<Item>) {
        for child in element.children().filter(Element::is_element) {
            if child.tag_name().namespace() != element.tag_name().namespace() {
                continue;
            }
            if child.tag_name().name() == "include" && table::rule("include", within).is_some() {
                self.include(child, places, within, found);
                continue;
            }
            found.extend(self.item(child, places, within));
        }
    }

    fn include(&mut self, element: Element, places: XmlSpans, within: &str, found: &mut Vec<Item>) {
        let Some(file) = xml::plain(element, "file") else {
            self.error(Code::MissingXml, places.tag(element), "`<include>` needs `file`", None);
            return;
        };
        let span = places.value(file);
        if let Some(path) = self.found(file.value(), &span) {
            self.file(&path, Some(span), Some(within), found);
        }
    }

    /// Another model, of which parts may be attached.
    fn model(&mut self, file: &Attribute, found: &mut Vec<Item>) {
        let Some(path) = self.found(&file.value, &file.span) else { return };
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let outer = std::mem::replace(&mut self.folder, folder);
        self.file(&path, Some(file.span.clone()), None, found);
        self.folder = outer;
    }

    /// The path of another file, unless that may not be read.
    fn found(&mut self, name: &str, span: &Span) -> Option<PathBuf> {
        match self.within.find(&self.folder, name) {
            Err(error) => self.error(error.code, span.clone(), error.message, error.help),
            Ok(path) if self.open.contains(&path) => {
                self.error(Code::Circle, span.clone(), format!("`{}` includes itself", clip(name)), None);
            }
            Ok(_) if self.files == TUNING.mjcf_files => {
                self.error(
                    Code::TooLarge,
                    span.clone(),
                    format!("the model includes more than {mjcf_files} files", mjcf_files = TUNING.mjcf_files),
                    None,
                );
            }
            Ok(path) => return Some(path),
        }
        None
    }

    /// An element with everything in it, unless it is ignored or refused.
    fn item(&mut self, element: Element, places: XmlSpans, within: &str) -> Option<Item> {
        let (tag, span) = (element.tag_name().name(), places.tag(element));
        let Some(rule) = table::rule(tag, within) else {
            let message = format!("`<{within}>` has no element `<{}>`", clip(tag));
            self.unknown(span, message, tag, table::elements_of(within));
            return None;
        };
        match rule.fate {
            Fate::Ignored(_) => return None,
            Fate::Refused(why) => {
                self.error(Code::UnsupportedXml, span, format!("`<{tag}>` is not supported"), why.to_owned());
                return None;
            }
            Fate::Supported => {}
        }
        self.items += 1;
        self.levels += 1;
        if self.items > TUNING.mjcf_items || self.levels > TUNING.mjcf_levels {
            if self.items == TUNING.mjcf_items + 1 || self.levels == TUNING.mjcf_levels + 1 {
                let message = format!(
                    "the files have more than {} elements, or nest deeper than {}",
                    TUNING.mjcf_items, TUNING.mjcf_levels
                );
                self.error(Code::TooLarge, span, message, None);
            }
            self.levels -= 1;
            return None;
        }
        let attributes = self.attributes(element, places, rule);
        let mut items = Vec::new();
        self.items_of(element, places, tag, &mut items);
        if let ("model", Some(file)) = (tag, attributes.iter().find(|attribute| attribute.name == "file")) {
            self.model(file, &mut items);
        }
        self.levels -= 1;
        Some(Item { tag: tag.to_owned(), span, attributes, items })
    }

    fn attributes(&mut self, element: Element, places: XmlSpans, rule: &'static Rule) -> Vec<Attribute> {
        let mut found = Vec::new();
        for attribute in element.attributes() {
            let (name, value, span) = (attribute.name(), attribute.value(), places.value(attribute));
            let own = attribute.namespace() == Some(NAMESPACE);
            if attribute.namespace().is_some() && !own {
                continue;
            }
            if !own && !rule.attributes().any(|known| known == name) {
                let message = format!("`<{}>` has no attribute `{}`", rule.tag, clip(name));
                self.unknown(places.attribute(attribute), message, name, rule.attributes());
                continue;
            }
            if let Some((_, why)) = rule.refusal(name).filter(|(harmless, _)| !own && !is_same(value, harmless)) {
                let message = format!("`{name}` of `<{}>` is not supported", rule.tag);
                self.error(Code::UnsupportedXml, places.attribute(attribute), message, why.to_owned());
                continue;
            }
            found.push(Attribute { name: name.to_owned(), value: value.to_owned(), span, own });
        }
        found
    }

    /// A misspelt name is an error; any other may be of a later version.
    fn unknown<'k>(&mut self, span: Span, message: String, name: &str, known: impl Iterator<Item = &'k str>) {
        match suggest::nearest(name, known) {
            Some(near) => self.error(Code::UnknownXml, span, message, format!("did you mean `{near}`?")),
            None => {
                self.diagnostics.push(Diagnostic::warning(Code::XmlIgnored, span, format!("{message}: it is ignored")))
            }
        }
    }
}

/// Whether a value means the same as another; of numbers, whether all of them do.
fn is_same(value: &str, harmless: &str) -> bool {
    let number = |text: &str| text.parse::<f64>().ok();
    match harmless.split_whitespace().next().and_then(number) {
        Some(harmless) => value.split_whitespace().all(|part| number(part) == Some(harmless)),
        None => value.trim() == harmless,
    }
}
