//! Laws in zones. In polar coordinates an even law over a disc or a ball, and a normal one in every direction, have a
//! direction and a radius that are independent (L. Devroye, Non-Uniform Random Variate Generation, 1986, chapter V).

use std::f64::consts::{PI, SQRT_2};

use symdiff::math;

use super::tuning::TUNING;
use crate::model::{Description, Zone, ZoneLaw, ZoneShape};

/// Standard deviations to the edge of a normal law.
const EDGE: f64 = 3.0;

/// The joint law of a zone's parameters.
pub(super) struct LawInZone {
    /// Indices of the parameters.
    members: Vec<usize>,
    shape: ZoneShape,
    law: ZoneLaw,
}

impl LawInZone {
    /// Laws in all zones of a model, whose uncertain parameters have these names.
    pub fn all(description: &Description, names: &[String]) -> Vec<Self> {
        let of = |zone: &Zone| Self { members: zone.indices(names), shape: zone.shape, law: zone.law };
        description.zones.iter().map(of).collect()
    }

    /// Replaces independent uniform values of the parameters in [-1, 1] by those of the law.
    pub fn place(&self, sample: &mut [f64]) {
        // Shares from 0 to 1, of values from -1 to 1.
        let by_share = |value: &mut f64, of: &dyn Fn(f64) -> f64| *value = 2.0 * of(0.5 * (1.0 + *value)) - 1.0;
        match self.shape {
            ZoneShape::Box => {}
            ZoneShape::Discs => {
                for members in self.members.chunks_exact(2) {
                    by_share(&mut sample[members[0]], &|share| self.radius_in_disc(share));
                }
            }
            ZoneShape::Ball => {
                let &[radius, elevation, _] = &self.members[..] else { return };
                by_share(&mut sample[radius], &|share| self.radius_in_ball(share));
                // Heights are even on a sphere.
                sample[elevation] = 1.0 - math::acos(sample[elevation].clamp(-1.0, 1.0)) / (0.5 * PI);
            }
        }
    }

    /// The radius below which a share lies, in units of the zone's.
    fn radius_in_disc(&self, share: f64) -> f64 {
        match self.law {
            ZoneLaw::Uniform => share.sqrt(),
            ZoneLaw::RadialNormal => {
                let inside = 1.0 - math::exp(-0.5 * EDGE * EDGE);
                (-2.0 * math::ln_1p(-share * inside)).sqrt() / EDGE
            }
        }
    }

    fn radius_in_ball(&self, share: f64) -> f64 {
        if self.law == ZoneLaw::Uniform {
            return math::cbrt(share);
        }
        // Maxwell's distribution.
        let below = |r: f64| 1.0 - math::erfc(r / SQRT_2) - (2.0 / PI).sqrt() * r * math::exp(-0.5 * r * r);
        let wanted = share * below(EDGE);
        let (mut least, mut most) = (0.0, EDGE);
        for _ in 0..TUNING.halvings {
            let middle = 0.5 * (least + most);
            if below(middle) < wanted { least = middle } else { most = middle }
        }
        0.5 * (least + most) / EDGE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For a uniform law in the disc r² is uniform, in the ball r³; radii of normal laws have the moments of Rayleigh's
    /// distribution, of which little is cut off.
    #[test]
    fn radii_have_their_laws() {
        let of = |law| LawInZone { members: Vec::new(), shape: ZoneShape::Discs, law };
        assert!((of(ZoneLaw::Uniform).radius_in_disc(0.25) - 0.5).abs() < 1e-15);
        assert!((of(ZoneLaw::Uniform).radius_in_ball(0.125) - 0.5).abs() < 1e-15);
        let normal = of(ZoneLaw::RadialNormal);
        let mean = |radius: &dyn Fn(f64) -> f64| -> f64 {
            (0..10_000).map(|index| radius((f64::from(index) + 0.5) / 1e4).powi(2)).sum::<f64>() / 1e4
        };
        // E r² = 2 - EDGE² e/(1 - e) with e = exp(-EDGE²/2), in σ².
        let outside = math::exp(-0.5 * EDGE * EDGE);
        let wanted = (2.0 - EDGE * EDGE * outside / (1.0 - outside)) / (EDGE * EDGE);
        assert!((mean(&|share| normal.radius_in_disc(share)) - wanted).abs() < 1e-4);
        assert!((normal.radius_in_ball(1.0) - 1.0).abs() < 1e-12 && normal.radius_in_ball(0.0).abs() < 1e-5);
    }
}
