//! Constants of the room `price`.

use symdiff::constants::tuning;

tuning! {
    /// The price of a run.
    "study: price" {
        /// Ratio of the time taken to the estimate from which on a run ends unless it is allowed.
        times: u32 = 3, moves "which runs end early";
        /// Time of an instruction of one sample, s: a processor of today with all its lanes, so that a refused study
        /// does take so long.
        instruction_seconds: f64 = 2e-10, moves "which runs ask before they begin";
        /// Time of a point that a program answers, s: it is not known, and shards are to be cut.
        answer_seconds: f64 = 1.0, moves "the size of shards";
        /// Corrections of a step after the first one.
        further_corrections: f64 = 1.0, moves "which runs ask before they begin";
        /// Most simulations that run unasked.
        simulations: f64 = 20_000.0, moves "which runs ask before they begin";
        /// Most time that is spent unasked, s.
        seconds: f64 = 60.0, moves "which runs ask before they begin";
        /// Time in which a value of a surrogate is fitted and bounded, s: from 0.6 to 6 µs were measured with 625 to
        /// 4913 samples of three to seven parameters.
        value_seconds: f64 = 5e-7, moves "which runs ask before they begin";
        /// Seconds that nothing takes.
        for_ever: f64 = 1e9, moves "which runs are refused";
        /// Fewest bytes of each of the three lists of an output's sensitivities in a row.
        list_bytes: usize = 32, moves "which runs are refused for want of memory";
    }
}
