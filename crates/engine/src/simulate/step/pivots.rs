//! Pivots of a factorisation that are too small.

use symdiff::{LaneWork, Tile, lanes, lanes_mut};

use crate::compile::WatchedPivots;

/// Marks lanes with a pivot that is too small as singular: they take the rank-revealing solve.
pub(super) struct Watch<'a> {
    pub watched: &'a [WatchedPivots],
    pub tile: &'a Tile,
    pub singular: &'a mut [bool],
}

impl LaneWork for Watch<'_> {
    #[inline(always)]
    fn run<const W: usize>(self) {
        let Self { watched, tile, singular } = self;
        let singular = lanes_mut::<W, _>(singular);
        // NaN is not trusted either.
        let lost = |inverse: f64, largest: f64| inverse.is_nan() || inverse.abs() > largest;
        let values = |register: usize| lanes::<W, _>(tile.lane(register));
        for WatchedPivots { mode, pivots } in watched {
            match mode {
                None => pivots.iter().for_each(|pivot| {
                    for (singular, &inverse) in singular.iter_mut().zip(values(pivot.register)) {
                        *singular |= lost(inverse, pivot.largest_inverse);
                    }
                }),
                // Lanes that do not use this version have arbitrary factors.
                Some(mode) if values(mode.register).iter().any(|&value| mode.holds(value)) => {
                    for pivot in pivots {
                        let lanes = singular.iter_mut().zip(values(pivot.register)).zip(values(mode.register));
                        for ((singular, &inverse), &value) in lanes {
                            *singular |= mode.holds(value) & lost(inverse, pivot.largest_inverse);
                        }
                    }
                }
                Some(_) => {}
            }
        }
    }
}
