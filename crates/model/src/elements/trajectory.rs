//! A trajectory: a value over the time by points that it passes.
//!
//! ```text
//! x(t) = x₀ before t₀,  xₙ after tₙ,  else by the timing
//! u = (t − tᵢ)/h,  h = tᵢ₊₁ − tᵢ,  d = xᵢ₊₁ − xᵢ,  v the rates, w = h v
//!
//! cubic        xᵢ + wᵢ u + (3 d − 2 wᵢ − wᵢ₊₁) u² + (wᵢ + wᵢ₊₁ − 2 d) u³
//! quintic      xᵢ + wᵢ u + (10 d − 6 wᵢ − 4 wᵢ₊₁) u³ + (8 wᵢ + 7 wᵢ₊₁ − 15 d) u⁴ + (6 d − 3 wᵢ − 3 wᵢ₊₁) u⁵
//! trapezoidal  xᵢ + d σ(u),  σ = u²/(2 r (1 − r)) up to r = ramp/h,  (u − r/2)/(1 − r) up to 1 − r,
//!              then 1 − (1 − u)²/(2 r (1 − r))
//! spline       cubic, with the rates that make ẍ continuous:
//!              hᵢ vᵢ₋₁ + 2 (hᵢ₋₁ + hᵢ) vᵢ + hᵢ₋₁ vᵢ₊₁ = 3 (hᵢ dᵢ₋₁/hᵢ₋₁ + hᵢ₋₁ dᵢ/hᵢ),   v₀ = vₙ = 0
//! ```
//!
//! Rate and acceleration are its derivatives. Pieces are guarded by their times, so that steps end there as at every
//! switch, and none is computed but that of the time. Biagiotti & Melchiorri, *Trajectory Planning for Automatic
//! Machines and Robots* (2008), ch. 2 to 4.

use symdiff::{Formula, Scalar};

use super::excitation::Excitation;
use super::random::RandomFunction;
use super::tuning::TUNING;
use crate::grammar::quantity::Dimension;

/// A value over the time.
#[derive(Clone, Debug)]
pub struct Trajectory {
    /// Its name.
    pub name: String,
    /// Points: at least two, times ascending; none for an excitation.
    pub points: Vec<Waypoint>,
    /// How it moves from one point to the next.
    pub timing: Timing,
    /// Dimension of the value; `None` if unknown.
    pub dimension: Option<Dimension>,
}

/// A point that a trajectory passes; formulas of parameters.
#[derive(Clone, Debug)]
pub struct Waypoint {
    /// s
    pub time: Formula,
    /// Value, in the trajectory's unit.
    pub value: Formula,
    /// Rate, in the trajectory's unit over s; `None` for 0.
    pub rate: Option<Formula>,
}

/// How a trajectory moves from one point to the next.
#[derive(Clone, Debug)]
pub enum Timing {
    /// Polynomials of degree three.
    Cubic,
    /// Polynomials of degree five.
    Quintic,
    /// From rest to rest at a constant rate between constant accelerations of this length, s.
    Trapezoidal(Option<Formula>),
    /// A cubic spline.
    Spline,
    /// Any function within limits.
    Within(Box<Excitation>),
    /// An excitation that is a known function: a formula of t.
    Given(Formula),
    /// A stationary random function.
    Random(Box<RandomFunction>),
}

/// Time, value and rate.
type Knot<'g> = [Scalar<'g>; 3];

/// A time and the expression that holds up to it.
type Piece<'g> = (Scalar<'g>, Scalar<'g>);

impl Trajectory {
    /// Every formula in it.
    pub fn formulas(&self) -> impl Iterator<Item = &Formula> {
        let ramp = match &self.timing {
            Timing::Trapezoidal(ramp) => ramp.as_ref(),
            _ => None,
        };
        let points = self.points.iter();
        let of_points = points.flat_map(|point| [&point.time, &point.value].into_iter().chain(&point.rate));
        let given = match &self.timing {
            Timing::Given(formula) => Some(formula),
            _ => None,
        };
        let of_excitation = self.excitation().into_iter().flat_map(Excitation::formulas);
        let of_random = self.random().into_iter().flat_map(RandomFunction::formulas);
        of_points.chain(ramp).chain(given).chain(of_excitation).chain(of_random)
    }

    /// Its spectrum, if it is random.
    pub fn random(&self) -> Option<&RandomFunction> {
        match &self.timing {
            Timing::Random(random) => Some(random),
            _ => None,
        }
    }

    /// Its limits, if it is an excitation.
    pub fn excitation(&self) -> Option<&Excitation> {
        match &self.timing {
            Timing::Within(excitation) => Some(excitation),
            _ => None,
        }
    }

    /// x(t), of an excitation as a constant; `number` makes expressions of formulas.
    ///
    /// # Errors
    /// Whatever `number` says.
    pub fn value<'g, E>(
        &self,
        time: Scalar<'g>,
        number: impl Fn(&Formula) -> Result<Scalar<'g>, E>,
    ) -> Result<Scalar<'g>, E> {
        if let Some(excitation) = self.excitation() {
            return excitation.as_constant(time, number);
        }
        if let Timing::Given(formula) = &self.timing {
            return number(formula);
        }
        if let Some(random) = self.random() {
            return random.value(time, number);
        }
        let zero = time.builder().number(0.0);
        let mut knots: Vec<Knot> = Vec::with_capacity(self.points.len());
        for Waypoint { time, value, rate } in &self.points {
            knots.push([number(time)?, number(value)?, rate.as_ref().map_or(Ok(zero), &number)?]);
        }
        if let Timing::Spline = self.timing {
            set_spline_rates(&mut knots);
        }
        let ramp = match &self.timing {
            Timing::Trapezoidal(Some(ramp)) => Some(number(ramp)?),
            _ => None,
        };
        let mut pieces = Vec::new();
        for (from, to) in knots.iter().zip(&knots[1..]) {
            let h = to[0] - from[0];
            let u = (time - from[0]) / h;
            match self.timing {
                Timing::Cubic | Timing::Spline => pieces.push((to[0], cubic(u, h, from, to))),
                Timing::Quintic => pieces.push((to[0], quintic(u, h, from, to))),
                Timing::Trapezoidal(_) => trapezoidal(&mut pieces, u, ramp.map(|ramp| ramp / h), from, to),
                // Without points there are no pieces.
                Timing::Within(_) | Timing::Given(_) | Timing::Random(_) => {}
            }
        }
        let ([first, start, _], [_, end, _]) = (knots[0], knots[knots.len() - 1]);
        let moving = pieces.into_iter().rev().fold(end, |later, (to, piece)| (to - time).select(piece, later));
        // A trajectory that begins with the motion waits for nothing.
        let waits = first.as_constant().is_none_or(|first| first > 0.0);
        Ok(if waits { (first - time).select(start, moving) } else { moving })
    }
}

/// x₀ + w₀ u + b u² + c u³.
fn cubic<'g>(u: Scalar<'g>, h: Scalar<'g>, [_, x, v]: &Knot<'g>, [_, next, end]: &Knot<'g>) -> Scalar<'g> {
    let (d, w, z) = (*next - *x, h * *v, h * *end);
    let (b, c) = (3.0 * d - 2.0 * w - z, w + z - 2.0 * d);
    *x + u * (w + u * (b + u * c))
}

/// x₀ + w₀ u + u³ (a + b u + c u²).
fn quintic<'g>(u: Scalar<'g>, h: Scalar<'g>, [_, x, v]: &Knot<'g>, [_, next, end]: &Knot<'g>) -> Scalar<'g> {
    let (d, w, z) = (*next - *x, h * *v, h * *end);
    let a = 10.0 * d - 6.0 * w - 4.0 * z;
    let b = 8.0 * w + 7.0 * z - 15.0 * d;
    let c = 6.0 * d - 3.0 * w - 3.0 * z;
    *x + u * (w + u * u * (a + u * (b + u * c)))
}

/// Both ramps, r long, and the part between them, if any.
fn trapezoidal<'g>(pieces: &mut Vec<Piece<'g>>, u: Scalar<'g>, r: Option<Scalar<'g>>, from: &Knot<'g>, to: &Knot<'g>) {
    let one = u.builder().number(1.0);
    let r = r.unwrap_or_else(|| u.builder().number(0.25));
    let ([begin, x, _], [end, next, _]) = (*from, *to);
    let (d, h, left) = (next - x, end - begin, one - u);
    let twice = 2.0 * (r * (one - r));
    pieces.push((begin + r * h, x + d * (u * u / twice)));
    let between = one - 2.0 * r;
    if between.as_constant().is_none_or(|share| share > TUNING.negligible_share) {
        pieces.push((end - r * h, x + d * ((u - 0.5 * r) / (one - r))));
    }
    pieces.push((end, next - d * (left * left / twice)));
}

/// Rates between the ends by which accelerations are continuous: Gaussian elimination of a matrix of three diagonals
/// that are dominant, so that it needs no pivots.
fn set_spline_rates(knots: &mut [Knot]) {
    let last = knots.len() - 1;
    let widths: Vec<Scalar> = (0..last).map(|index| knots[index + 1][0] - knots[index][0]).collect();
    let slope = |index: usize| (knots[index + 1][1] - knots[index][1]) / widths[index];
    // The rest of each inner knot's row: diagonal and right side.
    let mut rows: Vec<(Scalar, Scalar)> = Vec::with_capacity(last);
    for index in 1..last {
        let (before, after) = (widths[index - 1], widths[index]);
        let mut diagonal = 2.0 * (before + after);
        let mut right = 3.0 * (after * slope(index - 1) + before * slope(index));
        if let Some(&(above, right_above)) = rows.last() {
            let factor = after / above;
            // The entry above the diagonal in the row before is its own width before.
            diagonal -= factor * widths[index - 2];
            right -= factor * right_above;
        }
        rows.push((diagonal, right));
    }
    let mut next = knots[last][2];
    for index in (1..last).rev() {
        let (diagonal, right) = rows[index - 1];
        next = (right - widths[index - 1] * next) / diagonal;
        knots[index][2] = next;
    }
}
