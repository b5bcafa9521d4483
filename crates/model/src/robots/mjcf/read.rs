//! Elements → [`Robot`]: bodies with their frames, joints and masses. What couples and drives them is in `couplings`.

use super::couplings;
use super::document::{Attribute, Item};
use super::flags::on;
use super::geoms::{self, GeomMass};
use super::meshes;
use super::robot::{Body, Joint, Mass, MjcfType, Names, Robot, Site};
use super::springs;
use super::values::Values;
use crate::robots::algebra::{self, Pose, Quaternion};
use crate::robots::masses::MassPart;
use crate::robots::names;
use crate::robots::number::Number;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::suggest::clip;

const KINDS: [(&str, MjcfType); 4] =
    [("hinge", MjcfType::Hinge), ("slide", MjcfType::Slide), ("ball", MjcfType::Ball), ("free", MjcfType::Free)];

/// Reads everything; reports all that is wrong.
pub fn robot<'i>(root: &'i Item, values: &mut Values<'i, '_>) -> Option<Robot> {
    let before = values.diagnostics.errors();
    let world = Body {
        name: "ground".to_owned(),
        span: root.span.clone(),
        parent: 0,
        position: [0, 1, 2].map(|_| fixed(values, root, 0.0)),
        rotation: algebra::identity(),
        mass: None,
        joints: Vec::new(),
        sites: Vec::new(),
    };
    let mut robot = Robot {
        gravity: gravity(root, values),
        bodies: vec![world],
        joints: Vec::new(),
        equalities: Vec::new(),
        tendons: Vec::new(),
        actuators: Vec::new(),
    };
    let (mut names, mut touching) = (Names::default(), Vec::new());
    let whole = Whole { robot: &mut robot, names: &mut names, touching: &mut touching, copies: &mut 0 };
    let mut reader = MjcfReader { values, root, whole, prefix: String::new(), suffix: String::new() };
    for item in root.of("worldbody") {
        reader.inside(item, 0, &Around { pose: Pose::identity(), class: None }, &mut Contents::default());
    }
    if let [first, _, ..] = touching.as_slice() {
        let message = "contacts of geoms are ignored: bodies pass through each other and through the floor";
        let help = "an effect `contact` says which surfaces touch".to_owned();
        values.diagnostics.push(Diagnostic::warning(Code::ContactsIgnored, first.clone(), message).help(help));
    }
    meshes::warn(values);
    if let Some(total) = values.settings.total_mass {
        scale(&mut robot, total);
    }
    springs::set(&mut robot, values.settings.flags);
    couplings::read(root, values, &mut robot, &names, None);
    springs::damp_actuators(&mut robot);
    (values.diagnostics.errors() == before).then_some(robot)
}

/// A number that is no parameter.
fn fixed(values: &Values, item: &Item, value: f64) -> Number {
    values.number(item, None, String::new(), value, "")
}

fn gravity(root: &Item, values: &mut Values) -> [f64; 3] {
    let mut gravity = [0.0, 0.0, -9.81];
    for option in root.of("option") {
        if let Some(found) = option.get("gravity").and_then(|found| values.exact(found)) {
            gravity = found;
        }
    }
    if values.settings.flags.gravity { gravity } else { [0.0; 3] }
}

/// Context of an element.
pub struct Around {
    /// Pose of the `<frame>`s in the body.
    pub pose: Pose,
    pub class: Option<usize>,
}

/// Sources of a body's mass.
#[derive(Default)]
pub struct Contents<'i> {
    inertial: Option<&'i Item>,
    parts: Vec<MassPart>,
}

/// Destination of the data read.
pub struct Whole<'r> {
    pub robot: &'r mut Robot,
    pub names: &'r mut Names,
    /// Geoms that could touch something.
    pub touching: &'r mut Vec<Span>,
    /// Number of copies by `<replicate>` and `<attach>`.
    pub copies: &'r mut usize,
}

pub struct MjcfReader<'r, 'i, 'd> {
    pub values: &'r mut Values<'i, 'd>,
    /// The document that is read.
    pub root: &'i Item,
    pub whole: Whole<'r>,
    /// Around the names of the document.
    pub prefix: String,
    pub suffix: String,
}

impl<'i> MjcfReader<'_, 'i, '_> {
    fn refuse_second(&mut self, at: &Span, what: &str, name: &str) {
        self.values.error(Code::NameTaken, at.clone(), format!("a second {what} is called `{}`", clip(name)), None);
    }

    /// A name as it is in the whole model.
    fn written(&self, item: &Item) -> Option<String> {
        item.get("name").map(|name| format!("{}{}{}", self.prefix, name.value, self.suffix))
    }

    /// Reads the elements in a body or in a frame.
    pub fn inside(&mut self, item: &'i Item, body: usize, around: &Around, contents: &mut Contents<'i>) {
        for inner in &item.items {
            match inner.tag.as_str() {
                "body" => self.body(inner, body, around),
                "frame" => {
                    let (position, rotation) = self.values.frame(inner, None, &[]);
                    let pose = around.pose.then(&algebra::vector(position), &rotation);
                    let class = self.values.class_of(inner, around.class, "childclass");
                    self.inside(inner, body, &Around { pose, class }, contents);
                }
                "replicate" => self.replicate(inner, body, around, contents),
                "attach" => self.attach(inner, body, around, contents),
                "inertial" => contents.inertial = Some(inner),
                "joint" | "freejoint" => self.joint(inner, body, around),
                "geom" => {
                    let class = self.values.class_of(inner, around.class, "class");
                    let mask =
                        |name| self.values.get(inner, class, &["geom"], name).map_or("1", |found| found.value.trim());
                    if mask("contype") != "0" || mask("conaffinity") != "0" {
                        self.whole.touching.push(inner.span.clone());
                    }
                    if body != 0
                        && (self.values.settings.from_geoms.is_none_or(|from| from))
                        && !ignores_geoms(self.values, item)
                    {
                        contents.parts.extend(geoms::part(self.values, inner, class, &around.pose));
                    }
                }
                "site" => self.site(inner, body, around),
                _ => {}
            }
        }
    }

    /// A body with everything in it.
    pub fn body(&mut self, item: &'i Item, parent: usize, around: &Around) {
        let written = self.written(item);
        let index = self.whole.robot.bodies.len();
        let plain = written.clone().unwrap_or_else(|| format!("body_{index}"));
        let name = names::in_formulas(&plain, &mut self.whole.names.taken);
        if let Some(written) = written
            && self.whole.names.bodies.insert(written.clone(), index).is_some()
        {
            self.refuse_second(&item.span, "body", &written);
        }
        let (position, rotation) = self.values.frame(item, None, &[]);
        let pose = around.pose.then(&algebra::vector(position), &rotation);
        let position = algebra::numbers(&pose.position).unwrap_or_default();
        let number = |i: usize| {
            let name = format!("body.{name}.pos.{}", ["x", "y", "z"][i]);
            self.values.number(item, item.get("pos"), name, position[i], "m")
        };
        self.whole.robot.bodies.push(Body {
            span: item.span.clone(),
            parent,
            position: [0, 1, 2].map(number),
            rotation: pose.rotation,
            mass: None,
            joints: Vec::new(),
            sites: Vec::new(),
            name,
        });
        let class = self.values.class_of(item, around.class, "childclass");
        let mut contents = Contents::default();
        self.inside(item, index, &Around { pose: Pose::identity(), class }, &mut contents);
        self.whole.robot.bodies[index].mass = self.mass(item, &contents, index);
        let free = |&joint: &usize| self.whole.robot.joints[joint].kind == MjcfType::Free;
        let joints = &self.whole.robot.bodies[index].joints;
        if joints.iter().any(free) && (joints.len() > 1 || parent != 0) {
            let help = "a free joint is the only one of a body in the world".to_owned();
            self.values.error(Code::UnsupportedXml, item.span.clone(), "this body cannot have a free joint", help);
        }
    }

    fn site(&mut self, item: &Item, body: usize, around: &Around) {
        let class = self.values.class_of(item, around.class, "class");
        let (Some(named), Some(written)) = (item.get("name"), self.written(item)) else { return };
        let (position, rotation) = self.values.frame(item, class, &["site"]);
        let pose = around.pose.then(&algebra::vector(position), &rotation);
        let name = names::in_formulas(&written, self.whole.names.taken_by_sites.entry(body).or_default());
        let index = self.whole.robot.bodies[body].sites.len();
        if self.whole.names.sites.insert(written.clone(), (body, index)).is_some() {
            self.refuse_second(&named.span, "site", &written);
        }
        let position = algebra::numbers(&pose.position).unwrap_or_default();
        self.whole.robot.bodies[body].sites.push(Site { name, position, rotation: pose.rotation });
    }

    fn joint(&mut self, item: &'i Item, body: usize, around: &Around) {
        if body == 0 {
            self.values.error(Code::UnsupportedXml, item.span.clone(), "the world does not move", None);
            return;
        }
        let class = if item.tag == "joint" { self.values.class_of(item, around.class, "class") } else { None };
        let get = |values: &Values<'i, '_>, name: &'static str| {
            if item.tag == "joint" { values.get(item, class, &["joint"], name) } else { None }
        };
        let kind = match get(self.values, "type") {
            _ if item.tag == "freejoint" => MjcfType::Free,
            Some(found) => self.values.word(found, &KINDS).unwrap_or(MjcfType::Hinge),
            None => MjcfType::Hinge,
        };
        let index = self.whole.robot.joints.len();
        let written = self.written(item);
        let plain = written.clone().unwrap_or_else(|| format!("joint_{index}"));
        let name = names::in_formulas(&plain, &mut self.whole.names.taken_by_joints);
        if let Some(written) = written
            && self.whole.names.joints.insert(written.clone(), index).is_some()
        {
            self.refuse_second(&item.span, "joint", &written);
        }
        let vector = |values: &mut Values<'i, '_>, name, or| {
            get(values, name).and_then(|found| values.exact(found)).unwrap_or(or)
        };
        let position = vector(self.values, "pos", [0.0; 3]);
        let axis = vector(self.values, "axis", [0.0, 0.0, 1.0]);
        let length = axis.iter().map(|part: &f64| part * part).sum::<f64>().sqrt();
        if length < 1e-10 {
            self.values.error(
                Code::ZeroDirection,
                item.span.clone(),
                format!("the axis of joint `{name}` has no direction"),
                None,
            );
        }
        let (axis, at) = (axis.map(|part| part / length), algebra::vector(position));
        let turned = algebra::rotate(&around.pose.rotation, &algebra::vector(axis));
        let position = algebra::add(&around.pose.position, &algebra::rotate(&around.pose.rotation, &at));
        let angle = if kind == MjcfType::Slide { 1.0 } else { self.values.settings.angle };
        let scalar = |values: &mut Values<'i, '_>, name: &'static str| {
            let found = get(values, name);
            let value = found.and_then(|found| values.exact::<1>(found)).map_or(0.0, |[value]| value);
            (found, value)
        };
        let units = match kind {
            MjcfType::Slide => ["N*s/m", "N", "kg", "N/m", "m"],
            _ => ["N*m*s/rad", "N*m", "kg*m^2", "N*m/rad", "rad"],
        };
        let number = |values: &mut Values<'i, '_>, key: &'static str, scale: f64, less: f64, unit| {
            let (found, value) = scalar(values, key);
            if value < 0.0 && key != "springref" {
                let span = found.map_or_else(|| item.span.clone(), |found: &Attribute| found.span.clone());
                values.error(Code::BadXmlValue, span, format!("the {key} of joint `{name}` is negative"), None);
            }
            values.number(item, found, format!("joint.{name}.{key}"), value * scale - less, unit)
        };
        let reference = {
            get(self.values, "ref").and_then(|found| self.values.exact::<1>(found)).map_or(0.0, |[value]| value * angle)
        };
        let flags = self.values.settings.flags;
        let damping = number(self.values, "damping", on(flags.dampers), 0.0, units[0]);
        let friction = number(self.values, "frictionloss", on(flags.friction), 0.0, units[1]);
        let armature = number(self.values, "armature", 1.0, 0.0, units[2]);
        let stiffness = number(self.values, "stiffness", on(flags.springs), 0.0, units[3]);
        let spring_at = number(self.values, "springref", angle, reference, units[4]);
        let range = self.range(item, get(self.values, "range"), get(self.values, "limited"));
        let range = range.filter(|_| flags.limits && matches!(kind, MjcfType::Hinge | MjcfType::Slide)).map(|ends| {
            let end = |i: usize| {
                let name = format!("joint.{name}.range.{}", ["lower", "upper"][i]);
                self.values.number(item, get(self.values, "range"), name, ends[i] * angle - reference, units[4])
            };
            [0, 1].map(end)
        });
        let force_range =
            self.range(item, get(self.values, "actuatorfrcrange"), get(self.values, "actuatorfrclimited"));
        let spring_damper = get(self.values, "springdamper").and_then(|found| self.values.exact::<2>(found));
        self.whole.robot.joints.push(Joint {
            span: item.span.clone(),
            kind,
            body,
            position: algebra::numbers(&position).unwrap_or_default(),
            axis: algebra::numbers(&turned).unwrap_or_default(),
            damping,
            friction,
            armature,
            stiffness,
            spring_at,
            reference,
            range,
            force_range,
            spring_damper: spring_damper.filter(|both| both.iter().all(|part| *part > 0.0)),
            name,
        });
        self.whole.robot.bodies[body].joints.push(index);
    }

    /// A range that holds.
    fn range(&mut self, item: &Item, range: Option<&Attribute>, limited: Option<&Attribute>) -> Option<[f64; 2]> {
        let words = [("true", Some(true)), ("false", Some(false)), ("auto", None)];
        let limited = limited.and_then(|found| self.values.word(found, &words)).flatten();
        let ends = range.and_then(|found| self.values.exact::<2>(found));
        let holds = limited.unwrap_or(self.values.settings.autolimits && ends.is_some());
        let ends = ends.filter(|_| holds)?;
        if ends[0] >= ends[1] {
            let span = range.map_or_else(|| item.span.clone(), |found| found.span.clone());
            let name = range.map_or("range", |found| &found.name);
            self.values.error(Code::BadXmlValue, span, format!("the ends of `{name}` are reversed"), None);
        }
        Some(ends)
    }

    fn mass(&mut self, item: &Item, contents: &Contents, body: usize) -> Option<Mass> {
        let name = self.whole.robot.bodies[body].name.clone();
        let prefix = format!("body.{name}");
        let inertial = contents.inertial.filter(|_| self.values.settings.from_geoms != Some(true));
        let (from, solid, rotation, of_geoms) = match inertial {
            Some(inertial) => {
                let (solid, rotation) = self.inertial(inertial)?;
                (inertial, solid, rotation, false)
            }
            None => (item, geoms::solid(&contents.parts)?, algebra::identity(), true),
        };
        let solid = geoms::bounded(self.values, solid);
        let number = |last: &str, value, unit| {
            self.values.number(from, from.get("mass"), format!("{prefix}.{last}"), value, unit)
        };
        let centers = ["com.x", "com.y", "com.z"];
        let moments = ["inertia.xx", "inertia.yy", "inertia.zz", "inertia.xy", "inertia.xz", "inertia.yz"];
        Some(Mass {
            mass: number("mass", solid.mass, "kg"),
            center: [0, 1, 2].map(|i: usize| number(centers[i], solid.center[i], "m")),
            rotation,
            inertia: [0, 1, 2, 3, 4, 5].map(|i: usize| number(moments[i], solid.inertia[i], "kg*m^2")),
            of_geoms,
        })
    }

    /// Mass and inertia of `<inertial>`, with the rotation of its frame.
    fn inertial(&mut self, item: &Item) -> Option<(GeomMass, Quaternion)> {
        let (center, mut rotation) = self.values.frame(item, None, &[]);
        let Some(mass) = item.get("mass") else {
            self.values.error(Code::MissingXml, item.span.clone(), "`<inertial>` needs `mass`", None);
            return None;
        };
        let [mass] = self.values.exact(mass)?;
        if mass < 0.0 {
            self.values.error(Code::BadXmlValue, item.span.clone(), "this mass is negative", None);
            return None;
        }
        let inertia = match (item.get("diaginertia"), item.get("fullinertia")) {
            (Some(found), None) => {
                let [xx, yy, zz] = self.values.exact(found)?;
                [xx, yy, zz, 0.0, 0.0, 0.0]
            }
            (None, Some(found)) => {
                rotation = algebra::identity();
                self.values.exact(found)?
            }
            (None, None) => [0.0; 6],
            (Some(_), Some(found)) => {
                self.values.error(
                    Code::ExclusiveKeys,
                    found.span.clone(),
                    "`diaginertia` and `fullinertia` exclude each other",
                    None,
                );
                return None;
            }
        };
        Some((GeomMass { mass, center, inertia }, rotation))
    }
}

/// Whether a body's geoms say nothing of its inertia.
fn ignores_geoms(values: &Values, body: &Item) -> bool {
    values.settings.from_geoms.is_none() && body.of("inertial").next().is_some()
}

/// Scales all masses and inertias to a total.
fn scale(robot: &mut Robot, total: f64) {
    let sum: f64 = robot.bodies.iter().filter_map(|body| Some(body.mass.as_ref()?.mass.value)).sum();
    for mass in robot.bodies.iter_mut().filter_map(|body| body.mass.as_mut()).filter(|_| sum > 0.0) {
        mass.mass.value *= total / sum;
        mass.inertia.iter_mut().for_each(|number| number.value *= total / sum);
    }
}
