//! What certified bounds prove, and what an ensemble hands over for it.

use symdiff::Interval;

/// Order of the polynomials by the number of parameters, of a proof of the motion: pieces and coefficients grow with
/// powers of that number.
const ORDER_OF_MOTION: [usize; 4] = [14, 12, 12, 8];

/// The same of a proof of the scheme. (Slider crank, ±1 % of one: 8, 12 and 16 reach 0.51, 0.71 and 0.72 s in one
/// piece.)
const ORDER_OF_SCHEME: [usize; 3] = [0, 12, 6];

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
            Self::Motion => &ORDER_OF_MOTION,
            Self::Scheme => &ORDER_OF_SCHEME,
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

/// Takes the Taylor models of a row's outputs, and within which each output is since the row before; nothing where that
/// is not known.
pub type EnclosedRow<'r> = dyn FnMut(&[f64], &[Interval]) + 'r;
