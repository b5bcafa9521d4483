//! Constants of the room `stepping`.

use symdiff::constants::tuning;

tuning! {
    /// The steps of a study.
    "study: stepping" {
        /// Corners of the box that join the nominal sample as controlling samples of the step size.
        controlling_corners: usize = 16, moves "steps, and so the time errors and the last digits";
        /// Ratio of a value's error to its change by halved steps, at second order.
        richardson: f64 = 4.0 / 3.0, moves "steps, and so the time errors and the last digits";
        /// Share of the steps' tolerance that shorter steps aim at.
        controlled_aim: f64 = 0.6, moves "steps, and so the time errors and the last digits";
        /// Schedules that are tried for a tolerance of the steps.
        controlled_rounds: usize = 4, moves "steps, and so the time errors and the last digits";
        /// Most times as many steps as the first schedule has.
        controlled_growth: f64 = 6.0, moves "steps, and so the time errors and the last digits";
        /// Steps times coordinates that a schedule may have in any case.
        controlled_steps: f64 = 400_000.0, moves "steps, and so the time errors and the last digits";
        /// Range of a constant output, relative to the largest value of its dimension.
        constant: f64 = 1e-9, moves "steps, and so the time errors and the last digits";
        /// The same relative to the largest value of all: rounding.
        rounding: f64 = 1e-13, moves "steps, and so the time errors and the last digits";
        /// Share of its range that an output keeps with halved steps unless it moves by the steps' errors alone, as an
        /// energy does.
        steady: f64 = 0.5, moves "steps, and so the time errors and the last digits";
        /// Error of a step between events, as a share of how far the motion has gone: steps of order 8 that are so
        /// accurate cost little.
        event_error: f64 = 1e-10, moves "steps, and so the time errors and the last digits";
        /// The same as a share of a tolerance that is given.
        event_share: f64 = 1e-5, moves "steps, and so the time errors and the last digits";
        /// Samples spread over the box for each parameter, of which each has to meet the same events.
        event_samples: usize = 24, moves "which motions are cut at events";
        /// Error of an explicit step, as a share of the run's error allowance, until the growth of errors is known.
        explicit_share: f64 = 0.01, moves "steps, and so the time errors and the last digits";
        /// Schedules of the explicit method that are tried.
        explicit_rounds: usize = 6, moves "steps, and so the time errors and the last digits";
        /// Share of the tolerance that its next schedule aims at.
        explicit_aim: f64 = 0.1, moves "steps, and so the time errors and the last digits";
        /// Most that a trial sharpens its tolerance.
        explicit_sharpest: f64 = 1e-4, moves "steps, and so the time errors and the last digits";
        /// Samples that decide on its steps: as many as are integrated together.
        explicit_samples: usize = 32, moves "steps, and so the time errors and the last digits";
        /// Most steps if a model asks for the explicit method.
        explicit_most_steps: usize = 1_000_000, moves "which runs are refused";
        /// Steps beyond those of the given schedule that the method may take if it is one of several.
        explicit_further_steps: usize = 500, moves "whether the explicit method is taken";
        /// Step of the scheme that the method is compared with if the model names none, s.
        typical_step: f64 = 1e-3, moves "whether the explicit method is taken";
        /// Stages of an explicit step, for the comparison.
        explicit_stages: usize = 12, moves "whether the explicit method is taken";
        /// Corrections that move its end onto the constraints, for the comparison.
        explicit_closures: usize = 3, moves "whether the explicit method is taken";
        /// Share of the bounds' tolerance that the steps may take; the surrogate has the rest.
        share: f64 = 0.5, moves "steps, and so the time errors and the last digits";
        /// Share that is aimed at, so that the result is within the tolerance with some room.
        aim: f64 = 0.4, moves "steps, and so the time errors and the last digits";
        /// Share below which steps are joined.
        little: f64 = 0.1, moves "steps, and so the time errors and the last digits";
        /// Most parts that a schedule's steps are divided into; beyond, the best attained remains.
        parts: usize = 32, moves "steps, and so the time errors and the last digits";
        /// Most schedules that are tried.
        trials: usize = 10, moves "steps, and so the time errors and the last digits";
        /// Parts from which on steps are extrapolated instead: three levels take 7 steps for each.
        worth_levels: f64 = 3.0, moves "steps, and so the time errors and the last digits";
        /// Parts of extrapolated steps from which on a fourth level is taken, which takes twice the steps.
        worth_fourth: f64 = 2.0, moves "steps, and so the time errors and the last digits";
        /// Least factor by which extrapolation has to divide the error: else the motion is not smooth enough, or too
        /// stiff.
        gain: f64 = 8.0, moves "steps, and so the time errors and the last digits";
        /// Levels that are tried first; a fourth is added if steps under them would still have to be divided into
        /// more parts than `worth_fourth`.
        first_levels: usize = 3, moves "the steps that are chosen";
    }
}

const _: () = assert!(TUNING.little < TUNING.aim && TUNING.aim < TUNING.share && TUNING.share < 1.0);
