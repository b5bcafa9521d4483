//! Results of a subsystem's study, before they become bounds.

use super::kept::KeptPart;
use crate::results::{Bounds, Summary};
use crate::simulate::SingularPass;
use crate::study::bounding::{Attained, Bounded, Outcome};
use crate::study::internal::InternalError;
use crate::study::reduced::Found;

/// Results under one schedule.
pub struct Results {
    pub bounded: Bounded,
    /// Singular configurations that the nominal motion passes.
    pub singular: Vec<SingularPass>,
    /// Ends that were found along gradients, if they were searched for.
    pub attained: Option<(Outcome, Attained)>,
    /// Cost of the search over functions of the time, if there was one.
    pub searched: Option<Outcome>,
    /// Errors of this program; the results of the failed methods are unknown.
    pub internal: Vec<InternalError>,
    /// Reduced outputs.
    pub found: Found,
}

/// Bounds and summary of a subsystem.
pub struct Ran {
    pub bounds: Bounds,
    pub summary: Summary,
    /// Rows that every sample of every method has reached.
    pub whole: usize,
    /// The surrogate, if it is to be stored.
    pub kept: Option<KeptPart>,
}
