//! Points spread evenly over the unit cube: a lattice, shifted at random a few times, so that the replicates give the
//! error of a mean.

use super::tuning::TUNING;

/// Shifts of the lattice.
pub const REPLICATES: usize = TUNING.replicates;

/// A generating vector whose first 2^m points are a good lattice for every m up to 20: R. Cools, F. Y. Kuo & D. Nuyens,
/// Constructing embedded lattice rules for multivariate integration, SIAM J. Sci. Comput. 28 (2006) 2162
/// (`exod2_base2_m20_CKN`).
const GENERATOR: [u64; 32] = [
    1, 182667, 469891, 498753, 110745, 446247, 250185, 118627, 245333, 283199, 408519, 391023, 246327, 126539, 399185,
    461527, 300343, 69681, 516695, 436179, 106383, 238523, 413283, 70841, 47719, 300129, 113029, 123925, 410745,
    211325, 17489, 511893,
];

/// The whole numbers below 2^53 of a counter, mixed (S. Vigna's SplitMix64).
pub(super) fn mixed(counter: u64) -> u64 {
    let mut z = counter.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) >> 11
}

/// One replicate's points in (0, 1)^k, point after point; `count` is a power of two up to 2^20. Along axes beyond the
/// generator's, points are random.
pub fn replicate(number: usize, k: usize, count: usize) -> Vec<f64> {
    const UNIT: f64 = 1.0 / (1_u64 << 53) as f64;
    let mut points = Vec::with_capacity(k * count);
    let shifts: Vec<u64> = (0..k).map(|axis| mixed((number * 0x1_0000 + axis) as u64)).collect();
    let step = (1_u64 << 53) / count as u64;
    for index in 0..count as u64 {
        for (axis, shift) in shifts.iter().enumerate() {
            let along = match GENERATOR.get(axis) {
                Some(generator) => (index * generator % count as u64 * step + shift) % (1 << 53),
                None => mixed(shift.wrapping_mul(31) ^ (index << 20)),
            };
            // The middle of a cell of 2⁻⁵³, never an end.
            points.push((along as f64 + 0.5) * UNIT);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_match_integrals() {
        // The mean of Π (1 + (xᵢ − ½)) over the cube is 1.
        let (k, count) = (6, 1 << 12);
        let of_replicate = |number: usize| {
            let points = replicate(number, k, count);
            points.chunks_exact(k).map(|x| x.iter().map(|x| 0.5 + x).product::<f64>()).sum::<f64>() / count as f64
        };
        let means: Vec<f64> = (0..REPLICATES).map(of_replicate).collect();
        let mean = means.iter().sum::<f64>() / REPLICATES as f64;
        // The variance is (13/12)⁶ − 1: random points would be off by 1.2e-2 in a replicate, and by 3e-3 in all.
        assert!((mean - 1.0).abs() < 3e-4 && means.iter().all(|mean| (mean - 1.0).abs() < 4e-3), "{mean} {means:?}");
    }

    #[test]
    fn every_point_lies_inside_and_shifts_differ() {
        for k in [1, 3, 40] {
            let points = replicate(3, k, 256);
            assert!(points.len() == 256 * k && points.iter().all(|x| *x > 0.0 && *x < 1.0));
            assert!(points != replicate(4, k, 256));
        }
        // Along every axis the lattice has one point in each cell.
        let points = replicate(0, 5, 64);
        for axis in 0..5 {
            let mut cells: Vec<usize> = points.chunks_exact(5).map(|point| (point[axis] * 64.0) as usize).collect();
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(cells.len(), 64);
        }
    }
}
