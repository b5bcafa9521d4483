//! The operations of a step by kind, of every shipped model: `cargo bench -p mbint-benches --bench operations`. They do
//! not depend on the machine.

mod models;

use std::path::Path;

use mbint::inner::compile::Tapes;
use mbint::inner::model::load;
use mbint::inner::study::prepare;
use symdiff::{Binary, Op, Tape, Unary};

/// A name, and a test for its operations.
type OfKind = (&'static str, fn(Op) -> bool);

/// Kinds of operations, and tests for their instructions.
const KINDS: [OfKind; 7] = [
    ("+ −", |op| matches!(op, Op::Binary(Binary::Add | Binary::Sub))),
    ("·", |op| matches!(op, Op::Binary(Binary::Mul))),
    ("· ±", |op| matches!(op, Op::MulAdd | Op::MulSub | Op::NegMulAdd)),
    ("/", |op| matches!(op, Op::Binary(Binary::Div))),
    ("√", |op| matches!(op, Op::Unary(Unary::Sqrt))),
    ("sin cos", |op| matches!(op, Op::SinCos)),
    ("all", |_| true),
];

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let files = std::fs::read_dir(&folder).expect("the models are there");
    let mut files: Vec<_> = files.map(|file| file.expect("the folder can be read").path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "yaml"));
    files.sort();
    println!("| model | tape |{}", KINDS.map(|(name, _)| format!(" {name} |")).concat());
    println!("| --- | --- |{}", " --: |".repeat(KINDS.len()));
    for file in files {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        // An analysis without a motion has no steps.
        let Some(simulator) = load(&file, &[]).ok().and_then(|model| prepare(&model).ok()) else { continue };
        let (program, start) = (&simulator.program, &simulator.start);
        let tapes: [(&str, &Tape); 10] = [
            ("sample", program.sample()),
            ("step size", program.step_size()),
            ("step", program.step()),
            ("factor", program.factor()),
            ("first correction", program.first_correction()),
            ("correct", program.correct()),
            ("advance", program.advance()),
            ("observe", program.observe()),
            ("position", start.position()),
            ("acceleration", start.acceleration()),
        ];
        for (tape, of) in tapes {
            println!("| {name} | {tape} |{}", KINDS.map(|(_, kind)| format!(" {} |", of.count(kind))).concat());
        }
    }
}
