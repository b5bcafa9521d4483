//! Newton's corrections of a tile until every lane has settled.

use super::tuning::TUNING;
use symdiff::{LaneWork, Tile, in_lanes, lanes_mut};

/// Record of each lane's corrections.
#[derive(Debug)]
pub(super) struct Settling {
    pending: Vec<bool>,
    size: Vec<f64>,
    /// Size of the correction before; NaN before the first one.
    last: Vec<f64>,
}

impl Settling {
    /// For `width` lanes.
    pub fn new(width: usize) -> Self {
        Self { pending: vec![true; width], size: vec![0.0; width], last: vec![f64::NAN; width] }
    }

    /// Prepares for the first correction.
    pub fn begin(&mut self) {
        self.pending.fill(true);
        self.last.fill(f64::NAN);
    }

    /// Adds corrections, `count` registers from `corrections` on, to as many values from `values` on, which are before
    /// them in the tile, in all lanes that have not settled. `scale` has the least size of the values, 1 where it ends.
    /// Returns whether a lane has not settled.
    pub fn apply(&mut self, tile: &mut Tile, values: usize, corrections: usize, count: usize, scale: &[f64]) -> bool {
        let width = tile.width();
        let (known, found) = tile.values_mut().split_at_mut(corrections * width);
        let (known, found) = (&mut known[values * width..][..count * width], &found[..count * width]);
        in_lanes(width, Apply { settling: self, known, corrections: found, scale });
        self.pending.contains(&true)
    }

    /// Which lanes have settled.
    pub fn settled(&self) -> Vec<bool> {
        self.pending.iter().map(|pending| !pending).collect()
    }
}

struct Apply<'a> {
    settling: &'a mut Settling,
    known: &'a mut [f64],
    corrections: &'a [f64],
    scale: &'a [f64],
}

impl LaneWork for Apply<'_> {
    #[inline(always)]
    fn run<const W: usize>(self) {
        let Self { settling: Settling { pending, size, last }, known, corrections, scale } = self;
        let (pending, size) = (lanes_mut::<W, _>(pending), lanes_mut::<W, _>(size));
        *size = [0.0; W];
        let rows = known.as_chunks_mut::<W>().0.iter_mut().zip(corrections.as_chunks::<W>().0);
        for ((values, corrections), scale) in rows.zip(scale.iter().chain(std::iter::repeat(&1.0))) {
            let lanes = values.iter_mut().zip(corrections).zip(size.iter_mut()).zip(pending.iter());
            for (((value, correction), size), pending) in lanes {
                *value = if *pending { *value + correction } else { *value };
                // NaN is ignored: the caller searches for values that are not finite.
                let relative = (correction / scale.max(value.abs())).abs();
                *size = if relative > *size { relative } else { *size };
            }
        }
        for ((pending, size), last) in pending.iter_mut().zip(size.iter()).zip(lanes_mut::<W, _>(last)) {
            let is_rounding = *size <= TUNING.stalled && *size >= 0.5 * *last;
            *pending &= *size > TUNING.settled && !is_rounding;
            *last = *size;
        }
    }
}
