//! Tolerance classes by their names: `H7`, `g6`, `js9`, `IT8` of ISO 286-1:2010, `ISO 2768-m` of ISO 2768-1:1989.
//!
//! A class gives both limits of a size. Holes have capitals, shafts small letters:
//!
//! ```text
//! a … h    es = −deviation,  ei = es − IT          j, k … zc   ei = deviation,  es = ei + IT
//! A … H    EI = +deviation,  ES = EI + IT          J, K … ZC   ES = −deviation + Δ,  EI = ES − IT
//! js, JS, IT    ± IT/2
//! ```
//!
//! Δ = ITₙ − ITₙ₋₁ for K, M, N up to grade 8 and for P to ZC up to grade 7, of sizes above 3 mm (4.3.2).

mod classes;
mod general;
mod large;
mod tables;

use thiserror::Error;

pub use classes::FitClass;
pub use general::GeneralClass;

/// A tolerance class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToleranceClass {
    /// A class of ISO 286-1.
    Fit(FitClass),
    /// A class of ISO 2768-1.
    General(GeneralClass),
}

/// A class that has no limits, or that does not exist.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ClassError {
    /// Letters that ISO 286 does not have.
    #[error("ISO 286 has no class with the letters `{letters}`")]
    Letters {
        /// As written.
        letters: String,
    },
    /// A grade that ISO 286 does not have.
    #[error("ISO 286 has the grades 01, 0 and 1 to 18, and no `{grade}`")]
    Grade {
        /// As written.
        grade: String,
    },
    /// A designation that ISO 2768 does not have.
    #[error("ISO 2768 has the classes f, m, c and v for sizes, and no `{class}`")]
    General {
        /// As written.
        class: String,
    },
    /// A size outside of the tables.
    #[error("`{class}` has limits for sizes {range}, but this one is {size} mm")]
    Size {
        /// The class.
        class: String,
        /// Sizes that it has limits for.
        range: String,
        /// The size, mm.
        size: String,
    },
}

impl ToleranceClass {
    /// Reads a class; `None` if a text has not the form of one.
    pub fn parse(text: &str) -> Option<Result<Self, ClassError>> {
        if let Some(general) = general::parse(text) {
            return Some(general.map(Self::General));
        }
        classes::parse(text).map(|class| class.map(Self::Fit))
    }

    /// Lower and upper deviation from a size in mm, µm.
    ///
    /// # Errors
    /// For sizes outside of the tables.
    pub fn deviations(self, size: f64) -> Result<[f64; 2], ClassError> {
        match self {
            Self::Fit(class) => class.deviations(size),
            Self::General(class) => class.deviations(size),
        }
    }
}

/// Error of a size outside of the tables.
fn out_of_range(class: String, range: &str, size: f64) -> ClassError {
    ClassError::Size { class, range: range.to_owned(), size: format!("{size}") }
}
