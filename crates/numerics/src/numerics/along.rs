//! Excursions of a response beyond a sample and its neighbours along an axis.

use super::tuning::TUNING;

/// A sample among those along one axis.
pub(super) struct Along {
    /// Values from four samples before to four after; zero if none is known.
    values: [f64; 9],
    /// Second differences at all of them but the first and the last.
    bends: [f64; 7],
    /// Numbers of known samples before and after, up to four: none beyond the axis' ends, and in another part of the
    /// scan.
    before: usize,
    after: usize,
    /// Its number along the axis,
    at: usize,
    /// and the axis' samples.
    count: usize,
}

impl Along {
    /// The sample `index` of a part's values, which is number `at` of `count` along an axis, with this stride from one
    /// sample of the axis to the next.
    pub fn new(values: &[f64], index: usize, stride: usize, at: usize, count: usize) -> Self {
        let before = at.min(4).min(index / stride);
        let after = (count - 1 - at).min(4).min((values.len() - 1 - index) / stride);
        let mut window = [0.0; 9];
        let known = values[index - stride * before..].iter().step_by(stride);
        window[4 - before..=4 + after].iter_mut().zip(known).for_each(|(into, value)| *into = *value);
        let bends = std::array::from_fn(|left| window[left] - 2.0 * window[left + 1] + window[left + 2]);
        Self { values: window, bends, before, after, at, count }
    }

    /// The value `away` samples further, at most four.
    fn value(&self, away: isize) -> Option<f64> {
        self.is_known(away).then(|| self.values[4_usize.wrapping_add_signed(away)])
    }

    fn is_known(&self, away: isize) -> bool {
        away.unsigned_abs() <= if away < 0 { self.before } else { self.after }
    }

    /// The second difference `away` samples further, less than four.
    fn bend(&self, away: isize) -> Option<f64> {
        let is_known = self.is_known(away - 1) && self.is_known(away + 1);
        is_known.then(|| self.bends[3_usize.wrapping_add_signed(away)])
    }

    /// How far a smooth response may go below and above an inner sample; `None` at the ends.
    pub fn smooth(&self) -> Option<[f64; 2]> {
        let (here, before, after) = (self.value(0)?, self.value(-1)?, self.value(1)?);
        // Three samples do not show how the second difference changes between them.
        let unsure = if self.count == 3 { 1.0 + TUNING.unsure } else { 1.0 };
        let height = unsure * (before - 2.0 * here + after).abs() / 8.0;
        let lowest = here <= before && here <= after;
        let highest = here >= before && here >= after;
        Some([if lowest { height } else { 0.0 }, if highest { height } else { 0.0 }])
    }

    /// How far below and above a sample at the axis' end a response may go that bends back between it and its
    /// neighbour: the parabola through it and the two next to it, as far as that may turn within the uncertainty of its
    /// slope.
    pub fn bending_back(&self) -> [f64; 2] {
        let side = match self.at {
            0 => 1,
            last if last + 1 == self.count => -1,
            _ => return [0.0; 2],
        };
        let (Some(here), Some(there), Some(bend)) = (self.value(0), self.value(side), self.bend(side)) else {
            return [0.0; 2];
        };
        // Differences forwards: Δ − Δ²/2 + Δ³/3.
        let third = self.bend(2 * side).map(|next| next - bend);
        let slope = there - here - bend / 2.0 + third.unwrap_or_default() / 3.0;
        let unsure = third.map_or(f64::INFINITY, |third| third.abs() / 3.0).min(TUNING.unsure * bend.abs());
        // Towards the neighbour it rises if it bends upwards, and falls if it bends downwards.
        let back = unsure - slope * bend.signum();
        let is_end = (there - here) * bend >= 0.0;
        let depth = if is_end && back > 0.0 { 0.5 * bend.abs() * (back / bend.abs()).min(1.0).powi(2) } else { 0.0 };
        if bend > 0.0 { [depth, 0.0] } else { [0.0, depth] }
    }

    /// How far below and above the sample and its neighbour on one side a response that is not smooth between them may
    /// go.
    pub fn irregular(&self, side: isize) -> [f64; 2] {
        let (Some(here), Some(there)) = (self.value(0), self.value(side)) else { return [0.0; 2] };
        let excess = |away: isize, others: [isize; 2]| {
            let bend = self.bend(away)?;
            let expected = others.into_iter().filter_map(|other| self.expected(bend, away, other)).reduce(f64::max)?;
            Some(bend.signum() * (bend.abs() - expected).max(0.0))
        };
        let outer = [-side, 2 * side];
        let excess = [excess(0, outer), excess(side, outer)];
        let share = if excess.contains(&None) { 0.5 } else { 0.25 };
        let [a, b] = excess.map(Option::unwrap_or_default);
        if a * b < 0.0 {
            return [share * (a.abs() + b.abs()); 2];
        }
        let total = share * (a + b);
        // Lines through the pairs on both sides meet at a kink's tip.
        let tip = || {
            let (left, right) = (here - self.value(-side)?, there - self.value(2 * side)?);
            let at = (there + right - here) / (left + right);
            // Within rounding, if the tip is at one of the two samples.
            (-0.01..=1.01).contains(&at).then_some(here + at.clamp(0.0, 1.0) * left)
        };
        let most = |beyond: Option<f64>| beyond.map_or(total.abs(), |beyond| beyond.clamp(0.0, total.abs()));
        if total > 0.0 {
            [most(tip().map(|tip| here.min(there) - tip)), 0.0]
        } else if total < 0.0 {
            [0.0, most(tip().map(|tip| tip - here.max(there)))]
        } else {
            [0.0; 2]
        }
    }

    /// Largest second difference of a smooth response `away` samples from here, expected from those at `outer` and
    /// beyond; of the same sign, since a wave that changes it is too short to resolve.
    fn expected(&self, bend: f64, away: isize, outer: isize) -> Option<f64> {
        let (beside, beyond) = (self.bend(outer)?, self.bend(outer + (outer - away).signum())?);
        let growth = (beside / beyond).abs().clamp(1.0, TUNING.most_growth);
        let growth = if growth.is_nan() { 1.0 } else { growth };
        // One sample, or two.
        let growth = if (outer - away).unsigned_abs() == 1 { growth } else { growth * growth };
        Some(if beside * bend < 0.0 { 0.0 } else { TUNING.growth * beside.abs() * growth })
    }
}
