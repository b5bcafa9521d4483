//! The curves of a study: the method of the bounds, and the integrator of the motion.

use crate::compile::Scheme;
use crate::methods::Curve;

/// A curve of the study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CostMethod {
    /// Bounds, by plain steps of HHT-I3.
    Bounds(Curve),
    /// Bounds of samples that are integrated in this way.
    BoundsBy(Curve, Integrator),
    /// One simulation, by this scheme.
    Scheme(Scheme),
    /// One simulation that is integrated in this way.
    By(Integrator),
}

/// Integrator of a motion in place of plain steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// HHT-I3 with steps h, h/2, … of several levels, extrapolated.
    Extrapolated {
        /// 2 to 4.
        levels: usize,
    },
    /// The explicit method of order 8.
    Explicit,
}

impl Integrator {
    fn name(self) -> String {
        match self {
            Self::Extrapolated { levels } => format!("extrapolated({levels})"),
            Self::Explicit => "explicit".to_owned(),
        }
    }

    fn label(self) -> String {
        match self {
            Self::Extrapolated { levels } => format!("{levels} levels"),
            Self::Explicit => "explicit".to_owned(),
        }
    }
}

impl CostMethod {
    /// Curve of the bounds; `None` for a single simulation.
    pub fn curve(self) -> Option<Curve> {
        match self {
            Self::Bounds(curve) | Self::BoundsBy(curve, _) => Some(curve),
            Self::Scheme(_) | Self::By(_) => None,
        }
    }

    /// The integrator in place of plain steps, if any.
    pub fn integrator(self) -> Option<Integrator> {
        match self {
            Self::BoundsBy(_, integrator) | Self::By(integrator) => Some(integrator),
            Self::Bounds(_) | Self::Scheme(_) => None,
        }
    }

    /// The same, integrated in another way.
    #[must_use]
    pub fn by(self, integrator: Integrator) -> Self {
        self.curve().map_or(Self::By(integrator), |curve| Self::BoundsBy(curve, integrator))
    }

    /// Name in files.
    pub fn name(self) -> String {
        match self {
            Self::Bounds(curve) => curve.about().name.to_owned(),
            Self::BoundsBy(curve, integrator) => format!("{}.{}", curve.about().name, integrator.name()),
            Self::By(integrator) => integrator.name(),
            Self::Scheme(Scheme::Hht { alpha }) => format!("hht({alpha})"),
            Self::Scheme(Scheme::GeneralisedAlpha { spectral_radius }) => {
                format!("generalised_alpha({spectral_radius})")
            }
            Self::Scheme(Scheme::TrapezoidalIndex2) => "trapezoidal".to_owned(),
        }
    }

    /// Label for people.
    pub fn label(self) -> String {
        match self {
            Self::Bounds(curve) => curve.about().label.to_owned(),
            Self::BoundsBy(curve, integrator) => format!("{}, {}", curve.about().label, integrator.label()),
            Self::By(Integrator::Extrapolated { levels }) => format!("HHT-I3 over {levels} levels"),
            Self::By(Integrator::Explicit) => "Explicit, order 8".to_owned(),
            Self::Scheme(Scheme::Hht { alpha }) => format!("HHT-I3, α = −{}", (1e3 * alpha.abs()).round() / 1e3),
            Self::Scheme(Scheme::GeneralisedAlpha { spectral_radius }) => {
                format!("Generalised-α, ρ∞ = {spectral_radius}")
            }
            Self::Scheme(Scheme::TrapezoidalIndex2) => "Trapezoidal, index 2".to_owned(),
        }
    }
}
