//! Designs of experiments: points in the unit cube that are made one at a time, however many there are.

use std::ops::Range;

/// Primitive polynomials (with both ends' bits) and initial direction numbers of the axes after the first: S. Joe & F.
/// Y. Kuo, Constructing Sobol sequences with better two-dimensional projections, SIAM J. Sci. Comput. 30 (2008) 2635
/// (`new-joe-kuo-6.21201`).
#[rustfmt::skip]
const DIRECTIONS: [(u32, &[u32]); 63] = [
    (3, &[1]),
    (7, &[1, 3]),
    (11, &[1, 3, 1]),
    (13, &[1, 1, 1]),
    (19, &[1, 1, 3, 3]),
    (25, &[1, 3, 5, 13]),
    (37, &[1, 1, 5, 5, 17]),
    (41, &[1, 1, 5, 5, 5]),
    (47, &[1, 1, 7, 11, 19]),
    (55, &[1, 1, 5, 1, 1]),
    (59, &[1, 1, 1, 3, 11]),
    (61, &[1, 3, 5, 5, 31]),
    (67, &[1, 3, 3, 9, 7, 49]),
    (91, &[1, 1, 1, 15, 21, 21]),
    (97, &[1, 3, 1, 13, 27, 49]),
    (103, &[1, 1, 1, 15, 7, 5]),
    (109, &[1, 3, 1, 15, 13, 25]),
    (115, &[1, 1, 5, 5, 19, 61]),
    (131, &[1, 3, 7, 11, 23, 15, 103]),
    (137, &[1, 3, 7, 13, 13, 15, 69]),
    (143, &[1, 1, 3, 13, 7, 35, 63]),
    (145, &[1, 3, 5, 9, 1, 25, 53]),
    (157, &[1, 3, 1, 13, 9, 35, 107]),
    (167, &[1, 3, 1, 5, 27, 61, 31]),
    (171, &[1, 1, 5, 11, 19, 41, 61]),
    (185, &[1, 3, 5, 3, 3, 13, 69]),
    (191, &[1, 1, 7, 13, 1, 19, 1]),
    (193, &[1, 3, 7, 5, 13, 19, 59]),
    (203, &[1, 1, 3, 9, 25, 29, 41]),
    (211, &[1, 3, 5, 13, 23, 1, 55]),
    (213, &[1, 3, 7, 3, 13, 59, 17]),
    (229, &[1, 3, 1, 3, 5, 53, 69]),
    (239, &[1, 1, 5, 5, 23, 33, 13]),
    (241, &[1, 1, 7, 7, 1, 61, 123]),
    (247, &[1, 1, 7, 9, 13, 61, 49]),
    (253, &[1, 3, 3, 5, 3, 55, 33]),
    (285, &[1, 3, 1, 15, 31, 13, 49, 245]),
    (299, &[1, 3, 5, 15, 31, 59, 63, 97]),
    (301, &[1, 3, 1, 11, 11, 11, 77, 249]),
    (333, &[1, 3, 1, 11, 27, 43, 71, 9]),
    (351, &[1, 1, 7, 15, 21, 11, 81, 45]),
    (355, &[1, 3, 7, 3, 25, 31, 65, 79]),
    (357, &[1, 3, 1, 1, 19, 11, 3, 205]),
    (361, &[1, 1, 5, 9, 19, 21, 29, 157]),
    (369, &[1, 3, 7, 11, 1, 33, 89, 185]),
    (391, &[1, 3, 3, 3, 15, 9, 79, 71]),
    (397, &[1, 3, 7, 11, 15, 39, 119, 27]),
    (425, &[1, 1, 3, 1, 11, 31, 97, 225]),
    (451, &[1, 1, 1, 3, 23, 43, 57, 177]),
    (463, &[1, 3, 7, 7, 17, 17, 37, 71]),
    (487, &[1, 3, 1, 5, 27, 63, 123, 213]),
    (501, &[1, 1, 3, 5, 11, 43, 53, 133]),
    (529, &[1, 3, 5, 5, 29, 17, 47, 173, 479]),
    (539, &[1, 3, 3, 11, 3, 1, 109, 9, 69]),
    (545, &[1, 1, 1, 5, 17, 39, 23, 5, 343]),
    (557, &[1, 3, 1, 5, 25, 15, 31, 103, 499]),
    (563, &[1, 1, 1, 11, 11, 17, 63, 105, 183]),
    (601, &[1, 1, 5, 11, 9, 29, 97, 231, 363]),
    (607, &[1, 1, 5, 15, 19, 45, 41, 7, 383]),
    (617, &[1, 3, 7, 7, 31, 19, 83, 137, 221]),
    (623, &[1, 1, 1, 3, 23, 15, 111, 223, 83]),
    (631, &[1, 1, 5, 13, 31, 15, 55, 25, 161]),
    (637, &[1, 1, 3, 13, 25, 47, 39, 87, 257]),
];

/// Digits of a coordinate of Sobol's sequence.
const BITS: u32 = 32;

/// Most axes of Sobol's sequence.
pub const MOST_AXES: usize = DIRECTIONS.len() + 1;

/// Choice of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Design {
    /// Sobol's sequence from its first point on, without scrambling; up to 2³² points along up to [`MOST_AXES`] axes.
    Sobol,
    /// A Latin hypercube: each axis is cut into as many cells as there are points, and each cell has one, anywhere in
    /// it.
    LatinHypercube {
        /// Another number makes another hypercube.
        seed: u64,
    },
}

impl Design {
    /// Some consecutive points of `count` in [0, 1)^k.
    pub fn points(self, k: usize, count: usize, places: Range<usize>) -> Vec<Vec<f64>> {
        match self {
            Self::Sobol => {
                let axes: Vec<[u32; BITS as usize]> = (0..k).map(directions).collect();
                places.map(|index| axes.iter().map(|axis| sobol(axis, index as u32)).collect()).collect()
            }
            Self::LatinHypercube { seed } => {
                let point = |index: usize| {
                    let along = |axis: usize| {
                        let key = mixed(seed ^ mixed(axis as u64 + 1));
                        let cell = permuted(index as u64, count as u64, key);
                        (cell as f64 + uniform(mixed(key ^ mixed(index as u64)))) / count as f64
                    };
                    // Rounding must not reach the end.
                    (0..k).map(|axis| along(axis).min(1.0 - f64::EPSILON / 2.0)).collect()
                };
                places.map(point).collect()
            }
        }
    }
}

/// Direction numbers of an axis: the digits of the point at each power of two.
fn directions(axis: usize) -> [u32; BITS as usize] {
    let mut numbers = [0; BITS as usize];
    let Some(&(polynomial, initial)) = axis.checked_sub(1).and_then(|index| DIRECTIONS.get(index)) else {
        // Van der Corput's sequence.
        return std::array::from_fn(|bit| 1 << (BITS - 1 - bit as u32));
    };
    let degree = initial.len();
    for bit in 0..BITS as usize {
        numbers[bit] = match initial.get(bit) {
            Some(number) => number << (BITS - 1 - bit as u32),
            None => {
                let before: u32 = numbers[bit - degree];
                let inner = (1..degree).filter(|term| polynomial >> (degree - term) & 1 == 1);
                inner.fold(before ^ before >> degree, |number, term| number ^ numbers[bit - term])
            }
        };
    }
    numbers
}

/// A coordinate of a point, in the order of Gray's code.
fn sobol(directions: &[u32; BITS as usize], index: u32) -> f64 {
    let gray = index ^ index >> 1;
    let digits = (0..BITS).filter(|bit| gray >> bit & 1 == 1).fold(0, |digits, bit| digits ^ directions[bit as usize]);
    f64::from(digits) / 4_294_967_296.0
}

/// S. Vigna's SplitMix64.
fn mixed(counter: u64) -> u64 {
    let mut z = counter.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A number in [0, 1).
fn uniform(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

/// The image of a number under a random permutation of 0 … count − 1, without a table: a Feistel network on the next
/// even power of two, walked until it is back among the numbers (J. Black & P. Rogaway, Ciphers with arbitrary finite
/// domains, 2002).
fn permuted(number: u64, count: u64, key: u64) -> u64 {
    let half = (u64::BITS - count.saturating_sub(1).leading_zeros()).div_ceil(2).max(1);
    let mask = (1 << half) - 1;
    let mut at = number;
    loop {
        let (mut left, mut right) = (at >> half, at & mask);
        for round in 0..6 {
            (left, right) = (right, left ^ (mixed(key.wrapping_add(round << 56) ^ right) & mask));
        }
        at = left << half | right;
        if at < count {
            return at;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sobol_points_match_scipy() {
        // scipy.stats.qmc.Sobol(d, scramble=False).random(n), axes 1, 2, 3, 8 and 64 of points 5 and 1000.
        let points = Design::Sobol.points(64, 1001, 0..1001);
        let at = |index: usize| [0, 1, 2, 7, 63].map(|axis| points[index][axis]);
        assert_eq!(points[0], [0.0; 64]);
        assert_eq!(at(5), [0.875, 0.875, 0.125, 0.375, 0.625]);
        assert_eq!(at(1000), [0.2197265625, 0.0966796875, 0.5185546875, 0.8994140625, 0.4462890625]);
        assert_eq!(Design::Sobol.points(64, 1001, 1000..1001), points[1000..]);
    }

    #[test]
    fn every_cell_of_a_latin_hypercube_has_a_point() {
        for count in [1, 2, 7, 100, 1025] {
            let points = Design::LatinHypercube { seed: 3 }.points(3, count, 0..count);
            for axis in 0..3 {
                let mut cells: Vec<usize> = points.iter().map(|point| (point[axis] * count as f64) as usize).collect();
                cells.sort_unstable();
                assert!(cells.iter().copied().eq(0..count), "{count}");
            }
        }
        let of_seed = |seed| Design::LatinHypercube { seed }.points(2, 50, 0..50);
        assert_ne!(of_seed(1), of_seed(2));
        // Coordinates are not correlated: |r| of 1000 points is below 0.1 in all but one case of 600.
        let points = Design::LatinHypercube { seed: 0 }.points(2, 1000, 0..1000);
        let r = points.iter().map(|point| 12.0 * (point[0] - 0.5) * (point[1] - 0.5)).sum::<f64>() / 1000.0;
        assert!(r.abs() < 0.1, "{r}");
    }
}
