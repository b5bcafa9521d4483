//! Laws of the uncertain parameters, and which statistics are asked for.

use crate::numerics::statistics::Distribution;

/// What is asked beside the bounds.
#[derive(Clone, Debug, Default)]
pub struct Statistics {
    /// Whether anything is.
    pub asked: bool,
    /// Number of samples; the default where it is left out.
    pub samples: Option<usize>,
    /// Shares below the quantiles.
    pub quantiles: Vec<f64>,
    /// By the names of uncertain parameters; those that are not in are uniform.
    pub laws: Vec<(String, Law)>,
    /// Parameters that depend on each other.
    pub correlations: Vec<Correlation>,
}

/// A parameter's law.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// The law.
    pub distribution: Distribution,
    /// Whether its standard deviation is a third of the tolerance, since nothing else is said.
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

impl Statistics {
    /// The law of a parameter that lies in an interval.
    pub fn law(&self, name: &str, lower: f64, upper: f64) -> Law {
        let known = self.laws.iter().find(|(known, _)| known == name).map(|(_, law)| law.clone());
        known.unwrap_or(Law { distribution: Distribution::Uniform { lower, upper }, by_tolerance: false })
    }
}
