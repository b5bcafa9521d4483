//! Constants of the room `simulate: control`.

use symdiff::constants::tuning;

tuning! {
    /// Lengths of steps.
    "simulate: control" {
        /// A step longer than this share of the time left up to a goal is cut to half of that time, so that no sliver
        /// remains.
        halved_from: f64 = 0.55, moves "the steps of runs with chosen steps";
        /// Largest change of functions of the positions in a step, as a share of their range.
        most_change: f64 = 0.5, moves "the steps of runs with chosen steps";
        /// A step towards a switch ends this share beyond it, so that it is passed.
        beyond_switch: f64 = 1e-6, moves "the steps of runs with chosen steps";
        /// A lane chatters if velocities switch its equations so often.
        chattering_switches: usize = 1000, moves "which lanes chatter, and where they end";
        /// A lane chatters if velocities switch its equations in at least one of this many steps since it began to.
        chattering_share: usize = 8, moves "which lanes chatter, and where they end";
        /// Most steps that a chattering lane may take up to the end of the run.
        most_chattering: usize = 20_000, moves "which lanes chatter, and where they end";
        /// Smallest step, as a share of the duration; below it the control gives up.
        smallest_step: f64 = 1e-13, moves "the steps of runs with chosen steps";
        /// A switch is located to this share of the duration: shorter steps are left to the errors that they make.
        event_width: f64 = 1e-7, moves "the steps of runs with chosen steps";
        /// Local errors below this are round-off and are not controlled: positions carry an error of ε, and so does δ.
        round_off_of_errors: f64 = 4.0 * f64::EPSILON, moves "the steps of runs with chosen steps";
        /// Most steps that a schedule may come to for each that it has; some are allowed besides.
        most_parts_of_step: usize = 128, moves "which runs are refused because steps are divided too often";
        /// Most steps that a schedule may come to besides those for each that it has.
        most_parts_besides: usize = 20_000, moves "which runs are refused because steps are divided too often";
        /// Most steps that a schedule may come to beyond those that it has, whatever their number.
        most_further_steps: usize = 4_000_000, moves "which runs are refused because steps are divided too often";
        /// Times that differ by this share of the output step are the same.
        same_instant: f64 = 1e-9, moves "the steps of runs with chosen instants";
        /// Shortest part of a step that ends at a chosen time, as a share of the step: multipliers of shorter ones are
        /// rounding.
        shortest_part: f64 = 0.01, moves "the steps of runs with chosen instants";
        /// Steps of a refined schedule for each step of the one with which it is compared.
        finer_steps: f64 = 2.7, moves "steps that are refined";
        /// The first step, as a share of the output step.
        first_step: f64 = 1e-2, moves "the steps of runs with chosen steps";
        /// At the end of a run, its constraints are examined this share of an output step later: a residual needs time
        /// to grow.
        look_ahead: f64 = 0.5, moves "the steps of runs with chosen steps";
        /// Most steps of a schedule: where it needs more, no step resolves the motion.
        most_steps: usize = 2_000_000, moves "which runs are given up";
        /// A remainder below this share of a step is rounding.
        no_rest: f64 = 1e-6, moves "the last step of a run";
    }
}
