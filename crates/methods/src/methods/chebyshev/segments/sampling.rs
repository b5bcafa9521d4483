//! Samples that fits in the parts of a box need: enough of them, some next to surfaces, and none far outside of the
//! others.

use super::basis::{End, Fitted};
use super::fitting::Fitting;
use super::parts::WordPart;
use super::piece::Piece;
use super::tuning::TUNING;
use crate::numerics::{Range, corners, largest, spread};

impl Fitting<'_> {
    /// Points of a part that are far outside of its samples, the farthest first: a fit may have any value there.
    pub(super) fn uncovered(&self, part: &WordPart, piece: &Piece) -> Vec<Vec<f64>> {
        let k = self.samples.xi.first().map_or(0, Vec::len);
        let surrogate = &piece.surrogate;
        let margin = |xi: &Vec<f64>| surrogate.ends.iter().map(|end| end.margin(xi)).fold(f64::INFINITY, f64::min);
        let is_own = |sample: &usize| self.samples.motions.words[part.word].samples.contains(sample);
        let others: Vec<&Vec<f64>> = (0..self.samples.xi.len())
            .filter(|sample| !is_own(sample))
            .map(|sample| &self.samples.xi[sample])
            .collect();
        let of_box = [corners(k, TUNING.corners), spread(k, TUNING.candidates)].concat();
        let inside: Vec<Vec<f64>> = of_box.iter().filter(|xi| margin(xi) >= 0.0).cloned().collect();
        let outside: Vec<&Vec<f64>> = of_box.iter().filter(|xi| margin(xi) < 0.0).chain(others).collect();
        let from: Vec<&Vec<f64>> =
            if inside.is_empty() { piece.samples.iter().collect() } else { inside.iter().collect() };
        let inside_of = TUNING.inside_surface * from.iter().map(|xi| margin(xi)).fold(0.0, f64::max);
        let ends = across(&from, &outside, TUNING.candidates / 4, margin, |_| inside_of);
        let mut all: Vec<Vec<f64>> = inside.iter().cloned().chain(ends).filter(|xi| margin(xi) >= 0.0).collect();
        let mut found = Vec::new();
        while found.len() < TUNING.covering {
            let leverage = |xi: &Vec<f64>| surrogate.leverage(xi);
            let Some((worst, xi)) = all
                .iter()
                .map(|xi| (leverage(xi), xi.clone()))
                .max_by(|a, b| a.0.total_cmp(&b.0))
                .filter(|(worst, xi)| *worst > TUNING.far_outside && !self.samples.xi.contains(xi))
            else {
                break;
            };
            // Points near it are covered with it.
            all.retain(|other| leverage(other) < 0.5 * worst || distance(other, &xi) > TUNING.covering_apart);
            all.retain(|other| *other != xi);
            found.push(xi);
        }
        found
    }

    /// Points just behind surfaces on which an event is grazed: a contact that is entered slowly ends otherwise than a
    /// faster one, and polynomials through samples that are farther behind predict the faster one's end.
    pub(super) fn grazing(&self, parts: &[WordPart]) -> Vec<Vec<f64>> {
        let levels = self.samples.levels();
        let xi = &self.samples.xi;
        let k = xi.first().map_or(0, Vec::len);
        // With one parameter the surface is a point: copies of a sample would hide its error.
        let count = 1 + TUNING.grazing_samples * k.saturating_sub(1);
        let of_part = |part: &WordPart| {
            let ends = part.ends(&levels);
            let words = &self.samples.motions.words;
            let own: Vec<&Vec<f64>> = words[part.word].samples.iter().map(|&own| &xi[own]).collect();
            let of_end = |end: &End| {
                let margin = |point: &Vec<f64>| end.margin(point);
                let depth = own.iter().map(|point| margin(point)).fold(0.0, f64::max);
                let others: Vec<&Vec<f64>> = xi.iter().filter(|point| margin(point) < 0.0).collect();
                // The last of them as near as the surface is known.
                let nearest = TUNING.beyond_error * end.error();
                let shares = TUNING.grazing_shares.map(|share| share * depth);
                let far = shares.iter().filter(|at| **at > nearest).count();
                let depths = shares.into_iter().take(far + 1).map(|at| at.max(nearest));
                depths.flat_map(|at| across(&own, &others, count, margin, |_| at)).collect::<Vec<_>>()
            };
            let mut found: Vec<Vec<f64>> = ends.iter().filter(|end| end.sign < 0.0).flat_map(of_end).collect();
            found.retain(|point| ends.iter().all(|end| end.margin(point) >= 0.0));
            found
        };
        parts.iter().flat_map(of_part).collect()
    }

    /// Points at which samples are missing.
    pub(super) fn wanted(&self, parts: &[WordPart]) -> Vec<Vec<f64>> {
        let levels = self.samples.levels();
        let xi = &self.samples.xi;
        let k = xi.first().map_or(0, Vec::len);
        let of_box = [corners(k, TUNING.corners), spread(k, TUNING.candidates + xi.len()).split_off(xi.len())].concat();
        let mut wanted: Vec<Vec<f64>> = Vec::new();
        for part in parts {
            let (ends, depths) = (part.ends(&levels), part.depths(&levels));
            let own = &self.samples.motions.words[part.word].samples;
            let inside: Vec<&Vec<f64>> =
                self.samples.places(part, &levels).iter().map(|&index| &xi[own[index]]).collect();
            let terms = Fitted::new(self.degree, &depths, xi).len();
            let lacks = ((TUNING.samples_a_term * terms as f64) as usize + 2).saturating_sub(inside.len());
            let fits = |point: &Vec<f64>| ends.iter().all(|end| end.margin(point) >= 0.0) && !xi.contains(point);
            // Points near a surface, and those in layers, are on lines across it.
            let is_layer = ends.iter().any(End::is_far);
            let touches = ends.iter().any(|end| end.sign < 0.0 && end.offset == 0.0);
            let beside = if is_layer || touches { lacks } else { lacks / TUNING.beside_surface };
            let of_word: Vec<&Vec<f64>> = own.iter().map(|&sample| &xi[sample]).collect();
            let begins = |end: &&End| end.offset == 0.0 || is_layer && !end.is_far();
            let on_lines = ends.iter().filter(begins).flat_map(|end| {
                let margin = |point: &Vec<f64>| end.margin(point);
                let deepest = of_word.iter().map(|point| margin(point)).fold(0.0, f64::max);
                // A layer ends before.
                let limits = ends.iter().filter(|other| other.is_far()).map(|other| -other.offset - end.offset);
                let depth = limits.fold(deepest, f64::min);
                let others: Vec<&Vec<f64>> = xi.iter().filter(|point| margin(point) < 0.0).collect();
                // Apart by equal roots of the depth behind the surface.
                let [first, last] = [end.offset, end.offset + depth].map(f64::sqrt);
                let at = move |share: f64| (first + share * (last - first)).powi(2) - end.offset;
                across(&of_word, &others, beside, margin, at)
            });
            let mut own: Vec<Vec<f64>> = on_lines.filter(fits).take(beside).collect();
            let others = of_box.iter().filter(|point| fits(point)).cloned();
            own.extend(others.take(lacks - own.len().min(lacks)));
            if own.is_empty() && lacks > 0 && !is_layer {
                // The surface that the samples give excludes the part: there are too few next to it.
                own.extend(about(&of_word, lacks));
            }
            wanted.extend(own);
        }
        wanted.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
        wanted.dedup();
        wanted
    }
}

/// Largest distance along an axis.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    largest(a.iter().zip(b).map(|(a, b)| a - b))
}

/// `count` points spread over a box about some points that is twice as wide as theirs.
fn about(points: &[&Vec<f64>], count: usize) -> Vec<Vec<f64>> {
    let Some(k) = points.first().map(|point| point.len()) else { return Vec::new() };
    let of_axis = |axis: usize| {
        let own = Range::of(&points.iter().map(|point| point[axis]).collect::<Vec<f64>>());
        (0.5 * (own.lower + own.upper), own.width().max(TUNING.covering_apart))
    };
    let axes: Vec<(f64, f64)> = (0..k).map(of_axis).collect();
    let place = |xi: Vec<f64>| -> Vec<f64> {
        xi.iter().zip(&axes).map(|(xi, (middle, wide))| (middle + xi * wide).clamp(-1.0, 1.0)).collect()
    };
    spread(k, count).into_iter().map(place).collect()
}

/// `count` points on lines from points inside of a surface to others beyond it; `wanted` gives the margin of each from
/// its share of the number.
fn across(
    inside: &[&Vec<f64>],
    others: &[&Vec<f64>],
    count: usize,
    margin: impl Fn(&Vec<f64>) -> f64,
    wanted: impl Fn(f64) -> f64,
) -> Vec<Vec<f64>> {
    if inside.is_empty() || others.is_empty() {
        return Vec::new();
    }
    let of = |index: usize| {
        let (from, to) = (inside[index % inside.len()], others[index % others.len()]);
        let wanted = wanted((index as f64 + 0.5) / count as f64);
        let at = |share: f64| from.iter().zip(to).map(|(a, b)| a + share * (b - a)).collect::<Vec<f64>>();
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..TUNING.halvings_of_line {
            let middle = 0.5 * (low + high);
            if margin(&at(middle)) > wanted { low = middle } else { high = middle }
        }
        at(0.5 * (low + high))
    };
    (0..count).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_spread_about_samples_only() {
        assert!(about(&[], 5).is_empty());
        let samples = [vec![0.3, -0.9], vec![0.5, -0.8]];
        let found = about(&samples.iter().collect::<Vec<_>>(), 40);
        assert_eq!(found.len(), 40);
        let wide = TUNING.covering_apart;
        for xi in &found {
            assert!((xi[0] - 0.4).abs() <= wide && (xi[1] + 0.85).abs() <= wide && xi[1] >= -1.0, "{xi:?}");
        }
    }
}
