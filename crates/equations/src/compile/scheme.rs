//! The integration schemes: HHT, generalised-α and the trapezoidal rule are one family, and differ in coefficients
//! only.
//!
//! Chung & Hulbert, J. Appl. Mech. 60 (1993) 371, in the form of Arnold & Brüls, Multibody Syst. Dyn. 18 (2007) 185,
//! with the algorithmic acceleration a apart from the true one, w = v̇:
//!
//! ```text
//! (1−α_m) a₊ + α_m a = (1−α_f) w₊ + α_f w
//! q₊ = q + h v + h²/2 [(1−2β) a + 2β a₊]                      v₊ = v + h [(1−γ) a + γ a₊]
//! ```
//!
//! γ = ½ − Δ with Δ = α_m − α_f makes it of second order, and then a ≈ w(t + Δh); β = (γ + ½)²/4 damps high
//! frequencies most.
//!
//! | scheme | α_m | α_f | ρ∞: amplification of the highest frequencies |
//! |---|---|---|---|
//! | HHT | 0 | −α | (1+α)/(1−α) |
//! | generalised-α | (2ρ∞−1)/(ρ∞+1) | ρ∞/(ρ∞+1) | as chosen |
//! | trapezoidal | 0 | 0 | 1 |

/// A time integration scheme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scheme {
    /// HHT-I3 (Negrut et al., J. Comput. Nonlinear Dynam. 2 (2007) 73), index 3: positions fulfil the constraints.
    Hht {
        /// α ∈ [−1/3, 0); 0 diverges on constraints.
        alpha: f64,
    },
    /// Generalised-α (Chung & Hulbert 1993), index 3: positions fulfil the constraints. The nearer ρ∞ to 1, the
    /// smaller the error and the sooner long steps fail: with 0.9 the slider crank fails at h = 2e-3, where HHT of ρ∞
    /// = 0.9 does not.
    GeneralisedAlpha {
        /// ρ∞ ∈ [0, 1); 1 diverges on constraints.
        spectral_radius: f64,
    },
    /// The trapezoidal rule (Newmark's with β = ¼, γ = ½), index 2: velocities fulfil the constraints, positions drift
    /// from them by O(h²): 5e-6 of a pendulum's length squared in 10 s at h = 1e-3. The rule damps nothing: an error
    /// of a step in reactions and accelerations alternates from then on, O(h²), 8e-7 of the pendulum's tension. Near
    /// singular positions the energy may jump, and the order is lost.
    TrapezoidalIndex2,
}

/// The derivative of the constraints that a step makes zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConstraintLevel {
    /// Φ(q₊, t₊) = 0.
    Position,
    /// Φ_q v₊ + Φ_t = 0.
    Velocity,
}

/// A scheme's coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// Share of a in the balance of accelerations.
    alpha_m: f64,
    /// Share of w in the balance of accelerations.
    alpha_f: f64,
    /// Newmark's β.
    pub beta: f64,
    /// Newmark's γ.
    pub gamma: f64,
    /// The derivative of the constraints that a step makes zero.
    pub level: ConstraintLevel,
}

impl Scheme {
    /// The scheme's coefficients.
    pub fn coefficients(self) -> Coefficients {
        let level = ConstraintLevel::Position;
        match self {
            Self::Hht { alpha } => Coefficients {
                alpha_m: 0.0,
                alpha_f: -alpha,
                beta: (1.0 - alpha) * (1.0 - alpha) / 4.0,
                gamma: 0.5 - alpha,
                level,
            },
            Self::GeneralisedAlpha { spectral_radius: rho } => Coefficients {
                alpha_m: (2.0 * rho - 1.0) / (rho + 1.0),
                alpha_f: rho / (rho + 1.0),
                beta: 1.0 / ((rho + 1.0) * (rho + 1.0)),
                gamma: 0.5 + (1.0 - rho) / (1.0 + rho),
                level,
            },
            Self::TrapezoidalIndex2 => {
                let level = ConstraintLevel::Velocity;
                Coefficients { alpha_m: 0.0, alpha_f: 0.0, beta: 0.25, gamma: 0.5, level }
            }
        }
    }

    /// ρ∞: the factor by which a step multiplies the amplitude of the highest frequencies.
    pub fn spectral_radius(self) -> f64 {
        match self {
            Self::Hht { alpha } => (1.0 + alpha) / (1.0 - alpha),
            Self::GeneralisedAlpha { spectral_radius } => spectral_radius,
            Self::TrapezoidalIndex2 => 1.0,
        }
    }
}

impl Coefficients {
    /// Coefficient of w₊ in a₊: (1−α_f)/(1−α_m).
    pub fn of_new(self) -> f64 {
        (1.0 - self.alpha_f) / (1.0 - self.alpha_m)
    }

    /// Coefficient of w in a₊: α_f/(1−α_m).
    pub fn of_old(self) -> f64 {
        self.alpha_f / (1.0 - self.alpha_m)
    }

    /// Coefficient of −a in a₊: α_m/(1−α_m).
    pub fn of_algorithmic(self) -> f64 {
        self.alpha_m / (1.0 - self.alpha_m)
    }

    /// Δ = α_m − α_f: a ≈ w(t + Δh).
    pub fn shift(self) -> f64 {
        self.alpha_m - self.alpha_f
    }

    /// b = βh²(1−α_f)/(1−α_m): change of q₊ per change of w₊.
    pub fn position_gain(self, h: f64) -> f64 {
        self.beta * h * h * self.of_new()
    }

    /// c = γh(1−α_f)/(1−α_m): change of v₊ per change of w₊.
    pub fn velocity_gain(self, h: f64) -> f64 {
        self.gamma * h * self.of_new()
    }

    /// Divisor of the step's constraints, which keeps its matrix from degenerating as h → 0: b or c.
    pub fn constraint_gain(self, h: f64) -> f64 {
        match self.level {
            ConstraintLevel::Position => self.position_gain(h),
            ConstraintLevel::Velocity => self.velocity_gain(h),
        }
    }

    /// Local position error per a₊ − a: (β + Δ/2 − 1/6) h².
    pub fn error_gain(self, h: f64) -> f64 {
        (self.beta + self.shift() / 2.0 - 1.0 / 6.0) * h * h
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hht_has_the_papers_numbers() {
        // Negrut et al. 2007, eq. 9.
        let alpha = -0.1;
        let numbers = Scheme::Hht { alpha }.coefficients();
        assert_eq!((numbers.beta, numbers.gamma), ((1.0 - alpha) * (1.0 - alpha) / 4.0, 0.5 - alpha));
        assert_eq!((numbers.of_new(), numbers.of_old(), numbers.of_algorithmic()), (1.0 + alpha, -alpha, 0.0));
        assert_eq!(numbers.shift(), alpha);
        assert_eq!(numbers.error_gain(1.0), numbers.beta + alpha / 2.0 - 1.0 / 6.0);
    }

    #[test]
    fn generalised_alpha_has_the_laws_of_its_family() {
        for rho in [0.0, 0.3, 0.5, 0.8, 1.0] {
            let numbers = Scheme::GeneralisedAlpha { spectral_radius: rho }.coefficients();
            assert!((numbers.gamma - (0.5 - numbers.shift())).abs() < 1e-15, "second order");
            assert!((numbers.beta - 0.25 * (numbers.gamma + 0.5).powi(2)).abs() < 1e-15, "most dissipation");
            // Chung & Hulbert's own condition for the most dissipation: α_f = (α_m + 1)/3.
            assert!((numbers.alpha_f - (numbers.alpha_m + 1.0) / 3.0).abs() < 1e-15);
        }
    }
}
