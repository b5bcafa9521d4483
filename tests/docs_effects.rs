//! What `docs/effects.md` shows is so: every example is assembled, and every effect and picture is there.

use std::path::Path;

use mbint::{batch, model};

const PAGE: &str = include_str!("../docs/effects.md");

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
        let description =
            model::load_str("effects.md", &text, &[]).unwrap_or_else(|told| panic!("{}", told.render(false)));
        batch::prepare(&description).unwrap_or_else(|error| panic!("{error}\n{text}"));
    }
}

#[test]
fn every_effect_has_an_example_and_a_picture() {
    for keyword in model::effect_keywords() {
        assert!(PAGE.contains(&format!("{{ {keyword}:")) || PAGE.contains(&format!("    {keyword}:")), "{keyword}");
        let picture = format!("images/effects/{keyword}.svg");
        assert!(PAGE.contains(&picture), "{keyword}");
        assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(&picture).is_file(), "{picture}");
    }
}
