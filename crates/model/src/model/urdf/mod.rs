//! `urdf:`, a robot's file as the beginning of a model; or alone, as a model with gravity.
//!
//! The robot of the file ([`crate::robots::urdf`]) → parameters (`expand::numbers`) → bodies, joints and effects
//! (`build`, `effects`, `start`), with formulas (`robots::algebra`) where a number is a parameter. A number is one
//! where something names it; all others stay numbers. Not a tree: decision 0156.

mod bodies;
mod build;
mod effects;
mod joints;
mod link_points;
mod source;
mod start;

use std::collections::HashSet;
use std::path::Path;

use self::source::{Built, ParsedUrdf};
use crate::expand::numbers::{self, Format};
use crate::expand::overrides::Override;
use crate::expand::scenes::OmittedEffects;
use crate::grammar::report::Fields;
use crate::model::names::Reader;
use crate::robots::tuning::TUNING;
use crate::robots::urdf::robot::Robot;
use crate::robots::urdf::{is_number, is_urdf, read};
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

const FORMAT: Format = Format {
    name: "URDF",
    forms: "e.g. `link.NAME.mass`, `.com.x`, `.inertia.xx`, `joint.NAME.damping`, `.friction`, `.origin.z`, `.origin.yaw`",
    is_number,
};

/// The model that a URDF is by itself: gravity, a second, at rest in the zero configuration.
pub fn model_of(path: &Path) -> String {
    let file = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().replace('\'', "''"));
    format!(
        "urdf: '{file}'\neffects: {{ gravity: {{ gravity: {{ acceleration: [0, 0, -9.81] }} }} }}\n\
         simulation: {{ duration: 1, step: 1e-3, output_step: 0.01 }}\n"
    )
}

/// A robot's file, read.
pub struct Urdf {
    robot: Robot,
    floating: bool,
    words: HashSet<String>,
    /// Entries of `bodies:` for links.
    of_links: Vec<Entry>,
}

/// A robot with its bodies and joints in the model.
pub struct DeclaredRobot {
    urdf: Urdf,
    named: HashSet<String>,
    built: Built,
    /// Place of the key in the model.
    at: Span,
}

impl Urdf {
    /// Reads the file that the node names, next to the model's.
    pub fn read(
        reader: &mut Reader,
        node: &Node,
        fields: &Fields,
        model: &Path,
        root: &Node,
        overrides: &[(Override, Span)],
    ) -> Option<Self> {
        let base = match fields.get("base") {
            Some(node) => Some(reader.choice(node, &[("fixed", false), ("floating", true)])?),
            None => None,
        };
        let file = reader.scalar(node, "the path of a URDF")?.text.clone();
        let found = reader.files.find(Path::new(""), &file).and_then(|path| {
            let path = reader.files.full(&path);
            Ok((reader.files.read(&path, TUNING.file_bytes)?, path))
        });
        let (text, path) = match found {
            Ok(found) => found,
            Err(error) => {
                let alone = is_urdf(model);
                let span = if alone { None } else { Some(node.span.clone()) };
                let message = if alone { error.message } else { error.message.replacen("the file", "the URDF", 1) };
                reader.diagnostics.push(Diagnostic { span, message, ..*error });
                return None;
            }
        };
        let start = reader.diagnostics.sources.add(path.display().to_string(), text.clone());
        let robot = read::read(&text, start, reader.diagnostics)?;
        // A drone or a brick by itself: fixed, nothing of it would be left.
        let loose = || is_urdf(model) && robot.is_rigid() && robot.has_mass();
        let floating = base.unwrap_or_else(loose);
        Some(Self { robot, floating, words: numbers::words(root, overrides), of_links: Vec::new() })
    }

    /// The model's parameters, with those of the robot.
    pub fn parameters(&self, reader: &mut Reader, written: &[Entry]) -> Vec<Entry> {
        numbers::entries(reader, &FORMAT, self.robot.numbers(), &self.words, written)
    }

    /// Keeps the entries of `bodies:` that name links; the others, which are of the model's own bodies.
    pub fn keep_of_links(&mut self, entries: &[Entry]) -> Vec<Entry> {
        let links: HashSet<&str> = self.robot.links.iter().map(|link| link.name.as_str()).collect();
        let (of_links, others) = entries.iter().cloned().partition(|entry| links.contains(entry.key.as_str()));
        self.of_links = of_links;
        others
    }

    /// The entries of `bodies:` that name links, with the links.
    fn entries_of_links(&self) -> impl Iterator<Item = (usize, &Entry)> {
        let index = |name: &str| self.robot.links.iter().position(|link| link.name == name);
        self.of_links.iter().filter_map(move |entry| Some((index(&entry.key)?, entry)))
    }

    /// Adds the robot's bodies and joints to the model, behind those that it has.
    pub fn declare(self, reader: &mut Reader, parameters: &[Entry]) -> DeclaredRobot {
        let named: HashSet<String> =
            parameters.iter().filter(|entry| is_number(&entry.key)).map(|entry| entry.key.clone()).collect();
        for joint in &self.robot.joints {
            if reader.model.joints.iter().any(|known| known.name == joint.name) {
                let message = format!("the model has a joint that is called like the URDF's `{}`", joint.name);
                reader.diagnostics.push(Diagnostic::error(Code::NameTaken, joint.span.clone(), message));
            }
        }
        let source = ParsedUrdf { robot: &self.robot, floating: self.floating, words: &self.words, named: &named };
        let built = build::declare(reader, &source);
        let of_links: Vec<(usize, &Entry)> = self.entries_of_links().collect();
        link_points::declare(reader, &built, &of_links);
        let at = self.robot.links[self.robot.root].span.clone();
        DeclaredRobot { urdf: self, named, built, at }
    }
}

impl DeclaredRobot {
    /// Adds effects that are not omitted, start values and, if the model has none, outputs; checks that masses stay
    /// positive. `limits` is the section of that name.
    pub fn finish(&self, reader: &mut Reader, left_out: &OmittedEffects, limits: Option<(&Node, Span)>, observe: bool) {
        let Urdf { robot, floating, words, .. } = &self.urdf;
        let source = ParsedUrdf { robot, floating: *floating, words, named: &self.named };
        let effects = effects::read(reader, &source, &self.built, limits);
        effects::add(reader, &source, effects, left_out);
        start::start(reader, &source, &self.built);
        for number in robot.numbers().filter(|number| self.named.contains(&number.name)) {
            let last = number.name.rsplit('.').next().unwrap_or_default();
            let (holds, requirement): (fn(f64) -> bool, &str) = match last {
                "mass" if number.value > 0.0 => (|value| value > 0.0, "must be positive"),
                "mass" | "damping" | "friction" => (|value| value >= 0.0, "must not be negative"),
                _ => continue,
            };
            let Ok(formula) = symdiff::Formula::parse(&number.name) else { continue };
            let text = Scalar::plain(number.name.clone(), None);
            let node = Node { span: number.span.clone(), value: Value::Scalar(text) };
            reader.require(&node, &formula, holds, requirement);
        }
        if observe {
            start::outputs(reader, &source, &self.built);
            if reader.model.outputs.is_empty() {
                let help = "with `base: floating` in a model that names the file, the whole moves".to_owned();
                reader.error(Code::NothingMoves, self.at.clone(), "nothing of this robot can move", help);
            }
        }
    }
}
