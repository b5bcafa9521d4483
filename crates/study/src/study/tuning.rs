//! Constants of the room `study`.

use crate::{assemble, c_code, certificate, compile, methods, model, numerics, results, simulate, store};
use symdiff::constants::{Constant, tuning};

tuning! {
    /// Parts of a study.
    "study" {
        /// Samples of the box that determine how much of it fails.
        surveyed: usize = 1000, moves "bounds of boxes in part of which there is no motion";
        /// Most pieces that the box is cut into.
        most_pieces: usize = 32, moves "bounds of boxes in part of which there is no motion";
        /// A piece of this share of the box is not cut any more.
        smallest_piece: f64 = 1.0 / 1024.0, moves "bounds of boxes in part of which there is no motion";
        /// A parameter whose failing samples lie off its middle by so much on average (of ξ) matters.
        leans: f64 = 0.2, moves "bounds of boxes in part of which there is no motion";
        /// Chosen samples, from the first, that may show the events at which motions are cut.
        samples_of_events: usize = 1024, moves "the last digits of chosen samples";
    }
}

/// Constants from text to studies, room by room, in the order of the stages.
pub fn tuning() -> Vec<Constant> {
    [
        symdiff::tuning::Tuning::constants(),
        numerics::tuning(),
        certificate::tuning::Tuning::constants(),
        model::tuning(),
        methods::tuning(),
        assemble::tuning::Tuning::constants(),
        compile::tuning::Tuning::constants(),
        simulate::tuning(),
        c_code::tuning::Tuning::constants(),
        results::tuning::Tuning::constants(),
        store::tuning::Tuning::constants(),
        mbint_fmu::tuning(),
        crate::black_box::tuning::Tuning::constants(),
        Tuning::constants(),
        crate::study::formulation::tuning::Tuning::constants(),
        crate::study::stepping::tuning::Tuning::constants(),
        crate::study::price::tuning::Tuning::constants(),
        crate::study::ensemble::tuning::Tuning::constants(),
        crate::study::bounding::tuning::Tuning::constants(),
        crate::study::attained::tuning::Tuning::constants(),
        crate::study::excited::tuning::Tuning::constants(),
        crate::study::answers::tuning::Tuning::constants(),
        crate::study::reduced::tuning::Tuning::constants(),
        crate::study::statistics::tuning::Tuning::constants(),
        crate::study::gradient::tuning::Tuning::constants(),
        crate::study::black_box::tuning::Tuning::constants(),
        crate::study::drawing::tuning::Tuning::constants(),
        crate::study::motion::tuning::Tuning::constants(),
    ]
    .concat()
}
