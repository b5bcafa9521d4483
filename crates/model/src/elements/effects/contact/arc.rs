//! An arc between two points, of at most half a turn.
//!
//! ```text
//! c = (a + b)/2 + σ √(R² − |b − a|²/4) n,    σ = 1 where it turns left, n the left normal of b − a
//! ```

use symdiff::Scalar;

use crate::elements::tuning::TUNING;
use crate::multibody::Vector;

/// An arc in the x and y of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Arc<'g> {
    ends: [Vector<'g>; 2],
    /// c
    middle: Vector<'g>,
    /// R, m
    radius: Scalar<'g>,
    /// σ
    turn: Scalar<'g>,
    /// Unit vector from c to the middle of the arc.
    towards: Vector<'g>,
    /// Tangents at both ends.
    pub tangents: [Vector<'g>; 2],
}

impl<'g> Arc<'g> {
    /// Arc between two points; the radius is negative if it turns right.
    pub fn between([start, end]: [Vector<'g>; 2], signed: Scalar<'g>) -> Self {
        let radius = (signed * signed).sqrt();
        let turn = signed / radius;
        let chord = end - start;
        let left = chord.unit().perpendicular();
        let height = (radius * radius - 0.25 * chord.dot(chord)).sqrt();
        let middle = 0.5 * (start + end) + (turn * height) * left;
        let tangents = [start, end].map(|place| (turn / radius) * (place - middle).perpendicular());
        Self { ends: [start, end], middle, radius, turn, towards: -(turn * left), tangents }
    }

    /// |w|, never zero.
    fn distance(&self, place: Vector<'g>) -> Scalar<'g> {
        let from = place - self.middle;
        let centred = TUNING.centred_arc * self.radius;
        (from.dot(from) + centred * centred).sqrt()
    }

    /// Distance of a point to the left of the arc, with a sign.
    pub fn beside(&self, place: Vector<'g>) -> Scalar<'g> {
        self.turn * (self.radius - self.distance(place))
    }

    /// Two values, positive where a point is after the start and where it is past the end.
    pub fn ends(&self, place: Vector<'g>) -> [Scalar<'g>; 2] {
        let from = place - self.middle;
        let [after, past] = self.ends.map(|end| self.turn / self.radius * (end - self.middle).cross(from)[2]);
        let second_half = self.turn * self.towards.cross(from)[2];
        [second_half.select(self.radius, after), second_half.select(past, -self.radius)]
    }

    /// Vector from the nearest point of the arc to another point.
    pub fn across(&self, place: Vector<'g>, [after, past]: [Scalar<'g>; 2]) -> Vector<'g> {
        let distance = self.distance(place);
        let radial = (1.0 - self.radius / distance) * (place - self.middle);
        let [from_start, from_end] = self.ends.map(|end| place - end);
        let component = |axis: usize| after.select(past.select(from_end[axis], radial[axis]), from_start[axis]);
        [component(0), component(1), after.builder().number(0.0)].into()
    }

    /// Square of a point's distance from the arc.
    pub fn square(&self, place: Vector<'g>, [after, past]: [Scalar<'g>; 2]) -> Scalar<'g> {
        let off = self.radius - self.distance(place);
        let [from_start, from_end] = self.ends.map(|end| {
            let (x, y) = (place[0] - end[0], place[1] - end[1]);
            x * x + y * y
        });
        after.select(past.select(from_end, off * off), from_start)
    }
}
