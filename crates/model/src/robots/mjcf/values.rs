//! Values of attributes: of the element itself, or of its class among the defaults; checked numbers, frames.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use symdiff::math;

use super::assets::Meshes;
use super::document::{Attribute, Item};
use super::flags::Flags;
use crate::robots::algebra::{self, Quaternion, Value};
use crate::robots::number::Number;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::source::Span;
use crate::syntax::suggest::{self, clip};
use crate::syntax::within::AllowedFolders;

/// The class that has no name, or is the outermost.
const MAIN: &str = "main";

/// A class of defaults.
struct Class<'i> {
    parent: Option<usize>,
    item: &'i Item,
}

/// Context in which values are read.
pub struct Values<'i, 'd> {
    pub diagnostics: &'d mut Diagnostics,
    classes: Vec<Class<'i>>,
    by_name: HashMap<String, usize>,
    pub settings: Settings,
    pub meshes: Meshes<'i>,
}

/// Settings of `<compiler>`.
pub struct Settings {
    /// rad of one unit of an angle.
    pub angle: f64,
    pub euler: [(usize, bool); 3],
    pub autolimits: bool,
    /// Whether inertias come from geoms; if not given, those of bodies without `<inertial>` do.
    pub from_geoms: Option<bool>,
    pub groups: [f64; 2],
    pub least_mass: f64,
    pub least_inertia: f64,
    pub balance: bool,
    pub total_mass: Option<f64>,
    /// Forces and constraints that act.
    pub flags: Flags,
}

impl<'i, 'd> Values<'i, 'd> {
    /// For a file in a folder.
    pub fn new(root: &'i Item, files: &'i AllowedFolders, folder: &Path, diagnostics: &'d mut Diagnostics) -> Self {
        let settings = Settings {
            angle: std::f64::consts::PI / 180.0,
            euler: [0, 1, 2].map(|axis| (axis, true)),
            autolimits: true,
            from_geoms: None,
            groups: [0.0, 5.0],
            least_mass: 0.0,
            least_inertia: 0.0,
            balance: false,
            total_mass: None,
            flags: Flags::ALL,
        };
        let meshes = Meshes::new(root, files, folder);
        let mut values = Self { diagnostics, classes: Vec::new(), by_name: HashMap::new(), settings, meshes };
        for item in root.of("default") {
            values.class(item, None);
        }
        for item in root.of("compiler") {
            values.compiler(item);
        }
        for item in root.of("option").flat_map(|option| option.of("flag")) {
            let words = [("enable", false), ("disable", true)];
            let flags = values.settings.flags;
            values.settings.flags = flags.after(&mut |name| values.choice(item, name, &words) == Some(true));
        }
        values
    }

    pub fn error(&mut self, code: Code, span: Span, message: impl Into<String>, help: impl Into<Option<String>>) {
        self.diagnostics.push(Diagnostic::error(code, span, message).help(help));
    }

    fn class(&mut self, item: &'i Item, parent: Option<usize>) {
        let name = item.get("class").map_or(MAIN, |class| class.value.as_str());
        let same = self.by_name.get(name).copied().filter(|_| parent.is_none());
        let (index, parent) = match same {
            // Several outermost ones are one.
            Some(known) => (self.classes.len(), Some(known)),
            None => (self.classes.len(), parent.or_else(|| self.by_name.get(MAIN).copied())),
        };
        if same.is_none() && self.by_name.contains_key(name) {
            self.error(
                Code::NameTaken,
                item.span.clone(),
                format!("a second class of defaults is called `{}`", clip(name)),
                None,
            );
        }
        self.classes.push(Class { parent, item });
        self.by_name.insert(name.to_owned(), index);
        if index == 0 {
            self.by_name.insert(MAIN.to_owned(), index);
        }
        for inner in item.of("default") {
            self.class(inner, Some(index));
        }
    }

    fn compiler(&mut self, item: &Item) {
        if let Some(degrees) = self.choice(item, "angle", &[("degree", true), ("radian", false)]) {
            self.settings.angle = if degrees { std::f64::consts::PI / 180.0 } else { 1.0 };
        }
        if self.choice(item, "coordinate", &[("local", true), ("global", false)]) == Some(false) {
            let span = item.get("coordinate").map_or_else(|| item.span.clone(), |found| found.span.clone());
            self.error(
                Code::UnsupportedXml,
                span,
                "global coordinates are not supported: MuJoCo has them no more",
                None,
            );
        }
        if let Some(sequence) = item.get("eulerseq") {
            let axes: Vec<(usize, bool)> = sequence
                .value
                .chars()
                .filter_map(|letter| {
                    let axis = "xyz".find(letter.to_ascii_lowercase())?;
                    Some((axis, letter.is_ascii_lowercase()))
                })
                .collect();
            match axes.as_slice() {
                &[a, b, c] if sequence.value.len() == 3 => self.settings.euler = [a, b, c],
                _ => {
                    let help = "e.g. `xyz`, about axes that turn with the frame, or `XYZ`, about fixed ones".to_owned();
                    self.error(
                        Code::BadXmlValue,
                        sequence.span.clone(),
                        "`eulerseq` is three letters of x, y and z",
                        help,
                    );
                }
            }
        }
        let yes = [("true", true), ("false", false)];
        if let Some(found) = self.choice(item, "autolimits", &yes) {
            self.settings.autolimits = found;
        }
        if let Some(found) = self.choice(item, "balanceinertia", &yes) {
            self.settings.balance = found;
        }
        let from = [("true", Some(true)), ("false", Some(false)), ("auto", None)];
        if let Some(found) = self.choice(item, "inertiafromgeom", &from) {
            self.settings.from_geoms = found;
        }
        if let Some(folder) = item.get("meshdir").or_else(|| item.get("assetdir")) {
            self.meshes.meshdir = PathBuf::from(&folder.value);
        }
        if let Some(found) = self.choice(item, "strippath", &yes) {
            self.meshes.strips = found;
        }
        if let Some(found) = self.own_numbers(item, "inertiagrouprange") {
            self.settings.groups = found;
        }
        let single = |values: &mut Self, name| values.own_numbers::<1>(item, name).map(|[value]| value);
        self.settings.least_mass = single(self, "boundmass").unwrap_or(self.settings.least_mass);
        self.settings.least_inertia = single(self, "boundinertia").unwrap_or(self.settings.least_inertia);
        self.settings.total_mass = single(self, "settotalmass").filter(|mass| *mass > 0.0).or(self.settings.total_mass);
    }

    /// An attribute of an element itself, one of a few words.
    pub fn choice<T: Copy>(&mut self, item: &Item, name: &str, words: &[(&str, T)]) -> Option<T> {
        let found = item.get(name)?;
        self.word(found, words)
    }

    /// One of a few words.
    pub fn word<T: Copy>(&mut self, found: &Attribute, words: &[(&str, T)]) -> Option<T> {
        let known = words.iter().find(|(word, _)| *word == found.value.trim());
        if known.is_none() {
            let message = format!("`{}` is not a value of `{}`", clip(&found.value), found.name);
            let help = suggest::help(&found.value, "values", words.iter().map(|(word, _)| *word));
            self.error(Code::BadXmlValue, found.span.clone(), message, help);
        }
        known.map(|(_, value)| *value)
    }

    fn own_numbers<const N: usize>(&mut self, item: &Item, name: &str) -> Option<[f64; N]> {
        self.parsed(item.get(name)?, N)?.try_into().ok()
    }

    /// The class that an element is of, where it may be that of the bodies around it.
    pub fn class_of(&mut self, item: &Item, around: Option<usize>, key: &str) -> Option<usize> {
        let Some(class) = item.get(key) else { return around.or_else(|| self.by_name.get(MAIN).copied()) };
        let found = self.by_name.get(&class.value).copied();
        if found.is_none() {
            let help = suggest::help(&class.value, "classes", self.by_name.keys().map(String::as_str));
            self.diagnostics.push(
                Diagnostic::error(
                    Code::UnknownName,
                    class.span.clone(),
                    format!("unknown class `{}`", clip(&class.value)),
                )
                .help(help),
            );
        }
        found
    }

    /// An attribute of an element or of its class, in which it is under one of some tags.
    pub fn get<'a>(&self, item: &'a Item, class: Option<usize>, tags: &[&str], name: &str) -> Option<&'a Attribute>
    where
        'i: 'a,
    {
        if let Some(own) = item.get(name) {
            return Some(own);
        }
        let mut next = class;
        while let Some(class) = next {
            let Class { parent, item } = &self.classes[class];
            for tag in tags {
                let mut found = item.items.iter().rev().filter(|inner| inner.tag == **tag);
                if let Some(found) = found.find_map(|inner| inner.get(name)) {
                    return Some(found);
                }
            }
            next = *parent;
        }
        None
    }

    /// The finite numbers of an attribute, at least one and at most `most`.
    pub fn parsed(&mut self, attribute: &Attribute, most: usize) -> Option<Vec<f64>> {
        let mut numbers = Vec::new();
        for part in attribute.value.split_whitespace() {
            match part.parse::<f64>().ok().filter(|number| number.is_finite()) {
                Some(number) => numbers.push(number),
                None => {
                    let message = format!("`{}` is not a finite number", clip(part));
                    self.error(Code::BadXmlValue, attribute.span.clone(), message, None);
                    return None;
                }
            }
        }
        if numbers.is_empty() || numbers.len() > most {
            let message = format!("`{}` has {most} numbers, but here are {}", attribute.name, numbers.len());
            self.error(Code::BadXmlValue, attribute.span.clone(), message, None);
            return None;
        }
        Some(numbers)
    }

    /// An attribute of exactly `N` numbers.
    pub fn exact<const N: usize>(&mut self, attribute: &Attribute) -> Option<[f64; N]> {
        let numbers = self.parsed(attribute, N)?;
        let count = numbers.len();
        let found = numbers.try_into().ok();
        if found.is_none() {
            let message = format!("`{}` has {N} numbers, but here are {count}", attribute.name);
            self.error(Code::BadXmlValue, attribute.span.clone(), message, None);
        }
        found
    }

    /// Where an element is in the frame around it; euler angles and the like are those of the element, or of its class.
    pub fn frame(&mut self, item: &Item, class: Option<usize>, tags: &[&str]) -> ([f64; 3], Quaternion) {
        let position = self.get(item, class, tags, "pos").and_then(|found| self.exact::<3>(found));
        (position.unwrap_or([0.0; 3]), self.rotation(item, class, tags))
    }

    fn rotation(&mut self, item: &Item, class: Option<usize>, tags: &[&str]) -> Quaternion {
        const WORDS: [&str; 5] = ["quat", "axisangle", "xyaxes", "zaxis", "euler"];
        let own: Vec<&Attribute> = WORDS.iter().filter_map(|name| item.get(name)).collect();
        if let [_, second, ..] = own.as_slice() {
            self.error(
                Code::BadXmlValue,
                second.span.clone(),
                format!("a second orientation of one `<{}>`", item.tag),
                None,
            );
        }
        let found = own.first().copied().or_else(|| WORDS.iter().find_map(|name| self.get(item, class, tags, name)));
        let Some(found) = found else { return algebra::identity() };
        let rotation = match found.name.as_str() {
            "quat" => self.exact::<4>(found).map(|q| q.map(Value::Number)),
            "axisangle" => self.exact::<4>(found).map(|[x, y, z, angle]| {
                let angle = angle * self.settings.angle;
                let (cos, sin) = (math::cos(angle / 2.0), math::sin(angle / 2.0));
                let length = math::hypot(math::hypot(x, y), z);
                [cos * length, sin * x, sin * y, sin * z].map(Value::Number)
            }),
            "euler" => self.exact::<3>(found).map(|angles| self.euler(angles)),
            "zaxis" => self.exact::<3>(found).map(along_z),
            _ => self.exact::<6>(found).map(by_axes),
        };
        let Some(rotation) = rotation else { return algebra::identity() };
        normalised(&rotation).unwrap_or_else(|| {
            self.error(Code::ZeroDirection, found.span.clone(), format!("`{}` has no direction", found.name), None);
            algebra::identity()
        })
    }

    fn euler(&self, angles: [f64; 3]) -> Quaternion {
        let mut whole = algebra::identity();
        for (&(axis, turns), angle) in self.settings.euler.iter().zip(angles) {
            let mut about = [0.0; 3];
            about[axis] = 1.0;
            let turn = algebra::turn(about, angle * self.settings.angle);
            whole = if turns { algebra::product(&whole, &turn) } else { algebra::product(&turn, &whole) };
        }
        whole
    }

    /// A number as a parameter, with the text of mbint's own attribute for it.
    pub fn number(
        &self,
        item: &Item,
        from: Option<&Attribute>,
        name: String,
        value: f64,
        unit: &'static str,
    ) -> Number {
        let last = name.rsplit('.').next().unwrap_or_default();
        let uncertain = item.own(last).map(|own| (own.value.clone(), own.span.clone()));
        let span = from.map_or_else(|| item.span.clone(), |found| found.span.clone());
        Number { name, value, unit, span, uncertain }
    }
}

/// Quaternion scaled to length one; `None` if its length is zero or not a number.
fn normalised(q: &Quaternion) -> Option<Quaternion> {
    let numbers = algebra::numbers(q)?;
    let length = numbers.iter().map(|part| part * part).sum::<f64>().sqrt();
    (length > 1e-14).then(|| numbers.map(|part| Value::Number(part / length)))
}

/// The least rotation that turns z along a direction.
pub fn along_z(direction: [f64; 3]) -> Quaternion {
    let [x, y, z] = direction;
    let across = math::hypot(x, y);
    let angle = math::atan2(across, z);
    if across == 0.0 {
        // Upside down about x, as MuJoCo does; zero has no direction.
        let there = if z == 0.0 { 0.0 } else { 1.0 };
        let [cos, sin] = if z < 0.0 { [0.0, 1.0] } else { [there, 0.0] };
        return [cos, sin, 0.0, 0.0].map(Value::Number);
    }
    algebra::turn([-y / across, x / across, 0.0], angle)
}

/// The frame whose x is along the first three, and whose y in the plane of both.
fn by_axes([a, b, c, d, e, f]: [f64; 6]) -> Quaternion {
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let unit = |p: [f64; 3]| {
        let length = dot(p, p).sqrt();
        p.map(|part| part / length)
    };
    let x = unit([a, b, c]);
    let along = dot(x, [d, e, f]);
    let y = unit([d - along * x[0], e - along * x[1], f - along * x[2]]);
    let z = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
    of_columns([x, y, z]).map_or([0.0; 4].map(Value::Number), |q| q.map(Value::Number))
}

/// Euler parameters of a rotation by its columns; `None` if they are not finite.
fn of_columns([x, y, z]: [[f64; 3]; 3]) -> Option<[f64; 4]> {
    if [x, y, z].iter().flatten().any(|part| !part.is_finite()) {
        return None;
    }
    // Shepperd: from the largest of the four.
    let squares =
        [1.0 + x[0] + y[1] + z[2], 1.0 + x[0] - y[1] - z[2], 1.0 - x[0] + y[1] - z[2], 1.0 - x[0] - y[1] + z[2]];
    let largest = (0..4).max_by(|&i, &k| squares[i].total_cmp(&squares[k]))?;
    let s = 2.0 * squares[largest].sqrt();
    let quarter = s / 4.0;
    Some(match largest {
        0 => [quarter, (y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s],
        1 => [(y[2] - z[1]) / s, quarter, (y[0] + x[1]) / s, (z[0] + x[2]) / s],
        2 => [(z[0] - x[2]) / s, (y[0] + x[1]) / s, quarter, (z[1] + y[2]) / s],
        _ => [(x[1] - y[0]) / s, (z[0] + x[2]) / s, (z[1] + y[2]) / s, quarter],
    })
}
