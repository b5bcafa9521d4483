//! Motions that certified bounds prove, and the data that an ensemble hands over for it.

use symdiff::Interval;

use super::tuning::TUNING;
use crate::certificate::Piece;

/// The proven motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Proof {
    /// The differential equation's motion.
    #[default]
    Motion,
    /// The motion as HHT-I3's steps of the given length define it.
    Scheme,
}

impl Proof {
    /// Orders of polynomials, by the number of parameters.
    pub(super) fn orders(self) -> &'static [usize] {
        match self {
            Self::Motion => &TUNING.orders_of_motion,
            Self::Scheme => &TUNING.orders_of_scheme,
        }
    }

    /// Most pieces that are enclosed at last.
    pub(super) fn most_pieces(self) -> usize {
        match self {
            Self::Motion => 64,
            Self::Scheme => 16,
        }
    }
}

/// Takes the Taylor models of a row's outputs, and the intervals of the outputs since the row before; no intervals if
/// these are not known.
pub type EnclosedRow<'r> = dyn FnMut(&[f64], &[Interval]) + 'r;

/// Why an enclosure ends before the last row.
#[derive(Clone, Debug, PartialEq)]
pub struct Lost {
    /// End of the step that could not be enclosed, s.
    pub time: f64,
    /// Why.
    pub why: String,
    /// Whether a smaller piece of the box may get further.
    pub is_too_wide: bool,
    /// The parameter of which the piece is too wide, if it is known.
    pub axis: Option<usize>,
    /// A remedy, for people.
    pub help: String,
}

/// How the enclosure of a piece of the box ended.
#[derive(Clone, Debug, Default)]
pub struct EnclosureEnd {
    /// Why before the last row; at an interruption it just ends.
    pub lost: Option<Lost>,
    /// The proof for a certificate, if there is one.
    pub piece: Option<Piece>,
}

impl From<Lost> for EnclosureEnd {
    fn from(lost: Lost) -> Self {
        Self { lost: Some(lost), piece: None }
    }
}
