//! The outputs at a time, through events.

use super::at_row::RowMotion;
use super::piece::Piece;
use super::pieces::Pieces;
use super::surrogate::{Point, SegmentErrors};
use super::tuning::TUNING;
use crate::methods::chebyshev::sensitivity::Predicted;
use crate::methods::closure::Closure;
use crate::numerics::{ParameterBox, Surrogate, largest};

/// A row of output in one part of the box.
pub(super) struct SegmentRow<'r> {
    pub domain: &'r ParameterBox,
    /// Number of outputs.
    pub outputs: usize,
    pub piece: &'r Piece,
    /// The part's motion at the row's time, if it is expanded there.
    pub motion: Option<&'r RowMotion>,
    pub closure: &'r dyn Closure,
    /// s
    pub time: f64,
}

/// A row of output in all of it.
pub(super) struct BoxRow<'r> {
    pub domain: &'r ParameterBox,
    /// Number of outputs.
    pub outputs: usize,
    pub pieces: &'r Pieces,
    /// Motions of each part.
    pub motions: &'r [RowMotion],
    pub closure: &'r dyn Closure,
    /// s
    pub time: f64,
}

/// The same for sensitivities.
pub(super) struct SensedRow<'r> {
    pub row: &'r BoxRow<'r>,
    /// The surrogate by which instants and motions of a box of one word are expanded.
    pub grid: &'r Surrogate,
}

impl SegmentRow<'_> {
    /// All outputs (output, point), given the point's segment, and the time at which its motion is taken there.
    pub fn outputs_on(&self, points: &[(&Point, usize, f64)]) -> Vec<f64> {
        let (count, lines) = (points.len(), self.piece.surrogate.lines());
        let mut motion = vec![0.0; lines * count];
        for (index, (point, segment, time)) in points.iter().enumerate() {
            self.set_motion(point, *segment, *time, |line, value| motion[line * count + index] = value);
        }
        self.closed(points.iter().map(|(point, ..)| point.xi.as_slice()), count, motion)
    }

    /// Sets the motion of a point at a time on the branch of a segment, line by line.
    fn set_motion(&self, point: &Point, segment: usize, time: f64, mut set: impl FnMut(usize, f64)) {
        let at_row = self.motion.filter(|_| time == self.time).and_then(|own| own.motion(point, segment));
        match at_row {
            Some(values) => values.enumerate().for_each(|(line, value)| set(line, value)),
            None => {
                let values = self.piece.surrogate.motion(point, segment, time);
                values.enumerate().for_each(|(line, value)| set(line, value));
            }
        }
    }

    /// Whether motions on the branch of a segment are expanded at the row's time.
    pub fn has_branch(&self, segment: usize) -> bool {
        self.motion.is_some_and(|own| own.has_branch(segment))
    }

    /// Whether no event passes through the part.
    pub fn is_common(&self) -> bool {
        self.motion.is_some_and(|own| own.is_common)
    }

    /// Outputs at the row's time at points, each in its own segment.
    pub fn outputs_in(&self, places: &[(usize, Point)]) -> Vec<f64> {
        self.outputs_on(&places.iter().map(|(segment, point)| (point, *segment, self.time)).collect::<Vec<_>>())
    }

    /// Outputs at the row's time at points, in the segments that they are in then.
    pub fn outputs_at(&self, points: &[Point]) -> Vec<f64> {
        let at: Vec<_> = points.iter().map(|point| (point, point.segment(self.time), self.time)).collect();
        self.outputs_on(&at)
    }

    fn closed<'x>(&self, xi: impl Iterator<Item = &'x [f64]>, count: usize, motion: Vec<f64>) -> Vec<f64> {
        let domain = self.domain;
        let mut parameters = vec![0.0; domain.dimension() * count];
        for (index, xi) in xi.enumerate() {
            for (parameter, &xi) in xi.iter().enumerate() {
                parameters[parameter * count + index] = domain.value(parameter, xi);
            }
        }
        self.closure.outputs(self.time, count, parameters, motion)
    }

    /// How far the polynomials' errors move outputs `here` at points (output, point), which are ends of a range, each
    /// in the segment in which its value was taken: there an event nearby may have been already, or not yet, each line
    /// may be off by its own error, and a surface nearby by its.
    ///
    /// Lines have errors at times and at shares of their segment. Either is enough: within a contact, where a late
    /// instant makes a line late, an end at some share is found at that share nearby.
    pub fn errors(&self, places: &[(usize, Point)], here: &[f64]) -> Vec<f64> {
        let surrogate = &self.piece.surrogate;
        let count = places.len();
        let at = |shift: f64| {
            let shifted = |(segment, point): &(usize, Point)| {
                let times = &self.piece.errors_at(point).times;
                self.time + shift * times[*segment].max(times[segment + 1])
            };
            places.iter().map(|own| (&own.1, own.1.segment(shifted(own)), self.time)).collect::<Vec<_>>()
        };
        let of = |ways: [Vec<f64>; 2]| -> Vec<f64> {
            let value = |index: usize| largest(ways.iter().map(|way| way[index] - here[index]));
            (0..here.len()).map(value).collect()
        };
        let add = |moved: &mut Vec<f64>, by: &[f64]| moved.iter_mut().zip(by).for_each(|(own, by)| *own += by);
        let in_step = |error: fn(&SegmentErrors, usize, usize, usize) -> f64| {
            self.of_lines(places, here, |segment, point, line| {
                let at_row = self.motion.and_then(|own| own.error(segment, self.piece.told_at(point), line));
                let of_step =
                    || error(self.piece.errors_at(point), segment, surrogate.step(point, segment, self.time), line);
                at_row.unwrap_or_else(of_step)
            })
        };
        let mut moved = of([-1.0, 1.0].map(|shift| self.outputs_on(&at(shift))));
        add(&mut moved, &in_step(SegmentErrors::of_line));
        if !places.iter().all(|(segment, _)| self.has_branch(*segment)) {
            let mut at_shares = self.along(places, here);
            add(&mut at_shares, &in_step(SegmentErrors::of_share));
            // Errors that are unknown at times stay so; those on a branch are of the row's time.
            let is_less = |index: usize, own: f64, other: f64| other < own && !self.has_branch(places[index % count].0);
            let all = moved.iter_mut().zip(at_shares).enumerate();
            all.filter(|(index, (own, other))| is_less(*index, **own, *other))
                .for_each(|(_, (own, other))| *own = other);
        }
        for end in 0..surrogate.ends.len() {
            add(&mut moved, &of([-1.0, 1.0].map(|sign| self.outputs_at(&self.beside(places, end, sign)))));
        }
        // Outside of the samples of a fit errors are larger.
        let far: Vec<f64> = places.iter().map(|(_, point)| surrogate.leverage(&point.xi).max(1.0).sqrt()).collect();
        moved
            .chunks_exact(count.max(1))
            .flat_map(|moved| moved.iter().zip(&far).map(|(moved, far)| far * moved))
            .collect()
    }

    /// How far outputs at points move, from their values there, where each line is off by its error: of a segment, a
    /// point in it, and a line.
    fn of_lines(
        &self,
        places: &[(usize, Point)],
        here: &[f64],
        error: impl Fn(usize, &Point, usize) -> f64,
    ) -> Vec<f64> {
        let (count, n) = (places.len(), self.piece.surrogate.lines() / 2);
        let mut moved = vec![0.0; here.len()];
        for line in self.closure.independent().iter().flat_map(|&coordinate| [coordinate, n + coordinate]) {
            let ways = [-1.0, 1.0].map(|sign| {
                let mut motion = vec![0.0; 2 * n * count];
                for (index, &(segment, ref point)) in places.iter().enumerate() {
                    self.set_motion(point, segment, self.time, |number, value| motion[number * count + index] = value);
                    motion[line * count + index] += sign * error(segment, point, line);
                }
                self.closed(places.iter().map(|(_, point)| point.xi.as_slice()), count, motion)
            });
            for (index, moved) in moved.iter_mut().enumerate() {
                *moved += largest(ways.iter().map(|way| way[index] - here[index]));
            }
        }
        moved
    }

    /// How far outputs at points (output, point) differ from those nearby at the same share of the segment, as far away
    /// as the errors of its instants move that share; unknown where the box ends before.
    fn along(&self, places: &[(usize, Point)], here: &[f64]) -> Vec<f64> {
        let surrogate = &self.piece.surrogate;
        let count = places.len();
        let at_share = |point: &Point, (segment, share): (usize, f64)| {
            let [begin, end] = [point.times[segment], point.times[segment + 1]];
            begin + share * (end - begin)
        };
        let share = |&(segment, ref point): &(usize, Point)| (segment, surrogate.share(point, segment, self.time).0);
        let shares: Vec<(usize, f64)> = places.iter().map(share).collect();
        let k = self.domain.dimension();
        let moved = |point: &Point, axis: usize| {
            let mut xi = point.xi.clone();
            xi[axis] += TUNING.step_of_surfaces;
            xi
        };
        let around = places.iter().flat_map(|(_, point)| (0..k).map(move |axis| moved(point, axis)));
        let around = surrogate.points(around.collect());
        let way = |index: usize| -> Vec<f64> {
            let (point, own) = (&places[index].1, shares[index]);
            let errors = &self.piece.errors_at(point).times;
            // Not out of the box.
            let is_free = |xi: f64| xi.abs() < 1.0 - TUNING.step_of_surfaces;
            let slope = |axis: usize| {
                let later = at_share(&around[index * k + axis], own) - self.time;
                if is_free(point.xi[axis]) { later / TUNING.step_of_surfaces } else { 0.0 }
            };
            let slopes: Vec<f64> = (0..k).map(slope).collect();
            let square: f64 = slopes.iter().map(|slope| slope * slope).sum();
            let by = errors[own.0].max(errors[own.0 + 1]) / square;
            slopes.iter().map(|slope| by * slope).collect()
        };
        let ways: Vec<Vec<f64>> = (0..count).map(way).collect();
        let beside = |sign: f64| -> Vec<f64> {
            let xi = places.iter().zip(&ways);
            let xi = xi.map(|((_, point), way)| point.xi.iter().zip(way).map(|(xi, by)| xi + sign * by).collect());
            let others = surrogate.points(xi.collect());
            let at: Vec<(&Point, usize, f64)> =
                others.iter().zip(&shares).map(|(point, &own)| (point, own.0, at_share(point, own))).collect();
            let is_within = |index: usize| others[index % count].xi.iter().all(|xi| xi.abs() <= 1.0);
            let values = self.outputs_on(&at).into_iter().enumerate();
            values.map(|(index, value)| if is_within(index) { value } else { f64::NAN }).collect()
        };
        let both = [beside(-1.0), beside(1.0)];
        (0..here.len()).map(|index| largest(both.iter().map(|values| values[index] - here[index]))).collect()
    }

    /// The points, of which those near a surface are moved across it by its error.
    fn beside(&self, places: &[(usize, Point)], end: usize, sign: f64) -> Vec<Point> {
        let surface = &self.piece.surrogate.ends[end];
        let across = |point: &Point| {
            let mut xi = point.xi.clone();
            if point.margins[end].abs() > TUNING.near_end * surface.error() {
                return xi;
            }
            let of = |axis: usize| {
                let mut beside = point.xi.clone();
                beside[axis] += TUNING.step_of_surfaces;
                (surface.margin(&beside) - point.margins[end]) / TUNING.step_of_surfaces
            };
            let slopes: Vec<f64> = (0..xi.len()).map(of).collect();
            let square: f64 = slopes.iter().map(|slope| slope * slope).sum();
            let by = sign * surface.error() / square;
            if by.is_finite() {
                xi.iter_mut().zip(&slopes).for_each(|(xi, slope)| *xi = (*xi + by * slope).clamp(-1.0, 1.0));
            }
            xi
        };
        self.piece.surrogate.points(places.iter().map(|(_, point)| across(point)).collect())
    }
}

impl<'r> BoxRow<'r> {
    /// The row in each part.
    pub fn in_parts(&self) -> impl Iterator<Item = SegmentRow<'r>> {
        let Self { domain, outputs, pieces, motions, closure, time } = *self;
        let of_part = move |(piece, motion): (&'r Piece, &'r RowMotion)| SegmentRow {
            domain,
            outputs,
            piece,
            motion: Some(motion),
            closure,
            time,
        };
        pieces.all.iter().zip(motions).map(of_part)
    }

    /// Some of the outputs at points of the box: output, point.
    pub fn some_outputs(&self, outputs: &[usize], points: &[Vec<f64>]) -> Vec<f64> {
        let mut values = vec![f64::NAN; outputs.len() * points.len()];
        for row in self.in_parts() {
            let is_own =
                |point: &usize| self.pieces.part_of(&points[*point]).is_some_and(|own| std::ptr::eq(own, row.piece));
            let own: Vec<usize> = (0..points.len()).filter(is_own).collect();
            let at = row.piece.surrogate.points(own.iter().map(|&point| points[point].clone()).collect());
            let found = row.outputs_at(&at);
            for (line, output) in outputs.iter().enumerate() {
                for (index, point) in own.iter().enumerate() {
                    values[line * points.len() + point] = found[output * own.len() + index];
                }
            }
        }
        values
    }
}

impl Predicted for SensedRow<'_> {
    fn outputs(&self) -> usize {
        self.row.outputs
    }

    fn surrogate(&self) -> &Surrogate {
        self.grid
    }

    fn predict_some(&self, outputs: &[usize], points: &[Vec<f64>]) -> Vec<f64> {
        self.row.some_outputs(outputs, points)
    }
}
