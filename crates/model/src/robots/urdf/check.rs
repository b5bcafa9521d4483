//! The checks that urdf-rs does not make: unknown and repeated elements, unknown attributes, and the numbers of each
//! attribute.
//!
//! [`rewrite`] returns the robot as a text that urdf-rs reads without error: only the contents that
//! [`format`](super::format) lists, wrong values replaced after they are reported, so that all errors of a file are
//! found at once.

use std::fmt::Write;

use super::format::{Absent, Attribute, AttributeContent, ROBOT, Rule};
use crate::robots::algebra;
use crate::robots::xml::{EXPAND, Element, NAMESPACE, XmlSpans, children, plain};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};

/// A version of URDF.
type Version = (u32, u32);

/// The first with `quat_xyzw`.
const QUATERNIONS: Version = (1, 1);

/// The first in which an absent limit means no limit, and negative ones are errors.
const OPEN_LIMITS: Version = (1, 2);

const LATEST: Version = (1, 2);

/// Checks a robot, and writes it again for urdf-rs.
pub fn rewrite(robot: Element, places: XmlSpans, diagnostics: &mut Diagnostics) -> String {
    let mut check = Check { places, diagnostics, version: (1, 0), text: String::new() };
    check.version = check.version_of(robot);
    check.element(robot, &ROBOT);
    check.text
}

struct Check<'d> {
    places: XmlSpans,
    diagnostics: &'d mut Diagnostics,
    version: Version,
    text: String,
}

impl Check<'_> {
    fn error(&mut self, code: Code, span: Span, message: impl Into<String>, help: impl Into<Option<String>>) {
        self.diagnostics.push(Diagnostic::error(code, span, message).help(help));
    }

    fn version_of(&mut self, robot: Element) -> Version {
        let Some(attribute) = plain(robot, "version") else { return (1, 0) };
        let parts = attribute.value().trim().split_once('.');
        let version = parts.and_then(|(major, minor)| Some((major.parse().ok()?, minor.parse().ok()?)));
        let span = self.places.value(attribute);
        match version {
            None => {
                let message = format!("`{}` is not a version of URDF", clip(attribute.value()));
                self.error(Code::BadXmlValue, span, message, "the versions are `1.0`, `1.1` and `1.2`".to_owned());
            }
            Some(version) if version > LATEST => {
                let message = format!("URDF {} is not known: it is read as URDF 1.2", clip(attribute.value().trim()));
                self.diagnostics.push(Diagnostic::warning(Code::XmlIgnored, span, message));
            }
            Some(_) => {}
        }
        version.unwrap_or((1, 0))
    }

    /// Checks an element with everything in it, and writes it.
    fn element(&mut self, element: Element, rule: &Rule) {
        self.check_names(element, rule);
        let limits_hold = rule.tag != "limit" || self.limits_hold(element);
        self.text.push('<');
        self.text.push_str(rule.tag);
        for attribute in rule.attributes {
            let value = self.attribute(element, attribute);
            let value = if limits_hold { value } else { Some(attribute.instead.to_owned()) };
            match value {
                Some(value) if attribute.name == "quat_xyzw" => self.quaternion(element, &value),
                Some(value) => self.write(attribute.name, &value),
                None => {}
            }
        }
        self.text.push('>');
        for rule in rule.elements {
            let mut found = children(element, rule.tag).peekable();
            if let (None, Some(value)) = (found.peek(), rule.absent) {
                self.text.push('<');
                self.text.push_str(rule.tag);
                rule.attributes.iter().for_each(|attribute| self.write(attribute.name, value));
                self.text.push_str("/>");
            }
            for (index, child) in found.enumerate() {
                if index > 0 && !rule.repeats {
                    let message = format!("a second `<{}>` in one `<{}>`", rule.tag, element.tag_name().name());
                    self.error(Code::GivenTwice, self.places.tag(child), message, None);
                    break;
                }
                self.element(child, rule);
            }
        }
        // `write!` to a string does not fail.
        let _ = writeln!(self.text, "</{}>", rule.tag);
    }

    fn write(&mut self, attribute: &str, value: &str) {
        let _ = write!(self.text, " {attribute}=\"");
        for c in value.chars() {
            match c {
                '&' => self.text.push_str("&amp;"),
                '<' => self.text.push_str("&lt;"),
                '>' => self.text.push_str("&gt;"),
                '"' => self.text.push_str("&quot;"),
                c => self.text.push(c),
            }
        }
        self.text.push('"');
    }

    /// Reports elements and attributes that the format does not have. Those of other namespaces are other programs'.
    fn check_names(&mut self, element: Element, rule: &Rule) {
        let tag = element.tag_name();
        for attribute in element.attributes() {
            let (name, span) = (attribute.name(), self.places.attribute(attribute));
            match attribute.namespace() {
                None if rule.attributes.iter().all(|known| known.name != name) => {
                    let known = rule.attributes.iter().map(|known| known.name);
                    self.unknown(span, format!("`<{}>` has no attribute `{}`", rule.tag, clip(name)), name, known);
                }
                Some(NAMESPACE) if !rule.uncertain.contains(&name) => {
                    let message = format!("`<{}>` has no number `{}`", rule.tag, clip(name));
                    let help = suggest::help(name, "numbers of it", rule.uncertain.iter().copied());
                    self.error(Code::UnknownXml, span, message, help);
                }
                _ => {}
            }
        }
        let own = |node: &Element| node.is_element() && node.tag_name().namespace() == tag.namespace();
        for child in element.children().filter(own) {
            let name = child.tag_name().name();
            let known = rule.elements.iter().map(|known| known.tag);
            if !known.clone().any(|known| known == name) && !rule.others.contains(&name) {
                let message = format!("`<{}>` has no element `<{}>`", rule.tag, clip(name));
                self.unknown(self.places.tag(child), message, name, known);
            }
        }
    }

    /// A misspelt name is an error; any other may be an extension, which another program understands.
    fn unknown<'k>(&mut self, span: Span, message: String, name: &str, known: impl Iterator<Item = &'k str>) {
        match suggest::nearest(name, known) {
            Some(near) => self.error(Code::UnknownXml, span, message, format!("did you mean `{near}`?")),
            None => {
                self.diagnostics.push(Diagnostic::warning(Code::XmlIgnored, span, format!("{message}: it is ignored")))
            }
        }
    }

    /// The value to write for an attribute, if any.
    fn attribute(&mut self, element: Element, rule: &Attribute) -> Option<String> {
        let instead = || rule.instead.to_owned();
        let Some(attribute) = plain(element, rule.name) else {
            if rule.absent == Absent::Error {
                let message = format!("`<{}>` needs `{}`", element.tag_name().name(), rule.name);
                self.error(Code::MissingXml, self.places.tag(element), message, None);
            }
            return (rule.absent != Absent::Default).then(instead);
        };
        let (value, span) = (attribute.value(), self.places.value(attribute));
        let is_right = match rule.shape {
            AttributeContent::Text => true,
            AttributeContent::Word(words) => {
                let known = words.contains(&value);
                if !known {
                    let message = format!("`{}` is not a type of joint", clip(value));
                    self.error(Code::BadXmlValue, span, message, suggest::help(value, "types", words.iter().copied()));
                }
                known
            }
            AttributeContent::Numbers(count) => self.check_numbers(value, span, rule.name, count),
        };
        Some(if is_right { value.to_owned() } else { instead() })
    }

    fn check_numbers(&mut self, value: &str, span: Span, name: &str, count: usize) -> bool {
        let parts: Vec<&str> = if count == 1 { vec![value.trim()] } else { value.split_whitespace().collect() };
        if parts.len() != count {
            let words = if count == 3 { "three" } else { "four" };
            let message = format!("`{name}` has {words} numbers, but here are {}", parts.len());
            self.error(Code::BadXmlValue, span, message, None);
            return false;
        }
        let is_number = |part: &str| part.parse::<f64>().is_ok_and(f64::is_finite);
        let wrong: Vec<&str> = parts.into_iter().filter(|part| !is_number(part)).collect();
        for part in &wrong {
            let help = part.contains("${").then(|| EXPAND.to_owned());
            self.error(Code::BadXmlValue, span.clone(), format!("`{}` is not a finite number", clip(part)), help);
        }
        wrong.is_empty()
    }

    /// Writes a checked quaternion as roll, pitch and yaw.
    ///
    /// urdf-rs would do so too, but as urdfdom does, with a pitch within 0.26° of ±90° taken as ±90°.
    fn quaternion(&mut self, origin: Element, value: &str) {
        let span = self.places.value_or_tag(origin, "quat_xyzw");
        let parts: Vec<f64> = value.split_whitespace().filter_map(|part| part.parse().ok()).collect();
        let &[x, y, z, w] = parts.as_slice() else { return };
        if self.version < QUATERNIONS {
            let help = "write `version=\"1.1\"` in `<robot …>`, or give the rotation as `rpy`".to_owned();
            self.error(
                Code::BadXmlValue,
                span,
                "`quat_xyzw` belongs to URDF 1.1, and this file is of an earlier version",
                help,
            );
        } else if plain(origin, "rpy").is_some() {
            self.error(Code::ExclusiveKeys, span, "`rpy` and `quat_xyzw` exclude each other", None);
        } else if parts.iter().all(|part| *part == 0.0) {
            self.error(Code::ZeroDirection, span, "a quaternion of zeros is no rotation", None);
        } else {
            let [roll, pitch, yaw] = algebra::angles_of([w, x, y, z]);
            self.write("rpy", &format!("{roll:?} {pitch:?} {yaw:?}"));
        }
    }

    /// Whether limits are in order, with those that are absent.
    fn limits_hold(&mut self, limit: Element) -> bool {
        let value = |name: &str| plain(limit, name).and_then(|found| found.value().trim().parse::<f64>().ok());
        let open = self.version >= OPEN_LIMITS;
        let end = |name, absent: f64| value(name).unwrap_or(if open { absent } else { 0.0 });
        let mut hold = true;
        if end("lower", f64::NEG_INFINITY) > end("upper", f64::INFINITY) {
            let joint = limit.parent_element().and_then(|joint| plain(joint, "name")).map_or("", |name| name.value());
            let message = format!("the limits of joint `{}` are reversed", clip(joint));
            self.error(Code::BadXmlValue, self.places.value_or_tag(limit, "lower"), message, None);
            hold = false;
        }
        for name in ["effort", "velocity", "acceleration", "deceleration", "jerk"] {
            if open && value(name).is_some_and(|value| value < 0.0) {
                self.error(
                    Code::BadXmlValue,
                    self.places.value_or_tag(limit, name),
                    format!("`{name}` cannot be negative"),
                    None,
                );
                hold = false;
            }
        }
        hold
    }
}
