//! Constants of the room `formulation`.

use symdiff::constants::tuning;

tuning! {
    /// The choice of coordinates.
    "study: formulation" {
        /// Largest difference of an output's starts, relative or in its SI unit, by which formulations start alike: the
        /// residual of closures.
        alike: f64 = 1e-6, moves "coordinates of mechanisms with loops";
        /// Instructions of steps that are compiled in search of a shorter cut: in some hundredths of a second.
        cut_instructions: usize = 20_000, moves "cuts of loops, and so the last digits";
        /// Cuts that are compiled at once, if there are threads for them.
        cuts_at_once: usize = 2, moves "nothing: the time to choose a cut";
        /// Joints on the way from a body to its root, on average, beyond which joint coordinates are not tried, in the
        /// plane and in space: long planar chains are as short in absolute coordinates, in space they never are.
        deepest: [usize; 2] = [25, usize::MAX], moves "choice of coordinates of long chains";
        /// The same if joints close loops: deep loops couple all that is between their ends.
        deepest_of_loops: [usize; 2] = [25, 50], moves "choice of coordinates of long chains";
        /// Ratio of the operations of an elimination to those of a step in the other coordinates from which on a
        /// formulation is given up.
        given_up: usize = 10, moves "choice of coordinates";
        /// Weight of a step in a spherical joint's Euler parameters, which errs more than one in a body's own, whose
        /// inertia is about its centre of mass: of the same length that of a heavy top by 8 times, with order two three
        /// times as many steps.
        longer_steps: usize = 3, moves "choice of coordinates in space";
        /// Operations that are compiled in a moment: no formulation is given up for fewer.
        soon: usize = 100_000, moves "choice of coordinates";
        /// Most operations of the start's eliminations, or of the step's: in about a minute, and in 1 GB.
        operations: usize = 8_000_000, moves "which models are refused";
        /// The same in joint coordinates if only the start is wanted: in a second or two.
        operations_of_check: usize = 1_000_000, moves "coordinates in which large models are checked";
        /// Length of a cut's equations, over that of the best so far, from which on it is not compiled: of 90 cuts of
        /// the models of this repository all 7 that were shorter had equations that were no longer.
        longer_equations: f64 = 1.1, moves "cuts of loops, and so the last digits";
        /// Longest step in which the nominal motion is searched for singular configurations if a tolerance chooses
        /// the steps, s.
        longest_look: f64 = 1e-3, moves "choice of coordinates of loops";
        /// Most steps of that search.
        looks: f64 = 10_000.0, moves "choice of coordinates of loops";
        /// Least steps of it.
        least_looks: f64 = 100.0, moves "choice of coordinates of loops";
        /// Tolerance of its steps that are longer than the model's: some fifty a turn.
        tolerance_of_look: f64 = 3e-2, moves "choice of coordinates of loops";
        /// Part that a pivot has lost of the range between its size at the pivot samples (1e-10) and the smallest that
        /// is trusted (1) from which on no step is longer than the model's: a tenth of those that have a step examined.
        pivot_of_long_look: f64 = 1e-9, moves "choice of coordinates of loops";
        /// Eliminations of the start.
        eliminations: usize = 3, moves "choice of coordinates of large models";
        /// Most bodies of a whole model that is compiled to be checked; larger models are only assembled.
        few_bodies: usize = 50, moves "coordinates in which large models are checked";
    }
}
