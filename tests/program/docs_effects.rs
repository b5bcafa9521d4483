//! What `docs/guides/effects.md` shows is so: every example is assembled, every effect and picture is there, and what effects
//! cost is about what is written.

use std::path::Path;

use mbint::{model, study};

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
        let description =
            model::load_str("effects.md", &text, &[]).unwrap_or_else(|told| panic!("{}", told.render(false)));
        study::prepare(&description).unwrap_or_else(|error| panic!("{error}\n{text}"));
    }
}

#[test]
fn every_effect_has_an_example_and_a_picture() {
    for keyword in model::EffectKind::KEYWORDS {
        assert!(PAGE.contains(&format!("{{ {keyword}:")) || PAGE.contains(&format!("    {keyword}:")), "{keyword}");
        let picture = format!("images/effects/{keyword}.svg");
        assert!(PAGE.contains(&picture), "{keyword}");
        assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(&picture).is_file(), "{picture}");
    }
}

/// Numbers of a row of the page's table of costs: an iteration, a factorisation, a step, and the same apart.
fn written(keyword: &str) -> Option<Vec<i64>> {
    let cells = PAGE.lines().filter_map(|line| line.strip_prefix(&format!("| `{keyword}` |")));
    let numbers = cells.filter_map(|cells| {
        let numbers = cells.split(['|', ',']).map(str::trim).filter(|cell| !cell.is_empty());
        numbers.map(|number| number.parse().ok()).collect::<Option<Vec<i64>>>()
    });
    numbers.into_iter().next()
}

/// The table is counted, not estimated; a few instructions more or less come and go with the order of elimination.
#[test]
fn the_costs_of_effects_are_about_as_written() {
    let mut table = String::new();
    let mut wrong = Vec::new();
    for (keyword, cost) in study::language_costs().unwrap() {
        let numbers = |part: mbint::results::StepInstructions| [part.iteration, part.factor, part.step];
        let counted = [Some(cost.acting), cost.apart].into_iter().flatten().flat_map(numbers).collect::<Vec<_>>();
        let cells: Vec<String> = counted.iter().map(i64::to_string).collect();
        table += &format!("| `{keyword}` | {} | {} |\n", cells[..3].join(" | "), cells[3..].join(", "));
        let near = |written: &i64, counted: &i64| (written - counted).abs() <= 5 + counted.abs() / 10;
        match written(keyword) {
            Some(numbers)
                if numbers.len() == counted.len() && numbers.iter().zip(&counted).all(|(a, b)| near(a, b)) => {}
            found => wrong.push((keyword, found, counted)),
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}\nThe table should be\n{table}");
}
