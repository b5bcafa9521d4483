//! Constants of the room `simulate: events`.

use symdiff::constants::tuning;

tuning! {
    /// Motions that are cut at events.
    "simulate: events" {
        /// A sample at a share of the largest margin weighs as one on the surface over this share and it.
        near_surface: f64 = 0.02, moves "bounds of motions with events";
        /// Factor on the duration to which motions are followed, so that all of them meet an event near the end.
        followed_share: f64 = 1.25, moves "bounds of motions with events";
        /// Most events of a motion.
        most_events: usize = 128, moves "bounds of motions with events";
        /// Points between the ends of a step at which a cubic's first root is searched for.
        root_points: usize = 16, moves "instants of events";
        /// Bisections between two of the points at which a cubic's first root is searched for.
        root_bisections: usize = 50, moves "instants of events";
        /// A crossing after this share of a step is at its end.
        at_the_end: f64 = 0.999, moves "instants of events";
        /// First step, as a share of the duration.
        first_step: f64 = 1e-4, moves "the steps of motions with events";
        /// Longest step, as a share of the duration.
        longest_step: f64 = 1.0 / 16.0, moves "the steps of motions with events";
        /// The smallest step, as a share of the duration.
        smallest_step: f64 = 1e-13, moves "the steps of motions with events";
        /// A crossing behind this share of a step, or so little beyond its end, is solved for by Newton's method;
        /// before it, the step is cut short first.
        near_end: f64 = 0.98, moves "the steps of motions with events";
        /// Distance of a step's end beyond an event, as a share of the duration.
        beyond_event: f64 = 16.0 * f64::EPSILON, moves "the steps of motions with events";
        /// Accuracy of the end of a step beyond an event, as a share of the duration.
        located: f64 = 4.0 * f64::EPSILON, moves "the steps of motions with events";
        /// Largest uncertainty of an event's instant by rounding of the switch, as a share of the duration.
        rounded_instant: f64 = 1e-9, moves "the steps of motions with events";
        /// Corrections of an event's instant.
        corrections_of_instant: usize = 12, moves "the steps of motions with events";
        /// A switch that stays within this share of its largest value crosses by rounding.
        zero_of_switch: f64 = 1e-13, moves "the steps of motions with events";
        /// Switches that cross so soon after an event, as a share of the duration, are a part of it.
        same_event: f64 = 1e-10, moves "the steps of motions with events";
        /// Least share that a step is cut to at once where its error is large.
        least_share: f64 = 0.3, moves "the steps of motions with events";
        /// Share of a step over which the change of a rate is taken.
        share_for_bend: f64 = 1e-3, moves "the steps of motions with events";
        /// Rate near an extreme that counts as zero, as a share of the rates at the step's ends.
        flat_rate: f64 = 1e-7, moves "the steps of motions with events";
        /// Most steps that are tried of a motion without an event: a smooth motion that takes more is stiff.
        most_steps: usize = 3000, moves "which motions are given up";
        /// Most steps that are tried after an event: a contact that stays closed takes as many as its spring asks for.
        most_steps_with_events: usize = 12_000, moves "which motions are given up";
        /// Most steps that are tried where words end.
        most_steps_behind_words: usize = 40_000, moves "which motions are given up";
        /// Most steps of the scheme that are tried: each is of many.
        most_steps_of_scheme: usize = 2000, moves "which motions are given up";
        /// Most parts of a step that a sample takes, where fewer levels of the scheme take it.
        most_parts_of_step: usize = 256, moves "the steps of stiff motions with events";
        /// Levels of the scheme by which a sample is followed alone.
        levels_of_paths: usize = 4, moves "the steps of stiff motions with events";
        /// Levels of the scheme between events of motions that are stiff.
        levels_of_stiff: usize = 4, moves "the steps of stiff motions with events";
        /// Least error of a step of the scheme that is asked for, as a share of how far the motion has gone.
        error_of_scheme: f64 = 1e-8, moves "the steps of stiff motions with events";
        /// Error of a step by which a stiff motion is first searched for events.
        rough_error: f64 = 1e-4, moves "which motions are cut at events";
        /// Rounding of positions in steps from rest and in those of the scheme, in units of rounding.
        rounding_of_steps: f64 = 64.0, moves "the steps of stiff motions with events";
        /// Largest factor from one step of the scheme to the next.
        largest_factor_of_levels: f64 = 3.0, moves "the steps of stiff motions with events";
        /// Share of the length of a step that passes over a feature of a force in space, with which it is tried again.
        passing_share: f64 = 0.5, moves "the steps of motions with events";
        /// Samples whose segments are passed together.
        run_width: usize = 16, moves "time only";
        /// An event so close to the end, as a share of the duration, may be before it for other samples.
        beside_end: f64 = 0.02, moves "which motions are cut at events";
        /// Instants that differ by no more than this share of the duration are the same.
        same_instant: f64 = 1e-9, moves "which motions are cut at events";
        /// Samples after the first of which one has to meet an event.
        deciding_samples: usize = 8, moves "which motions are cut at events";
        /// Most words, each a sequence of events, that the motions of a box may spell.
        most_words: usize = 6, moves "which motions are cut at events";
        /// Most events of a motion with a contact whose normal turns, where it may meet others instead: a pin that
        /// rattles meets them by the hundred.
        most_turning_events: usize = 16, moves "which motions are cut at events";
        /// Parameters, at most, of boxes with several words: ranges of more, of which each word has one, take long.
        most_of_parts: usize = 4, moves "which motions are cut at events";
        /// Motions are cut if their words can be followed for at least this share of the duration: a polynomial that
        /// is not cut there ends at the first event.
        worthwhile_share: f64 = 0.25, moves "which motions are cut at events";
        /// Motions are also cut if their words can be followed through at least this many events.
        worthwhile_events: usize = 8, moves "which motions are cut at events";
    }
}
