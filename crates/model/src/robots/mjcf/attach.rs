//! `<replicate>` and `<attach>`: copies of the elements in a body, and parts of other models, with names, classes and
//! settings of their own.

use std::path::Path;

use super::assets::name_of;
use super::couplings;
use super::document::Item;
use super::meshes;
use super::read::{Around, Contents, MjcfReader, Whole};
use super::values::Values;
use crate::robots::algebra;
use crate::robots::tuning::TUNING;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest::{self, clip};

impl<'i> MjcfReader<'_, 'i, '_> {
    /// Copies, each moved against the one before, with their number behind every name.
    pub fn replicate(&mut self, item: &'i Item, body: usize, around: &Around, contents: &mut Contents<'i>) {
        let Some(found) = item.get("count") else {
            self.values.error(Code::MissingXml, item.span.clone(), "`<replicate>` needs `count`", None);
            return;
        };
        let Some([count]) = self.values.exact::<1>(found) else { return };
        if count < 1.0 || count.fract() != 0.0 {
            self.values.error(Code::BadXmlValue, found.span.clone(), "`count` is a whole number, at least 1", None);
            return;
        }
        let offset = item.get("offset").and_then(|found| self.values.exact::<3>(found)).unwrap_or([0.0; 3]);
        let (_, turn) = self.values.frame(item, None, &[]);
        let separator = item.get("sep").map_or("", |found| found.value.as_str());
        let (count, digits) = (count as usize, format!("{}", count as usize - 1).len());
        let mut pose = around.pose.clone();
        let outer = self.suffix.clone();
        for index in 0..count {
            if self.is_too_many(item) {
                break;
            }
            self.suffix = format!("{separator}{index:0digits$}{outer}");
            self.inside(item, body, &Around { pose: pose.clone(), class: around.class }, contents);
            pose = pose.then(&algebra::vector(offset), &turn);
        }
        self.suffix = outer;
    }

    fn is_too_many(&mut self, item: &Item) -> bool {
        *self.whole.copies += 1;
        if *self.whole.copies == TUNING.mjcf_copies + 1 {
            self.values.error(
                Code::TooLarge,
                item.span.clone(),
                format!("the model has more than {mjcf_copies} copies", mjcf_copies = TUNING.mjcf_copies),
                None,
            );
        }
        *self.whole.copies > TUNING.mjcf_copies
    }

    /// Another model's world, or a body of it with all that couples and drives it.
    pub fn attach(&mut self, item: &'i Item, body: usize, around: &Around, contents: &mut Contents<'i>) {
        let Some(model) = item.get("model") else {
            self.values.error(Code::MissingXml, item.span.clone(), "`<attach>` needs `model`", None);
            return;
        };
        let models = || self.root.of("asset").flat_map(|asset| asset.of("model"));
        let Some(asset) = models().find(|known| name_of(known).as_ref() == Some(&model.value)) else {
            let names: Vec<String> = models().filter_map(name_of).collect();
            let help = suggest::help(&model.value, "models", names.iter().map(String::as_str));
            let error = Diagnostic::error(
                Code::UnknownName,
                model.span.clone(),
                format!("unknown model `{}`", clip(&model.value)),
            );
            self.values.diagnostics.push(error.help(help));
            return;
        };
        // A file that could not be read is reported.
        let Some(root) = asset.items.first().filter(|_| !self.is_too_many(item)) else { return };
        let file = asset.get("file").map_or("", |file| file.value.as_str());
        let folder = self.values.meshes.folder.join(Path::new(file).parent().unwrap_or(Path::new("")));
        let (flags, files) = (self.values.settings.flags, self.values.meshes.files);
        let mut values = Values::new(root, files, &folder, self.values.diagnostics);
        values.settings.flags = flags;
        let prefix = format!("{}{}", self.prefix, item.get("prefix").map_or("", |found| found.value.as_str()));
        let Whole { robot, names, touching, copies } = &mut self.whole;
        let whole = Whole { robot, names, touching, copies };
        let suffix = self.suffix.clone();
        let mut reader = MjcfReader { values: &mut values, root, whole, prefix: prefix.clone(), suffix };
        let around = |class| Around { pose: around.pose.clone(), class };
        match item.get("body") {
            None => root.of("worldbody").for_each(|world| reader.inside(world, body, &around(None), contents)),
            Some(named) => {
                let mut worlds = root.of("worldbody");
                let Some((found, class)) = worlds.find_map(|world| find(world, None, &named.value)) else {
                    let message = format!("the model `{}` has no body `{}`", clip(&model.value), clip(&named.value));
                    reader.values.error(Code::UnknownName, named.span.clone(), message, None);
                    return;
                };
                let class = class.and_then(|holder| reader.values.class_of(holder, None, "childclass"));
                reader.body(found, body, &around(class));
            }
        }
        if self.suffix.is_empty() {
            couplings::read(root, &mut values, self.whole.robot, self.whole.names, Some(&prefix));
        }
        meshes::warn(&mut values);
    }
}

/// A body of a name, and the element around it that says its class.
fn find<'i>(item: &'i Item, class: Option<&'i Item>, name: &str) -> Option<(&'i Item, Option<&'i Item>)> {
    let class = if item.get("childclass").is_some() { Some(item) } else { class };
    let is_it = |inner: &&Item| inner.tag == "body" && inner.get("name").is_some_and(|own| own.value == name);
    let found = item.items.iter().find(is_it).map(|found| (found, class));
    found.or_else(|| {
        let inside = item.items.iter().filter(|inner| matches!(inner.tag.as_str(), "body" | "frame" | "replicate"));
        inside.into_iter().find_map(|inner| find(inner, class, name))
    })
}
