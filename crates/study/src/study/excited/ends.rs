//! Ends of all outputs in all rows over functions of the time.
//!
//! From the middle of all limits the kernel of each output in each row says how far either end is, and under which
//! function. Where a simulation under it ends there, the output is linear in it, and that is the end. Others are bent.
//! Where the kernel under that function names it again, it is an end too. In some rows bent ends are followed (`climb`)
//! from the middle, from the constants and from the best functions of the ends around them; those between learn from
//! these.

use super::climb::FunctionClimb;
use super::motions::{ExcitedMotions, WeightedPoint, in_row};
use super::point::Point;
use super::tuning::TUNING;
use crate::numerics::{SAFETY_OF_STEPS, step_error};
use crate::simulate::{Schedule, SimulationError, Simulator};
use crate::study::bounding::{FunctionEnd, FunctionEnds};
use crate::study::problem::Study;

/// An end of an output that is not linear in the functions.
struct Bent {
    row: usize,
    output: usize,
    sign: f64,
    /// Set if the kernel under the first function names that function again: its value, upwards, and the remaining
    /// promise.
    settled: Option<(f64, f64)>,
}

/// Ends of all outputs in all rows, and the motions, which have counted simulations.
///
/// # Errors
/// If the nominal motion cannot be simulated, and at an interruption.
pub fn ends<'s, 'm>(
    study: &'s Study<'m>,
    simulator: &'s Simulator,
    schedule: &Schedule,
) -> Result<(FunctionEnds, ExcitedMotions<'s, 'm>), SimulationError> {
    let motions = ExcitedMotions::new(study, simulator, schedule);
    let (rows, outputs) = (motions.schedule.rows, motions.outputs());
    let found = FunctionEnds::new(rows, outputs, motions.inputs());
    let mut search = Search { motions, found, bent: Vec::new() };
    let checked: Vec<usize> = checked(rows);
    let all: Vec<(usize, usize)> = (0..rows).flat_map(|row| (0..outputs).map(move |output| (row, output))).collect();
    for some in all.chunks(TUNING.kernels_at_once) {
        search.straight(some, &checked)?;
    }
    search.follow_bent()?;
    search.found.spread_steps();
    Ok((search.found, search.motions))
}

/// Some rows, ascending, the last of all among them.
fn checked(rows: usize) -> Vec<usize> {
    let count = TUNING.checked_rows.min(rows);
    (1..=count).map(|number| (number * rows).div_ceil(count) - 1).collect()
}

struct Search<'s, 'm> {
    motions: ExcitedMotions<'s, 'm>,
    found: FunctionEnds,
    bent: Vec<Bent>,
}

impl Search<'_, '_> {
    /// Ends of some outputs in rows that are linear in the functions; the others are noted as bent.
    fn straight(&mut self, some: &[(usize, usize)], checked: &[usize]) -> Result<(), SimulationError> {
        let middle = self.motions.middle();
        let asked: Vec<WeightedPoint> = some.iter().map(|&(row, output)| (&middle, in_row(row, output))).collect();
        let kernels = self.motions.gradients(&asked)?;
        let mut climbs: Vec<FunctionClimb> = Vec::with_capacity(2 * some.len());
        for (&(row, output), kernel) in some.iter().zip(&kernels) {
            for sign in [-1.0, 1.0] {
                let mut climb = FunctionClimb::new(row, output, sign, middle.clone());
                climb.take(kernel, &self.motions);
                self.found.note_parts(row, output, &climb.parts);
                climbs.push(climb);
            }
        }
        drop(kernels);
        let going: Vec<usize> = (0..climbs.len()).filter(|&number| climbs[number].next.is_some()).collect();
        let bent = if self.motions.has_parameters() {
            // Those may matter under a function only: their derivatives are known there.
            going
        } else {
            let asked: Vec<WeightedPoint> = going.iter().filter_map(|&number| climbs[number].asked()).collect();
            let values = self.motions.values(&asked, 1)?;
            let bent = |(number, value): (usize, f64)| (!climbs[number].arrive(value)).then_some(number);
            going.into_iter().zip(values).filter_map(bent).collect()
        };
        self.step(&mut climbs, &bent)?;
        for number in bent {
            let climb = &mut climbs[number];
            let (row, output, sign) = (climb.row, climb.output, climb.sign);
            let settled = climb.next.is_none().then(|| (climb.reached(), climb.open()));
            self.bent.push(Bent { row, output, sign, settled });
            if settled.is_none() {
                climb.best = None;
            }
        }
        climbs.retain(|climb| climb.best.is_some());
        let (measured, others): (Vec<FunctionClimb>, Vec<FunctionClimb>) =
            climbs.into_iter().partition(|climb| checked.contains(&climb.row));
        others.iter().for_each(|climb| self.note(climb));
        self.note_measured(&measured)
    }

    /// Follows some of the bent ends, evenly spread over the rows of an output's end; the others learn from these.
    fn follow_bent(&mut self) -> Result<(), SimulationError> {
        let mut bent = std::mem::take(&mut self.bent);
        bent.sort_by(|a, b| a.output.cmp(&b.output).then(a.sign.total_cmp(&b.sign)).then(a.row.cmp(&b.row)));
        // The last row of each output's end, and rows at a fixed interval before it.
        let (mut followed, mut between): (Vec<FunctionClimb>, Vec<Bent>) = (Vec::new(), Vec::new());
        for of_end in bent.chunk_by(|a, b| a.output == b.output && a.sign == b.sign) {
            let every = of_end.len().div_ceil(TUNING.followed_rows);
            for (number, own) in of_end.iter().enumerate() {
                if (of_end.len() - 1 - number) % every == 0 {
                    followed.push(FunctionClimb::new(own.row, own.output, own.sign, self.motions.middle()));
                } else {
                    between.push(Bent { ..*own });
                }
            }
        }
        self.follow(&mut followed, TUNING.steps_of_climb)?;
        self.start_elsewhere(&mut followed)?;
        self.note_measured(&followed)?;
        for some in between.chunks(TUNING.kernels_at_once / 2) {
            self.learn(some, &followed)?;
        }
        Ok(())
    }

    /// Goes on with climbs until all are done, in at most `steps` steps.
    fn follow(&mut self, climbs: &mut [FunctionClimb], steps: usize) -> Result<(), SimulationError> {
        for _ in 0..steps {
            let going: Vec<usize> = (0..climbs.len()).filter(|&number| climbs[number].next.is_some()).collect();
            if going.is_empty() {
                break;
            }
            self.step(climbs, &going)?;
        }
        Ok(())
    }

    /// A step of some climbs.
    fn step(&mut self, climbs: &mut [FunctionClimb], going: &[usize]) -> Result<(), SimulationError> {
        let asked: Vec<WeightedPoint> = going.iter().filter_map(|&number| climbs[number].asked()).collect();
        let found = self.motions.gradients(&asked)?;
        for (&number, found) in going.iter().zip(found) {
            let climb = &mut climbs[number];
            climb.take(&found, &self.motions);
        }
        Ok(())
    }

    /// Climbs once more from the best functions of the ends around, as they are and moved by the time between, from the
    /// opposite function and from the two constants. More than once, since neighbours learn from one another.
    fn start_elsewhere(&mut self, climbs: &mut [FunctionClimb]) -> Result<(), SimulationError> {
        for round in 0..TUNING.rounds {
            let (mut numbers, mut others) = (Vec::new(), Vec::new());
            for (number, climb) in climbs.iter().enumerate() {
                let around = [number.checked_sub(1), Some(number + 1)].into_iter().flatten();
                let mut starts: Vec<FunctionClimb> = around
                    .filter_map(|other| climbs.get(other))
                    .filter(|other| other.output == climb.output && other.sign == climb.sign)
                    .flat_map(|other| self.of_neighbour(climb.row, other))
                    .collect();
                if let Some((best, _)) = climb.best.as_ref().filter(|_| round == 0) {
                    let classes = self.motions.classes(&best.xi);
                    let constant = |sign: f64| Point {
                        xi: best.xi.clone(),
                        functions: classes.iter().map(|class| class.constant(sign, &self.motions.ends)).collect(),
                    };
                    let start = |point: Point| FunctionClimb::new(climb.row, climb.output, climb.sign, point);
                    starts.extend([-1.0, 1.0].map(constant).map(start));
                    starts.push(FunctionClimb::guided(climb.row, climb.output, climb.sign, best.opposite()));
                }
                numbers.extend(starts.iter().map(|_| number));
                others.extend(starts);
            }
            self.follow(&mut others, TUNING.steps_of_climb)?;
            climbs.iter_mut().for_each(|climb| climb.improved = 0.0);
            numbers.into_iter().zip(others).for_each(|(number, other)| climbs[number].learn(other));
        }
        Ok(())
    }

    /// Climbs to the same end in another row: from its function, and from that moved by the time between the rows.
    fn of_neighbour(&self, row: usize, other: &FunctionClimb) -> Vec<FunctionClimb> {
        let Some((point, _)) = &other.best else { return Vec::new() };
        let by = self.motions.schedule.time(row) - self.motions.schedule.time(other.row);
        vec![
            FunctionClimb::new(row, other.output, other.sign, point.clone()),
            FunctionClimb::guided(
                row,
                other.output,
                other.sign,
                point.later(by, &self.motions.ends, &self.motions.ends),
            ),
        ]
    }

    /// Bent ends between those that are followed: those of which the kernel settled at once, and climbs from their
    /// neighbours' functions. They may be as far off as starts from elsewhere improve their neighbours.
    fn learn(&mut self, some: &[Bent], followed: &[FunctionClimb]) -> Result<(), SimulationError> {
        let (mut numbers, mut climbs) = (Vec::new(), Vec::new());
        let mut improved = vec![0.0_f64; some.len()];
        for (number, own) in some.iter().enumerate() {
            let mut alike = followed.iter().filter(|climb| climb.output == own.output && climb.sign == own.sign);
            let after = alike.clone().find(|climb| climb.row > own.row);
            let before = alike.rfind(|climb| climb.row < own.row);
            let around = || [before, after].into_iter().flatten();
            improved[number] = around().map(|other| other.improved).fold(0.0, f64::max);
            // If no start from elsewhere is better, one that has settled is the end.
            if own.settled.is_some_and(|(_, open)| improved[number] <= open) {
                continue;
            }
            for other in around() {
                let starts = self.of_neighbour(own.row, other);
                numbers.extend(starts.iter().map(|_| number));
                climbs.extend(starts);
            }
        }
        self.follow(&mut climbs, TUNING.steps_of_learnt)?;
        let mut best: Vec<Option<FunctionClimb>> = some.iter().map(|_| None).collect();
        for (number, climb) in numbers.into_iter().zip(climbs) {
            if best[number].as_ref().is_none_or(|known| climb.reached() > known.reached()) {
                best[number] = Some(climb);
            }
        }
        for ((own, best), improved) in some.iter().zip(best).zip(improved) {
            let settled =
                own.settled.filter(|(reached, _)| best.as_ref().is_none_or(|best| *reached >= best.reached()));
            match (settled, best) {
                (Some((reached, open)), _) => {
                    let end = FunctionEnd { value: own.sign * reached, open: open + improved };
                    self.found.note(own.row, own.output, own.sign > 0.0, end);
                }
                (None, Some(best)) => self.note(&best),
                (None, None) => {}
            }
        }
        Ok(())
    }

    /// Notes the results of climbs, with the errors of the steps, measured by halved steps.
    fn note_measured(&mut self, climbs: &[FunctionClimb]) -> Result<(), SimulationError> {
        let known: Vec<&FunctionClimb> = climbs.iter().filter(|climb| climb.best.is_some()).collect();
        let point = |climb: &&'_ FunctionClimb| climb.best.as_ref().map(|(point, _)| point.clone());
        let points: Vec<Point> = known.iter().filter_map(point).collect();
        let asked: Vec<WeightedPoint> =
            points.iter().zip(&known).map(|(point, climb)| (point, in_row(climb.row, climb.output))).collect();
        let halved = self.motions.values(&asked, 2)?;
        let jumps = self.motions.jumps();
        for (climb, halved) in known.into_iter().zip(halved) {
            self.note(climb);
            let direct = climb.sign * climb.reached();
            let error =
                if jumps { TUNING.first_order * (halved - direct).abs() } else { step_error(&[direct], &[halved]) };
            self.found.note_steps(climb.row, climb.output, SAFETY_OF_STEPS * error);
        }
        Ok(())
    }

    /// Notes the result of a climb.
    fn note(&mut self, climb: &FunctionClimb) {
        let FunctionClimb { row, output, sign, .. } = *climb;
        let Some((point, reached)) = &climb.best else { return };
        let value = sign * reached;
        self.found.note(row, output, sign > 0.0, FunctionEnd { value, open: climb.open() });
        let function = || self.motions.function(row, value, point);
        self.found.note_worst(output, climb.gain(), function);
        self.found.note_extreme(output, sign > 0.0, function, value);
    }
}
