//! Spectral densities of stationary random functions, and lines that stand for them.
//!
//! A density G is one-sided: the variance is ∫ G(ν) dν over the band. A line stands for a bin of the band: a cosine
//! with a random amplitude of the bin's variance, at a random frequency in it.

use symdiff::math;

use super::quadrature::integrals;
use super::tuning::TUNING;

/// A one-sided spectral density over its frequency ν, up to a factor.
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// (ν/at)^exponent: white noise with exponent 0, a road with −2.
    Power {
        /// The exponent.
        exponent: f64,
        /// Frequency at which the density is one.
        at: f64,
    },
    /// White noise behind a lag: 1/(1 + (ν/corner)²).
    Lag {
        /// Frequency at which the density is one half.
        corner: f64,
    },
    /// White noise behind a vibration: 1/((1 − r²)² + (2 ζ r)²), r = ν/natural.
    Vibration {
        /// Natural frequency.
        natural: f64,
        /// ζ, positive.
        damping: f64,
    },
    /// Pairs of a frequency and a density, both positive, frequencies ascending; between them straight lines of their
    /// logarithms, as densities are drawn.
    Table(Vec<[f64; 2]>),
}

/// A part of a band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Its ends.
    pub ends: [f64; 2],
    /// ∫ G over it.
    pub variance: f64,
    /// Exponent of the power law through the densities at its ends.
    pub exponent: f64,
}

impl Spectrum {
    /// G(ν).
    pub fn density(&self, frequency: f64) -> f64 {
        match self {
            Self::Power { exponent: 0.0, .. } => 1.0,
            Self::Power { exponent, at } => math::pow(frequency / at, *exponent),
            Self::Lag { corner } => 1.0 / (1.0 + (frequency / corner) * (frequency / corner)),
            Self::Vibration { natural, damping } => {
                let r = frequency / natural;
                let (stiff, damped) = (1.0 - r * r, 2.0 * damping * r);
                1.0 / (stiff * stiff + damped * damped)
            }
            Self::Table(points) => {
                let after = points.partition_point(|[own, _]| *own < frequency).clamp(1, points.len() - 1);
                let ([from, low], [to, high]) = (points[after - 1], points[after]);
                let share = math::ln(frequency / from) / math::ln(to / from);
                low * math::pow(high / low, share)
            }
        }
    }

    /// Frequencies at which the density has kinks or peaks.
    pub fn breaks(&self) -> Vec<f64> {
        match self {
            Self::Power { .. } => Vec::new(),
            Self::Lag { corner } => vec![*corner],
            Self::Vibration { natural, .. } => vec![*natural],
            Self::Table(points) => points.iter().map(|[frequency, _]| *frequency).collect(),
        }
    }

    /// ∫ G from a to b; NaN if the integration fails.
    pub fn variance(&self, [from, to]: [f64; 2]) -> f64 {
        let mut ends = vec![from];
        ends.extend(self.breaks().into_iter().filter(|own| from < *own && *own < to));
        ends.push(to);
        let found =
            integrals(&ends, 1, TUNING.accuracy_of_bins, |frequency, values| values[0] = self.density(frequency));
        found.map_or(f64::NAN, |found| found[0])
    }

    /// A band in `count` bins: half of them evenly (by equal factors in a wide band), half by their variance.
    pub fn bins(&self, band: [f64; 2], count: usize) -> Vec<Bin> {
        let [from, to] = band;
        let is_wide = from > 0.0 && to > TUNING.wide_bin * from;
        let number = TUNING.points_a_bin * count;
        let point = |index: usize| {
            let share = index as f64 / number as f64;
            if is_wide { from * math::pow(to / from, share) } else { from + (to - from) * share }
        };
        let points: Vec<f64> = (0..=number).map(point).collect();
        let mut sums = vec![0.0];
        for pair in points.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            sums.push(sums[sums.len() - 1] + self.density(middle) * (pair[1] - pair[0]));
        }
        let all = sums[number];
        let measure: Vec<f64> =
            sums.iter().enumerate().map(|(index, sum)| 0.5 * (index as f64 / number as f64 + sum / all)).collect();
        let end = |bin: usize| {
            let wanted = bin as f64 / count as f64;
            let after = measure.partition_point(|own| *own < wanted).clamp(1, number);
            let share = (wanted - measure[after - 1]) / (measure[after] - measure[after - 1]);
            points[after - 1] + share * (points[after] - points[after - 1])
        };
        let mut ends: Vec<f64> = (0..=count).map(end).collect();
        (ends[0], ends[count]) = (from, to);
        let bin = |pair: &[f64]| {
            let ends = [pair[0], pair[1]];
            let densities = ends.map(|end| self.density(end));
            let exponent =
                if ends[0] > 0.0 { math::ln(densities[1] / densities[0]) / math::ln(ends[1] / ends[0]) } else { 0.0 };
            Bin { ends, variance: self.variance(ends), exponent }
        };
        ends.windows(2).map(bin).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variances_match_closed_forms() {
        // ∫ (ν/n)⁻² = n² (1/a − 1/b); ∫ of a lag is an arc; of a vibration over all frequencies π f/(4 ζ).
        let road = Spectrum::Power { exponent: -2.0, at: 0.1 };
        let lag = Spectrum::Lag { corner: 5.0 };
        let vibration = Spectrum::Vibration { natural: 3.0, damping: 0.02 };
        let table = Spectrum::Table(vec![[1.0, 4.0], [2.0, 1.0], [4.0, 1.0]]);
        let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
        near(road.variance([0.011, 2.83]), 0.01 * (1.0 / 0.011 - 1.0 / 2.83));
        near(lag.variance([0.0, 20.0]), 5.0 * math::atan2(20.0, 5.0));
        let beyond = 3.0_f64.powi(4) / (3.0 * 3000.0_f64.powi(3));
        near(vibration.variance([0.0, 3000.0]) + beyond, std::f64::consts::PI * 3.0 / 0.08);
        // 4 ν⁻² from 1 to 2, then 1.
        near(table.variance([1.0, 4.0]), 2.0 + 2.0);
    }

    #[test]
    fn bins_have_all_of_the_variance() {
        let all = [
            (Spectrum::Power { exponent: -2.0, at: 0.1 }, [0.011, 2.83]),
            (Spectrum::Power { exponent: 0.0, at: 1.0 }, [0.0, 20.0]),
            (Spectrum::Vibration { natural: 3.0, damping: 0.05 }, [0.5, 30.0]),
        ];
        for (spectrum, band) in all {
            let bins = spectrum.bins(band, 80);
            let sum: f64 = bins.iter().map(|bin| bin.variance).sum();
            assert!((sum / spectrum.variance(band) - 1.0).abs() < 1e-8, "{spectrum:?}");
            assert!(bins.len() == 80 && bins.windows(2).all(|pair| pair[0].ends[1] == pair[1].ends[0]));
            // None has much more than its share of a half.
            assert!(bins.iter().all(|bin| bin.ends[0] < bin.ends[1] && bin.variance < 2.1 * sum / 80.0));
        }
    }
}
