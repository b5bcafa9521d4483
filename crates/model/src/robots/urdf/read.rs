//! URDF text → [`Robot`].
//!
//! The text is parsed with locations ([`xml`](crate::robots::xml)) and checked ([`check`](super::check)); urdf-rs
//! reads the values; and the remaining checks are relations of values: names, masses, axes, and that links and joints
//! are one tree.

use std::collections::{HashMap, HashSet};

use urdf_rs::JointType;

use super::robot::{Inertial, Joint, Limits, Link, Mimic, Origin, Robot, UrdfJointType};
use super::visual::Visuals;
use super::{check, tree};
use crate::robots::names;
use crate::robots::number::Number;
use crate::robots::xml::{EXPAND, Element, NAMESPACE, XmlSpans, child, children, parse, plain};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};

/// Reads the text, which begins at an offset of the sources; reports everything that is wrong with it.
pub fn read(text: &str, start: usize, diagnostics: &mut Diagnostics) -> Option<Robot> {
    let before = diagnostics.errors();
    let mut held = String::new();
    let (document, places) = parse(text, &mut held, start, "a URDF", diagnostics)?;
    let root = document.root_element();
    let mut reader = Reader { places, diagnostics };
    reader.is_urdf(root).then_some(())?;
    let checked = check::rewrite(root, places, reader.diagnostics);
    let values = match urdf_rs::read_from_string(&checked) {
        Ok(values) => values,
        Err(error) => {
            reader.error(
                Code::BadXml,
                places.tag(root),
                format!("urdf-rs cannot read this file: {}", clip(&error.to_string())),
                None,
            );
            return None;
        }
    };
    let mut robot = reader.robot(root, &values)?;
    // Where something is missing because of an error, the links are no tree either.
    (reader.diagnostics.errors() == before && tree::order(&mut robot, reader.diagnostics)).then_some(robot)
}

struct Reader<'d> {
    places: XmlSpans,
    diagnostics: &'d mut Diagnostics,
}

/// An element, if it is there, with the beginning of its numbers' names.
#[derive(Clone, Copy)]
struct Numbers<'a, 'i, 'p> {
    places: XmlSpans,
    element: Option<Element<'a, 'i>>,
    prefix: &'p str,
}

impl Numbers<'_, '_, '_> {
    /// A value as a parameter, with the text of mbint's own attribute for it. It stands in `attribute`.
    fn number(&self, attribute: &str, name: &str, value: f64, unit: &'static str) -> Number {
        let span = self.element.map_or(0..0, |element| self.places.value_or_tag(element, attribute));
        let own = self.element.and_then(|element| element.attribute_node((NAMESPACE, name)));
        let uncertain = own.map(|own| (own.value().to_owned(), self.places.value(own)));
        Number { name: format!("{}.{name}", self.prefix), value, unit, span, uncertain }
    }
}

impl Reader<'_> {
    fn error(&mut self, code: Code, span: Span, message: impl Into<String>, help: impl Into<Option<String>>) {
        self.diagnostics.push(Diagnostic::error(code, span, message).help(help));
    }

    fn warn(&mut self, span: Span, message: String) {
        self.diagnostics.push(Diagnostic::warning(Code::MasslessLink, span, message));
    }

    fn is_urdf(&mut self, root: Element) -> bool {
        if root.tag_name().name() != "robot" {
            let message = format!("a URDF is a `<robot>`, but here is `<{}>`", clip(root.tag_name().name()));
            self.error(Code::WrongRobot, self.places.tag(root), message, None);
            return false;
        }
        let of_xacro = |node: &Element| node.tag_name().namespace().is_some_and(|uri| uri.contains("xacro"));
        let found = root.descendants().filter(Element::is_element).find(of_xacro);
        if let Some(found) = found {
            self.error(Code::WrongRobot, self.places.tag(found), "this is xacro, not yet URDF", EXPAND.to_owned());
        }
        found.is_none()
    }

    /// The links and joints, which stand in `values` in the order of the file.
    fn robot(&mut self, root: Element, values: &urdf_rs::Robot) -> Option<Robot> {
        let mut robot = Robot { name: values.name.clone(), ..Robot::default() };
        let mut taken = HashSet::new();
        let mut links = HashMap::new();
        let visuals = Visuals::of(root);
        for (element, link) in children(root, "link").zip(&values.links) {
            let Some(name) = self.name(element, "link", &link.name, &mut taken) else { continue };
            if links.insert(link.name.as_str(), robot.links.len()).is_some() {
                self.error(
                    Code::NameTaken,
                    self.places.tag(element),
                    format!("a second link is called `{}`", clip(&link.name)),
                    None,
                );
            }
            let inertial = child(element, "inertial").and_then(|found| self.inertial(found, &link.inertial, &name));
            let visuals = visuals.link(element);
            robot.links.push(Link { name, span: self.places.tag(element), inertial, visuals });
        }
        if robot.links.is_empty() {
            self.error(Code::MissingXml, self.places.tag(root), "a robot needs at least one link", None);
            return None;
        }
        let mut taken = HashSet::new();
        let mut joints = HashMap::new();
        let mut mimics = Vec::new();
        for (element, joint) in children(root, "joint").zip(&values.joints) {
            let Some(name) = self.name(element, "joint", &joint.name, &mut taken) else { continue };
            let Some(found) = self.joint(element, joint, name, &links) else { continue };
            if joints.insert(joint.name.as_str(), robot.joints.len()).is_some() {
                self.error(
                    Code::NameTaken,
                    self.places.tag(element),
                    format!("a second joint is called `{}`", clip(&joint.name)),
                    None,
                );
            }
            if let (Some(mimic), Some(place)) = (&joint.mimic, child(element, "mimic")) {
                mimics.push((robot.joints.len(), place, mimic));
            }
            robot.joints.push(found);
        }
        for (index, element, mimic) in mimics {
            robot.joints[index].mimic = self.mimic(element, mimic, index, &joints);
        }
        Some(robot)
    }

    /// A name as formulas can have it.
    fn name(&mut self, element: Element, what: &str, written: &str, taken: &mut HashSet<String>) -> Option<String> {
        if written.trim().is_empty() {
            self.error(Code::MissingXml, self.places.tag(element), format!("a {what} needs a `name`"), None);
            return None;
        }
        Some(names::in_formulas(written, taken))
    }

    fn origin(&self, within: Element, pose: &urdf_rs::Pose, prefix: &str) -> Origin {
        let element = child(within, "origin");
        let numbers = Numbers { places: self.places, element, prefix };
        let turned = if element.is_some_and(|found| plain(found, "rpy").is_some()) { "rpy" } else { "quat_xyzw" };
        let part = |attribute: &str, names: [&str; 3], values: [f64; 3], unit| {
            std::array::from_fn(|i| numbers.number(attribute, names[i], values[i], unit))
        };
        Origin {
            xyz: part("xyz", ["x", "y", "z"], *pose.xyz, "m"),
            rpy: part(turned, ["roll", "pitch", "yaw"], *pose.rpy, "rad"),
        }
    }

    fn inertial(&mut self, element: Element, values: &urdf_rs::Inertial, name: &str) -> Option<Inertial> {
        let origin = self.origin(element, &values.origin, &format!("link.{name}.com"));
        let Some(found) = child(element, "mass") else {
            self.error(
                Code::MissingXml,
                self.places.tag(element),
                format!("the inertial of link `{name}` needs a `<mass>`"),
                None,
            );
            return None;
        };
        let mass = values.mass.value;
        if mass < 0.0 {
            let span = self.places.value_or_tag(found, "value");
            self.error(Code::BadXmlValue, span, format!("the mass of link `{name}` is negative"), None);
        }
        let prefix = format!("link.{name}");
        let mass_number = Numbers { places: self.places, element: Some(found), prefix: &prefix };
        let mass_number = mass_number.number("value", "mass", mass, "kg");
        let urdf_rs::Inertia { ixx, ixy, ixz, iyy, iyz, izz } = values.inertia;
        let inertia = child(element, "inertia");
        let place = self.places.tag(inertia.unwrap_or(element));
        if inertia.is_none() && mass > 0.0 {
            self.warn(place, format!("link `{name}` has a mass, but no inertia"));
        } else if let Some(problem) = not_physical([ixx, iyy, izz, ixy, ixz, iyz]) {
            self.warn(place, format!("the inertia of link `{name}` is not that of a body: {problem}"));
        }
        let prefix = format!("link.{name}.inertia");
        let numbers = Numbers { places: self.places, element: inertia, prefix: &prefix };
        let number = |attribute: &str, value| numbers.number(attribute, &attribute[1..], value, "kg*m^2");
        let inertia = [
            number("ixx", ixx),
            number("iyy", iyy),
            number("izz", izz),
            number("ixy", ixy),
            number("ixz", ixz),
            number("iyz", iyz),
        ];
        Some(Inertial { origin, mass: mass_number, inertia })
    }

    fn joint(
        &mut self,
        element: Element,
        values: &urdf_rs::Joint,
        name: String,
        links: &HashMap<&str, usize>,
    ) -> Option<Joint> {
        if plain(element, "type").is_none() {
            let help = format!("the types are {}", suggest::list(&UrdfJointType::WORDS));
            self.error(Code::MissingXml, self.places.tag(element), format!("joint `{name}` needs a `type`"), help);
        }
        let kind = match values.joint_type {
            JointType::Revolute => UrdfJointType::Revolute,
            JointType::Continuous => UrdfJointType::Continuous,
            JointType::Prismatic => UrdfJointType::Prismatic,
            JointType::Floating => UrdfJointType::Floating,
            JointType::Planar => UrdfJointType::Planar,
            // The check before lets no other type pass.
            JointType::Fixed | JointType::Spherical => UrdfJointType::Fixed,
        };
        let parent = self.link(element, "parent", &values.parent.link, &name, links);
        let linked = self.link(element, "child", &values.child.link, &name, links);
        let axis = *values.axis.xyz;
        if axis == [0.0; 3] && !matches!(kind, UrdfJointType::Fixed | UrdfJointType::Floating) {
            let found = child(element, "axis").unwrap_or(element);
            let span = self.places.value_or_tag(found, "xyz");
            self.error(Code::ZeroDirection, span, format!("the axis of joint `{name}` has no direction"), None);
        }
        let units = if kind.turns() { ["N*m*s/rad", "N*m", "rad", "rad/s"] } else { ["N*s/m", "N", "m", "m/s"] };
        let prefix = format!("joint.{name}");
        let numbers = Numbers { places: self.places, element: child(element, "dynamics"), prefix: &prefix };
        let dynamics = values.dynamics.clone().unwrap_or_default();
        for (what, value) in [("damping", dynamics.damping), ("friction", dynamics.friction)] {
            if let (true, Some(found)) = (value < 0.0, numbers.element) {
                let span = self.places.value_or_tag(found, what);
                self.error(Code::BadXmlValue, span, format!("the {what} of joint `{name}` is negative"), None);
            }
        }
        let limits = child(element, "limit").map(|found| self.limits(found, &values.limit, &prefix, units));
        Some(Joint {
            span: self.places.tag(element),
            kind,
            parent: parent?,
            child: linked?,
            origin: self.origin(element, &values.origin, &format!("{prefix}.origin")),
            axis,
            damping: numbers.number("damping", "damping", dynamics.damping, units[0]),
            friction: numbers.number("friction", "friction", dynamics.friction, units[1]),
            limits,
            mimic: None,
            name,
        })
    }

    /// Limits that are finite; urdf-rs gives the others as infinite, by the rules of the file's version.
    fn limits(&self, limit: Element, values: &urdf_rs::JointLimit, joint: &str, units: [&'static str; 4]) -> Limits {
        let prefix = format!("{joint}.limit");
        let numbers = Numbers { places: self.places, element: Some(limit), prefix: &prefix };
        let number = |name: &str, value: f64, unit| value.is_finite().then(|| numbers.number(name, name, value, unit));
        let [_, force, position, velocity] = units;
        Limits {
            lower: number("lower", values.lower, position),
            upper: number("upper", values.upper, position),
            effort: number("effort", values.effort, force),
            velocity: number("velocity", values.velocity, velocity),
        }
    }

    /// The link at an end of a joint.
    fn link(
        &mut self,
        joint: Element,
        end: &'static str,
        written: &str,
        name: &str,
        links: &HashMap<&str, usize>,
    ) -> Option<usize> {
        let Some(element) = child(joint, end).filter(|element| plain(*element, "link").is_some()) else {
            self.error(
                Code::MissingXml,
                self.places.tag(joint),
                format!("joint `{name}` needs `<{end} link=\"…\"/>`"),
                None,
            );
            return None;
        };
        let link = links.get(written).copied();
        if link.is_none() {
            let span = self.places.value_or_tag(element, "link");
            let help = suggest::help(written, "links", links.keys().copied());
            self.error(Code::UnknownName, span, format!("unknown link `{}`", clip(written)), help);
        }
        link
    }

    fn mimic(
        &mut self,
        element: Element,
        values: &urdf_rs::Mimic,
        index: usize,
        joints: &HashMap<&str, usize>,
    ) -> Option<Mimic> {
        if plain(element, "joint").is_none() {
            self.error(Code::MissingXml, self.places.tag(element), "`<mimic>` needs `joint`", None);
            return None;
        }
        let joint = joints.get(values.joint.as_str()).copied().filter(|joint| *joint != index);
        if joint.is_none() {
            let help = suggest::help(&values.joint, "joints", joints.keys().copied());
            let message = format!("no other joint is called `{}`", clip(&values.joint));
            self.error(Code::UnknownName, self.places.value_or_tag(element, "joint"), message, help);
        }
        let (multiplier, offset) = (values.multiplier.unwrap_or(1.0), values.offset.unwrap_or(0.0));
        Some(Mimic { joint: joint?, multiplier, offset })
    }
}

/// Why no body has this tensor (xx, yy, zz, xy, xz, yz), if none has.
fn not_physical(tensor: [f64; 6]) -> Option<String> {
    // NaN stands for a number that is reported already; its eigenvalues would never converge.
    let [xx, yy, zz, xy, xz, yz] = tensor;
    if tensor.iter().any(|element| element.is_nan()) {
        return None;
    }
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
