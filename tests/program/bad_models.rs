//! Every file in `tests/bad_models` lists its diagnostics at the top: `# error[E0401]: 13:13 unknown body `crnk``, each
//! perhaps with `# help: …`, in a URDF or MJCF `<!-- error[…]: … -->`. Code, message and position must all be found,
//! and nothing else.
//!
//! `{effects}` stands for the list of all effects, which grows.
//!
//! `MBINT_UPDATE=1 cargo test --test program bad_models` writes the diagnostics that are found; then read the
//! difference.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use mbint::{Diagnostics, Error, Model};
use proptest::prelude::*;

use crate::place::{Place, diagnostics_of};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn slider_crank() -> String {
    fs::read_to_string(root().join("models/slider_crank.yaml")).unwrap()
}

fn is_expectation(line: &str) -> bool {
    let line = line.strip_prefix("<!-- ").or_else(|| line.strip_prefix("# "));
    line.is_some_and(|line| ["error[", "warning[", "help: "].iter().any(|start| line.starts_with(start)))
}

/// Lines as comments of the file's language; comments of XML contain no two hyphens in a row.
fn commented(path: &Path, lines: Vec<String>) -> Vec<String> {
    if path.extension().is_some_and(|extension| extension == "yaml") {
        return lines;
    }
    lines.iter().map(|line| format!("<!-- {} -->", line.trim_start_matches("# ").replace("--", "- -"))).collect()
}

/// `` `gravity`, … and `belt` ``.
fn list_effects() -> String {
    let (printed, _) = Place::new().run("explain --effects --format json", 0);
    let effects: Vec<serde_json::Value> = serde_json::from_str(&printed).unwrap();
    let quoted: Vec<String> =
        effects.iter().map(|effect| format!("`{}`", effect["keyword"].as_str().unwrap())).collect();
    let (last, others) = quoted.split_last().unwrap();
    format!("{} and {last}", others.join(", "))
}

fn found(diagnostics: &Diagnostics) -> Vec<String> {
    static EFFECTS: LazyLock<String> = LazyLock::new(list_effects);
    let mut lines = Vec::new();
    for record in diagnostics.records() {
        let severity = format!("{:?}", record.severity).to_lowercase();
        let place = match (record.line, record.column) {
            (Some(line), Some(column)) => format!("{line}:{column} "),
            _ => String::new(),
        };
        lines.push(format!("# {severity}[{}]: {place}{}", record.code, record.message));
        lines.extend(record.help.map(|help| format!("# help: {}", help.replace(EFFECTS.as_str(), "{effects}"))));
    }
    lines
}

fn bad_models() -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = fs::read_dir(root().join("tests/bad_models"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension().is_some_and(|extension| ["yaml", "urdf", "xml"].iter().any(|known| extension == *known))
        })
        .collect();
    paths.sort();
    paths
}

#[test]
fn bad_models_are_reported_with_positions() {
    let update = std::env::var_os("MBINT_UPDATE").is_some();
    let mut failures = String::new();
    let paths = bad_models();
    assert!(paths.len() >= 50, "only {} bad models", paths.len());
    for path in paths {
        let text = fs::read_to_string(&path).unwrap();
        let expected: Vec<&str> = text.lines().take_while(|line| is_expectation(line)).collect();
        let got = commented(&path, found(&diagnostics_of(Model::from_file(&path))));
        if got == expected {
            assert!(!expected.is_empty(), "{} is not bad", path.display());
            continue;
        }
        if update {
            let body: String = text.split_inclusive('\n').skip(expected.len()).collect();
            let with = |lines: &[String]| format!("{}\n{body}", lines.join("\n"));
            // The locations move down by the lines that are written: a second pass gives the final ones.
            fs::write(&path, with(&got)).unwrap();
            let moved = commented(&path, found(&diagnostics_of(Model::from_file(&path))));
            fs::write(&path, with(&moved)).unwrap();
        }
        failures +=
            &format!("{}\n  expected:\n{}\n  found:\n{}\n", path.display(), expected.join("\n"), got.join("\n"));
    }
    assert!(failures.is_empty(), "{failures}");
}

#[test]
#[ignore = "2 s"]
fn every_bad_model_renders() {
    for path in bad_models() {
        let diagnostics = diagnostics_of(Model::from_file(&path));
        for colour in [true, false] {
            let text = diagnostics.render(colour);
            assert!(!text.is_empty());
            assert!(text.lines().all(|line| line.chars().count() < 1000), "{}", path.display());
        }
    }
}

#[test]
fn an_error_looks_like_rustc() {
    let text = slider_crank().replace("[crank.B, rod.B]", "[crnk.B, rod.B]");
    let diagnostics = wrong("models/x.yaml", &text);
    let expected = "\
error[E0401]: unknown body `crnk`
  --> models/x.yaml:19:23
   |
19 |   pin:   { revolute: [crnk.B, rod.B] }
   |                       ^^^^
   |
   = help: did you mean `crank`?
";
    assert_eq!(diagnostics.render(false), expected);
}

#[test]
fn both_positions_of_a_duplicate_are_shown() {
    let text = "parameters:\n  a: 1\n  a: 2\n";
    let rendered = wrong("x.yaml", text).render(false);
    assert!(rendered.contains("first here") && rendered.contains("again here"), "{rendered}");
}

#[test]
fn very_long_lines_are_cut() {
    let filler = "x".repeat(1_000_000);
    let text = format!("outputs: {{ {filler}: 1, b: [2], y: {filler} }}");
    let diagnostics = wrong("x.yaml", &text);
    let rendered = diagnostics.render(false);
    assert!(rendered.len() < 20_000, "{} bytes", rendered.len());
    let place = diagnostics.records().into_iter().find(|record| record.column.is_some_and(|column| column > 1_000_000));
    assert!(rendered.contains(&format!("x.yaml:1:{}", place.unwrap().column.unwrap())), "{rendered}");
}

/// The diagnostics of a text with errors.
#[track_caller]
fn wrong(name: &str, text: &str) -> Diagnostics {
    wrong_of(Model::from_yaml_str(name, text))
}

#[track_caller]
fn wrong_of(model: Result<Model, Error>) -> Diagnostics {
    let Err(Error::Model(diagnostics)) = model else { panic!("it has no errors") };
    diagnostics
}

fn error_of(path: &Path) -> String {
    let diagnostics = wrong_of(Model::from_file(path));
    let rendered = diagnostics.render(false);
    assert!(rendered.contains(&path.display().to_string()), "{rendered}");
    let record = diagnostics.records().remove(0);
    record.message
}

#[test]
fn files_without_a_model_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path
    };
    assert_eq!(error_of(&folder.path().join("missing.yaml")), "the file cannot be read: there is no such file");
    assert_eq!(error_of(folder.path()), "this is a directory, not a file");
    assert_eq!(error_of(&file("empty.yaml", b"")), "the file is empty");
    assert_eq!(error_of(&file("comments.yaml", b"# nothing\n# here\n")), "the file is empty");
    let latin = "the file is not UTF-8 text: line 2, column 6, behind `b: üx`";
    assert_eq!(error_of(&file("latin1.yaml", b"a: 1\nb: \xc3\xbcx\xff\n")), latin);
    assert!(error_of(&file("binary.yaml", &[0x7f, b'E', b'L', b'F', 2, 1, 1, 0])).contains("zero byte"));
    let large = folder.path().join("large.yaml");
    fs::File::create(&large).unwrap().set_len(100_000_000).unwrap();
    assert_eq!(error_of(&large), "the file has 100.0 MB; a model may have 10 MB");
    let mut bomb = "a: &a [x,x,x,x,x,x,x,x,x]\n".to_owned();
    for (this, last) in ('b'..='i').zip('a'..) {
        bomb += &format!("{this}: &{this} [{}]\n", vec![format!("*{last}"); 9].join(","));
    }
    let records = wrong("bomb.yaml", &bomb).records();
    for message in ["anchors are not supported", "aliases are not supported"] {
        assert!(records.iter().any(|record| record.message == message));
    }
    for (name, open) in [("flow.yaml", "["), ("block.yaml", "- "), ("maps.yaml", "{a: ")] {
        let message = error_of(&file(name, open.repeat(100_000).as_bytes()));
        assert_eq!(message, "mappings and lists nest deeper than 40 levels");
    }
    let formula = slider_crank().replace("l1 + l2", &"(".repeat(100_000));
    assert!(error_of(&file("formula.yaml", formula.as_bytes())).contains("nests deeper"));
}

#[test]
#[ignore = "8 s"]
fn all_errors_of_a_large_file_are_counted() {
    let mut text = "bodies: { b: { mass: 1, coordinates: [x] } }\noutputs: { x: b.x }\n".to_owned();
    text += "simulation: { duration: 1 }\nparameters:\n";
    for index in 0..20_000 {
        let value = if index == 0 { "1".to_owned() } else { format!("p{} + q{index}", index - 1) };
        text += &format!("  p{index}: {value}\n");
    }
    let diagnostics = wrong("x.yaml", &text);
    assert_eq!(diagnostics.errors(), 19_999);
    assert!(diagnostics.render(false).ends_with("… and 19949 more\n"));
}

/// One repeated mistake is one message, with the lines of its repetitions; machines get all of them.
#[test]
fn a_message_that_comes_often_is_shown_once() {
    let mut text = "outputs: { x: b1.x }\nsimulation: { duration: 1 }\nbodies:\n".to_owned();
    for index in 1..=24 {
        text += &format!("  b{index}: {{ mass: 1, density: 7800, coordinates: [x] }}\n");
    }
    let diagnostics = wrong("x.yaml", &text);
    assert_eq!(diagnostics.records().len(), 24);
    let rendered = diagnostics.render(false);
    assert_eq!(rendered.matches("error[").count(), 1, "{rendered}");
    assert!(rendered.contains("the same in 23 more places: line 5, 6, 7, 8, 9, 10, 11, 12, …"), "{rendered}");
    let two = text.lines().take(5).collect::<Vec<_>>().join("\n");
    let rendered = wrong("x.yaml", &two).render(false);
    assert_eq!(rendered.matches("error[").count(), 2, "{rendered}");
}

/// A word that is wrong of several bodies is one habit.
#[test]
fn a_slip_of_several_bodies_is_shown_once() {
    let text = "bodies:\n  rod: { mass: 1, inertia: 1 }\n  disc: { mass: 1, inertia: 1 }\n  cam: { mass: 1, inertia: 1 }\n\
                initial: { rod.angel: 0, disc.angel: 0 }\noutputs: { x: cam.angel, y: cam.width }\n\
                simulation: { duration: 1, step: 1e-3 }\n";
    let diagnostics = wrong("x.yaml", text);
    assert_eq!(diagnostics.records().len(), 4);
    let rendered = diagnostics.render(false);
    assert_eq!(rendered.matches("error[").count(), 2, "{rendered}");
    assert!(rendered.contains("the same in 2 more places (also of `cam`, `disc`): line 5, 6"), "{rendered}");
}

#[test]
fn faulty_overrides_are_reported_with_positions() {
    // Without a value there is nothing that Rust could set.
    let model = root().join("models/slider_crank.yaml");
    let (_, errors) = Place::new().run(&format!("check {} --set l1", model.display()), 2);
    assert!(errors.contains("a parameter is set with `=`"), "{errors}");
    let set = |text: &str| {
        let (name, value) = text.split_once('=').unwrap();
        Model::from_yaml_str("models/slider_crank.yaml", &slider_crank()).unwrap().with(name, value)
    };
    for (text, message, place, help) in [
        ("l3=1", "unknown parameter `l3`", Some((1, 1)), Some("did you mean `l1`?")),
        ("l1=", "the value is missing", Some((1, 1)), None),
        ("l1=[1,2", "the interval's `]` is missing", Some((1, 4)), None),
        ("l1=[1]", "an interval has two ends", Some((1, 4)), None),
        ("l1=[2, 1]", "the interval is reversed", Some((1, 4)), Some("the smaller one stands first: `[1, 2]`")),
        ("l1=1 kg", "a mass (kg) stands where a length (m) belongs", Some((1, 4)), None),
        ("l1=1±-1%", "a tolerance cannot be negative", Some((1, 6)), None),
        ("l1=1±", "a number belongs behind the `±`", Some((1, 4)), Some("e.g. `0.5 m ± 1%`")),
        ("l1=1 ± 1% ± 2%", "a tolerance has one `±`", Some((1, 4)), None),
        ("l1=1 + foo", "unknown parameter `foo`", Some((1, 8)), None),
    ] {
        let diagnostics = wrong_of(set(text));
        let record = diagnostics.records().into_iter().find(|record| record.file == "--set").unwrap();
        assert_eq!(record.message, message, "{text}");
        assert_eq!(record.line.zip(record.column), place, "{text}");
        if help.is_some() {
            assert_eq!(record.help.as_deref(), help, "{text}");
        }
        assert!(diagnostics.render(false).contains("--> --set:1:"), "{text}");
    }
}

/// Sound texts to be spoilt: a model of the plane, one with all elements of space, or one of scenes.
fn sound(which: usize) -> String {
    let file = ["models/slider_crank.yaml", "tests/bad_models/space.yaml", "models/door.yaml"][which];
    fs::read_to_string(root().join(file)).unwrap()
}

fn never_panics(text: &str) {
    let model = Model::from_yaml_str("x.yaml", text);
    let has_errors = model.is_err();
    let diagnostics = diagnostics_of(model);
    let rendered = diagnostics.render(false);
    assert_eq!(has_errors, diagnostics.has_errors());
    assert_eq!(rendered.is_empty(), diagnostics.is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn flipped_bytes_do_not_panic(
        which in 0..3_usize,
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = sound(which).into_bytes();
        for (index, byte) in flips {
            let at = index.index(bytes.len());
            bytes[at] = byte;
        }
        never_panics(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn edited_lines_do_not_panic(
        which in 0..3_usize,
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0..3), 1..5),
    ) {
        let text = sound(which);
        let mut lines: Vec<&str> = text.lines().collect();
        for (from, to, edit) in edits {
            let (from, to) = (from.index(lines.len()), to.index(lines.len()));
            match edit {
                0 if lines.len() > 1 => { lines.remove(from); }
                1 => lines.insert(to, lines[from]),
                _ => lines.swap(from, to),
            }
        }
        never_panics(&lines.join("\n"));
    }

    #[test]
    fn swapped_tokens_do_not_panic(
        which in 0..3_usize,
        swaps in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 1..5),
    ) {
        let text = sound(which);
        let mut tokens: Vec<String> = Vec::new();
        for c in text.chars() {
            match tokens.last_mut() {
                Some(token) if c.is_alphanumeric() && token.ends_with(char::is_alphanumeric) => token.push(c),
                _ => tokens.push(c.to_string()),
            }
        }
        for (a, b) in swaps {
            let (a, b) = (a.index(tokens.len()), b.index(tokens.len()));
            tokens.swap(a, b);
        }
        never_panics(&tokens.concat());
    }

    #[test]
    fn random_bytes_do_not_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        never_panics(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn random_overrides_do_not_panic(text in "l1=?[-+±%0-9a-z. \\[\\],=*/^()]{0,20}") {
        let (name, value) = text.split_once('=').unwrap_or((&text, ""));
        diagnostics_of(Model::from_yaml_str("x.yaml", &slider_crank()).unwrap().with(name, value)).render(false);
    }
}
