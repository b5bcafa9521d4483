//! Whole runs: the study of the paper, method by method, on one thread and on all; and model compilation.

#![allow(clippy::disallowed_methods, reason = "tests compare with the standard library's functions")]

mod models;

use divan::{Bencher, bench};
use mbint::results::Method;

fn main() {
    divan::main();
}

fn study(bencher: Bencher, methods: &[Method], threads: Option<usize>) {
    let model = models::slider_crank();
    bencher.bench_local(|| {
        let study = model.study().methods(methods).allow_costly();
        let study = match threads {
            Some(threads) => study.threads(threads),
            None => study,
        };
        study.run().expect("the model runs")
    });
}

/// The nominal sample and 36 of Chebyshev's.
#[bench]
fn chebyshev(bencher: Bencher) {
    study(bencher, &[Method::Chebyshev], None);
}

/// The nominal sample and a Taylor polynomial of order 2.
#[bench]
fn taylor(bencher: Bencher) {
    study(bencher, &[Method::Taylor], None);
}

/// The nominal sample and a scan of 900.
#[bench(args = [1, 2])]
fn scan(bencher: Bencher, threads: usize) {
    study(bencher, &[Method::Scan], Some(threads));
}

/// The nominal sample alone.
#[bench]
fn nominal(bencher: Bencher) {
    study(bencher, &[], Some(1));
}

/// Reading, building, compiling and assembling the N-four-bar.
#[bench(args = [2, 10, 40, 100, 1000], sample_count = 3)]
fn compile_four_bar(bencher: Bencher, loops: usize) {
    bencher.bench_local(|| models::prepare(&models::four_bar(loops)));
}
