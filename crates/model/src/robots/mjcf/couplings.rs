//! Equalities and fixed tendons; actuators are in `actuators`.

use std::collections::{HashMap, HashSet};

use super::document::{Attribute, Item};
use super::flags::on;
use super::robot::{At, Body, Coupling, Equality, Length, Names, Robot, Tendon};
use super::values::Values;
use crate::robots::algebra::{self, Pose, Value};
use crate::robots::names;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest::{self, clip};

/// Reads the elements that couple and drive the joints of a robot whose bodies are read. Of an attached model, whose
/// names have a prefix, only those that name nothing outside the attached part.
pub fn read(root: &Item, values: &mut Values, robot: &mut Robot, names: &Names, attached: Option<&str>) {
    let taken = robot.equalities.iter().map(|own| &own.name).chain(robot.tendons.iter().map(|own| &own.name));
    let taken = taken.chain(robot.actuators.iter().map(|own| &own.name)).cloned().collect();
    let prefix = attached.unwrap_or("");
    let mut reader = CouplingReader { values, robot, names, prefix, tendons: HashMap::new(), taken };
    let flags = reader.values.settings.flags;
    let acts = |tag: &str| match tag {
        "equality" => flags.equalities,
        "actuator" => flags.actuators,
        _ => true,
    };
    for section in ["tendon", "equality", "actuator"] {
        for item in root.of(section).filter(|_| acts(section)).flat_map(|section| &section.items) {
            if attached.is_some() && !reader.is_attached(item) {
                continue;
            }
            match section {
                "tendon" => reader.tendon(item),
                "equality" => {
                    reader.equality(item);
                }
                _ => {
                    reader.actuator(item);
                }
            }
        }
    }
}

pub struct CouplingReader<'r, 'i, 'd> {
    pub values: &'r mut Values<'i, 'd>,
    pub robot: &'r mut Robot,
    names: &'r Names,
    prefix: &'r str,
    /// Tendons by the names of the file.
    tendons: HashMap<String, usize>,
    taken: HashSet<String>,
}

impl CouplingReader<'_, '_, '_> {
    pub fn name(&mut self, item: &Item, otherwise: String) -> String {
        let written = item.get("name").map_or(otherwise, |name| format!("{}{}", self.prefix, name.value));
        names::in_formulas(&written, &mut self.taken)
    }

    /// Whether everything that an element names is there.
    fn is_attached(&self, item: &Item) -> bool {
        let has = |attribute: &Attribute| {
            let name = format!("{}{}", self.prefix, attribute.value);
            match attribute.name.as_str() {
                "joint" | "jointinparent" | "joint1" | "joint2" => self.names.joints.contains_key(&name),
                "body1" | "body2" => attribute.value == "world" || self.names.bodies.contains_key(&name),
                "site1" | "site2" => self.names.sites.contains_key(&name),
                "tendon" | "tendon1" | "tendon2" => self.tendons.contains_key(&name),
                _ => true,
            }
        };
        item.attributes.iter().all(has) && item.items.iter().all(|inner| self.is_attached(inner))
    }

    /// Finds the object that an attribute names; reports an unknown name.
    fn found<T: Copy>(&mut self, attribute: &Attribute, what: &str, known: &HashMap<String, T>) -> Option<T> {
        let found = known.get(&format!("{}{}", self.prefix, attribute.value)).copied();
        if found.is_none() {
            let help = suggest::help(&attribute.value, what, known.keys().map(String::as_str));
            let singular = what.strip_suffix('s').map_or_else(|| what.to_owned(), |word| word.replace("bodie", "body"));
            let message = format!("unknown {singular} `{}`", clip(&attribute.value));
            self.values
                .diagnostics
                .push(Diagnostic::error(Code::UnknownName, attribute.span.clone(), message).help(help));
        }
        found
    }

    /// A joint of one coordinate.
    pub fn joint(&mut self, attribute: &Attribute) -> Option<usize> {
        let names = self.names;
        let joint = self.found(attribute, "joints", &names.joints)?;
        if self.robot.joints[joint].is_single() {
            return Some(joint);
        }
        let message = format!("joint `{}` has more than one coordinate", clip(&attribute.value));
        self.values.error(
            Code::UnsuitableJoint,
            attribute.span.clone(),
            message,
            "only hinges and slides can stand here".to_owned(),
        );
        None
    }

    pub fn needs(&mut self, item: &Item, names: &str) {
        self.values.error(Code::MissingXml, item.span.clone(), format!("`<{}>` needs {names}", item.tag), None);
    }

    fn tendon(&mut self, item: &Item) {
        let name = self.name(item, format!("tendon_{}", self.robot.tendons.len()));
        if let Some(written) = item.get("name") {
            self.tendons.insert(format!("{}{}", self.prefix, written.value), self.robot.tendons.len());
        }
        let mut terms = Vec::new();
        for term in item.of("joint") {
            let (Some(joint), Some(coefficient)) = (term.get("joint"), term.get("coef")) else {
                self.needs(term, "`joint` and `coef`");
                continue;
            };
            let joint = self.joint(joint);
            if let (Some(joint), Some([coefficient])) = (joint, self.values.exact(coefficient)) {
                terms.push((joint, coefficient));
            }
        }
        let reference: f64 =
            terms.iter().map(|&(joint, by): &(usize, f64)| by * self.robot.joints[joint].reference).sum();
        let class = self.values.class_of(item, None, "class");
        let flags = self.values.settings.flags;
        let mut number = |key: &str, acts: bool| {
            let found = self.values.get(item, class, &["tendon"], key);
            let value = found.and_then(|found| self.values.exact::<1>(found)).map_or(0.0, |[value]| on(acts) * value);
            self.values.number(item, found, format!("tendon.{name}.{key}"), value, "")
        };
        let (stiffness, damping) = (number("stiffness", flags.springs), number("damping", flags.dampers));
        let friction = number("frictionloss", flags.friction);
        let ends = self.values.get(item, class, &["tendon"], "springlength");
        let ends = ends.and_then(|found| self.values.parsed(found, 2)).unwrap_or_else(|| vec![-1.0]);
        // A length of −1 is that in the file's configuration.
        let slack = match ends.as_slice() {
            [both] if *both < 0.0 => [0.0; 2],
            [both] => [both - reference; 2],
            ends if ends[0] < 0.0 => [0.0; 2],
            ends => [ends[0] - reference, ends[1] - reference],
        };
        self.robot.tendons.push(Tendon {
            name,
            span: item.span.clone(),
            length: Length { terms },
            stiffness,
            damping,
            friction,
            slack,
        });
    }

    fn equality(&mut self, item: &Item) -> Option<()> {
        let yes = [("true", true), ("false", false)];
        if self.values.choice(item, "active", &yes) == Some(false) {
            return None;
        }
        let what = match item.tag.as_str() {
            "connect" => Coupling::Connect(self.connect(item)?),
            "weld" => Coupling::Weld(self.weld(item)?),
            tag => self.polynomial(item, tag)?,
        };
        let name = self.name(item, format!("equality_{}", self.robot.equalities.len()));
        self.robot.equalities.push(Equality { name, span: item.span.clone(), what });
        Some(())
    }

    /// Two sites, where they are given.
    fn sites(&mut self, item: &Item) -> Option<Option<[At; 2]>> {
        let (Some(first), Some(second)) = (item.get("site1"), item.get("site2")) else { return Some(None) };
        let names = self.names;
        let places = [first, second].map(|site| self.found(site, "sites", &names.sites));
        let [first, second] = places.map(|place| {
            let (body, site) = place?;
            let site = &self.robot.bodies[body].sites[site];
            Some(At { body, position: site.position, rotation: site.rotation.clone() })
        });
        Some(Some([first?, second?]))
    }

    /// Two bodies, the second the world if it is not given.
    fn bodies(&mut self, item: &Item) -> Option<[usize; 2]> {
        let Some(first) = item.get("body1") else {
            self.needs(item, "`body1`, or `site1` and `site2`");
            return None;
        };
        let names = self.names;
        let mut body = |attribute: &Attribute| match attribute.value.as_str() {
            "world" => Some(0),
            _ => self.found(attribute, "bodies", &names.bodies),
        };
        Some([body(first)?, item.get("body2").map_or(Some(0), body)?])
    }

    fn connect(&mut self, item: &Item) -> Option<[At; 2]> {
        if let Some(sites) = self.sites(item)? {
            return Some(sites);
        }
        let [first, second] = self.bodies(item)?;
        let Some(anchor) = item.get("anchor") else {
            self.needs(item, "`anchor`");
            return None;
        };
        let anchor = self.values.exact::<3>(anchor)?;
        let here = Pose { position: algebra::vector(anchor), rotation: algebra::identity() };
        Some([
            At { body: first, position: anchor, rotation: algebra::identity() },
            self.seen_from(first, &here, second),
        ])
    }

    /// A frame on one body, in the file's configuration, on another.
    fn seen_from(&self, body: usize, frame: &Pose, other: usize) -> At {
        let world = |body: usize| {
            let mut pose = Pose::identity();
            let mut next = body;
            while next != 0 {
                let Body { position, rotation, parent, .. } = &self.robot.bodies[next];
                let here =
                    Pose { position: position.each_ref().map(|x| Value::Number(x.value)), rotation: rotation.clone() };
                pose = here.then(&pose.position, &pose.rotation);
                next = *parent;
            }
            pose
        };
        let in_world = world(body).then(&frame.position, &frame.rotation);
        let there = world(other);
        let back = algebra::inverse(&there.rotation);
        let apart: algebra::Vector = std::array::from_fn(|i| algebra::sub(&in_world.position[i], &there.position[i]));
        let position = algebra::numbers(&algebra::rotate(&back, &apart)).unwrap_or_default();
        At { body: other, position, rotation: algebra::product(&back, &in_world.rotation) }
    }

    fn weld(&mut self, item: &Item) -> Option<[At; 2]> {
        if let Some(sites) = self.sites(item)? {
            return Some(sites);
        }
        let [first, second] = self.bodies(item)?;
        let anchor = item.get("anchor").and_then(|found| self.values.exact::<3>(found)).unwrap_or([0.0; 3]);
        let relative = item.get("relpose").and_then(|found| self.values.exact::<7>(found));
        let here = At { body: second, position: anchor, rotation: algebra::identity() };
        let frame = Pose { position: algebra::vector(anchor), rotation: algebra::identity() };
        let there = match relative {
            // Where the second body is in the frame of the first; a quaternion of zeros is the file's configuration.
            Some([x, y, z, q @ ..]) if q != [0.0; 4] => {
                let length = q.iter().map(|part| part * part).sum::<f64>().sqrt();
                let second =
                    Pose { position: algebra::vector([x, y, z]), rotation: q.map(|part| Value::Number(part / length)) };
                let pose = second.then(&frame.position, &frame.rotation);
                At {
                    body: first,
                    position: algebra::numbers(&pose.position).unwrap_or_default(),
                    rotation: pose.rotation,
                }
            }
            _ => self.seen_from(second, &frame, first),
        };
        Some([there, here])
    }

    fn polynomial(&mut self, item: &Item, tag: &str) -> Option<Coupling> {
        let keys = if tag == "joint" { ["joint1", "joint2"] } else { ["tendon1", "tendon2"] };
        let Some(first) = item.get(keys[0]) else {
            self.needs(item, &format!("`{}`", keys[0]));
            return None;
        };
        let mut length = |attribute: &Attribute| {
            if tag == "joint" {
                return self.joint(attribute).map(|joint| Length { terms: vec![(joint, 1.0)] });
            }
            self.tendon_length(attribute)
        };
        let first = length(first)?;
        let second = match item.get(keys[1]) {
            Some(second) => Some(length(second)?),
            None => None,
        };
        let mut coefficients = [0.0, 1.0, 0.0, 0.0, 0.0];
        if let Some(found) = item.get("polycoef") {
            let given = self.values.parsed(found, 5)?;
            coefficients[..given.len()].copy_from_slice(&given);
        }
        Some(Coupling::Polynomial { first, second, coefficients })
    }

    pub fn tendon_length(&mut self, attribute: &Attribute) -> Option<Length> {
        let known = std::mem::take(&mut self.tendons);
        let found = self.found(attribute, "tendons", &known);
        self.tendons = known;
        Some(self.robot.tendons[found?].length.clone())
    }
}
