//! Margins of all requirements of a model, and its reduced outputs, each of the subsystem that has it.

use std::borrow::Cow;

use super::kept::KeptReduced;
use crate::numerics::{PointSet, Points};

/// Stored surrogates of a subsystem, with indices from its numbers to the model's.
#[derive(Clone)]
pub struct MarginsOfPart<'k> {
    /// Surrogates of the subsystem.
    pub kept: Cow<'k, KeptReduced>,
    /// Numbers of its parameters in the model.
    pub parameters: &'k [usize],
    /// Numbers of its reduced outputs in the model.
    pub reduced: &'k [usize],
    /// Numbers of its requirements in the model.
    pub requirements: Cow<'k, [usize]>,
}

impl MarginsOfPart<'_> {
    /// Samples of the model's box as those of the subsystem's.
    fn own(&self, samples: Points) -> PointSet {
        samples.coordinates(self.parameters)
    }
}

/// All reduced outputs as functions of all uncertain parameters.
pub struct ReducedValues<'k> {
    parts: Vec<MarginsOfPart<'k>>,
    /// By reduced output: its part, and its number there.
    indices: Vec<(usize, usize)>,
}

impl<'k> ReducedValues<'k> {
    /// All `count` reduced outputs, from these parts; `None` if one is of none.
    pub fn of(parts: Vec<MarginsOfPart<'k>>, count: usize) -> Option<Self> {
        let index = |number: usize| {
            let own = |part: &MarginsOfPart| part.reduced.iter().position(|&own| own == number);
            parts.iter().enumerate().find_map(|(part, of)| Some((part, own(of)?)))
        };
        let indices = (0..count).map(index).collect::<Option<Vec<_>>>()?;
        Some(Self { parts, indices })
    }

    /// Error of a value anywhere in the box; unknown if it cannot be relied on.
    pub fn error(&self, number: usize) -> f64 {
        let (part, own) = self.indices[number];
        self.parts[part].kept.value_error(own)
    }

    /// The part of it that the steps leave.
    pub fn time_error(&self, number: usize) -> f64 {
        let (part, own) = self.indices[number];
        self.parts[part].kept.time_error(own..own + 1)
    }

    /// Values at samples of the model's box, one after the other; NaN if one is unknown.
    pub fn values(&self, samples: Points) -> Vec<Vec<f64>> {
        let found: Vec<Vec<f64>> =
            self.parts.iter().map(|part| part.kept.values(part.reduced.len(), part.own(samples).points())).collect();
        let of = |&(part, own): &(usize, usize)| found[part][own * samples.len()..][..samples.len()].to_vec();
        self.indices.iter().map(of).collect()
    }
}

/// Margins of all requirements as functions of all uncertain parameters.
pub struct Margins<'k> {
    parts: Vec<MarginsOfPart<'k>>,
    /// By requirement: its part, and its number there.
    indices: Vec<(usize, usize)>,
}

impl<'k> Margins<'k> {
    /// Margins of these parts; `None` if a requirement has none.
    pub fn of(parts: Vec<MarginsOfPart<'k>>) -> Option<Self> {
        let count = parts.iter().map(|part| part.requirements.len()).sum();
        let index = |requirement: usize| {
            let own = |part: &MarginsOfPart| part.requirements.iter().position(|&own| own == requirement);
            parts.iter().enumerate().find_map(|(number, part)| Some((number, own(part)?)))
        };
        let indices = (0..count).map(index).collect::<Option<Vec<_>>>()?;
        Some(Self { parts, indices })
    }

    /// Margins of some requirements alone, numbered in this order; no other is evaluated.
    pub fn only(&self, requirements: &[usize]) -> Self {
        let mut of_parts = vec![Vec::new(); self.parts.len()];
        let place = |&requirement: &usize| {
            let (part, own) = self.indices[requirement];
            of_parts[part].push(own);
            (part, of_parts[part].len() - 1)
        };
        let indices = requirements.iter().map(place).collect();
        let of_part = |(part, own): (&MarginsOfPart<'k>, &Vec<usize>)| MarginsOfPart {
            kept: Cow::Owned(part.kept.only(own)),
            requirements: own.iter().map(|&own| part.requirements[own]).collect(),
            ..*part
        };
        Self { parts: self.parts.iter().zip(&of_parts).map(of_part).collect(), indices }
    }

    /// Number of requirements.
    pub fn count(&self) -> usize {
        self.indices.len()
    }

    /// Error of a margin anywhere in the box; unknown if it cannot be relied on.
    pub fn error(&self, requirement: usize) -> f64 {
        let (part, own) = self.indices[requirement];
        self.parts[part].kept.error(own)
    }

    /// The part of it that a better surrogate would not have.
    pub fn surrogate_error(&self, requirement: usize) -> f64 {
        let (part, own) = self.indices[requirement];
        self.parts[part].kept.surrogate_error(own)
    }

    /// The part of it that the steps leave.
    pub fn time_error(&self, requirement: usize) -> f64 {
        let (part, own) = self.indices[requirement];
        let kept = &self.parts[part].kept;
        kept.time_error(kept.values.parts(own))
    }

    /// Margins at samples of the model's box, requirement by requirement, sample by sample; NaN if one is unknown.
    pub fn values(&self, samples: Points) -> Vec<f64> {
        let of_part = |part: &MarginsOfPart| part.kept.margins(part.requirements.len(), part.own(samples).points());
        let found: Vec<Vec<f64>> = self.parts.iter().map(of_part).collect();
        let of = |&(part, own): &(usize, usize)| &found[part][own * samples.len()..][..samples.len()];
        self.indices.iter().flat_map(of).copied().collect()
    }
}
