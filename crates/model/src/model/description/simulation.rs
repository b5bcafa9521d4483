//! How time is stepped.

/// How time is stepped.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// s
    pub duration: f64,
    /// Fixed, or controlled.
    pub stepping: Stepping,
    /// HHT parameter α ∈ [−1/3, 0).
    pub alpha: f64,
    /// s between rows of output.
    pub output_step: f64,
    /// Coordinates that describe the motion.
    pub formulation: Formulation,
    /// Scheme that integrates the motion.
    pub scheme: SchemeChoice,
    /// Levels of step lengths that are combined; `None` if not given.
    pub extrapolation: Option<usize>,
}

/// Scheme that integrates a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SchemeChoice {
    /// Under a tolerance whichever reaches it with the least work; else HHT-I3.
    #[default]
    Auto,
    /// HHT-I3.
    Hht,
    /// Dormand and Prince's explicit method of order 8.
    Explicit,
}

/// Coordinates that describe a motion; the motion is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Formulation {
    /// Whichever takes fewer instructions.
    #[default]
    Auto,
    /// Each body has its own, and joints constrain them.
    Absolute,
    /// Those of the joints, as far as joints give bodies their positions; those that close loops constrain them.
    Joint,
}

/// How steps are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stepping {
    /// Every step this long, s.
    Fixed(f64),
    /// Steps' local position errors add up to no more than this over the run, relative to |q|, or to the model's size
    /// where that is larger.
    Tolerance(f64),
}
