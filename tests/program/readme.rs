//! The README is correct.

use mbint::Model;

const README: &str = include_str!("../../README.md");

/// The code blocks of a language.
fn blocks(language: &str) -> impl Iterator<Item = &'static str> {
    let parts = README.split("```").skip(1).step_by(2);
    parts.filter_map(move |block| block.strip_prefix(language)?.strip_prefix('\n'))
}

#[test]
fn the_models_are_right() {
    assert_eq!(blocks("yaml").count(), 1);
    for text in blocks("yaml") {
        Model::from_yaml_str("README.md", text).unwrap_or_else(|error| panic!("{error}")).check().unwrap();
    }
}

#[test]
fn the_first_screen_has_the_two_commands() {
    let first = blocks("sh").next().unwrap();
    assert_eq!(first, "cargo run --release -- run models/slider_crank.yaml\ncargo test --release\n");
    let before = README.split("cargo test").next().unwrap();
    assert!(before.lines().count() < 24, "they have left the first screen");
}

#[test]
fn rust_example_matches_that_of_the_guide() {
    // The guide's example is a doctest.
    let guide = include_str!("../../docs/guides/rust.md");
    assert_eq!(blocks("rust").count(), 1);
    for example in blocks("rust") {
        assert!(guide.contains(&format!("```rust\n{example}```")), "the README has\n{example}");
    }
}
