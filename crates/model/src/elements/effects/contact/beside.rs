//! The point of a line that is nearest to a block.
//!
//! ```text
//! p(t) = b + t v in the block's frame, eᵢ(t) = ⟨pᵢ − hᵢ⟩ − ⟨−pᵢ − hᵢ⟩;    ½|e|² + ½ ε² (t − m)² is least where
//! g(t) = Σ eᵢ(t) vᵢ + ε² (t − m) = 0 within 0 … M,    ε² = 2·10⁻⁴ (ρ + r)/M
//! ```
//!
//! g grows and is straight between the places where p passes a face's plane: its root lies between the last of these at
//! which it is not positive and the first at which it is. Where the line is parallel to a face many points are as near;
//! m, the one nearest to the block's middle, is taken then, and takes over within an angle of 10⁻⁴.

use symdiff::Scalar;

use super::solid::Segment;
use crate::elements::tuning::TUNING;

/// t: how far along the line, from `start` along the unit vector `along` of the block's frame. `half` are the block's
/// half-sizes, `reach` is ρ + r.
pub fn nearest_to_block<'g>(
    (start, along, length): Segment<'g>,
    half: [Option<Scalar<'g>>; 3],
    reach: Scalar<'g>,
) -> Scalar<'g> {
    let zero = length.builder().number(0.0);
    let within = |place: Scalar<'g>| place.max(zero).min(length);
    let middle = within(-along.dot(start));
    let small = 2.0 * TUNING.line_along_face * reach / length;
    let (start, along) = (start.components(), along.components());
    let slope = |place: Scalar<'g>| {
        let mut slope = small * (place - middle);
        for axis in 0..3 {
            let Some(half) = half[axis] else { continue };
            let at = start[axis] + place * along[axis];
            slope += ((at - half).max(zero) + (at + half).min(zero)) * along[axis];
        }
        slope
    };
    let mut before = (zero, slope(zero).min(zero));
    let mut after = (length, slope(length).max(zero));
    for axis in 0..3 {
        let Some(half) = half[axis] else { continue };
        let steepness = along[axis] / (along[axis] * along[axis] + TUNING.no_passing);
        for face in [half, -half] {
            let place = within((face - start[axis]) * steepness);
            let slope = slope(place);
            // The last of the points with a slope that is not positive, and the first of the others.
            let is_later = (place - before.0).min(-slope);
            let is_earlier = (after.0 - place).min(slope);
            before = (is_later.select(place, before.0), is_later.select(slope, before.1));
            after = (is_earlier.select(place, after.0), is_earlier.select(slope, after.1));
        }
    }
    let rise = (after.1 - before.1).max(small * small * length);
    within(before.0 - before.1 * (after.0 - before.0) / rise)
}
