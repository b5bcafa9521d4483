//! Whole steps of HHT-I3, Newton's iteration included. Divan's items are samples.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

mod models;

use divan::counter::ItemsCount;
use divan::{Bencher, bench};
use mbint::Model;
use models::STEP;
use symdiff::WIDTHS;

fn main() {
    divan::main();
}

fn steps(bencher: Bencher, width: usize, model: &Model) {
    let simulator = models::prepare(model);
    let mut stepper = models::stepper(&simulator, width);
    let mut time = 0.0;
    bencher.counter(ItemsCount::new(width)).bench_local(|| {
        time += STEP;
        stepper.step(STEP, time)
    });
}

#[bench(args = WIDTHS)]
fn slider_crank(bencher: Bencher, width: usize) {
    steps(bencher, width, &models::slider_crank());
}

#[bench(args = WIDTHS)]
fn four_bar_of_40_loops(bencher: Bencher, width: usize) {
    steps(bencher, width, &models::four_bar(40));
}

/// One sample, against the number of loops.
#[bench(args = [2, 10, 40, 100, 1000])]
fn four_bar(bencher: Bencher, loops: usize) {
    steps(bencher, 1, &models::four_bar(loops));
}
