//! One sample's course of a coordinate through time, as a measure of where others are: a coordinate that turns is q = V(s), with s the
//! time at which this sample is there.
//!
//! A crank's angle ripples over time, once or twice a turn, and where samples are some turns apart it ripples over their box too, which
//! takes polynomials of high degree. All of them ripple at the same places, so that s does not.

use super::range::Range;

/// Least rate on the way, as a share of the mean where samples are: where the course all but rests, times tell no places.
const SLOWEST: f64 = 0.05;
/// Fewest rows of a way.
const ROWS: usize = 4;
/// Places within a piece at which it has to rise.
const LOOKS: usize = 4;
/// Rows that a piece is made through, at either side, and its terms: a value and a rate of each.
const BESIDE: usize = 2;
const TERMS: usize = 4 * BESIDE;
/// Most steps of the search for a time.
const STEPS: usize = 64;

/// A course: values and rates in rows, and polynomials between them.
#[derive(Clone, Debug)]
pub struct Course {
    /// −1 of a coordinate that falls.
    sign: f64,
    times: Vec<f64>,
    values: Vec<f64>,
    pieces: Vec<Piece>,
}

/// Between two rows: the polynomial through the values and rates of these and of those beside them, in Newton's form.
#[derive(Clone, Copy, Debug)]
struct Piece {
    nodes: [f64; TERMS],
    differences: [f64; TERMS],
    /// Least and largest rate seen.
    rates: (f64, f64),
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
        let first = (row + 1).saturating_sub(BESIDE).min(times.len() - 2 * BESIDE);
        let of = |place: usize| first + place / 2;
        let nodes: [f64; TERMS] = std::array::from_fn(|place| times[of(place)]);
        let mut differences: [f64; TERMS] = std::array::from_fn(|place| values[of(place)]);
        for order in 1..TERMS {
            for place in (order..TERMS).rev() {
                differences[place] = if order == 1 && place % 2 == 1 {
                    rates[of(place)]
                } else {
                    (differences[place] - differences[place - 1]) / (nodes[place] - nodes[place - order])
                };
            }
        }
        let mut piece = Self { nodes, differences, rates: (f64::INFINITY, 0.0) };
        for look in 0..=LOOKS {
            let share = look as f64 / LOOKS as f64;
            let (_, rate) = piece.at(times[row] + share * (times[row + 1] - times[row]));
            // Where it is NaN, it does not rise.
            let (least, largest) = piece.rates;
            piece.rates = (if rate >= least { least } else { rate }, largest.max(rate));
        }
        piece
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
    /// Of a coordinate's values and rates at ascending times; `None` of too few.
    pub fn new(times: Vec<f64>, mut values: Vec<f64>, mut rates: Vec<f64>) -> Option<Self> {
        if times.len() < 2 * BESIDE {
            return None;
        }
        let sign = if values.last() < values.first() { -1.0 } else { 1.0 };
        values.iter_mut().chain(&mut rates).for_each(|value| *value *= sign);
        let pieces = (0..times.len() - 1).map(|row| Piece::new(&times, &values, &rates, row)).collect();
        Some(Self { sign, times, values, pieces })
    }

    /// The part about the places of some samples; `None` where the course does not pass all of them, rests, or turns back.
    pub fn over(&self, range: Range) -> Option<Phase<'_>> {
        let (a, b) = (self.sign * range.lower, self.sign * range.upper);
        let (low, high) = (a.min(b), a.max(b));
        let mut end = self.values.iter().position(|&value| value >= high)?;
        let mut begin = self.values[..=end].iter().rposition(|&value| value <= low)?;
        // Written so that NaN is nowhere.
        if !(low < high && begin < end) {
            return None;
        }
        let least = SLOWEST * (self.values[end] - self.values[begin]) / (self.times[end] - self.times[begin]);
        let rises = |piece: &Piece| piece.rates.0 >= least;
        if !self.pieces[begin..end].iter().all(rises) {
            return None;
        }
        begin -= self.pieces[..begin].iter().rev().take_while(|piece| rises(piece)).count();
        end += self.pieces[end..].iter().take_while(|piece| rises(piece)).count();
        let steepest = self.pieces[begin..end].iter().fold(0.0_f64, |most, piece| most.max(piece.rates.1));
        (end >= begin + ROWS).then_some(Phase { course: self, begin, end, steepest })
    }
}

impl Phase<'_> {
    /// The coordinate and its rate at a time of the course.
    pub fn at(&self, time: f64) -> (f64, f64) {
        let Course { sign, times, pieces, .. } = self.course;
        let within = time.clamp(times[self.begin], times[self.end]);
        let row = times[self.begin + 1..self.end].partition_point(|&row| row <= within) + self.begin;
        let (value, rate) = pieces[row].at(within);
        (sign * (value + rate * (time - within)), sign * rate)
    }

    /// The time at which the course has a value.
    pub fn time(&self, value: f64) -> f64 {
        let Course { sign, times, values, pieces } = self.course;
        let value = sign * value;
        let beyond = [(self.begin, value <= values[self.begin]), (self.end, value >= values[self.end])];
        if let Some((row, _)) = beyond.into_iter().find(|beyond| beyond.1) {
            let (at, rate) = pieces[row.min(self.end - 1)].at(times[row]);
            return times[row] + (value - at) / rate;
        }
        let row = values[self.begin + 1..self.end].partition_point(|&row| row <= value) + self.begin;
        let (mut low, mut high) = (times[row], times[row + 1]);
        let mut time = low + (high - low) * (value - values[row]) / (values[row + 1] - values[row]);
        // Newton's method, within what is known to hold the time.
        for _ in 0..STEPS {
            let (at, rate) = pieces[row].at(time);
            if at > value {
                high = time
            } else {
                low = time
            }
            let next = time - (at - value) / rate;
            let next = if next >= low && next <= high { next } else { 0.5 * (low + high) };
            if (next - time).abs() <= 2.0 * f64::EPSILON * time.abs() {
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
    fn times_and_values_belong_together() {
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
                    // What lies between the rows is the angle's own.
                    let (own, own_rate) = angle(time, speed);
                    assert!((own - value).abs() < 1e-7 && (own_rate - rate).abs() < 1e-4, "{own} {own_rate} {rate}");
                }
                let ahead = phase.at(time + 1e-7).0;
                assert!(((ahead - value) / 1e-7 - rate).abs() < 1e-4 * rate.abs());
            }
        }
    }

    #[test]
    fn what_rests_or_turns_back_is_no_measure() {
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
