//! The samples in each part of the box.

use super::basis::{End, Level};
use super::tuning::TUNING;
use crate::numerics::CutMotions;

/// Samples with their motions.
pub(super) struct Samples {
    pub xi: Vec<Vec<f64>>,
    pub motions: CutMotions,
}

/// A part of the box: that of a word, or a layer of it.
#[derive(Clone)]
pub(super) struct WordPart {
    pub word: usize,
    limits: Vec<Limit>,
}

/// A side of a boundary, or of a surface parallel to it.
#[derive(Clone, Copy)]
struct Limit {
    boundary: usize,
    sign: f64,
    offset: f64,
}

impl Samples {
    /// The surfaces between words, estimated from the samples.
    pub fn levels(&self) -> Vec<Option<Level>> {
        let of = |values: &Vec<f64>| {
            let all = self.xi.iter().map(Vec::as_slice).zip(values.iter().copied());
            Level::through(&all.filter(|(_, margin)| margin.is_finite()).collect::<Vec<_>>())
        };
        self.motions.boundaries.iter().map(|boundary| of(&boundary.values)).collect()
    }

    /// Indices, among the samples of its word, of those in a part.
    pub fn places(&self, part: &WordPart, levels: &[Option<Level>]) -> Vec<usize> {
        // A sample's word determines its side of a boundary.
        let layers =
            WordPart { limits: part.limits.iter().filter(|limit| limit.offset != 0.0).copied().collect(), ..*part };
        let ends = layers.ends(levels);
        let own = self.motions.words[part.word].samples.iter().enumerate();
        own.filter(|(_, sample)| ends.iter().all(|end| end.margin(&self.xi[**sample]) >= 0.0))
            .map(|(index, _)| index)
            .collect()
    }
}

impl WordPart {
    /// All of a word's.
    pub fn of_word(word: usize, motions: &CutMotions) -> Self {
        let of = |(boundary, margins): (usize, &crate::numerics::BoundaryMargins)| {
            let sign = match () {
                () if margins.met.contains(&word) => -1.0,
                () if margins.missed.contains(&word) => 1.0,
                () => return None,
            };
            Some(Limit { boundary, sign, offset: 0.0 })
        };
        Self { word, limits: motions.boundaries.iter().enumerate().filter_map(of).collect() }
    }

    pub fn ends(&self, levels: &[Option<Level>]) -> Vec<End> {
        let of =
            |&Limit { boundary, sign, offset }: &Limit| Some(End { level: levels[boundary].clone()?, sign, offset });
        self.limits.iter().filter_map(of).collect()
    }

    /// Levels of the surfaces behind which the part is.
    pub fn depths(&self, levels: &[Option<Level>]) -> Vec<Level> {
        let own = self.limits.iter().filter(|limit| limit.sign < 0.0);
        own.filter_map(|limit| levels[limit.boundary].clone()).collect()
    }

    /// The layer next to the first surface that it is behind, and the rest; `None` if it touches none.
    pub fn layers(&self, levels: &[Option<Level>], xi: &[Vec<f64>]) -> Option<[Self; 2]> {
        let touches = |limit: &&Limit| limit.sign < 0.0 && limit.offset == 0.0;
        let boundary = self.limits.iter().find(touches)?.boundary;
        let level = levels[boundary].as_ref()?;
        let depth = TUNING.layer * xi.iter().map(|xi| -level.at(xi)).fold(0.0, f64::max);
        if depth <= level.error() {
            return None;
        }
        // Above the depth, and below it.
        let above = Limit { boundary, sign: 1.0, offset: -depth };
        let below = Limit { boundary, sign: -1.0, offset: depth };
        let mut layer = self.clone();
        layer.limits.retain(|limit| limit.boundary != boundary || limit.offset == 0.0);
        layer.limits.push(above);
        let mut rest = self.clone();
        rest.limits.retain(|limit| limit.boundary != boundary || limit.offset != 0.0);
        rest.limits.push(below);
        Some([layer, rest])
    }
}
