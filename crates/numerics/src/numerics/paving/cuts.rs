//! A box of which one quantity decides, cut by planes: at least and at most this part of it belongs to the set.

use super::Tubes;
use super::parts::{PavingBox, Shape};
use super::tuning::TUNING;

/// The part of a box where normal · u ≤ inner belongs to the set, that where normal · u > outer does not;
/// u ∈ [0, 1]^k are the shares of the box's edges.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cut {
    pub normal: Vec<f64>,
    pub inner: f64,
    pub outer: f64,
}

impl Cut {
    /// Nothing is known of the box.
    fn none(k: usize) -> Self {
        Self { normal: vec![0.0; k], inner: -1.0, outer: 1.0 }
    }

    /// Cut of a box in which one end of one quantity's interval is undecided; of any other box nothing is known.
    pub fn of(part: &PavingBox, shape: &Shape, tubes: &Tubes) -> Self {
        let k = shape.dimension();
        let &[row] = part.rows.as_slice() else { return Self::none(k) };
        let (outer, inner) = (tubes.outer[row as usize], tubes.inner[row as usize]);
        let Some((_, range)) = part.ranges(shape).next() else { return Self::none(k) };
        let is_lower_met = range.lower >= inner[0];
        let is_upper_met = range.upper <= inner[1];
        let (mut linear, error) = part.linear(shape);
        let constant = linear.pop().unwrap_or(0.0);
        match (is_lower_met, is_upper_met) {
            (true, false) => {
                Self { normal: linear, inner: inner[1] - error - constant, outer: outer[1] + error - constant }
            }
            (false, true) => Self {
                normal: linear.into_iter().map(|own| -own).collect(),
                inner: constant - error - inner[0],
                outer: constant + error - outer[0],
            },
            _ => Self::none(k),
        }
    }

    /// Shares of the box that belong to the set at least and at most.
    pub fn shares(&self) -> [f64; 2] {
        let most = self.normal.iter().fold(0.0_f64, |most, own| most.max(own.abs()));
        let steep: Vec<f64> = self.normal.iter().copied().filter(|own| own.abs() > TUNING.flat * most).collect();
        let flat = self.normal.iter().filter(|own| own.abs() <= TUNING.flat * most);
        // The most that flat axes may take away from, or add to, the others.
        let (away, beyond) = flat.fold((0.0, 0.0), |sum, own| (sum.0 + own.max(0.0), sum.1 + own.min(0.0)));
        [share_below(&steep, self.inner - away), share_below(&steep, self.outer - beyond)]
    }
}

/// Volume of the part of [0, 1]^k in which normal · u ≤ level; all components differ from zero.
fn share_below(normal: &[f64], level: f64) -> f64 {
    // With u → 1 − u where a component is negative.
    let level = level - normal.iter().map(|own| own.min(0.0)).sum::<f64>();
    let all: f64 = normal.iter().map(|own| own.abs()).sum();
    if level < 0.0 || level >= all {
        return f64::from(level >= all);
    }
    let corner = |choice: usize| {
        let chosen = |axis: &usize| choice >> axis & 1 == 1;
        let reached: f64 = (0..normal.len()).filter(chosen).map(|axis| normal[axis].abs()).sum();
        let sign = if choice.count_ones().is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * (level - reached).max(0.0).powi(normal.len() as i32)
    };
    let volume: f64 = (0..1_usize << normal.len()).map(corner).sum();
    let scale: f64 = normal.iter().enumerate().map(|(axis, own)| (axis + 1) as f64 * own.abs()).product();
    (volume / scale).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volumes_below_planes_match_simplices() {
        // x + y ≤ 1/2: 1/8; x + y + z ≤ 1: 1/6; x ≥ 3/4: 1/4; x − y ≤ 0: 1/2.
        let cases = [
            (vec![1.0, 1.0], 0.5, 0.125),
            (vec![1.0, 1.0, 1.0], 1.0, 1.0 / 6.0),
            (vec![-2.0], -1.5, 0.25),
            (vec![1.0, -1.0], 0.0, 0.5),
            (vec![1.0, 2.0], 3.0, 1.0),
            (vec![], -1.0, 0.0),
        ];
        for (normal, level, volume) in cases {
            assert!((share_below(&normal, level) - volume).abs() < 1e-14, "{normal:?}");
        }
    }
}
