//! Cost of conditional effects: a scan of 1024 samples in lockstep, without them, with them far from touching, and with
//! some samples touching some of the time. Medians of the ratios to the bare model, with the quartiles.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

mod paired;

use mbint::inner::model::{Description, load_str};
use mbint::inner::study::{Options, prepare, run};
use mbint::results::Method;
use paired::{Paired, paired};

/// Pairs of runs of each comparison.
const PAIRS: usize = 101;

/// The paper's slider crank with more in `ground` and `effects`.
fn slider_crank(name: &str, points: &str, effects: &str) -> Description {
    let text = include_str!("../models/slider_crank.yaml")
        .replace("bodies:\n", &format!("bodies:\n  ground: {{ points: {{ O: [0, 0], {points} }} }}\n"))
        .replace("initial:", &format!("{effects}initial:"))
        .replace("duration: 2,", "duration: 0.4,")
        .replace("points: 30", "points: 32");
    load_str(name, &text, &[]).unwrap_or_else(|wrong| panic!("{}", wrong.render(false)))
}

/// Contacts of points of the crank and the rod with `count` floors, a metre and more below them.
fn floors(count: usize, friction: &str) -> Description {
    let floor = |i: usize| format!("F{i}: [0, -{}]", 1.0 + 0.1 * i as f64);
    let contact = |i: usize| {
        let point = ["crank.B", "rod.C", "rod", "crank"][i % 4];
        format!(
            "  floor{i}: {{ contact: {{ between: [ground.F{i}, {point}], plane: y, radius: 0.05, \
             impact: {{ stiffness: 1e6, restitution: 0.7, impact_velocity: 1 }}{friction} }} }}\n"
        )
    };
    let points: Vec<String> = (0..count).map(floor).collect();
    let effects: String = (0..count).map(contact).collect();
    slider_crank(&format!("{count} floors"), &points.join(", "), &effects)
}

/// `count` rollers next to the mechanism, which the rod's middle does not reach.
fn rollers(count: usize) -> Description {
    let points: Vec<String> = (0..count).map(|i| format!("R{i}: [{}, 1]", 0.1 * i as f64)).collect();
    let contact = |i: usize| {
        format!(
            "  roller{i}: {{ contact: {{ between: [ground.R{i}, rod], circle: 0.1, radius: 0.05, impact: {{ stiffness: 1e6 }} }} }}\n"
        )
    };
    slider_crank(&format!("{count} rollers"), &points.join(", "), &(0..count).map(contact).collect::<String>())
}

/// `count` stops of the crank's joint, none of which it reaches.
fn stops(count: usize) -> Description {
    let stop = |i: usize| {
        let end = 100 + i;
        format!(
            "  stop{i}: {{ stop: {{ on: pivot, lower: -{end}, upper: {end}, impact: {{ stiffness: 1e4, dissipation: 0.1 }} }} }}\n"
        )
    };
    slider_crank(&format!("{count} stops"), "", &(0..count).map(stop).collect::<String>())
}

/// A buffer that the slider hits in a part of each turn.
fn buffer(at: &str) -> Description {
    let effect = "  buffer: { contact: { between: [ground.W, slider], plane: [-1, 0], impact: { stiffness: 1e4, exponent: 1, dissipation: 0.1 } } }\n";
    slider_crank(&format!("buffer at {at}"), &format!("W: [{at}, 0]"), effect)
}

fn main() {
    let friction = ", friction: { coefficient: 0.3, breakaway: 1.2, stribeck_velocity: 0.1 }";
    let bare = slider_crank("bare", "", "");
    let cases = [
        ("itself", slider_crank("bare", "", "")),
        ("1 far contact", floors(1, "")),
        ("4 far contacts", floors(4, "")),
        ("16 far contacts", floors(16, "")),
        ("1 with friction", floors(1, friction)),
        ("4 with friction", floors(4, friction)),
        ("16 with friction", floors(16, friction)),
        ("4 far rollers", rollers(4)),
        ("2 far stops", stops(2)),
        ("8 far stops", stops(8)),
        ("buffer never touched", buffer("1")),
        ("buffer touched at times", buffer("l2 + 0.9*l1")),
        ("buffer touched half the time", buffer("l2")),
    ];
    let ran = |description: &Description| {
        let options = Options { methods: Some(vec![Method::Scan]), threads: Some(1), ..Options::default() };
        run(description, options).expect("the model runs");
    };
    println!("{:30} {:>8} {:>23} {:>22}", "bare, against", "seconds", "ratio", "instructions, apart");
    for (name, description) in &cases {
        let Paired { seconds: [_, seconds], ratio: [low, ratio, high] } =
            paired(PAIRS, [&|| ran(&bare), &|| ran(description)]);
        let program = prepare(description).expect("the model compiles").program;
        let tapes = [program.step(), program.factor(), program.first_correction(), program.advance()];
        let [all, apart] = [true, false].map(|active| tapes.iter().map(|tape| tape.len_where(active)).sum::<usize>());
        println!("{name:30} {seconds:8.3} {ratio:7.3} ({low:.3} to {high:.3}) {all:14} {apart:7}");
    }
}
