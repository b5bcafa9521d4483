//! URDF text → [`Robot`]: everything that is wrong with it, in its place.

use std::collections::{HashMap, HashSet};

use roxmltree::{Document, Node, ParsingOptions};

use super::robot::{Inertial, Joint, Kind, Limits, Link, Mimic, Number, Origin, Robot};
use super::tree;
use crate::grammar::names;
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};

/// Namespace of mbint's own attributes.
pub const NAMESPACE: &str = "urn:mbint";

/// Elements, attributes and texts that a file may have; 20 MB of meshes' names have fewer.
const MOST_NODES: u32 = 4_000_000;

/// Reads the text, which begins at an offset of the sources.
pub fn read(text: &str, start: usize, diagnostics: &mut Diagnostics) -> Option<Robot> {
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = match Document::parse_with_options(text, options) {
        Ok(document) => document,
        Err(error) => {
            diagnostics.push(syntax(text, start, &error));
            return None;
        }
    };
    let mut reader = Reader { start, diagnostics };
    reader.robot(document.root_element())
}

/// What the parser says, with what would be right where that is known.
fn syntax(text: &str, start: usize, error: &roxmltree::Error) -> Diagnostic {
    let at = error.pos();
    let line = text.split_inclusive('\n').take(at.row.saturating_sub(1) as usize).map(str::len).sum::<usize>();
    let column: usize = text[line..].chars().take(at.col.saturating_sub(1) as usize).map(char::len_utf8).sum();
    let ended = matches!(error, roxmltree::Error::UnexpectedEndOfStream);
    let offset = if ended { text.trim_end().len() } else { (line + column).min(text.len()) };
    let length = text[offset..].chars().next().map_or(0, char::len_utf8);
    let span = start + offset..start + offset + length;
    let (message, help) = match error {
        roxmltree::Error::DtdDetected => {
            ("a URDF has no document type: `<!DOCTYPE` is refused".to_owned(), Some("take it out".to_owned()))
        }
        roxmltree::Error::UnknownNamespace(prefix, _) if prefix == "xacro" => {
            ("this is xacro, not yet URDF".to_owned(), Some(EXPAND.to_owned()))
        }
        roxmltree::Error::UnknownNamespace(prefix, _) if prefix == "mbint" => (
            "the prefix `mbint` is not declared".to_owned(),
            Some(format!("write `xmlns:mbint=\"{NAMESPACE}\"` in `<robot …>`")),
        ),
        roxmltree::Error::UnexpectedEndOfStream => ("the file ends in the middle".to_owned(), None),
        roxmltree::Error::NodesLimitReached => ("the file has too many elements".to_owned(), None),
        error => {
            // The place is shown beside it.
            let message = error.to_string();
            let message = message.rsplit_once(" at ").map_or(message.as_str(), |(message, _)| message);
            (format!("this is not XML: {}", clip(message)), None)
        }
    };
    Diagnostic::error(span, message).help(help)
}

const EXPAND: &str = "expand it first: `xacro robot.urdf.xacro > robot.urdf`";

struct Reader<'d> {
    start: usize,
    diagnostics: &'d mut Diagnostics,
}

type Element<'a, 'i> = Node<'a, 'i>;

impl Reader<'_> {
    fn error(&mut self, span: Span, message: impl Into<String>, help: impl Into<Option<String>>) {
        self.diagnostics.push(Diagnostic::error(span, message).help(help));
    }

    /// The element's start tag: what an error of the whole is shown at.
    fn tag(&self, element: Element) -> Span {
        let range = element.range();
        let text = &element.document().input_text()[range.clone()];
        let length = text.find(['>', '\n']).map_or(text.len(), |end| end + usize::from(text[end..].starts_with('>')));
        self.start + range.start..self.start + range.start + length
    }

    fn value(&self, element: Element, attribute: &str) -> Option<Span> {
        let range = element.attribute_node(attribute)?.range_value();
        Some(self.start + range.start..self.start + range.end)
    }

    fn robot(&mut self, root: Element) -> Option<Robot> {
        let before = self.diagnostics.errors();
        if root.tag_name().name() != "robot" {
            let message = format!("a URDF is a `<robot>`, but here is `<{}>`", clip(root.tag_name().name()));
            self.error(self.tag(root), message, None);
            return None;
        }
        let expanded = |node: &Element| node.tag_name().namespace().is_none_or(|uri| !uri.contains("xacro"));
        let macros = root.descendants().filter(Node::is_element).find(|node| !expanded(node));
        if let Some(found) = macros {
            self.error(self.tag(found), "this is xacro, not yet URDF", EXPAND.to_owned());
            return None;
        }
        let elements = |tag: &'static str| root.children().filter(move |node| node.has_tag_name(tag));
        let mut taken = HashSet::new();
        let mut robot = Robot { name: root.attribute("name").unwrap_or("robot").to_owned(), ..Robot::default() };
        let mut links = HashMap::new();
        for element in elements("link") {
            let Some((written, name)) = self.name(element, "link", &mut taken) else { continue };
            if links.insert(written, robot.links.len()).is_some() {
                self.error(self.tag(element), format!("a second link is called `{}`", clip(written)), None);
            }
            let inertial = self.inertial(element, &name);
            robot.links.push(Link { name, span: self.tag(element), inertial });
        }
        if robot.links.is_empty() {
            self.error(self.tag(root), "a robot needs at least one link", None);
            return None;
        }
        let mut taken = HashSet::new();
        let mut joints = HashMap::new();
        let mut mimics = Vec::new();
        // Of every joint a transmission may speak of: `<joint>` within `<transmission>` is none of the robot's.
        for element in elements("joint") {
            let Some((written, name)) = self.name(element, "joint", &mut taken) else { continue };
            let Some(joint) = self.joint(element, name, &links) else { continue };
            if joints.insert(written, robot.joints.len()).is_some() {
                self.error(self.tag(element), format!("a second joint is called `{}`", clip(written)), None);
            }
            if let Some(mimic) = element.children().find(|node| node.has_tag_name("mimic")) {
                mimics.push((robot.joints.len(), mimic));
            }
            robot.joints.push(joint);
        }
        for (index, element) in mimics {
            robot.joints[index].mimic = self.mimic(element, index, &joints);
        }
        // What is missing because of an error makes no tree.
        (self.diagnostics.errors() == before && tree::order(&mut robot, self.diagnostics)).then_some(robot)
    }

    /// The name as the file has it, and as formulas can have it.
    fn name<'a>(
        &mut self,
        element: Element<'a, '_>,
        what: &str,
        taken: &mut HashSet<String>,
    ) -> Option<(&'a str, String)> {
        let Some(written) = element.attribute("name").filter(|name| !name.trim().is_empty()) else {
            self.error(self.tag(element), format!("a {what} needs a `name`"), None);
            return None;
        };
        let mut name: String = written.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
        if name.starts_with(|c: char| c.is_numeric()) {
            name.insert(0, '_');
        }
        while names::is_reserved(&name) || name == names::GROUND || taken.contains(&name) {
            name.push('_');
        }
        taken.insert(name.clone());
        Some((written, name))
    }

    /// One number of an attribute; `default` where there is no attribute or no element.
    fn number(&mut self, at: Option<Element>, attribute: &str, default: Option<f64>) -> Option<(f64, Span)> {
        let Some(element) = at else { return Some((default?, 0..0)) };
        let Some(text) = element.attribute(attribute) else {
            if default.is_none() {
                let message = format!("`<{}>` needs `{attribute}`", element.tag_name().name());
                self.error(self.tag(element), message, None);
            }
            return Some((default?, self.tag(element)));
        };
        let span = self.value(element, attribute)?;
        self.parse(text, span.clone()).map(|value| (value, span))
    }

    fn parse(&mut self, text: &str, span: Span) -> Option<f64> {
        let value = text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        if value.is_none() {
            let help = if text.contains("${") { Some(EXPAND.to_owned()) } else { None };
            self.error(span, format!("`{}` is not a finite number", clip(text)), help);
        }
        value
    }

    /// Three numbers of an attribute.
    fn three(&mut self, at: Option<Element>, attribute: &str, default: [f64; 3]) -> Option<([f64; 3], Span)> {
        let Some((element, text)) = at.and_then(|element| Some((element, element.attribute(attribute)?))) else {
            return Some((default, at.map_or(0..0, |element| self.tag(element))));
        };
        let span = self.value(element, attribute)?;
        let parts: Vec<&str> = text.split_whitespace().collect();
        let [x, y, z] = parts.as_slice() else {
            let message = format!("`{attribute}` has three numbers, but here are {}", parts.len());
            self.error(span, message, None);
            return None;
        };
        let [x, y, z] = [x, y, z].map(|part| self.parse(part, span.clone()));
        Some(([x?, y?, z?], span))
    }

    /// A number as a parameter, with what mbint's own attribute says of it.
    fn parameter(
        &self,
        at: Option<Element>,
        own: &str,
        name: String,
        (value, span): (f64, Span),
        unit: &'static str,
    ) -> Number {
        let attribute = at.and_then(|element| element.attribute_node((NAMESPACE, own)));
        let uncertain = attribute.map(|attribute| {
            let range = attribute.range_value();
            (attribute.value().to_owned(), self.start + range.start..self.start + range.end)
        });
        Number { name, value, unit, span, uncertain }
    }

    /// Says which of mbint's own attributes an element cannot have.
    fn check_own(&mut self, at: Option<Element>, known: &[&str]) {
        let Some(element) = at else { return };
        for attribute in element.attributes().filter(|attribute| attribute.namespace() == Some(NAMESPACE)) {
            if !known.contains(&attribute.name()) {
                let range = attribute.range();
                let message = format!("`<{}>` has no number `{}`", element.tag_name().name(), clip(attribute.name()));
                let help = suggest::help(attribute.name(), "numbers of it", known.iter().copied());
                self.error(self.start + range.start..self.start + range.end, message, help);
            }
        }
    }

    fn origin(&mut self, at: Option<Element>, prefix: &str) -> Option<Origin> {
        const XYZ: [&str; 3] = ["x", "y", "z"];
        const RPY: [&str; 3] = ["roll", "pitch", "yaw"];
        self.check_own(at, &[XYZ, RPY].concat());
        let xyz = self.three(at, "xyz", [0.0; 3]);
        let rpy = self.three(at, "rpy", [0.0; 3]);
        let (xyz, rpy) = (xyz?, rpy?);
        let numbers = |names: [&str; 3], (values, span): ([f64; 3], Span), unit: &'static str| {
            std::array::from_fn(|i| {
                let name = format!("{prefix}.{}", names[i]);
                self.parameter(at, names[i], name, (values[i], span.clone()), unit)
            })
        };
        Some(Origin { xyz: numbers(XYZ, xyz, "m"), rpy: numbers(RPY, rpy, "rad") })
    }

    fn inertial(&mut self, link: Element, name: &str) -> Option<Inertial> {
        const INERTIA: [(&str, &str); 6] =
            [("ixx", "xx"), ("iyy", "yy"), ("izz", "zz"), ("ixy", "xy"), ("ixz", "xz"), ("iyz", "yz")];
        let element = child(link, "inertial")?;
        let origin = self.origin(child(element, "origin"), &format!("link.{name}.com"));
        let mass = child(element, "mass");
        if mass.is_none() {
            self.error(self.tag(element), format!("the inertial of link `{name}` needs a `<mass>`"), None);
        }
        self.check_own(mass, &["mass"]);
        let value = self.number(mass, "value", None);
        let inertia = child(element, "inertia");
        self.check_own(inertia, &INERTIA.map(|(_, own)| own));
        let tensor = INERTIA.map(|(attribute, own)| {
            let needed = inertia.is_some() && matches!(attribute, "ixx" | "iyy" | "izz");
            let number = self.number(inertia, attribute, (!needed).then_some(0.0))?;
            Some(self.parameter(inertia, own, format!("link.{name}.inertia.{own}"), number, "kg*m^2"))
        });
        let (mass_number, tensor) = (value?, tensor.into_iter().collect::<Option<Vec<_>>>()?);
        if mass_number.0 < 0.0 {
            let message = format!("the mass of link `{name}` is negative");
            self.error(mass_number.1.clone(), message, None);
        }
        if inertia.is_none() && mass_number.0 > 0.0 {
            let message = format!("link `{name}` has a mass, but no inertia");
            self.diagnostics.push(Diagnostic::warning(self.tag(element), message));
        } else {
            let numbers: Vec<f64> = tensor.iter().map(|number| number.value).collect();
            if let Some(problem) = not_physical(&numbers) {
                let at = inertia.map_or_else(|| self.tag(element), |inertia| self.tag(inertia));
                let message = format!("the inertia of link `{name}` is not that of a body: {problem}");
                self.diagnostics.push(Diagnostic::warning(at, message));
            }
        }
        let mass = self.parameter(mass, "mass", format!("link.{name}.mass"), mass_number, "kg");
        Some(Inertial { origin: origin?, mass, inertia: tensor.try_into().ok()? })
    }

    fn joint(&mut self, element: Element, name: String, links: &HashMap<&str, usize>) -> Option<Joint> {
        let words: Vec<&str> = Kind::ALL.iter().map(|(word, _)| *word).collect();
        let word = element.attribute("type");
        let kind = Kind::ALL.iter().find(|(known, _)| Some(*known) == word).map(|(_, kind)| *kind);
        if kind.is_none() {
            let span = self.value(element, "type").unwrap_or_else(|| self.tag(element));
            match word {
                Some(word) => {
                    let message = format!("`{}` is not a type of joint", clip(word));
                    self.error(span, message, suggest::help(word, "types", words.iter().copied()));
                }
                None => {
                    let message = format!("joint `{name}` needs a `type`");
                    self.error(span, message, format!("the types are {}", suggest::list(&words)));
                }
            }
        }
        let parent = self.link(element, "parent", &name, links);
        let linked = self.link(element, "child", &name, links);
        let origin = self.origin(child(element, "origin"), &format!("joint.{name}.origin"));
        let axis = self.three(child(element, "axis"), "xyz", [1.0, 0.0, 0.0]);
        if let Some((axis, span)) = &axis
            && axis.iter().all(|part| *part == 0.0)
            && kind.is_some_and(|kind| !matches!(kind, Kind::Fixed | Kind::Floating))
        {
            self.error(span.clone(), format!("the axis of joint `{name}` has no direction"), None);
        }
        let kind = kind?;
        let units =
            if kind.turns() { ["N*m*s/rad", "N*m", "rad", "N*m", "rad/s"] } else { ["N*s/m", "N", "m", "N", "m/s"] };
        let dynamics = child(element, "dynamics");
        self.check_own(dynamics, &["damping", "friction"]);
        let [damping, friction] = ["damping", "friction"].map(|attribute| {
            let number = self.number(dynamics, attribute, Some(0.0))?;
            if number.0 < 0.0 {
                self.error(number.1.clone(), format!("the {attribute} of joint `{name}` is negative"), None);
            }
            let unit = units[usize::from(attribute == "friction")];
            Some(self.parameter(dynamics, attribute, format!("joint.{name}.{attribute}"), number, unit))
        });
        let limit = child(element, "limit");
        let limits = limit.map(|_| self.limits(limit, &name, units));
        let limits = match limits {
            Some(limits) => Some(limits?),
            None => None,
        };
        if let Some(Limits { lower, upper, .. }) = &limits
            && lower.value > upper.value
        {
            self.error(lower.span.clone(), format!("the limits of joint `{name}` are reversed"), None);
        }
        Some(Joint {
            span: self.tag(element),
            name,
            kind,
            parent: parent?,
            child: linked?,
            origin: origin?,
            axis: axis?.0,
            damping: damping?,
            friction: friction?,
            limits,
            mimic: None,
        })
    }

    fn limits(&mut self, at: Option<Element>, name: &str, units: [&'static str; 5]) -> Option<Limits> {
        const NAMES: [&str; 4] = ["lower", "upper", "effort", "velocity"];
        self.check_own(at, &NAMES);
        let numbers: [Option<Number>; 4] = std::array::from_fn(|i| {
            let number = self.number(at, NAMES[i], Some(0.0))?;
            let unit = [units[2], units[2], units[3], units[4]][i];
            Some(self.parameter(at, NAMES[i], format!("joint.{name}.limit.{}", NAMES[i]), number, unit))
        });
        let [lower, upper, effort, velocity] = numbers;
        Some(Limits { lower: lower?, upper: upper?, effort: effort?, velocity: velocity? })
    }

    /// The link at an end of a joint.
    fn link(&mut self, joint: Element, end: &str, name: &str, links: &HashMap<&str, usize>) -> Option<usize> {
        let found = child(joint, end).and_then(|element| Some((element, element.attribute("link")?)));
        let Some((element, written)) = found else {
            self.error(self.tag(joint), format!("joint `{name}` needs `<{end} link=\"…\"/>`"), None);
            return None;
        };
        let link = links.get(written).copied();
        if link.is_none() {
            let span = self.value(element, "link")?;
            let help = suggest::help(written, "links", links.keys().copied());
            self.error(span, format!("unknown link `{}`", clip(written)), help);
        }
        link
    }

    fn mimic(&mut self, element: Element, index: usize, joints: &HashMap<&str, usize>) -> Option<Mimic> {
        let Some(written) = element.attribute("joint") else {
            self.error(self.tag(element), "`<mimic>` needs `joint`", None);
            return None;
        };
        let joint = joints.get(written).copied().filter(|joint| *joint != index);
        if joint.is_none() {
            let help = suggest::help(written, "joints", joints.keys().copied());
            self.error(self.value(element, "joint")?, format!("no other joint is called `{}`", clip(written)), help);
        }
        let multiplier = self.number(Some(element), "multiplier", Some(1.0));
        let offset = self.number(Some(element), "offset", Some(0.0));
        Some(Mimic { joint: joint?, multiplier: multiplier?.0, offset: offset?.0 })
    }
}

fn child<'a, 'i>(element: Element<'a, 'i>, tag: &str) -> Option<Element<'a, 'i>> {
    element.children().find(|node| node.has_tag_name(tag))
}

/// Why no body has this tensor (xx, yy, zz, xy, xz, yz), if none has.
fn not_physical(tensor: &[f64]) -> Option<String> {
    let &[xx, yy, zz, xy, xz, yz] = tensor else { return None };
    let moments = nalgebra::Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz).symmetric_eigenvalues();
    let mut moments = [moments[0], moments[1], moments[2]];
    moments.sort_by(f64::total_cmp);
    // Files are written with few digits.
    let slack = 1e-3 * moments[2].abs();
    if moments[0] < -slack {
        return Some(format!("its smallest principal moment is {:.3e}", moments[0]));
    }
    let [small, middle, large] = moments;
    (large > small + middle + slack).then(|| {
        format!("of its principal moments {small:.3e}, {middle:.3e} and {large:.3e} the largest exceeds the sum of the others")
    })
}
