//! Laws of the uncertain parameters, and which statistics are asked for.

use crate::numerics::statistics::Distribution;

/// Questions in addition to the bounds.
#[derive(Clone, Debug, Default)]
pub struct Statistics {
    /// Whether anything is.
    pub asked: bool,
    /// Number of samples; `None` for the default.
    pub samples: Option<usize>,
    /// Seed of samples of random excitations.
    pub seed: usize,
    /// Time within which failures are counted, s, if it is longer than the motion.
    pub exposure: Option<f64>,
    /// Shares below the quantiles.
    pub quantiles: Vec<f64>,
    /// Laws by the names of uncertain parameters; others are uniform.
    pub laws: Vec<(String, Law)>,
    /// Parameters that depend on each other.
    pub correlations: Vec<Correlation>,
    /// Costs of tolerances, by the names of uncertain parameters.
    pub costs: Vec<(String, Cost)>,
}

/// A parameter's law.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// The law.
    pub distribution: Distribution,
    /// Whether its standard deviation is a third of the tolerance, by default.
    pub by_tolerance: bool,
}

/// Correlated parameters: names, and the matrix of their normal scores' correlations.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlation {
    /// Names of uncertain parameters.
    pub names: Vec<String>,
    /// A row for each.
    pub matrix: Vec<Vec<f64>>,
}

/// Cost of a parameter's tolerance.
#[derive(Clone, Debug, PartialEq)]
pub enum Cost {
    /// The tolerance stays as it is.
    Fixed,
    /// Cost at the model's tolerance; it is inversely proportional to the tolerance.
    Reciprocal(f64),
    /// Grades of processes, the tightest first.
    Grades(Vec<Grade>),
}

/// A grade of a process.
#[derive(Clone, Debug, PartialEq)]
pub struct Grade {
    /// `IT7`.
    pub name: String,
    /// Tolerance to either side, in the parameter's SI unit.
    pub tolerance: f64,
    /// Cost.
    pub cost: f64,
}

impl Statistics {
    /// Cost of a parameter's tolerance, if the model gives it.
    pub fn cost(&self, name: &str) -> Option<&Cost> {
        self.costs.iter().find(|(known, _)| known == name).map(|(_, cost)| cost)
    }

    /// Whether some tolerance costs less if it is wider.
    pub fn is_priced(&self) -> bool {
        self.costs.iter().any(|(_, cost)| !matches!(cost, Cost::Fixed))
    }

    /// The law of a parameter that lies in an interval.
    pub fn law(&self, name: &str, lower: f64, upper: f64) -> Law {
        let known = self.laws.iter().find(|(known, _)| known == name).map(|(_, law)| law.clone());
        known.unwrap_or(Law { distribution: Distribution::Uniform { lower, upper }, by_tolerance: false })
    }
}
