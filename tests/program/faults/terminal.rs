//! Names from files that contain control sequences of a terminal.

use std::fs;

use crate::place::Place;

/// Control sequences in a name: set the title, clear the screen, colours, bell, return, the control characters of one
/// byte and of two, marks that reverse the line.
const HOSTILE: &str = "\\e]0;PWNED\\a\\e[2J\\e[31mx\\r\\x9b5m\\u202eabc\\u2066\\u200f\\u2028";

/// Everything that reached the terminal holds no control character but line ends and colours.
#[track_caller]
fn assert_harmless(text: &str) {
    for (at, c) in text.char_indices() {
        let colour = c == '\u{1b}' && {
            let end = text[at..].find('m').map_or(0, |end| at + end);
            text[at + 1..].starts_with('[')
                && end > at
                && text[at + 2..end].chars().all(|c| c.is_ascii_digit() || c == ';')
        };
        let harmful = c.is_control() && c != '\n' && !colour
            || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        assert!(!harmful, "{:?} in {:?}", c, &text[at.saturating_sub(30)..(at + 30).min(text.len())].escape_debug());
    }
    assert!(!text.contains("\u{1b}[2J") && !text.contains("\u{1b}[31mx"), "{}", text.escape_debug());
}

#[test]
fn names_from_files_are_shown_without_escape_sequences() {
    let place = Place::new();
    let raw = "\u{1b}]0;PWNED\u{7}\u{1b}[2J\u{1b}[31mx\u{9b}5m\u{202e}";
    let good = |name: &str| {
        format!(
            "model: \"{name}\"\nparameters: {{ m: {{ value: 1, tolerance: 1% }} }}\n\
             bodies: {{ rod: {{ mass: m, inertia: 1, points: {{ tip: [1, 0] }} }} }}\n\
             joints: {{ hinge: {{ revolute: [ground, rod.tip] }} }}\noutputs: {{ h: rod.x }}\n\
             simulation: {{ duration: 0.01, step: 0.001 }}\nbounds: {{ scan: {{ points: 2 }} }}\n"
        )
    };
    let models = [
        ("help.yaml", good("z").replace("parameters: { m:", &format!("parameters: {{ \"m{HOSTILE}\":"))),
        ("title.yaml", good(HOSTILE)),
        ("unknown.yaml", good("z").replace("rod.x", &format!("\"rod.{HOSTILE}\""))),
        ("raw.yaml", good("z").replace("rod.x", &format!("rod.{raw}"))),
        ("comment.yaml", good("z").replace("inertia: 1", &format!("inertia: nonsense # {raw}"))),
        (
            "robot.urdf",
            "<robot name=\"r\"><link name=\"base\"/><link name=\"\u{9b}[31mRED\u{9b}[2J\u{202e}\"/>\
             <joint name=\"j\" type=\"revolute\"><parent link=\"base\"/><child link=\"q\"/></joint></robot>"
                .to_owned(),
        ),
    ];
    for (name, text) in &models {
        fs::write(place.path().join(name), text).unwrap();
    }
    let odd = "odd\u{1b}[2J\u{202e}.yaml";
    fs::write(place.path().join(odd), "model: [").unwrap();
    for (name, _) in &models {
        for command in ["check", "run -o out", "explain", "cost --budget 0.1 -o out", "check --format json"] {
            for color in ["always", "never"] {
                let mut run = place.command(&format!("{command} --color {color}"));
                let done = run.arg(name).output().unwrap();
                assert_harmless(&String::from_utf8(done.stdout).unwrap());
                assert_harmless(&String::from_utf8(done.stderr).unwrap());
            }
        }
    }
    let done = place.command("check --color always").arg(odd).output().unwrap();
    assert_harmless(&String::from_utf8(done.stderr).unwrap());
}
