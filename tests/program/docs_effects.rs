//! `docs/guides/effects.md` is correct: every example is assembled, every picture is shown; and the reference of
//! effects is that of the code.

use std::path::Path;

use mbint::Model;
use mbint::inner::{applications, model};

const PAGE: &str = include_str!("../../docs/guides/effects.md");

/// The first block is the mechanism; each other replaces or adds sections, or is a model of its own.
fn models() -> Vec<String> {
    let blocks: Vec<&str> =
        PAGE.split("```").skip(1).step_by(2).filter_map(|block| block.strip_prefix("yaml\n")).collect();
    let (mechanism, examples) = blocks.split_first().unwrap();
    let with = |example: &&str| {
        if example.starts_with("bodies:") {
            return (*example).to_owned();
        }
        let replaced = example.starts_with("joints:");
        let kept: Vec<&str> = mechanism.lines().collect();
        let joints = kept.iter().position(|line| *line == "joints:").unwrap();
        let initial = kept.iter().position(|line| line.starts_with("initial:")).unwrap();
        let kept = if replaced { [&kept[..joints], &kept[initial..]].concat() } else { kept };
        // Motors decide where their joints start.
        let kept: Vec<String> = kept
            .iter()
            .map(|line| if replaced { line.replace("arm.angle: 0.3, cart.x: 1, ", "") } else { (*line).to_owned() })
            .collect();
        format!("{}\n{example}", kept.join("\n"))
    };
    [vec![(*mechanism).to_owned()], examples.iter().map(with).collect()].concat()
}

#[test]
fn the_examples_are_right() {
    let models = models();
    assert!(models.len() >= 8);
    for text in models {
        let model = Model::from_yaml_str("effects.md", &text).unwrap_or_else(|error| panic!("{error}"));
        model.check().unwrap_or_else(|error| panic!("{error}\n{text}"));
    }
}

/// Every effect has its example in the reference; the guide shows those that have a picture.
#[test]
fn every_picture_is_shown_next_to_an_example() {
    let pictures = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/images/effects");
    let names = std::fs::read_dir(pictures).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    for name in names {
        assert!(PAGE.contains(&format!("images/effects/{name}")), "{name}");
        let keyword = name.trim_end_matches(".svg");
        if model::EffectKind::KEYWORDS.contains(&keyword) {
            assert!(PAGE.contains(&format!("{{ {keyword}:")) || PAGE.contains(&format!("    {keyword}:")), "{keyword}");
        }
    }
}

/// `MBINT_UPDATE_DOCS=1 cargo test --test program docs_effects` writes the page.
#[test]
fn the_reference_of_effects_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reference/effects.md");
    let current = mbint::inner::export::effects_page(&applications::language_costs().unwrap());
    if std::env::var_os("MBINT_UPDATE_DOCS").is_some() {
        std::fs::write(&path, &current).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap();
    assert!(committed == current, "write it anew: MBINT_UPDATE_DOCS=1 cargo test --test program");
}
