//! Constants of the room `study`.

use super::{
    allocate, answers, attained, black_box, bounding, cost, design, drawing, ensemble, excited, explain, fit,
    formulation, gradient, motion, price, reduced, statistics, stepping, verify,
};
use crate::{assemble, c_code, certificate, compile, methods, model, numerics, results, simulate, store};
use symdiff::constants::{Constant, tuning};

tuning! {
    /// Parts of a study.
    "study" {
        /// Samples of the box that tell how much of it fails.
        surveyed: usize = 1000, moves "bounds of boxes in part of which there is no motion";
        /// Most pieces that the box is cut into.
        most_pieces: usize = 32, moves "bounds of boxes in part of which there is no motion";
        /// A piece of this share of the box is not cut any more.
        smallest_piece: f64 = 1.0 / 1024.0, moves "bounds of boxes in part of which there is no motion";
        /// A parameter whose failing samples lie off its middle by so much on average (of ξ) matters.
        leans: f64 = 0.2, moves "bounds of boxes in part of which there is no motion";
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
        formulation::tuning::Tuning::constants(),
        stepping::tuning::Tuning::constants(),
        price::tuning::Tuning::constants(),
        ensemble::tuning::Tuning::constants(),
        bounding::tuning::Tuning::constants(),
        attained::tuning::Tuning::constants(),
        excited::tuning::Tuning::constants(),
        answers::tuning::Tuning::constants(),
        reduced::tuning::Tuning::constants(),
        statistics::tuning::Tuning::constants(),
        gradient::tuning::Tuning::constants(),
        fit::tuning::Tuning::constants(),
        allocate::tuning::Tuning::constants(),
        design::tuning::Tuning::constants(),
        cost::tuning::Tuning::constants(),
        verify::tuning::Tuning::constants(),
        black_box::tuning::Tuning::constants(),
        explain::tuning::Tuning::constants(),
        drawing::tuning::Tuning::constants(),
        motion::tuning::Tuning::constants(),
    ]
    .concat()
}
