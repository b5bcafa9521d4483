//! Instants of events that only a part of the box has: bounds over that part.
//!
//! Where an event is just grazed, its instant goes with the root of the distance to that surface, whose margin is the
//! height of the hump that does not reach. So samples are divided by the events of their motions, and by the hump
//! in which the event occurs; each part has polynomials of its own, with roots.

use std::collections::BTreeSet;
use std::ops::Range as Rows;

use symdiff::jet::JetSpace;
use symdiff::taylor_model::ModelSpace;

use super::ensemble::ReducedEnsemble;
use super::tuning::TUNING;
use super::values::Humps;
use crate::methods::{
    self, EnclosedRow, EnclosureEnd, Ensemble, EnsembleError, Method, Proof, Sampling, Simulated, Validation,
    number_as_motion, range_in_part,
};
use crate::numerics::{
    BandError, BoundaryMargins, CutMotions, EMPTY, ParameterBox, Range, Sample, time_error_certified,
};
use crate::results::ReducedSummary;

/// Bounds of an instant over the part of the box that has one.
#[derive(Clone, Copy, Debug)]
pub struct InPart {
    /// s
    pub range: Range,
    /// Errors of the polynomials, and of the steps, s.
    pub surrogate: f64,
    pub time: f64,
    /// Share of the box that is this part, at least and at most.
    pub share: [f64; 2],
}

impl InPart {
    /// A summary with these bounds by the method that expands; widened to the values of samples.
    pub fn bounding(self, mut summary: ReducedSummary, tolerance: Option<f64>, is_unreliable: bool) -> ReducedSummary {
        let seen =
            summary.worst.as_ref().map_or(EMPTY, |[least, most]| Range { lower: least.value, upper: most.value });
        let range = self.range.with(seen);
        let mut error = BandError::new(&[range], &[self.surrogate], &[self.time], range.width(), tolerance);
        let contradicted = error.contradicted(&[self.range], &[seen]);
        for band in summary.bands.iter_mut().filter(|band| band.method == Method::Chebyshev.name()) {
            (band.lower, band.upper, band.error) = (range.lower, range.upper, error.total[0]);
            (band.surrogate, band.time) = (error.surrogate, error.time);
            band.unresolved = error.unresolved[0] || contradicted[0] || is_unreliable;
        }
        summary.occurs.iter_mut().for_each(|occurs| occurs.share = Some(self.share));
        summary
    }
}

/// The word of a sample's motion, and the segment or the window in which the event occurs, if it does.
type Kind = (usize, Option<usize>);

/// An instant as the output of an ensemble of one row.
struct Instants<'a> {
    values: &'a ReducedEnsemble<'a>,
    value: usize,
    humps: &'a Humps,
    /// Whether motions are cut at events.
    is_cut: bool,
    /// The parts; those of one word in the order in which the event is searched for, the part without it last.
    kinds: Vec<Kind>,
    /// Words whose motions end a segment with the event, and that segment: the instant is theirs, to rounding.
    ended: Vec<(usize, usize)>,
    /// Words without the event, and the height of a hump that only grazes it, within the error of heights.
    never: Vec<usize>,
    grazed: f64,
}

/// Samples with their events.
#[derive(Default)]
struct Found {
    /// s; NaN if the event does not occur.
    instants: Vec<f64>,
    /// `None` for samples whose part cannot be determined.
    kinds: Vec<Option<Kind>>,
    /// Whether the instant is the end of a segment of the motion.
    ends: Vec<bool>,
    /// The heights of humps by sample.
    heights: Vec<Vec<f64>>,
    /// Surfaces between the words of motions that are cut.
    boundaries: Vec<BoundaryMargins>,
}

/// Bounds of a value that is the instant of an event, over the part of the box in which it occurs, by motions and by
/// motions with halved steps. `None` if it is no instant, if all samples have it or none has, and if its parts cannot
/// be determined.
///
/// # Errors
/// If a sample cannot be assembled.
pub fn in_part(
    value: usize,
    values: [&ReducedEnsemble; 2],
    is_cut: bool,
    validation: &Validation,
    degree: usize,
) -> Result<Option<InPart>, EnsembleError> {
    let all = validation.direct.at(0, value);
    if all.iter().all(|instant| instant.is_nan()) || !all.iter().any(|instant| instant.is_nan()) {
        return Ok(None);
    }
    let range = |values| match Instants::new(values, value, is_cut, &validation.points)? {
        Some(instants) => range_in_part(&instants, degree, validation),
        None => Ok(None),
    };
    let [direct, halved] = values;
    let Some((range, halved)) = range(direct)?.zip(range(halved)?) else { return Ok(None) };
    let time = time_error_certified(range.range, halved.range);
    let share = [range.share[0].min(halved.share[0]), range.share[1].max(halved.share[1])];
    Ok(Some(InPart { range: range.range, surrogate: range.error, time, share }))
}

impl<'a> Instants<'a> {
    /// `None` if the parts of these ξ cannot be determined, or are too many.
    fn new(
        values: &'a ReducedEnsemble<'a>,
        value: usize,
        is_cut: bool,
        xi: &[Vec<f64>],
    ) -> Result<Option<Self>, EnsembleError> {
        let Some((humps, is_last)) = values.plan().values.event(value) else { return Ok(None) };
        let mut own =
            Self { values, value, humps, is_cut, kinds: Vec::new(), ended: Vec::new(), never: Vec::new(), grazed: 0.0 };
        let Some(found) = own.found(&values.domain().samples(xi))? else { return Ok(None) };
        let kinds: Option<BTreeSet<Kind>> = found.kinds.iter().copied().collect();
        let sign = if is_last { -1 } else { 1 };
        let order = |&(word, place): &Kind| (word, place.map_or(i64::MAX, |place| sign * place as i64));
        own.kinds = kinds.unwrap_or_default().into_iter().collect();
        own.kinds.sort_by_key(order);
        // Beside an event the instant has a kink.
        let moves = |pair: &[Kind]| is_cut && pair[0].0 == pair[1].0 && pair[1].1.is_some();
        let all_end = |kind: &Kind| found.kinds.iter().zip(&found.ends).all(|(own, ends)| *ends || *own != Some(*kind));
        let is_alone = |kind: &Kind| own.kinds.iter().filter(|other| other.0 == kind.0).count() == 1;
        let ended = own.kinds.iter().filter(|kind| is_cut && is_alone(kind) && all_end(kind));
        let ended: Vec<Kind> = ended.copied().collect();
        own.ended = ended.iter().filter_map(|&(word, segment)| Some((word, segment?))).collect();
        let never = own.kinds.iter().filter(|kind| is_cut && kind.1.is_none() && is_alone(kind));
        own.never = never.map(|kind| kind.0).collect();
        own.grazed = TUNING.grazed_height * Range::of(&found.heights.concat()).width();
        let is_known =
            !own.kinds.is_empty() && own.kinds.len() <= TUNING.most_occurring_parts && !own.kinds.windows(2).any(moves);
        Ok(is_known.then_some(own))
    }

    /// The events of samples; `None` if their motions cannot be cut.
    fn found(&self, samples: &[Sample]) -> Result<Option<Found>, EnsembleError> {
        let (channels, _) = self.values.channels(samples, false)?;
        let mut words = vec![if self.is_cut { None } else { Some((0, Vec::new())) }; samples.len()];
        let mut found = Found::default();
        if self.is_cut {
            let Some(motions) = self.values.cut(samples)? else { return Ok(None) };
            for (number, word) in motions.words.iter().enumerate() {
                for (index, &sample) in word.samples.iter().enumerate() {
                    words[sample] = Some((number, word.times[1..].iter().map(|ends| ends[index]).collect()));
                }
            }
            found.boundaries = motions.boundaries;
        }
        let mut values = Vec::new();
        for ((sample, channels), word) in samples.iter().zip(channels).zip(words) {
            self.values.plan().values.evaluate(&channels, sample, &mut values);
            let heights: Vec<f64> = self.humps.heights.iter().map(|&height| channels[height]).collect();
            let known = word.filter(|_| channels.iter().all(|own| own.is_finite()));
            let (instant, kind, ends) = match known {
                Some((word, ends)) => self.event(word, &ends, values[self.value], &channels, &heights),
                None => (f64::NAN, None, false),
            };
            found.instants.push(instant);
            found.kinds.push(kind);
            found.ends.push(ends);
            found.heights.push(heights);
        }
        Ok(Some(found))
    }

    /// The instant of a sample, its part and whether it ends a segment, given the word, the ends of its segments, and
    /// the instant according to the channels. An instant at the end of the time in which the event is searched for has
    /// a kink there.
    fn event(
        &self,
        word: usize,
        ends: &[f64],
        instant: f64,
        channels: &[f64],
        heights: &[f64],
    ) -> (f64, Option<Kind>, bool) {
        if let Some(&(_, segment)) = self.ended.iter().find(|ended| ended.0 == word) {
            return (ends[segment], Some((word, Some(segment))), true);
        }
        let grazes = heights.iter().all(|height| *height <= self.grazed);
        if instant.is_nan() || grazes && self.never.contains(&word) {
            return (f64::NAN, Some((word, None)), false);
        }
        let end = self.values.time(0);
        let near = TUNING.at_event * end;
        let [first, last] = self.values.plan().span(self.humps.times.iter().copied());
        if instant <= first + near || instant >= last.min(end) - near {
            return (instant, None, false);
        }
        let window = self.humps.times.iter().position(|&time| channels[time] == instant);
        let segment = ends.iter().take_while(|&&end| end < instant - near).count();
        let place = if self.is_cut { Some(segment) } else { window };
        let is_end = ends.get(segment).is_some_and(|end| (end - instant).abs() <= near);
        (instant, place.map(|place| (word, Some(place))), is_end)
    }

    /// Margins by which samples miss the event: between a part and all those of its word behind it.
    fn margins(&self, found: &Found) -> Vec<BoundaryMargins> {
        let own = (0..self.kinds.len()).filter_map(|part| {
            let (word, place) = self.kinds[part];
            let missed: Vec<usize> =
                (part + 1..self.kinds.len()).filter(|&other| self.kinds[other].0 == word).collect();
            let place = place.filter(|_| !missed.is_empty())?;
            let margin = |(kind, heights): (&Option<Kind>, &Vec<f64>)| {
                let number = kind.and_then(|kind| self.kinds.iter().position(|own| *own == kind));
                let is_own = number.is_some_and(|number| number == part || missed.contains(&number));
                let height = if self.is_cut {
                    heights.iter().copied().fold(f64::NEG_INFINITY, f64::max)
                } else {
                    heights[place]
                };
                if is_own { -height } else { f64::NAN }
            };
            let values = found.kinds.iter().zip(&found.heights).map(margin).collect();
            Some(BoundaryMargins { met: vec![part], missed, values })
        });
        let of_words = |words: &[usize]| -> Vec<usize> {
            (0..self.kinds.len()).filter(|&part| words.contains(&self.kinds[part].0)).collect()
        };
        let between_words = found.boundaries.iter().map(|boundary| BoundaryMargins {
            met: of_words(&boundary.met),
            missed: of_words(&boundary.missed),
            values: boundary.values.clone(),
        });
        own.chain(between_words).collect()
    }
}

impl Ensemble for Instants<'_> {
    fn domain(&self) -> &ParameterBox {
        self.values.domain()
    }

    fn outputs(&self) -> usize {
        1
    }

    fn rows(&self) -> usize {
        1
    }

    fn time(&self, row: usize) -> f64 {
        self.values.time(row)
    }

    fn rounding(&self, _: usize) -> f64 {
        0.0
    }

    fn has_kink(&self, _: usize) -> bool {
        false
    }

    fn jumps(&self, _: usize) -> bool {
        false
    }

    fn is_interrupted(&self) -> bool {
        self.values.is_interrupted()
    }

    /// One word for each part, whose motions are the instants.
    fn segments(&self, samples: &[Sample]) -> Result<Option<CutMotions>, EnsembleError> {
        let Some(found) = self.found(samples)? else { return Ok(None) };
        let of_part = |kind: &Kind| {
            let own: Vec<usize> = (0..samples.len()).filter(|&sample| found.kinds[sample] == Some(*kind)).collect();
            let instants: Vec<f64> = own.iter().map(|&sample| found.instants[sample]).collect();
            number_as_motion(own, kind.1.map(|_| instants.as_slice()))
        };
        let is_known = |kind: &Option<Kind>| kind.is_some_and(|kind| self.kinds.contains(&kind));
        let known_to = if found.kinds.iter().all(is_known) { f64::INFINITY } else { 0.0 };
        let words = self.kinds.iter().map(of_part).collect();
        Ok(Some(CutMotions { words, boundaries: self.margins(&found), known_to }))
    }

    fn simulate(
        &self,
        samples: &[Sample],
        sampling: Sampling,
        reduce: &mut dyn FnMut(Rows<usize>, &[f64]),
    ) -> Result<Simulated, EnsembleError> {
        self.values.simulate(samples, sampling, reduce)
    }

    fn jets(&self, space: &JetSpace, reduce: &mut dyn FnMut(Rows<usize>, &[f64])) -> Result<Simulated, EnsembleError> {
        self.values.jets(space, reduce)
    }

    fn obstacle_to_enclosure(&self, proof: Proof) -> Option<String> {
        self.values.obstacle_to_enclosure(proof)
    }

    fn enclose(&self, proof: Proof, space: &ModelSpace, piece: &ParameterBox, row: &mut EnclosedRow) -> EnclosureEnd {
        self.values.enclose(proof, space, piece, row)
    }

    fn scales(&self) -> &[f64] {
        &[]
    }

    fn independent(&self, _: &[f64], _: &[f64], _: f64) -> Vec<usize> {
        Vec::new()
    }

    fn closure(&self, independent: Vec<usize>) -> Result<Box<dyn methods::Closure + '_>, EnsembleError> {
        self.values.closure(independent)
    }
}
