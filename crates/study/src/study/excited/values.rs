//! Ends of reduced outputs, and of margins of requirements on them, over functions of the time.
//!
//! A reduced output follows from its sources in all rows: its derivatives by these are weights, and the gradient of the
//! weighted sum names the next function, as that of an output in a row does. A peak can go no further than the ends of
//! its source in the rows: these say how much is open.

use super::climb::FunctionClimb;
use super::motions::{ExcitedMotions, WeightedPoint};
use super::point::Point;
use super::tuning::TUNING;
use crate::assemble::NumberFormulas;
use crate::model::ReducedKind;
use crate::numerics::{SAFETY_OF_STEPS, largest, step_error};
use crate::simulate::{Gradient, SimulationError, Term};
use crate::study::bounding::{FunctionEnd, FunctionEnds};
use crate::study::gradient::{InRows, in_rows};
use crate::study::reduced::Store;

/// A value of a motion.
enum Value<'v> {
    /// A reduced output, by its index.
    Reduced(usize),
    /// A slack of a requirement on reduced outputs (by their indices) and parameters.
    Slack { formulas: &'v NumberFormulas, reduced: &'v [usize] },
}

/// A value with its derivatives by outputs in rows and by parameters.
struct Linear {
    value: f64,
    terms: Vec<Term>,
    by_parameters: Vec<f64>,
}

/// The values of a study, and how they follow from outputs.
struct Values<'m, 's, 'd> {
    motions: &'m mut ExcitedMotions<'s, 'd>,
    times: Vec<f64>,
    /// Ends of outputs in rows.
    rows: &'m FunctionEnds,
    /// With their indices among all values of the study.
    all: Vec<(usize, Value<'m>)>,
    /// Outputs that they follow from, ascending.
    sources: Vec<usize>,
}

/// Ends of all values that have derivatives, as outputs of one row.
///
/// # Errors
/// As for gradients.
pub fn ends_of_values(
    motions: &mut ExcitedMotions,
    rows: &FunctionEnds,
    store: &Store,
) -> Result<FunctionEnds, SimulationError> {
    let description = motions.study.description;
    let reduced = (0..description.reduced.len()).map(|index| (index, Value::Reduced(index)));
    let mut all: Vec<(usize, Value)> = reduced.filter(|(index, _)| !description.reduced[*index].of_results).collect();
    for (number, own) in description.requirements.iter().enumerate() {
        if own.times.is_some() || own.of_results {
            continue;
        }
        let slack = |index| Some((index, store.plan.values.slack(index)?));
        let slacks = store.plan.values.parts(number).filter_map(slack);
        all.extend(slacks.map(|(index, (formulas, reduced))| (index, Value::Slack { formulas, reduced })));
    }
    let mut sources: Vec<usize> = description.reduced.iter().flat_map(|own| own.outputs.iter().copied()).collect();
    sources.sort_unstable();
    sources.dedup();
    let found = FunctionEnds::new(1, store.plan.values.count(), motions.inputs());
    let times = (0..motions.schedule.rows).map(|row| motions.schedule.time(row)).collect();
    let mut values = Values { motions, times, rows, all, sources };
    values.search(found)
}

/// The end of a value that a climb goes to.
struct OfValue {
    /// Index in the list of values.
    number: usize,
    climb: FunctionClimb,
}

/// Furthest value that an end can have.
struct Limit {
    value: f64,
    /// Whether some function goes there, but for the errors of the rows.
    is_attained: bool,
}

/// A point to climb from.
struct Start {
    /// The output that goes furthest there; `None` of those for all values.
    of: Option<usize>,
    point: Point,
    /// Whether it may be no function of its class.
    is_guide: bool,
}

impl Values<'_, '_, '_> {
    fn search(&mut self, mut found: FunctionEnds) -> Result<FunctionEnds, SimulationError> {
        let starts = self.starts();
        let mut climbs: Vec<OfValue> = Vec::new();
        for (number, (_, value)) in self.all.iter().enumerate() {
            for sign in [-1.0, 1.0] {
                let climb = |Start { point, is_guide, .. }: &Start| {
                    let begin = if *is_guide { FunctionClimb::guided } else { FunctionClimb::new };
                    OfValue { number, climb: begin(0, number, sign, point.clone()) }
                };
                let own = self.sources_of(value);
                climbs.extend(starts.iter().filter(|start| start.of.is_none_or(|of| own.contains(&of))).map(climb));
            }
        }
        for _ in 0..TUNING.steps_of_climb {
            if !self.step(&mut climbs)? {
                break;
            }
        }
        for of_end in climbs.chunk_by(|a, b| a.number == b.number && a.climb.sign == b.climb.sign) {
            self.note(of_end, &mut found)?;
        }
        Ok(found)
    }

    /// Outputs that a value follows from.
    fn sources_of(&self, value: &Value) -> Vec<usize> {
        let reduced = match value {
            Value::Reduced(index) => std::slice::from_ref(index),
            Value::Slack { reduced, .. } => *reduced,
        };
        let of_reduced = |index: &usize| self.motions.study.description.reduced[*index].outputs.iter().copied();
        reduced.iter().flat_map(of_reduced).collect()
    }

    /// The middle of all limits, both constants, and the functions under which each source goes furthest either way.
    fn starts(&self) -> Vec<Start> {
        let middle = self.motions.middle();
        let classes = self.motions.classes(&middle.xi);
        let constant = |sign: f64| Point {
            xi: middle.xi.clone(),
            functions: classes.iter().map(|class| class.constant(sign, &self.motions.ends)).collect(),
        };
        let for_all = |point: Point| Start { of: None, point, is_guide: false };
        let mut starts: Vec<Start> = [middle.clone(), constant(-1.0), constant(1.0)].map(for_all).into();
        for &output in &self.sources {
            for own in self.rows.extremes[output].iter().flatten() {
                let point = Point { xi: self.motions.study.domain.xi(&own.sample), functions: own.cells.clone() };
                let point = point.later(0.0, &own.ends, &self.motions.ends);
                starts.push(Start { of: Some(output), point, is_guide: own.ends != self.motions.ends });
            }
        }
        starts
    }

    /// The farthest end of an output, upwards by the sign, in rows from a time to another, and its row.
    fn furthest(&self, output: usize, sign: f64, from: f64, to: f64) -> Option<(f64, usize)> {
        let of_row = |row: usize| {
            let range = self.rows.range(row, output);
            (sign * if sign > 0.0 { range.upper } else { range.lower }, row)
        };
        let rows = (0..self.times.len()).filter(|&row| self.times[row] >= from && self.times[row] <= to);
        rows.map(of_row).filter(|(value, _)| value.is_finite()).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Furthest value by the ends of its source in the rows with their errors, upwards by the sign. `None` if these do
    /// not determine it.
    fn limit(&self, value: &Value, sign: f64) -> Option<Limit> {
        let Value::Reduced(index) = value else { return None };
        let own = &self.motions.study.description.reduced[*index];
        let source = *own.outputs.first()?;
        let (from, to) = (own.from, own.to.min(self.motions.study.description.simulation.duration));
        let rows = || (0..self.times.len()).filter(|&row| self.times[row] >= from && self.times[row] <= to);
        let open = || largest(rows().map(|row| self.rows.open(row, source)));
        let furthest = |side: f64| self.furthest(source, side, from, to).map(|(value, _)| value);
        let beyond = match (own.kind, sign > 0.0) {
            (ReducedKind::Max, true) => furthest(1.0)?,
            (ReducedKind::Min, false) => furthest(-1.0)?,
            (ReducedKind::MaxAbs, true) => furthest(1.0)?.max(furthest(-1.0)?),
            (ReducedKind::Range, true) => furthest(1.0)? + furthest(-1.0)?,
            // The least peak is no less than the highest of the lower ends; a size or a distance is not negative.
            (ReducedKind::Max, false) => {
                -rows().map(|row| self.rows.range(row, source).lower).fold(f64::NEG_INFINITY, f64::max)
            }
            (ReducedKind::Min, true) => {
                rows().map(|row| self.rows.range(row, source).upper).fold(f64::INFINITY, f64::min)
            }
            (ReducedKind::MaxAbs | ReducedKind::Range | ReducedKind::Rms, false) => {
                return Some(Limit { value: 0.0, is_attained: false });
            }
            _ => return None,
        };
        let is_attained = matches!(
            (own.kind, sign > 0.0),
            (ReducedKind::Max | ReducedKind::MaxAbs, true) | (ReducedKind::Min, false)
        );
        Some(Limit { value: beyond + open(), is_attained })
    }

    /// Goes on with all climbs that are not done; whether there were any.
    fn step(&mut self, climbs: &mut [OfValue]) -> Result<bool, SimulationError> {
        let going: Vec<usize> = (0..climbs.len()).filter(|&number| climbs[number].climb.next.is_some()).collect();
        let points: Vec<Point> = going.iter().filter_map(|&number| climbs[number].climb.next.clone()).collect();
        if points.is_empty() {
            return Ok(false);
        }
        let numbers: Vec<usize> = going.iter().map(|&number| climbs[number].number).collect();
        let linear = self.linear(&points, &numbers, 1, 1)?;
        let known = || linear.iter().zip(&points).filter_map(|(own, point)| Some((own.as_ref()?, point)));
        let asked: Vec<WeightedPoint> = known().map(|(own, point)| (point, own.terms.clone())).collect();
        let mut gradients = self.motions.gradients(&asked)?.into_iter();
        for (&number, own) in going.iter().zip(&linear) {
            let climb = &mut climbs[number].climb;
            let found = own.as_ref().zip(own.as_ref().and_then(|_| gradients.next())).map(|(own, gradient)| {
                let by = gradient.by_parameters.iter().zip(&own.by_parameters).map(|(a, b)| a + b).collect();
                Gradient { value: own.value, by_parameters: by, ..gradient }
            });
            match found {
                Some(found) => climb.take(&found, self.motions),
                None => climb.next = None,
            }
        }
        Ok(true)
    }

    /// Values at points, with steps divided into `parts` and from one in `every` rows.
    fn linear(
        &mut self,
        points: &[Point],
        numbers: &[usize],
        parts: usize,
        every: usize,
    ) -> Result<Vec<Option<Linear>>, SimulationError> {
        // The last row is always one of them.
        let rows: Vec<usize> =
            (0..self.times.len()).rev().step_by(every).collect::<Vec<_>>().into_iter().rev().collect();
        let of_source = |&output: &usize| rows.iter().map(move |&row| Term { row, output, weight: 1.0 });
        let terms: Vec<Term> = self.sources.iter().flat_map(of_source).collect();
        let asked: Vec<WeightedPoint> = points.iter().map(|point| (point, terms.clone())).collect();
        let found = self.motions.all_values(&asked, parts)?;
        let times: Vec<f64> = rows.iter().map(|&row| self.times[row]).collect();
        let value = |((found, &number), point): ((Gradient, &usize), &Point)| {
            let in_rows_of = |reduced: usize| {
                let own = &self.motions.study.description.reduced[reduced];
                let series = |output: usize| {
                    let number = self.sources.partition_point(|known| *known < output);
                    &found.terms[number * rows.len()..][..rows.len()]
                };
                let mut found = in_rows(own, self.motions.study.description.simulation.duration, &times, series)?;
                found.terms.iter_mut().for_each(|term| term.row = rows[term.row]);
                found.value.is_finite().then_some(found)
            };
            let sample = self.motions.sample(point);
            match &self.all[number].1 {
                Value::Reduced(index) => {
                    let InRows { value, terms, .. } = in_rows_of(*index)?;
                    Some(Linear { value, terms, by_parameters: vec![0.0; sample.len()] })
                }
                Value::Slack { formulas, reduced } => {
                    let read = reduced.iter().map(|own| in_rows_of(*own)).collect::<Option<Vec<InRows>>>()?;
                    let numbers: Vec<f64> = read.iter().map(|own| own.value).collect();
                    let derivatives = formulas.derivatives(&sample, &numbers).swap_remove(0);
                    let (by_numbers, by_parameters) = derivatives.split_at(numbers.len());
                    let scaled = |(factor, own): (&f64, InRows)| {
                        let factor = *factor;
                        own.terms.into_iter().map(move |term| Term { weight: factor * term.weight, ..term })
                    };
                    Some(Linear {
                        value: formulas.values(&sample, &numbers)[0],
                        terms: by_numbers.iter().zip(read).flat_map(scaled).collect(),
                        by_parameters: by_parameters.to_vec(),
                    })
                }
            }
        };
        Ok(found.into_iter().zip(numbers).zip(points).map(value).collect())
    }

    /// Notes the best of the climbs to one end.
    fn note(&mut self, climbs: &[OfValue], found: &mut FunctionEnds) -> Result<(), SimulationError> {
        let best = climbs.iter().max_by(|a, b| a.climb.reached().total_cmp(&b.climb.reached()));
        let Some((OfValue { number, climb }, (point, reached))) =
            best.and_then(|best| Some((best, best.climb.best.as_ref()?)))
        else {
            return Ok(());
        };
        let (index, value) = &self.all[*number];
        let index = *index;
        // From the middle of all limits, with which climbs begin.
        found.note_parts(0, index, &climbs[0].climb.parts);
        // A peak that is made small has kinks, at which halved steps give no information: for a linear output the
        // gradient's whole promise holds.
        let by_gradient = climb.promised.max(0.0) + climb.cells;
        let open = match self.limit(value, climb.sign) {
            Some(Limit { value, is_attained: true }) => (value - reached).max(0.0),
            Some(Limit { value, is_attained: false }) => (value - reached).max(0.0).min(by_gradient),
            None => by_gradient,
        };
        let is_upper = climb.sign > 0.0;
        // Nobody asks how much further the upper end of a margin may be.
        let open = if is_upper && matches!(value, Value::Slack { .. }) { 0.0 } else { open };
        found.note(0, index, is_upper, FunctionEnd { value: climb.sign * reached, open });
        let (last, value) = (self.times.len() - 1, climb.sign * reached);
        let function = || self.motions.function(last, value, point);
        let from_middle = climbs[0].climb.start().map_or(0.0, |start| reached - start);
        found.note_worst(index, from_middle, function);
        found.note_extreme(index, is_upper, function, value);
        let points = std::slice::from_ref(point);
        let mut at = |parts: usize, every: usize| -> Result<f64, SimulationError> {
            let found = self.linear(points, &[*number], parts, every)?;
            Ok(found[0].as_ref().map_or(f64::NAN, |own| climb.sign * own.value))
        };
        let [halved, in_fewer] = [at(2, 1)?, at(1, 2)?];
        let error = if self.motions.jumps() {
            TUNING.first_order * (halved - reached).abs()
        } else {
            step_error(&[*reached], &[halved])
        };
        found.note_steps(0, index, SAFETY_OF_STEPS * error + (in_fewer - reached).abs());
        Ok(())
    }
}
