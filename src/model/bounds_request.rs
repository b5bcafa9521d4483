//! Which bounds are asked for, typed: what `bounds:` says, checked.

pub use crate::numerics::RangeKind;

/// What a Chebyshev surrogate expands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expand {
    /// The independent coordinates and their velocities; outputs follow from them.
    Coordinates,
    /// Each output (the paper's).
    Output,
}

/// Which bounds are asked for; per-parameter vectors run over the uncertain parameters in file order.
#[derive(Clone, Debug, Default)]
pub struct BoundsRequest {
    /// Error allowed of every bound, relative to how far its output ranges over the run.
    pub tolerance: Option<f64>,
    /// What may be spent on it.
    pub budget: Budget,
    #[allow(missing_docs)]
    pub chebyshev: Option<ChebyshevRequest>,
    #[allow(missing_docs)]
    pub taylor: Option<TaylorRequest>,
    #[allow(missing_docs)]
    pub scan: Option<ScanRequest>,
    /// Bounds that are proven.
    pub certified: bool,
}

/// Where the search for bounds within a tolerance ends at the latest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Simulations.
    pub solves: usize,
    /// s
    pub seconds: Option<f64>,
}

impl Default for Budget {
    fn default() -> Self {
        Self { solves: 3000, seconds: None }
    }
}

impl BoundsRequest {
    /// Error relative to the output's range that is aimed at where a degree is to be chosen and no tolerance is given.
    pub const TOLERANCE: f64 = 1e-3;

    /// Whether no method is asked for.
    pub fn is_empty(&self) -> bool {
        self.chebyshev.is_none() && self.taylor.is_none() && self.scan.is_none() && !self.certified
    }
}

/// Chebyshev bounds.
#[derive(Clone, Debug)]
pub struct ChebyshevRequest {
    #[allow(missing_docs)]
    pub degree: Degree,
    #[allow(missing_docs)]
    pub expand: Expand,
    /// Of the outputs' polynomials, where those are expanded.
    pub range: RangeKind,
}

/// Taylor bounds.
#[derive(Clone, Debug)]
pub struct TaylorRequest {
    /// Total degree.
    pub order: usize,
    #[allow(missing_docs)]
    pub range: RangeKind,
}

/// Scanning bounds.
#[derive(Clone, Debug)]
pub struct ScanRequest {
    /// Points per parameter, both ends included.
    pub points: Vec<usize>,
}

/// Simulations that one method may ask for.
pub const MOST_SOLVES: f64 = 1e7;

/// The degree of a Chebyshev polynomial.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Degree {
    /// As given, for each parameter, with so many nodes, more than the degree.
    Fixed {
        #[allow(missing_docs)]
        order: Vec<usize>,
        #[allow(missing_docs)]
        nodes: Vec<usize>,
    },
    /// As the tolerance asks for.
    Adaptive,
}

impl ChebyshevRequest {
    /// As the tolerance asks for.
    pub const ADAPTIVE: Self = Self { degree: Degree::Adaptive, expand: Expand::Coordinates, range: RangeKind::Tight };

    /// Most parameters for which full grids are the default.
    pub const FEW: usize = 3;

    /// What a model gets that asks for no degree: [`ORDER`](Self::ORDER), or what a tolerance asks for where there is one or
    /// are many parameters.
    pub fn unspecified(k: usize, tolerance: Option<f64>) -> Self {
        if tolerance.is_some() || k > Self::FEW { Self::ADAPTIVE } else { Self::of_order(Self::ORDER, k) }
    }

    /// Degree where a model asks for none.
    pub const ORDER: usize = 5;

    /// One degree for each of k parameters, one node more than the degree.
    pub fn of_order(order: usize, k: usize) -> Self {
        let degree = Degree::Fixed { order: vec![order; k], nodes: vec![order + 1; k] };
        Self { degree, expand: Expand::Coordinates, range: RangeKind::Tight }
    }
}

impl TaylorRequest {
    /// Degree where a model asks for none, the paper's.
    pub const ORDER: usize = 2;
}

impl Default for TaylorRequest {
    /// The usual order, the tight range.
    fn default() -> Self {
        Self { order: Self::ORDER, range: RangeKind::Tight }
    }
}

impl ScanRequest {
    /// Points a parameter where a model asks for none, the paper's.
    pub const POINTS: usize = 30;

    /// One number of points for each of k parameters.
    pub fn of_points(points: usize, k: usize) -> Self {
        Self { points: vec![points; k] }
    }
}
