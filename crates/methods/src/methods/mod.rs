//! Bounding methods: ranges of the outputs of an ensemble over a box of parameters.
//!
//! Each method is one file (its keys, how it bounds, its label and colour) and one line below, from which follow the
//! names on the command line, the order of bands in files, the legend of plots and `mbint explain --methods`. A method
//! sees an [`Ensemble`] and knows neither mechanics nor who runs it.

mod closure;
mod ensemble;
mod expansion;
mod followed;
mod kept;
mod proof;
mod registry;
mod request;
mod result;
pub(crate) mod tuning;
mod validation;

mod certified;
mod chebyshev;
mod scan;
mod taylor;

use tuning::TUNING;

pub use certified::Certified;
pub use chebyshev::{
    Chebyshev, Degree, Expand, MOST_ON_GRIDS, can_compose, ends_of_combinations, number_as_motion, range_in_part,
};
pub use closure::Closure;
pub use ensemble::{
    Combination, DenseMotions, Effort, Ensemble, EnsembleError, Interrupted, JET_WORK, Observed, OfParameters,
    Sampling, Simulated, Stop, StopCause, TooDeep, Until, lines, scan, scan_shard,
};
pub use followed::{Followed, FollowedEnds, Sensitivity};
pub use kept::{KeptRow, KeptSurrogate};
pub use proof::{EnclosedRow, EnclosureEnd, Lost, Proof};
pub use registry::{About, BoundingMethod, Curve, Refusal, Registered, Varied};
pub use request::{Budget, Keep, MOST_SIMULATIONS, Problem};
pub use result::{BandBuilder, MethodResult};
pub use scan::Scan;
pub use taylor::Taylor;
pub use tuning::tuning;
pub use validation::{Ensembles, Validation};

/// Least and largest counts that can be asked for, by the keys of the file: definition in the schema, key, least,
/// largest.
pub const COUNTS: [(&str, &str, usize, usize); 5] = [
    ("Chebyshev", "order", 1, chebyshev::tuning::TUNING.most_order),
    ("Chebyshev", "nodes", 2, chebyshev::tuning::TUNING.most_nodes),
    ("Taylor", "order", 1, TUNING.most_taylor_order),
    ("Scan", "points", 2, TUNING.most_points),
    ("Budget", "solves", 1, MOST_SIMULATIONS as usize),
];

registry::methods! {
    /// A Chebyshev polynomial in the parameters.
    chebyshev: Chebyshev, keys chebyshev::keys::Chebyshev;
    /// A Taylor polynomial in the parameters.
    taylor: Taylor, keys taylor::keys::Taylor;
    /// Many samples; inner bounds.
    scan: Scan, keys scan::keys::Scan;
    /// Proven enclosures; asked for by `--certify`.
    certified: Certified;
}
