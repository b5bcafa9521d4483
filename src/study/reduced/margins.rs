//! Margins of all requirements of a model, each of the subsystem that has it.

use super::kept::KeptReduced;

/// What a subsystem kept, the numbers of its parameters, and those of its requirements in the model.
#[derive(Clone, Copy)]
pub struct MarginsOfPart<'k> {
    pub kept: &'k KeptReduced,
    pub parameters: &'k [usize],
    pub requirements: &'k [usize],
}

/// Margins of all requirements as functions of all uncertain parameters.
pub struct Margins<'k> {
    parts: Vec<MarginsOfPart<'k>>,
    /// By requirement: its part, and its number there.
    places: Vec<(usize, usize)>,
}

impl<'k> Margins<'k> {
    /// Of these parts; `None` where a requirement has none.
    pub fn of(parts: Vec<MarginsOfPart<'k>>) -> Option<Self> {
        let count = parts.iter().map(|part| part.requirements.len()).sum();
        let place = |requirement: usize| {
            let own = |part: &MarginsOfPart| part.requirements.iter().position(|&own| own == requirement);
            parts.iter().enumerate().find_map(|(number, part)| Some((number, own(part)?)))
        };
        let places = (0..count).map(place).collect::<Option<Vec<_>>>()?;
        Some(Self { parts, places })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.places.len()
    }

    /// How far a margin may be from the truth anywhere in the box; unknown where it cannot be relied on.
    pub fn error(&self, requirement: usize) -> f64 {
        let (part, own) = self.places[requirement];
        self.parts[part].kept.error(own)
    }

    /// The part of it that a better surrogate would not have.
    pub fn surrogate_error(&self, requirement: usize) -> f64 {
        let (part, own) = self.places[requirement];
        self.parts[part].kept.surrogate_error(own)
    }

    /// Margins at samples of the model's box, requirement by requirement, sample by sample; NaN where one is unknown.
    pub fn values<P: AsRef<[f64]> + Sync>(&self, samples: &[P]) -> Vec<f64> {
        let of_part = |part: &MarginsOfPart| {
            let pick = |sample: &P| part.parameters.iter().map(|&place| sample.as_ref()[place]).collect();
            let own: Vec<Vec<f64>> = samples.iter().map(pick).collect();
            part.kept.margins(part.requirements.len(), &own)
        };
        let found: Vec<Vec<f64>> = self.parts.iter().map(of_part).collect();
        let of = |&(part, own): &(usize, usize)| &found[part][own * samples.len()..][..samples.len()];
        self.places.iter().flat_map(of).copied().collect()
    }
}
