//! Equalities, fixed tendons and actuators.

use std::collections::{HashMap, HashSet};

use super::document::{Attribute, Item};
use super::flags::on;
use super::robot::{Actuator, At, Body, Coupling, Equality, Law, Length, Names, Robot, Tendon};
use super::values::Values;
use crate::model::robots::algebra::{self, Pose, Value};
use crate::model::robots::names;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest::{self, clip};

/// Reads what couples and drives the joints of a robot whose bodies are read.
pub fn read(root: &Item, values: &mut Values, robot: &mut Robot, names: &Names) {
    let mut reader = Reader { values, robot, names, tendons: HashMap::new(), taken: HashSet::new() };
    root.of("tendon").flat_map(|section| section.of("fixed")).for_each(|item| reader.tendon(item));
    let flags = reader.values.settings.flags;
    root.of("equality").filter(|_| flags.equalities).flat_map(|section| &section.items).for_each(|item| {
        reader.equality(item);
    });
    root.of("actuator").filter(|_| flags.actuators).flat_map(|section| &section.items).for_each(|item| {
        reader.actuator(item);
    });
}

struct Reader<'r, 'i, 'd> {
    values: &'r mut Values<'i, 'd>,
    robot: &'r mut Robot,
    names: &'r Names,
    /// By the names of the file.
    tendons: HashMap<String, usize>,
    taken: HashSet<String>,
}

impl Reader<'_, '_, '_> {
    fn name(&mut self, item: &Item, otherwise: String) -> String {
        let written = item.get("name").map_or(otherwise, |name| name.value.clone());
        names::in_formulas(&written, &mut self.taken)
    }

    /// What an attribute names.
    fn found<T: Copy>(&mut self, attribute: &Attribute, what: &str, known: &HashMap<String, T>) -> Option<T> {
        let found = known.get(&attribute.value).copied();
        if found.is_none() {
            let help = suggest::help(&attribute.value, what, known.keys().map(String::as_str));
            let singular = what.strip_suffix('s').map_or_else(|| what.to_owned(), |word| word.replace("bodie", "body"));
            let message = format!("unknown {singular} `{}`", clip(&attribute.value));
            self.values.diagnostics.push(Diagnostic::error(attribute.span.clone(), message).help(help));
        }
        found
    }

    /// A joint of one coordinate.
    fn joint(&mut self, attribute: &Attribute) -> Option<usize> {
        let names = self.names;
        let joint = self.found(attribute, "joints", &names.joints)?;
        if self.robot.joints[joint].is_single() {
            return Some(joint);
        }
        let message = format!("joint `{}` has more than one coordinate", clip(&attribute.value));
        self.values.error(attribute.span.clone(), message, "only hinges and slides can stand here".to_owned());
        None
    }

    fn needs(&mut self, item: &Item, names: &str) {
        self.values.error(item.span.clone(), format!("`<{}>` needs {names}", item.tag), None);
    }

    fn tendon(&mut self, item: &Item) {
        let name = self.name(item, format!("tendon_{}", self.robot.tendons.len()));
        if let Some(written) = item.get("name") {
            self.tendons.insert(written.value.clone(), self.robot.tendons.len());
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

    /// Two bodies, the second the world where it is not given.
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

    fn tendon_length(&mut self, attribute: &Attribute) -> Option<Length> {
        let known = std::mem::take(&mut self.tendons);
        let found = self.found(attribute, "tendons", &known);
        self.tendons = known;
        Some(self.robot.tendons[found?].length.clone())
    }

    fn actuator(&mut self, item: &Item) -> Option<()> {
        let name = self.name(item, format!("actuator_{}", self.robot.actuators.len()));
        let class = self.values.class_of(item, None, "class");
        let tags = [item.tag.as_str(), "general"];
        let get = |values: &Values, key: &str| {
            let found = values.get(item, class, &tags, key)?;
            Some(Attribute {
                name: found.name.clone(),
                value: found.value.clone(),
                span: found.span.clone(),
                own: false,
            })
        };
        let on =
            match (get(self.values, "joint").or_else(|| get(self.values, "jointinparent")), get(self.values, "tendon"))
            {
                (Some(joint), _) => Length { terms: vec![(self.joint(&joint)?, 1.0)] },
                (None, Some(tendon)) => self.tendon_length(&tendon)?,
                (None, None) => {
                    self.needs(item, "`joint` or `tendon`");
                    return None;
                }
            };
        let offset = on.terms.iter().map(|&(joint, by)| by * self.robot.joints[joint].reference).sum();
        let law = self.law(item, &get, &name)?;
        let gear = get(self.values, "gear");
        let first = gear.as_ref().and_then(|found| self.values.parsed(found, 6)).map_or(1.0, |gear| gear[0]);
        let gear = self.values.number(item, gear.as_ref(), format!("actuator.{name}.gear"), first, "");
        let control = self.range(item, &get, "ctrlrange", "ctrllimited");
        let control = control.filter(|_| self.values.settings.flags.clamps_controls);
        let force = self.range(item, &get, "forcerange", "forcelimited");
        self.robot.actuators.push(Actuator { name, span: item.span.clone(), on, offset, gear, law, control, force });
        Some(())
    }

    fn law(&mut self, item: &Item, get: &dyn Fn(&Values, &str) -> Option<Attribute>, name: &str) -> Option<Law> {
        let values = &mut *self.values;
        let list = |values: &mut Values, key: &str, default: f64| {
            let given = get(values, key).and_then(|found| values.parsed(&found, 10));
            given.unwrap_or_else(|| vec![default])
        };
        let number = |values: &mut Values, key: &str, default: f64| {
            let value = list(values, key, default)[0];
            values.number(item, get(values, key).as_ref(), format!("actuator.{name}.{key}"), value, "")
        };
        Some(match item.tag.as_str() {
            "motor" => Law::Affine { gain: 1.0, bias: [0.0; 3] },
            "position" => Law::Position { kp: number(values, "kp", 1.0), kv: number(values, "kv", 0.0) },
            "velocity" => Law::Velocity { kv: number(values, "kv", 1.0) },
            "damper" => Law::Damper { kv: number(values, "kv", 1.0) },
            _ => {
                let mut plain = |key: &str, words: &[(&str, bool)]| match get(values, key) {
                    Some(found) => values.word(&found, words),
                    None => Some(false),
                };
                plain("dyntype", &[("none", false)])?;
                plain("gaintype", &[("fixed", false)])?;
                let is_affine = plain("biastype", &[("none", false), ("affine", true)])?;
                let (gain, bias) = (list(values, "gainprm", 1.0)[0], list(values, "biasprm", 0.0));
                let at = |place: usize| bias.get(place).copied().filter(|_| is_affine).unwrap_or(0.0);
                Law::Affine { gain, bias: [at(0), at(1), at(2)] }
            }
        })
    }

    /// A range that holds.
    fn range(
        &mut self,
        item: &Item,
        get: &dyn Fn(&Values, &str) -> Option<Attribute>,
        key: &str,
        limited: &str,
    ) -> Option<[f64; 2]> {
        let words = [("true", Some(true)), ("false", Some(false)), ("auto", None)];
        let limited = get(self.values, limited).and_then(|found| self.values.word(&found, &words)).flatten();
        let ends = get(self.values, key).and_then(|found| self.values.exact::<2>(&found));
        let holds = limited.unwrap_or(self.values.settings.autolimits && ends.is_some());
        let ends = ends.filter(|_| holds)?;
        if ends[0] >= ends[1] {
            self.values.error(item.span.clone(), format!("the ends of `{key}` are reversed"), None);
        }
        Some(ends)
    }
}
