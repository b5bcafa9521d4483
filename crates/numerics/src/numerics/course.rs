//! One sample's course of a coordinate through time, as a measure of where others are: a coordinate that turns is q =
//! V(s), with s the time at which this sample is there.
//!
//! A crank's angle ripples over time, once or twice a turn, and where samples are some turns apart it ripples over
//! their box too, which takes polynomials of high degree. All of them ripple at the same angles, so that s does not.

use super::range::Range;
use super::tuning::TUNING;

const TERMS: usize = 4 * TUNING.rows_beside;

/// A course: values and rates in rows, and polynomials between them.
#[derive(Clone, Debug)]
pub struct Course {
    /// −1 of a coordinate that falls.
    sign: f64,
    times: Vec<f64>,
    values: Vec<f64>,
    /// Whether they never fall.
    ascends: bool,
    pieces: Vec<Piece>,
    /// Least and largest rate seen in each piece. (Separate from the pieces, since each row examines all of them.)
    rates: Vec<(f64, f64)>,
}

/// Between two rows: the polynomial through the values and rates of these and of their neighbours, in Newton's form.
#[derive(Clone, Copy, Debug)]
struct Piece {
    nodes: [f64; TERMS],
    differences: [f64; TERMS],
}

/// The part of a course on which it rises, beyond which it goes straight on.
#[derive(Clone, Copy, Debug)]
pub struct Phase<'c> {
    course: &'c Course,
    begin: usize,
    end: usize,
    steepest: f64,
}

impl Piece {
    fn new(times: &[f64], values: &[f64], rates: &[f64], row: usize) -> Self {
        let first = (row + 1).saturating_sub(TUNING.rows_beside).min(times.len() - 2 * TUNING.rows_beside);
        let of = |index: usize| first + index / 2;
        let nodes: [f64; TERMS] = std::array::from_fn(|index| times[of(index)]);
        let mut differences: [f64; TERMS] = std::array::from_fn(|index| values[of(index)]);
        for order in 1..TERMS {
            for index in (order..TERMS).rev() {
                differences[index] = if order == 1 && index % 2 == 1 {
                    rates[of(index)]
                } else {
                    (differences[index] - differences[index - 1]) / (nodes[index] - nodes[index - order])
                };
            }
        }
        Self { nodes, differences }
    }

    /// Least and largest rate seen between two times; where one is NaN, the piece does not rise.
    fn rates(&self, (from, to): (f64, f64)) -> (f64, f64) {
        let rate = |look: usize| self.at(from + look as f64 / TUNING.looks as f64 * (to - from)).1;
        (0..=TUNING.looks).map(rate).fold((f64::INFINITY, 0.0), |(least, largest), rate| {
            (if rate >= least { least } else { rate }, rate.max(largest))
        })
    }

    /// Value and rate.
    fn at(&self, time: f64) -> (f64, f64) {
        let (mut value, mut rate) = (self.differences[TERMS - 1], 0.0);
        for (difference, node) in self.differences.iter().zip(&self.nodes).rev().skip(1) {
            rate = rate * (time - node) + value;
            value = value * (time - node) + difference;
        }
        (value, rate)
    }
}

impl Course {
    /// Course of a coordinate's values and rates at ascending times; `None` if these are too few.
    pub fn new(times: Vec<f64>, mut values: Vec<f64>, mut rates: Vec<f64>) -> Option<Self> {
        if times.len() < 2 * TUNING.rows_beside {
            return None;
        }
        let sign = if values.last() < values.first() { -1.0 } else { 1.0 };
        values.iter_mut().chain(&mut rates).for_each(|value| *value *= sign);
        let pieces: Vec<Piece> = (0..times.len() - 1).map(|row| Piece::new(&times, &values, &rates, row)).collect();
        let rates = pieces.iter().enumerate().map(|(row, piece)| piece.rates((times[row], times[row + 1]))).collect();
        let ascends = values.is_sorted();
        Some(Self { sign, times, values, ascends, pieces, rates })
    }

    /// The last row up to `low` before the first one from `high` on, and that one.
    fn around(&self, low: f64, high: f64) -> Option<(usize, usize)> {
        if self.ascends {
            let end = self.values.partition_point(|&value| value < high);
            let begin = self.values[..end].partition_point(|&value| value <= low).checked_sub(1)?;
            return (end < self.values.len()).then_some((begin, end));
        }
        let end = self.values.iter().position(|&value| value >= high)?;
        let begin = self.values[..=end].iter().rposition(|&value| value <= low)?;
        Some((begin, end))
    }

    /// The part around the values of some samples, and as much again on either side as far as the course rises there;
    /// `None` if the course does not pass all of them, rests, or turns back.
    pub fn over(&self, range: Range) -> Option<Phase<'_>> {
        let (a, b) = (self.sign * range.lower, self.sign * range.upper);
        let (low, high) = (a.min(b), a.max(b));
        let (mut begin, mut end) = self.around(low, high)?;
        // Written so that NaN is nowhere.
        if !(low < high && begin < end) {
            return None;
        }
        let least =
            TUNING.slowest_course * (self.values[end] - self.values[begin]) / (self.times[end] - self.times[begin]);
        let rises = |rates: &(f64, f64)| rates.0 >= least;
        if !self.rates[begin..end].iter().all(rises) {
            return None;
        }
        let beside = (end - begin).max(TUNING.fewest_rows_beside);
        begin -= self.rates[..begin].iter().rev().take(beside).take_while(|rates| rises(rates)).count();
        end += self.rates[end..].iter().take(beside).take_while(|rates| rises(rates)).count();
        let steepest = self.rates[begin..end].iter().fold(0.0_f64, |most, rates| most.max(rates.1));
        (end >= begin + TUNING.fewest_rows).then_some(Phase { course: self, begin, end, steepest })
    }
}

impl Phase<'_> {
    /// The coordinate and its rate at a time of the course.
    pub fn at(&self, time: f64) -> (f64, f64) {
        let Course { sign, times, pieces, .. } = self.course;
        let within = time.clamp(times[self.begin], times[self.end]);
        // Rows are about equally far apart: the last one before a time is within a step or two of where it then is.
        let share = (within - times[self.begin]) / (times[self.end] - times[self.begin]);
        let last = self.end - 1;
        let mut row = (self.begin + (share * (self.end - self.begin) as f64) as usize).min(last);
        while row < last && times[row + 1] <= within {
            row += 1;
        }
        while row > self.begin && times[row] > within {
            row -= 1;
        }
        let (value, rate) = pieces[row].at(within);
        (sign * (value + rate * (time - within)), sign * rate)
    }

    /// Whether a time of the course lies on this part of it.
    pub fn holds(&self, time: f64) -> bool {
        let times = &self.course.times;
        times[self.begin] <= time && time <= times[self.end]
    }

    /// The time at which the course has a value.
    pub fn time(&self, value: f64) -> f64 {
        let Course { sign, times, values, pieces, .. } = self.course;
        let value = sign * value;
        let beyond = [(self.begin, value <= values[self.begin]), (self.end, value >= values[self.end])];
        if let Some((row, _)) = beyond.into_iter().find(|beyond| beyond.1) {
            let (at, rate) = pieces[row.min(self.end - 1)].at(times[row]);
            return times[row] + (value - at) / rate;
        }
        let row = values[self.begin + 1..self.end].partition_point(|&row| row <= value) + self.begin;
        let (mut low, mut high) = (times[row], times[row + 1]);
        let mut time = low + (high - low) * (value - values[row]) / (values[row + 1] - values[row]);
        let settled = (TUNING.close_time * (high - low)).max(2.0 * f64::EPSILON * time.abs());
        // Newton's method, within the interval known to contain the time.
        for _ in 0..TUNING.steps_to_time {
            let (at, rate) = pieces[row].at(time);
            if at > value {
                high = time
            } else {
                low = time
            }
            let next = time - (at - value) / rate;
            let next = if next >= low && next <= high { next } else { 0.5 * (low + high) };
            // The next step is as small as the square of this one.
            if (next - time).abs() <= settled {
                return next;
            }
            time = next;
        }
        time
    }

    /// Largest rate, whichever way.
    pub fn steepest(&self) -> f64 {
        self.steepest
    }
}

#[cfg(test)]
mod tests {
    use symdiff::math;

    use super::*;

    /// An angle that ripples twice a turn, and its rate.
    fn angle(t: f64, speed: f64) -> (f64, f64) {
        let base = speed * t;
        (base + 0.2 * math::sin(2.0 * base), speed * (1.0 + 0.4 * math::cos(2.0 * base)))
    }

    fn course(speed: f64) -> Course {
        let times: Vec<f64> = (0..=200).map(|row| 0.01 * f64::from(row)).collect();
        let (values, rates) = times.iter().map(|&t| angle(t, speed)).unzip();
        Course::new(times, values, rates).unwrap()
    }

    #[test]
    fn times_and_values_are_inverse() {
        for speed in [20.0, -20.0] {
            let course = course(speed);
            let [a, b] = [5.0, 31.0].map(|turned: f64| turned.copysign(speed));
            let phase = course.over(Range { lower: a.min(b), upper: a.max(b) }).unwrap();
            for step in -20..=260 {
                let value = (0.15 * f64::from(step)).copysign(if step < 0 { -speed } else { speed });
                let time = phase.time(value);
                let (back, rate) = phase.at(time);
                assert!((back - value).abs() < 1e-12 * (1.0 + value.abs()), "{value}: {back}");
                if (5.0..31.0).contains(&value.abs()) && value * speed > 0.0 {
                    // The course between the rows is that of the angle.
                    let (own, own_rate) = angle(time, speed);
                    assert!((own - value).abs() < 1e-7 && (own_rate - rate).abs() < 1e-4, "{own} {own_rate} {rate}");
                }
                let ahead = phase.at(time + 1e-7).0;
                assert!(((ahead - value) / 1e-7 - rate).abs() < 1e-4 * rate.abs());
            }
        }
    }

    /// A time that one part gives is the time that any part which contains it gives.
    #[test]
    fn times_do_not_depend_on_the_part() {
        let course = course(20.0);
        let [narrow, wide] =
            [(9.0, 11.0), (4.0, 30.0)].map(|(lower, upper)| course.over(Range { lower, upper }).unwrap());
        for value in (0..=20).map(|step| 9.0 + 0.1 * f64::from(step)) {
            let time = narrow.time(value);
            assert!(wide.holds(time) && wide.time(value).to_bits() == time.to_bits());
        }
        assert!(!narrow.holds(0.0) && !narrow.holds(f64::NAN));
    }

    #[test]
    fn resting_or_reversing_course_is_no_measure() {
        let course = course(20.0);
        assert!(course.over(Range { lower: 5.0, upper: 5.0 }).is_none());
        assert!(course.over(Range { lower: 5.0, upper: 60.0 }).is_none());
        assert!(course.over(Range { lower: f64::NAN, upper: 6.0 }).is_none());
        let times: Vec<f64> = (0..=200).map(|row| 0.01 * f64::from(row)).collect();
        let all_but_rests = times.iter().map(|&t| (t + 0.199 * math::sin(5.0 * t), 1.0 + 0.995 * math::cos(5.0 * t)));
        let (values, rates) = all_but_rests.unzip();
        let course = Course::new(times.clone(), values, rates).unwrap();
        assert!(course.over(Range { lower: 0.1, upper: 0.4 }).is_some());
        assert!(course.over(Range { lower: 0.4, upper: 1.0 }).is_none());
        let turns_back = times.iter().map(|&t| (t + 0.4 * math::sin(5.0 * t), 1.0 + 2.0 * math::cos(5.0 * t)));
        let (values, rates) = turns_back.unzip();
        let course = Course::new(times, values, rates).unwrap();
        assert!(course.over(Range { lower: 0.1, upper: 0.4 }).is_some());
        assert!(course.over(Range { lower: 0.1, upper: 1.2 }).is_none());
    }
}
