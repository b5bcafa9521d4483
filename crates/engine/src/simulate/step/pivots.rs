//! Pivots of a factorisation that are too small.

use symdiff::{Tile, Vectorise};

use crate::compile::WatchedPivots;

/// Marks lanes with a pivot that is too small as singular: they take the rank-revealing solve.
pub(super) struct Watch<'a> {
    pub watched: &'a [WatchedPivots],
    pub tile: &'a Tile,
    pub singular: &'a mut [bool],
}

impl Vectorise for Watch<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { watched, tile, singular } = self;
        // NaN is not trusted either.
        let lost = |inverse: f64, largest: f64| inverse.is_nan() || inverse.abs() > largest;
        for WatchedPivots { mode, pivots } in watched {
            match mode {
                None => pivots.iter().for_each(|pivot| {
                    for (singular, &inverse) in singular.iter_mut().zip(tile.lane(pivot.register)) {
                        *singular |= lost(inverse, pivot.largest_inverse);
                    }
                }),
                // Lanes that do not use this version have arbitrary factors.
                Some(mode) if tile.lane(mode.register).iter().any(|&value| mode.holds(value)) => {
                    for pivot in pivots {
                        let lanes = singular.iter_mut().zip(tile.lane(pivot.register)).zip(tile.lane(mode.register));
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
