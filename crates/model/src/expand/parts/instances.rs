//! `instances:`, copies of assemblies with names, parameters and placements of their own.

use std::collections::HashMap;
use std::sync::Arc;

use super::Writer;
use super::in_model::InstanceEntries;
use super::parameters::{is_shared, scope_of_shared};
use super::placement::{GROUND, InstancePlacement};
use crate::elements::effects::{self, EffectKind};
use crate::elements::joints::JointKind;
use crate::expand::instance::{Instance, InstanceKind};
use crate::expand::tuning::TUNING;
use crate::grammar::mentions::NameKind;
use crate::keys;
use crate::syntax::codes::Code;
use crate::syntax::scope::Scope;
use crate::syntax::source::{Span, TextInstance};
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Value};

/// Sections whose entries an instance has under its own name.
const NAMED: [&str; 6] = ["bodies", "joints", "effects", "states", "initial", "guess"];

/// Prefix of the numbers of an instance's placement.
const AT: &str = "at";

/// An instance to be written out.
struct New {
    /// Its full name.
    name: String,
    /// Its assembly.
    of: String,
    definition: Arc<Entry>,
    /// Parameters that it gives.
    given: Vec<Entry>,
    placement: InstancePlacement,
    /// Scope of the instance that it is in.
    outer: Option<Arc<Scope>>,
}

impl Writer<'_, '_> {
    /// Writes out the instances of the model, and the entries that all instances of an assembly share.
    pub(super) fn instances_of_model(&mut self, root: &Node) {
        let mut names: Vec<String> = self.definitions.keys().cloned().collect();
        names.sort_unstable();
        for name in names {
            self.share(&name);
            self.check_scopes(&name);
        }
        let Some(node) = root.get("instances") else { return };
        let entries = self.report.entries(node, "instances");
        let instances = self.repeated(entries, 0, None);
        for instance in &instances {
            self.instance("", instance, &mut Vec::new());
        }
        self.check_names(&instances);
    }

    /// Reports effects that would act on bodies outside of the instances, once for each of them.
    fn check_scopes(&mut self, name: &str) {
        let Some(definition) = self.definitions.get(name).cloned() else { return };
        let Some(Value::Mapping(effects)) = definition.value.get("effects").map(|node| &node.value) else { return };
        for effect in effects {
            let Value::Mapping(kinds) = &effect.value.value else { continue };
            let is_world = |kind: &&Entry| EffectKind::scope_of(&kind.key) == Some(effects::Scope::EveryBody);
            let Some(kind) = kinds.iter().find(is_world) else { continue };
            let message =
                format!("`{}` acts on every body of the model, and so does not belong to an assembly", kind.key);
            let help = format!("write `{}` among the `effects` of the model: it acts on all instances", effect.key);
            self.report.error(Code::WorldEffect, kind.key_span.clone(), message, help);
        }
    }

    /// The parameters that are one for all instances.
    fn share(&mut self, name: &str) {
        let Some(definition) = self.definitions.get(name).cloned() else { return };
        let Some(fields) = self.report.fields::<keys::Assembly>(&definition.value, definition.key_span.clone()) else {
            self.definitions.remove(name);
            return;
        };
        let Some(shared) = fields.get("shared") else { return };
        let entries = fields.get("parameters").map_or(&[][..], |node| self.report.entries(node, "parameters"));
        match &shared.value {
            Value::Sequence(items) => {
                for item in items {
                    let Some(scalar) = self.report.scalar(item, "the name of a parameter") else { continue };
                    self.report.mentions(Some(NameKind::Parameter), &format!("{name}.{}", scalar.text), &item.span);
                    if !entries.iter().any(|entry| entry.key == scalar.text) {
                        let help =
                            suggest::help(&scalar.text, "parameters of it", entries.iter().map(|e| e.key.as_str()));
                        let message = format!("assembly `{name}` has no parameter `{}`", clip(&scalar.text));
                        self.report.error(Code::UnknownName, item.span.clone(), message, help);
                    }
                }
            }
            _ if shared.scalar().is_some_and(|scalar| scalar.text == "all") => {}
            _ => {
                let message = format!("`all` or a list of parameters belongs here, but here is {}", shared.kind());
                self.report.error(Code::WrongShape, shared.span.clone(), message, "write `[name, name]`".to_owned());
            }
        }
        let scope = Arc::new(scope_of_shared(name));
        let chosen: Vec<Entry> = entries.iter().filter(|entry| is_shared(Some(shared), &entry.key)).cloned().collect();
        if !chosen.is_empty() {
            self.parts.instances.push(Instance { name: name.to_owned(), kind: InstanceKind::Definition });
        }
        for entry in self.repeated(&chosen, 0, Some(&scope)) {
            self.add("parameters", Entry { key: format!("{name}.{}", entry.key), ..entry });
        }
    }

    /// Writes out an instance, whose entry is that of a copy already; `around` are the assemblies that it is in.
    fn instance(&mut self, outer: &str, entry: &Entry, around: &mut Vec<String>) {
        if self.is_full
            || !self.report.is_name(&entry.key, &entry.key_span, "an instance")
            || !self.is_free(entry, !outer.is_empty())
        {
            return;
        }
        let Some(fields) = self.report.fields::<keys::InstanceFile>(&entry.value, entry.key_span.clone()) else {
            return;
        };
        let Some(node) = self.report.required(&fields, "of") else { return };
        let Some(scalar) = self.report.scalar(node, "the name of an assembly") else { return };
        let of = match &scalar.scope {
            None => scalar.text.clone(),
            Some(scope) => {
                let filled = symdiff::formula::indices::fill(&scalar.text, &|name| scope.whole(name));
                filled.unwrap_or_else(|_| scalar.text.clone())
            }
        };
        self.report.mentions(Some(NameKind::Assembly), &of, &node.span);
        let Some(definition) = self.definitions.get(&of).cloned() else {
            let mut known: Vec<&str> = self.definitions.keys().map(String::as_str).collect();
            known.sort_unstable();
            let help = suggest::help(&of, "assemblies", known);
            self.report.error(Code::UnknownName, node.span.clone(), format!("unknown assembly `{}`", clip(&of)), help);
            return;
        };
        if around.contains(&of) || around.len() == TUNING.depth {
            let names: Vec<String> = around.iter().chain([&of]).map(|name| clip(name)).collect();
            let message = format!("an assembly is in itself: {}", names.join(" → "));
            self.report.error(Code::Circle, node.span.clone(), message, None);
            return;
        }
        let name = format!("{outer}{}", entry.key);
        self.report.defines(NameKind::Instance, &name, entry);
        let given = fields.get("parameters").map_or(&[][..], |node| self.report.entries(node, "parameters")).to_vec();
        let Some(placement) = self.placement(&format!("{name}."), &fields) else { return };
        let outer = scalar.scope.clone();
        around.push(of.clone());
        let new = New { name, of, definition, given, placement, outer };
        self.written_out(&new, entry, around);
        around.pop();
    }

    fn written_out(&mut self, new: &New, entry: &Entry, around: &mut Vec<String>) {
        let New { name, of, definition, placement, .. } = new;
        let prefix = format!("{name}.");
        let within = TextInstance { instance: name.clone(), of: of.clone(), span: entry.key_span.clone() };
        let shift = self.report.diagnostics.sources.copy(&definition.key_span, within);
        let entries_of = |section: &str| match definition.value.get(section).map(|node| &node.value) {
            Some(Value::Mapping(entries)) => entries.clone(),
            _ => Vec::new(),
        };
        let wrong = |section: &&str| {
            let node = definition.value.get(section);
            node.is_some_and(|node| !matches!(node.value, Value::Mapping(_)) && !node.is_null())
        };
        let sections = NAMED.into_iter().chain(["parameters", "ports", "instances"]);
        for node in sections.filter(wrong).filter_map(|section| definition.value.get(section)) {
            self.report.entries(node, "the parts of an assembly");
        }
        self.parts.instances.push(Instance { name: name.clone(), kind: InstanceKind::Assembly(of.clone()) });

        let plain = Arc::new(Scope::of_instance(name, None, Arc::default()));
        let own = self.repeated(&entries_of("parameters"), shift, Some(&plain));
        let shared = definition.value.get("shared");
        let parameters = self.parameters(of, &prefix, own, &new.given, |name| is_shared(shared, name));
        let counts = Arc::new(self.counts_of_instance(&prefix, &parameters));
        for parameter in parameters {
            self.add("parameters", parameter);
        }
        let frame = placement.frame_in(new.outer.as_ref().and_then(|outer| outer.frame()));
        self.parameters_of(&prefix, placement, new.outer.as_deref(), frame);
        let has_points = definition.value.get("bodies").and_then(|bodies| bodies.get(GROUND)).is_some();
        let ground = (has_points || frame.is_some()).then(|| format!("{prefix}{GROUND}"));
        let scope = Arc::new(Scope::of_instance(name, ground, counts).standing(frame));
        let places = self.sections_of(&prefix, &entries_of, &placement.span, shift, &scope);
        for instance in self.repeated(&entries_of("instances"), shift, Some(&scope)) {
            self.instance(&prefix, &instance, around);
        }
        self.image(&places, &scope);
        let ports = self.repeated(&entries_of("ports"), shift, Some(&scope));
        self.ports(&prefix, ports, frame.unwrap_or_default().mirrors);
        self.starts(&places, &scope);
    }

    /// Adds bodies, joints, effects and start values of an instance as its assembly says them.
    fn sections_of(
        &mut self,
        prefix: &str,
        entries_of: &dyn Fn(&str) -> Vec<Entry>,
        at: &Span,
        shift: usize,
        scope: &Arc<Scope>,
    ) -> InstanceEntries {
        let copies = NAMED.map(|section| self.repeated(&entries_of(section), shift, Some(scope)));
        let [bodies, joints, effects, states, initial, guess] = copies;
        let (ground, bodies): (Vec<Entry>, Vec<Entry>) = bodies.into_iter().partition(|body| body.key == GROUND);
        for part in [&bodies, &joints, &effects, &states].into_iter().flatten() {
            self.is_free(part, true);
        }
        if scope.has_ground() {
            let points = ground.first().and_then(|ground| ground.value.get("points")).cloned();
            self.ground(prefix, at, points, scope);
            self.parts.grounds.insert(prefix.to_owned(), scope.frame().unwrap_or_default().mirrors);
        }
        self.bodies.extend(bodies.iter().map(|body| scope.full(&body.key)));
        let turns = |joint: &Entry| match &joint.value.value {
            Value::Mapping(kinds) => kinds.iter().any(|kind| JointKind::turns(&kind.key)),
            _ => false,
        };
        self.turning.extend(joints.iter().map(|joint| (scope.full(&joint.key), turns(joint))));
        let all = [bodies, joints, effects, states, initial, guess];
        let [bodies, joints, effects, _, initial, guess] = std::array::from_fn(|index| {
            let (section, entries) = (NAMED[index], &all[index]);
            let start = self.entries(section).len();
            for entry in entries {
                let key = scope.full(&entry.key);
                self.add(section, Entry { key, ..entry.clone() });
            }
            start..self.entries(section).len()
        });
        InstanceEntries { bodies, joints, effects, starts: [("initial", initial), ("guess", guess)] }
    }

    /// Whether an instance or a part of one may be called so.
    pub(super) fn is_free(&mut self, entry: &Entry, is_part: bool) -> bool {
        let why = match entry.key.as_str() {
            GROUND => "fixed things have this name",
            AT if is_part => "numbers of the instance's place are called so: `left.at.x`",
            _ => return true,
        };
        let message = format!("`{}` cannot be the name of a part or an instance", entry.key);
        self.report.error(Code::BadName, entry.key_span.clone(), message, why.to_owned());
        false
    }

    /// Reports instances that are called like something else, and names that are there twice.
    fn check_names(&mut self, instances: &[Entry]) {
        let sections = ["bodies", "joints", "effects", "states", "parameters"];
        let definitions = self.definitions.values().map(AsRef::as_ref);
        let mut first: HashMap<&str, Option<Span>> = instances.iter().map(|own| (own.key.as_str(), None)).collect();
        for entry in sections.iter().flat_map(|section| self.entries(section)).chain(definitions) {
            if let Some(first) = first.get_mut(entry.key.as_str()) {
                first.get_or_insert_with(|| entry.key_span.clone());
            }
        }
        for instance in instances {
            if let Some(Some(first)) = first.get(instance.key.as_str()) {
                self.twice(&instance.key, &instance.key_span, first);
            }
        }
        for section in ["parameters", "bodies", "joints", "effects", "states", "initial", "guess"] {
            for (key, span, first) in duplicates(self.entries(section)) {
                self.twice(&key, &span, &first);
            }
        }
    }
}

/// Names that occur again: name, location, first location.
fn duplicates(entries: &[Entry]) -> Vec<(String, Span, Span)> {
    let mut first = HashMap::new();
    let mut found = Vec::new();
    for entry in entries {
        match first.get(entry.key.as_str()) {
            Some(known) => found.push((entry.key.clone(), entry.key_span.clone(), Span::clone(known))),
            None => {
                first.insert(entry.key.as_str(), entry.key_span.clone());
            }
        }
    }
    found
}
