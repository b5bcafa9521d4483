//! The slider crank's tapes over tiles of every width. Divan's items are operations times samples, so that the
//! reciprocal of the throughput is the time of an operation for a sample.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

mod models;

use divan::counter::ItemsCount;
use divan::{Bencher, bench};
use mbint::inner::simulate::Simulator;
use symdiff::{Tape, WIDTHS};

fn main() {
    divan::main();
}

fn evaluate(bencher: Bencher, width: usize, tape: fn(&Simulator) -> &Tape) {
    let simulator = models::prepare(&models::slider_crank());
    let mut tile = models::stepper(&simulator, width).tile().clone();
    let tape = tape(&simulator);
    bencher.counter(ItemsCount::new(tape.len() * width)).bench_local(|| tile.run(tape));
}

/// Quantities of a step that its iteration does not change.
#[bench(args = WIDTHS)]
fn step(bencher: Bencher, width: usize) {
    evaluate(bencher, width, |simulator| simulator.program.step());
}

/// Newton matrix and its factors.
#[bench(args = WIDTHS)]
fn factor(bencher: Bencher, width: usize) {
    evaluate(bencher, width, |simulator| simulator.program.factor());
}

/// Residual and correction.
#[bench(args = WIDTHS)]
fn correct(bencher: Bencher, width: usize) {
    evaluate(bencher, width, |simulator| simulator.program.correct());
}

/// The same right after a factorisation.
#[bench(args = WIDTHS)]
fn first_correction(bencher: Bencher, width: usize) {
    evaluate(bencher, width, |simulator| simulator.program.first_correction());
}

/// The state at the step's end.
#[bench(args = WIDTHS)]
fn advance(bencher: Bencher, width: usize) {
    evaluate(bencher, width, |simulator| simulator.program.advance());
}
