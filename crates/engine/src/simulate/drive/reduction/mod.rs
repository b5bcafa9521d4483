//! One number of a motion: outputs accumulated from step to step, between steps too.
//!
//! Between steps an output is the cubic through the values at four of them (`piece`), one order more than the scheme
//! has. Where the values jump it does not rise above them.

mod piece;
pub(crate) mod tuning;
mod zone;

use std::ops::Range;

use piece::Piece;
use serde::{Deserialize, Serialize};
use tuning::TUNING;
use zone::Zone;

/// Quantity accumulated of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Accumulation {
    /// The greatest value.
    Greatest,
    /// The smallest value.
    Least,
    /// When it is greatest first, s.
    WhenGreatest,
    /// When it is smallest first, s.
    WhenLeast,
    /// When it is first not negative, s; when it is greatest, where it never is.
    First,
    /// When it is last not negative, s; when it is greatest, where it never is.
    Last,
    /// Its integral over the time.
    Integral,
    /// The integral of its square.
    IntegralOfSquare,
    /// Its value at the end of the time.
    AtEnd,
    /// The width of the narrowest strip that holds the path with this ordinate.
    Zone {
        /// The output that is the abscissa.
        abscissa: usize,
    },
}

/// Something accumulated of an output between two times.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Channel {
    /// Number of the output.
    pub output: usize,
    /// Kind of reduction.
    pub accumulation: Accumulation,
    /// Begin, s.
    pub from: f64,
    /// End, s; the end of the run, if that is earlier.
    pub to: f64,
}

/// A channel's state in a lane.
#[derive(Clone, Debug)]
struct State {
    value: f64,
    /// Time of an extreme, s, and its value.
    time: f64,
    height: f64,
    zone: Zone,
}

impl State {
    fn new() -> Self {
        Self { value: f64::NAN, time: f64::NAN, height: f64::NAN, zone: Zone::default() }
    }
}

/// Accumulates the channels of a tile's lanes.
#[derive(Debug)]
pub(in crate::simulate) struct Accumulator<'s> {
    channels: &'s [Channel],
    outputs: usize,
    width: usize,
    /// Times of the last steps, up to four, and the outputs at them: output by output, lane by lane.
    times: Vec<f64>,
    values: Vec<Vec<f64>>,
    /// Whether pieces of all but the last step are accumulated.
    begun: bool,
    /// Channel by channel, lane by lane.
    states: Vec<State>,
    /// Lanes that stopped.
    stopped: Vec<bool>,
}

impl<'s> Accumulator<'s> {
    /// Accumulates a tile of `width` lanes, with `outputs` outputs.
    pub fn new(channels: &'s [Channel], outputs: usize, width: usize) -> Self {
        let states = vec![State::new(); channels.len() * width];
        let stopped = vec![false; width];
        Self { channels, outputs, width, times: Vec::new(), values: Vec::new(), begun: false, states, stopped }
    }

    /// Room for the outputs of the next step.
    pub fn buffer(&mut self) -> Vec<f64> {
        match self.values.len() {
            4 => self.values.remove(0),
            _ => vec![0.0; self.outputs * self.width],
        }
    }

    /// Goes on to a step's end, given the outputs there, and which lanes still run.
    pub fn push(&mut self, time: f64, values: Vec<f64>, alive: &[bool]) {
        self.stopped.iter_mut().zip(alive).for_each(|(stopped, alive)| *stopped |= !alive);
        if self.times.len() == 4 {
            self.times.remove(0);
        }
        self.times.push(time);
        self.values.push(values);
        if self.times.len() == 4 {
            if !std::mem::replace(&mut self.begun, true) {
                self.accumulate(0);
            }
            self.accumulate(1);
        }
    }

    /// The values after the last step, channel by channel, lane by lane; NaN of lanes that stopped. A value at one time
    /// only is constant.
    pub fn finish(&mut self) -> Vec<f64> {
        if let ([time], [values]) = (&self.times[..], &self.values[..]) {
            let (time, values) = (time + 1.0, values.clone());
            self.times.push(time);
            self.values.push(values);
        }
        // Intervals that wait for a later step are taken without it.
        let first = if self.begun { self.times.len() - 2 } else { 0 };
        for index in first..self.times.len().saturating_sub(1) {
            self.accumulate(index);
        }
        let value = |(index, state): (usize, &State)| {
            let channel = &self.channels[index / self.width];
            match channel.accumulation {
                _ if self.stopped[index % self.width] => f64::NAN,
                Accumulation::WhenGreatest | Accumulation::WhenLeast => state.time,
                Accumulation::First | Accumulation::Last if state.value.is_nan() => state.time,
                Accumulation::Zone { .. } => state.zone.width(),
                _ => state.value,
            }
        };
        self.states.iter().enumerate().map(value).collect()
    }

    /// Accumulates the interval between two steps.
    fn accumulate(&mut self, index: usize) {
        let piece = |output: usize, lane: usize| {
            let mut points = [(0.0, 0.0); 4];
            for (point, (&time, values)) in points.iter_mut().zip(self.times.iter().zip(&self.values)) {
                *point = (time, values[output * self.width + lane]);
            }
            Piece::between(&points[..self.times.len()], index)
        };
        let [start, end] = [self.times[index], self.times[index + 1]];
        for (number, channel) in self.channels.iter().enumerate() {
            // A channel of a single time takes the piece that ends there or after it.
            let is_at = channel.accumulation == Accumulation::AtEnd;
            if channel.from >= end && !is_at
                || channel.to < start
                || (is_at && channel.to > end && !is_last(channel, end))
            {
                continue;
            }
            for lane in (0..self.width).filter(|&lane| !self.stopped[lane]) {
                let own = piece(channel.output, lane);
                let state = &mut self.states[number * self.width + lane];
                match channel.accumulation {
                    Accumulation::Zone { abscissa } => add_path(&mut state.zone, &piece(abscissa, lane), &own, channel),
                    _ => take(state, &own, channel),
                }
            }
        }
    }
}

/// Whether a channel of a single time may end here: later steps are not known yet.
fn is_last(channel: &Channel, end: f64) -> bool {
    channel.to.is_infinite() || channel.to <= end * (1.0 + 1e-12)
}

fn add_path(zone: &mut Zone, x: &Piece, y: &Piece, channel: &Channel) {
    if let Some(Range { start: begin, end }) = y.part(channel.from, channel.to) {
        for index in 0..=TUNING.places_of_path {
            let share = begin + (end - begin) * index as f64 / TUNING.places_of_path as f64;
            zone.add([x.at(share), y.at(share)]);
        }
    }
}

/// Takes a piece into a state.
fn take(state: &mut State, piece: &Piece, channel: &Channel) {
    if channel.accumulation == Accumulation::AtEnd {
        let share = ((channel.to - piece.start) / piece.length).clamp(0.0, 1.0);
        state.value = piece.at(share);
        return;
    }
    let Some(part) = piece.part(channel.from, channel.to) else { return };
    let add = |state: &mut State, more: f64| state.value = if state.value.is_nan() { more } else { state.value + more };
    match channel.accumulation {
        Accumulation::Greatest | Accumulation::WhenGreatest => climb(state, piece, &part, 1.0),
        Accumulation::Least | Accumulation::WhenLeast => climb(state, piece, &part, -1.0),
        Accumulation::Integral => add(state, piece.integral(&part, |value| value)),
        Accumulation::IntegralOfSquare => add(state, piece.integral(&part, |value| value * value)),
        Accumulation::First => {
            let known = state.value;
            climb(state, piece, &part, 1.0);
            let found = piece.first_above(&part).map_or(f64::NAN, |share| piece.time(share));
            state.value = if known.is_nan() { found } else { known };
        }
        Accumulation::Last => {
            let known = state.value;
            climb(state, piece, &part, 1.0);
            state.value = piece.last_above(&part).map_or(known, |share| piece.time(share));
        }
        Accumulation::AtEnd | Accumulation::Zone { .. } => (),
    }
    // `climb` stores the height as the value of a height.
    if matches!(channel.accumulation, Accumulation::Greatest | Accumulation::Least) {
        state.value = state.height;
    }
}

/// Stores a higher value with its time.
fn climb(state: &mut State, piece: &Piece, part: &Range<f64>, sign: f64) {
    let (share, height) = piece.greatest(part, sign);
    if state.height.is_nan() || sign * height > sign * state.height {
        (state.height, state.time) = (height, piece.time(share));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use symdiff::math::sin;

    fn reduced(accumulation: Accumulation, from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
        let channels = [Channel { output: 0, accumulation, from, to }];
        let mut reduction = Accumulator::new(&channels, 1, 1);
        for step in 0..=63 {
            let time = 0.1 * f64::from(step);
            let mut values = reduction.buffer();
            values[0] = f(time);
            reduction.push(time, values, &[true]);
        }
        reduction.finish()[0]
    }

    #[test]
    fn a_sine_is_reduced_between_its_steps() {
        use Accumulation::*;
        let half = std::f64::consts::FRAC_PI_2;
        // A cubic's error between its two middle nodes: |f⁗| h⁴/4! times 9/16.
        let cubic = 1e-4 / 24.0 * 9.0 / 16.0;
        for (accumulation, from, to, expected, error) in [
            (Greatest, 0.0, f64::INFINITY, 1.0, cubic),
            (Least, 0.0, f64::INFINITY, -1.0, cubic),
            (Least, 1.0, 2.0, sin(1.0), 1e-15),
            (WhenGreatest, 0.0, f64::INFINITY, half, 2e-4),
            (WhenLeast, 0.0, f64::INFINITY, 3.0 * half, 2e-4),
            (First, 1.0, 6.0, 1.0, 1e-15),
            (First, 3.3, 6.0, 3.0 * half, 2.0),
            (Last, 0.0, 6.0, 2.0 * half, 1e-6),
            (AtEnd, 0.0, 0.55, sin(0.55), 3e-6),
            (AtEnd, 0.0, f64::INFINITY, sin(6.3), 1e-15),
            (Integral, 0.0, 2.0 * half, 2.0, 1e-5),
            (IntegralOfSquare, 0.0, 2.0 * half, half, 1e-5),
        ] {
            let found = reduced(accumulation, from, to, sin);
            assert!((found - expected).abs() < error, "{accumulation:?} from {from} to {to}: {found}");
        }
    }

    #[test]
    fn few_steps_and_stopped_lanes() {
        let channels = [Channel { output: 0, accumulation: Accumulation::Greatest, from: 0.0, to: f64::INFINITY }];
        let mut reduction = Accumulator::new(&channels, 1, 2);
        reduction.push(0.0, vec![1.0, 1.0], &[true, true]);
        reduction.push(0.5, vec![3.0, 9.0], &[true, false]);
        let found = reduction.finish();
        assert!(found[0] == 3.0 && found[1].is_nan());
    }
}
