//! A file → its [`Description`], or everything that is wrong with it.

use std::path::Path;

use super::description::{Description, Space};
use super::reading::{Reading, Scene};
use super::urdf::{self, Urdf};
use super::{
    analysis, black_box, bodies, bounds, definitions, design, effects, excitations, fmu, instances, joints,
    motion_times, parameters, random, requests, requirements, sections, space, states, statistics, tables, teeth,
    trajectories, zone_sizes,
};
use crate::expand::dimensions::{self, Chain};
use crate::expand::overrides::Override;
use crate::expand::parts::{self, Parts, WrittenOut};
use crate::expand::scenes::{Scenes, Variant};
use crate::expand::zones::{self, Zone};
use crate::expand::{asked_outputs, fmu as units, mjcf};
use crate::grammar::mentions::Notes;
use crate::grammar::report::Report;
use crate::keys;
use crate::model::names::Reader;
use crate::robots::mjcf::is_mjcf;
use crate::robots::urdf::is_urdf;
use crate::syntax::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::source::Span;
use crate::syntax::text_file::{read_given, text_of};
use crate::syntax::tuning::TUNING;
use crate::syntax::within::AllowedFolders;
use crate::syntax::yaml::{self, Entry, Node};
use crate::syntax::{Code, harmless};

/// Reads a model file, parameters replaced as the command line says.
///
/// # Errors
/// Everything that is wrong with the file.
pub fn load(path: &Path, overrides: &[Override]) -> Result<Description, Diagnostics> {
    let Reading { description, diagnostics, .. } = read(path, overrides);
    description.ok_or(diagnostics)
}

/// Reads a model from text; `name` is its name in diagnostics.
///
/// # Errors
/// Everything that is wrong with the text.
pub fn load_str(name: &str, text: &str, overrides: &[Override]) -> Result<Description, Diagnostics> {
    let Reading { description, diagnostics, .. } = read_str(name, text, overrides);
    description.ok_or(diagnostics)
}

/// A path as it is shown: on one line, and saying nothing to the terminal.
pub fn shown(path: &Path) -> String {
    harmless(&path.display().to_string()).replace(['\n', '\t'], "\u{fffd}")
}

/// Whether a file is a robot's own, URDF or MJCF, and no model that names one.
pub fn is_robot(path: &Path) -> bool {
    is_urdf(path) || is_mjcf(path)
}

/// The model of nothing but a robot, where the file is one: errors are in the robot's file.
pub(super) fn robot_alone(path: &Path) -> Option<String> {
    if is_urdf(path) {
        return Some(urdf::model_of(path));
    }
    is_mjcf(path).then(|| mjcf::model_of(path))
}

/// Whether a path stands for standard input.
pub fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

/// Like [`load`], with the warnings of a model that can be used. The path `-` is standard input, whose model is called
/// `stdin` if it does not say otherwise, and finds other files from the working directory.
pub fn read(path: &Path, overrides: &[Override]) -> Reading {
    read_rooted(path, Changes::of(overrides), None)
}

/// Replacements for parts of a model's text.
#[derive(Clone, Copy, Debug)]
pub struct Changes<'c> {
    /// Values of parameters.
    pub overrides: &'c [Override],
    /// Outputs, by names and formulas; `None` for the model's own.
    pub outputs: Option<&'c [(String, String)]>,
}

impl<'c> Changes<'c> {
    /// Changes of parameters alone.
    pub fn of(overrides: &'c [Override]) -> Self {
        Self { overrides, outputs: None }
    }
}

/// Like [`read`] with all changes, where the model may also name files of another folder or below.
pub fn read_rooted(path: &Path, changes: Changes, root: Option<&Path>) -> Reading {
    let from_input = is_standard_input(path);
    let name = if from_input { "stdin".to_owned() } else { shown(path) };
    if let Some(model) = robot_alone(path) {
        return read_text_of(&name, &model, changes, root);
    }
    let text = if from_input {
        text_of(std::io::stdin().lock(), TUNING.file_bytes)
    } else {
        read_given(path, TUNING.file_bytes)
    };
    match text {
        Ok(text) => read_text_of(&name, &text, changes, root),
        Err(error) => {
            let mut diagnostics = Diagnostics::new(name, "");
            diagnostics.push(*error);
            Reading { description: None, scenes: Vec::new(), diagnostics }
        }
    }
}

/// Like [`load_str`], with the warnings of a model that can be used.
pub fn read_str(name: &str, text: &str, overrides: &[Override]) -> Reading {
    read_text(name, text, Changes::of(overrides))
}

/// Like [`read_str`] with all changes.
pub fn read_text(name: &str, text: &str, changes: Changes) -> Reading {
    read_text_of(name, text, changes, None)
}

fn read_text_of(name: &str, text: &str, changes: Changes, root: Option<&Path>) -> Reading {
    read_from(ModelOrigin::of(name, AllowedFolders::of(Path::new(name), root), None), text, changes)
}

/// Reads a model from text that comes from somewhere.
pub(super) fn read_from(origin: ModelOrigin, text: &str, changes: Changes) -> Reading {
    let name = origin.name;
    let mut diagnostics = Diagnostics::new(name, text);
    let mut placed = Vec::new();
    for wanted in changes.overrides {
        let start = diagnostics.sources.add("--set", wanted.text.clone());
        match Override::at(&wanted.text, start) {
            Ok(wanted) => {
                let leading = wanted.text.len() - wanted.text.trim_start().len();
                let span = start + leading..start + leading + wanted.name.len();
                placed.push((wanted, span));
            }
            Err(error) => diagnostics.push(*error),
        }
    }
    if let Some(zero) = text.find('\0') {
        let message = "the file is not text: it has a zero byte";
        diagnostics.push(Diagnostic::error(Code::NotText, zero..zero + 1, message));
        return Reading { description: None, scenes: Vec::new(), diagnostics };
    }
    let Some(root) = yaml::parse(text, &mut diagnostics) else {
        return Reading { description: None, scenes: Vec::new(), diagnostics };
    };
    let root = match root.get("mjcf") {
        None => root,
        Some(_) => match mjcf::write_out(&mut origin.report(&mut diagnostics), &root, Path::new(name), &placed) {
            Some(root) if !diagnostics.has_errors() => root,
            _ => return Reading { description: None, scenes: Vec::new(), diagnostics },
        },
    };
    let Some(root) = units::write_out(&mut origin.report(&mut diagnostics), &root) else {
        return Reading { description: None, scenes: Vec::new(), diagnostics };
    };
    let written = parts::write_out(&mut origin.report(&mut diagnostics), &root, text, &placed);
    let (root, parts) = match written {
        Some(WrittenOut { root, parts }) => (root, Some(parts)),
        None => (root, None),
    };
    if diagnostics.has_errors() && parts.is_some() {
        // Parts missing in the tree would be reported again and again.
        return Reading { description: None, scenes: Vec::new(), diagnostics };
    }
    if let Some(parts) = &parts {
        placed = parts.follow(placed);
    }
    let parts = parts.as_ref();
    let before = diagnostics.len();
    let (root, chains) = dimensions::write_out(&mut origin.report(&mut diagnostics), root);
    let (root, zones) = zones::write_out(&mut origin.report(&mut diagnostics), root);
    if diagnostics.len() > before {
        // Missing keys of the tree would be reported again.
        return Reading { description: None, scenes: Vec::new(), diagnostics };
    }
    let origin = ModelOrigin { chains, zones, ..origin };
    let root = match changes.outputs {
        Some(outputs) => asked_outputs::write_out(root, outputs, &mut diagnostics),
        None => root,
    };
    let plan = Scenes::read(&mut origin.report(&mut diagnostics), &root);
    let before = diagnostics.len();
    let model = plan.model();
    let (description, mut unused) = describe(&origin, &model, parts, &placed, &mut diagnostics);
    diagnostics.found_without(before, &model.left_out);
    let mut scenes = Vec::with_capacity(plan.count());
    for scene in 0..plan.count() {
        let before = diagnostics.len();
        let variant = plan.scene(&mut origin.report(&mut diagnostics), scene);
        let (found, idle) = describe(&origin, &variant, parts, &placed, &mut diagnostics);
        diagnostics.found_without(before, &variant.left_out);
        scenes.extend(variant.scene.map(|name| Scene { name, description: found }));
        // A name that one of them uses counts as used.
        unused.retain(|warning| idle.iter().any(|found| found.message == warning.message));
        let (name, whole) = plan.place(scene);
        diagnostics.found_in_scene(before, &name, &whole);
    }
    if diagnostics.has_errors() {
        return Reading { description: None, scenes: Vec::new(), diagnostics };
    }
    unused.into_iter().for_each(|warning| diagnostics.push(warning));
    Reading { description: Some(description), scenes, diagnostics }
}

/// Where a model comes from.
pub(super) struct ModelOrigin<'o> {
    /// Name in diagnostics.
    name: &'o str,
    /// Files that it may name.
    files: AllowedFolders,
    /// Chains of its dimensions.
    chains: Vec<Chain>,
    /// Its zones.
    zones: Vec<Zone>,
    /// Where names and formulas are noted.
    mentions: Option<&'o Notes>,
}

impl<'o> ModelOrigin<'o> {
    /// Origin of a text, whose dimensions and zones are not read yet.
    pub(super) fn of(name: &'o str, files: AllowedFolders, mentions: Option<&'o Notes>) -> Self {
        Self { name, files, chains: Vec::new(), zones: Vec::new(), mentions }
    }

    /// A report that adds to these diagnostics.
    fn report<'d>(&self, diagnostics: &'d mut Diagnostics) -> Report<'d>
    where
        'o: 'd,
    {
        Report { diagnostics, files: self.files.clone(), mentions: self.mentions }
    }

    /// A model without contents, called after its file.
    fn empty(&self) -> Description {
        let stem = Path::new(self.name).file_stem();
        Description::empty(stem.map_or_else(|| self.name.to_owned(), |stem| stem.to_string_lossy().into_owned()))
    }
}

/// Reads every section, each before those that refer to it; the warnings are of parameters that are used nowhere.
fn describe(
    origin: &ModelOrigin,
    variant: &Variant,
    parts: Option<&Parts>,
    overrides: &[(Override, Span)],
    diagnostics: &mut Diagnostics,
) -> (Description, Vec<Diagnostic>) {
    let root = &variant.root;
    let mut reader = Reader::new(origin.report(diagnostics), origin.empty());
    definitions::note(&reader, root);
    reader.model.chains = origin.chains.clone();
    reader.model.zones = origin.zones.clone();
    reader.model.mechanism_mut().instances = parts.map_or_else(Vec::new, |parts| parts.instances.clone());
    let start = root.span.start..root.span.start;
    let Some(fields) = reader.fields::<keys::File>(root, start) else { return (reader.model, Vec::new()) };
    sections::title(&mut reader, &fields, variant.scene.as_deref());
    let mut robot = match fields.get("urdf") {
        None => None,
        Some(node) => {
            let Some(robot) = Urdf::read(&mut reader, node, &fields, Path::new(origin.name), root, overrides) else {
                return (reader.model, Vec::new());
            };
            Some(robot)
        }
    };
    reader.model.mechanism_mut().space = match &robot {
        Some(_) => Space { spatial: true, why: "the robot is in space".to_owned() },
        None => space::read(&mut reader, &fields),
    };
    let body_entries = section(&mut reader, fields.get("bodies"), "bodies");
    let own_bodies = robot.as_mut().map(|robot| robot.keep_of_links(body_entries));
    let body_entries = own_bodies.as_deref().unwrap_or(body_entries);
    let joint_entries = section(&mut reader, fields.get("joints"), "joints");
    let effect_entries = section(&mut reader, fields.get("effects"), "effects");
    let state_entries = section(&mut reader, fields.get("states"), "states");
    let output_entries = section(&mut reader, fields.get("outputs"), "outputs");
    let requirement_entries = section(&mut reader, fields.get("requirements"), "requirements");
    analysis::read(&mut reader, &fields);
    let initial_entries = section(&mut reader, analysis::values_of_start(&fields), "start values");
    let guess_entries = section(&mut reader, fields.get("guess"), "start values");

    let table_entries = section(&mut reader, fields.get("tables"), "tables");
    tables::read(&mut reader, table_entries);
    let parameter_entries = section(&mut reader, fields.get("parameters"), "parameters");
    let with_robot = robot.as_ref().map(|robot| robot.parameters(&mut reader, parameter_entries));
    let parameter_entries = with_robot.as_deref().unwrap_or(parameter_entries);

    bodies::declare(&mut reader, body_entries);
    parts.into_iter().for_each(|parts| {
        instances::declare_ports(&mut reader, parts);
        instances::stand(&mut reader, parts);
    });
    joints::declare(&mut reader, joint_entries);
    let robot = robot.map(|robot| robot.declare(&mut reader, parameter_entries));
    design::declare(&mut reader, &fields);
    let free = parameters::read(&mut reader, parameter_entries, overrides);
    black_box::read(&mut reader, &fields, parameter_entries, Path::new(origin.name));
    trajectories::read(&mut reader, &fields);
    excitations::read(&mut reader, &fields);
    bodies::read(&mut reader, body_entries);
    zone_sizes::check(&mut reader);
    robot.iter().for_each(|robot| robot.read_points(&mut reader));
    states::declare(&mut reader, state_entries, effect_entries);
    joints::read(&mut reader, joint_entries);
    effects::read(&mut reader, effect_entries);
    states::read(&mut reader, state_entries);
    reader.model.mechanism_mut().initial = requests::start_values(&mut reader, initial_entries, true);
    reader.model.mechanism_mut().guess = requests::start_values(&mut reader, guess_entries, false);
    let limits = fields.get("limits").map(|node| (node, fields.key_span("limits")));
    match &robot {
        Some(robot) => robot.finish(&mut reader, &variant.robot, limits, output_entries.is_empty()),
        None => sections::no_robot(&mut reader, &fields),
    }
    // A robot's own effects have names, too.
    requests::outputs(&mut reader, output_entries);
    black_box::all_outputs(&mut reader.model);
    teeth::check(&mut reader, joint_entries, effect_entries, output_entries);
    analysis::check_outputs(&mut reader, output_entries);
    analysis::read_modes(&mut reader, &fields);
    if let Some(node) = fields.get("simulation") {
        requests::simulation_section(&mut reader, node, fields.key_span("simulation"));
    }
    analysis::fit_time(&mut reader.model);
    requirements::read(&mut reader, requirement_entries);
    motion_times::check(&mut reader, output_entries, requirement_entries);
    design::read(&mut reader, &fields, &free);
    if variant.partial {
        reader.idle = parameters::idle(&reader);
    }
    excitations::check_limits(&mut reader, &fields);
    let unused_excitations = excitations::unused(&mut reader, &fields);
    let bounds_section = fields.get("bounds").map(|node| (node, fields.key_span("bounds")));
    if let Some(bounds) = bounds::read(&mut reader, bounds_section) {
        reader.model.bounds = bounds;
    }
    let section = fields.get("statistics").map(|node| (node, fields.key_span("statistics")));
    statistics::read(&mut reader, section);
    states::check(&mut reader, &fields, effect_entries);
    states::check_instants(&mut reader, effect_entries);
    analysis::check_joints(&mut reader, joint_entries);
    excitations::check_joints(&mut reader, joint_entries);
    random::check_joints(&mut reader, joint_entries);
    analysis::check_speeds(&mut reader, joint_entries);
    analysis::check_requests(&mut reader, &fields, [output_entries, requirement_entries]);
    sections::missing_sections(&mut reader, &fields, robot.is_some(), body_entries, output_entries);
    reader.warn_of_lengths();
    fmu::check_parameters(&mut reader, &fields, parameter_entries);
    let is_count = |name: &str| parts.is_some_and(|parts| parts.is_count(name));
    let mut unused = parameters::unused(&reader, parameter_entries, is_count);
    design::check_used(&mut reader, &fields, &unused, variant.partial);
    unused.extend(unused_excitations);
    let Reader { mut model, idle, .. } = reader;
    model.parameters.retain(|parameter| !idle.contains(&parameter.name));
    (model, unused)
}

fn section<'n>(reader: &mut Reader, node: Option<&'n Node>, what: &str) -> &'n [Entry] {
    node.map_or(&[], |node| reader.named_entries(node, what))
}
