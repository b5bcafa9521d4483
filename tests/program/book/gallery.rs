//! `docs/gallery.md`: a picture of every model that comes with mbint, made by `mbint show`, that leads to its file.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::{BINARY, docs, expect_page};

const FILES: &str = "https://github.com/mbint/mbint/blob/main/models";

const HEAD: &str = "# Gallery

Every model of `models/`, as `mbint show` draws it at its start; a picture leads to the model's file. With what their bounds are compared is
[a table](guides/models.md) of its own. `MBINT_UPDATE_DOCS=1 cargo test --test program gallery` draws them anew.
";

/// All models but the template, which `mbint new` writes.
fn models() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("models")).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| {
        file.extension().is_some_and(|extension| extension == "yaml") && !file.ends_with("template.yaml")
    });
    files.sort();
    files
}

/// The first sentence of the comment at a model's head.
fn first_sentence(text: &str) -> String {
    let lines = text
        .lines()
        .skip_while(|line| line.starts_with("# yaml-language-server"))
        .map_while(|line| line.strip_prefix('#'));
    let lines = lines.map(str::trim).skip_while(|line| line.is_empty()).take_while(|line| !line.is_empty());
    let head = lines.collect::<Vec<_>>().join(" ");
    let sentence = head.split(". ").next().unwrap();
    sentence.trim_end_matches(['.', ':', ',', ';']).replace('|', "\\|")
}

#[test]
fn the_gallery_has_every_model() {
    let mut page = HEAD.to_owned();
    for file in models() {
        let name = file.file_stem().unwrap().to_str().unwrap();
        let place = tempfile::tempdir().unwrap();
        let shown = Command::new(BINARY).arg("show").arg(&file).arg("-o").arg(place.path()).output().unwrap();
        assert!(shown.status.success(), "{name}: {}", String::from_utf8_lossy(&shown.stderr));
        let picture = std::fs::read_to_string(place.path().join("mechanism.svg")).unwrap();
        expect_page(&docs().join(format!("images/models/{name}.svg")), &picture);
        let sentence = first_sentence(&std::fs::read_to_string(&file).unwrap());
        page += &format!("\n## {name}\n\n{sentence}.\n\n[![{name}](images/models/{name}.svg)]({FILES}/{name}.yaml)\n");
    }
    expect_page(&docs().join("gallery.md"), &page);
}
