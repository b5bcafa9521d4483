//! Integrals of several functions of one variable, by Gauss and Kronrod's rules on intervals that are halved where the
//! two rules differ.
//!
//! Nodes and weights of 7 and 15 points: R. Piessens, E. de Doncker-Kapenga, C. W. Überhuber & D. K. Kahaner,
//! QUADPACK (1983), `qk15`.

use super::tuning::TUNING;

/// Nodes of the 15 points from 1 to 0; every second one, from the second on, is Gauss's.
const NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];

/// Kronrod's weights.
const WEIGHTS: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_82,
];

/// Gauss's weights.
const GAUSS: [f64; 4] =
    [0.129_484_966_168_869_7, 0.279_705_391_489_276_64, 0.381_830_050_505_118_9, 0.417_959_183_673_469_4];

/// One interval: Kronrod's integrals, and their distance from Gauss's.
struct Piece {
    ends: [f64; 2],
    integrals: Vec<f64>,
    errors: Vec<f64>,
}

/// Integrals of functions that are nowhere negative, over the intervals between `breaks` (ascending), each to the share
/// `relative` of it. `values` puts the functions' values at a point into a list of `count`. `None` if the intervals
/// do not suffice, or a value is not finite.
pub fn integrals(
    breaks: &[f64],
    count: usize,
    relative: f64,
    mut values: impl FnMut(f64, &mut [f64]),
) -> Option<Vec<f64>> {
    let mut at = vec![0.0; count];
    let mut piece = |ends: [f64; 2]| {
        let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
        let (mut integrals, mut gauss) = (vec![0.0; count], vec![0.0; count]);
        for (index, (node, weight)) in NODES.iter().zip(WEIGHTS).enumerate() {
            let sides: &[f64] = if *node == 0.0 { &[0.0] } else { &[-1.0, 1.0] };
            for side in sides {
                values(middle + side * half * node, &mut at);
                for (index_of, value) in at.iter().enumerate() {
                    integrals[index_of] += half * weight * value;
                    gauss[index_of] += if index % 2 == 1 { half * GAUSS[index / 2] * value } else { 0.0 };
                }
            }
        }
        let errors = integrals.iter().zip(&gauss).map(|(a, b)| (a - b).abs()).collect();
        Piece { ends, integrals, errors }
    };
    let mut pieces: Vec<Piece> = breaks.windows(2).map(|pair| piece([pair[0], pair[1]])).collect();
    loop {
        let sums = |of: fn(&Piece) -> &Vec<f64>| -> Vec<f64> {
            (0..count).map(|index| pieces.iter().map(|piece| of(piece)[index]).sum()).collect()
        };
        let (totals, errors) = (sums(|piece| &piece.integrals), sums(|piece| &piece.errors));
        if totals.iter().any(|total| !total.is_finite()) {
            return None;
        }
        if errors.iter().zip(&totals).all(|(error, total)| *error <= relative * total) {
            return Some(totals);
        }
        // All pieces with more than their share of an error are halved at once.
        let share = 1.0 / pieces.len() as f64;
        let is_coarse =
            |piece: &Piece| piece.errors.iter().zip(&totals).any(|(error, total)| *error > share * relative * total);
        let (coarse, fine): (Vec<Piece>, Vec<Piece>) = pieces.into_iter().partition(is_coarse);
        if fine.len() + 2 * coarse.len() > TUNING.most_intervals {
            return None;
        }
        pieces = fine;
        for Piece { ends: [from, to], .. } in coarse {
            let middle = 0.5 * (from + to);
            pieces.extend([piece([from, middle]), piece([middle, to])]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use symdiff::math;

    #[test]
    fn integrals_of_peaks_and_of_polynomials() {
        // ∫ 1/((x − 0.3)² + c²) = (atan((b − 0.3)/c) − atan((a − 0.3)/c))/c, and ∫ x⁸ from −1 to 2.
        let c = 1e-3;
        let found = integrals(&[-1.0, 2.0], 2, 1e-11, |x, values| {
            values[0] = 1.0 / ((x - 0.3) * (x - 0.3) + c * c);
            values[1] = math::pow(x.abs(), 8.0);
        });
        let found = found.expect("smooth functions");
        let peak = (math::atan2(1.7, c) + math::atan2(1.3, c)) / c;
        assert!((found[0] / peak - 1.0).abs() < 1e-11 && (found[1] / 57.0 - 1.0).abs() < 1e-11, "{found:?}");
    }

    #[test]
    fn poles_have_no_integral() {
        let pole = |x: f64, values: &mut [f64]| values[0] = 1.0 / ((x - 0.3) * (x - 0.3));
        assert!(integrals(&[0.0, 1.0], 1, 1e-9, pole).is_none());
    }
}
