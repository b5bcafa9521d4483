//! The order of the source: rooms of a crate import only earlier ones, files form no circles, and no file is long. The
//! order of crates is the compiler's to hold.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Sources of the crates with their rooms. Each room stands on those before it, and knows none after it.
const CRATES: [(&str, &[&str]); 15] = [
    ("crates/numerics/src", &["numerics"]),
    ("crates/certificate/src", &["certificate"]),
    ("crates/language/src", &["syntax", "grammar", "multibody"]),
    ("crates/methods/src", &["methods"]),
    ("crates/fmu/src", &["unit", "native", "run"]),
    ("crates/model/src", &["robots", "elements", "keys", "expand", "model"]),
    ("crates/equations/src", &["reduce", "assemble", "compile"]),
    ("crates/engine/src", &["simulate", "c_code"]),
    ("crates/study/src", &["results", "store", "black_box", "study"]),
    ("crates/applications/src", &["applications"]),
    ("crates/export/src", &["export", "overview"]),
    ("crates/lsp/src", &["lsp"]),
    ("crates/studio/src", &["studio"]),
    ("crates/playground/src", &["playground", "abi"]),
    ("src", &["api", "cli", "inner"]),
];

/// Lines that a file may have.
const LONGEST: usize = 400;

/// A module's path: `["robots", "urdf", "read"]`. Its file is `robots/urdf/read.rs` or `robots/urdf/read/mod.rs`.
type Module = Vec<String>;

/// The source of a package without its unit tests, by module.
struct Package(BTreeMap<Module, String>);

impl Package {
    fn of(folder: &str) -> Self {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let mut modules = BTreeMap::new();
        let mut folders = vec![(source, Module::new())];
        while let Some((folder, within)) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                let name = path.file_stem().unwrap().to_string_lossy().into_owned();
                if name == "tests" {
                    continue;
                }
                let module = [&within[..], std::slice::from_ref(&name)].concat();
                if path.is_dir() {
                    folders.push((path, module));
                } else if path.extension().is_some_and(|extension| extension == "rs") {
                    let module = if ["mod", "lib", "main"].contains(&name.as_str()) { within.clone() } else { module };
                    let text = fs::read_to_string(&path).unwrap();
                    modules.entry(module).or_insert_with(String::new).push_str(without_tests(&text));
                }
            }
        }
        Self(modules)
    }

    /// Modules of its own package that a module names, as paths from the root.
    fn named(&self, module: &Module) -> Vec<Module> {
        let text: Vec<&str> = self.0[module].lines().map(|line| line.split("//").next().unwrap()).collect();
        let text = text.join("\n");
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let mut found = Vec::new();
        for (at, _) in text.match_indices("::") {
            let start = text[..at].rfind(|c| !is_word(c)).map_or(0, |before| before + 1);
            if text[..start].ends_with("::") || start == at {
                continue;
            }
            let within: &[String] = match &text[start..at] {
                "crate" => &[],
                "super" => &module[..module.len().saturating_sub(1)],
                "self" => module,
                // In `use child::Item;` a child stands alone.
                child if self.0.contains_key(&[&module[..], &[child.to_owned()]].concat()) => module,
                _ => continue,
            };
            let mut rest = &text[start..];
            if ["crate", "super", "self"].contains(&&text[start..at]) {
                rest = &text[at + 2..];
            }
            let mut within = within.to_vec();
            while let Some(above) = rest.strip_prefix("super::") {
                within.pop();
                rest = above;
            }
            found.extend(expand(rest).0.into_iter().map(|path| [&within[..], &path].concat()));
        }
        found
    }

    /// The module that an item is written in: through re-exports of the modules on its path.
    fn home(&self, path: &[String]) -> Option<Module> {
        let depth = (0..=path.len()).rev().find(|&depth| self.0.contains_key(&path[..depth]))?;
        let (module, item) = (path[..depth].to_vec(), path.get(depth));
        let passed_on = item.and_then(|item| {
            let paths = self.named(&module).into_iter();
            let mut inner = paths.filter(|named| named.len() > depth + 1 && named.starts_with(&module));
            inner.find(|named| named.last() == Some(item))
        });
        passed_on.map_or(Some(module), |inner| self.home(&inner))
    }
}

/// Unit tests stand at the end of a file.
fn without_tests(text: &str) -> &str {
    text.split("#[cfg(test)]\nmod tests {").next().unwrap()
}

/// The paths of `a::{b, c::d}`, and how much of the text they take.
fn expand(text: &str) -> (Vec<Module>, usize) {
    let word = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
    if word > 0 {
        let own = text[..word].to_owned();
        let Some(rest) = text[word..].strip_prefix("::") else { return (vec![vec![own]], word) };
        let (inner, taken) = expand(rest);
        let inner: Vec<Module> = if inner.is_empty() { vec![Module::new()] } else { inner };
        return (
            inner.into_iter().map(|path| [std::slice::from_ref(&own), &path[..]].concat()).collect(),
            word + 2 + taken,
        );
    }
    let (mut paths, mut at) = (Vec::new(), 1);
    if !text.starts_with('{') {
        return (paths, 0);
    }
    while let Some(next) = text[at..].chars().next() {
        if next == '}' {
            return (paths, at + 1);
        }
        let (found, taken) = expand(&text[at..]);
        paths.extend(found);
        at += taken.max(next.len_utf8());
    }
    (paths, at)
}

#[test]
fn use_trees_are_expanded() {
    let join = |text: &str| expand(text).0.iter().map(|path| path.join("::")).collect::<Vec<_>>();
    assert_eq!(join("a::b;"), ["a::b"]);
    assert_eq!(join("a::{b, c::{d, self}, E};"), ["a::b", "a::c::d", "a::c::self", "a::E"]);
}

#[test]
fn rooms_import_only_earlier_rooms() {
    let mut wrong = BTreeSet::new();
    for (source, rooms) in CRATES {
        let package = Package::of(source);
        let index = |room: &String| rooms.iter().position(|known| known == room);
        for module in package.0.keys().filter(|module| !module.is_empty()) {
            let own = index(&module[0]).unwrap_or_else(|| panic!("where in {source} is {}?", module[0]));
            for path in package.named(module) {
                if path.first().and_then(index).is_some_and(|other| other > own) {
                    wrong.insert(format!("{} imports {}", module.join("::"), path.join("::")));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Modules that reach each other, but for a parent and its children.
fn circles(package: &Package) -> Vec<Vec<String>> {
    let mut reached: BTreeMap<&Module, BTreeSet<Module>> = BTreeMap::new();
    for module in package.0.keys() {
        let targets = package.named(module).into_iter().filter_map(|path| package.home(&path));
        let beside = targets.filter(|target| !target.starts_with(module) && !module.starts_with(target));
        reached.insert(module, beside.collect());
    }
    loop {
        let before: usize = reached.values().map(BTreeSet::len).sum();
        for module in package.0.keys() {
            let further: Vec<Module> = reached[module].iter().flat_map(|target| reached[target].clone()).collect();
            reached.get_mut(module).unwrap().extend(further);
        }
        if reached.values().map(BTreeSet::len).sum::<usize>() == before {
            break;
        }
    }
    let together = |module: &Module| -> Vec<String> {
        let others = reached[module].iter().filter(|other| reached[*other].contains(module));
        others.map(|module| module.join("::")).collect()
    };
    let circles: BTreeSet<Vec<String>> = package.0.keys().map(together).filter(|circle| !circle.is_empty()).collect();
    circles.into_iter().collect()
}

#[test]
fn files_form_no_circles() {
    let sources = CRATES.iter().map(|&(source, _)| source).chain(["crates/symdiff/src"]);
    let found: Vec<_> = sources.flat_map(|source| circles(&Package::of(source))).collect();
    assert!(found.is_empty(), "{found:#?}");
}

/// Crates in which a type has all its methods in its own file: a file uses nothing but its imports, so that the circles
/// above are complete.
const UNTIED: [&str; 3] = ["crates/study/src", "crates/export/src", "src"];

/// Types with inherent methods in a file that does not declare them.
fn strangers(text: &str) -> Vec<String> {
    let word = |text: &str| text.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap().to_owned();
    let declared: BTreeSet<String> = ["struct ", "enum ", "trait "]
        .iter()
        .flat_map(|keyword| text.match_indices(keyword).map(|(at, _)| word(&text[at + keyword.len()..])))
        .collect();
    let of_impl = |line: &str| {
        let mut rest = line.strip_prefix("impl")?;
        if rest.starts_with('<') {
            rest = rest.split_once("> ")?.1;
        }
        let is_inherent = !line.contains(" for ");
        is_inherent.then(|| word(rest.trim_start()))
    };
    text.lines().filter_map(of_impl).filter(|name| !declared.contains(name)).collect()
}

#[test]
fn strangers_are_found() {
    assert_eq!(strangers("struct A;\nimpl A {\n}\nimpl<'a> B<'a> {\n}\nimpl Clone for C {\n}"), ["B"]);
}

#[test]
fn types_have_their_methods_in_their_own_file() {
    let mut found = Vec::new();
    for source in UNTIED {
        for (module, text) in Package::of(source).0 {
            let own = strangers(&text).into_iter();
            found.extend(own.map(|name| format!("{source}: {name} in {}", module.join("::"))));
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn no_file_is_long() {
    let mut long = Vec::new();
    for folder in ["src", "crates"] {
        let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
        while let Some(folder) = folders.pop() {
            for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "rs")
                    && fs::read_to_string(&path).unwrap().lines().count() > LONGEST
                {
                    let within = path.strip_prefix(env!("CARGO_MANIFEST_DIR")).unwrap();
                    long.push(within.to_string_lossy().into_owned());
                }
            }
        }
    }
    assert!(long.is_empty(), "more than {LONGEST} lines: {long:#?}");
}
